//! Polygons from corners a modeller wrote down.

use std::cmp::Ordering;

use glam::DVec2;

use super::{ProfileError, error::Segment, orientation::orientation, primitive::single};
use crate::geom::{
    Contour, Region,
    overlay::{Fill, REACH, Rule, overlay},
};

/// The polygon with the given corners (mm, in either direction) less `holes`.
///
/// Contours may touch themselves and each other at single points.
///
/// # Errors
/// Too few corners, a corner given twice in a row, corners on one line, segments that cross or lie on
/// each other (decided exactly), a hole outside the outline.
///
/// ```
/// use glam::dvec2;
/// use katachi::kernel::profile::polygon;
/// let triangle = [dvec2(0., 0.), dvec2(0., 2.), dvec2(2., 0.)];
/// assert_eq!(polygon(&triangle, &[]).unwrap().area(), 2.0);
/// ```
pub fn polygon(points: &[DVec2], holes: &[Vec<DVec2>]) -> Result<Region, ProfileError> {
    let contours: Vec<&[DVec2]> =
        std::iter::once(points).chain(holes.iter().map(Vec::as_slice)).collect();
    for (number, corners) in contours.iter().enumerate() {
        check_corners(number, corners)?;
    }
    let touches = check_crossings(&contours)?;
    let outer = Contour::polygon(oriented(points, true));
    let holes: Vec<Contour> = holes.iter().map(|h| Contour::polygon(oriented(h, false))).collect();
    check_holes(&outer, &holes)?;
    if touches {
        let all = std::iter::once(&outer).chain(&holes);
        return Ok(overlay(all, [], Rule::Union, Fill::Positive));
    }
    let mut region = single(outer);
    region.pieces[0].holes = holes;
    Ok(region)
}

fn check_corners(contour: usize, corners: &[DVec2]) -> Result<(), ProfileError> {
    let far = |p: &DVec2| !(p.x.abs() <= REACH && p.y.abs() <= REACH);
    if let Some(index) = corners.iter().position(far) {
        return Err(ProfileError::Coordinate { contour, index, at: corners[index] });
    }
    let count = corners.len();
    if count < 3 {
        return Err(ProfileError::Corners { contour, count });
    }
    for index in 0..count {
        let next = (index + 1) % count;
        if corners[index] == corners[next] {
            return Err(ProfileError::Repeated { contour, index, next, at: corners[index] });
        }
    }
    let flat = |p: &DVec2| orientation(corners[0], corners[1], *p) == Ordering::Equal;
    if corners.iter().all(flat) {
        return Err(ProfileError::Flat { contour });
    }
    Ok(())
}

/// The corners in the wanted direction, the first one staying first.
fn oriented(corners: &[DVec2], counter_clockwise: bool) -> Vec<DVec2> {
    let mut corners = corners.to_vec();
    if is_counter_clockwise(&corners) != counter_clockwise {
        corners[1..].reverse();
    }
    corners
}

/// Decided exactly at the least corner, which is convex.
fn is_counter_clockwise(corners: &[DVec2]) -> bool {
    let n = corners.len();
    let less = |p: DVec2, q: DVec2| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
    let least = (0..n).min_by(|&i, &j| less(corners[i], corners[j])).unwrap_or(0);
    let (before, after) = (corners[(least + n - 1) % n], corners[(least + 1) % n]);
    match orientation(before, corners[least], after) {
        Ordering::Equal => Contour::polygon(corners.to_vec()).area() > 0.0,
        turn => turn == Ordering::Greater,
    }
}

/// A segment with its place in the polygon.
#[derive(Clone, Copy)]
struct Side {
    a: DVec2,
    b: DVec2,
    name: Segment,
    count: usize,
}

/// Whether contours touch at points; an error where segments cross. A sweep over x.
fn check_crossings(contours: &[&[DVec2]]) -> Result<bool, ProfileError> {
    let mut sides = sides(contours);
    sides.sort_by(|s, t| s.a.x.min(s.b.x).total_cmp(&t.a.x.min(t.b.x)).then(s.name.cmp(&t.name)));
    let (mut active, mut touches): (Vec<Side>, bool) = (vec![], false);
    for side in sides {
        let left = side.a.x.min(side.b.x);
        active.retain(|other| other.a.x.max(other.b.x) >= left);
        for other in &active {
            touches |= check_pair(contours, other, &side)?;
        }
        active.push(side);
    }
    Ok(touches)
}

fn sides(contours: &[&[DVec2]]) -> Vec<Side> {
    let all = contours.iter().enumerate().flat_map(|(contour, corners)| {
        let count = corners.len();
        (0..count).map(move |index| {
            let next = (index + 1) % count;
            let name = Segment { contour, index, next };
            Side { a: corners[index], b: corners[next], name, count }
        })
    });
    all.collect()
}

/// Whether two sides touch in a point without crossing.
fn check_pair(contours: &[&[DVec2]], s: &Side, t: &Side) -> Result<bool, ProfileError> {
    let (low, high) = (s.a.y.min(s.b.y), s.a.y.max(s.b.y));
    if t.a.y.max(t.b.y) < low || t.a.y.min(t.b.y) > high {
        return Ok(false);
    }
    let crossing = |at| {
        let mut segments = [s.name, t.name];
        segments.sort();
        Err(ProfileError::SelfCrossing { at, segments })
    };
    let around_t = [orientation(t.a, t.b, s.a), orientation(t.a, t.b, s.b)];
    let around_s = [orientation(s.a, s.b, t.a), orientation(s.a, s.b, t.b)];
    if around_t == [Ordering::Equal; 2] {
        return match common_stretch(s, t) {
            Some(at) => crossing(at),
            None => touch(contours, s, t).map_or(Ok(false), |at| vertex(contours, s, t, at)),
        };
    }
    let apart = |turns: [Ordering; 2]| turns[0] == turns[1];
    if apart(around_t) || apart(around_s) {
        return Ok(false);
    }
    if !around_t.contains(&Ordering::Equal) && !around_s.contains(&Ordering::Equal) {
        return crossing(meeting_point(s, t));
    }
    touch(contours, s, t).map_or(Ok(false), |at| vertex(contours, s, t, at))
}

/// A point inside the stretch that two sides on one line share.
fn common_stretch(s: &Side, t: &Side) -> Option<DVec2> {
    let key = |p: DVec2| [p.x, p.y];
    let ends = |side: &Side| {
        if key(side.a) < key(side.b) { (side.a, side.b) } else { (side.b, side.a) }
    };
    let ((s0, s1), (t0, t1)) = (ends(s), ends(t));
    let start = if key(s0) < key(t0) { t0 } else { s0 };
    let end = if key(s1) < key(t1) { s1 } else { t1 };
    (key(start) < key(end)).then(|| start.midpoint(end))
}

fn meeting_point(s: &Side, t: &Side) -> DVec2 {
    let (d, g) = (s.b - s.a, t.b - t.a);
    let along = (t.a - s.a).perp_dot(g) / d.perp_dot(g);
    s.a + d * along.clamp(0.0, 1.0)
}

/// The end of one side that lies on the other; `None` for the common corner of neighbours.
fn touch(contours: &[&[DVec2]], s: &Side, t: &Side) -> Option<DVec2> {
    let neighbours = s.name.contour == t.name.contour
        && (s.name.next == t.name.index || t.name.next == s.name.index)
        && contours[s.name.contour].len() > 2;
    let joint = if s.name.next == t.name.index { s.b } else { s.a };
    let ends = [(s.a, t), (s.b, t), (t.a, s), (t.b, s)];
    let mut on = ends.iter().filter(|(p, side)| is_on(*p, side)).map(|(p, _)| *p);
    if neighbours { on.find(|p| *p != joint) } else { on.next() }
}

fn is_on(p: DVec2, side: &Side) -> bool {
    let (low, high) = (side.a.min(side.b), side.a.max(side.b));
    p.cmpge(low).all() && p.cmple(high).all() && orientation(side.a, side.b, p) == Ordering::Equal
}

/// Two strands meet in `at`: whether they only touch (true), or an error if they cross.
fn vertex(contours: &[&[DVec2]], s: &Side, t: &Side, at: DVec2) -> Result<bool, ProfileError> {
    let (s_in, s_out) = strand(contours, s, at);
    let (t_in, t_out) = strand(contours, t, at);
    let inside = [t_in, t_out].map(|p| is_between(at, s_in, s_out, p));
    match inside {
        [Some(first), Some(second)] if first == second => Ok(true),
        _ => {
            let mut segments = [s.name, t.name];
            segments.sort();
            Err(ProfileError::SelfCrossing { at, segments })
        }
    }
}

/// The points before and after `at` on the contour of a side that passes through it.
fn strand(contours: &[&[DVec2]], side: &Side, at: DVec2) -> (DVec2, DVec2) {
    let corners = contours[side.name.contour];
    let n = side.count;
    if at == side.a {
        (corners[(side.name.index + n - 1) % n], side.b)
    } else if at == side.b {
        (side.a, corners[(side.name.next + 1) % n])
    } else {
        (side.a, side.b)
    }
}

/// Whether the direction of `p` lies counter-clockwise between those of `from` and `to`, all seen
/// from `at`; `None` if it is one of them.
fn is_between(at: DVec2, from: DVec2, to: DVec2, p: DVec2) -> Option<bool> {
    let same = |q: DVec2| orientation(at, q, p) == Ordering::Equal && (q - at).dot(p - at) > 0.0;
    if same(from) || same(to) {
        return None;
    }
    let after_from = orientation(at, from, p) == Ordering::Greater;
    let before_to = orientation(at, p, to) == Ordering::Greater;
    let opening = orientation(at, from, to);
    let straight = opening == Ordering::Equal;
    Some(match opening {
        Ordering::Greater => after_from && before_to,
        _ if straight => after_from,
        _ => {
            let after_to = orientation(at, to, p) == Ordering::Greater;
            let before_from = orientation(at, p, from) == Ordering::Greater;
            !(after_to && before_from)
        }
    })
}

fn check_holes(outer: &Contour, holes: &[Contour]) -> Result<(), ProfileError> {
    for (i, hole) in holes.iter().enumerate() {
        let others = holes.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, h)| h);
        let stray = !holds(outer, hole) || { others }.any(|other| holds(other, hole));
        if stray {
            return Err(ProfileError::StrayHole { contour: i + 1 });
        }
    }
    Ok(())
}

/// Whether `inner`, which does not cross `outer`, lies in it: by the first middle of an edge of
/// `inner` that is not on `outer`.
fn holds(outer: &Contour, inner: &Contour) -> bool {
    let p = inner.points[0].midpoint(inner.points[1]);
    let edges = outer.edges().map(|e| (e.from, e.to));
    let crossed = edges.filter(|&(a, b)| {
        let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
        low.y <= p.y && p.y < high.y && orientation(low, high, p) == Ordering::Greater
    });
    crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().map(|&(x, y)| dvec2(x, y)).collect()
    }

    #[test]
    fn a_bow_tie_names_the_point_and_the_segments() {
        let bow = points(&[(0., 0.), (4., 4.), (4., 0.), (0., 4.)]);
        let error = polygon(&bow, &[]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the polygon crosses itself at (2, 2): the segment from corner 0 to 1 and \
             the segment from corner 2 to 3 meet there"
        );
        let through = points(&[(0., 0.), (2., 2.), (4., 4.), (4., 0.), (2., 2.), (0., 4.)]);
        let error = polygon(&through, &[]).unwrap_err();
        assert!(matches!(error, ProfileError::SelfCrossing { at, .. } if at == dvec2(2., 2.)));
    }

    #[test]
    fn a_spike_and_a_doubled_edge_are_crossings() {
        let spike = points(&[(0., 0.), (4., 0.), (6., 0.), (4., 0.), (4., 4.)]);
        assert!(matches!(polygon(&spike, &[]), Err(ProfileError::SelfCrossing { .. })));
        let keyhole = points(&[
            (0., 0.),
            (9., 0.),
            (9., 9.),
            (5., 5.),
            (5., 4.),
            (5., 5.),
            (9., 9.),
            (0., 9.),
        ]);
        assert!(matches!(polygon(&keyhole, &[]), Err(ProfileError::SelfCrossing { .. })));
    }

    #[test]
    fn touching_in_a_point_is_no_crossing() {
        let hourglass = points(&[(0., 0.), (4., 0.), (2., 2.), (4., 4.), (0., 4.), (2., 2.)]);
        let region = polygon(&hourglass, &[]).unwrap();
        assert_eq!((region.pieces.len(), region.area()), (2, 8.0));
        let hole = points(&[(2., 0.), (3., 1.), (1., 1.)]);
        let region = polygon(&points(&[(0., 0.), (4., 0.), (4., 4.), (0., 4.)]), &[hole]).unwrap();
        assert_eq!(region.area(), 15.0);
    }

    #[test]
    fn either_direction_and_holes() {
        let clockwise = points(&[(0., 0.), (0., 4.), (4., 4.), (4., 0.)]);
        let hole = points(&[(1., 1.), (2., 1.), (2., 2.), (1., 2.)]);
        let region = polygon(&clockwise, std::slice::from_ref(&hole)).unwrap();
        assert_eq!(region.area(), 15.0);
        assert!(region.pieces[0].outer.area() > 0.0 && region.pieces[0].holes[0].area() < 0.0);
        let stray = points(&[(9., 9.), (10., 9.), (10., 10.)]);
        let error = polygon(&clockwise, &[hole.clone(), stray]).unwrap_err();
        assert_eq!(error, ProfileError::StrayHole { contour: 2 });
        let across = points(&[(3., 1.), (5., 1.), (5., 2.)]);
        let error = polygon(&clockwise, &[across]).unwrap_err();
        assert!(matches!(error, ProfileError::SelfCrossing { .. }));
        let error = polygon(&clockwise, &[hole.clone(), hole]).unwrap_err();
        assert!(matches!(error, ProfileError::SelfCrossing { .. }));
    }

    #[test]
    fn what_encloses_nothing_is_refused() {
        let message = |list: &[(f64, f64)]| polygon(&points(list), &[]).unwrap_err().to_string();
        assert_eq!(
            message(&[(0., 0.), (1., 0.)]),
            "a polygon needs at least 3 corners, the outline has 2"
        );
        assert!(
            message(&[(0., 0.), (1., 1.), (2., 2.)]).starts_with("the outline encloses no area")
        );
        assert!(
            message(&[(0., 0.), (1., 1.), (1., 1.), (2., 0.)])
                .contains("corners 1 and 2 are both at (1, 1)")
        );
        assert!(message(&[(0., 0.), (f64::NAN, 1.), (2., 2.)]).starts_with("corner 1 is (NaN, 1)"));
        assert!(message(&[(0., 0.), (1., 1.), (1., 0.), (0., 0.)]).contains("corners 3 and 0"));
    }

    #[test]
    fn a_nearly_crossing_pair_is_decided_exactly() {
        let tip = |y: f64| points(&[(0., 0.), (10., 0.), (10., 10.), (5., y), (0., 10.)]);
        assert!(polygon(&tip(1e-300), &[]).is_ok());
        assert!(matches!(polygon(&tip(-1e-18), &[]), Err(ProfileError::SelfCrossing { .. })));
    }
}
