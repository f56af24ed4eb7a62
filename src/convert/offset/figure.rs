//! What becomes of the surroundings of a point when the faces around it move outwards.
//!
//! Around a point, convex edges part the faces into *runs*. The faces of a run meet in one point again
//! ([`mitre`]); over an edge between two runs an arc goes from one such point to the other, and three or
//! more arcs enclose a cap of a sphere. Where that does not describe the offset, the figure is *open*: every
//! face keeps its own corner, and what joins them goes through the point itself.

use glam::DVec3;

use super::{
    arc::{Angle, arc, cap, evened, swollen},
    mitre::mitre,
    rings::{Bend, Rings},
};

/// Radii, tolerances and limits of an offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// How far faces move, mm.
    pub radius: f64,
    /// Whether convex edges become round; otherwise faces are prolonged until they meet.
    pub round: bool,
    /// Whether facets of spheres and cylinders move as these do.
    pub curved: bool,
    /// Points that may be opened.
    pub crowd: usize,
    /// What a chord may be off its arc, in radii.
    pub chord: f64,
    /// How much the inner points of arcs move outwards, relative to what makes the area of an arc right.
    pub bulge: f64,
    /// What a mitre may be off its planes, and an arc off its edge, in radii.
    pub joint: f64,
}

/// A mitre longer than this many radii leaves its point for another part of the solid.
const LONGEST: f64 = 20.0;
/// The chords of a cap must be shorter than those of an arc, since triangles of a sphere bulge more.
const CAP: f64 = 0.75;
/// How much farther chords may be off an arc before they are [`evened`]: by that the first and the last one come
/// nearer by a sixth at least.
const EVENED: f64 = 1.2;

/// The figure of one point, in radii from it.
#[derive(Debug, Default)]
pub(super) struct Figure {
    /// Offsets, and for the cap those of its inside too.
    pub points: Vec<DVec3>,
    /// For each corner around the point the offsets it becomes, in the order of its face.
    pub corners: Vec<Vec<u32>>,
    /// For each edge around the point the offsets from the corner before it to the corner after it.
    pub chains: Vec<Vec<u32>>,
    /// Triangles of the cap.
    pub cap: Vec<[u32; 3]>,
    /// Whether it is open; then the last offset is the point itself.
    pub open: bool,
}

/// The faces and edges around a point.
pub(super) struct Surroundings {
    normals: Vec<DVec3>,
    /// Unit directions of the edges; edge i lies between faces i and i + 1.
    edges: Vec<DVec3>,
    /// Edges whose faces part.
    sharp: Vec<bool>,
    bends: Vec<Bend>,
}

impl Surroundings {
    pub fn of(rings: &Rings, points: &[DVec3], point: u32, measure: Measure) -> Surroundings {
        let fan = &rings.around[point as usize];
        let normals: Vec<DVec3> = fan.iter().map(|&c| rings.normal(c)).collect();
        let towards = |&c: &u32| points[rings.corners[c as usize].before as usize];
        let edges: Vec<DVec3> =
            fan.iter().map(|c| (towards(c) - points[point as usize]).normalize_or_zero()).collect();
        let n = fan.len();
        let bends: Vec<Bend> =
            (0..n).map(|i| rings.bend(fan[i], fan[(i + 1) % n], edges[i])).collect();
        let parts = |i: usize| {
            let half = normals[i].angle(normals[(i + 1) % n]) / 2.0;
            let round = measure.round && bends[i] == Bend::Convex;
            round && 1.0 / libm::cos(half) - 1.0 > measure.joint
        };
        let sharp = (0..n).map(parts).collect();
        Surroundings { normals, edges, sharp, bends }
    }

    fn len(&self) -> usize {
        self.normals.len()
    }

    /// The figure of the point, which may be wanted open.
    pub fn figure(&self, measure: Measure, open: bool) -> Figure {
        if open {
            return self.open(measure);
        }
        let sharp: Vec<usize> = (0..self.len()).filter(|&i| self.sharp[i]).collect();
        let found = match sharp[..] {
            [] => self.single(measure),
            [edge] => self.ending(edge, measure),
            _ => self.parted(&sharp, measure),
        };
        found.unwrap_or_else(|| self.open(measure))
    }

    /// One point for all faces.
    fn single(&self, measure: Measure) -> Option<Figure> {
        let m = joint(&self.normals, measure)?;
        let each = vec![vec![0]; self.len()];
        Some(Figure { points: vec![m], corners: each.clone(), chains: each, ..Figure::default() })
    }

    /// Two runs with an arc from one to the other, or more with a cap between them.
    fn parted(&self, sharp: &[usize], measure: Measure) -> Option<Figure> {
        let (n, k) = (self.len(), sharp.len());
        let run = |i: usize| {
            let (first, last) = (sharp[i] + 1, sharp[(i + 1) % k] + if i + 1 == k { n } else { 0 });
            (first..=last).map(|c| c % n).collect::<Vec<usize>>()
        };
        let runs: Vec<Vec<usize>> = (0..k).map(run).collect();
        let faces = |run: &Vec<usize>| run.iter().map(|&c| self.normals[c]).collect::<Vec<_>>();
        let joints = runs.iter().map(|run| joint(&faces(run), measure));
        let joints = joints.collect::<Option<Vec<DVec3>>>()?;
        let mut figure = Figure {
            points: joints.clone(),
            corners: vec![vec![]; n],
            chains: vec![vec![]; n],
            ..Figure::default()
        };
        for (i, run) in runs.iter().enumerate() {
            run.iter().for_each(|&c| figure.corners[c] = vec![i as u32]);
            run.iter().take(run.len() - 1).for_each(|&c| figure.chains[c] = vec![i as u32]);
        }
        if k == 2 {
            self.bridge(sharp, &joints, measure, &mut figure)?;
        } else {
            self.dome(sharp, &joints, measure, &mut figure)?;
        }
        Some(figure)
    }

    /// The arc that two edges share: after edge `sharp[0]` comes run 0, after `sharp[1]` run 1.
    fn bridge(
        &self,
        sharp: &[usize],
        joints: &[DVec3],
        measure: Measure,
        figure: &mut Figure,
    ) -> Option<()> {
        let points = self.arc_over(sharp[1], joints[0], joints[1], measure.chord, measure)?;
        self.fits(sharp[0], &points, measure)?;
        let points = evened(points, measure.bulge, measure.chord);
        let inner = points.len() as u32 - 2;
        figure.points.extend(&points[1..points.len() - 1]);
        let chain: Vec<u32> = [0].into_iter().chain(2..2 + inner).chain([1]).collect();
        figure.chains[sharp[0]] = chain.iter().rev().copied().collect();
        figure.chains[sharp[1]] = chain;
        Some(())
    }

    /// Arcs around a cap. The edge before run i is `sharp[i]`.
    fn dome(
        &self,
        sharp: &[usize],
        joints: &[DVec3],
        measure: Measure,
        figure: &mut Figure,
    ) -> Option<()> {
        let k = sharp.len();
        if joints.iter().any(|m| (m.length() - 1.0).abs() > measure.joint) {
            return None;
        }
        let (mut ring, mut numbers) = (vec![], vec![]);
        for i in 0..k {
            let next = (i + 1) % k;
            let chord = CAP * measure.chord;
            let points = self.arc_over(sharp[next], joints[i], joints[next], chord, measure)?;
            let points = evened(points, measure.bulge, chord);
            let first = figure.points.len() as u32;
            figure.points.extend(&points[1..points.len() - 1]);
            let inner = first..figure.points.len() as u32;
            ring.extend(&points[..points.len() - 1]);
            numbers.extend([i as u32].into_iter().chain(inner.clone()));
            figure.chains[sharp[next]] =
                [i as u32].into_iter().chain(inner).chain([next as u32]).collect();
        }
        let (more, triangles) = cap(&ring, span(CAP * measure.chord));
        let first = figure.points.len() as u32;
        figure.points.extend(more);
        let number = |v: u32| match numbers.get(v as usize) {
            Some(&n) => n,
            None => first + v - numbers.len() as u32,
        };
        figure.cap = triangles.into_iter().map(|t| t.map(number)).collect();
        let inner = first as usize..figure.points.len();
        swollen(&mut figure.points, inner, &figure.cap, measure.chord);
        Some(())
    }

    /// An arc from one joint to another that keeps its distance from an edge.
    fn arc_over(
        &self,
        edge: usize,
        from: DVec3,
        to: DVec3,
        chord: f64,
        measure: Measure,
    ) -> Option<Vec<DVec3>> {
        let points = arc(from, to, chords(from.angle(to), chord));
        self.fits(edge, &points, measure)?;
        Some(points)
    }

    /// Whether points are one radius from the line of an edge.
    fn fits(&self, edge: usize, points: &[DVec3], measure: Measure) -> Option<()> {
        let along = self.edges[edge];
        let off = |p: &DVec3| ((*p - along * p.dot(along)).length() - 1.0).abs();
        points.iter().all(|p| off(p) <= measure.joint).then_some(())
    }

    /// The one edge that parts its faces ends in a face across it, in whose plane its arc ends.
    fn ending(&self, edge: usize, measure: Measure) -> Option<Figure> {
        let n = self.len();
        let [first, across, last] = [1, 2, 3].map(|k| (edge + k) % n);
        let plane = self.normals[across];
        let lean = self.edges[edge].dot(plane);
        if n != 3 || lean.abs() < 1.0 / LONGEST {
            return None;
        }
        let (from, to) = (self.normals[last], self.normals[first]);
        let flat = arc(from, to, chords(from.angle(to), measure.chord));
        let flat = evened(flat, measure.bulge, measure.chord);
        let put = |d: &DVec3| *d + self.edges[edge] * ((1.0 - d.dot(plane)) / lean);
        let points: Vec<DVec3> = flat.iter().map(put).collect();
        if points.iter().any(|p| p.length() > LONGEST) {
            return None;
        }
        let all: Vec<u32> = (0..points.len() as u32).collect();
        let end = points.len() as u32 - 1;
        let mut figure = Figure { points, ..Figure::default() };
        (figure.corners, figure.chains) = (vec![vec![]; 3], vec![vec![]; 3]);
        (figure.corners[last], figure.corners[first]) = (vec![0], vec![end]);
        // Its face comes along the edge to `last` and leaves along that to `first`.
        figure.corners[across] = all.clone();
        (figure.chains[first], figure.chains[across]) = (vec![end], vec![0]);
        figure.chains[edge] = all;
        Some(figure)
    }

    /// A corner for every face, and the point itself in the middle.
    fn open(&self, measure: Measure) -> Figure {
        let n = self.len();
        let mut figure = Figure { open: true, ..Figure::default() };
        let mut own: Vec<u32> = (0..n as u32).collect();
        (1..n).filter(|&i| self.bends[i - 1] == Bend::Flat).for_each(|i| own[i] = own[i - 1]);
        if self.bends[n - 1] == Bend::Flat {
            let (first, last) = (own[0], own[n - 1]);
            own.iter_mut().filter(|o| **o == last).for_each(|o| *o = first);
        }
        figure.points = self.normals.clone();
        let middle = (0..n).map(|i| self.bent(i, measure).len() as u32).sum::<u32>() + n as u32;
        for i in 0..n {
            let (from, to) = (own[i], own[(i + 1) % n]);
            let inner = self.bent(i, measure);
            let first = figure.points.len() as u32;
            let added = first..first + inner.len() as u32;
            figure.points.extend(inner);
            figure.corners.push(vec![from]);
            figure.chains.push(match self.bends[i] {
                _ if from == to => vec![from],
                Bend::Concave => vec![from, middle, to],
                _ => [from].into_iter().chain(added).chain([to]).collect(),
            });
            if self.bends[i] == Bend::Convex && from != to {
                let fan = figure.chains[i].windows(2).map(|w| [middle, w[0], w[1]]);
                figure.cap.extend(fan.collect::<Vec<_>>());
            }
        }
        figure.points.push(DVec3::ZERO);
        figure
    }

    /// What lies between the ends of the arc over a convex edge.
    fn bent(&self, edge: usize, measure: Measure) -> Vec<DVec3> {
        if self.bends[edge] != Bend::Convex {
            return vec![];
        }
        let (from, to) = (self.normals[edge], self.normals[(edge + 1) % self.len()]);
        let points = evened(
            arc(from, to, chords(from.angle(to), measure.chord)),
            measure.bulge,
            measure.chord,
        );
        points[1..points.len() - 1].to_vec()
    }
}

/// The point where the offsets of faces meet, if they do.
fn joint(normals: &[DVec3], measure: Measure) -> Option<DVec3> {
    let (m, off) = mitre(normals);
    (off <= measure.joint && m.length() <= LONGEST).then_some(m)
}

/// The angle whose chord is off its arc by a part of the radius.
pub(super) fn span(chord: f64) -> f64 {
    4.0 * libm::asin((chord.min(1.0) / 2.0).sqrt())
}

/// Chords for an arc of an angle, whose inner points are then [`evened`].
fn chords(angle: f64, chord: f64) -> u32 {
    if angle <= span(chord) {
        return 1;
    }
    (angle / span(EVENED * chord)).ceil().max(2.0) as u32
}
