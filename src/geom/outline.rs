//! Outlines drawn with a pen: lines and Bezier curves become contours of chords.

use glam::DVec2;

use super::{
    Contour, EdgeCurve, Tolerance,
    flatten::{self, Chords},
};

/// The cosine of the turn, 10 degrees, up to which two curves in a row are drawn as one.
const SMOOTH: f64 = 0.985;

/// Collects contours from pen strokes, in millimetres. Every subpath is closed.
///
/// ```
/// use glam::dvec2;
/// use katachi::geom::{Tolerance, outline::Outline};
/// let mut pen = Outline::new(Tolerance::DEFAULT);
/// pen.move_to(dvec2(0., 0.));
/// pen.line_to(dvec2(2., 0.));
/// pen.line_to(dvec2(0., 2.));
/// assert_eq!(pen.take()[0].area(), 2.0);
/// ```
#[derive(Debug)]
pub struct Outline {
    tolerance: Tolerance,
    contours: Vec<Contour>,
    open: Contour,
    at: DVec2,
    /// The number of the last smooth curve and its direction at its end.
    curve: Option<(u32, DVec2)>,
    free: u32,
    most_chords: u32,
}

impl Outline {
    /// An outline without contours, whose curves follow `tolerance`.
    pub fn new(tolerance: Tolerance) -> Outline {
        Outline {
            tolerance,
            contours: vec![],
            open: Contour::default(),
            at: DVec2::ZERO,
            curve: None,
            free: 0,
            most_chords: 0,
        }
    }

    /// Closes the subpath and begins another one.
    pub fn move_to(&mut self, p: DVec2) {
        self.close();
        self.at = p;
    }

    /// A straight edge.
    pub fn line_to(&mut self, p: DVec2) {
        self.curve = None;
        self.edge(p, EdgeCurve::Line);
    }

    /// A quadratic Bezier curve with one control point.
    pub fn quad_to(&mut self, c: DVec2, p: DVec2) {
        let from = self.at;
        let curve = self.smooth(c - from, p - c, p - from);
        self.chords(flatten::quadratic([from, c, p], self.tolerance), curve);
    }

    /// A cubic Bezier curve with two control points.
    pub fn cubic_to(&mut self, c: DVec2, d: DVec2, p: DVec2) {
        let from = self.at;
        let chord = p - from;
        let start = if c == from { chord } else { c - from };
        let curve = self.smooth(start, if d == p { chord } else { p - d }, chord);
        self.chords(flatten::cubic([from, c, d, p], self.tolerance), curve);
    }

    fn chords(&mut self, chords: Chords, curve: EdgeCurve) {
        self.most_chords = self.most_chords.max(chords.needed);
        chords.points.into_iter().for_each(|point| self.edge(point, curve));
    }

    /// The most chords that a curve needed so far. One that needs more than [`flatten::MOST_CHORDS`] was
    /// drawn coarser than the tolerance asks for: refuse it.
    pub fn most_chords(&self) -> u32 {
        self.most_chords
    }

    /// The curve that begins in direction `start` and ends in direction `end`: the one before, if it
    /// goes on smoothly.
    fn smooth(&mut self, start: DVec2, end: DVec2, chord: DVec2) -> EdgeCurve {
        let direction = |v: DVec2| v.try_normalize().or(chord.try_normalize()).unwrap_or(DVec2::X);
        let goes_on = self.curve.filter(|(_, before)| before.dot(direction(start)) >= SMOOTH);
        let number = goes_on.map_or(self.free, |(number, _)| number);
        self.free = self.free.max(number + 1);
        self.curve = Some((number, direction(end)));
        EdgeCurve::Smooth(number)
    }

    fn edge(&mut self, p: DVec2, curve: EdgeCurve) {
        if p != self.at {
            self.open.points.push(self.at);
            self.open.curves.push(curve);
            self.at = p;
        }
    }

    /// Closes the subpath with a straight edge, where it is not closed yet.
    pub fn close(&mut self) {
        let contour = std::mem::take(&mut self.open);
        self.curve = None;
        let Some(&start) = contour.points.first() else { return };
        self.open = contour;
        self.edge(start, EdgeCurve::Line);
        let closed = std::mem::take(&mut self.open);
        if closed.points.len() >= 3 {
            self.contours.push(closed);
        }
    }

    /// The contours drawn since the last call, in order; curves go on being numbered.
    pub fn take(&mut self) -> Vec<Contour> {
        self.close();
        std::mem::take(&mut self.contours)
    }
}
