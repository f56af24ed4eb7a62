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
mod diffusion;
mod dots;
mod facet;
mod format;
mod ink;
mod light;
mod overstrike;
mod picture;
mod plate;
mod png;
mod scan;
mod screen;
mod shadow;
mod stipple;
mod strokes;
mod tone;
mod vector;

pub use format::{Halftone, PictureFormat, Tones, lines};
pub use ink::{Ink, Mark};
pub use light::{LightError, Sun};
pub use overstrike::{LEVELS, Level, Overstrike, levels, overstrike};
pub use picture::{Frame, FrameError, PIXELS, Picture};
pub use png::png;
pub use screen::{CELLS, Screen, ScreenError};
pub use vector::svg;

use glam::DVec3;

use self::{
    facet::{Bend, Facet, facets},
    plate::{Optics, Plate},
    shadow::{Lit, Shadows},
    tone::Toner,
};
use super::drawing::{Camera, Scene};

/// What lights a scene.
#[derive(Clone, PartialEq, Debug)]
pub struct Light {
    /// At least one, at most [`SUNS`].
    pub suns: Vec<Sun>,
    /// The height of the plane that shadows fall on, if there is one, mm.
    pub ground: Option<f64>,
}

/// Suns of one scene at most.
pub const SUNS: usize = 8;

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

/// A sun stands above the horizon from this sine of its height on; shadows are 10,000 times as long as what casts them
/// there.
pub const HORIZON: f64 = 1e-4;

/// The picture of a scene: strokes are left out.
pub fn picture(scene: &Scene, camera: &Camera, light: &Light, frame: &Frame) -> Picture {
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
    let optics = Optics::new(camera, frame);
    let plates: Vec<Plate> =
        facets.iter().zip(&lit).filter_map(|(facet, lit)| optics.plate(facet, lit)).collect();
    let toner = Toner { optics: &optics, suns: &light.suns };
    scan::scan(&plates, frame, &|plate, at, suns| toner.at(plate, at, suns))
}
