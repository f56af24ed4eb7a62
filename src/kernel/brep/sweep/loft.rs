//! Bodies through sections.

use std::sync::Arc;

use glam::DVec3;

use super::{
    SweepError,
    rings::{Builder, Part, Step, Swept},
    sections::{Alike, Placed, alike},
    sound,
    stations::{Station, stations},
};
use crate::{
    geom::{Form, Parametric, Surface, Tolerance, curve::slopes, sweep::Repair},
    kernel::brep::Polyhedron,
};

/// The body through sections in their order: between two of them its surface is ruled; through three or more every point
/// runs along a cubic spline, or straight if it is `ruled`. Contours with as many corners are joined corner by corner,
/// others by the parts of their length. The boundary keeps within `tolerance` of that surface; the ends are the first and
/// the last section.
///
/// Fails for fewer than two sections, sections that are empty or have different numbers of contours, and where the body
/// crosses itself.
///
/// ```
/// use glam::{DVec2, DVec3};
/// use katachi::geom::{Contour, Piece, Placement, Region, Tolerance};
/// use katachi::kernel::brep::{measure::volume, sweep::{Placed, loft}};
/// let square = |r: f64| {
///     let corners = [[-r, -r], [r, -r], [r, r], [-r, r]].map(DVec2::from).to_vec();
///     Region { pieces: vec![Piece { outer: Contour::polygon(corners), holes: vec![] }] }
/// };
/// let (low, high) = (square(2.0), square(1.0));
/// let sections = [
///     Placed { region: &low, frame: Placement::IDENTITY },
///     Placed { region: &high, frame: Placement::translation(DVec3::Z * 3.0) },
/// ];
/// let frustum = loft(&sections, false, Tolerance::DEFAULT).unwrap();
/// assert!((volume(&frustum) - 28.0).abs() < 1e-12);
/// ```
pub fn loft(
    sections: &[Placed],
    ruled: bool,
    tolerance: Tolerance,
) -> Result<Polyhedron, SweepError> {
    if sections.len() < 2 {
        return Err(SweepError::Sections { found: sections.len(), needed: 2 });
    }
    let contours = alike(sections, &directions(sections))?;
    let skin = |contour: &Alike| Arc::new(Skin::new(contour.rings.clone(), ruled));
    let skins: Vec<Arc<Skin>> = contours.iter().map(skin).collect();
    let steps: Vec<f64> = (0..sections.len()).map(|i| i as f64).collect();
    let ring = |place: f64| Ok(skins.iter().flat_map(|skin| skin.at(place)).collect());
    let all = stations(&steps, true, tolerance, &ring)?;
    let last = sections.len() - 1;
    let form = |part: &Part| {
        let skin = skins[part.contour].clone();
        let columns = columns(&part.edges, contours[part.contour].curves.len());
        let steps = if ruled { [part.run, part.run + 1] } else { [0, last] };
        Some(Form::new(Arc::new(Lofted { skin, columns, steps: steps.map(|i| i as f64) })))
    };
    let solid = body(&contours, &all, [!ruled, false], &form);
    let way = sections
        .iter()
        .zip(0..)
        .map(|(section, i)| (f64::from(i) / (sections.len() - 1) as f64, section.middle()));
    sound(solid, Repair::No, way)
}

/// The way at each section: from the middle of the one before to that of the next; where that runs along the section, the
/// side on which the one before is left.
fn directions(sections: &[Placed]) -> Vec<DVec3> {
    let middles: Vec<DVec3> = sections.iter().map(Placed::middle).collect();
    let last = middles.len() - 1;
    let mut found: Vec<DVec3> = vec![];
    for (i, section) in sections.iter().enumerate() {
        let normal = section.frame.vector(DVec3::Z);
        let ways = [(i, (i + 1).min(last)), (i.saturating_sub(1), i)];
        let steps = ways.map(|(from, to)| (middles[to] - middles[from]).normalize_or_zero());
        let side: f64 = steps.iter().map(|step| step.dot(normal)).sum();
        let before = found.last().copied().unwrap_or(normal);
        found.push(if side.abs() > LEVEL { normal * side } else { normal * before.dot(normal) });
    }
    found
}

/// A step runs along a section when the sine of the angle between them is below this.
const LEVEL: f64 = 1e-6;

/// The corners of edges that follow one another around so many corners.
pub(super) fn columns(edges: &[usize], count: usize) -> Vec<usize> {
    let last = edges.last().map(|last| (last + 1) % count);
    edges.iter().copied().chain(last).collect()
}

/// A point between those of some columns, at a part of the way from the first to the last.
pub(super) fn between_columns(columns: &[usize], u: f64, point: impl Fn(usize) -> DVec3) -> DVec3 {
    let steps = columns.len() - 1;
    let along = u * steps as f64;
    let i = (along as usize).min(steps - 1);
    point(columns[i]).lerp(point(columns[i + 1]), along - i as f64)
}

/// Columns of a loft over a part of its way.
#[derive(Debug)]
struct Lofted {
    skin: Arc<Skin>,
    columns: Vec<usize>,
    steps: [f64; 2],
}

impl Parametric for Lofted {
    fn at(&self, u: f64, v: f64) -> DVec3 {
        let place = self.steps[0] + (self.steps[1] - self.steps[0]) * v;
        between_columns(&self.columns, u, |j| self.skin.point(j, place))
    }
}

/// The solid of contours whose points at all stations stand one contour after the other. Unless it is smooth there is an
/// edge at every whole place. A closed one ends where it starts and has no ends.
pub(super) fn body(
    contours: &[Alike],
    all: &[Station],
    [is_smooth, is_closed]: [bool; 2],
    form: &dyn Fn(&Part) -> Option<Form>,
) -> Polyhedron {
    let size = all.iter().flat_map(|s| &s.points).fold(0.0, |size: f64, p| size.max(p.length()));
    let steps: Vec<Step> = all
        .windows(2)
        .map(|pair| {
            let middle = (pair[0].place + pair[1].place) / 2.0;
            Step { run: if is_smooth { 0 } else { middle as usize }, is_flat: false }
        })
        .collect();
    let mut builder = Builder::new(size, &|_, _| Surface::Smooth, form);
    let mut first = 0;
    let mut ends: [Vec<Vec<u32>>; 2] = Default::default();
    for contour in contours {
        if !contour.is_hole && !is_closed {
            cap(&mut builder, std::mem::take(&mut ends));
        }
        let count = contour.curves.len();
        let own: Vec<Station> = all
            .iter()
            .map(|s| Station { place: s.place, points: s.points[first..first + count].to_vec() })
            .collect();
        first += count;
        let closing = is_closed.then_some(0);
        let swept = Swept { stations: &own, curves: &contour.curves, closing };
        let [start, end] = builder.add(&swept, &steps);
        ends[0].push(start);
        ends[1].push(end);
    }
    if !is_closed {
        cap(&mut builder, ends);
    }
    builder.solid()
}

fn cap(builder: &mut Builder, [start, end]: [Vec<Vec<u32>>; 2]) {
    builder.cap(start, true);
    builder.cap(end, false);
}

/// Rings of points with a curve through the points of each number.
#[derive(Debug)]
pub(super) struct Skin {
    rings: Vec<Vec<DVec3>>,
    /// For each ring the slope of each point over the steps; none where it is ruled.
    slopes: Option<Vec<Vec<DVec3>>>,
    /// The mean distance from ring to ring.
    steps: Vec<f64>,
}

impl Skin {
    /// Straight between two rings, or everywhere if it is ruled; else splines over the mean distances of the rings.
    pub fn new(rings: Vec<Vec<DVec3>>, ruled: bool) -> Skin {
        let mean = |pair: &[Vec<DVec3>]| {
            let sum: f64 = pair[0].iter().zip(&pair[1]).map(|(a, b)| a.distance(*b)).sum();
            (sum / pair[0].len() as f64).max(f64::MIN_POSITIVE)
        };
        let steps: Vec<f64> = rings.windows(2).map(mean).collect();
        if ruled || rings.len() < 3 {
            return Skin { rings, slopes: None, steps };
        }
        let mut found = vec![vec![]; rings.len()];
        for j in 0..rings[0].len() {
            let column: Vec<DVec3> = rings.iter().map(|ring| ring[j]).collect();
            let slopes = slopes(&column, &steps, [None; 2]);
            found.iter_mut().zip(slopes).for_each(|(list, slope)| list.push(slope));
        }
        Skin { rings, slopes: Some(found), steps }
    }

    /// The points at a place: ring 1 and three quarters is 1.75.
    pub fn at(&self, place: f64) -> Vec<DVec3> {
        (0..self.rings[0].len()).map(|j| self.point(j, place)).collect()
    }

    /// The point with a number at a place.
    fn point(&self, j: usize, place: f64) -> DVec3 {
        let i = (place as usize).min(self.rings.len() - 2);
        let t = place - i as f64;
        let (a, b) = (self.rings[i][j], self.rings[i + 1][j]);
        if t == 0.0 || t == 1.0 {
            return if t == 0.0 { a } else { b };
        }
        let straight = a.lerp(b, t);
        let Some(slopes) = &self.slopes else { return straight };
        // Hermite's form: the line between the ends and what the slopes differ from it.
        let (u, h, chord) = (1.0 - t, self.steps[i], b - a);
        let bend = (slopes[i][j] * h - chord) * u - (slopes[i + 1][j] * h - chord) * t;
        straight + bend * (t * u)
    }
}
