//! Strokes of one pen that cross in the dark. On round faces and grids they follow the parameter lines, elsewhere a fixed
//! direction.
//!
//! Lines of a layer are so near that all of them together would be too dark. Each has a rank, and is drawn where the tone
//! is darker than that; about there it is broken, so that the mean tone is right. Where the parameter lines of a face come
//! closer on paper than the pitch, only every second is drawn, or every fourth, and so on.

use glam::{DVec2, DVec3, dvec2};

use super::{
    average::Average,
    chart::Chart,
    guide::{Guide, Shown},
    ink::Mark,
    strokes::{Rows, clip},
    travel,
};
use crate::geom::trig::{cos_deg, sin_deg};

/// The directions that strokes take one after the other as it gets darker, degrees from the first.
const LAYERS: [f64; 5] = [0.0, 90.0, 45.0, 135.0, 22.5];

/// The pen's width as a part of the pitch.
const PEN: f64 = 0.5;

/// How far the pen goes before it is thought of lifting it, in pitches.
const SHORTEST: f64 = 2.0;

/// Places of a line that are looked at in one pitch.
const FINE: f64 = 4.0;

/// The golden section: multiples of it, less whole numbers, are spread evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// One over the plastic number: its first powers are spread evenly together.
const PLASTIC: f64 = 0.754_877_666_246_693;

/// Parameter lines of one face in one direction at most; faces with more are hatched in a fixed direction.
const MOST_LINES: f64 = 20_000.0;

/// Strokes of a pen half as wide as their pitch in mm, the first at an angle in degrees to the x axis. Where that is
/// not dark enough others cross them; where it is too dark they are broken. The same strokes are never drawn twice,
/// and they come in an order in which the pen moves little between them.
pub(super) fn hatch(
    tones: &Average,
    pitch: f64,
    angle: f64,
    guide: Option<&Guide<'_>>,
) -> Vec<Mark> {
    let hatcher = Hatcher::new(tones, pitch, guide);
    let mut strokes = vec![];
    for (layer, turn) in LAYERS.into_iter().enumerate() {
        for (number, row) in Rows::of(tones, pitch, angle + turn).enumerate() {
            let line = |t: f64| row.start + row.along * t;
            hatcher.straight(layer, number, row.length, &line, &mut strokes);
        }
        for number in 0..hatcher.followed.len() {
            hatcher.round(layer, turn, number, &mut strokes);
        }
    }
    let strokes = travel::sorted(strokes, tones.frame().window);
    strokes.into_iter().map(|points| Mark::Stroke { points, width: pitch * PEN }).collect()
}

struct Hatcher<'a> {
    tones: &'a Average,
    pitch: f64,
    guide: Option<&'a Guide<'a>>,
    /// For each chart its largest scale on paper, if strokes follow it.
    followed: Vec<Option<f64>>,
}

/// How quickly a line goes from white to black as it gets darker: from nothing to all of it over 1 / STEEP of the range of
/// tones.
const STEEP: f64 = 8.0;

/// Which part of a line of a rank from 0 to 1 is drawn, so that lines of all ranks together are drawn as the share of a
/// tone says.
fn drawn(share: f64, rank: f64) -> f64 {
    let half = 0.5 / STEEP;
    // Ranks end at 0 and 1, where fewer lines are on one side of the tone than on the other.
    let middle = if share < half {
        (2.0 * share / STEEP).sqrt() - half
    } else if share > 1.0 - half {
        1.0 + half - (2.0 * (1.0 - share) / STEEP).sqrt()
    } else {
        share
    };
    ((middle - rank) * STEEP + 0.5).clamp(0.0, 1.0)
}

/// Whether the pen is down along a line, so that it is as often as the tone asks for.
struct Pen {
    rank: f64,
    owed: f64,
    /// The way to go until it is thought of again.
    left: f64,
    is_down: bool,
}

impl Pen {
    /// For the line of a number: lines are out of step with each other.
    fn new(number: usize, step: f64) -> Pen {
        let part = |x: f64| (number as f64 * x).fract();
        let (rank, owed) = (part(GOLDEN), part(PLASTIC));
        Pen { rank, owed, left: part(PLASTIC * PLASTIC) * step, is_down: false }
    }

    /// Puts it down or lifts it, given which part of the line is to be drawn here.
    fn think(&mut self, share: f64, step: f64) {
        self.owed += drawn(share, self.rank);
        self.is_down = self.owed >= 1.0;
        if self.is_down {
            self.owed -= 1.0;
        }
        self.left += step;
    }
}

impl<'a> Hatcher<'a> {
    fn new(tones: &'a Average, pitch: f64, guide: Option<&'a Guide<'a>>) -> Hatcher<'a> {
        let followed = |guide: &Guide<'_>, chart: &Chart<'_>, number: u32| {
            let magnified = guide.magnification(number)?;
            let stretch = chart.most_stretch() * magnified * MARGIN;
            let lines = chart.size.element_sum() * stretch / pitch;
            (lines <= MOST_LINES).then_some(stretch)
        };
        let followed = guide.map_or(vec![], |guide| {
            guide.charts().iter().zip(0..).map(|(chart, i)| followed(guide, chart, i)).collect()
        });
        Hatcher { tones, pitch, guide, followed }
    }

    /// Whether rows of a fixed direction are drawn at a place on paper.
    fn is_plain(&self, guide: &Guide<'_>, at: DVec2) -> bool {
        match guide.shown(at) {
            Shown::Paper => false,
            Shown::Flat => true,
            Shown::Round(chart) => self.followed[chart as usize].is_none(),
        }
    }

    /// How far the pen goes on paper before it is thought of again.
    fn step(&self) -> f64 {
        self.pitch * SHORTEST
    }

    /// Adds the strokes along a straight line on paper, on faces that have no lines of their own.
    fn straight(
        &self,
        layer: usize,
        number: usize,
        length: f64,
        line: &dyn Fn(f64) -> DVec2,
        strokes: &mut Vec<Vec<DVec2>>,
    ) {
        let step = self.step();
        let mut pen = Pen::new(number, step);
        // The tone where the line enters the paper holds for the part of a step before the first full one.
        let mut at = pen.left - step;
        while at < length {
            let dark = 1.0 - self.tones.at(line(at + step / 2.0), step);
            pen.think(share(dark, layer), step);
            if pen.is_down {
                self.piece((at.max(0.0), (at + step).min(length)), line, strokes);
            }
            at += step;
        }
    }

    /// Adds a piece of a straight line, as far as it is on faces that have no lines of their own.
    fn piece(
        &self,
        (from, to): (f64, f64),
        line: &dyn Fn(f64) -> DVec2,
        strokes: &mut Vec<Vec<DVec2>>,
    ) {
        if to <= from {
            return;
        }
        let Some(guide) = self.guide else { return extend(strokes, line(from), line(to)) };
        let count = ((to - from) * FINE / self.pitch).ceil();
        let place = |i: u32| line(from + (to - from) * f64::from(i) / count);
        for i in 0..count as u32 {
            let (start, end) = (place(i), place(i + 1));
            if self.is_plain(guide, (start + end) / 2.0) {
                extend(strokes, start, end);
            }
        }
    }

    /// Adds the strokes along the parameter lines of a chart, turned by an angle on the surface.
    fn round(&self, layer: usize, turn: f64, number: usize, strokes: &mut Vec<Vec<DVec2>>) {
        let (Some(guide), Some(most)) = (self.guide, self.followed[number]) else { return };
        let chart = &guide.charts()[number];
        let angle = chart.first + turn;
        let along = dvec2(cos_deg(angle), sin_deg(angle));
        let bundle = Bundle { guide, chart, number: number as u32, along };
        let half = chart.size / 2.0;
        let reach = half.dot(along.perp().abs());
        let count = lines(2.0 * reach * most / self.pitch);
        let gap = 2.0 * reach / count;
        for line in 0..count as usize {
            let base = along.perp() * ((line as f64 + 0.5) * gap - reach);
            let Some((from, to)) = clip(base, along, half) else { continue };
            let walk = Walk { start: half + base, from, to, gap, most, line };
            self.walk(layer, &bundle, &walk, strokes);
        }
    }

    /// Goes along a parameter line.
    fn walk(&self, layer: usize, bundle: &Bundle<'_>, walk: &Walk, strokes: &mut Vec<Vec<DVec2>>) {
        let step = self.step();
        let longest = (walk.to - walk.from) / LEAST;
        let mut pen = Pen::new(walk.line, step);
        let (mut t, mut drawing) = (walk.from, vec![]);
        while t < walk.to {
            let Some(spot) = bundle.spot(walk.start + bundle.along * t) else {
                finish(&mut drawing, self.pitch, strokes);
                t += longest;
                continue;
            };
            let stretch = spot.along.length();
            // What is farther from the paper than a fine step is passed over.
            let way = (self.pitch / FINE).max(self.beyond(spot.at) * walk.most.recip() * stretch);
            let ahead = (way / stretch).min(longest).max(longest / MOST_STEPS);
            // So many lines share the room of one.
            let every = (self.pitch / (spot.apart * walk.gap)).max(1.0).log2().floor().exp2();
            pen.left -= ahead * stretch;
            if pen.left <= 0.0 {
                let dark = 1.0 - self.tones.at(spot.at, self.pitch);
                let full = self.pitch * PEN / (spot.apart * walk.gap * every);
                pen.think((share(dark, layer) * PEN / full).min(1.0), step);
            }
            let is_drawn = walk.line as f64 % every == 0.0;
            if pen.is_down && is_drawn && bundle.guide.sees(bundle.number, spot.point, spot.at) {
                drawing.push(spot.at);
            } else {
                if !drawing.is_empty() {
                    drawing.push(spot.at);
                }
                finish(&mut drawing, self.pitch, strokes);
            }
            t += ahead;
        }
        finish(&mut drawing, self.pitch, strokes);
    }

    /// How far a place is from the paper, mm.
    fn beyond(&self, at: DVec2) -> f64 {
        let window = self.tones.frame().window;
        at.distance(at.clamp(window.min, window.max))
    }
}

/// Pieces that a parameter line is looked at in at least, and how many times more at most.
const LEAST: f64 = 64.0;
const MOST_STEPS: f64 = 4096.0;

/// Lines come so much nearer than the largest scale that was found would need.
const MARGIN: f64 = 1.1;

/// The step over which derivatives are taken, as a part of a chart's size.
const DIFFERENCE: f64 = 1e-5;

/// So many lines that halves, quarters and eighths of them are evenly spread where the surface closes.
fn lines(wanted: f64) -> f64 {
    let wanted = wanted.max(1.0);
    let unit = (wanted.log2().floor() - 2.0).max(0.0).exp2();
    (wanted / unit).ceil() * unit
}

/// Parameter lines of one direction on a chart.
struct Bundle<'a> {
    guide: &'a Guide<'a>,
    chart: &'a Chart<'a>,
    number: u32,
    along: DVec2,
}

/// A place on a parameter line.
struct Spot {
    point: DVec3,
    /// Where it is on paper.
    at: DVec2,
    /// How fast the place on paper moves along the line.
    along: DVec2,
    /// How fast lines beside it move away on paper.
    apart: f64,
}

/// A line of a bundle: from and to are lengths from its start.
struct Walk {
    start: DVec2,
    from: f64,
    to: f64,
    gap: f64,
    most: f64,
    line: usize,
}

impl Bundle<'_> {
    /// `None` behind the eye, and where the line has no direction on paper.
    fn spot(&self, at: DVec2) -> Option<Spot> {
        let step = self.chart.size.min_element() * DIFFERENCE;
        let image = |by: DVec2| self.guide.project(self.chart.point(at + by * step));
        let point = self.chart.point(at);
        let place = self.guide.project(point)?;
        let along = (image(self.along)? - place) / step;
        let across = (image(self.along.perp())? - place) / step;
        let apart = along.perp_dot(across).abs() / along.length();
        apart.is_finite().then_some(Spot { point, at: place, along, apart })
    }
}

/// Which part of a layer's rows is drawn, so that all layers up to it leave as much white as the tone has, or as
/// little as they can.
fn share(dark: f64, layer: usize) -> f64 {
    let mut white = 1.0;
    for _ in 0..layer {
        white *= 1.0 - PEN;
    }
    // Layers before this one are full where this one begins.
    let wanted = (1.0 - (1.0 - dark) / white) / PEN;
    wanted.clamp(0.0, 1.0)
}

/// Strokes that are nearer than this, mm, go on: places on one line differ by rounding.
const SAME: f64 = 1e-9;

/// Lengthens the last stroke if it ends where this one begins, else begins one.
fn extend(strokes: &mut Vec<Vec<DVec2>>, from: DVec2, to: DVec2) {
    match strokes.last_mut() {
        Some(last) if last[last.len() - 1].distance(from) < SAME => {
            last.pop();
            last.push(to);
        }
        _ => strokes.push(vec![from, to]),
    }
}

/// Corners of a stroke that are off by less than this part of the pitch are left out.
const FLAT: f64 = 0.02;

/// Strokes shorter than this part of the pitch are left out.
const CRUMB: f64 = 0.25;

/// Puts a stroke away.
fn finish(drawing: &mut Vec<DVec2>, pitch: f64, strokes: &mut Vec<Vec<DVec2>>) {
    let points = std::mem::take(drawing);
    let length: f64 = points.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
    if length < pitch * CRUMB {
        return;
    }
    let mut kept = vec![points[0]];
    let mut from = 0;
    for to in 2..points.len() {
        let chord = (points[to] - points[from]).normalize_or_zero();
        let off = |p: &DVec2| chord.perp_dot(*p - points[from]).abs() > pitch * FLAT;
        if points[from + 1..to].iter().any(off) {
            from = to - 1;
            kept.push(points[from]);
        }
    }
    kept.push(points[points.len() - 1]);
    strokes.push(kept);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_all_ranks_make_the_share() {
        for share in [0.0, 0.01, 0.05, 0.3, 0.77, 0.97, 1.0] {
            let ranks = (0..1000i32).map(|i| (f64::from(i) + 0.5) / 1000.0);
            let mean = ranks.map(|rank| drawn(share, rank)).sum::<f64>() / 1000.0;
            assert!((mean - share).abs() < 1e-4, "{mean} for {share}");
        }
    }

    #[test]
    fn halves_of_lines_are_whole() {
        assert_eq!([1.0, 7.0, 9.0, 100.0].map(lines), [1.0, 7.0, 10.0, 112.0]);
    }
}
