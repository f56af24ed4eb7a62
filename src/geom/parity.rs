//! Parity of a ray: a point is inside a closed surface when a ray from it meets an odd number of triangles.
//! The ray runs along +z; every decision is an exact sign.

use glam::{DVec2, DVec3};

use super::orient::{orient2d, orient3d};

/// Whether a point lies straight below a triangle (not on it). Under the triangle's outline the point counts
/// as moved by a little in x and much less in y, so that of the triangles around a corner the right number
/// is met.
///
/// ```
/// use glam::{DVec3, dvec3};
/// use katachi::geom::parity::is_below;
/// let corner = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// assert!(is_below(dvec3(0.2, 0.2, -5.0), corner) && !is_below(dvec3(0.2, 0.2, 5.0), corner));
/// ```
pub fn is_below(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let side = |u: DVec3, v: DVec3| left_of(u.truncate(), v.truncate(), p.truncate());
    let turns = [side(a, b), side(b, c), side(c, a)];
    let up = turns == [true; 3];
    let down = turns == [false; 3];
    let height = orient3d(a, b, c, p);
    (up && height > 0.0) || (down && height < 0.0)
}

fn left_of(a: DVec2, b: DVec2, p: DVec2) -> bool {
    let turn = orient2d(a, b, p);
    if turn != 0.0 {
        turn > 0.0
    } else if a.y != b.y {
        a.y > b.y
    } else {
        b.x > a.x
    }
}
