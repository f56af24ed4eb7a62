//! Where a closed surface crosses or covers itself.

use glam::{DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};
use thiserror::Error;

use super::{
    Polyhedron,
    separation::{Hull, Slope},
    threads,
};
use crate::geom::{
    Bounds, PolyMesh,
    bvh::Bvh,
    orient::{orient2d, orient3d},
    triangulate::{Triangles, triangulate, triangulate_face},
};

type Triangle = [DVec3; 3];

/// What rounding makes of a corner in a plane: a few units in the last place of its coordinates.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Pairs of triangles that are compared at most to find one that crosses: some seconds. Of 2 million facets that stand side
/// by side some 20 million pairs have boxes that meet.
pub const MOST_COMPARED: usize = 50_000_000;

/// Pairs of triangles that are compared, and those of them that cross, at most where a surface is to be freed of its
/// crossings.
pub const MOST_UNITED: [usize; 2] = [10_000_000, 200_000];

/// A surface whose crossings are not looked for to the end.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum Tangled {
    /// Boxes of triangles meet at too many places.
    #[error(
        "of its {triangles} triangles more than {limit} pairs lie so near one another that they would have to be compared"
    )]
    Near {
        /// All triangles.
        triangles: usize,
        /// The limit.
        limit: usize,
    },
    /// Too many cross.
    #[error("of its {triangles} triangles more than {limit} pairs cross; so many are not united")]
    Crossing {
        /// All triangles.
        triangles: usize,
        /// The limit.
        limit: usize,
    },
}

/// A place in mm where the boundary of a solid passes through itself or lies on itself; `None` if it does
/// nowhere. Decided by exact signs. Triangles that share a corner are not compared; shells that share an edge
/// or a corner do not cross, one that stands on a face with an edge counts as crossing. Fails after
/// [`MOST_COMPARED`] pairs without a crossing.
///
/// ```
/// use glam::DVec3;
/// use katachi::kernel::brep::{crossing::crossing, primitive::cuboid};
/// let mut two = cuboid(DVec3::ZERO, DVec3::splat(2.0)).into_mesh();
/// assert_eq!(crossing(&two), Ok(None));
/// two.append(cuboid(DVec3::ONE, DVec3::new(3.0, 3.5, 4.0)).mesh());
/// assert!(crossing(&two).is_ok_and(|at| at.is_some()));
/// ```
pub fn crossing(mesh: &PolyMesh) -> Result<Option<DVec3>, Tangled> {
    let soup = Soup::of(mesh);
    let found = soup.cross_until(MOST_COMPARED, 1)?;
    Ok(found.first().map(|[i, j]| soup.place(*i, *j)))
}

/// Whether the boundary of a solid meets itself as [`crossing`] tells, and so little that it can be freed of it. Fails
/// beyond [`MOST_UNITED`].
pub(super) fn is_crossed(mesh: &PolyMesh) -> Result<bool, Tangled> {
    let soup = Soup::of(mesh);
    let [compared, crossing] = MOST_UNITED;
    let found = soup.cross_until(compared, crossing + 1)?.len();
    match found > crossing {
        true => Err(Tangled::Crossing { triangles: soup.indices.len(), limit: crossing }),
        false => Ok(found > 0),
    }
}

/// A place in mm for every two triangles of the boundary that pass through each other or lie on each other,
/// those that share a corner or an edge not left out; in a fixed order. A solid that stands on a face with an
/// edge or a corner, as exactly as coordinates can say, touches it there and does not cross it.
///
/// ```
/// use glam::DVec3;
/// use katachi::kernel::brep::{crossing::crossings, primitive::cuboid};
/// let mut two = cuboid(DVec3::ZERO, DVec3::splat(2.0)).into_mesh();
/// assert_eq!(crossings(&two).len(), 0);
/// two.append(cuboid(DVec3::ONE, DVec3::new(3.0, 3.5, 4.0)).mesh());
/// assert_eq!(crossings(&two).len(), 9); // of the six pairs of faces that cross, three are cut by a diagonal
/// ```
pub fn crossings(mesh: &PolyMesh) -> Vec<DVec3> {
    let soup = Soup::of(mesh);
    let mut pairs = vec![];
    Bvh::new(&soup.boxes).self_pairs(|i, j| pairs.push([i, j]));
    soup.crossings(&pairs).into_iter().map(|[i, j]| soup.place(i, j)).collect()
}

/// Pairs of faces, at least one of them suspected, that cross or lie on each other, and a place in mm where
/// two do.
pub(super) struct Tangle {
    /// The faces.
    pub faces: Vec<[u32; 2]>,
    /// The place.
    pub place: DVec3,
}

/// What the suspected faces of a mesh cross among its first `count` faces; `None` if nothing.
pub(super) fn tangle(mesh: &PolyMesh, count: usize, suspects: &[u32]) -> Option<Tangle> {
    if suspects.is_empty() {
        return None;
    }
    let open = unproved(mesh, count, suspects);
    let mut soup = Soup::of_faces(mesh, &unique(open.iter().flatten().copied()));
    let mut found = soup.meeting_of_faces(&open);
    if found.is_empty() {
        return None;
    }
    soup.add_around(&found, mesh, count);
    soup.drop_touching(&mut found);
    let &[i, j] = found.first()?;
    let faces = found.iter().map(|pair| pair.map(|t| soup.owners[t as usize])).collect();
    Some(Tangle { faces, place: soup.place(i, j) })
}

/// The faces in a list, each once, in order.
fn unique(faces: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut faces: Vec<u32> = faces.collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// The pairs of faces among the first `count`, at least one of them suspected, whose boxes meet and that are
/// not [kept apart](Hull::is_apart) for certain; a suspected face that may cross itself is a pair for itself.
fn unproved(mesh: &PolyMesh, count: usize, suspects: &[u32]) -> Vec<[u32; 2]> {
    let hulls = spread(suspects, |&face| [hull(mesh, face)]);
    let boxes: Vec<Bounds> = suspects.iter().map(|&face| bounds(mesh, face)).collect();
    let hierarchy = Bvh::new(&boxes);
    let mut near = vec![];
    hierarchy.self_pairs(|i, j| near.push([i, j]));
    let mut open = spread(&near, |pair| {
        let [f, g] = pair.map(|i| &hulls[i as usize]);
        (!are_kept_apart(f, g)).then(|| pair.map(|i| suspects[i as usize]))
    });
    let may_cross_itself = |hull: &Option<Hull<'_>>| !hull.as_ref().is_some_and(Hull::is_simple);
    let themselves = suspects.iter().zip(&hulls).filter(|(_, hull)| may_cross_itself(hull));
    open.extend(themselves.map(|(&face, _)| [face; 2]));
    open.extend(spread(&rest(count, suspects), |&face| {
        let (mut own, mut open) = (None, vec![]);
        hierarchy.visit(&bounds(mesh, face), |i| {
            let own = own.get_or_insert_with(|| hull(mesh, face));
            if !are_kept_apart(own, &hulls[i as usize]) {
                open.push([face, suspects[i as usize]]);
            }
        });
        open
    }));
    open.iter_mut().for_each(|pair| pair.sort_unstable());
    open.sort_unstable();
    open
}

fn hull(mesh: &PolyMesh, face: u32) -> Option<Hull<'_>> {
    Hull::of(mesh, mesh.face(face as usize))
}

fn bounds(mesh: &PolyMesh, face: u32) -> Bounds {
    let corners = mesh.face(face as usize).loops().flatten();
    Bounds::of(corners.map(|&c| mesh.points[c as usize]))
}

fn are_kept_apart(f: &Option<Hull<'_>>, g: &Option<Hull<'_>>) -> bool {
    f.as_ref().zip(g.as_ref()).is_some_and(|(f, g)| f.is_apart(g))
}

/// Those of the first `count` faces that are not in a list.
fn rest(count: usize, list: &[u32]) -> Vec<u32> {
    let mut is_listed = vec![false; count];
    list.iter().for_each(|&face| is_listed[face as usize] = true);
    (0..count as u32).filter(|&face| !is_listed[face as usize]).collect()
}

/// So many pairs of triangles of two faces are looked at one by one.
const TOGETHER: usize = 4096;

/// Items that one thread looks at together.
const CHUNK: usize = 256;

/// What is found for all items of a list, in order, by all threads if the list is long.
fn spread<T: Sync, R: Send, I: IntoIterator<Item = R>>(
    list: &[T],
    find: impl Fn(&T) -> I + Sync,
) -> Vec<R> {
    let all = |part: &[T]| part.iter().flat_map(&find).collect::<Vec<R>>();
    threads::parts(list, CHUNK, all).into_iter().flatten().collect()
}

/// The triangles of a mesh, or of some of its faces.
struct Soup<'a> {
    points: &'a [DVec3],
    indices: Vec<[u32; 3]>,
    /// The face of each.
    owners: Vec<u32>,
    corners: Vec<Triangle>,
    planes: Vec<Slope>,
    boxes: Vec<Bounds>,
}

impl Soup<'_> {
    fn of(mesh: &PolyMesh) -> Soup<'_> {
        let Triangles { corners, face } = triangulate(mesh);
        let mut soup = Soup::empty(mesh);
        (soup.indices, soup.owners) = (corners, face);
        soup.locate();
        soup
    }

    fn empty(mesh: &PolyMesh) -> Soup<'_> {
        let (indices, owners, corners) = (vec![], vec![], vec![]);
        Soup { points: &mesh.points, indices, owners, corners, planes: vec![], boxes: vec![] }
    }

    /// The triangles of some faces.
    fn of_faces<'a>(mesh: &'a PolyMesh, faces: &[u32]) -> Soup<'a> {
        let mut soup = Soup::empty(mesh);
        soup.append(mesh, faces);
        soup
    }

    /// Adds the triangles of some faces.
    fn append(&mut self, mesh: &PolyMesh, faces: &[u32]) {
        let triangles = spread(faces, |&face| {
            let loops: Vec<&[u32]> = mesh.face(face as usize).loops().collect();
            let mut triangles = vec![];
            triangulate_face(&mesh.points, &loops, &mut triangles);
            triangles.into_iter().map(move |corners| (corners, face))
        });
        self.indices.extend(triangles.iter().map(|t| t.0));
        self.owners.extend(triangles.iter().map(|t| t.1));
        self.locate();
    }

    /// Adds the triangles of the faces, among the first `count`, at corners of some triangles.
    fn add_around(&mut self, pairs: &[[u32; 2]], mesh: &PolyMesh, count: usize) {
        let corners = pairs.iter().flatten().flat_map(|&t| self.indices[t as usize]);
        let corners: FxHashSet<u32> = corners.collect();
        let known: FxHashSet<u32> = self.owners.iter().copied().collect();
        let is_around = |face: &u32| {
            let mut all = mesh.face(*face as usize).loops().flatten();
            !known.contains(face) && all.any(|corner| corners.contains(corner))
        };
        let around: Vec<u32> = (0..count as u32).filter(is_around).collect();
        self.append(mesh, &around);
    }

    /// Finds the places of triangles that have none yet.
    fn locate(&mut self) {
        let from = self.corners.len();
        let places = self.indices[from..].iter().map(|t| t.map(|c| self.points[c as usize]));
        self.corners.extend(places);
        self.planes.extend(self.corners[from..].iter().map(Slope::of));
        self.boxes.extend(self.corners[from..].iter().map(|t| Bounds::of(*t)));
    }

    /// Pairs of triangles without a common corner that meet, until there are `enough`, of at most `most` that are
    /// compared.
    fn cross_until(&self, most: usize, enough: usize) -> Result<Vec<[u32; 2]>, Tangled> {
        let (mut compared, mut found) = (0, vec![]);
        Bvh::new(&self.boxes).find_pair(|i, j| {
            if self.shared(i, j) == 0 {
                compared += 1;
                if self.meet(i, j) {
                    found.push([i, j]);
                }
            }
            compared > most || found.len() >= enough
        });
        match compared > most && found.len() < enough {
            true => Err(Tangled::Near { triangles: self.indices.len(), limit: most }),
            false => Ok(found),
        }
    }

    /// How many corners two triangles share.
    fn shared(&self, i: u32, j: u32) -> usize {
        let [a, b] = [i, j].map(|t| &self.indices[t as usize]);
        a.iter().filter(|corner| b.contains(corner)).count()
    }

    /// For each edge and each way along it the corner beyond the edge from the triangle that runs that way.
    fn beyond(&self) -> FxHashMap<[u32; 2], u32> {
        let sides = |t: &[u32; 3]| [0, 1, 2].map(|k| ([t[(k + 1) % 3], t[k]], t[(k + 2) % 3]));
        self.indices.iter().flat_map(sides).collect()
    }

    /// Those of the pairs of triangles that cross or cover each other and do not only touch.
    fn crossings(&self, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
        let mut found = self.meeting(pairs);
        self.drop_touching(&mut found);
        found
    }

    /// The pairs of triangles of some pairs of faces that [meet](Soup::meet). All triangles of a face are
    /// together, and the faces are in order.
    fn meeting_of_faces(&self, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
        let place = |face: u32| self.owners.partition_point(|&owner| owner < face) as u32;
        let ranges = spread(pairs, |pair| [pair.map(|face| place(face)..place(face + 1))]);
        let mut large = FxHashSet::default();
        let mut small = vec![];
        for (pair, [a, b]) in pairs.iter().zip(ranges) {
            match a.len() * b.len() > TOGETHER {
                true => _ = large.insert(*pair),
                false => small.push([a, b]),
            }
        }
        let mut found = spread(&small, |[a, b]| {
            let mut found = vec![];
            for i in a.clone() {
                for j in if a == b { i + 1..b.end } else { b.clone() } {
                    if self.are_near(i, j) && self.meet(i, j) {
                        found.push([i, j]);
                    }
                }
            }
            found
        });
        if !large.is_empty() {
            let faces: FxHashSet<u32> = large.iter().flatten().copied().collect();
            let all = 0..self.owners.len() as u32;
            let members = all.filter(|&t| faces.contains(&self.owners[t as usize]));
            let members: Vec<u32> = members.collect();
            let boxes: Vec<Bounds> = members.iter().map(|&t| self.boxes[t as usize]).collect();
            let mut near = vec![];
            Bvh::new(&boxes).self_pairs(|i, j| {
                let [i, j] = [i, j].map(|k| members[k as usize]);
                let [f, g] = [i, j].map(|t| self.owners[t as usize]);
                if large.contains(&[f.min(g), f.max(g)]) {
                    near.push([i, j]);
                }
            });
            found.extend(self.meeting(&near));
        }
        found
    }

    fn are_near(&self, i: u32, j: u32) -> bool {
        self.boxes[i as usize].meets(&self.boxes[j as usize])
    }

    /// Those of the pairs of triangles that [meet](Soup::meet).
    fn meeting(&self, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
        spread(pairs, |&[i, j]| self.meet(i, j).then_some([i, j]))
    }

    /// Leaves out the pairs of triangles that only touch.
    fn drop_touching(&self, pairs: &mut Vec<[u32; 2]>) {
        if !pairs.is_empty() {
            let beyond = self.beyond();
            pairs.retain(|&[i, j]| !self.touch(i, j, &beyond) && !self.touch(j, i, &beyond));
        }
    }

    /// Whether two triangles pass through each other, have area in common, or one has an edge on the other.
    /// What shared corners and a common face tell is not computed.
    fn meet(&self, i: u32, j: u32) -> bool {
        let [s, t] = [i, j].map(|k| &self.corners[k as usize]);
        if self.owners[i as usize] == self.owners[j as usize] && are_apart(s, t) {
            return false;
        }
        let of_t = self.sides(i, j);
        if is_beside(of_t) || (of_t != [0.0; 3] && self.shared(i, j) > 1) {
            return false;
        }
        if of_t == [0.0; 3] { overlap(s, t) } else { pass((s, self.sides(j, i)), (t, of_t)) }
    }

    /// On which side of the plane of triangle `i` the corners of `j` are.
    fn sides(&self, i: u32, j: u32) -> [f64; 3] {
        let (i, j) = (i as usize, j as usize);
        let (own, [a, b, c], plane) = (&self.indices[i], &self.corners[i], &self.planes[i]);
        std::array::from_fn(|k| {
            if own.contains(&self.indices[j][k]) {
                return 0.0;
            }
            let p = self.corners[j][k];
            plane.side(p - *a).map_or_else(|| orient3d(*a, *b, *c, p), |height| -height)
        })
    }

    /// Whether triangle `i` only stands on `j`, up to rounding of coordinates: with a corner in its plane, or
    /// with an edge and on the same side as the triangle beyond that edge.
    fn touch(&self, i: u32, j: u32, beyond: &FxHashMap<[u32; 2], u32>) -> bool {
        let (corners, [a, b, c]) = (self.indices[i as usize], self.corners[j as usize]);
        let reach = [a, b, c].iter().fold(0.0, |reach: f64, p| reach.max(p.abs().max_element()));
        let near = (b - a).cross(c - a).length() * reach * ROUNDING;
        let side = |corner: u32| {
            let height = orient3d(a, b, c, self.points[corner as usize]);
            if height.abs() <= near { 0.0 } else { height }
        };
        let sides = corners.map(side);
        let far = || sides.iter().filter(|s| **s != 0.0);
        match far().count() {
            2 => far().product::<f64>() > 0.0,
            1 => (0..3).any(|k| {
                let edge = [corners[k], corners[(k + 1) % 3]];
                let next = beyond.get(&edge).map_or(0.0, |&next| side(next));
                sides[(k + 2) % 3] * next > 0.0
            }),
            _ => false,
        }
    }

    /// The middle of what the boxes of two triangles have in common.
    fn place(&self, i: u32, j: u32) -> DVec3 {
        let [a, b] = [i, j].map(|t| &self.boxes[t as usize]);
        (a.min.max(b.min) + a.max.min(b.max)) / 2.0
    }
}

/// Whether a triangle with its corners on these sides of a plane has at most a corner in it.
fn is_beside(sides: [f64; 3]) -> bool {
    let [low, high] = [sides.iter().any(|v| *v < 0.0), sides.iter().any(|v| *v > 0.0)];
    low != high && sides.iter().filter(|v| **v == 0.0).count() < 2
}

/// Whether two triangles in two planes, each with the sides of the other's plane that its corners are on,
/// pass through each other or one has an edge on the other.
fn pass((s, of_s): (&Triangle, [f64; 3]), (t, of_t): (&Triangle, [f64; 3])) -> bool {
    match (apex(s, of_s), apex(t, of_t)) {
        (Some(s), Some(t)) => straddle(&s, &t),
        (None, Some(_)) => rests(s, of_s, t),
        (Some(_), None) => rests(t, of_t, s),
        (None, None) => false,
    }
}

/// The triangle turned so that its first corner is alone on its side of a plane; `None` if the plane does
/// not separate its corners.
fn apex(t: &Triangle, sides: [f64; 3]) -> Option<Triangle> {
    let separated = sides.iter().any(|v| *v > 0.0) && sides.iter().any(|v| *v < 0.0);
    let alone = |k: usize| {
        let same = |i: usize| sides[i % 3] * sides[k] > 0.0;
        sides[k] != 0.0 && !same(k + 1) && !same(k + 2)
    };
    let first = (0..3).find(|&k| separated && alone(k))?;
    Some([t[first], t[(first + 1) % 3], t[(first + 2) % 3]])
}

/// Whether two triangles, each separated by the other's plane and turned by [`apex`], have a segment in
/// common. The edges from both apexes pass through the common line; the sign of two edges is the order of
/// their places there.
fn straddle(s: &Triangle, t: &Triangle) -> bool {
    let order = |i: usize, j: usize| orient3d(s[0], s[i], t[0], t[j]);
    let orders = [order(1, 1), order(1, 2), order(2, 1), order(2, 2)];
    orders.iter().any(|v| *v > 0.0) && orders.iter().any(|v| *v < 0.0)
}

/// Whether `s`, on one side of the plane of `t`, has an edge in it that runs through `t`. The surface may
/// pass through there with the next triangle.
fn rests(s: &Triangle, sides: [f64; 3], t: &Triangle) -> bool {
    let Some(k) = (0..3).find(|&k| sides[k] == 0.0 && sides[(k + 1) % 3] == 0.0) else {
        return false;
    };
    let flat = projection(t);
    let (edge, t) = ([s[k], s[(k + 1) % 3]].map(&flat), t.map(&flat));
    let sides = t.map(|p| orient2d(edge[0], edge[1], p));
    sides.iter().any(|v| *v > 0.0) && sides.iter().any(|v| *v < 0.0) && !parted(&t, &edge)
}

/// Whether two triangles of one plane have area in common: no edge of either has the other on its far side.
fn overlap(s: &Triangle, t: &Triangle) -> bool {
    let flat = projection(s);
    let (s, t) = (s.map(&flat), t.map(&flat));
    let has_area = |t: &[DVec2; 3]| orient2d(t[0], t[1], t[2]) != 0.0;
    has_area(&s) && has_area(&t) && !parted(&s, &t) && !parted(&t, &s)
}

/// Whether two triangles are seen beside each other, so that they have at most an edge in common.
fn are_apart(s: &Triangle, t: &Triangle) -> bool {
    let flat = projection(s);
    let (s, t) = (s.map(&flat), t.map(&flat));
    parted(&s, &t) || parted(&t, &s)
}

/// Drops the coordinate along which a triangle's normal is longest.
fn projection(t: &Triangle) -> impl Fn(DVec3) -> DVec2 {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]).abs();
    let long = normal.max_element();
    let axis = if normal.z == long { 2 } else { usize::from(normal.y == long) };
    move |p| DVec2::new(p[(axis + 1) % 3], p[(axis + 2) % 3])
}

/// Whether an edge of a triangle has all points on its far side.
fn parted(t: &[DVec2; 3], points: &[DVec2]) -> bool {
    let turn = orient2d(t[0], t[1], t[2]).signum();
    let far = |k: usize| points.iter().all(|p| orient2d(t[k], t[(k + 1) % 3], *p) * turn <= 0.0);
    (0..3).any(far)
}

/// The solid's volume is so small a share of its area times its size that it encloses nothing.
const NOTHING: f64 = 1e-12;

/// Whether a solid encloses nothing but rounding: it is flat, or inside out.
pub fn is_hollow(solid: &Polyhedron) -> bool {
    let Some([min, max]) = super::measure::bounds(solid) else { return true };
    let size = (max - min).length();
    super::measure::volume(solid) <= NOTHING * super::measure::area(solid) * size
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::{
        geom::PolyMesh,
        kernel::brep::primitive::{cuboid, torus},
    };

    fn with(second: &Polyhedron) -> PolyMesh {
        let mut mesh = cuboid(DVec3::ZERO, DVec3::splat(2.0)).into_mesh();
        mesh.append(second.mesh());
        mesh
    }

    #[test]
    fn shells_that_touch_do_not_cross() {
        for at in [dvec3(2., 2., 0.), dvec3(2., 2., 2.), dvec3(5., 0., 0.)] {
            assert_eq!(crossing(&with(&cuboid(at, at + 1.0))), Ok(None), "{at}");
        }
        assert_eq!(crossing(torus(9., 3., 24, 12).mesh()), Ok(None));
    }

    #[test]
    fn shells_that_cross_or_cover_each_other() {
        for at in [dvec3(1., 1., 1.), dvec3(0., 0., 0.), dvec3(2., 0.5, 0.5), dvec3(0.5, 0.5, 1.)] {
            let found = crossing(&with(&cuboid(at, at + 2.0))).expect("few");
            assert!(found.is_some_and(|p| p.cmpge(at).all() && p.cmple(at + 2.0).all()), "{at}");
        }
    }

    #[test]
    fn a_ball_whose_equator_lies_in_a_face() {
        let ball = crate::kernel::brep::primitive::sphere(0.5, 10);
        let up = crate::geom::Placement::new(glam::DMat3::IDENTITY, dvec3(1., 1., 2.));
        assert!(crossing(&with(&ball.placed(&up))).expect("few").is_some());
    }

    #[test]
    fn a_box_that_stands_on_its_edge_touches_and_one_sunk_in_crosses() {
        let turn = glam::DMat3::from_cols(dvec3(1., 0., 1.), DVec3::Y, dvec3(-1., 0., 1.));
        let standing = |low: f64| {
            let place = crate::geom::Placement::new(turn, dvec3(1., 0.5, low));
            with(&cuboid(DVec3::ZERO, dvec3(1., 1., 1.)).placed(&place))
        };
        assert!(crossing(&standing(2.0)).expect("few").is_some());
        assert_eq!(crossings(&standing(2.0)).len(), 0);
        assert!(!crossings(&standing(1.5)).is_empty());
        assert_eq!(crossings(&standing(2.5)).len(), 0);
    }

    /// Long needles across one another's boxes, in which no two cross.
    #[test]
    fn searches_end() {
        let mut mesh = PolyMesh::default();
        for i in 0..40 {
            let low = dvec3(0.0, 0.0, f64::from(i));
            mesh.append(cuboid(low, low + dvec3(1.0, 1.0, 0.5)).mesh());
        }
        let turn =
            glam::DMat3::from_cols(dvec3(1., 1., 1.), dvec3(-1., 1., 0.), dvec3(0., -1., 1.));
        let slanted =
            Polyhedron::trusted(mesh).placed(&crate::geom::Placement::new(turn, DVec3::ZERO));
        let soup = Soup::of(slanted.mesh());
        assert_eq!(soup.cross_until(MOST_COMPARED, 1), Ok(vec![]));
        assert_eq!(soup.cross_until(9, 1), Err(Tangled::Near { triangles: 480, limit: 9 }));
    }

    #[test]
    fn what_encloses_nothing() {
        assert!(is_hollow(&Polyhedron::empty()));
        assert!(!is_hollow(&cuboid(DVec3::ZERO, dvec3(1., 1., 1e-6))));
    }
}
