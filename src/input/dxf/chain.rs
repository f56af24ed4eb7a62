//! Chains of edges, and joining them to closed outlines.

use glam::{DAffine2, DVec2, dvec2};
use rustc_hash::FxHashMap;

use super::{
    DXF, JOIN,
    entity::{Entity, Vertex},
};
use crate::{
    geom::{Contour, EdgeCurve, Tolerance, flatten, trig},
    input::{Place, ReadError},
};

/// Corners in a row; edge i runs from corner i to the next one.
pub(super) struct Chain {
    /// The corners; a closed chain does not repeat its first one.
    pub points: Vec<DVec2>,
    /// The curves of its edges.
    pub curves: Vec<EdgeCurve>,
    /// Whether the last corner joins the first.
    pub closed: bool,
}

impl Chain {
    /// A LINE.
    pub fn line(entity: &Entity) -> Result<Chain, ReadError> {
        let points = vec![entity.point(10)?, entity.point(11)?];
        Ok(Chain { points, curves: vec![EdgeCurve::Line], closed: false })
    }

    /// An ARC between two angles in degrees, counter-clockwise, or a CIRCLE.
    pub fn arc(
        entity: &Entity,
        (from, to): (f64, f64),
        fine: Tolerance,
    ) -> Result<Chain, ReadError> {
        let (center, radius) = (entity.point(10)?, entity.number(40, 0.0)?);
        if radius <= 0.0 {
            return Err(entity.error(format!("a radius of {radius}"), "a positive one is needed"));
        }
        let span = turn(to - from);
        let at =
            |degrees: f64| center + dvec2(trig::cos_deg(degrees), trig::sin_deg(degrees)) * radius;
        swept(entity, (from, span), EdgeCurve::Circle { center, radius }, radius, fine, at)
    }

    /// An ELLIPSE, whole or part.
    pub fn ellipse(entity: &Entity, fine: Tolerance, number: u32) -> Result<Chain, ReadError> {
        let (center, major) = (entity.point(10)?, entity.point(11)?);
        let minor = major.perp() * entity.number(40, 1.0)?;
        let from = entity.number(41, 0.0)?.to_degrees();
        let to = entity.number(42, std::f64::consts::TAU)?.to_degrees();
        let radius = major.length().max(minor.length());
        if major.length() <= 0.0 || minor.length() <= 0.0 {
            return Err(entity.error("an axis of length 0".into(), "two axes are needed"));
        }
        let at =
            |degrees: f64| center + major * trig::cos_deg(degrees) + minor * trig::sin_deg(degrees);
        swept(entity, (from, turn(to - from)), EdgeCurve::Smooth(number), radius, fine, at)
    }

    /// A polyline with bulges.
    pub fn polyline(
        entity: &Entity,
        vertices: &[Vertex],
        fine: Tolerance,
    ) -> Result<Chain, ReadError> {
        let closed = entity.flag(1)?;
        let mut chain = Chain { points: vec![], curves: vec![], closed };
        for (i, &(p, bulge)) in vertices.iter().enumerate() {
            let last = i + 1 == vertices.len();
            chain.points.push(p);
            if last && !closed {
                break;
            }
            let next = vertices[if last { 0 } else { i + 1 }].0;
            chain.bulge(p, next, bulge, fine)?;
        }
        Ok(chain)
    }

    /// The edges of an arc from p to q that turns by four times the arc tangent of `bulge`.
    fn bulge(&mut self, p: DVec2, q: DVec2, bulge: f64, fine: Tolerance) -> Result<(), ReadError> {
        let height = (q - p).perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let center = p.midpoint(q) + height;
        let radius = center.distance(p);
        if bulge == 0.0 || p == q || !radius.is_finite() {
            self.curves.push(EdgeCurve::Line);
            return Ok(());
        }
        let angle = 4.0 * libm::atan(bulge);
        let circle = EdgeCurve::Circle { center, radius };
        let chords = flatten::arc_chords(radius, angle, fine);
        DXF.chords("a bulge", chords)?;
        for i in 1..chords {
            let degrees = angle.to_degrees() * f64::from(i) / f64::from(chords);
            let turn = dvec2(trig::cos_deg(degrees), trig::sin_deg(degrees));
            self.points.push(center + turn.rotate(p - center));
        }
        self.curves.extend((0..chords).map(|_| circle));
        Ok(())
    }

    /// The chain after a map; circles that do not stay circles become the smooth curve `number` + 1.
    pub fn placed(mut self, map: &DAffine2, number: u32) -> Chain {
        let (x, y) = (map.matrix2.x_axis, map.matrix2.y_axis);
        const SIMILARITY: f64 = 1e-9;
        let square = x.length_squared();
        let similar = (y.length_squared() - square).abs() <= SIMILARITY * square
            && x.dot(y).abs() <= SIMILARITY * square;
        for p in &mut self.points {
            *p = map.transform_point2(*p);
        }
        for curve in &mut self.curves {
            *curve = match *curve {
                EdgeCurve::Circle { center, radius } if similar => EdgeCurve::Circle {
                    center: map.transform_point2(center),
                    radius: radius * x.length(),
                },
                EdgeCurve::Circle { .. } => EdgeCurve::Smooth(number + 1),
                other => other,
            };
        }
        self
    }

    fn ends(&self) -> [DVec2; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    fn reversed(mut self) -> Chain {
        self.points.reverse();
        self.curves.reverse();
        self
    }
}

/// An angle in (0, 360].
fn turn(degrees: f64) -> f64 {
    let rest = degrees % 360.0;
    if rest <= 0.0 { rest + 360.0 } else { rest }
}

/// A curve given by an angle, from `from` over `span` degrees.
fn swept(
    entity: &Entity,
    (from, span): (f64, f64),
    curve: EdgeCurve,
    radius: f64,
    fine: Tolerance,
    at: impl Fn(f64) -> DVec2,
) -> Result<Chain, ReadError> {
    const WHOLE: f64 = 360.0 - 1e-9;
    let closed = span >= WHOLE;
    let chords =
        flatten::arc_chords(radius, span.to_radians(), fine).max(if closed { 3 } else { 1 });
    DXF.chords(entity.kind, chords)?;
    let corners = if closed { 0..chords } else { 0..chords + 1 };
    let points = corners.map(|i| at(from + span * f64::from(i) / f64::from(chords))).collect();
    Ok(Chain { points, curves: vec![curve; chords as usize], closed })
}

/// The ends of open chains by place, in cells as wide as ends may be apart.
struct Ends(FxHashMap<(i64, i64), Vec<usize>>);

impl Ends {
    fn new(chains: &[Option<Chain>]) -> Ends {
        let mut ends = Ends(FxHashMap::default());
        for (i, chain) in chains.iter().enumerate() {
            for end in chain.iter().flat_map(Chain::ends) {
                ends.0.entry(Ends::cell(end)).or_default().push(i);
            }
        }
        ends
    }

    fn cell(p: DVec2) -> (i64, i64) {
        ((p.x / JOIN).floor() as i64, (p.y / JOIN).floor() as i64)
    }

    /// The nearest chain with an end at `p`, taken from `chains`, its near end first.
    fn take(&mut self, p: DVec2, chains: &mut [Option<Chain>]) -> Option<Chain> {
        let (x, y) = Ends::cell(p);
        let mut best: Option<(f64, usize, bool)> = None;
        for cell in (0..9).map(|i| (x.saturating_add(i % 3 - 1), y.saturating_add(i / 3 - 1))) {
            let Some(here) = self.0.get_mut(&cell) else { continue };
            here.retain(|&i| chains[i].is_some());
            for &i in here.iter() {
                let [start, end] = chains[i].as_ref().map_or([DVec2::NAN; 2], Chain::ends);
                for (near, backwards) in [(start.distance(p), false), (end.distance(p), true)] {
                    let key = (near, i, backwards);
                    if near <= JOIN && best.is_none_or(|b| key < b) {
                        best = Some(key);
                    }
                }
            }
        }
        let (_, i, backwards) = best?;
        let chain = chains[i].take()?;
        Some(if backwards { chain.reversed() } else { chain })
    }
}

/// The closed outlines of chains.
pub(super) fn joined(chains: Vec<Chain>) -> Result<Vec<Contour>, ReadError> {
    let (closed, open): (Vec<Chain>, Vec<Chain>) = chains.into_iter().partition(|c| c.closed);
    let contour = |c: Chain| Contour { points: c.points, curves: c.curves };
    let mut contours: Vec<Contour> = closed.into_iter().map(contour).collect();
    let mut open: Vec<Option<Chain>> = open.into_iter().map(Some).collect();
    let mut ends = Ends::new(&open);
    for i in 0..open.len() {
        let Some(mut chain) = open[i].take() else { continue };
        while !meets(&chain) {
            let [start, end] = chain.ends();
            let Some(next) = ends.take(end, &mut open) else {
                let gap = start.distance(end);
                let found = format!(
                    "an outline from ({}, {}) to ({}, {}) mm, {gap} mm apart",
                    start.x, start.y, end.x, end.y
                );
                return Err(DXF.error(
                    Place::File,
                    found,
                    format!("its ends must meet within {JOIN} mm"),
                ));
            };
            chain.points.extend_from_slice(&next.points[1..]);
            chain.curves.extend_from_slice(&next.curves);
        }
        chain.points.pop();
        contours.push(contour(chain));
    }
    Ok(contours)
}

/// Whether the ends of a chain of two edges or more meet.
fn meets(chain: &Chain) -> bool {
    let [start, end] = chain.ends();
    chain.points.len() > 2 && start.distance(end) <= JOIN
}
