//! The nearest point of a triangle, and on which of its features it lies.

use glam::DVec3;

/// What a nearest point lies on, by numbers of the mesh.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Feature {
    /// Inside of a face.
    Face(u32),
    /// On the edge between two points, the smaller number first.
    Edge(u32, u32),
    /// On a point.
    Vertex(u32),
}

/// Where on a triangle a point lies: within it, on edge k (from corner k to the next) or at corner k.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Part {
    Inside,
    Edge(usize),
    Corner(usize),
}

/// A triangle ready for many questions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Triangle {
    a: DVec3,
    ab: DVec3,
    ac: DVec3,
}

impl Triangle {
    pub fn new([a, b, c]: [DVec3; 3]) -> Triangle {
        Triangle { a, ab: b - a, ac: c - a }
    }

    /// The unit normal; zero for a triangle without area.
    pub fn normal(&self) -> DVec3 {
        self.ab.cross(self.ac).normalize_or_zero()
    }

    /// The nearest point and its part.
    ///
    /// Source: C. Ericson, *Real-Time Collision Detection*, 2005, section 5.1.5; the six products of the
    /// source follow from two.
    #[inline(always)]
    pub fn nearest(&self, p: DVec3) -> (DVec3, Part) {
        let ap = p - self.a;
        let (d1, d2) = (self.ab.dot(ap), self.ac.dot(ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (self.a, Part::Corner(0));
        }
        let (bb, bc, cc) = (self.ab.dot(self.ab), self.ab.dot(self.ac), self.ac.dot(self.ac));
        let (d3, d4) = (d1 - bb, d2 - bc);
        if d3 >= 0.0 && d4 <= d3 {
            return (self.a + self.ab, Part::Corner(1));
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (self.a + self.ab * (d1 / bb), Part::Edge(0));
        }
        let (d5, d6) = (d1 - bc, d2 - cc);
        if d6 >= 0.0 && d5 <= d6 {
            return (self.a + self.ac, Part::Corner(2));
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (self.a + self.ac * (d2 / cc), Part::Edge(2));
        }
        let va = d3 * d6 - d5 * d4;
        let (u, v) = (d4 - d3, d5 - d6);
        if va <= 0.0 && u >= 0.0 && v >= 0.0 {
            return (self.a + self.ab + (self.ac - self.ab) * (u / (u + v)), Part::Edge(1));
        }
        let share = 1.0 / (va + vb + vc);
        (self.a + self.ab * (vb * share) + self.ac * (vc * share), Part::Inside)
    }
}
