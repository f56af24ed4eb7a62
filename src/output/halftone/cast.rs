//! Cast shadows as outlines, for drawings.

use glam::DVec3;

use super::{
    HORIZON,
    facet::{Bend, Facet, facets},
    light::Sun,
    shadow::Shadows,
};
use crate::output::drawing::Scene;

/// A shadow on a flat piece of a face or on the ground.
#[derive(Clone, PartialEq, Debug)]
pub struct CastShadow {
    /// The place in the scene of the body that it falls on; `None` for the ground.
    pub body: Option<usize>,
    /// Unit normal of what it falls on.
    pub normal: DVec3,
    /// Closed contours, mm (even-odd).
    pub outline: Vec<Vec<DVec3>>,
    /// The pieces of the outline that are no border of what it falls on, and between which light and shadow meet.
    pub rim: Vec<[DVec3; 2]>,
}

/// Edges of a shadow are on the border of a face when their middle is nearer than this part of the scene's size: above
/// what the union of outlines rounds, below what is seen.
const CONTACT: f64 = 1e-7;

/// Where light grazes a round face (the cosine of its angle with the normal is below this), its facets shade each other
/// though the face does not; it is nearly in its own shade there.
const FAINT: f64 = 0.25;

/// The shadows that bodies cast on each other and on the horizontal plane at a height. Faces turned away from the sun, and
/// round ones where light grazes them, have none; a sun that is not above the horizon casts none on the ground.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{kernel::brep::primitive::cuboid, output::{drawing::Scene, halftone::{Sun, cast_shadows}}};
/// let table = cuboid(dvec3(-5.0, -5.0, -1.0), dvec3(5.0, 5.0, 0.0));
/// let cube = cuboid(DVec3::ZERO, DVec3::ONE);
/// let sun = Sun::new(dvec3(-1.0, 0.0, 1.0), 0.0).unwrap();
/// let shadows = cast_shadows(&Scene::of([table.mesh(), cube.mesh()]), &sun, None);
/// let on_table = shadows.iter().filter(|shadow| shadow.body == Some(0)).flat_map(|shadow| &shadow.rim);
/// let far = on_table.flatten().map(|p| p.x).fold(0.0, f64::max);
/// assert!((far - 2.0).abs() < 1e-9);
/// ```
pub fn cast_shadows(scene: &Scene, sun: &Sun, ground: Option<f64>) -> Vec<CastShadow> {
    let facets = facets(&scene.bodies);
    let points = || facets.iter().flat_map(|facet| facet.loops.iter().flatten());
    let size = points().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    let shadows = Shadows::new(&facets, sun);
    let is_bright = |facet: &Facet| {
        matches!(facet.bend, Bend::Flat) || facet.normal.dot(sun.toward()).abs() > FAINT
    };
    let on_face = |(number, outline): (u32, Vec<Vec<DVec3>>)| {
        let facet = &facets[number as usize];
        let rim = rim(&outline, facet, CONTACT * size);
        CastShadow { body: Some(facet.face.0 as usize), normal: facet.normal, outline, rim }
    };
    let cast = shadows.cast().into_iter().filter(|cast| is_bright(&facets[cast.0 as usize]));
    let mut all: Vec<CastShadow> = cast.map(on_face).collect();
    if let Some(z) = ground.filter(|_| sun.toward().z > HORIZON) {
        let outline = shadows.on_ground(z);
        if !outline.is_empty() {
            let rim = edges(&outline).collect();
            all.push(CastShadow { body: None, normal: DVec3::Z, outline, rim });
        }
    }
    all
}

fn edges(loops: &[Vec<DVec3>]) -> impl Iterator<Item = [DVec3; 2]> {
    loops
        .iter()
        .flat_map(|points| points.iter().zip(points.iter().cycle().skip(1)).map(|(p, q)| [*p, *q]))
}

/// The edges of an outline that are not on the border of a facet.
fn rim(outline: &[Vec<DVec3>], facet: &Facet, near: f64) -> Vec<[DVec3; 2]> {
    let on_border = |p: DVec3| {
        edges(&facet.loops).any(|[a, b]| {
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a.lerp(b, t)) <= near
        })
    };
    edges(outline).filter(|[a, b]| !on_border((*a + *b) / 2.0)).collect()
}
