//! Facets in the picture: outlines in columns and rows, and how near they are.

use glam::{DMat3, DVec2, DVec3, dvec2};

use super::{
    facet::{Bend, Facet},
    picture::Frame,
    shadow::Lit,
};
use crate::output::drawing::Camera;

/// A facet as it lies in the picture.
pub(super) struct Plate<'a> {
    pub facet: &'a Facet,
    /// Outlines: where it is, and for each sun where that shines on it.
    pub layers: Vec<Layer>,
    /// How near it is: at column 0, row 0, and growth along columns and rows; larger is nearer.
    pub near: DVec3,
    /// Whether the eye sees its back.
    pub back: bool,
}

/// A part of a facet.
pub(super) enum Layer {
    All,
    None,
    /// Inside these edges, by the number of times they are crossed; each from its upper end.
    Inside(Vec<[DVec2; 2]>),
}

/// From space to columns and rows.
pub(super) struct Optics<'a> {
    camera: &'a Camera,
    frame: &'a Frame,
    axes: DMat3,
}

/// A facet is seen from its edge when the cosine of its angle with the sight line is below this; it has no image.
const EDGE_ON: f64 = 1e-9;

impl<'a> Optics<'a> {
    pub fn new(camera: &'a Camera, frame: &'a Frame) -> Optics<'a> {
        Optics { camera, frame, axes: camera.frame() }
    }

    /// A facet in the picture; `None` if the eye does not see it or its outline is not in the frame.
    pub fn plate<'f>(&self, facet: &'f Facet, lit: &[Lit]) -> Option<Plate<'f>> {
        let base = facet.loops[0][0];
        let sight = self.camera.sight(base);
        let cosine = facet.normal.dot(sight) / sight.length();
        if cosine.abs() < EDGE_ON || (cosine < 0.0 && !facet.open) {
            return None;
        }
        let outline = self.edges(&facet.loops);
        let size = dvec2(f64::from(self.frame.size[0]), f64::from(self.frame.size[1]));
        let (low, high) = extent(&outline)?;
        if low.cmpge(size).any() || high.cmple(DVec2::ZERO).any() {
            return None;
        }
        let mut layers = vec![Layer::Inside(outline)];
        layers.extend(lit.iter().map(|lit| match lit {
            Lit::All => Layer::All,
            Lit::None => Layer::None,
            Lit::Part(loops) => Layer::Inside(self.edges(loops)),
        }));
        let near = self.nearness(base, facet.normal);
        Some(Plate { facet, layers, near, back: cosine < 0.0 })
    }

    /// The images of outlines, cut off before the eye.
    fn edges(&self, loops: &[Vec<DVec3>]) -> Vec<[DVec2; 2]> {
        let mut edges = vec![];
        for corners in loops {
            let seen = self.before_eye(corners);
            let image = |p: DVec3| self.camera.project(p).map(|at| self.frame.column_row(at));
            let images: Vec<DVec2> = seen.into_iter().filter_map(image).collect();
            let next = images.iter().cycle().skip(1);
            edges.extend(
                images.iter().zip(next).map(
                    |(&p, &q)| {
                        if (p.y, p.x) <= (q.y, q.x) { [p, q] } else { [q, p] }
                    },
                ),
            );
        }
        edges
    }

    fn before_eye(&self, corners: &[DVec3]) -> Vec<DVec3> {
        let ahead = |p: DVec3| self.camera.ahead(p);
        if corners.iter().all(|&p| ahead(p) >= 0.0) {
            return corners.to_vec();
        }
        let mut kept = vec![];
        for (&p, &q) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let (s, t) = (ahead(p), ahead(q));
            if s >= 0.0 {
                kept.push(p);
            }
            if (s >= 0.0) != (t >= 0.0) {
                let (inside, outside) = if s >= 0.0 { (p, q) } else { (q, p) };
                let (s, t) = (s.max(t), s.min(t));
                // A hair towards the side that is seen.
                kept.push(inside + (outside - inside) * (s / (s - t) * (1.0 - 1e-9)));
            }
        }
        kept
    }

    /// How near the plane through a point is: 1 / distance for a perspective, against the picture plane's; else the
    /// height above the picture plane.
    fn nearness(&self, base: DVec3, normal: DVec3) -> DVec3 {
        let target = self.camera.target();
        let [right, up, toward] = [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis];
        let tilt = DVec3::new(normal.dot(right), normal.dot(up), normal.dot(toward));
        // At a place x, y of the picture plane: c + x gx + y gy.
        let (c, gx, gy) = match self.camera.eye() {
            None => {
                let k = 1.0 / tilt.z;
                (normal.dot(base - target) * k, -tilt.x * k, -tilt.y * k)
            }
            Some(eye) => {
                let k = 1.0 / normal.dot(base - eye);
                (normal.dot(target - eye) * k, tilt.x * k, tilt.y * k)
            }
        };
        let (corner, pitch) = (self.frame.place(DVec2::ZERO), self.frame.pitch());
        DVec3::new(c + corner.x * gx + corner.y * gy, pitch * gx, -pitch * gy)
    }

    /// The point in space at a column and row, so near, and the unit vector towards the eye there.
    pub fn point(&self, at: DVec2, near: f64) -> (DVec3, DVec3) {
        let at = self.frame.place(at);
        let flat = self.axes.x_axis * at.x + self.axes.y_axis * at.y;
        match self.camera.eye() {
            None => {
                let toward = self.axes.z_axis;
                (self.camera.target() + flat + toward * near, toward)
            }
            Some(eye) => {
                let away = self.camera.target() + flat - eye;
                (eye + away / near, -away.normalize())
            }
        }
    }
}

impl Plate<'_> {
    /// Whether its normal is the same everywhere.
    pub fn is_flat(&self) -> bool {
        matches!(self.facet.bend, Bend::Flat)
    }

    /// How near it is at a column and row.
    pub fn near_at(&self, at: DVec2) -> f64 {
        self.near.x + self.near.y * at.x + self.near.z * at.y
    }

    /// Rows from the first to the last that it reaches.
    pub fn rows(&self) -> (f64, f64) {
        let Layer::Inside(outline) = &self.layers[0] else { return (0.0, 0.0) };
        extent(outline).map_or((0.0, 0.0), |(low, high)| (low.y, high.y))
    }
}

fn extent(edges: &[[DVec2; 2]]) -> Option<(DVec2, DVec2)> {
    let points = edges.iter().flatten().copied().map(|p| (p, p));
    points.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}
