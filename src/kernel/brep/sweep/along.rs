//! A profile carried along one curve.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    MAX_FACETS, SweepError,
    frames::{Course, Frames, Stand},
    rings::{Builder, Part, Step, Swept},
    sound,
    stations::{Station, stations},
};
use crate::{
    geom::{
        Contour, Curve, EdgeCurve, Form, Parametric, Region, Surface, Tolerance,
        curve::{Piece, PlaneError, Turn},
        sweep::{Corners, Frame, Repair},
        trig::{cos_deg, sin_deg},
    },
    kernel::brep::{Polyhedron, flank::encloses},
};

/// How a profile is carried.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// The way.
    pub path: &'a Curve,
    /// Right-handed turn from start to end, degrees, beside what the frame does.
    pub twist: f64,
    /// Size at the end relative to the start.
    pub scale: f64,
    /// How the profile turns on its way.
    pub frame: Frame,
    /// How it goes round corners.
    pub corners: Corners,
    /// What is done where it crosses itself.
    pub repair: Repair,
}

impl<'a> Along<'a> {
    /// Along a path with no twist and scale, the least turn, mitred corners.
    pub fn path(path: &'a Curve) -> Along<'a> {
        let (frame, corners, repair) = Default::default();
        Along { path, twist: 0.0, scale: 1.0, frame, corners, repair }
    }
}

/// Carries a region along a path, its origin on the path, its plane across it. At the start its y points as far up as it
/// can; on a path that starts upright its x stays x. The ends are flat; a closed path has none. The boundary keeps within
/// `tolerance` of the surface that the region's edges sweep.
///
/// Fails for an empty region, a path with a cusp, a bend narrower than the region reaches inwards, and where the sweep
/// crosses itself, unless that is repaired.
///
/// ```
/// use glam::{DVec2, dvec3};
/// use katachi::geom::{Contour, Curve, Piece, Region, Tolerance};
/// use katachi::kernel::brep::{measure::volume, sweep::{Along, along}};
/// let square = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(DVec2::from).to_vec();
/// let region = Region { pieces: vec![Piece { outer: Contour::polygon(square), holes: vec![] }] };
/// let corners = [dvec3(0., 0., 0.), dvec3(20., 0., 0.), dvec3(20., 10., 0.), dvec3(0., 10., 0.)];
/// let frame = Curve::polyline(&corners, true).unwrap();
/// let solid = along(&region, &Along::path(&frame), Tolerance::DEFAULT).unwrap();
/// assert_eq!(volume(&solid), 4.0 * 60.0);
/// ```
pub fn along(
    region: &Region,
    sweep: &Along,
    tolerance: Tolerance,
) -> Result<Polyhedron, SweepError> {
    if !encloses(region) {
        return Err(SweepError::EmptyProfile);
    }
    if !(sweep.scale > 0.0 && sweep.scale.is_finite()) {
        return Err(SweepError::Scale(sweep.scale));
    }
    let rounded;
    let path = match sweep.corners {
        Corners::Mitred => sweep.path,
        Corners::Rounded => {
            rounded = round_corners(region, sweep)?;
            &rounded
        }
    };
    Way::new(region, Along { path, ..*sweep })?.solid(tolerance)
}

/// The path with arcs in its corners, so narrow that the innermost point of the profile stays where it is.
fn round_corners(region: &Region, sweep: &Along) -> Result<Curve, SweepError> {
    let way = Way::new(region, *sweep)?;
    let count = sweep.path.pieces().len();
    let mut reach = vec![0.0; count];
    for (joint, reach) in reach.iter_mut().enumerate() {
        let before = way.course.frames.at((joint + count - 1) % count, 1.0)?;
        let after = way.course.frames.at(joint, 0.0)?;
        let inwards = (after.tangent - before.tangent).normalize_or_zero();
        let inwards = DVec2::new(before.x.dot(inwards), before.y.dot(inwards)).normalize_or_zero();
        *reach = way.reach(joint as f64, inwards);
    }
    let narrowest = ONE * sweep.path.length();
    sweep.path.rounded_by(|joint| reach[joint].max(narrowest)).map_err(|error| match error {
        PlaneError::Tight { r, fits, at } => {
            let part = sweep.path.part(sweep.path.nearest(at));
            SweepError::Bend { reach: r, radius: fits, part, at }
        }
        PlaneError::Bent(at) | PlaneError::Narrow { at, .. } => SweepError::TurnsBack(at),
        PlaneError::NotFlat => SweepError::TurnsBack(sweep.path.at(0.0)),
    })
}

/// Lengths below this part of the size are none; points of a profile nearer than it are one.
const ONE: f64 = 1e-9;

/// Parts that a piece is cut into at first at most; a twist that needs more has more facets than are made.
const MOST_PARTS: f64 = MAX_FACETS as f64;

/// Places of a piece where a first look is taken at how it bends.
const LOOKS: u32 = 16;

/// A mitre may be so many times longer than the profile is wide.
const LONGEST: f64 = 100.0;

struct Way<'a> {
    region: &'a Region,
    sweep: Along<'a>,
    course: Arc<Course>,
}

impl<'a> Way<'a> {
    fn new(region: &'a Region, sweep: Along<'a>) -> Result<Way<'a>, SweepError> {
        let frames = Frames::new(sweep.path, sweep.frame)?;
        let course = Arc::new(Course { frames, twist: sweep.twist, scale: sweep.scale });
        Ok(Way { region, sweep, course })
    }

    fn solid(&self, tolerance: Tolerance) -> Result<Polyhedron, SweepError> {
        let path = self.sweep.path;
        let points: Vec<DVec2> =
            self.region.contours().flat_map(|c| c.points.iter().copied()).collect();
        // Folds would ask for stations without end: first those that a rough look finds.
        let rough =
            (0..path.pieces().len() as u32 * LOOKS).map(|i| f64::from(i) / f64::from(LOOKS));
        self.check_bends(rough)?;
        let all = stations_of(self, &points, tolerance)?;
        self.check_bends(all.iter().map(|station| station.place))?;
        let size = path.length() + points.iter().map(|p| p.length()).fold(0.0, f64::max);
        let runs = self.runs();
        let steps: Vec<Step> = all.windows(2).map(|pair| self.step(&runs, pair)).collect();
        let surface = |run: usize, curve: EdgeCurve| self.surface(&runs, run, curve);
        let contours: Vec<&Contour> = self.region.contours().collect();
        let form = |part: &Part| Some(self.form(&runs, contours[part.contour], part));
        let mut builder = Builder::new(size, &surface, &form);
        let mut first = 0;
        for piece in &self.region.pieces {
            let mut ends = [vec![], vec![]];
            for contour in std::iter::once(&piece.outer).chain(&piece.holes) {
                let count = contour.points.len();
                let own: Vec<Station> = all
                    .iter()
                    .map(|s| Station {
                        place: s.place,
                        points: s.points[first..first + count].to_vec(),
                    })
                    .collect();
                first += count;
                let closing = if path.is_closed() { Some(self.closing(contour)?) } else { None };
                let swept = Swept { stations: &own, curves: &contour.curves, closing };
                let [start, end] = builder.add(&swept, &steps);
                ends[0].push(start);
                ends[1].push(end);
            }
            if !path.is_closed() {
                let [start, end] = ends;
                builder.cap(start, true);
                builder.cap(end, false);
            }
        }
        let whole = path.pieces().len() as f64;
        let way = all.iter().map(|s| (s.place / whole, path.at(s.place)));
        sound(builder.solid(), self.sweep.repair, way)
    }

    /// Places of a piece between which it turns by a quarter at most, and so does the twist.
    fn plain_places(&self, piece: usize) -> Vec<f64> {
        let Along { path, twist, .. } = self.sweep;
        let from = piece as f64;
        let share = path.part(from + 1.0) - path.part(from);
        let twists = (twist * share / 90.0).abs().ceil().min(MOST_PARTS) as u32;
        let count = path.pieces()[piece].plain_parts().max(twists);
        (0..=count).map(|k| from + f64::from(k) / f64::from(count)).collect()
    }

    /// Points of the profile at a place.
    fn ring(&self, piece: usize, s: f64, points: &[DVec2]) -> Result<Vec<DVec3>, SweepError> {
        let (stand, size) = self.course.stand(piece, s)?;
        Ok(points.iter().map(|p| stand.place(*p * size)).collect())
    }

    /// Points of the profile where two pieces meet in a corner: in the plane half-way between them.
    fn mitre(&self, joint: usize, points: &[DVec2]) -> Result<Vec<DVec3>, SweepError> {
        let count = self.sweep.path.pieces().len();
        let (before, size) = self.course.stand((joint + count - 1) % count, 1.0)?;
        let after = self.course.frames.at(joint % count, 0.0)?.tangent;
        let normal = before.tangent + after;
        let slope = normal.dot(before.tangent);
        if slope * LONGEST <= normal.length() {
            return Err(SweepError::TurnsBack(before.origin));
        }
        let place = |p: &DVec2| {
            let at = before.place(*p * size);
            at - before.tangent * ((at - before.origin).dot(normal) / slope)
        };
        Ok(points.iter().map(place).collect())
    }

    fn is_corner(&self, joint: usize) -> bool {
        !self.sweep.path.is_smooth_at(joint) && self.sweep.frame != Frame::Fixed
    }

    /// How far the profile reaches in a direction of its plane at a place.
    fn reach(&self, place: f64, direction: DVec2) -> f64 {
        let Along { path, twist, scale, .. } = self.sweep;
        let part = path.part(place);
        let (s, c) = (sin_deg(-twist * part), cos_deg(-twist * part));
        let own = DVec2::new(direction.x * c - direction.y * s, direction.x * s + direction.y * c);
        let points = self.region.contours().flat_map(|contour| &contour.points);
        points.map(|p| p.dot(own)).fold(0.0, f64::max) * (1.0 + (scale - 1.0) * part)
    }

    /// Refuses bends that are narrower than the profile reaches inwards.
    fn check_bends(&self, places: impl Iterator<Item = f64>) -> Result<(), SweepError> {
        let Along { path, repair, frame, .. } = self.sweep;
        if repair == Repair::Union || frame == Frame::Fixed {
            return Ok(());
        }
        for place in places {
            let (piece, s) = split(place, path.pieces().len());
            let curvature = path.pieces()[piece].curvature(s);
            if curvature == DVec3::ZERO {
                continue;
            }
            let stand = self.course.frames.at(piece, s)?;
            let inwards = DVec2::new(stand.x.dot(curvature), stand.y.dot(curvature));
            let reach = self.reach(place, inwards.normalize_or_zero());
            if reach * inwards.length() > 1.0 + ONE {
                let (radius, part) = (1.0 / inwards.length(), path.part(place));
                return Err(SweepError::Bend { reach, radius, part, at: stand.origin });
            }
        }
        Ok(())
    }

    /// By how many points the profile is turned when it comes back on a closed path.
    fn closing(&self, contour: &Contour) -> Result<usize, SweepError> {
        let Along { path, twist, scale, .. } = self.sweep;
        let points = &contour.points;
        let start = self.ring(0, 0.0, points)?;
        let last = path.pieces().len() - 1;
        let end = match self.is_corner(0) {
            true => {
                let (stand, size) = self.course.stand(last, 1.0)?;
                let first = self.course.frames.at(0, 0.0)?;
                let turn = |v| super::frames::smallest_turn(stand.tangent, first.tangent, v);
                let stand = Stand { x: turn(stand.x), y: turn(stand.y), ..stand };
                points.iter().map(|p| stand.place(*p * size)).collect()
            }
            false => self.ring(last, 1.0, points)?,
        };
        let (count, near) = (points.len(), CLOSE * path.length());
        let meets =
            |shift: usize| (0..count).all(|j| end[j].distance(start[(j + shift) % count]) <= near);
        (0..count).find(|&shift| meets(shift)).ok_or(SweepError::Unclosed { twist, scale })
    }

    /// For each piece the number of the first of its run: pieces that run on smoothly sweep one surface.
    fn runs(&self) -> Vec<usize> {
        let count = self.sweep.path.pieces().len();
        let mut runs: Vec<usize> = vec![];
        for i in 0..count {
            let smooth = i > 0 && self.sweep.path.is_smooth_at(i);
            runs.push(if smooth { runs[i - 1] } else { i });
        }
        if self.sweep.path.is_closed() && self.sweep.path.is_smooth_at(0) {
            let last = runs[count - 1];
            runs.iter_mut().filter(|run| **run == last).for_each(|run| *run = 0);
        }
        runs
    }

    fn step(&self, runs: &[usize], pair: &[Station]) -> Step {
        let middle = (pair[0].place + pair[1].place) / 2.0;
        let piece = (middle as usize).min(runs.len() - 1);
        Step { run: runs[piece], is_flat: self.is_straight(piece) }
    }

    /// Whether edges move along a piece without a turn.
    fn is_straight(&self, piece: usize) -> bool {
        let Along { path, twist, scale, .. } = self.sweep;
        let line = matches!(path.pieces()[piece], Piece::Line(_));
        line && twist == 0.0 && scale == 1.0 && self.course.frames.is_still()
    }

    /// What a curve of the profile sweeps in a run.
    fn surface(&self, runs: &[usize], run: usize, curve: EdgeCurve) -> Surface {
        let mut pieces = (0..runs.len()).filter(|&i| runs[i] == run);
        let alone = pieces.next().filter(|_| pieces.next().is_none());
        let known = alone.and_then(|piece| self.known_surface(piece, curve));
        known.unwrap_or(Surface::Smooth)
    }

    /// The parameter surface of edges that are carried along a run.
    fn form(&self, runs: &[usize], contour: &Contour, part: &Part) -> Form {
        let count = contour.points.len();
        let last = (part.edges[part.edges.len() - 1] + 1) % count;
        let corners = part.edges.iter().chain([&last]);
        let line = corners.map(|i| contour.points[*i]).collect();
        let pieces: Vec<usize> = (0..runs.len()).filter(|i| runs[*i] == part.run).collect();
        // A run over the start of a closed path begins where it is left before the end.
        let first = (0..pieces.len()).find(|&i| i > 0 && pieces[i] != pieces[i - 1] + 1);
        let mut pieces = pieces;
        pieces.rotate_left(first.unwrap_or(0));
        Form::new(Arc::new(Carried { course: self.course.clone(), line, pieces }))
    }

    /// What a curve sweeps along one piece, if that has a form of its own.
    fn known_surface(&self, piece: usize, curve: EdgeCurve) -> Option<Surface> {
        let stand = self.course.frames.at(piece, 0.0).ok()?;
        if self.is_straight(piece) {
            return match curve {
                EdgeCurve::Line => Some(Surface::Plane),
                EdgeCurve::Circle { center, radius } => Some(Surface::Cylinder {
                    point: stand.place(center),
                    axis: stand.tangent,
                    radius,
                }),
                EdgeCurve::Smooth(_) => None,
            };
        }
        let plain = self.sweep.scale == 1.0 && self.sweep.frame != Frame::Fixed;
        match (&self.sweep.path.pieces()[piece], curve) {
            (Piece::Turn(turn), EdgeCurve::Circle { center: DVec2::ZERO, radius }) if plain => {
                ring(turn, radius)
            }
            _ => None,
        }
    }
}

/// Edges of a profile carried along pieces of a path.
#[derive(Debug)]
struct Carried {
    course: Arc<Course>,
    /// Corners that follow one another.
    line: Vec<DVec2>,
    /// Pieces that follow one another smoothly.
    pieces: Vec<usize>,
}

impl Parametric for Carried {
    fn at(&self, u: f64, v: f64) -> DVec3 {
        let (edge, share) = split(u * (self.line.len() - 1) as f64, self.line.len() - 1);
        let p = self.line[edge].lerp(self.line[edge + 1], share);
        let (piece, s) = split(v * self.pieces.len() as f64, self.pieces.len());
        // The boundary was made of the same stands: none of them fails.
        let stand = self.course.stand(self.pieces[piece], s);
        stand.map_or(DVec3::ZERO, |(stand, size)| stand.place(p * size))
    }
}

/// The torus that a circle about an arc sweeps.
fn ring(turn: &Turn, minor: f64) -> Option<Surface> {
    let major = turn.x.length();
    let round = (turn.y.length() - major).abs() <= ONE * major
        && turn.x.dot(turn.y).abs() <= ONE * major * major
        && turn.rise == DVec3::ZERO;
    let axis = turn.x.cross(turn.y).try_normalize()?;
    round.then_some(Surface::Torus { center: turn.center, axis, major, minor })
}

/// Ends of a closed sweep meet up to this part of its length.
const CLOSE: f64 = 1e-7;

/// A place as a piece and its own parameter; the end of the last piece is its own.
fn split(place: f64, count: usize) -> (usize, f64) {
    let piece = (place as usize).min(count - 1);
    (piece, place - piece as f64)
}

/// The stations along a way: as close as each piece needs, and in the planes of mitres at corners.
fn stations_of(
    way: &Way,
    points: &[DVec2],
    tolerance: Tolerance,
) -> Result<Vec<Station>, SweepError> {
    let count = way.sweep.path.pieces().len();
    let mut all: Vec<Station> = vec![];
    for piece in 0..count {
        let ring = |place: f64| way.ring(piece, place - piece as f64, points);
        let found = stations(&way.plain_places(piece), true, tolerance, &ring)?;
        all.extend(found.into_iter().skip(usize::from(piece > 0)));
    }
    let closed = way.sweep.path.is_closed();
    for station in &mut all {
        let joint = station.place as usize;
        let whole = station.place == joint as f64;
        let inner = closed || (joint > 0 && joint < count);
        if whole && inner && way.is_corner(joint % count) {
            station.points = way.mitre(joint, points)?;
        }
    }
    Ok(all)
}
