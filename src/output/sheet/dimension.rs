//! Dimensions after ISO 129-1: extension lines, a dimension line with filled arrows, the number above it, readable
//! from below or from the right.

use glam::{DVec2, dvec2};

use super::{
    lettering::{Anchor, Lettering, write},
    page::{Ink, Mark},
    pen::Layer,
};
use crate::{
    geom::trig::{cos_deg, sin_deg},
    output::drawing::{Path, Segment},
};

/// Between an edge and its extension line, mm.
const GAP: f64 = 1.0;
/// How far extension lines go beyond the dimension line, mm.
const OVERSHOOT: f64 = 2.0;
/// Between the dimension line and the text above it, mm.
const LIFT: f64 = 1.0;
/// Half the width of an arrow for each length of it: a point of about 20 degrees.
const ARROW_SLOPE: f64 = 1.0 / 6.0;

/// A dimension of a drawing: places in mm at scale 1, distances on paper in mm.
#[derive(Clone, PartialEq, Debug)]
pub struct Dimension {
    /// What it shows.
    pub shape: Shape,
    /// What is written, one text for each distance.
    pub texts: Vec<String>,
}

/// The kinds of dimension.
#[derive(Clone, PartialEq, Debug)]
pub enum Shape {
    /// Distances between neighbouring points.
    Linear {
        /// At least two.
        points: Vec<DVec2>,
        /// Unit vector along the dimension line.
        along: DVec2,
        /// From the first point to the dimension line, to the left.
        offset: f64,
    },
    /// A radius or a diameter.
    Round {
        /// Centre.
        center: DVec2,
        /// Radius.
        r: f64,
        /// Whether the line runs through the whole circle.
        diameter: bool,
        /// Direction of the leader, degrees.
        angle: f64,
    },
    /// An angle.
    Angle {
        /// Where the legs meet.
        apex: DVec2,
        /// Points on the two legs.
        legs: [DVec2; 2],
        /// Direction of the first leg, degrees, and the turn from it to the second, counter-clockwise.
        from: f64,
        /// See `from`.
        turn: f64,
        /// Radius of the dimension line, mm on paper.
        r: f64,
    },
}

impl Dimension {
    /// What is drawn of it at a scale.
    pub fn inks(&self, scale: f64, height: f64, lettering: &dyn Lettering) -> Vec<Ink> {
        let mut pen = Pen { height, lettering, inks: vec![] };
        match &self.shape {
            Shape::Linear { points, along, offset } => {
                let points: Vec<DVec2> = points.iter().map(|&p| p * scale).collect();
                pen.linear(&points, *along, *offset, &self.texts);
            }
            Shape::Round { center, r, diameter, angle } => {
                let text = self.texts.first().map_or("", |text| text);
                pen.round((*center * scale, *r * scale), *diameter, *angle, text);
            }
            Shape::Angle { apex, legs, from, turn, r } => {
                let text = self.texts.first().map_or("", |text| text);
                let (apex, legs) = (*apex * scale, legs.map(|p| p * scale));
                pen.angle(apex, legs, (*from, *turn, *r), text);
            }
        }
        pen.inks
    }
}

/// A length or angle as it is written: two decimals at most.
///
/// ```
/// use katachi::output::sheet::dimension_number;
/// assert_eq!([40.0, 12.346, 0.5].map(dimension_number), ["40", "12.35", "0.5"]);
/// ```
pub fn dimension_number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

struct Pen<'a> {
    /// Of capitals, mm.
    height: f64,
    lettering: &'a dyn Lettering,
    inks: Vec<Ink>,
}

fn direction(degrees: f64) -> DVec2 {
    dvec2(cos_deg(degrees), sin_deg(degrees))
}

/// The angle of a base line along a direction that is read from below or from the right.
fn readable(along: DVec2) -> f64 {
    let degrees = libm::atan2(along.y, along.x).to_degrees();
    // Rounding must not decide on which side of an upright line its text stands.
    let degrees = (degrees * 1e9).round() / 1e9;
    if degrees > 90.0 {
        degrees - 180.0
    } else if degrees <= -90.0 {
        degrees + 180.0
    } else {
        degrees
    }
}

impl Pen<'_> {
    fn stroke(&mut self, from: DVec2, to: DVec2) {
        if from != to {
            self.inks.push(Ink::stroke(Layer::Dimension, from, to));
        }
    }

    /// An arrow whose point is at `tip`, pointing along a unit vector.
    fn arrow(&mut self, tip: DVec2, along: DVec2) {
        let tail = tip - along * self.height;
        let side = along.perp() * (self.height * ARROW_SLOPE);
        let mark = Mark::Area(vec![vec![tip, tail + side, tail - side]]);
        self.inks.push(Ink { layer: Layer::Dimension, mark, part: None });
    }

    fn text(&mut self, text: &str, at: DVec2, anchor: Anchor, angle: f64) {
        let place = (at, anchor, angle);
        self.inks.push(write(self.lettering, Layer::Dimension, text, self.height, place));
    }

    fn width(&self, text: &str) -> f64 {
        self.lettering.outlines(text, self.height).map_or(0.0, |(_, width)| width)
    }

    fn linear(&mut self, points: &[DVec2], along: DVec2, offset: f64, texts: &[String]) {
        let base = points[0] + along.perp() * offset;
        let feet: Vec<DVec2> =
            points.iter().map(|p| base + along * (*p - base).dot(along)).collect();
        for (point, foot) in points.iter().zip(&feet) {
            let away = (*foot - *point).normalize_or_zero();
            if point.distance(*foot) > GAP {
                self.stroke(*point + away * GAP, *foot + away * OVERSHOOT);
            }
        }
        for (i, ends) in feet.windows(2).enumerate() {
            let text = texts.get(i).map_or("", |text| text);
            self.span(ends[0], ends[1], text, feet.len() == 2);
        }
    }

    /// One stretch of a dimension line; where there is no room for them, arrows come from outside, and so does the
    /// text of a stretch that stands alone.
    fn span(&mut self, from: DVec2, to: DVec2, text: &str, alone: bool) {
        let length = from.distance(to);
        let along = (to - from).normalize_or_zero();
        let (tail, width) = (along * (2.0 * self.height), self.width(text));
        let inside = length >= 3.0 * self.height;
        let beside = alone && width > length - if inside { 0.0 } else { self.height };
        self.stroke(from, to);
        self.arrow(from, if inside { -along } else { along });
        self.arrow(to, if inside { along } else { -along });
        if !inside {
            self.stroke(from - tail, from);
        }
        let angle = readable(along);
        let up = direction(angle).perp() * LIFT;
        if !beside {
            if !inside {
                self.stroke(to, to + tail);
            }
            return self.text(text, from.midpoint(to) + up, Anchor::Middle, angle);
        }
        let end = to + along * (self.height * if inside { 1.0 } else { 2.0 } + width);
        self.stroke(to, end);
        let forwards = along.dot(direction(angle)) > 0.0;
        let anchor = if forwards { Anchor::End } else { Anchor::Start };
        self.text(text, end + up, anchor, angle);
    }

    fn round(&mut self, (center, r): (DVec2, f64), diameter: bool, angle: f64, text: &str) {
        let out = direction(angle);
        let rim = center + out * r;
        let knee = rim + out * (2.5 * self.height);
        let across = diameter && r >= 2.0 * self.height;
        if across {
            self.arrow(rim, out);
            self.arrow(center - out * r, -out);
            self.stroke(center - out * r, knee);
        } else {
            self.arrow(rim, -out);
            self.stroke(rim, knee);
        }
        let right = out.x >= 0.0;
        let reach = self.width(text) + LIFT;
        let end = knee + dvec2(if right { reach } else { -reach }, 0.0);
        self.stroke(knee, end);
        let start = dvec2(knee.x.min(end.x) + LIFT / 2.0, knee.y + LIFT);
        self.text(text, start, Anchor::Start, 0.0);
    }

    fn angle(&mut self, apex: DVec2, legs: [DVec2; 2], line: (f64, f64, f64), text: &str) {
        let (from, turn, r) = line;
        let ends = [from, from + turn].map(direction);
        for (leg, end) in legs.into_iter().zip(ends) {
            let reach = (leg - apex).length();
            if reach + GAP < r {
                self.stroke(leg + end * GAP, apex + end * (r + OVERSHOOT));
            }
        }
        let arc = Segment::Arc {
            center: apex,
            major: dvec2(r, 0.0),
            minor: dvec2(0.0, r),
            from: from.to_radians(),
            to: (from + turn).to_radians(),
        };
        self.inks.push(Ink::line(Layer::Dimension, Path::of(apex + ends[0] * r, arc)));
        let outside = r * turn.to_radians() < 3.0 * self.height;
        let sense = if outside { -1.0 } else { 1.0 };
        self.arrow(apex + ends[0] * r, -ends[0].perp() * sense);
        self.arrow(apex + ends[1] * r, ends[1].perp() * sense);
        let middle = direction(from + turn / 2.0);
        let angle = readable(-middle.perp());
        let up = direction(angle).perp();
        // Outside the arc: the base line of a text that stands below it is a text's height further out.
        let out = if up.dot(middle) > 0.0 { LIFT } else { -(LIFT + self.height) };
        self.text(text, apex + middle * r + up * out, Anchor::Middle, angle);
    }
}
