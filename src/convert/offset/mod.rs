//! Solids grown and shrunk by a distance.
//!
//! Tatehara et al. grow a solid by the union of balls about its points. Of a polyhedron that is: its faces
//! moved outwards, cylinders about its convex edges, spheres about its convex points; where edges are concave
//! the moved faces are cut by each other. [`surface`] makes this as one closed surface with few, exact
//! pieces: moved faces are flat polygons, arcs have as many chords as the tolerance asks for. Where parts of
//! the solid come near each other, the surface crosses itself; what it winds around at least once is the
//! solid grown, found by exact set operations. Shrinking is growing the complement.
//!
//! Whether the result is right is not taken on trust: [`Polyhedral`] tells the true distance of its corners,
//! the middles of its edges and of its triangles. Where the surface lies over itself at too many places to be freed
//! of its crossings, the distance itself is contoured ([`apart`]), with more triangles.

mod apart;
mod arc;
mod figure;
mod fillet;
mod mitre;
mod proof;
mod rings;
mod surface;

use std::sync::Arc;

use glam::{DMat3, DVec3};
use thiserror::Error;

use self::{
    apart::apart,
    figure::Measure,
    proof::missing,
    surface::{Raw, TooMany},
};
pub use self::{
    apart::tested,
    fillet::fillet,
    proof::{Deviation, deviation},
};
use super::contour::LevelSetError;
use crate::{
    geom::{Placement, Surface, Tolerance, sides},
    kernel::{
        brep::{
            Polyhedron,
            boolean::{self, BooleanError, Tree},
            crossing::crossing,
            measure::bounds,
            primitive,
        },
        field::Polyhedral,
    },
};

/// Why a solid cannot be grown or shrunk.
#[derive(Clone, Debug, Error)]
pub enum OffsetError {
    /// The distance is no number.
    #[error("an offset by {0} mm; it needs a finite distance")]
    NotFinite(f64),
    /// The surface needs too many triangles.
    #[error(
        "an offset this fine needs about {found:.0} corners; the limit is {limit}, which a tolerance of {fitting:.3e} mm meets"
    )]
    TooFine {
        /// Corners needed, about.
        found: f64,
        /// Corners allowed.
        limit: usize,
        /// A tolerance that fits, mm.
        fitting: f64,
    },
    /// Too many parts of the surface lie over each other.
    #[error(
        "the offset turns more than {limit} points of the solid over, whose pieces lie over each other"
    )]
    Crowded {
        /// Points allowed.
        limit: usize,
    },
    /// The set operation that frees the surface of its crossings failed.
    #[error(transparent)]
    Boolean(#[from] BooleanError),
    /// The level set that stands in for such a surface failed.
    #[error(transparent)]
    LevelSet(#[from] LevelSetError),
    /// The result is farther from the distance than the tolerance.
    #[error("the offset is off by {found:.3e} mm near ({}, {}, {}); the tolerance is {allowed} mm", .at.x, .at.y, .at.z)]
    Inexact {
        /// The largest deviation found, mm.
        found: f64,
        /// The tolerance, mm.
        allowed: f64,
        /// Where, mm.
        at: DVec3,
    },
}

/// Shares of the tolerance: what chords may be off their arcs, and what mitred faces and arcs of rims may be
/// off.
const CHORDS: f64 = 0.96;
const JOINTS: f64 = 0.2;

/// The points at most `by` mm from a solid; for a negative `by` the points of the solid at least so far from
/// its boundary. Curved parts of the result are chords within `tolerance` of the true surface; the solid is
/// taken as it is, facets and all. Empty if nothing is left.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{convert::offset::offset, geom::Tolerance};
/// use katachi::kernel::brep::{measure::volume, primitive::cuboid};
/// let block = cuboid(DVec3::ZERO, dvec3(10.0, 20.0, 30.0));
/// let grown = offset(&block, 2.0, Tolerance::new(0.005).unwrap()).unwrap();
/// assert!((volume(&grown) - 11187.49).abs() < 4.0);
/// let shrunk = offset(&block, -2.0, Tolerance::DEFAULT).unwrap();
/// assert!((volume(&shrunk) - 6.0 * 16.0 * 26.0).abs() < 1e-9);
/// assert!(offset(&block, -6.0, Tolerance::DEFAULT).unwrap().is_empty());
/// ```
pub fn offset(
    solid: &Polyhedron,
    by: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    offset_before(solid, by, 0.0, tolerance)
}

/// An offset that is followed by another one by `next` mm: arcs are such that the area they enclose is right when
/// that is done.
fn offset_before(
    solid: &Polyhedron,
    by: f64,
    next: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    if !by.is_finite() {
        return Err(OffsetError::NotFinite(by));
    }
    if by == 0.0 || solid.is_empty() {
        return Ok(solid.clone());
    }
    if is_thinner(solid, -2.0 * by) {
        return Ok(Polyhedron::empty());
    }
    // What is made of pieces is exact and has few triangles; what is too much for that is contoured.
    // Errors of chords and joints may add up: then once more, finer.
    let mut finer = tolerance;
    for _ in 0..TRIES {
        match offset_once(solid, by, next, [finer, tolerance]) {
            Err(OffsetError::Inexact { .. }) => finer = finer.half(),
            Err(OffsetError::Crowded { .. } | OffsetError::Boolean(_)) => break,
            done => return done,
        }
    }
    apart(solid, by, tolerance)
}

/// Whether no ball of a diameter fits between the faces of the box around a solid.
fn is_thinner(solid: &Polyhedron, diameter: f64) -> bool {
    let thinnest = bounds(solid).map_or(0.0, |[low, high]| (high - low).min_element());
    diameter > thinnest
}

/// How often an offset is made, each time with half of the tolerance.
const TRIES: usize = 3;

/// An offset made with one tolerance and held against another.
fn offset_once(
    solid: &Polyhedron,
    by: f64,
    next: f64,
    [made, allowed]: [Tolerance; 2],
) -> Result<Polyhedron, OffsetError> {
    // Chords over angles 2 a touch the arc of the last radius r with its area at r (1 - a^2 / 6), and meet at the
    // radius of this step after a^2 / 2 more.
    let bulge = 1.5 - 0.5 * ((by + next) / by).clamp(0.0, 1.0);
    let whole = Measure { bulge, ..measure(by, made) };
    let attempt = |measure: Measure| {
        let grown = uncrossed(raw_surface(solid, by, measure, made)?)?;
        proved(solid, grown, by, allowed)
    };
    // Nothing is turned over, mostly. What shrinks onto the centres of its own spheres and cylinders falls
    // together as these do; only then is the surface made of pieces that lie over each other.
    match attempt(Measure { crowd: 0, ..whole }) {
        Err(OffsetError::Crowded { .. }) => {}
        done => return done,
    }
    if is_round(solid)
        && let Ok(done) = attempt(Measure { curved: true, ..whole })
    {
        return Ok(done);
    }
    attempt(whole)
}

/// Whether facets of a solid stand for spheres or cylinders.
fn is_round(solid: &Polyhedron) -> bool {
    let round = |s: &Surface| matches!(s, Surface::Sphere { .. } | Surface::Cylinder { .. });
    solid.mesh().origins().iter().any(|o| round(&o.surface))
}

/// A solid with its faces moved outwards by a distance (mm) and prolonged until they meet: convex edges stay
/// sharp, unless they have to be round next to what is not simple.
fn extended(solid: &Polyhedron, by: f64, tolerance: Tolerance) -> Result<Polyhedron, OffsetError> {
    if by == 0.0 || solid.is_empty() {
        return Ok(solid.clone());
    }
    let measure = Measure { round: false, ..measure(by, tolerance) };
    match raw_surface(solid, by, measure, tolerance).and_then(uncrossed) {
        Err(OffsetError::Crowded { .. } | OffsetError::Boolean(_)) => offset(solid, by, tolerance),
        done => done,
    }
}

fn measure(by: f64, tolerance: Tolerance) -> Measure {
    let (radius, allowed) = (by.abs(), tolerance.mm());
    let (chord, joint) = (CHORDS * allowed / radius, JOINTS * allowed / radius);
    Measure { radius, round: true, curved: false, bulge: 1.0, crowd: surface::CROWD, chord, joint }
}

/// The surface at a distance from a solid, which may cross itself.
fn raw_surface(
    solid: &Polyhedron,
    by: f64,
    measure: Measure,
    tolerance: Tolerance,
) -> Result<Raw, OffsetError> {
    let refused = |many: TooMany| match many {
        TooMany::Turned => OffsetError::Crowded { limit: surface::CROWD },
        TooMany::Corners(found) => OffsetError::TooFine {
            found,
            limit: surface::CORNERS,
            // Caps have as many points as their area over the square of a chord.
            fitting: tolerance.mm() * found / surface::CORNERS as f64,
        },
    };
    if by > 0.0 {
        return surface::raw(solid.mesh(), measure).map_err(refused);
    }
    let mut inverse = solid.mesh().clone();
    inverse.flip();
    let mut raw = surface::raw(&inverse, measure).map_err(refused)?;
    raw.mesh.flip();
    Ok(raw)
}

/// Frees a surface of its crossings.
fn uncrossed(raw: Raw) -> Result<Polyhedron, OffsetError> {
    let crosses = raw.folded || crossing(&raw.mesh) != Ok(None);
    // Where points fell together the surface may be pinched.
    let pinched = |_| OffsetError::Crowded { limit: surface::CROWD };
    let surface = Polyhedron::new(raw.mesh).map_err(pinched)?;
    Ok(if crosses { boolean::self_union(&surface)?.solid } else { surface })
}

/// Looks whether an offset is where it should be, and adds what no cap covers.
fn proved(
    solid: &Polyhedron,
    mut grown: Polyhedron,
    by: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    let field = Polyhedral::new(solid.mesh()).expect("a solid that is not empty has a face");
    for _ in 0..ROUNDS {
        let Some(found) = deviation(grown.mesh(), &field, by) else { return Ok(grown) };
        if found.most <= tolerance.mm() {
            return Ok(grown);
        }
        let balls = missing(solid, grown.mesh(), &field, by, tolerance);
        if balls.is_empty() {
            return Err(OffsetError::Inexact {
                found: found.most,
                allowed: tolerance.mm(),
                at: found.at,
            });
        }
        grown = with_balls(grown, &balls, by, tolerance)?;
    }
    let found = deviation(grown.mesh(), &field, by);
    match found {
        Some(Deviation { most, at }) if most > tolerance.mm() => {
            Err(OffsetError::Inexact { found: most, allowed: tolerance.mm(), at })
        }
        _ => Ok(grown),
    }
}

/// How often balls are added about points that no cap covers.
const ROUNDS: usize = 4;

/// A solid with balls added, or for a negative distance taken away.
fn with_balls(
    solid: Polyhedron,
    centers: &[DVec3],
    by: f64,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    let ball = Arc::new(primitive::sphere(by.abs(), sides::sphere(by.abs(), tolerance)));
    let at =
        |c: &DVec3| Tree::Placed(Placement::translation(*c), Box::new(Tree::Leaf(ball.clone())));
    let trees = [Tree::Leaf(Arc::new(solid))].into_iter().chain(centers.iter().map(at)).collect();
    let tree = if by > 0.0 { Tree::Union(trees) } else { Tree::Difference(trees) };
    Ok(boolean::evaluate(&tree)?.solid)
}

/// A solid grown (all radii positive) or shrunk (all negative) by an ellipsoid with its radii along the axes,
/// mm: space is scaled so that the ellipsoid is the unit ball, and back.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::{convert::offset::by_ellipsoid, geom::Tolerance};
/// use katachi::kernel::brep::{measure::bounds, primitive::cuboid};
/// let cube = cuboid(DVec3::ZERO, DVec3::splat(4.0));
/// let grown = by_ellipsoid(&cube, dvec3(1.0, 2.0, 0.5), Tolerance::DEFAULT).unwrap();
/// assert_eq!(bounds(&grown), Some([dvec3(-1.0, -2.0, -0.5), dvec3(5.0, 6.0, 4.5)]));
/// ```
pub fn by_ellipsoid(
    solid: &Polyhedron,
    radii: DVec3,
    tolerance: Tolerance,
) -> Result<Polyhedron, OffsetError> {
    let sizes = radii.abs();
    let scale = |by: DVec3| Placement::new(DMat3::from_diagonal(by), DVec3::ZERO);
    let (sign, largest) = (radii.x.signum(), sizes.max_element());
    if !sizes.is_finite() || sizes.min_element() <= 0.0 {
        return Err(OffsetError::NotFinite(sizes.min_element()));
    }
    // The largest radius keeps its length, so that tolerances keep theirs.
    let shape = sizes / largest;
    let fine = tolerance;
    let ball = offset(&solid.placed(&scale(shape.recip())), sign * largest, fine)?;
    Ok(ball.placed(&scale(shape)))
}
