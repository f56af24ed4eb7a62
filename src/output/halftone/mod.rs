//! Half-tones: what a scene looks like in the light, with the shadows it casts.
//!
//! The sun is the first eye: [`shadow`] finds on every face where the light does not reach, as polygons. The
//! real eye is the second: [`scan`] finds line by line which face is seen, [`plate`] how near it is, and
//! [`tone`] how light it is there, by the true normals of round surfaces ([`facet`]).
//!
//! ```
//! use glam::{DVec3, dvec2};
//! use katachi::{
//!     kernel::brep::primitive::cuboid,
//!     output::{drawing::{Camera, Scene, View, Window}, halftone::{Frame, Light, Sun, picture}},
//! };
//! let cube = cuboid(DVec3::ZERO, DVec3::splat(10.0));
//! let window = Window { min: dvec2(-10.0, -10.0), max: dvec2(10.0, 10.0) };
//! let frame = Frame::new(window, 25.4).unwrap();
//! let light = Light { suns: vec![Sun::new(DVec3::Z, 0.2).unwrap()], ground: None };
//! let camera = Camera::view(View::Top);
//! let picture = picture(&Scene::of([cube.mesh()]), &camera, &light, &frame);
//! assert_eq!(picture.at(15, 5), [1.0; 3]);
//! ```
//!
//! # Paper
//! Half-tone pictures with shadows, METHODS 3.4.
//!
//! # Departures
//! The paper prints 20 levels on a line printer, and keeps with each face the outlines of single bodies that
//! shade it. Here what shades a face is united, so that a face is in the shade once however many bodies are
//! before it, and shaded edges are polygons that drawings can use.

mod average;
mod cast;
mod chart;
mod diffusion;
mod dots;
mod facet;
mod format;
mod guide;
mod hatch;
mod ink;
mod light;
mod overstrike;
mod picture;
mod plate;
mod png;
mod preview;
mod scan;
mod screen;
mod shadow;
mod stipple;
mod strokes;
mod tone;
mod travel;

pub use cast::{CastShadow, cast_shadows};
pub use format::{Halftone, PictureFormat, Tones};
pub use guide::Guide;
pub use ink::{Ink, Mark};
pub use light::{LightError, Sun};
pub use overstrike::{LEVELS, Level, Overstrike, levels, overstrike};
pub use picture::{Frame, FrameError, PIXELS, Picture};
pub use png::png;
pub use preview::{cell_dpi, cell_width, preview};
pub use screen::{CELLS, ScreenError};

pub use crate::geom::{
    light::{HORIZON, SUNS},
    screen::{DotShape, Screen},
};

use glam::DVec3;

use self::{
    facet::{Bend, Facet, facets},
    plate::{Optics, Plate},
    shadow::{Lit, Shadows},
    tone::Toner,
};
use super::drawing::{Camera, Scene};
use crate::geom::{CurvedGrid, Tolerance};

/// What lights a scene.
#[derive(Clone, PartialEq, Debug)]
pub struct Light {
    /// At least one, at most [`SUNS`].
    pub suns: Vec<Sun>,
    /// The height of the plane that shadows fall on, if there is one, mm.
    pub ground: Option<f64>,
}

/// A part of a face that a sun shines on.
#[derive(Clone, PartialEq, Debug)]
pub struct LitPart {
    /// The body's place in the scene.
    pub body: usize,
    /// The face's place in the mesh.
    pub face: usize,
    /// Closed contours, millimetres: what they wind around is lit.
    pub outline: Vec<Vec<DVec3>>,
}

/// Where a sun shines: on each face that is turned to it, what no other face shades. Faces of surfaces without a closed
/// form come in triangles.
///
/// ```
/// use glam::DVec3;
/// use katachi::{kernel::brep::primitive::cuboid, output::{drawing::Scene, halftone::{Sun, lit_parts}}};
/// let cube = |low: f64| cuboid(DVec3::splat(low), DVec3::splat(low + 1.0));
/// let (lower, upper) = (cube(0.0), cuboid(DVec3::Z * 2.0, DVec3::new(1.0, 0.5, 3.0)));
/// let sun = Sun::new(DVec3::Z, 0.0).unwrap();
/// let parts = lit_parts(&Scene::of([lower.mesh(), upper.mesh()]), &sun);
/// assert_eq!(parts.len(), 2);
/// assert!(parts[0].outline[0].iter().all(|p| p.z == 1.0 && p.y >= 0.5));
/// ```
pub fn lit_parts(scene: &Scene, sun: &Sun) -> Vec<LitPart> {
    let facets = facets(&scene.bodies);
    let lit = Shadows::new(&facets, sun).lit();
    let part = |(facet, lit): (&Facet, Lit)| {
        let outline = match lit {
            Lit::None => return None,
            Lit::All => facet.loops.clone(),
            Lit::Part(loops) => loops,
        };
        Some(LitPart { body: facet.face.0 as usize, face: facet.face.1 as usize, outline })
    };
    facets.iter().zip(lit).filter_map(part).collect()
}

/// The outline of the shadow that the bodies of a scene cast on the horizontal plane at `z`: closed contours,
/// outer ones counter-clockwise seen from the sun, millimetres. What is below the plane casts none; a sun that
/// is not above the horizon gives none.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{kernel::brep::primitive::cuboid, output::{drawing::Scene, halftone::{Sun, ground_shadow}}};
/// let cube = cuboid(DVec3::ZERO, DVec3::ONE);
/// let sun = Sun::new(dvec3(0.0, -1.0, 1.0), 0.0).unwrap();
/// let outline = &ground_shadow(&Scene::of([cube.mesh()]), &sun, 0.0)[0];
/// let far = outline.iter().map(|p| p.y).fold(0.0, f64::max);
/// assert!((far - 2.0).abs() < 1e-12);
/// ```
pub fn ground_shadow(scene: &Scene, sun: &Sun, z: f64) -> Vec<Vec<DVec3>> {
    let facets = facets(&scene.bodies);
    if sun.toward().z <= HORIZON { vec![] } else { Shadows::new(&facets, sun).on_ground(z) }
}

/// The picture of a scene: strokes are left out.
pub fn picture(scene: &Scene, camera: &Camera, light: &Light, frame: &Frame) -> Picture {
    let facets = lit_facets(scene, light);
    seen(&facets, camera, light, frame, false).0
}

/// The picture of a scene whose bodies of some numbers are grids, and a guide along the round faces in it. Faces are
/// within the tolerance of their true surfaces.
pub fn guided<'a>(
    scene: &Scene,
    (camera, light, frame): (&Camera, &Light, &Frame),
    grids: &[(u32, &'a CurvedGrid)],
    tolerance: Tolerance,
) -> (Picture, Guide<'a>) {
    let lit = lit_facets(scene, light);
    let (picture, seen) = seen(&lit, camera, light, frame, true);
    (picture, Guide::new(&lit.0, grids, seen, (camera, frame), tolerance))
}

/// The facets of a scene and where each sun shines on them, with the shadows on the ground.
fn lit_facets(scene: &Scene, light: &Light) -> (Vec<Facet>, Vec<Vec<Lit>>) {
    let mut facets = facets(&scene.bodies);
    let mut lit: Vec<Vec<Lit>> = vec![vec![]; facets.len()];
    let mut grounds = vec![];
    for sun in light.suns.iter().take(SUNS) {
        let shadows = Shadows::new(&facets, sun);
        for (own, found) in lit.iter_mut().zip(shadows.lit()) {
            own.push(found);
        }
        let ground = light.ground.filter(|_| sun.toward().z > HORIZON);
        grounds.push(ground.map_or(vec![], |z| shadows.on_ground(z)));
    }
    for (facet, own) in facets.iter().zip(&mut lit) {
        let bent = !matches!(facet.bend, Bend::Flat);
        let suns = light.suns.iter().zip(own);
        // Where a round face turns away from the light, its true normals say so.
        suns.filter(|(sun, _)| bent && !facet.open && facet.normal.dot(sun.toward()) <= 0.0)
            .for_each(|(_, lit)| *lit = Lit::All);
    }
    for (number, shadow) in grounds.into_iter().enumerate().filter(|g| !g.1.is_empty()) {
        let suns = 0..light.suns.len().min(SUNS);
        lit.push(suns.map(|other| if other == number { Lit::None } else { Lit::All }).collect());
        facets.push(Facet::ground(shadow));
    }
    (facets, lit)
}

/// The picture of facets, and the number of the facet that each pixel shows, from 1, if that is wanted.
fn seen(
    (facets, lit): &(Vec<Facet>, Vec<Vec<Lit>>),
    camera: &Camera,
    light: &Light,
    frame: &Frame,
    wanted: bool,
) -> (Picture, Vec<u32>) {
    let optics = Optics::new(camera, frame);
    let (mut plates, mut numbers): (Vec<Plate>, Vec<u32>) = (vec![], vec![0]);
    for ((facet, lit), number) in facets.iter().zip(lit).zip(1..) {
        if let Some(plate) = optics.plate(facet, lit) {
            plates.push(plate);
            numbers.push(number);
        }
    }
    let toner = Toner { optics: &optics, suns: &light.suns };
    let paint = |plate: &Plate<'_>, at, suns| toner.at(plate, at, suns);
    let (picture, mut seen) = scan::scan(&plates, frame, &paint, wanted);
    seen.iter_mut().for_each(|plate| *plate = numbers[*plate as usize]);
    (picture, seen)
}
