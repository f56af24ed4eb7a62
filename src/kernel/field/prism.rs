//! Prisms around triangles in one frame, eight at a time: the shadow of a triangle on a plane, and how thick it is
//! across it.
//!
//! Where a surface hardly bends, the plane is nearly that of all triangles, and a prism is hardly larger than its
//! triangle. A point above its side is as far from it as measured, one beyond a corner farther than that.

use glam::{DMat3, DVec2, DVec3, Vec3};

use super::{
    lanes::{LANES, Lanes},
    question::Question,
};

/// Eight prisms, each number of all of them side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prisms {
    /// The direction out of each side, and where along it.
    along: [[Lanes; 2]; 3],
    at: [Lanes; 3],
    /// The middle of the thickness, and half of it.
    middle: Lanes,
    half: Lanes,
}

impl Prisms {
    /// No prisms: nothing is near to them.
    const EMPTY: Prisms = Prisms {
        along: [[Lanes::ZERO; 2]; 3],
        at: [Lanes::ZERO; 3],
        middle: Lanes::ZERO,
        half: Lanes::all(f32::NEG_INFINITY),
    };

    /// The prisms of at most eight triangles, whose corners are given in the frame.
    fn new(triangles: &[[DVec3; 3]]) -> Prisms {
        let mut made = Prisms::EMPTY;
        for (lane, corners) in triangles.iter().take(LANES).enumerate() {
            made.set(lane, *corners);
        }
        made
    }

    fn set(&mut self, lane: usize, corners: [DVec3; 3]) {
        let [a, b, c] = corners.map(|p| p.truncate());
        let turn = (b - a).perp_dot(c - a).signum();
        for (k, side) in [b - a, c - b, a - c].into_iter().enumerate() {
            let out = (DVec2::new(side.y, -side.x) * turn).normalize_or_zero().as_vec2();
            let heights = [a, b, c].map(|p| out.as_dvec2().dot(p));
            self.along[k][0].set(lane, out.x);
            self.along[k][1].set(lane, out.y);
            let most = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            self.at[k].set(lane, (most as f32).next_up());
        }
        let [a, b, c] = corners.map(|p| p.z);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let middle = ((low + high) / 2.0) as f32;
        let half = (high - f64::from(middle)).max(f64::from(middle) - low);
        self.middle.set(lane, middle);
        self.half.set(lane, (half as f32).next_up());
    }

    /// The squares of the distances of a point from the triangles, or less.
    #[inline]
    pub fn away(&self, at: Vec3) -> Lanes {
        let [x, y, z] = at.to_array().map(Lanes::all);
        let beyond = |k: usize| self.along[k][0] * x + self.along[k][1] * y - self.at[k];
        let beside = beyond(0).max(beyond(1)).max(beyond(2)).max(Lanes::ZERO);
        let above = ((z - self.middle).abs() - self.half).max(Lanes::ZERO);
        beside * beside + above * above
    }
}

/// Prisms in their frame.
#[derive(Clone, Debug)]
pub(super) struct Framed {
    origin: DVec3,
    /// From the mesh into the frame.
    turn: DMat3,
    /// The size of coordinates in it.
    reach: f64,
    pub eights: Vec<Prisms>,
}

impl Framed {
    /// The prisms of triangles in their order, about a point, across a direction.
    pub fn new(
        origin: DVec3,
        across: DVec3,
        triangles: impl Iterator<Item = [DVec3; 3]>,
    ) -> Framed {
        let z = across.try_normalize().unwrap_or(DVec3::Z);
        let (x, y) = z.any_orthonormal_pair();
        let turn = DMat3::from_cols(x, y, z).transpose();
        let inside = |t: [DVec3; 3]| t.map(|p| turn * (p - origin));
        let triangles: Vec<[DVec3; 3]> = triangles.map(inside).collect();
        let reach = triangles.iter().flatten().map(|p| p.length_squared()).fold(0.0, f64::max);
        let eights = triangles.chunks(LANES).map(Prisms::new).collect();
        Framed { origin, turn, reach: reach.sqrt(), eights }
    }

    /// A point in the frame.
    #[inline]
    pub fn question(&self, p: DVec3) -> Question {
        Question::new(self.turn * (p - self.origin), self.reach)
    }
}
