//! Single-valued surfaces z = f(x, y) over a grid, drawn by their floating horizon.
//!
//! Cells are taken from the eye outwards. What they cover in the picture so far lies, over every place of the
//! picture's x axis, between a lowest and a highest point: two polylines, kept exactly. A grid line is seen where it
//! rises above the one (the upper side of the surface) or falls below the other (the lower side).
//!
//! Source: T. Nishita (METHODS, section 3.5).
//!
//! # Departures
//! The paper goes through one direction of grid lines and takes the other's visibility from its neighbours; here cells
//! go in order, so that both directions are held against the same horizon. The paper keeps the horizon in columns.

use glam::{DVec2, DVec3, dvec3};
use thiserror::Error;

use super::{
    Camera, Drawing,
    drawing::{Class, Line, Path, Segment},
    envelope::{Envelope, Rise},
    merge::{Mark, Piece},
    scene::Kind,
};
use crate::geom::CurvedGrid;

/// Heights over the points of a grid.
#[derive(Clone, PartialEq, Debug)]
pub struct HeightField {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Heights, x slowest.
    z: Vec<f64>,
}

/// Why a grid has no picture by its horizon.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum HorizonError {
    /// Not one height for each grid point.
    #[error("{found} heights; a grid of {nx} x {ny} points needs {}", nx * ny)]
    Heights {
        /// Heights given.
        found: usize,
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
    },
    /// Too few grid points, or places that do not grow.
    #[error(
        "the grid has {nx} x {ny} points; both need at least 2, at finite places in increasing order"
    )]
    Grid {
        /// Points along x.
        nx: usize,
        /// Points along y.
        ny: usize,
    },
    /// A height that is NaN or infinite.
    #[error("the height at x = {x} mm, y = {y} mm is not finite")]
    NotFinite {
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// A point that is not before an eye looking level.
    #[error("the point ({}, {}, {}) is not before the eye; the horizon needs the whole surface there", .0.x, .0.y, .0.z)]
    BehindEye(DVec3),
}

impl HeightField {
    /// Heights in mm over places x and y in mm, x slowest. Fails unless there are two places or more each way in
    /// increasing order, one height for each point, and all numbers finite.
    pub fn new(x: Vec<f64>, y: Vec<f64>, z: Vec<f64>) -> Result<HeightField, HorizonError> {
        let (nx, ny) = (x.len(), y.len());
        let grows = |places: &[f64]| {
            places.len() > 1
                && places.iter().all(|p| p.is_finite())
                && places.windows(2).all(|p| p[0] < p[1])
        };
        if !grows(&x) || !grows(&y) {
            return Err(HorizonError::Grid { nx, ny });
        }
        if z.len() != nx * ny {
            return Err(HorizonError::Heights { found: z.len(), nx, ny });
        }
        match z.iter().position(|z| !z.is_finite()) {
            Some(i) => Err(HorizonError::NotFinite { x: x[i / ny], y: y[i % ny] }),
            None => Ok(HeightField { x, y, z }),
        }
    }

    /// The heights of a grid that is a function of x and y; `None` for another.
    pub fn of(grid: &CurvedGrid) -> Option<HeightField> {
        let [x, y] = grid.places()?;
        let z = grid.points().iter().map(|p| p.z).collect();
        Some(HeightField { x, y, z })
    }

    fn point(&self, [i, j]: [usize; 2]) -> DVec3 {
        dvec3(self.x[i], self.y[j], self.z[i * self.y.len() + j])
    }
}

/// The visible grid lines of a surface: [`Kind::Upper`] where its upper side is seen, [`Kind::Lower`] where its lower side
/// is. Nothing is drawn hidden; the hidden length is what is left of all grid lines, those behind others included.
///
/// Fails when a point is not before the eye: of a perspective, before the eye turned level.
///
/// ```
/// use katachi::output::drawing::{Camera, HeightField, View, horizon_lines};
/// let places = vec![0.0, 10.0, 20.0];
/// let flat = HeightField::new(places.clone(), places, vec![1.0; 9]).unwrap();
/// let top = horizon_lines(&flat, &Camera::view(View::Top), 0).unwrap();
/// assert!((top.visible - 6.0 * 20.0).abs() < 1e-9);
/// ```
pub fn horizon_lines(
    field: &HeightField,
    camera: &Camera,
    id: u32,
) -> Result<Drawing, HorizonError> {
    let Some(level) = camera.level() else {
        return Ok(draw_all(field, camera, id));
    };
    let mut images = Vec::with_capacity(field.z.len());
    for i in 0..field.x.len() {
        for j in 0..field.y.len() {
            let p = field.point([i, j]);
            if level.ahead(p) < 0.0 || camera.ahead(p) < 0.0 {
                return Err(HorizonError::BehindEye(p));
            }
            images.push(level.image(p));
        }
    }
    let mut horizon = Horizon {
        field,
        camera,
        images,
        upper: Envelope::default(),
        lower: Envelope::default(),
        parts: vec![],
        id,
    };
    horizon.run(level);
    let mut drawing = finished(horizon.parts, camera);
    let all: f64 = grid_edges(field, camera).map(|(_, p, q)| p.distance(q)).sum();
    drawing.hidden = (all - drawing.visible).max(0.0);
    Ok(drawing)
}

/// All grid lines: seen along z, nothing is in front of anything.
fn draw_all(field: &HeightField, camera: &Camera, id: u32) -> Drawing {
    let kind = if camera.toward().z > 0.0 { Kind::Upper } else { Kind::Lower };
    let mark = Mark { class: Class::Visible, order: 0, kind, id, loose: false };
    let part = |(line, from, to)| Part { line, piece: Piece { from, to, mark } };
    finished(grid_edges(field, camera).map(part).collect(), camera)
}

/// All edges of the grid with their grid lines, in the picture as far as they are in its window.
fn grid_edges<'a>(
    field: &'a HeightField,
    camera: &'a Camera,
) -> impl Iterator<Item = (GridLine, DVec2, DVec2)> + 'a {
    let (nx, ny) = (field.x.len(), field.y.len());
    let places = (0..nx).flat_map(move |i| (0..ny).map(move |j| [i, j]));
    let edges = places.flat_map(move |[i, j]| {
        let far = [(i + 1 < nx).then_some([i + 1, j]), (j + 1 < ny).then_some([i, j + 1])];
        far.into_iter().flatten().map(move |to| [[i, j], to])
    });
    let window = camera.window();
    edges.filter_map(move |ends| {
        let [p, q] = ends.map(|at| camera.image(field.point(at)).0);
        let (from, to) = window.map_or(Some((0.0, 1.0)), |w| w.of_segment(p, q))?;
        Some((grid_line(ends), p.lerp(q, from), p.lerp(q, to)))
    })
}

/// A grid line as its direction and number, and a place on it.
type GridLine = (bool, usize, usize);

/// A visible part of an edge of the grid.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// The grid line it belongs to, and its place there.
    line: GridLine,
    piece: Piece,
}

/// The grid line of an edge between neighbouring points, the smaller first: its direction, number and place.
fn grid_line([[i, j], [k, _]]: [[usize; 2]; 2]) -> GridLine {
    if i == k { (false, i, j) } else { (true, j, i) }
}

/// Parts strung together along their grid lines. Grid lines do not coincide, so nothing is merged.
fn finished(mut parts: Vec<Part>, camera: &Camera) -> Drawing {
    if let Some(window) = camera.window() {
        parts.retain_mut(|p| window.cut(&mut p.piece));
    }
    // Stable: parts of one edge come in its direction.
    parts.sort_by_key(|p| p.line);
    let mut drawing = Drawing { segments: parts.len(), ..Drawing::default() };
    let mut end = None;
    for Part { line: (along_x, number, _), piece: Piece { from, to, mark } } in parts {
        drawing.visible += from.distance(to);
        let here = (along_x, number, mark);
        match drawing.lines.last_mut() {
            Some(last) if end == Some((here, from)) => {
                last.path.segments.push(Segment::Line { to })
            }
            _ => {
                let path = Path::of(from, Segment::Line { to });
                let Mark { class, order, kind, id, .. } = mark;
                drawing.lines.push(Line { class, kind, id, order, path });
            }
        }
        end = Some((here, to));
    }
    drawing
}

/// The surface on the way from the eye outwards.
struct Horizon<'a> {
    field: &'a HeightField,
    camera: &'a Camera,
    /// Images of the grid points in a picture where z is upright, and their magnifications.
    images: Vec<(DVec2, f64)>,
    upper: Envelope,
    lower: Envelope,
    parts: Vec<Part>,
    id: u32,
}

/// Cells along an axis from the eye outwards: the number of each, and whether its larger side is the far one. The cell that
/// the eye is over comes first.
fn outwards(places: &[f64], eye: Option<f64>, toward: f64) -> Vec<(usize, bool)> {
    let cells = places.len() - 1;
    let split = match eye {
        Some(eye) => places.partition_point(|p| *p <= eye).saturating_sub(1),
        None if toward > 0.0 => cells,
        None => 0,
    };
    let up = (split..cells).map(|i| (i, true));
    up.chain((0..split).rev().map(|i| (i, false))).collect()
}

impl Horizon<'_> {
    fn run(&mut self, level: Camera) {
        let eye = level.eye();
        let columns = outwards(&self.field.x, eye.map(|e| e.x), level.toward().x);
        let rows = outwards(&self.field.y, eye.map(|e| e.y), level.toward().y);
        for (n, &(i, right)) in columns.iter().enumerate() {
            let first_i = n == 0 || columns[n - 1].1 != right;
            for (m, &(j, up)) in rows.iter().enumerate() {
                let first_j = m == 0 || rows[m - 1].1 != up;
                let [near_i, far_i] = if right { [i, i + 1] } else { [i + 1, i] };
                let [near_j, far_j] = if up { [j, j + 1] } else { [j + 1, j] };
                if first_i && !(n > 0 && near_i == columns[0].0) {
                    self.edges(&[[[near_i, near_j], [near_i, far_j]]]);
                }
                if first_j && !(m > 0 && near_j == rows[0].0) {
                    self.edges(&[[[near_i, near_j], [far_i, near_j]]]);
                }
                let far = [far_i, far_j];
                self.edges(&[[[far_i, near_j], far], [[near_i, far_j], far]]);
            }
        }
    }

    /// Draws edges where they leave the horizon, then adds them to it.
    fn edges(&mut self, edges: &[[[usize; 2]; 2]]) {
        for &ends in edges {
            self.draw(ends);
        }
        for ends in edges {
            let [p, q] = ends.map(|at| self.image(at).0);
            self.upper.raise(p, q);
            self.lower.raise(mirrored(p), mirrored(q));
        }
    }

    fn image(&self, [i, j]: [usize; 2]) -> (DVec2, f64) {
        self.images[i * self.field.y.len() + j]
    }

    fn draw(&mut self, mut ends: [[usize; 2]; 2]) {
        ends.sort_unstable();
        let [(p, _), (q, _)] = ends.map(|at| self.image(at));
        let mut seen = vec![];
        self.upper.above(p, q, |rise| seen.push((rise, Kind::Upper)));
        // Beyond both horizons a line is its own: it was told above.
        self.lower.above(mirrored(p), mirrored(q), |rise| {
            if rise.over_something {
                seen.push((rise, Kind::Lower));
            }
        });
        seen.sort_by(|a, b| a.0.from.total_cmp(&b.0.from));
        for (Rise { from, to, .. }, kind) in seen {
            let mark = Mark { class: Class::Visible, order: 0, kind, id: self.id, loose: false };
            let [from, to] = [from, to].map(|t| self.on_paper(ends, t));
            let piece = Piece { from, to, mark };
            self.parts.push(Part { line: grid_line(ends), piece });
        }
    }

    /// The image, in the camera's picture, of the point of an edge that is at t in the upright picture.
    fn on_paper(&self, ends: [[usize; 2]; 2], t: f64) -> DVec2 {
        let [k, l] = ends.map(|at| self.image(at).1);
        let s = t * l / ((1.0 - t) * k + t * l);
        let [p, q] = ends.map(|at| self.field.point(at));
        self.camera.image(p.lerp(q, s)).0
    }
}

fn mirrored(p: DVec2) -> DVec2 {
    DVec2::new(p.x, -p.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::drawing::View;

    fn field(n: usize, z: impl Fn(f64, f64) -> f64) -> HeightField {
        let places: Vec<f64> = (0..n).map(|i| 20.0 * i as f64 / (n - 1) as f64 - 10.0).collect();
        let all = places.iter().flat_map(|x| places.iter().map(|y| z(*x, *y))).collect();
        HeightField::new(places.clone(), places, all).expect("a grid")
    }

    fn lengths(drawing: &Drawing) -> [f64; 2] {
        [Kind::Upper, Kind::Lower].map(|kind| {
            let of = drawing.lines.iter().filter(|l| l.kind == kind);
            of.map(|l| l.path.length()).sum()
        })
    }

    #[test]
    fn a_plane_is_seen_whole_from_either_side() {
        let flat = field(5, |_, _| 2.0);
        for (z, side) in [(1.0, 0), (-1.0, 1)] {
            let camera = Camera::parallel(dvec3(1.0, -2.0, z)).expect("a direction");
            let found = lengths(&horizon_lines(&flat, &camera, 0).expect("before the eye"));
            let along = |v: DVec3| camera.project(v).expect("parallel").length();
            let whole = 5.0 * (along(DVec3::X * 20.0) + along(DVec3::Y * 20.0));
            // Which side the first edges show is not known before there is a horizon.
            assert!((found[0] + found[1] - whole).abs() < 1e-9, "{found:?}");
            assert!(found[side] > 0.75 * whole, "{found:?}");
        }
    }

    #[test]
    fn a_ridge_hides_what_is_behind_it() {
        // Seen level from the front, a ridge of height 5 covers the plane behind it.
        let ridge = field(41, |_, y| (5.0 - 5.0 * y.abs()).max(0.0));
        let front = horizon_lines(&ridge, &Camera::view(View::Front), 0).expect("before the eye");
        let (min, max) = front.bounds().expect("lines");
        assert!((max.y - min.y - 5.0).abs() < 1e-12);
        // The lines y = -1, -0.5, 0 over each other at heights 0, 2.5, 5 and 41 upright ones.
        assert!((front.visible - (3.0 * 20.0 + 41.0 * 5.0)).abs() < 1e-9, "{}", front.visible);
    }

    #[test]
    fn bad_grids_are_told() {
        let two = vec![0.0, 1.0];
        let made = |x: Vec<f64>, z: Vec<f64>| HeightField::new(x, two.clone(), z);
        assert_eq!(made(vec![0.0], vec![]), Err(HorizonError::Grid { nx: 1, ny: 2 }));
        assert!(matches!(
            made(two.clone(), vec![0.0]),
            Err(HorizonError::Heights { found: 1, .. })
        ));
        let nan = made(two.clone(), vec![0.0, f64::NAN, 0.0, 0.0]);
        assert_eq!(nan, Err(HorizonError::NotFinite { x: 0.0, y: 1.0 }));
        let flat = made(two.clone(), vec![0.0; 4]).expect("a grid");
        let among = Camera::perspective(dvec3(0.5, 0.5, 1.0), DVec3::ZERO).expect("apart");
        assert!(matches!(horizon_lines(&flat, &among, 0), Err(HorizonError::BehindEye(_))));
    }
}
