//! SPLINE entities: rational B-splines by de Boor's algorithm.

use glam::{DVec2, DVec3, dvec3};

use super::{DXF, chain::Chain, entity::Entity};
use crate::{
    geom::{EdgeCurve, Tolerance},
    input::ReadError,
};

/// The most halvings of a knot span.
const MOST_HALVINGS: u32 = 12;

/// The highest degree read.
const MOST_DEGREE: usize = 25;

struct Spline {
    degree: usize,
    knots: Vec<f64>,
    /// Control points (w x, w y, w).
    poles: Vec<DVec3>,
}

/// The chain of a SPLINE; one given by fit points alone is drawn as the polyline through them.
pub(super) fn chain(entity: &Entity, fine: Tolerance, number: u32) -> Result<Chain, ReadError> {
    let poles = entity.points(10)?;
    let closed_flag = entity.flag(1)?;
    let points = if poles.is_empty() {
        entity.points(11)?
    } else {
        let spline = spline(entity, &poles)?;
        spline.sampled(fine)?
    };
    let curves = vec![EdgeCurve::Smooth(number); points.len()];
    let mut chain = Chain { points, curves, closed: false };
    let repeats = chain.points.len() > 3 && chain.points.first() == chain.points.last();
    if repeats {
        chain.points.pop();
        chain.curves.pop();
        chain.closed = true;
    } else if closed_flag && chain.points.len() > 2 {
        chain.closed = true;
    } else {
        chain.curves.pop();
    }
    Ok(chain)
}

fn spline(entity: &Entity, poles: &[DVec2]) -> Result<Spline, ReadError> {
    let degree = entity.number(71, 3.0)? as usize;
    let (knots, weights) = (entity.numbers(40)?, entity.numbers(41)?);
    let ordered = knots.windows(2).all(|k| k[0] <= k[1]);
    let counts = (1..=MOST_DEGREE).contains(&degree)
        && poles.len() > degree
        && knots.len() == poles.len() + degree + 1;
    if !counts || !ordered {
        let found =
            format!("degree {degree}, {} control points, {} knots", poles.len(), knots.len());
        return Err(entity
            .error(found, "as many rising knots as control points and degree and 1 are needed"));
    }
    let weight = |i: usize| weights.get(i).copied().filter(|w| *w > 0.0).unwrap_or(1.0);
    let lifted = poles.iter().enumerate().map(|(i, p)| dvec3(p.x, p.y, 1.0) * weight(i));
    Ok(Spline { degree, knots, poles: lifted.collect() })
}

impl Spline {
    /// The point at `t` in the knot span that begins with knot `span`.
    fn at(&self, t: f64, span: usize) -> DVec2 {
        let p = self.degree;
        let mut d: Vec<DVec3> = self.poles[span - p..=span].to_vec();
        for level in 1..=p {
            for j in (level..=p).rev() {
                let (low, high) = (self.knots[span + j - p], self.knots[span + j + 1 - level]);
                let a = if high > low { (t - low) / (high - low) } else { 0.0 };
                d[j] = d[j - 1].lerp(d[j], a);
            }
        }
        d[p].truncate() / d[p].z
    }

    fn sampled(&self, fine: Tolerance) -> Result<Vec<DVec2>, ReadError> {
        let mut points: Vec<DVec2> = vec![];
        for span in self.degree..self.poles.len() {
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if from >= to {
                continue;
            }
            if points.is_empty() {
                points.push(self.at(from, span));
            }
            let ends = ((from, self.at(from, span)), (to, self.at(to, span)));
            if !self.halve(span, ends, fine, MOST_HALVINGS, &mut points) {
                let limit = format!("{} chords a knot span", 1 << MOST_HALVINGS);
                return Err(DXF.limit("a SPLINE of more chords at this tolerance", limit));
            }
        }
        Ok(points)
    }

    /// Adds corners behind the first end up to the second, so that quarter points lie near the chords. Whether
    /// all do.
    fn halve(
        &self,
        span: usize,
        ((from, p), (to, q)): ((f64, DVec2), (f64, DVec2)),
        fine: Tolerance,
        halvings: u32,
        points: &mut Vec<DVec2>,
    ) -> bool {
        let middle = from.midpoint(to);
        let m = self.at(middle, span);
        let probes = [self.at(from.midpoint(middle), span), m, self.at(middle.midpoint(to), span)];
        let flat = probes.iter().all(|r| off_chord(*r, p, q) <= fine.mm());
        // A whole span is halved once at least: an S passes near its chord.
        if halvings == 0 || (flat && halvings < MOST_HALVINGS) {
            points.push(q);
            return flat;
        }
        self.halve(span, ((from, p), (middle, m)), fine, halvings - 1, points)
            && self.halve(span, ((middle, m), (to, q)), fine, halvings - 1, points)
    }
}

fn off_chord(r: DVec2, p: DVec2, q: DVec2) -> f64 {
    let d = q - p;
    let t = ((r - p).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    let t = if t.is_nan() { 0.0 } else { t };
    r.distance(p + d * t)
}
