//! Planes that keep faces apart: a quick proof that two faces of a surface do not cross.
//!
//! However a face is cut into triangles, they lie in the hull of its corners. So two faces cannot cross if a
//! plane has the corners of one on one side and those of the other on the other side, and the corners that
//! they share in it. Such a plane is guessed and then verified by signs that doubles tell for certain.
//!
//! Nor do they cross if one of them stands on the other at the corners that they share, see [`Hull::carries`].
//!
//! What is not proved here may still be sound: triangles tell ([`super::crossing`]).

use glam::{DVec2, DVec3, Vec2Swizzles};

use crate::geom::{FaceRef, PolyMesh, orient::orient2d};

/// Faces with more corners are not looked at: their hulls say little.
const MANY: usize = 1000;

/// With more corners the middle of a face is as good as the middle direction to its corners.
const SOME: usize = 12;

/// With more corners it is not looked for how near they come to each other.
const FEW: usize = 8;

/// The edges of a face with more corners are not compared with each other.
const SIMPLE: usize = 48;

/// How many times more than nothing the clearance must be, with room for what the argument leaves out.
const ROOM: f64 = 64.0;

/// Relative error of a product of three differences summed over the axes: a dozen roundings at most.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The plane through three places, for a filter of signs.
pub(super) struct Slope {
    normal: DVec3,
    /// How wrong a height may be, relative to the sum of the coordinates of the place.
    error: f64,
}

impl Slope {
    /// The plane through three places.
    pub fn of([a, b, c]: &[DVec3; 3]) -> Slope {
        let (p, q) = (*b - *a, *c - *a);
        let (r, s) = (p.abs(), q.abs());
        let terms = DVec3::new(r.y * s.z + r.z * s.y, r.z * s.x + r.x * s.z, r.x * s.y + r.y * s.x);
        Slope { normal: p.cross(q), error: terms.max_element() * ROUNDING }
    }

    /// The plane through a place across a direction, which is taken as it is.
    fn across(normal: DVec3) -> Slope {
        Slope { normal, error: normal.abs().max_element() * ROUNDING }
    }

    /// The height of a place, given from a place in the plane, and how wrong it may be.
    fn height(&self, at: DVec3) -> (f64, f64) {
        (self.normal.dot(at), self.error * (at.x.abs() + at.y.abs() + at.z.abs()))
    }

    /// The height of a place, given from the first one, if its sign is certain.
    pub fn side(&self, at: DVec3) -> Option<f64> {
        let (height, error) = self.height(at);
        (height.abs() > error).then_some(height)
    }
}

/// A face with few corners in one loop.
pub(super) struct Hull<'a> {
    corners: &'a [u32],
    points: &'a [DVec3],
    /// A direction of length 1 across it, nearly.
    normal: DVec3,
    /// No corner is lower or higher along the normal than this from the first one.
    heights: (f64, f64),
    /// No two corners are farther apart along the normal.
    flatness: f64,
    /// The middle of the corners.
    middle: DVec3,
    /// No two corners are farther apart.
    reach: f64,
    /// No corner is nearer to a segment between two others; 0 if that is not known.
    clearance: f64,
    /// Whether its triangles are known not to cross each other.
    is_simple: bool,
}

impl<'a> Hull<'a> {
    /// The hull of a face; `None` if it has holes or many corners, or no area.
    pub fn of(mesh: &'a PolyMesh, face: FaceRef<'a>) -> Option<Hull<'a>> {
        let (corners, points) = (face.outer(), &mesh.points[..]);
        if corners.len() > MANY || face.loops().nth(1).is_some() {
            return None;
        }
        let at = |i: usize| points[corners[i] as usize] - points[corners[0] as usize];
        let area = (1..corners.len() - 1).map(|i| at(i).cross(at(i + 1))).sum::<DVec3>();
        let normal = area.try_normalize()?;
        let slope = Slope::across(normal);
        let (mut low, mut high, mut reach, mut sum) = (0.0f64, 0.0f64, 0.0f64, DVec3::ZERO);
        for i in 1..corners.len() {
            let (height, error) = slope.height(at(i));
            (low, high) = (low.min(height - error), high.max(height + error));
            reach = reach.max(2.0 * at(i).length());
            sum += at(i);
        }
        let mut hull = Hull {
            corners,
            points,
            normal,
            heights: (low, high),
            flatness: 2.0 * high.max(-low),
            middle: points[corners[0] as usize] + sum / corners.len() as f64,
            reach,
            clearance: 0.0,
            is_simple: false,
        };
        let outline = hull.outline();
        hull.is_simple = is_seen_whole(&outline) || is_simple(&outline);
        if hull.is_simple && corners.len() <= FEW {
            hull.clearance = hull.least_distance();
        }
        Some(hull)
    }

    /// Whether triangles of it are known not to cross each other.
    pub fn is_simple(&self) -> bool {
        self.is_simple
    }

    /// How near a corner comes to a segment between two others.
    fn least_distance(&self) -> f64 {
        let mut least = f64::INFINITY;
        for (i, &a) in self.corners.iter().enumerate() {
            for &b in &self.corners[i + 1..] {
                let (from, along) = (self.at(a), self.at(b) - self.at(a));
                let length = along.length_squared();
                for &c in self.corners.iter().filter(|&&c| c != a && c != b) {
                    let to = self.at(c) - from;
                    let share = (to.dot(along) / length).clamp(0.0, 1.0);
                    least = least.min((to - along * share).length_squared());
                }
            }
        }
        least.sqrt()
    }

    fn at(&self, corner: u32) -> DVec3 {
        self.points[corner as usize]
    }

    /// The corners without the coordinate along which the normal is longest, counter-clockwise.
    fn outline(&self) -> Vec<DVec2> {
        let (size, all) = (self.normal.abs(), self.corners.iter().map(|&c| self.at(c)));
        let (mut outline, normal): (Vec<DVec2>, f64) = if size.z >= size.x.max(size.y) {
            (all.map(|p| DVec2::new(p.x, p.y)).collect(), self.normal.z)
        } else if size.y > size.x {
            (all.map(|p| DVec2::new(p.z, p.x)).collect(), self.normal.y)
        } else {
            (all.map(|p| DVec2::new(p.y, p.z)).collect(), self.normal.x)
        };
        if normal < 0.0 {
            outline.iter_mut().for_each(|p| *p = p.yx());
        }
        outline
    }

    /// Whether a plane is found that keeps two faces apart.
    pub fn is_apart(&self, other: &Hull<'_>) -> bool {
        let mut shared = [0; 3];
        let mut count = 0;
        for &corner in self.corners.iter().filter(|c| other.corners.contains(c)) {
            if count == 3 {
                return false;
            }
            shared[count] = corner;
            count += 1;
        }
        match shared[..count] {
            [] if self.corners.len() < other.corners.len() => {
                self.is_above_or_below(other) || other.is_above_or_below(self)
            }
            [] => other.is_above_or_below(self) || self.is_above_or_below(other),
            [a] => self.carry_each_other(other, &[a]) || self.part_at(other, a),
            [a, b] => self.carry_each_other(other, &[a, b]) || self.part_along(other, (a, b)),
            _ => false,
        }
    }

    fn carry_each_other(&self, other: &Hull<'_>, shared: &[u32]) -> bool {
        self.carries(other, shared) || other.carries(self, shared)
    }

    /// Whether another face stands on this one at a shared corner or along an edge between two, so that they
    /// cannot cross: it has all other corners at heights of at least h on one side.
    ///
    /// This face is within m of its plane, and all is of size R. So the other one can cross it only within
    /// 2 m R / h of what they share. Triangles of this face that do not have that are at least the clearance c
    /// away. For one that has it, at a share s of its size from the shared corner v, the two are s m apart at
    /// most; so the other face's triangle is there at a share of at most about s m R / (h c) of its free
    /// corner, which takes it no more than that times R away from the shared edge; but this face's triangle is
    /// by s c c / R away from it. So they do not meet if h c c c > 2 m R R R, with room for the rest.
    ///
    /// A diagonal of this face between the two shared corners will not do: triangles that do not have it may lie
    /// on both sides of it.
    fn carries(&self, other: &Hull<'_>, shared: &[u32]) -> bool {
        if let &[a, b] = shared
            && !self.has_edge(a, b)
        {
            return false;
        }
        let (slope, base) = (Slope::across(self.normal), self.at(shared[0]));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &corner in other.corners.iter().filter(|c| !shared.contains(c)) {
            let (height, error) = slope.height(self.at(corner) - base);
            (low, high) = (low.min(height - error), high.max(height + error));
        }
        let height = low.max(-high);
        let reach = self.reach.max(other.reach);
        height * self.clearance.powi(3) > ROOM * self.flatness * reach.powi(3)
    }

    /// Whether two of its corners are neighbours.
    fn has_edge(&self, a: u32, b: u32) -> bool {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).any(|(&c, &d)| (c, d) == (a, b) || (d, c) == (a, b))
    }

    /// Whether all corners are higher, or all are lower, than those of another face along its normal.
    fn is_above_or_below(&self, other: &Hull<'_>) -> bool {
        let (slope, base) = (Slope::across(other.normal), self.at(other.corners[0]));
        let heights = |corner: &u32| slope.height(self.at(*corner) - base);
        let (low, high) = other.heights;
        self.corners.iter().map(heights).all(|(height, error)| height - error > high)
            || self.corners.iter().map(heights).all(|(height, error)| height + error < low)
    }

    /// The middle direction from a corner to the others.
    fn inward(&self, from: DVec3) -> DVec3 {
        if self.corners.len() > SOME {
            return self.middle - from;
        }
        self.corners.iter().map(|&c| (self.at(c) - from).normalize_or_zero()).sum()
    }

    /// Whether a plane through a shared corner is found that keeps two faces apart.
    fn part_at(&self, other: &Hull<'_>, corner: u32) -> bool {
        let base = self.at(corner);
        let [own, others] = [self, other].map(|h| h.inward(base).normalize_or_zero());
        self.is_parted(other, (Slope::across(others - own), base), &[corner])
    }

    /// Whether a plane through a shared edge is found that keeps two faces apart.
    fn part_along(&self, other: &Hull<'_>, (a, b): (u32, u32)) -> bool {
        let base = self.at(a);
        let edge = self.at(b) - base;
        let across = |hull: &Hull<'_>| {
            let inward = hull.inward(base);
            (inward - edge * (inward.dot(edge) / edge.length_squared())).normalize_or_zero()
        };
        let third = base + edge.cross(across(other) - across(self));
        let slope = Slope::of(&[base, self.at(b), third]);
        self.is_parted(other, (slope, base), &[a, b])
    }

    /// Whether a plane has all corners of one face, but those in it, on one side, and those of the other on
    /// the other side.
    fn is_parted(&self, other: &Hull<'_>, (slope, base): (Slope, DVec3), within: &[u32]) -> bool {
        let all = |hull: &Hull<'_>, sign: f64| {
            let mut free = hull.corners.iter().filter(|c| !within.contains(c));
            free.all(|&c| slope.side(self.at(c) - base).is_some_and(|height| height * sign > 0.0))
        };
        (all(self, -1.0) && all(other, 1.0)) || (all(self, 1.0) && all(other, -1.0))
    }
}

/// Whether a polygon is seen whole, within less than half a turn, from one of its corners, so that it does not
/// cross itself.
fn is_seen_whole(outline: &[DVec2]) -> bool {
    let count = outline.len();
    (0..if count == 3 { 1 } else { count }).any(|from| {
        let at = |k: usize| outline[if from + k < count { from + k } else { from + k - count }];
        let turns = |i: usize, j: usize| orient2d(at(0), at(i), at(j)) > 0.0;
        (2..count).all(|k| turns(k - 1, k) && turns(1, k))
    })
}

/// Whether edges of a polygon with few corners meet nowhere but at the corner between two, and its inside is to
/// their left. However such a polygon is cut into triangles, they have no area in common.
fn is_simple(outline: &[DVec2]) -> bool {
    let count = outline.len();
    if count > SIMPLE {
        return false;
    }
    let at = |k: usize| outline[if k < count { k } else { k - count }];
    let are_apart = |i: usize, j: usize| is_beside([at(i), at(i + 1)], [at(j), at(j + 1)]);
    let goes_on = |k: usize| {
        let [a, b, c] = [at(k), at(k + 1), at(k + 2)];
        orient2d(a, b, c) != 0.0
            || (precedes(a, b) && precedes(b, c))
            || (precedes(b, a) && precedes(c, b))
    };
    // The first and the last edge are neighbours too.
    let others = |i: usize| i + 2..if i == 0 { count - 1 } else { count };
    let first = (1..count).fold(0, |k, i| if precedes(at(i), at(k)) { i } else { k });
    orient2d(at(first + count - 1), at(first), at(first + 1)) > 0.0
        && (0..count).all(|i| goes_on(i) && others(i).all(|j| are_apart(i, j)))
}

/// Whether two segments are told to have no point in common: by their boxes, or by the line of one of them.
fn is_beside([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let is_far = a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any();
    let parts = |p: DVec2, q: DVec2, r: DVec2, s: DVec2| {
        let (one, other) = (orient2d(p, q, r), orient2d(p, q, s));
        (one > 0.0 && other > 0.0) || (one < 0.0 && other < 0.0)
    };
    is_far || parts(a, b, c, d) || parts(c, d, a, b)
}

/// Whether a place is left of another, or below it.
fn precedes(a: DVec2, b: DVec2) -> bool {
    a.x < b.x || (a.x == b.x && a.y < b.y)
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::geom::{Origin, Surface};
    use crate::kernel::brep::primitive::sphere;

    /// The hulls of all faces of a ball.
    #[test]
    fn faces_of_a_ball_are_apart() {
        let ball = sphere(5.0, 24);
        let mesh = ball.mesh();
        let hulls: Vec<Hull<'_>> = mesh.faces().filter_map(|f| Hull::of(mesh, f)).collect();
        for (i, a) in hulls.iter().enumerate() {
            assert!(a.is_simple());
            for b in &hulls[i + 1..] {
                assert!(a.is_apart(b) && b.is_apart(a), "{:?} {:?}", a.corners, b.corners);
            }
        }
    }

    /// A quadrilateral with a triangle on its diagonal: rounding decides whether the edge is above it.
    #[test]
    fn a_face_does_not_stand_on_a_diagonal() {
        let corners = [
            dvec3(0., 0., 0.),
            dvec3(1., 0., 0.),
            dvec3(1., 1., 0.),
            dvec3(0., 1., 1e-16),
            dvec3(0.5, 0.5, 1.),
        ];
        let mut mesh = PolyMesh::with_points(corners.to_vec());
        let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
        mesh.push_face(&[[0, 1, 2, 3]], plane, origin);
        mesh.push_face(&[[0, 2, 4]], plane, origin);
        mesh.push_face(&[[0, 1, 4]], plane, origin);
        let [floor, across, beside] =
            [0, 1, 2].map(|face| Hull::of(&mesh, mesh.face(face)).expect("a hull"));
        assert!(!floor.is_apart(&across) && !across.is_apart(&floor));
        assert!(floor.is_apart(&beside) && beside.is_apart(&floor));
    }

    #[test]
    fn faces_that_cross_are_not_apart() {
        let corners = [
            dvec3(0., 0., 0.),
            dvec3(4., 0., 0.),
            dvec3(0., 4., 0.),
            dvec3(1., 1., -1.),
            dvec3(1., 1., 1.),
            dvec3(5., 5., 0.),
        ];
        let mut mesh = PolyMesh::with_points(corners.to_vec());
        let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
        for face in [[0, 1, 2], [3, 4, 5], [0, 3, 4], [0, 1, 5]] {
            mesh.push_face(&[&face], plane, origin);
        }
        mesh.push_face(&[&[0, 1, 2, 5]], plane, origin);
        let hull = |face: usize| Hull::of(&mesh, mesh.face(face)).expect("a hull");
        for (a, b) in [(0, 1), (0, 2), (0, 3)] {
            assert!(!hull(a).is_apart(&hull(b)), "{a} {b}");
        }
        assert!(hull(0).is_simple() && !hull(4).is_simple());
    }

    #[test]
    fn edges_tell_what_is_simple() {
        let is_simple = |corners: &[[f64; 2]]| {
            let outline: Vec<DVec2> = corners.iter().map(|&c| DVec2::from(c)).collect();
            let turned = |by: usize| [&outline[by..], &outline[..by]].concat();
            let found = is_simple(&outline);
            assert!((0..outline.len()).all(|by| is_simple(&turned(by)) == found));
            found
        };
        let comb = [[0., 0.], [5., 0.], [5., 3.], [4., 3.], [4., 1.], [1., 1.], [1., 3.], [0., 3.]];
        assert!(is_simple(&comb));
        let straight = [[0., 0.], [1., 0.], [2., 0.], [2., 2.], [1., 1.], [0., 2.]];
        assert!(is_simple(&straight));
        let mut back = comb;
        back.reverse();
        assert!(!is_simple(&back));
        let crossing = [[0., 0.], [4., 0.], [4., 4.], [2., -1.], [0., 4.]];
        assert!(!is_simple(&crossing));
        let touching = [[0., 0.], [4., 0.], [4., 4.], [2., 0.], [0., 4.]];
        assert!(!is_simple(&touching));
        let spike = [[0., 0.], [4., 0.], [2., 0.], [2., 4.], [0., 4.]];
        assert!(!is_simple(&spike));
        let double = [[0., 0.], [4., 0.], [4., 0.], [4., 4.], [0., 4.]];
        assert!(!is_simple(&double));
        let twice = [[0., 0.], [2., 0.], [2., 2.], [0., 0.], [2., 0.], [2., 2.]];
        assert!(!is_simple(&twice));
    }
}
