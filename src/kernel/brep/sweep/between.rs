//! Sections carried along two rails.
//!
//! # Paper
//! METHODS 4.3 (Nakajima). With chords c(v) from rail 1 to rail 2 and sections relative to their point of rail 1:
//!
//! ```text
//! S(u, v) = BS_1(v) + T(v) R(v) ((1 - v) sec_1(u) + v sec_2(u)),   T(v) = |c(v)| / ((1 - v) |a| + v |b|)
//! ```
//!
//! # Departures
//! - After R(v), the share v of the turn from chord a to chord b, comes the smallest turn onto the chord c(v), so that
//!   sections keep both rails where the chord does not turn evenly in one plane.
//! - The turn goes in steps of less than 60 degrees of the chords between, so that rails may go half around an axis, where b is
//!   opposite to a, or further. With a parallel to b there is no turn; where the rails meet, the section shrinks to the point.
//! - The surface passes through every section: between two of them as the formula says; through three or more the
//!   sections, brought into the frame of the first chord, run along cubic splines in place of straight lines. The paper's
//!   stations, which meet the first and last section only, are [`Stations::Mid`].
//! - Before the first section and after the last one the rails carry these on.
//!
//! # Convergence
//! Stations hold points of the true surface: on both rails, and at sections on these. So the body that rails turned about an
//! axis sweep has chords in place of arcs, and its volume is too small by the square of the step; a chord is off its arc by
//! the square of the step too. The error is so in proportion to the tolerance, and a quarter with half the step. To
//! be better than that, say of the square of the tolerance, a ring would have to stand outside the true surface as much as
//! its chords stand inside, which no ring on two rails, and none at a section, can. Outlines of profiles, which nothing
//! but their area ties down, are made that way.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::{
    SweepError,
    frames::smallest_turn,
    loft::{Skin, between_columns, body, columns},
    rings::Part,
    sections::{Placed, alike},
    sound,
    stations::stations,
};
use crate::{
    geom::{
        Curve, CurvedGrid, Form, Parametric, Tolerance,
        sweep::{Repair, Stations},
        trig::{acos_deg, cos_deg, sin_deg},
    },
    kernel::brep::Polyhedron,
};

/// Two curves that sections are carried along.
pub type Rails<'a> = [&'a Curve; 2];

/// How closed sections are carried along two rails.
#[derive(Clone, Copy, Debug)]
pub struct Between<'a> {
    /// The two curves.
    pub rails: Rails<'a>,
    /// Where sections are met.
    pub stations: Stations,
    /// What is done where the sweep crosses itself.
    pub repair: Repair,
}

/// An open section: a curve from rail 1 to rail 2, or the other way.
pub type Row<'a> = &'a Curve;

/// Ends of sections are on a rail up to this part of its length.
const ON: f64 = 1e-6;

/// A chord shorter than this part of the rails is none.
const NONE: f64 = 1e-12;

/// The solid that closed sections, each in a plane that both rails go through, sweep along the rails. Its ends are flat, or
/// points where the rails meet.
///
/// Fails for fewer than two sections (four with [`Stations::Mid`]), sections that are out of order, unlike one another, or not
/// crossed by the rails, and where the sweep crosses itself, unless that is repaired.
///
/// ```
/// use glam::{DVec2, DVec3, dvec3};
/// use katachi::geom::{Contour, Curve, Piece, Placement, Region, Tolerance, sweep::{Repair, Stations}};
/// use katachi::kernel::brep::{measure::volume, sweep::{Between, Placed, between}};
/// let square = [[0., 0.], [2., 0.], [2., 2.], [0., 2.]].map(DVec2::from).to_vec();
/// let region = Region { pieces: vec![Piece { outer: Contour::polygon(square), holes: vec![] }] };
/// let rail = |x: f64| Curve::polyline(&[dvec3(x, 0., 0.), dvec3(x, 0., 5.)], false).unwrap();
/// let (a, b) = (rail(0.0), rail(2.0));
/// let at = |z: f64| Placed { region: &region, frame: Placement::translation(DVec3::Z * z) };
/// let way = Between { rails: [&a, &b], stations: Stations::Through, repair: Repair::No };
/// let block = between(&[at(0.0), at(5.0)], &way, Tolerance::DEFAULT).unwrap();
/// assert!((volume(&block) - 20.0).abs() < 1e-12);
/// ```
pub fn between(
    sections: &[Placed],
    way: &Between,
    tolerance: Tolerance,
) -> Result<Polyhedron, SweepError> {
    enough(sections.len(), way.stations)?;
    check_rails(way.rails)?;
    let mut places = vec![];
    for (number, section) in sections.iter().enumerate() {
        let (at, normal) = (section.middle(), section.frame.vector(DVec3::Z));
        let place = |rail: usize| {
            crossing(way.rails[rail], at, normal)
                .ok_or(SweepError::Beside { section: number, rail })
        };
        places.push([place(0)?, place(1)?]);
    }
    check_order(way.rails, &places)?;
    let ahead = |place: &[f64; 2]| (0..2).map(|i| way.rails[i].tangent(place[i])).sum::<DVec3>();
    let directions: Vec<DVec3> = places.iter().map(ahead).collect();
    let contours = alike(sections, &directions)?;
    let rings: Vec<Vec<DVec3>> = (0..sections.len())
        .map(|i| contours.iter().flat_map(|contour| contour.rings[i].iter().copied()).collect())
        .collect();
    let carried = Arc::new(Carried::new(way.rails, places, rings, way.stations));
    let all = stations(&carried.breaks(), true, tolerance, &|v| Ok(carried.at(v)))?;
    let whole = all[all.len() - 1].place;
    let form = |part: &Part| {
        let before: usize = contours[..part.contour].iter().map(|c| c.curves.len()).sum();
        let own = columns(&part.edges, contours[part.contour].curves.len());
        let columns = own.into_iter().map(|j| before + j).collect();
        Some(Form::new(Arc::new(Skinned { carried: carried.clone(), columns, whole })))
    };
    let solid = body(&contours, &all, [true, carried.is_closed()], &form);
    sound(solid, way.repair, all.iter().map(|s| (s.place / whole, carried.rail(0, s.place))))
}

/// The surface that open sections sweep along two rails: rows of points, one row a station, from rail 1 to rail 2. Sections
/// of as many pieces are matched piece by piece, others by the parts of their length.
///
/// Fails for fewer than two sections, and sections that are out of order or do not run from rail to rail.
pub fn surface(
    sections: &[Row],
    rails: Rails,
    rule: Stations,
    tolerance: Tolerance,
) -> Result<CurvedGrid, SweepError> {
    enough(sections.len(), rule)?;
    check_rails(rails)?;
    let (mut places, mut turned) = (vec![], vec![]);
    for (number, section) in sections.iter().enumerate() {
        let (place, section) = ends(rails, number, section)?;
        places.push(place);
        turned.push(section);
    }
    check_order(rails, &places)?;
    let rows = rows(&turned, tolerance.half());
    let carried = Carried::new(rails, places, rows, rule);
    let all = stations(&carried.breaks(), false, tolerance.half(), &|v| Ok(carried.at(v)))?;
    let rows: Vec<Vec<DVec3>> = all.into_iter().map(|station| station.points).collect();
    let is_closed = carried.is_closed();
    let kept = rows.len() - usize::from(is_closed);
    Ok(CurvedGrid::new(&rows[..kept], is_closed, false)?)
}

fn enough(found: usize, rule: Stations) -> Result<(), SweepError> {
    let needed = if rule == Stations::Mid { 4 } else { 2 };
    if found < needed { Err(SweepError::Sections { found, needed }) } else { Ok(()) }
}

fn check_rails(rails: Rails) -> Result<(), SweepError> {
    match rails.iter().position(|rail| rail.length() <= 0.0 || !rail.length().is_finite()) {
        Some(rail) => Err(SweepError::Rail(rail)),
        None => Ok(()),
    }
}

/// Sections must follow one another on both rails.
fn check_order(rails: Rails, places: &[[f64; 2]]) -> Result<(), SweepError> {
    for (section, pair) in (1..).zip(places.windows(2)) {
        for rail in 0..2 {
            let [before, part] = [pair[0][rail], pair[1][rail]];
            if part <= before {
                let [before, part] = [before, part].map(|place| rails[rail].part(place));
                return Err(SweepError::Order { section, rail, part, before });
            }
        }
    }
    Ok(())
}

/// Where a section starts on rail 1 and ends on rail 2, and the section that way round.
fn ends(rails: Rails, number: usize, section: &Curve) -> Result<([f64; 2], Curve), SweepError> {
    let last = section.pieces().len() as f64;
    let size = section.length() + rails[0].length();
    let off = |from: DVec3, to: DVec3| {
        let places = [rails[0].nearest(from), rails[1].nearest(to)];
        let gaps = [rails[0].at(places[0]).distance(from), rails[1].at(places[1]).distance(to)];
        (places, gaps)
    };
    let [start, end] = [section.at(0.0), section.at(last)];
    let (places, gaps) = off(start, end);
    let (back_places, back_gaps) = off(end, start);
    if gaps[0] + gaps[1] <= ON * size {
        return Ok((places, section.clone()));
    }
    if back_gaps[0] + back_gaps[1] <= ON * size {
        return Ok((back_places, section.reversed()));
    }
    let (gaps, at) = match gaps[0] + gaps[1] <= back_gaps[0] + back_gaps[1] {
        true => (gaps, [start, end]),
        false => (back_gaps, [end, start]),
    };
    let rail = usize::from(gaps[1] > gaps[0]);
    Err(SweepError::OffRail { section: number, rail, distance: gaps[rail], at: at[rail] })
}

/// Where a rail goes through a plane, nearest to a point of it.
fn crossing(rail: &Curve, at: DVec3, normal: DVec3) -> Option<f64> {
    const PARTS: u32 = 64;
    let count = rail.pieces().len() as f64;
    let parts = rail.pieces().len() as u32 * PARTS;
    let height = |place: f64| normal.dot(rail.at(place) - at);
    let slack = ON * rail.length();
    let place = |i: u32| f64::from(i) / f64::from(PARTS);
    let mut found: Vec<f64> =
        [0.0, count].into_iter().filter(|p| height(*p).abs() <= slack).collect();
    for i in 0..parts {
        let (mut low, mut high) = (place(i), place(i + 1));
        let start = height(low);
        if start == 0.0 {
            found.push(low);
        } else if start * height(high) < 0.0 {
            for _ in 0..60 {
                let middle = (low + high) / 2.0;
                if height(middle) * start > 0.0 { low = middle } else { high = middle }
            }
            found.push((low + high) / 2.0);
        }
    }
    let distance = |place: f64| rail.at(place).distance_squared(at);
    let passes = |place: &f64| rail.tangent(*place).dot(normal).abs() > ON;
    found.into_iter().filter(passes).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
}

/// The points of open sections that belong together.
fn rows(sections: &[Curve], tolerance: Tolerance) -> Vec<Vec<DVec3>> {
    let pieces = sections[0].pieces().len();
    if sections.iter().all(|section| section.pieces().len() == pieces) {
        let chords = |i: usize| {
            let counts = sections.iter().map(|section| section.pieces()[i].chords(tolerance));
            counts.max().unwrap_or(1)
        };
        let counts: Vec<u32> = (0..pieces).map(chords).collect();
        let row = |section: &Curve| {
            let steps = counts.iter().zip(section.pieces()).flat_map(|(&count, piece)| {
                (1..=count).map(move |i| piece.at(f64::from(i) / f64::from(count)))
            });
            std::iter::once(section.at(0.0)).chain(steps).collect()
        };
        return sections.iter().map(row).collect();
    }
    let mut parts: Vec<f64> = vec![0.0, 1.0];
    for section in sections {
        for (i, piece) in section.pieces().iter().enumerate() {
            let count = piece.chords(tolerance);
            let place = |k: u32| i as f64 + f64::from(k) / f64::from(count);
            parts.extend((0..count).map(|k| section.part(place(k))));
        }
    }
    parts.sort_by(f64::total_cmp);
    parts.dedup_by(|a, b| *a - *b <= ON * ON);
    sections.iter().map(|s| parts.iter().map(|part| s.at(s.place(*part))).collect()).collect()
}

/// Chords of one step turn by less than 60 degrees.
const STEADY: f64 = 0.5;

/// Steps that are taken between two stations at most.
const MOST_STEPS: usize = 64;

/// The way between two stations, in equal steps in each of which the chord turns little.
#[derive(Debug)]
struct Span {
    from: [f64; 2],
    to: [f64; 2],
    /// The chord at the start of each step, and at the end.
    chords: Vec<DVec3>,
    /// The turn from the first section's frame there.
    turns: Vec<DMat3>,
}

/// Sections on their way along two rails.
#[derive(Debug)]
struct Carried {
    rails: [Arc<Curve>; 2],
    spans: Vec<Span>,
    /// The direction of the first section's chord.
    along: DVec3,
    /// The points of each station relative to rail 1, in the frame of the first section's chord, and after them the chord
    /// itself.
    skin: Skin,
    /// Whether places are parts of the length, because the rails have different pieces.
    by_length: bool,
}

impl Carried {
    fn new(rails: Rails, places: Vec<[f64; 2]>, rings: Vec<Vec<DVec3>>, rule: Stations) -> Carried {
        let by_length = rails[0].pieces().len() != rails[1].pieces().len();
        let own = |place: [f64; 2]| match by_length {
            true => [0, 1].map(|rail| rails[rail].part(place[rail])),
            false => place,
        };
        let places: Vec<[f64; 2]> = places.into_iter().map(own).collect();
        let skin = Skin::new(vec![], true);
        let rails = rails.map(|rail| Arc::new(rail.clone()));
        let mut carried = Carried { rails, spans: vec![], along: DVec3::X, skin, by_length };
        carried.along = carried.chord(places[0]).normalize_or(DVec3::X);
        carried.go(&places);
        let mut rings = carried.settled(&places, rings);
        if rule == Stations::Mid {
            let (middles, means) = middles(&places, &rings);
            carried.go(&middles);
            rings = means;
        }
        carried.carry_on(&mut rings);
        carried.skin = Skin::new(rings, rule == Stations::Mid);
        carried
    }

    /// Sets out from station to station.
    fn go(&mut self, places: &[[f64; 2]]) {
        self.spans.clear();
        let mut turn = DMat3::IDENTITY;
        for pair in places.windows(2) {
            let span = self.span([pair[0], pair[1]], turn);
            turn = span.end();
            self.spans.push(span);
        }
    }

    /// The way between two stations that starts with a turn.
    fn span(&self, [from, to]: [[f64; 2]; 2], start: DMat3) -> Span {
        let mut steps = 1;
        let chords = loop {
            let at = |j: usize| mixed(from, to, j as f64 / steps as f64);
            let chords: Vec<DVec3> = (0..=steps).map(|j| self.chord(at(j))).collect();
            let steady = chords.windows(2).all(|pair| {
                let lengths = pair[0].length() * pair[1].length();
                pair[0].dot(pair[1]) >= STEADY * lengths
            });
            let halves = chords.windows(2).enumerate().all(|(j, pair)| {
                let middle = self.chord(mixed(from, to, (j as f64 + 0.5) / steps as f64));
                pair.iter().all(|end| middle.dot(*end) >= STEADY * middle.length() * end.length())
            });
            if (steady && halves) || steps >= MOST_STEPS {
                break chords;
            }
            steps *= 2;
        };
        let mut turns = vec![start];
        for (j, pair) in chords.windows(2).enumerate() {
            turns.push(share([pair[0], pair[1]], 1.0) * turns[j]);
        }
        Span { from, to, chords, turns }
    }

    /// The points of all stations in the frame of the first chord, each with its chord.
    fn settled(&self, places: &[[f64; 2]], rings: Vec<Vec<DVec3>>) -> Vec<Vec<DVec3>> {
        let turn = |i: usize| if i == 0 { DMat3::IDENTITY } else { self.spans[i - 1].end() };
        let own = rings.into_iter().enumerate().map(|(i, ring)| {
            let (base, back) = (self.on(0, places[i][0]), turn(i).transpose());
            let chord = self.along * self.chord(places[i]).length();
            ring.into_iter().map(|p| back * (p - base)).chain([chord]).collect()
        });
        own.collect()
    }

    /// Whether the rails are closed, and the sections with them.
    fn is_closed(&self) -> bool {
        self.rails.iter().all(|rail| rail.is_closed()) && self.spans[0].from == [0.0; 2]
    }

    /// Carries the first section back to the start of the rails, and the last one on to their end; on closed rails the last
    /// one goes over into the first.
    fn carry_on(&mut self, rings: &mut Vec<Vec<DVec3>>) {
        let ends = match self.by_length {
            true => [1.0; 2],
            false => [0, 1].map(|rail: usize| self.rails[rail].pieces().len() as f64),
        };
        let first = self.spans[0].from;
        if first.iter().all(|place| *place > ON) {
            let mut span = self.span([[0.0; 2], first], DMat3::IDENTITY);
            let back = span.end().transpose();
            span.turns.iter_mut().for_each(|turn| *turn *= back);
            self.spans.insert(0, span);
            rings.insert(0, rings[0].clone());
        }
        let last = &self.spans[self.spans.len() - 1];
        if (0..2).all(|rail| ends[rail] - last.to[rail] > ON) {
            let span = self.span([last.to, ends], last.end());
            let from = if self.is_closed() { 0 } else { rings.len() - 1 };
            self.spans.push(span);
            rings.push(rings[from].clone());
        }
    }

    /// Places where stations must stand: sections, and the ends of the rails' pieces and of quarters of turns.
    fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = (0..=self.spans.len()).map(|i| i as f64).collect();
        for (i, span) in self.spans.iter().enumerate() {
            for rail in 0..2 {
                let (from, to) = (span.from[rail], span.to[rail]);
                let joint = |joint: f64| match self.by_length {
                    true => self.rails[rail].part(joint),
                    false => joint,
                };
                let joints = self.rails[rail].plain_places().into_iter().map(joint);
                let inner = joints.filter(|joint| *joint > from && *joint < to);
                breaks.extend(inner.map(|joint| i as f64 + (joint - from) / (to - from)));
            }
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b <= ON);
        breaks
    }

    /// The span of a place and the share of it.
    fn part(&self, v: f64) -> (&Span, f64) {
        let i = (v as usize).min(self.spans.len() - 1);
        (&self.spans[i], v - i as f64)
    }

    /// The point of a rail at a place of its own kind.
    fn on(&self, rail: usize, place: f64) -> DVec3 {
        match self.by_length {
            true => self.rails[rail].at(self.rails[rail].place(place)),
            false => self.rails[rail].at(place),
        }
    }

    /// The point of a rail at a place of the way.
    fn rail(&self, rail: usize, v: f64) -> DVec3 {
        let (span, t) = self.part(v);
        self.on(rail, mixed(span.from, span.to, t)[rail])
    }

    fn chord(&self, [a, b]: [f64; 2]) -> DVec3 {
        self.on(1, b) - self.on(0, a)
    }

    /// The points at a place of the way.
    fn at(&self, v: f64) -> Vec<DVec3> {
        let (span, t) = self.part(v);
        let base = self.rail(0, v);
        let chord = self.rail(1, v) - base;
        let size = self.rails[0].length() + self.rails[1].length();
        let mut own = self.skin.at(v);
        let own_chord = own.pop().map_or(0.0, |chord| chord.dot(self.along));
        if chord.length() <= NONE * size || own_chord <= 0.0 {
            return vec![base; own.len()];
        }
        let turn = span.turn(t);
        let (from, to) = ((turn * self.along).normalize(), chord.normalize());
        let stretch = chord.length() / own_chord;
        let place = |p: DVec3| base + smallest_turn(from, to, turn * p) * stretch;
        own.into_iter().map(place).collect()
    }
}

/// Columns of sections on their way.
#[derive(Debug)]
struct Skinned {
    carried: Arc<Carried>,
    columns: Vec<usize>,
    /// The last place.
    whole: f64,
}

impl Parametric for Skinned {
    fn at(&self, u: f64, v: f64) -> DVec3 {
        let points = self.carried.at(v * self.whole);
        between_columns(&self.columns, u, |j| points[j])
    }
}

impl Span {
    fn end(&self) -> DMat3 {
        self.turns[self.turns.len() - 1]
    }

    /// The turn from the first section's frame at a share of the way.
    fn turn(&self, t: f64) -> DMat3 {
        let steps = self.chords.len() - 1;
        let along = t * steps as f64;
        let j = (along as usize).min(steps - 1);
        share([self.chords[j], self.chords[j + 1]], along - j as f64) * self.turns[j]
    }
}

/// R(v): the share t of the turn from one chord to the next; none between parallel ones, and where there is no chord.
fn share(chords: [DVec3; 2], t: f64) -> DMat3 {
    let [Some(a), Some(b)] = chords.map(DVec3::try_normalize) else {
        return DMat3::IDENTITY;
    };
    match a.cross(b).try_normalize() {
        Some(axis) => about(axis, acos_deg(a.dot(b).clamp(-1.0, 1.0)) * t),
        None => DMat3::IDENTITY,
    }
}

/// Places on both rails between two others.
fn mixed(from: [f64; 2], to: [f64; 2], t: f64) -> [f64; 2] {
    [0, 1].map(|rail| if t == 1.0 { to[rail] } else { from[rail] + (to[rail] - from[rail]) * t })
}

/// The paper's stations: half-way between neighbours, with the mean of their sections; the first and the last stay.
fn middles(places: &[[f64; 2]], rings: &[Vec<DVec3>]) -> (Vec<[f64; 2]>, Vec<Vec<DVec3>>) {
    let last = places.len() - 1;
    let (mut found, mut means) = (vec![places[0]], vec![rings[0].clone()]);
    for i in 1..last - 1 {
        found.push(mixed(places[i], places[i + 1], 0.5));
        let pairs = rings[i].iter().zip(&rings[i + 1]);
        means.push(pairs.map(|(p, q)| p.midpoint(*q)).collect());
    }
    found.push(places[last]);
    means.push(rings[last].clone());
    (found, means)
}

/// The rotation about a unit axis.
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (s, c) = (sin_deg(degrees), cos_deg(degrees));
    let column = |v: DVec3| v * c + axis.cross(v) * s + axis * (axis.dot(v) * (1.0 - c));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}
