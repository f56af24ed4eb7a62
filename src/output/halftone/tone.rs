//! How light a face is.

use glam::{DVec2, DVec3};

use super::{
    facet::{Bend, Facet},
    light::Sun,
    plate::{Optics, Plate},
};

/// Gives plates their tones.
pub(super) struct Toner<'a> {
    pub optics: &'a Optics<'a>,
    pub suns: &'a [Sun],
}

/// Steps from a facet to its true surface along the sight line: each squares the error.
const STEPS: usize = 3;

/// The true surface is not looked for where the sight line grazes it, by the cosine of the angle with its normal.
const GRAZING: f64 = 0.05;

impl Toner<'_> {
    /// The colour of a plate at a column and row, where suns of the given bits shine.
    pub fn at(&self, plate: &Plate<'_>, at: DVec2, suns: u32) -> [f32; 3] {
        let normal = if plate.is_flat() { plate.facet.normal } else { self.true_normal(plate, at) };
        let normal = if plate.back { -normal } else { normal };
        let tone = self.tone(normal, suns);
        plate.facet.color.map(|part| (part * tone) as f32)
    }

    /// The tone of a white face with a normal: the mean of what the suns give, by their strengths.
    fn tone(&self, normal: DVec3, suns: u32) -> f64 {
        let (mut sum, mut strength) = (0.0, 0.0);
        for (number, sun) in self.suns.iter().enumerate() {
            let shines = suns & 1 << number != 0;
            let cosine = if shines { normal.dot(sun.toward()) } else { 0.0 };
            sum += sun.strength() * sun.tone(cosine);
            strength += sun.strength();
        }
        if strength > 0.0 { sum / strength } else { 1.0 }
    }

    fn true_normal(&self, plate: &Plate<'_>, at: DVec2) -> DVec3 {
        let (p, toward) = self.optics.point(at, plate.near_at(at));
        plate.facet.normal_at(on_surface(plate.facet, p, toward))
    }
}

/// Where the sight line through a point of a facet meets its true surface.
fn on_surface(facet: &Facet, mut p: DVec3, toward: DVec3) -> DVec3 {
    let Bend::Surface { surface, .. } = facet.bend else { return p };
    for _ in 0..STEPS {
        let (distance, normal) = surface.slope(p);
        let cosine = normal.dot(toward);
        if cosine.abs() < GRAZING {
            break;
        }
        p -= toward * (distance / cosine);
    }
    p
}
