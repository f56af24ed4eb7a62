//! Boxes turned along what they hold, eight at a time.
//!
//! Gottschalk, S., Lin, M. C., Manocha, D.: *OBBTree: a hierarchical structure for rapid interference detection*,
//! 1996. A patch of a surface is thin across its normal; a box along the axes is as thick as the patch is
//! slanted, and a ball that touches the surface at one point meets hundreds of such boxes.
//!
//! # Departures
//! Numbers are single and stand side by side, so that one loop measures eight boxes; what rounding may do is
//! told by [`SLACK`].

use glam::{DMat3, DVec3};

/// Boxes in a group.
pub(super) const LANES: usize = 8;

/// How much nearer than measured a box may be, relative to the sum of the sizes of all coordinates: each of some
/// twenty roundings of single numbers is 2^-24 of them at most.
pub(super) const SLACK: f64 = 24.0 / (1 << 24) as f64;

/// A box: its middle, its axes, and half of its sides along these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oriented {
    center: [f32; 3],
    axes: [[f32; 3]; 3],
    half: [f32; 3],
}

impl Oriented {
    /// The box of a triangle: its plane, its longest side.
    pub fn of_triangle(corners: [DVec3; 3]) -> Oriented {
        let [a, b, c] = corners;
        let longest =
            [b - a, c - b, a - c].into_iter().max_by(|s, t| length(*s).total_cmp(&length(*t)));
        let along = longest.map_or(DVec3::X, |side| side.try_normalize().unwrap_or(DVec3::X));
        Oriented::around(frame((b - a).cross(c - a), along), || corners.into_iter())
    }

    /// A box of points on a surface whose area vector is about `facing`: the smaller of the box along the axes and of
    /// one along that vector.
    pub fn of_points<I: Iterator<Item = DVec3>>(points: impl Fn() -> I, facing: DVec3) -> Oriented {
        let straight = Oriented::around(DMat3::IDENTITY, &points);
        if facing == DVec3::ZERO {
            return straight;
        }
        let turned = Oriented::around(frame(facing, spread(&points, facing)), &points);
        if turned.surface() < straight.surface() { turned } else { straight }
    }

    /// The box of points along the columns of a matrix.
    fn around<I: Iterator<Item = DVec3>>(axes: DMat3, points: impl Fn() -> I) -> Oriented {
        let single = |v: DVec3| v.as_vec3().to_array();
        let axes = [axes.x_axis, axes.y_axis, axes.z_axis].map(single);
        // Along the axes as they are kept, not as they were meant.
        let kept = axes.map(|a| DVec3::from(a.map(f64::from)));
        let along = |p: DVec3| DVec3::from(kept.map(|axis| axis.dot(p)));
        let fold = |(low, high): (DVec3, DVec3), p| (low.min(along(p)), high.max(along(p)));
        let (low, high) = points().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), fold);
        let middle = (low + high) / 2.0;
        let center = single(kept[0] * middle.x + kept[1] * middle.y + kept[2] * middle.z);
        let at = along(DVec3::from(center.map(f64::from)));
        let half = (high - at).max(at - low).max(DVec3::ZERO);
        Oriented { center, axes, half: half.to_array().map(|h| (h as f32).next_up()) }
    }

    /// A measure of the area of the box.
    fn surface(&self) -> f32 {
        let [a, b, c] = self.half;
        a * b + b * c + c * a
    }
}

fn length(side: DVec3) -> f64 {
    side.length_squared()
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

/// Eight boxes, each number of all of them side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eight {
    center: [[f32; LANES]; 3],
    axes: [[[f32; LANES]; 3]; 3],
    half: [[f32; LANES]; 3],
}

impl Eight {
    pub const EMPTY: Eight =
        Eight { center: [[0.0; LANES]; 3], axes: [[[0.0; LANES]; 3]; 3], half: [[0.0; LANES]; 3] };

    /// Puts a box into a lane.
    pub fn set(&mut self, lane: usize, b: &Oriented) {
        for i in 0..3 {
            self.center[i][lane] = b.center[i];
            self.half[i][lane] = b.half[i];
            (0..3).for_each(|k| self.axes[i][k][lane] = b.axes[i][k]);
        }
    }

    /// The box in a lane.
    pub fn get(&self, lane: usize) -> Oriented {
        Oriented {
            center: self.center.map(|c| c[lane]),
            axes: self.axes.map(|axis| axis.map(|c| c[lane])),
            half: self.half.map(|c| c[lane]),
        }
    }

    /// The squares of the distances of a point from the boxes.
    #[inline]
    pub fn away(&self, at: [f32; 3]) -> [f32; LANES] {
        // Loops over lanes alone, which compilers turn into vectors.
        let mut from = [[0.0; LANES]; 3];
        for k in 0..3 {
            for (from, center) in from[k].iter_mut().zip(&self.center[k]) {
                *from = at[k] - center;
            }
        }
        let [x, y, z] = &from;
        let mut squares = [0.0; LANES];
        for k in 0..3 {
            let ([u, v, w], half) = (&self.axes[k], &self.half[k]);
            for i in 0..LANES {
                let along = x[i] * u[i] + y[i] * v[i] + z[i] * w[i];
                let beyond = along.abs() - half[i];
                let beyond = if beyond > 0.0 { beyond } else { 0.0 };
                squares[i] += beyond * beyond;
            }
        }
        squares
    }
}
