//! Chains of chords as they are drawn: straight lines, arcs of ellipses, or a few cubic curves.

use std::f64::consts::TAU;

use glam::DVec2;

use super::{
    LOOSE,
    chain::Chord,
    conic::Ellipse,
    count::Stretch,
    drawing::{Path, Segment},
    meet::Strand,
    model::Model,
};

/// A point of a curve in the picture, and the unit tangent there.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// The point, mm.
    pub at: DVec2,
    /// The unit tangent.
    pub tangent: DVec2,
}

/// Images that move slower than this part of the curve itself are at a cusp: their direction is rounding.
const CUSP: f64 = 1e-4;

/// What a part of a chain is on paper.
#[derive(Clone, PartialEq, Debug)]
pub enum Shape {
    /// Between two points.
    Straight(DVec2, DVec2),
    /// Part of an ellipse, counter-clockwise between two parameters, the second one larger.
    Arc(Ellipse, f64, f64),
    /// Something else.
    Curve(Path),
}

/// A chain on paper, ready to be asked for its parts.
pub struct Fitted<'a> {
    model: &'a Model,
    chain: &'a [Chord],
    /// The corners of the chain, one more than chords.
    nodes: Vec<Node>,
    /// Whether all of it is on one line.
    straight: bool,
    ellipse: Option<Ellipse>,
    tolerance: f64,
}

impl<'a> Fitted<'a> {
    /// A chain whose shapes are within `tolerance` mm.
    pub fn new(model: &'a Model, chain: &'a [Chord], tolerance: f64) -> Fitted<'a> {
        let mut fitted =
            Fitted { model, chain, nodes: vec![], straight: false, ellipse: None, tolerance };
        fitted.nodes = (0..=chain.len()).map(|i| fitted.corner(i)).collect();
        let mut points: Vec<DVec2> = fitted.nodes.iter().map(|n| n.at).collect();
        if points.len() < 12 {
            points =
                (0..=12).map(|i| fitted.point(chain.len() as f64 * f64::from(i) / 12.0)).collect();
        }
        fitted.straight = is_straight(&points, tolerance);
        if !fitted.straight {
            fitted.ellipse = Ellipse::through(&points, tolerance);
        }
        fitted
    }

    fn strand(&self, number: usize) -> Strand<'a> {
        let chord = self.chain[number];
        Strand::new(self.model, self.model.edges[chord.edge as usize].curve, chord.ends)
    }

    /// The point over a place of the chain.
    fn point(&self, at: f64) -> DVec2 {
        let number = (at as usize).min(self.chain.len() - 1);
        let p = self.strand(number).at(&self.model.camera, at - number as f64);
        self.model.camera.image(p).0
    }

    fn corner(&self, i: usize) -> Node {
        let chord = self.chain[i.min(self.chain.len() - 1)];
        let end = chord.ends[usize::from(i == self.chain.len())];
        self.node(i.min(self.chain.len() - 1), self.model.space[end as usize])
    }

    /// A point of the curve over a chord.
    fn node(&self, number: usize, p: glam::DVec3) -> Node {
        let camera = &self.model.camera;
        let velocity = camera.image_velocity(p, self.strand(number).tangent(camera, p));
        let at = camera.image(p).0;
        let tangent = if velocity.length() > CUSP { velocity.normalize() } else { DVec2::ZERO };
        Node { at, tangent }
    }

    /// Calls with the shapes of a part of the chain.
    pub fn shapes(&self, stretch: &Stretch, mut found: impl FnMut(Shape)) {
        let nodes = self.part(stretch);
        let points: Vec<DVec2> = nodes.iter().map(|n| n.at).collect();
        if self.straight {
            let (low, high) = extremes(&points);
            return found(Shape::Straight(low, high));
        }
        if let Some(ellipse) = &self.ellipse {
            return found(self.arc(ellipse, stretch, &points));
        }
        runs(&nodes, self.tolerance, found);
    }

    /// The nodes of a part of the chain.
    fn part(&self, stretch: &Stretch) -> Vec<Node> {
        let last = self.chain.len() - 1;
        let [first, end] = [stretch.from.0, stretch.to.0].map(|at| (at as usize).min(last));
        let mut nodes = vec![self.node(first, stretch.from.1)];
        let inner = (first + 1..=end).map(|i| self.nodes[i]);
        nodes.extend(inner);
        nodes.push(self.node(end, stretch.to.1));
        nodes.dedup_by(|b, a| a.at.distance(b.at) <= self.tolerance);
        if nodes.len() < 2 {
            nodes.push(self.node(end, stretch.to.1));
        }
        settle_cusps(&mut nodes);
        nodes
    }

    /// The arc through points of an ellipse.
    fn arc(&self, ellipse: &Ellipse, stretch: &Stretch, points: &[DVec2]) -> Shape {
        let (start, end) = (points[0], points[points.len() - 1]);
        let middle = if points.len() > 2 {
            points[points.len() / 2]
        } else {
            self.point((stretch.from.0 + stretch.to.0) / 2.0)
        };
        let long = start.distance(middle) + middle.distance(end);
        let [s, m, e] = [start, middle, end].map(|p| ellipse.parameter(p));
        let after = |from: f64, t: f64| (t - from).rem_euclid(TAU);
        let short = long < ellipse.minor.length() / 4.0;
        if start.distance(end) <= self.tolerance && !short {
            return Shape::Arc(*ellipse, s, s + TAU);
        }
        // Of a short arc the middle is too near to the ends to tell the way.
        let forwards = if short { after(s, e) <= after(e, s) } else { after(s, m) <= after(s, e) };
        if forwards {
            Shape::Arc(*ellipse, s, s + after(s, e))
        } else {
            Shape::Arc(*ellipse, e, e + after(e, s))
        }
    }
}

/// Calls with the shapes of a smooth line through nodes: straight runs and curves.
fn runs(nodes: &[Node], tolerance: f64, mut found: impl FnMut(Shape)) {
    let points: Vec<DVec2> = nodes.iter().map(|n| n.at).collect();
    let mut from = 0;
    while from + 1 < nodes.len() {
        let (to, straight) = run(&points, from, tolerance);
        found(if straight {
            Shape::Straight(points[from], points[to])
        } else {
            Shape::Curve(cubics(&nodes[from..=to], tolerance * LOOSE))
        });
        from = to;
    }
}

/// How far a line goes on from a point without changing between straight and bent.
fn run(points: &[DVec2], from: usize, tolerance: f64) -> (usize, bool) {
    let bent = |i: usize| i + 2 < points.len() && !is_straight(&points[i..i + 3], tolerance);
    let last = points.len() - 1;
    if from + 2 > last || bent(from) {
        let to = (from + 1..last).find(|&i| i + 3 < last && !bent(i) && !bent(i + 1));
        return (to.unwrap_or(last), false);
    }
    let mut to = from + 2;
    while to < last && is_straight(&points[from..=to + 1], tolerance) {
        to += 1;
    }
    (to, true)
}

/// Calls with the shapes of a smooth line through nodes; one that is straight all along is one piece.
pub fn through(nodes: &[Node], tolerance: f64, mut found: impl FnMut(Shape)) {
    let mut nodes = nodes.to_vec();
    nodes.dedup_by(|b, a| a.at.distance(b.at) <= tolerance);
    if nodes.len() < 2 {
        return;
    }
    let points: Vec<DVec2> = nodes.iter().map(|n| n.at).collect();
    let (low, high) = extremes(&points);
    let along = high - low;
    let level = nodes.iter().all(|n| n.tangent.perp_dot(along).abs() <= tolerance);
    if level && is_straight(&points, tolerance) {
        return found(Shape::Straight(low, high));
    }
    runs(&nodes, tolerance, found);
}

/// Gives a node at a cusp the direction of the chord to its neighbour.
fn settle_cusps(nodes: &mut [Node]) {
    let last = nodes.len() - 1;
    for i in 0..=last {
        if nodes[i].tangent == DVec2::ZERO {
            let [from, to] = if i < last { [i, i + 1] } else { [i - 1, i] };
            nodes[i].tangent = (nodes[to].at - nodes[from].at).normalize_or_zero();
        }
    }
}

/// Whether points lie on a line, up to a tolerance.
fn is_straight(points: &[DVec2], tolerance: f64) -> bool {
    let (low, high) = extremes(points);
    let along = (high - low).normalize_or_zero();
    points.iter().all(|p| along.perp_dot(*p - low).abs() <= tolerance)
}

/// The two ends of points that lie on a line.
fn extremes(points: &[DVec2]) -> (DVec2, DVec2) {
    let far = |from: DVec2| {
        let by_distance =
            |a: &&DVec2, b: &&DVec2| a.distance_squared(from).total_cmp(&b.distance_squared(from));
        *points.iter().max_by(by_distance).expect("there are points")
    };
    let low = far(points[0]);
    (low, far(low))
}

/// Cubic curves through nodes, as few as keep within a tolerance of all of them.
fn cubics(nodes: &[Node], tolerance: f64) -> Path {
    let mut segments = vec![];
    let mut i = 0;
    while i + 1 < nodes.len() {
        let mut reach = 1;
        while i + 2 * reach < nodes.len() && fits(&nodes[i..=i + 2 * reach], tolerance) {
            reach *= 2;
        }
        let rest = nodes.len() - 1 - i;
        if reach < rest && fits(&nodes[i..], tolerance) {
            reach = rest;
        }
        segments.push(cubic(&nodes[i], &nodes[i + reach]));
        i += reach;
    }
    Path { start: nodes[0].at, segments }
}

/// The cubic between two nodes that is right to the sixth order for a circle.
pub fn cubic(a: &Node, b: &Node) -> Segment {
    let chord = b.at - a.at;
    let length = chord.length();
    let handle = |tangent: DVec2| {
        let cosine = (tangent.dot(chord) / length).max(0.0);
        2.0 * length / (3.0 * (1.0 + cosine))
    };
    Segment::Cubic {
        first: a.at + a.tangent * handle(a.tangent),
        second: b.at - b.tangent * handle(b.tangent),
        to: b.at,
    }
}

/// Whether the cubic between the first and the last node passes the others and keeps their directions.
fn fits(nodes: &[Node], tolerance: f64) -> bool {
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let segment = cubic(&first, &last);
    let chord = last.at - first.at;
    nodes[1..nodes.len() - 1].iter().all(|node| {
        let mut t = (node.at - first.at).dot(chord) / chord.length_squared();
        for _ in 0..3 {
            let (p, q) = (segment.at(first.at, t), segment.at(first.at, t + STEP));
            let velocity = (q - p) / STEP;
            t += (node.at - p).dot(velocity) / velocity.length_squared();
        }
        (0.0..=1.0).contains(&t) && segment.at(first.at, t).distance(node.at) <= tolerance
    })
}

/// Half the digits of a parameter: differences over it are derivatives to the other half.
const STEP: f64 = 1e-7;
