//! Collecting the faces of a file into a mesh.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{ReadError, error::Format};
use crate::geom::{Origin, PolyMesh, Surface, mesh::Color};

/// The most faces read from one file.
pub const MOST_FACES: usize = 1 << 26;

/// How far the corners of a polygon may lie from its plane, relative to its size, to count as planar:
/// files carry six or seven digits.
const PLANAR: f64 = 1e-5;

/// A mesh in the making: points as in the file, faces with all their corners.
pub(super) struct Soup {
    format: Format,
    /// The mesh so far; its points may repeat.
    pub mesh: PolyMesh,
    origins: FxHashMap<(Option<Color>, u32), u32>,
    names: Vec<std::sync::Arc<str>>,
}

impl Soup {
    /// No faces over no points.
    pub fn new(format: Format) -> Soup {
        Soup { format, mesh: PolyMesh::default(), origins: FxHashMap::default(), names: vec![] }
    }

    /// Names the faces that follow; an empty name is none.
    pub fn name(&mut self, name: &str) {
        self.names.push(name.trim().into());
    }

    fn origin(&mut self, color: Option<Color>) -> u32 {
        let (mesh, names) = (&mut self.mesh, &self.names);
        *self.origins.entry((color, names.len() as u32)).or_insert_with(|| {
            let tags = names.last().filter(|n| !n.is_empty()).cloned().into_iter().collect();
            mesh.add_origin(Origin { tags, color, ..Origin::of(Surface::Facets) })
        })
    }

    /// Adds a polygon. Corners repeated in a row are one; what is left of fewer than three is no face.
    /// A polygon that is not planar is cut into triangles.
    pub fn face(&mut self, corners: &[u32], color: Option<Color>) -> Result<(), ReadError> {
        if self.mesh.face_count() >= MOST_FACES {
            return Err(self.format.limit("the number of faces", format!("{MOST_FACES} faces")));
        }
        let mut kept = corners.to_vec();
        kept.dedup();
        while kept.len() > 1 && kept.first() == kept.last() {
            kept.pop();
        }
        if kept.len() < 3 {
            return Ok(());
        }
        let origin = self.origin(color);
        if kept.len() == 3 || is_planar(&self.mesh.points, &kept) {
            self.push(&kept, origin);
        } else {
            for i in 1..kept.len() - 1 {
                self.push(&[kept[0], kept[i], kept[i + 1]], origin);
            }
        }
        Ok(())
    }

    fn push(&mut self, corners: &[u32], origin: u32) {
        let distinct = corners.len() > 3
            || (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]);
        if distinct {
            let plane = self.mesh.add_plane();
            self.mesh.push_face(&[corners], plane, origin);
        }
    }

    /// The mesh: as in the file where it is closed by index, else with equal points welded. Points of no
    /// face are left out.
    pub fn finish(self) -> Result<PolyMesh, ReadError> {
        let closed = is_closed(&self.mesh);
        let mesh = if closed { self.mesh } else { super::weld::welded(&self.mesh) };
        if mesh.is_empty() {
            let needed = "a mesh with at least one face is needed";
            return Err(self.format.error(super::Place::File, "no faces", needed));
        }
        Ok(super::weld::without_strays(mesh))
    }
}

/// Whether every directed edge has its reverse, each once.
fn is_closed(mesh: &PolyMesh) -> bool {
    let mut edges: Vec<(u32, u32)> = Vec::with_capacity(mesh.triangle_count() * 3);
    for corners in mesh.faces().flat_map(|f| f.loops()) {
        let next = corners.iter().cycle().skip(1);
        edges.extend(corners.iter().copied().zip(next.copied()));
    }
    edges.sort_unstable();
    let unique = edges.windows(2).all(|w| w[0] != w[1]);
    unique && edges.iter().all(|&(a, b)| edges.binary_search(&(b, a)).is_ok())
}

fn is_planar(points: &[DVec3], corners: &[u32]) -> bool {
    let at = |i: usize| points[corners[i % corners.len()] as usize] - points[corners[0] as usize];
    let normal: DVec3 = (0..corners.len()).map(|i| at(i).cross(at(i + 1))).sum();
    let size = (0..corners.len()).map(|i| at(i).length()).fold(0.0, f64::max);
    let Some(normal) = normal.try_normalize() else { return false };
    (0..corners.len()).all(|i| at(i).dot(normal).abs() <= PLANAR * size)
}
