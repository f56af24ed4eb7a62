//! The solid of this kernel: a closed, oriented polygon mesh.

use glam::DVec3;
use thiserror::Error;

use crate::geom::{FaceRef, Placement, PolyMesh};

/// A closed, consistently oriented 2-manifold of planar polygons, possibly empty.
///
/// By index: every directed edge borders exactly one face, its reverse exactly one other, and the
/// faces around every point form one fan. Geometry (no self-intersection) is the maker's promise.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Polyhedron {
    mesh: PolyMesh,
}

/// Why a mesh is not a solid.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Defect {
    /// A hole in the boundary, or a fin.
    #[error("edge {a}-{b} borders {faces} faces; a solid needs exactly 2")]
    OpenEdge {
        /// Index of its start.
        a: u32,
        /// Index of its end.
        b: u32,
        /// Faces found there.
        faces: usize,
        /// The middle of the edge, mm.
        at: DVec3,
        /// Number of such edges.
        edges: usize,
    },
    /// Two sheets that meet in one point.
    #[error("the faces at point {point} form {fans} fans; a solid needs exactly 1")]
    PinchedPoint {
        /// Its index.
        point: u32,
        /// Fans found there.
        fans: usize,
    },
    /// A surface with one side only, as a Moebius band has.
    #[error("the faces at ({}, {}, {}) cannot all face outwards; a solid's boundary has two sides", .at.x, .at.y, .at.z)]
    OneSided {
        /// The middle of an edge where it shows, mm.
        at: DVec3,
    },
    /// A coordinate that is NaN or infinite.
    #[error("point {point} has a coordinate that is not finite")]
    NotFinite {
        /// Its index.
        point: u32,
    },
}

impl Polyhedron {
    /// The empty solid.
    pub fn empty() -> Polyhedron {
        Polyhedron::default()
    }

    /// Takes a mesh in after checking that it is closed and manifold by index.
    pub fn new(mesh: PolyMesh) -> Result<Polyhedron, Defect> {
        check(&mesh)?;
        Ok(Polyhedron { mesh })
    }

    /// Takes a mesh in whose maker vouches for it; checked in debug builds only.
    pub(crate) fn trusted(mesh: PolyMesh) -> Polyhedron {
        debug_assert_eq!(check(&mesh), Ok(()));
        Polyhedron { mesh }
    }

    /// Whether a mesh is closed and manifold by index of which only a part is new: the first `faces`, which
    /// have the first `points`. All others come from solids as they stand, so only what meets at those points
    /// is looked at; `false` says nothing.
    pub(crate) fn is_seam_sound(mesh: &PolyMesh, faces: usize, points: u32) -> bool {
        let is_near = |face: &FaceRef<'_>| {
            face.index() < faces || face.loops().flatten().any(|&corner| corner < points)
        };
        let finite = mesh.points.iter().all(|p| p.is_finite());
        finite && Corners::of(mesh.faces().filter(is_near), points).are_fans()
    }

    /// Its boundary.
    pub fn mesh(&self) -> &PolyMesh {
        &self.mesh
    }

    /// Its boundary, given away.
    pub fn into_mesh(self) -> PolyMesh {
        self.mesh
    }

    /// Whether it is the empty solid.
    pub fn is_empty(&self) -> bool {
        self.mesh.is_empty()
    }

    /// The solid after a placement that does not flatten space.
    pub fn placed(&self, placement: &Placement) -> Polyhedron {
        if placement.is_identity() {
            return self.clone();
        }
        Polyhedron { mesh: self.mesh.placed(placement) }
    }
}

/// The edges of a loop: start, end, and the corner after the end.
fn edges(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    let n = corners.len();
    (0..n).map(move |i| [corners[i], corners[(i + 1) % n], corners[(i + 2) % n]])
}

/// The corners of loops, by point: at each the point before and the point after.
struct Corners {
    /// Where the corners of each point begin; one more at the end.
    starts: Vec<u32>,
    /// The point before and the point after.
    arms: Vec<(u32, u32)>,
}

impl Corners {
    /// The corners of some faces at points below a limit.
    fn of<'a>(faces: impl Iterator<Item = FaceRef<'a>> + Clone, points: u32) -> Corners {
        let all =
            || faces.clone().flat_map(|f| f.loops()).flat_map(edges).filter(|e| e[1] < points);
        let mut starts = vec![0u32; points as usize + 2];
        all().for_each(|[_, point, _]| starts[point as usize + 2] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let mut arms = vec![(0, 0); starts[starts.len() - 1] as usize];
        for [before, point, after] in all() {
            let place = &mut starts[point as usize + 1];
            arms[*place as usize] = (before, after);
            *place += 1;
        }
        starts.pop();
        Corners { starts, arms }
    }

    fn at(&mut self, point: u32) -> &mut [(u32, u32)] {
        let [from, to] = [0, 1].map(|i| self.starts[point as usize + i] as usize);
        &mut self.arms[from..to]
    }

    /// Whether the corners at every point form one fan: stepping from corner to corner over the edge
    /// that two of them share meets each of them once.
    fn are_fans(&mut self) -> bool {
        (0..self.starts.len() as u32 - 1).all(|point| is_fan(point, self.at(point)))
    }
}

/// So many corners at a point are searched one by one.
const FEW: usize = 12;

/// Whether the corners at a point form one fan.
fn is_fan(point: u32, corners: &mut [(u32, u32)]) -> bool {
    let Some(&first) = corners.first() else { return true };
    let many = corners.len() > FEW;
    if many {
        corners.sort_unstable();
    }
    let (mut at, mut met) = (first, 0);
    loop {
        met += 1;
        let next = if many {
            corners.get(corners.partition_point(|c| c.0 < at.1)).filter(|c| c.0 == at.1)
        } else {
            corners.iter().find(|c| c.0 == at.1)
        };
        match next {
            Some(_) if at.1 == point || met > corners.len() => return false,
            Some(&next) if next == first => return met == corners.len(),
            Some(&next) => at = next,
            None => return false,
        }
    }
}

fn check(mesh: &PolyMesh) -> Result<(), Defect> {
    if let Some(point) = mesh.points.iter().position(|p| !p.is_finite()) {
        return Err(Defect::NotFinite { point: point as u32 });
    }
    if Corners::of(mesh.faces(), mesh.points.len() as u32).are_fans() {
        return Ok(());
    }
    let spokes = Spokes::new(mesh);
    check_edges(mesh, &spokes)?;
    (0..mesh.points.len() as u32).try_for_each(|point| check_fan(&spokes, point))
}

/// An edge that leaves a point, and the corner that comes after its end in the loop.
#[derive(Clone, Copy)]
struct Spoke {
    end: u32,
    follower: u32,
}

/// All directed edges, sorted by start and end: what is wrong with a mesh is told by them.
struct Spokes {
    /// Where the edges of each point begin; one more at the end.
    starts: Vec<u32>,
    spokes: Vec<Spoke>,
}

impl Spokes {
    fn new(mesh: &PolyMesh) -> Spokes {
        let all = || mesh.faces().flat_map(|f| f.loops()).flat_map(edges);
        let mut starts = vec![0u32; mesh.points.len() + 2];
        all().for_each(|[a, ..]| starts[a as usize + 2] += 1);
        (1..starts.len()).for_each(|i| starts[i] += starts[i - 1]);
        let total = starts[starts.len() - 1] as usize;
        let mut spokes = vec![Spoke { end: 0, follower: 0 }; total];
        for [a, end, follower] in all() {
            let place = &mut starts[a as usize + 1];
            spokes[*place as usize] = Spoke { end, follower };
            *place += 1;
        }
        for pair in starts.windows(2) {
            spokes[pair[0] as usize..pair[1] as usize].sort_unstable_by_key(|s| s.end);
        }
        Spokes { starts, spokes }
    }

    fn of(&self, point: u32) -> &[Spoke] {
        &self.spokes[self.starts[point as usize] as usize..self.starts[point as usize + 1] as usize]
    }

    /// How many loops run from `a` to `b`.
    fn count(&self, a: u32, b: u32) -> usize {
        let spokes = self.of(a);
        let first = spokes.partition_point(|s| s.end < b);
        spokes[first..].iter().take_while(|s| s.end == b).count()
    }

    /// The corner after `b` in the only loop that runs from `a` to `b`.
    fn follower(&self, a: u32, b: u32) -> u32 {
        let spokes = self.of(a);
        spokes[spokes.partition_point(|s| s.end < b)].follower
    }
}

fn check_edges(mesh: &PolyMesh, spokes: &Spokes) -> Result<(), Defect> {
    let bad = |a, b| a == b || spokes.count(a, b) != 1 || spokes.count(b, a) != 1;
    let all = mesh.faces().flat_map(|f| f.loops()).flat_map(edges);
    let mut open = all.filter(|&[a, b, _]| bad(a, b));
    let Some([a, b, _]) = open.next() else { return Ok(()) };
    let at = (mesh.points[a as usize] + mesh.points[b as usize]) / 2.0;
    let faces = spokes.count(a, b) + spokes.count(b, a);
    Err(Defect::OpenEdge { a, b, faces, at, edges: open.count() + 1 })
}

/// Walks around a point from face to face: the walk must meet all edges that leave it.
fn check_fan(spokes: &Spokes, point: u32) -> Result<(), Defect> {
    let leaving = spokes.of(point);
    let Some(first) = leaving.first() else { return Ok(()) };
    let walk = std::iter::successors(Some(first.end), |&end| {
        Some(spokes.follower(end, point)).filter(|&next| next != first.end)
    });
    let met = walk.take(leaving.len()).count();
    if met == leaving.len() { Ok(()) } else { Err(Defect::PinchedPoint { point, fans: 2 }) }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;
    use crate::{
        geom::{Origin, Surface},
        kernel::brep::primitive::cuboid,
    };

    fn cube() -> PolyMesh {
        cuboid(DVec3::ZERO, DVec3::ONE).into_mesh()
    }

    /// A mesh of single faces without holes.
    fn mesh(points: Vec<DVec3>, faces: &[&[u32]]) -> PolyMesh {
        let mut mesh = PolyMesh::with_points(points);
        let (plane, origin) = (mesh.add_plane(), mesh.add_origin(Origin::of(Surface::Plane)));
        faces.iter().for_each(|f| mesh.push_face(&[f], plane, origin));
        mesh
    }

    #[test]
    fn open_edges_are_counted() {
        let cube = cube();
        let faces: Vec<&[u32]> = cube.faces().skip(1).map(|f| f.outer()).collect();
        let open = Polyhedron::new(mesh(cube.points.clone(), &faces));
        assert!(matches!(open, Err(Defect::OpenEdge { faces: 1, edges: 4, .. })), "{open:?}");
        let mut turned = faces.clone();
        turned.push(&[0, 1, 3, 2]);
        let turned = Polyhedron::new(mesh(cube.points.clone(), &turned));
        assert!(matches!(turned, Err(Defect::OpenEdge { faces: 2, .. })));
    }

    #[test]
    fn points_and_edges_that_two_cubes_share_are_refused() {
        for (shift, by_edge) in [(dvec3(1., 1., 1.), false), (dvec3(1., 1., 0.), true)] {
            let mut two = cube();
            let mut other = cube();
            other.points.iter_mut().for_each(|p| *p += shift);
            two.append(&other);
            let number: Vec<u32> = (0..two.points.len())
                .map(|i| {
                    two.points.iter().position(|p| *p == two.points[i]).expect("itself") as u32
                })
                .collect();
            let welded: Vec<Vec<u32>> = two
                .faces()
                .map(|f| f.outer().iter().map(|&c| number[c as usize]).collect())
                .collect();
            let faces: Vec<&[u32]> = welded.iter().map(Vec::as_slice).collect();
            let found = Polyhedron::new(mesh(two.points.clone(), &faces));
            match found {
                Err(Defect::OpenEdge { faces, .. }) => assert!(by_edge && faces == 4),
                Err(Defect::PinchedPoint { fans, .. }) => assert!(!by_edge && fans == 2),
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn coordinates_must_be_finite() {
        let mut bad = cube();
        bad.points[3].y = f64::NAN;
        assert_eq!(Polyhedron::new(bad), Err(Defect::NotFinite { point: 3 }));
    }
}
