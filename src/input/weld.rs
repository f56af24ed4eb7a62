//! Making one point of points that are meant to be one.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::geom::PolyMesh;

/// The mesh with points at most `mm` apart made one: each point joins the first earlier point
/// within reach, which keeps its place. Faces that fall together to fewer than three corners are left
/// out. This is what `heal = 0.01mm` does on import. A reach that is not positive welds equal points.
///
/// ```
/// use glam::dvec3;
/// use katachi::{geom::PolyMesh, input::weld};
/// let points = vec![dvec3(0., 0., 0.), dvec3(0.001, 0., 0.), dvec3(1., 0., 0.)];
/// assert_eq!(weld(&PolyMesh::with_points(points), 0.01).points.len(), 2);
/// ```
pub fn weld(mesh: &PolyMesh, mm: f64) -> PolyMesh {
    if mm.is_nan() || mm <= 0.0 {
        return welded(mesh);
    }
    let cell = |p: DVec3| [p.x, p.y, p.z].map(|c| (c / mm).floor() as i64);
    let mut cells: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    let mut points: Vec<DVec3> = vec![];
    let place = |p: &DVec3| {
        let home = cell(*p);
        let found = neighbours(home).filter_map(|c| cells.get(&c)).flatten().copied();
        let near = found.filter(|&i| points[i as usize].distance(*p) <= mm).min();
        near.unwrap_or_else(|| {
            points.push(*p);
            cells.entry(home).or_default().push(points.len() as u32 - 1);
            points.len() as u32 - 1
        })
    };
    let places: Vec<u32> = mesh.points.iter().map(place).collect();
    renumbered(mesh, points, &places)
}

fn neighbours(home: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(move |i: i64| {
        let step = [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1];
        std::array::from_fn(|axis| home[axis].saturating_add(step[axis]))
    })
}

/// The mesh with equal points made one; -0 and 0 are equal.
pub(super) fn welded(mesh: &PolyMesh) -> PolyMesh {
    let mut seen: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let mut points: Vec<DVec3> = vec![];
    let place = |p: &DVec3| {
        let key = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
        *seen.entry(key).or_insert_with(|| {
            points.push(*p);
            points.len() as u32 - 1
        })
    };
    let places: Vec<u32> = mesh.points.iter().map(place).collect();
    renumbered(mesh, points, &places)
}

/// The mesh without the points that no face has.
pub(super) fn without_strays(mesh: PolyMesh) -> PolyMesh {
    let mut used = vec![false; mesh.points.len()];
    for &corner in mesh.faces().flat_map(|f| f.loops()).flatten() {
        used[corner as usize] = true;
    }
    if used.iter().all(|u| *u) {
        return mesh;
    }
    let mut points = vec![];
    let places: Vec<u32> = (mesh.points.iter().zip(&used))
        .map(|(p, used)| {
            let place = points.len() as u32;
            if *used {
                points.push(*p);
            }
            place
        })
        .collect();
    renumbered(&mesh, points, &places)
}

fn renumbered(mesh: &PolyMesh, points: Vec<DVec3>, places: &[u32]) -> PolyMesh {
    let mut result = PolyMesh::with_points(points);
    for origin in mesh.origins() {
        result.add_origin(origin.clone());
    }
    for _ in 0..mesh.plane_count() {
        result.add_plane();
    }
    for face in mesh.faces() {
        let loops = face.loops().map(|corners| {
            let mut moved: Vec<u32> = corners.iter().map(|&c| places[c as usize]).collect();
            moved.dedup();
            while moved.len() > 1 && moved.first() == moved.last() {
                moved.pop();
            }
            moved
        });
        let loops: Vec<Vec<u32>> = loops.enumerate().filter(keeps).map(|(_, l)| l).collect();
        let is_flat = loops[0].len() < 3 || loops[0].len() == 3 && loops[0][0] == loops[0][2];
        if !is_flat {
            result.push_face(&loops, face.plane(), face.origin_index());
        }
    }
    result
}

/// The outer loop, and holes that are left.
fn keeps((number, corners): &(usize, Vec<u32>)) -> bool {
    *number == 0 || corners.len() >= 3
}
