//! From lines in the picture to lines in space.

use glam::{DVec2, DVec3, dvec2};

use super::{
    ISO,
    known::Known,
    sketch::{Line, Sketch},
};
use crate::{
    geom::isometric::{IsoDrawing, IsoLine, IsoScale, SHRINK, image},
    input::{Place, ReadError},
};

/// Places nearer than this part of the size of the drawing are one: 0.06 mm on A4.
const NEAR: f64 = 2e-4;

/// The tangent of the angle up to which a stroke may be one along an axis: half a degree.
const ALONG: f64 = 8.7e-3;

/// Lengths within this part of a pitch of its multiples are snapped.
const SNAP: f64 = 0.1;

/// The most times that a known point is tried for a line: about a second.
const MOST_LOOKS: usize = 20_000_000;

/// Corners of one line of which the places relative to each other are known.
struct Run {
    line: usize,
    /// The first corner.
    from: usize,
    /// From the first corner to each.
    steps: Vec<DVec3>,
}

/// A line and its corners.
struct Traced<'a> {
    line: &'a Line,
    /// Corners as drawn, in user units, repeated ones left out.
    drawn: Vec<DVec2>,
    /// The same as images on paper, mm, y up.
    places: Vec<DVec2>,
    marked: Vec<bool>,
    /// The known point at each.
    points: Vec<Option<u32>>,
}

struct Resolver<'a> {
    scale: &'a IsoScale,
    lines: Vec<Traced<'a>>,
    known: Known,
    notes: Vec<String>,
    looks: usize,
}

/// The drawing in space.
pub fn resolve(sketch: &Sketch, scale: &IsoScale) -> Result<IsoDrawing, ReadError> {
    let mut resolver = Resolver::new(sketch, scale)?;
    let mut runs: Vec<Run> = vec![];
    for number in 0..resolver.lines.len() {
        runs.extend(resolver.runs(number));
    }
    let (mut runs, mut ends): (Vec<Run>, Vec<Run>) =
        runs.into_iter().partition(|run| run.steps.len() > 1 || (run.line, run.from) == (0, 0));
    if !runs.is_empty() {
        let first = runs.remove(0);
        resolver.put(&first, scale.origin);
    }
    loop {
        resolver.place_all(&mut runs)?;
        ends.retain(|run| !resolver.joined(run));
        if !resolver.lead_on(&mut runs) && !resolver.lead_on(&mut ends) {
            break;
        }
    }
    runs.append(&mut ends);
    runs.sort_by_key(|run| (run.line, run.from));
    match runs.is_empty() {
        true => Ok(resolver.drawing(sketch)),
        false => Err(resolver.unresolved(&runs)),
    }
}

impl<'a> Resolver<'a> {
    fn new(sketch: &'a Sketch, scale: &'a IsoScale) -> Result<Resolver<'a>, ReadError> {
        let all = || sketch.lines.iter().flat_map(|line| line.points.iter().copied());
        let min = all().reduce(DVec2::min).unwrap_or_default();
        let max = all().reduce(DVec2::max).unwrap_or_default();
        let near = min.distance(max) * NEAR;
        let factor = scale.unit.map_or(sketch.mm, |unit| unit * SHRINK);
        let start = all().next().unwrap_or_default();
        let place = |p: DVec2| (p - start) * dvec2(1.0, -1.0) * factor + image(scale.origin);
        let is_mark = |p: DVec2| sketch.marks.iter().any(|mark| mark.distance(p) <= near);
        let traced = |line: &'a Line| {
            let (drawn, repeated) = corners(line, near);
            let marked = drawn.iter().zip(repeated).map(|(p, twice)| twice || is_mark(*p));
            let (marked, points) = (marked.collect(), vec![None; drawn.len()]);
            Traced {
                line,
                places: drawn.iter().map(|p| place(*p)).collect(),
                drawn,
                marked,
                points,
            }
        };
        let mut lines: Vec<Traced> = sketch.lines.iter().map(traced).collect();
        lines.retain(|line| line.drawn.len() > 1);
        if lines.is_empty() {
            let found = "no lines";
            return Err(ISO.error(Place::File, found, "at least one path or polyline is needed"));
        }
        let known = Known::new(near * factor);
        Ok(Resolver { scale, lines, known, notes: sketch.notes.clone(), looks: 0 })
    }

    /// The runs of a line: where strokes follow the axes, one; corners between other strokes stand alone.
    fn runs(&self, number: usize) -> Vec<Run> {
        let line = &self.lines[number];
        let mut runs: Vec<Run> = vec![];
        for corner in 0..line.places.len() {
            let step = (corner > 0 && !line.line.joins)
                .then(|| self.exact(line.places[corner] - line.places[corner - 1]))
                .flatten();
            match (step, runs.last_mut()) {
                (Some(step), Some(run)) => {
                    let last = run.steps.last().copied().unwrap_or_default();
                    run.steps.push(last + step);
                }
                _ => runs.push(Run { line: number, from: corner, steps: vec![DVec3::ZERO] }),
            }
        }
        self.around(line, runs)
    }

    /// Joins the last run of a closed line to the first one where the closing stroke follows an axis.
    fn around(&self, line: &Traced, mut runs: Vec<Run>) -> Vec<Run> {
        let count = line.places.len();
        let closes = line.line.closed && !line.line.joins && runs.len() > 1;
        let step = closes.then(|| self.exact(line.places[0] - line.places[count - 1])).flatten();
        if let (Some(step), Some(mut last)) = (step, runs.pop_if(|_| step.is_some())) {
            let way = last.steps.last().copied().unwrap_or_default() + step;
            last.steps.extend(runs[0].steps.iter().map(|own| way + *own));
            runs[0] = last;
        }
        runs
    }

    /// The way in space of a stroke that ends as near to an axis as places can tell.
    fn exact(&self, stroke: DVec2) -> Option<DVec3> {
        let beside = |axis: DVec3| stroke.perp_dot(image(axis) / SHRINK).abs();
        let near = DVec3::AXES.into_iter().any(|axis| beside(axis) <= self.known.near);
        near.then(|| self.step(stroke)).flatten()
    }

    /// The way in space of a stroke about along an axis.
    fn step(&self, stroke: DVec2) -> Option<DVec3> {
        let along = |axis: &DVec3| {
            let unit = image(*axis) / SHRINK;
            stroke.perp_dot(unit).abs() <= ALONG * stroke.dot(unit).abs()
        };
        let axis = DVec3::AXES.into_iter().find(along)?;
        let length = stroke.dot(image(axis)) / (SHRINK * SHRINK);
        let whole = self.scale.snap.map(|pitch| (length / pitch).round() * pitch);
        let pitch = self.scale.snap.unwrap_or_default();
        let snapped = whole.filter(|w| *w != 0.0 && (w - length).abs() <= SNAP * pitch);
        Some(axis * snapped.unwrap_or(length))
    }

    /// Resolves runs in their order as far as they meet known points, and leaves the others.
    fn place_all(&mut self, runs: &mut Vec<Run>) -> Result<(), ReadError> {
        loop {
            let before = runs.len();
            let mut waiting = vec![];
            for run in runs.drain(..) {
                match self.starts(&run)?[..] {
                    [start] => self.put(&run, start),
                    _ => waiting.push(run),
                }
            }
            *runs = waiting;
            if runs.len() == before && !self.place_doubtful(runs)? {
                return Ok(());
            }
        }
    }

    /// Resolves the first run that several known points are possible for; whether there is one.
    fn place_doubtful(&mut self, runs: &mut Vec<Run>) -> Result<bool, ReadError> {
        for i in 0..runs.len() {
            let starts = self.starts(&runs[i])?;
            if let Some(&start) = starts.first() {
                let run = runs.remove(i);
                self.doubt(&run, start, starts.len());
                self.put(&run, start);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Resolves the first run of which no corner is known and to which a stroke about along an axis leads; whether there
    /// is one.
    fn lead_on(&mut self, runs: &mut Vec<Run>) -> bool {
        let found = runs.iter().enumerate().find_map(|(i, run)| {
            let line = &self.lines[run.line];
            let before = run.from.checked_sub(1).filter(|_| !line.line.joins)?;
            let start = self.known.points[line.points[before]? as usize].at;
            let step = self.step(line.places[run.from] - line.places[before])?;
            Some((i, start + step))
        });
        let Some((i, start)) = found else { return false };
        let run = runs.remove(i);
        self.put(&run, start);
        true
    }

    fn doubt(&mut self, run: &Run, at: DVec3, count: usize) {
        let place = self.lines[run.line].drawn[run.from];
        let [x, y, z] = at.to_array();
        self.notes.push(format!(
            "{count} known points are at {}; the line there is taken from [{x}, {y}, {z}]",
            shown(place)
        ));
    }

    /// Where the first corner of a run may be: by the known points at its first corner, else its last, else any. Of
    /// several only those are left that let most of its corners be known points.
    fn starts(&mut self, run: &Run) -> Result<Vec<DVec3>, ReadError> {
        let count = run.steps.len();
        let groups = [0..1, count - 1..count, 0..count];
        for group in groups {
            let mut starts: Vec<DVec3> = vec![];
            for i in group {
                let found = self.known.seen_at(self.place(run, i));
                let at = |k: u32| self.known.points[k as usize].at - run.steps[i];
                starts.extend(found.into_iter().map(at));
            }
            if starts.len() > 1 {
                self.looks += starts.len() * count;
                if self.looks > MOST_LOOKS {
                    let what = "the number of lines that begin where several points are seen";
                    return Err(ISO.limit(what, format!("{MOST_LOOKS} trials")));
                }
                let met: Vec<usize> = starts.iter().map(|s| self.met(run, *s)).collect();
                let most = met.iter().copied().max().unwrap_or_default();
                let best = starts.into_iter().zip(met).filter(|(_, met)| *met == most);
                starts = self.different(best.map(|(start, _)| start));
            }
            if !starts.is_empty() {
                return Ok(starts);
            }
        }
        Ok(vec![])
    }

    /// How many corners of a run that starts at a point are known.
    fn met(&self, run: &Run, start: DVec3) -> usize {
        let is_known =
            |i: &usize| self.known.find(start + run.steps[*i], self.place(run, *i)).is_some();
        (0..run.steps.len()).filter(is_known).count()
    }

    fn different(&self, starts: impl Iterator<Item = DVec3>) -> Vec<DVec3> {
        let mut kept: Vec<DVec3> = vec![];
        for start in starts {
            if kept.iter().all(|known| known.distance(start) > self.known.reach()) {
                kept.push(start);
            }
        }
        kept
    }

    /// The number of a run's corner in its line.
    fn corner(&self, run: &Run, i: usize) -> usize {
        (run.from + i) % self.lines[run.line].places.len()
    }

    fn place(&self, run: &Run, i: usize) -> DVec2 {
        self.lines[run.line].places[self.corner(run, i)]
    }

    /// Settles the corners of a run.
    fn put(&mut self, run: &Run, start: DVec3) {
        for (i, step) in run.steps.iter().enumerate() {
            let (corner, place) = (self.corner(run, i), self.place(run, i));
            let line = &mut self.lines[run.line];
            let marked = line.marked[corner];
            let registered = marked || !line.line.dashed;
            let number = self.known.add(start + *step, place, marked, registered);
            line.points[corner] = Some(number);
        }
    }

    /// Settles a corner between strokes that join known points; whether there is one.
    fn joined(&mut self, run: &Run) -> bool {
        let found = self.known.seen_at(self.place(run, 0));
        let Some(&point) = found.first() else { return false };
        let marked = |k: &&u32| self.known.points[**k as usize].marked;
        let marks = found.iter().filter(marked).count();
        if found.len() > 1 && marks != 1 {
            self.doubt(run, self.known.points[point as usize].at, found.len());
        }
        let corner = self.corner(run, 0);
        self.lines[run.line].points[corner] = Some(point);
        true
    }

    fn drawing(self, sketch: &Sketch) -> IsoDrawing {
        let Resolver { lines, known, notes, .. } = self;
        debug_assert!(lines.len() <= sketch.lines.len());
        let at = |k: &Option<u32>| k.map(|k| known.points[k as usize].at);
        let line = |line: &Traced| {
            let points: Vec<DVec3> = line.points.iter().filter_map(at).collect();
            let both = points.iter().zip(&line.marked);
            let marks: Vec<DVec3> = both.filter(|(_, m)| **m).map(|(p, _)| *p).collect();
            let marks = if marks.is_empty() { points.clone() } else { marks };
            let (name, closed) = (line.line.name.clone(), line.line.closed && points.len() > 2);
            IsoLine { name, points, marks, closed, is_edge: !line.line.dashed }
        };
        let registered = known.points.iter().filter(|point| point.registered);
        let vertices = registered.map(|point| point.at).collect();
        IsoDrawing { vertices, lines: lines.iter().map(line).collect(), notes }
    }

    /// What is not known of some runs.
    fn unresolved(&self, runs: &[Run]) -> ReadError {
        let words: Vec<String> = runs.iter().take(MOST_TOLD).map(|run| self.why(run)).collect();
        let rest = runs.len() - words.len();
        let more = if rest > 0 { format!("; and {rest} more") } else { String::new() };
        let needed =
            "a line starts at a known point, and its strokes follow an axis or join known points";
        ISO.error(Place::File, words.join("; ") + &more, needed)
    }

    /// Why a run is not resolved: no known point at it, and the strokes that lead to it.
    fn why(&self, run: &Run) -> String {
        let line = &self.lines[run.line];
        let here = line.drawn[run.from];
        let last = self.corner(run, run.steps.len() - 1);
        if run.steps.len() > 1 {
            let end = line.drawn[last];
            return format!("no known point on the line from {} to {}", shown(here), shown(end));
        }
        let before = (run.from > 0).then(|| run.from - 1);
        let after = Some(run.from + 1).filter(|i| *i < line.drawn.len());
        let Some(other) = before.or(after) else {
            return format!("no known point at {}", shown(here));
        };
        let (stroke, nearest) = direction(line.places[run.from] - line.places[other]);
        format!(
            "no known point at {}, and the stroke to it from {} runs at {stroke}°, not along {nearest}",
            shown(here),
            shown(line.drawn[other])
        )
    }
}

/// Errors that are told one by one.
const MOST_TOLD: usize = 4;

/// A place in user units.
fn shown(p: DVec2) -> String {
    let short = |x: f64| (x * 1e3).round() / 1e3 + 0.0;
    format!("({}, {})", short(p.x), short(p.y))
}

/// The angle of a stroke in the picture, degrees from the right counter-clockwise, and the axis nearest to it.
fn direction(stroke: DVec2) -> (f64, String) {
    let degrees = |v: DVec2| (libm::atan2(v.y, v.x).to_degrees() * 10.0).round() / 10.0 + 0.0;
    let names = ["+x", "-x", "+y", "-y", "+z", "-z"];
    let ways = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let unit = stroke.normalize_or_zero();
    let near = |way: &DVec3| image(*way).dot(unit);
    let nearest = ways.zip(names).max_by(|a, b| near(&a.0).total_cmp(&near(&b.0)));
    let (way, name) = nearest.unwrap_or((DVec3::X, "+x"));
    (degrees(stroke), format!("{name} at {}°", degrees(image(way))))
}

/// The corners of a line without those that repeat the one before, and whether each is repeated.
fn corners(line: &Line, near: f64) -> (Vec<DVec2>, Vec<bool>) {
    let (mut points, mut twice): (Vec<DVec2>, Vec<bool>) = (vec![], vec![]);
    for &point in &line.points {
        match points.last() {
            Some(last) if last.distance(point) <= near => {
                twice.pop();
                twice.push(true);
            }
            _ => {
                points.push(point);
                twice.push(false);
            }
        }
    }
    let ends_at_start = points.len() > 2 && points[0].distance(points[points.len() - 1]) <= near;
    if line.closed && ends_at_start {
        points.pop();
        twice[0] |= twice.pop().unwrap_or_default();
    }
    (points, twice)
}
