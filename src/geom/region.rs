//! Regions of a plane bounded by polygons: what profiles become when they are realised.

use glam::DVec2;

/// A closed polygon in a plane, millimetres: the last point joins the first, none is repeated.
///
/// Edge `i` runs from point `i` to the next one. `curves[i]` says which true curve it approximates.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Contour {
    /// Corners.
    pub points: Vec<DVec2>,
    /// For each edge the curve it stands for.
    pub curves: Vec<EdgeCurve>,
}

/// The curve that an edge of a contour approximates.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum EdgeCurve {
    /// The straight edge itself.
    Line,
    /// A circle about `center`; the edge is one of its chords.
    Circle {
        /// Centre.
        center: DVec2,
        /// Radius.
        radius: f64,
    },
    /// Some smooth curve, known by a number that neighbouring edges of the same curve share.
    Smooth(u32),
}

/// An edge of a contour.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Edge {
    /// Where it starts, mm.
    pub from: DVec2,
    /// Where it ends, mm.
    pub to: DVec2,
    /// The curve it stands for.
    pub curve: EdgeCurve,
}

impl Contour {
    /// Its edges in order, the first from the first point.
    pub fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().zip(next).enumerate().map(|(i, (&from, &to))| {
            let curve = self.curves.get(i).copied().unwrap_or(EdgeCurve::Line);
            Edge { from, to, curve }
        })
    }

    /// A contour of straight edges.
    pub fn polygon(points: Vec<DVec2>) -> Contour {
        let curves = vec![EdgeCurve::Line; points.len()];
        Contour { points, curves }
    }

    /// The centre and radius of the circle that all its edges are chords of, if there is one.
    ///
    /// ```
    /// use glam::{DVec2, dvec2};
    /// use katachi::geom::{Contour, EdgeCurve};
    /// let circle = EdgeCurve::Circle { center: DVec2::ZERO, radius: 2.0 };
    /// let points = vec![dvec2(2., 0.), dvec2(0., 2.), dvec2(-2., 0.), dvec2(0., -2.)];
    /// assert_eq!(Contour { points, curves: vec![circle; 4] }.circle(), Some((DVec2::ZERO, 2.0)));
    /// ```
    pub fn circle(&self) -> Option<(DVec2, f64)> {
        let first = self.edges().next()?.curve;
        let EdgeCurve::Circle { center, radius } = first else { return None };
        self.edges().all(|e| e.curve == first).then_some((center, radius))
    }

    /// Signed area in mm^2, positive when the corners run counter-clockwise.
    ///
    /// ```
    /// use glam::dvec2;
    /// use katachi::geom::Contour;
    /// let square = vec![dvec2(0., 0.), dvec2(2., 0.), dvec2(2., 2.), dvec2(0., 2.)];
    /// assert_eq!(Contour::polygon(square).area(), 4.0);
    /// ```
    pub fn area(&self) -> f64 {
        let Some(&base) = self.points.first() else { return 0.0 };
        let pairs = self.points.windows(2);
        pairs.map(|p| (p[0] - base).perp_dot(p[1] - base)).sum::<f64>() / 2.0
    }
}

/// One connected piece of a region.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Piece {
    /// Its outer boundary, counter-clockwise.
    pub outer: Contour,
    /// Its holes, clockwise.
    pub holes: Vec<Contour>,
}

/// A set of disjoint pieces; contours touch at single points at most.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Region {
    /// The pieces, in a fixed order that depends on the input alone.
    pub pieces: Vec<Piece>,
}

impl Region {
    /// All contours, each outer boundary before its holes.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        self.pieces.iter().flat_map(|p| std::iter::once(&p.outer).chain(&p.holes))
    }

    /// Area in mm^2, holes left out.
    pub fn area(&self) -> f64 {
        self.contours().map(Contour::area).sum()
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }
}
