//! Polygon meshes: what kernels hand to outputs.
//!
//! A face is a planar polygon with holes. Every face names its *plane* (faces of one mesh with the
//! same number lie in one plane and face the same way) and its *origin* (source surface, tag,
//! colour).

use std::sync::Arc;

use glam::DVec3;

use super::{form::Form, placement::Placement, surface::Surface};

/// An sRGB colour, 0 to 255 each.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Color {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
}

/// Where faces come from; shared by all faces cut from one face of a primitive.
#[derive(Clone, PartialEq, Debug)]
pub struct Origin {
    /// The true surface, in the frame of the mesh.
    pub surface: Surface,
    /// Of a [`Surface::Smooth`] that was swept: its parameter surface, in the frame of the mesh.
    pub form: Option<Form>,
    /// The names given with `tag`, the outermost last.
    pub tags: Vec<Arc<str>>,
    /// The colour given with `color`; the innermost one holds.
    pub color: Option<Color>,
}

impl Origin {
    /// An origin without tag and colour.
    pub fn of(surface: Surface) -> Origin {
        Origin { surface, form: None, tags: vec![], color: None }
    }

    /// The origin of a face after a placement.
    pub fn placed(&self, placement: &Placement) -> Origin {
        let form = self.form.as_ref().map(|form| form.placed(placement));
        Origin { surface: self.surface.placed(placement), form, ..self.clone() }
    }
}

/// A face as stored: a run of loops.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Face {
    /// One past its last loop in `loop_ends`; it begins where the face before it ends.
    loops_end: u32,
    plane: u32,
    origin: u32,
}

/// Polygons over shared points, millimetres. Counter-clockwise seen from outside; holes clockwise.
///
/// Stored flat, so that a mesh of a million triangles costs five allocations. Nothing about
/// closedness is promised here: a kernel's solid type does that.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct PolyMesh {
    /// The corners.
    pub points: Vec<DVec3>,
    corners: Vec<u32>,
    loop_ends: Vec<u32>,
    faces: Vec<Face>,
    origins: Vec<Origin>,
    planes: u32,
}

/// A view of one face.
#[derive(Clone, Copy, Debug)]
pub struct FaceRef<'a> {
    mesh: &'a PolyMesh,
    index: usize,
}

impl PolyMesh {
    /// An empty mesh over the given points.
    pub fn with_points(points: Vec<DVec3>) -> PolyMesh {
        PolyMesh { points, ..PolyMesh::default() }
    }

    /// Adds a face of another mesh with its corners renamed by `number`, in the opposite order if `turned`.
    ///
    /// # Panics
    /// When a point, the plane or the origin does not exist.
    pub fn push_renamed(
        &mut self,
        face: FaceRef<'_>,
        turned: bool,
        (plane, origin): (u32, u32),
        number: impl Fn(u32) -> u32,
    ) {
        assert!(plane < self.planes && (origin as usize) < self.origins.len());
        let start = self.corners.len();
        for corners in face.loops() {
            match turned {
                true => self.corners.extend(corners.iter().rev().map(|&c| number(c))),
                false => self.corners.extend(corners.iter().map(|&c| number(c))),
            }
            self.loop_ends.push(self.corners.len() as u32);
        }
        assert!(self.corners[start..].iter().all(|&c| (c as usize) < self.points.len()));
        self.faces.push(Face { loops_end: self.loop_ends.len() as u32, plane, origin });
    }

    /// Makes room for so many faces, of one loop each, with so many corners in all.
    pub fn reserve(&mut self, faces: usize, corners: usize) {
        self.corners.reserve(corners);
        self.loop_ends.reserve(faces);
        self.faces.reserve(faces);
    }

    /// Adds an origin and returns its number.
    pub fn add_origin(&mut self, origin: Origin) -> u32 {
        self.origins.push(origin);
        self.origins.len() as u32 - 1
    }

    /// A new plane number.
    pub fn add_plane(&mut self) -> u32 {
        self.planes += 1;
        self.planes - 1
    }

    /// Adds a face: its outer loop first, then its holes, each a list of point indices.
    ///
    /// # Panics
    /// When an index, a plane or an origin does not exist, or a loop has fewer than three corners.
    pub fn push_face<L: AsRef<[u32]>>(&mut self, loops: &[L], plane: u32, origin: u32) {
        assert!(plane < self.planes && (origin as usize) < self.origins.len());
        assert!(!loops.is_empty());
        for corners in loops {
            let corners = corners.as_ref();
            assert!(
                corners.len() >= 3 && corners.iter().all(|&c| (c as usize) < self.points.len())
            );
            self.corners.extend_from_slice(corners);
            self.loop_ends.push(self.corners.len() as u32);
        }
        self.faces.push(Face { loops_end: self.loop_ends.len() as u32, plane, origin });
    }

    /// The faces in order.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceRef<'_>> + Clone {
        (0..self.faces.len()).map(|index| FaceRef { mesh: self, index })
    }

    /// One face.
    pub fn face(&self, index: usize) -> FaceRef<'_> {
        assert!(index < self.faces.len());
        FaceRef { mesh: self, index }
    }

    /// The number of faces.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The number of planes; plane numbers are below it.
    pub fn plane_count(&self) -> u32 {
        self.planes
    }

    /// The origins; a face's origin number is an index here.
    pub fn origins(&self) -> &[Origin] {
        &self.origins
    }

    /// The number of triangles any triangulation without new points has.
    pub fn triangle_count(&self) -> usize {
        self.faces().map(|f| f.triangle_count()).sum()
    }

    /// Whether it has no face.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// The mesh after a placement; a mirroring one turns the faces over, so that outside stays outside.
    pub fn placed(&self, placement: &Placement) -> PolyMesh {
        let mut mesh = self.clone();
        for p in &mut mesh.points {
            *p = placement.point(*p);
        }
        for origin in &mut mesh.origins {
            *origin = origin.placed(placement);
        }
        if placement.mirrors() {
            mesh.flip();
        }
        mesh
    }

    /// The mesh with every origin changed by `change`.
    pub fn with_origins(mut self, change: impl FnMut(&mut Origin)) -> PolyMesh {
        self.origins.iter_mut().for_each(change);
        self
    }

    /// Turns every face over.
    pub fn flip(&mut self) {
        let mut start = 0;
        for &end in &self.loop_ends {
            self.corners[start as usize..end as usize].reverse();
            start = end;
        }
    }

    /// Leaves out the points that no face uses; the others keep their order.
    pub fn drop_unused_points(&mut self) {
        let mut number = vec![u32::MAX; self.points.len()];
        self.corners.iter().for_each(|&c| number[c as usize] = 0);
        let mut kept = 0;
        for (i, n) in number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
            self.points[kept as usize] = self.points[i];
            *n = kept;
            kept += 1;
        }
        self.points.truncate(kept as usize);
        self.corners.iter_mut().for_each(|c| *c = number[*c as usize]);
    }

    /// Adds the points, faces, planes and origins of another mesh behind its own; nothing is merged.
    pub fn append(&mut self, other: &PolyMesh) {
        let (points, corners) = (self.points.len() as u32, self.corners.len() as u32);
        let (loops, origins) = (self.loop_ends.len() as u32, self.origins.len() as u32);
        self.points.extend_from_slice(&other.points);
        self.corners.extend(other.corners.iter().map(|c| c + points));
        self.loop_ends.extend(other.loop_ends.iter().map(|e| e + corners));
        self.faces.extend(other.faces.iter().map(|f| Face {
            loops_end: f.loops_end + loops,
            plane: f.plane + self.planes,
            origin: f.origin + origins,
        }));
        self.origins.extend_from_slice(&other.origins);
        self.planes += other.planes;
    }
}

impl<'a> FaceRef<'a> {
    #[inline]
    fn loop_range(self) -> std::ops::Range<usize> {
        let start = if self.index == 0 { 0 } else { self.mesh.faces[self.index - 1].loops_end };
        start as usize..self.mesh.faces[self.index].loops_end as usize
    }

    /// Its place among the faces.
    #[inline]
    pub fn index(self) -> usize {
        self.index
    }

    /// Its loops as point indices: the outer one, then the holes.
    #[inline]
    pub fn loops(self) -> impl ExactSizeIterator<Item = &'a [u32]> + Clone {
        let mesh = self.mesh;
        self.loop_range().map(move |i| {
            let start = if i == 0 { 0 } else { mesh.loop_ends[i - 1] };
            &mesh.corners[start as usize..mesh.loop_ends[i] as usize]
        })
    }

    /// Its outer loop.
    #[inline]
    pub fn outer(self) -> &'a [u32] {
        let first = self.loop_range().start;
        let start = if first == 0 { 0 } else { self.mesh.loop_ends[first - 1] };
        &self.mesh.corners[start as usize..self.mesh.loop_ends[first] as usize]
    }

    /// The corners of all its loops, one loop after the other.
    #[inline]
    pub fn corners(self) -> &'a [u32] {
        let ends = self.loop_range();
        let start = if ends.start == 0 { 0 } else { self.mesh.loop_ends[ends.start - 1] };
        &self.mesh.corners[start as usize..self.mesh.loop_ends[ends.end - 1] as usize]
    }

    /// The number of its plane.
    #[inline]
    pub fn plane(self) -> u32 {
        self.mesh.faces[self.index].plane
    }

    /// The number of its origin.
    pub fn origin_index(self) -> u32 {
        self.mesh.faces[self.index].origin
    }

    /// Its origin.
    pub fn origin(self) -> &'a Origin {
        &self.mesh.origins[self.origin_index() as usize]
    }

    /// Twice its area times its unit normal (Newell's sum over all loops), mm^2.
    pub fn area_vector(self) -> DVec3 {
        let points = &self.mesh.points;
        let base = points[self.outer()[0] as usize];
        let mut sum = DVec3::ZERO;
        for corners in self.loops() {
            let last = points[corners[corners.len() - 1] as usize] - base;
            corners.iter().fold(last, |before, &corner| {
                let here = points[corner as usize] - base;
                sum += before.cross(here);
                here
            });
        }
        sum
    }

    /// The number of triangles it falls into: corners + 2 holes - 2.
    pub fn triangle_count(self) -> usize {
        let loops = self.loops();
        let holes = loops.len() - 1;
        loops.map(<[u32]>::len).sum::<usize>() + 2 * holes - 2
    }
}
