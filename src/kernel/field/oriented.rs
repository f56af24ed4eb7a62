//! Eight boxes in a frame that is turned along what they hold, on a lattice of bytes.
//!
//! Gottschalk, S., Lin, M. C., Manocha, D.: *OBBTree: a hierarchical structure for rapid interference detection*,
//! 1996. A patch of a surface is thin across its normal; a box along the axes is as thick as the patch is
//! slanted, and a ball that touches the surface at one point meets hundreds of such boxes.
//!
//! Ylitie, H., Karras, T., Laine, S.: *Efficient incoherent ray traversal on GPUs through compressed wide BVHs*,
//! 2017. What is asked at random waits for memory: a node is two lines of a cache.
//!
//! # Departures
//! Boxes of a node share its frame, which is turned as a whole, and one loop measures eight of them; what rounding
//! may do is told by the slack of a question.

use glam::{DMat3, DVec3, Mat3A, Vec3, Vec3A};

use super::lanes::{Bytes, LANES, Lanes};

/// Steps of the lattice along an axis.
const STEPS: f64 = 255.0;
/// The least extent that is told apart, relative to the size of coordinates.
const LEAST: f64 = 1.0 / (1 << 20) as f64;

/// Eight boxes.
#[derive(Clone, Copy, Debug)]
#[repr(align(128))]
pub(super) struct Boxes {
    /// Where the axes of the mesh lead in the frame, in steps of the lattice a millimetre.
    columns: [Vec3A; 3],
    /// Where the lattice begins along each axis, in steps.
    start: [f32; 3],
    /// The step of the lattice along each axis, mm.
    step: [f32; 3],
    /// The lower and the upper sides in steps.
    low: [Bytes; 3],
    high: [Bytes; 3],
    /// Which boxes there are, one bit each; the others are the last one again.
    pub present: u32,
}

/// A frame as it is kept, and boxes in it.
struct Fitted {
    axes: [Vec3; 3],
    boxes: Vec<[DVec3; 2]>,
}

impl Fitted {
    fn new<'a>(axes: DMat3, parts: impl Iterator<Item = &'a [[DVec3; 3]]>) -> Fitted {
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.as_vec3());
        // Along the axes as they are kept, not as they were meant.
        let kept = axes.map(|axis| axis.as_dvec3());
        let along = |p: &DVec3| DVec3::from(kept.map(|axis| axis.dot(*p)));
        let around = |part: &[[DVec3; 3]]| {
            let fold = |[low, high]: [DVec3; 2], p: DVec3| [low.min(p), high.max(p)];
            part.iter().flatten().map(along).fold([DVec3::INFINITY, DVec3::NEG_INFINITY], fold)
        };
        Fitted { axes, boxes: parts.map(around).collect() }
    }

    /// A measure of the area of the boxes.
    fn surface(&self) -> f64 {
        let of = |[low, high]: &[DVec3; 2]| {
            let size = *high - *low;
            size.x * size.y + size.y * size.z + size.z * size.x
        };
        self.boxes.iter().map(of).sum()
    }
}

impl Boxes {
    /// Boxes around triangles, so many in each; their corners are not larger than `reach`.
    pub fn new(triangles: &[[DVec3; 3]], each: usize, reach: f64) -> Boxes {
        let parts = || triangles.chunks(each).take(LANES);
        let straight = Fitted::new(DMat3::IDENTITY, parts());
        let turned = Fitted::new(fitting(|| triangles.iter().copied()), parts());
        let smaller = if turned.surface() < straight.surface() { turned } else { straight };
        Boxes::on_lattice(&smaller, reach)
    }

    fn on_lattice(fitted: &Fitted, reach: f64) -> Boxes {
        let low = fitted.boxes.iter().map(|b| b[0]).fold(DVec3::INFINITY, DVec3::min);
        let high = fitted.boxes.iter().map(|b| b[1]).fold(DVec3::NEG_INFINITY, DVec3::max);
        let start = low.as_vec3();
        // A part more than the extent, so that rounding does not lead beyond the last step.
        let extent =
            (high - low) * (1.0 + LEAST) + 2.0 * LEAST * reach.max(f64::from(f32::MIN_POSITIVE));
        let step = (extent / STEPS).as_vec3();
        let columns =
            Mat3A::from_cols_array_2d(&fitted.axes.map(|axis| axis.to_array())).transpose();
        let per = Vec3A::from(step.recip());
        let mut made = Boxes {
            columns: [columns.x_axis, columns.y_axis, columns.z_axis].map(|c| c * per),
            start: (start / step).to_array(),
            step: step.to_array(),
            low: Default::default(),
            high: Default::default(),
            present: (1 << fitted.boxes.len()) - 1,
        };
        for lane in 0..LANES {
            let sides = fitted.boxes[lane.min(fitted.boxes.len() - 1)];
            let [low, high] = sides.map(|p| (p - start.as_dvec3()) / step.as_dvec3());
            for k in 0..3 {
                made.low[k].set(lane, low[k].floor() as u8);
                made.high[k].set(lane, high[k].ceil() as u8);
            }
        }
        made
    }

    /// The squares of the distances of a point from the boxes.
    #[inline(always)]
    pub fn away(&self, at: Vec3) -> Lanes {
        let [x, y, z] = self.columns;
        let at = x * at.x + y * at.y + z * at.z - Vec3A::from(self.start);
        let beyond = |k: usize| {
            let at = Lanes::all(at[k]);
            let (low, high) = (Lanes::of(&self.low[k]), Lanes::of(&self.high[k]));
            let beyond = (low - at).max(at - high).max(Lanes::ZERO) * Lanes::all(self.step[k]);
            beyond * beyond
        };
        beyond(0) + beyond(1) + beyond(2)
    }
}

/// The frame of triangles: across them and along where they are spread most; that of the mesh if they face all ways.
pub(super) fn fitting<I: Iterator<Item = [DVec3; 3]>>(triangles: impl Fn() -> I) -> DMat3 {
    let areas = || triangles().map(|[a, b, c]| (b - a).cross(c - a));
    let (facing, area) = (areas().sum::<DVec3>(), areas().map(DVec3::length).sum::<f64>());
    if facing.length() <= area / 2.0 {
        return DMat3::IDENTITY;
    }
    frame(facing, spread(|| triangles().flatten(), facing))
}

/// Axes with the third one along `facing` and the first one about along `along`.
fn frame(facing: DVec3, along: DVec3) -> DMat3 {
    let z = facing.try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
    let x = along.reject_from_normalized(z).try_normalize();
    let x = x.unwrap_or_else(|| z.any_orthonormal_vector());
    DMat3::from_cols(x, z.cross(x), z)
}

/// The direction across `facing` along which points are spread most.
fn spread<I: Iterator<Item = DVec3>>(points: impl Fn() -> I, facing: DVec3) -> DVec3 {
    let z = facing.normalize_or_zero();
    let (x, y) = z.any_orthonormal_pair();
    let (mut middle, mut count) = (DVec3::ZERO, 0.0);
    points().for_each(|p| (middle, count) = (middle + p, count + 1.0));
    middle /= count;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in points() {
        let (a, b) = ((p - middle).dot(x), (p - middle).dot(y));
        (xx, xy, yy) = (xx + a * a, xy + a * b, yy + b * b);
    }
    // The eigenvector of the larger eigenvalue.
    let half = (xx - yy) / 2.0;
    let root = (half * half + xy * xy).sqrt();
    let found = if half > 0.0 { x * (half + root) + y * xy } else { x * xy + y * (root - half) };
    found.try_normalize().unwrap_or(x)
}
