//! Sections made alike: the same number of points, which belong together.

use glam::{DVec2, DVec3};

use super::SweepError;
use crate::geom::{Contour, EdgeCurve, Placement, Region};

/// A section: a figure and where its plane stands.
#[derive(Clone, Debug)]
pub struct Placed<'a> {
    /// The figure, mm.
    pub region: &'a Region,
    /// The rigid motion from the xy plane to its plane.
    pub frame: Placement,
}

/// A contour of all sections.
pub(super) struct Alike {
    /// Its points in each section; they run counter-clockwise around an outline seen against the way.
    pub rings: Vec<Vec<DVec3>>,
    /// The curve of each edge.
    pub curves: Vec<EdgeCurve>,
    /// Whether it bounds a hole.
    pub is_hole: bool,
}

/// Places along a contour that are compared to find how it is turned.
const COMPARED: usize = 64;

/// Turns of a contour that are compared at most.
const MOST_TURNS: usize = 512;

/// Parts of a contour nearer than this are one.
const ONE: f64 = 1e-9;

impl Placed<'_> {
    /// The middle of its corners.
    pub(super) fn middle(&self) -> DVec3 {
        let points = || self.region.contours().flat_map(|c| &c.points);
        let sum: DVec2 = points().sum();
        self.frame.point((sum / points().count().max(1) as f64).extend(0.0))
    }

    /// Its contours in space, turned over if its normal is against a direction.
    fn contours(&self, direction: DVec3) -> Vec<(Loop, bool)> {
        let is_turned = self.frame.vector(DVec3::Z).dot(direction) < 0.0;
        let made = |(contour, is_hole): (&Contour, bool)| {
            let place = |p: &DVec2| self.frame.point(p.extend(0.0));
            let (mut points, mut curves): (Vec<_>, _) =
                (contour.points.iter().map(place).collect(), contour.curves.clone());
            if is_turned {
                points[1..].reverse();
                curves.reverse();
            }
            (Loop { points, curves }, is_hole)
        };
        let pieces = self.region.pieces.iter();
        let all = pieces.flat_map(|piece| {
            std::iter::once((&piece.outer, false))
                .chain(piece.holes.iter().map(|hole| (hole, true)))
        });
        all.map(made).collect()
    }
}

/// A closed polygon in space.
struct Loop {
    points: Vec<DVec3>,
    curves: Vec<EdgeCurve>,
}

impl Loop {
    /// The part of the length up to each corner, and the length.
    fn parts(&self) -> (Vec<f64>, f64) {
        let next = self.points.iter().cycle().skip(1);
        let mut sum = 0.0;
        let ends: Vec<f64> = self
            .points
            .iter()
            .zip(next)
            .map(|(a, b)| {
                let here = sum;
                sum += a.distance(*b);
                here
            })
            .collect();
        (ends.into_iter().map(|end| end / sum).collect(), sum)
    }

    fn turned(&self, start: usize) -> Loop {
        let (mut points, mut curves) = (self.points.clone(), self.curves.clone());
        points.rotate_left(start);
        curves.rotate_left(start);
        Loop { points, curves }
    }

    /// The points at increasing parts of the length.
    fn at(&self, wanted: &[f64]) -> Vec<DVec3> {
        let (parts, _) = self.parts();
        let count = parts.len();
        let mut edge = 0;
        let mut point = |part: &f64| {
            while edge + 1 < count && parts[edge + 1] <= *part + ONE {
                edge += 1;
            }
            let end = parts.get(edge + 1).copied().unwrap_or(1.0);
            let share = (part - parts[edge]) / (end - parts[edge]);
            let share = if share < ONE { 0.0 } else { share.min(1.0) };
            self.points[edge].lerp(self.points[(edge + 1) % count], share)
        };
        wanted.iter().map(&mut point).collect()
    }

    /// Whether its corner is one, and no joint of two chords of a curve.
    fn is_corner(&self, i: usize) -> bool {
        let before = self.curves[(i + self.curves.len() - 1) % self.curves.len()];
        before == EdgeCurve::Line || self.curves[i] == EdgeCurve::Line || before != self.curves[i]
    }

    /// The corner to start from so that it lies nearest to another loop, both moved to one middle.
    fn nearest_start(&self, other: &Loop) -> usize {
        let even: Vec<f64> = (0..COMPARED).map(|i| i as f64 / COMPARED as f64).collect();
        let centred = |points: Vec<DVec3>| -> Vec<DVec3> {
            let middle = points.iter().sum::<DVec3>() / points.len() as f64;
            points.into_iter().map(|p| p - middle).collect()
        };
        let fixed = centred(other.at(&even));
        let step = self.points.len().div_ceil(MOST_TURNS);
        let gap = |start: &usize| {
            let own = centred(self.turned(*start).at(&even));
            own.iter().zip(&fixed).map(|(a, b)| a.distance_squared(*b)).sum::<f64>()
        };
        let starts = (0..self.points.len()).step_by(step).map(|start| (gap(&start), start));
        let best = starts.min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or(0, |(_, start)| start)
    }
}

/// Makes sections alike: contours with as many corners corner by corner, others by the parts of their length. Each starts
/// where it is nearest to the one before. `directions` are those of the way at each section. Fails where they are made of
/// different numbers of contours.
pub(super) fn alike(sections: &[Placed], directions: &[DVec3]) -> Result<Vec<Alike>, SweepError> {
    let mut all: Vec<Vec<(Loop, bool)>> = vec![];
    for (i, section) in sections.iter().enumerate() {
        if section.region.is_empty() {
            return Err(SweepError::EmptyProfile);
        }
        let contours = section.contours(directions[i]);
        if let Some(first) = all.first().filter(|first| first.len() != contours.len()) {
            return Err(SweepError::Unlike {
                section: i,
                found: contours.len(),
                first: first.len(),
            });
        }
        all.push(contours);
    }
    let contours = all[0].len();
    let mut found = vec![];
    for k in 0..contours {
        let is_hole = all[0][k].1;
        let mut loops: Vec<Loop> = vec![];
        for section in &all {
            let own = &section[k].0;
            let start = loops.last().map_or(0, |before| own.nearest_start(before));
            loops.push(own.turned(start));
        }
        found.push(matched(&loops, is_hole));
    }
    Ok(found)
}

fn matched(loops: &[Loop], is_hole: bool) -> Alike {
    let count = loops[0].points.len();
    if loops.iter().all(|l| l.points.len() == count) {
        let is_corner: Vec<bool> =
            (0..count).map(|i| loops.iter().any(|l| l.is_corner(i))).collect();
        let rings = loops.iter().map(|l| l.points.clone()).collect();
        return Alike { rings, curves: numbered(&is_corner), is_hole };
    }
    let mut parts: Vec<(f64, bool)> = vec![];
    for own in loops {
        let (ends, _) = own.parts();
        parts.extend(ends.into_iter().enumerate().map(|(i, part)| (part, own.is_corner(i))));
    }
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, bool)> = vec![];
    for (part, is_corner) in parts {
        match merged.last_mut() {
            Some(last) if part - last.0 <= ONE => last.1 |= is_corner,
            _ => merged.push((part, is_corner)),
        }
    }
    let places: Vec<f64> = merged.iter().map(|(part, _)| *part).collect();
    let is_corner: Vec<bool> = merged.iter().map(|(_, is_corner)| *is_corner).collect();
    let rings = loops.iter().map(|l| l.at(&places)).collect();
    Alike { rings, curves: numbered(&is_corner), is_hole }
}

/// Edges between corners are of one curve.
fn numbered(is_corner: &[bool]) -> Vec<EdgeCurve> {
    let first = is_corner.iter().position(|is_corner| *is_corner);
    let mut number = 0;
    let mut curves = vec![EdgeCurve::Smooth(0); is_corner.len()];
    for i in 0..is_corner.len() {
        let at = (first.unwrap_or(0) + i) % is_corner.len();
        number += u32::from(is_corner[at]);
        curves[at] = EdgeCurve::Smooth(number);
    }
    curves
}
