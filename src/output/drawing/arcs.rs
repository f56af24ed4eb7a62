//! Arcs that coincide are drawn once: the most important class wins (ISO 128).

use std::f64::consts::TAU;

use glam::DVec2;

use super::{
    conic::Ellipse,
    drawing::{Path, Segment},
    merge::Mark,
};

/// An arc of an ellipse, counter-clockwise from one parameter to a larger one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ArcPiece {
    /// Where it lies.
    pub ellipse: Ellipse,
    /// Parameter of its start.
    pub from: f64,
    /// Parameter of its end.
    pub to: f64,
    /// How it is drawn and whose it is.
    pub mark: Mark,
}

/// The arcs without overlaps: arcs of one ellipse, up to `tolerance` mm, are cut at each other's ends, the
/// most important is kept of each part, and equal neighbours are joined.
pub fn merged(arcs: &[ArcPiece], tolerance: f64) -> Vec<ArcPiece> {
    let mut order: Vec<usize> = (0..arcs.len()).collect();
    order.sort_by(|&a, &b| arcs[a].ellipse.center.x.total_cmp(&arcs[b].ellipse.center.x));
    let mut taken = vec![false; arcs.len()];
    let mut out = vec![];
    for (i, &one) in order.iter().enumerate() {
        if std::mem::replace(&mut taken[one], true) {
            continue;
        }
        let mut group = vec![one];
        for &other in &order[i + 1..] {
            let (a, b) = (&arcs[one].ellipse, &arcs[other].ellipse);
            if b.center.x - a.center.x > tolerance {
                break;
            }
            if !taken[other] && alike(a, b, tolerance) {
                taken[other] = true;
                group.push(other);
            }
        }
        merge_group(arcs, &group, &mut out);
    }
    out
}

/// Curves on the ellipse of one of the arcs, up to `near` mm, become arcs of it, so that they can be merged; the others
/// are given back. A short curve does not tell its ellipse by itself.
pub fn adopted(
    curves: Vec<(Path, Mark)>,
    arcs: &mut Vec<ArcPiece>,
    near: f64,
) -> Vec<(Path, Mark)> {
    let ellipses: Vec<Ellipse> = arcs.iter().map(|arc| arc.ellipse).collect();
    let mut others = vec![];
    for (path, mark) in curves {
        let found = ellipses.iter().find_map(|e| on_ellipse(&path, e, near).map(|part| (e, part)));
        match found {
            Some((&ellipse, [from, to])) => arcs.push(ArcPiece { ellipse, from, to, mark }),
            None => others.push((path, mark)),
        }
    }
    others
}

/// The parameters of a short curve's ends on an ellipse, the second one larger, if it lies on it.
fn on_ellipse(path: &Path, ellipse: &Ellipse, near: f64) -> Option<[f64; 2]> {
    let on = |p: DVec2| ellipse.at(ellipse.parameter(p)).distance(p) <= near;
    let is_on = |(start, segment): (DVec2, &Segment)| {
        [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|t| on(segment.at(start, *t)))
    };
    let within = path.start.distance(ellipse.center) <= ellipse.major.length() + near;
    if !within || !path.pieces().all(is_on) || path.length() > ellipse.minor.length() {
        return None;
    }
    let [s, e] = [path.start, path.end()].map(|p| ellipse.parameter(p));
    let after = |from: f64, to: f64| (to - from).rem_euclid(TAU);
    let forwards = after(s, e) <= after(e, s);
    Some(if forwards { [s, s + after(s, e)] } else { [e, e + after(e, s)] })
}

fn alike(a: &Ellipse, b: &Ellipse, tolerance: f64) -> bool {
    a.center.distance(b.center) <= tolerance
        && a.major.distance(b.major) <= tolerance
        && a.minor.distance(b.minor) <= tolerance
}

/// Merges arcs of one ellipse.
fn merge_group(arcs: &[ArcPiece], group: &[usize], out: &mut Vec<ArcPiece>) {
    if let &[only] = group {
        return out.push(arcs[only]);
    }
    let ellipse = arcs[group[0]].ellipse;
    let mut parts: Vec<(f64, f64, Mark)> = vec![];
    for arc in group.iter().map(|&i| &arcs[i]) {
        let from = arc.from.rem_euclid(TAU);
        let to = from + (arc.to - arc.from);
        parts.push((from, to.min(TAU), arc.mark));
        if to > TAU {
            parts.push((0.0, to - TAU, arc.mark));
        }
    }
    let mut cuts: Vec<f64> = parts.iter().flat_map(|p| [p.0, p.1]).collect();
    cuts.sort_by(f64::total_cmp);
    let mut merged: Vec<ArcPiece> = vec![];
    for cut in cuts.windows(2).filter(|c| c[1] > c[0]) {
        let covering = parts.iter().filter(|p| p.0 <= cut[0] && cut[1] <= p.1);
        let Some(mark) = covering.map(|p| p.2).min() else { continue };
        match merged.last_mut() {
            Some(last) if last.to == cut[0] && last.mark == mark => last.to = cut[1],
            _ => merged.push(ArcPiece { ellipse, from: cut[0], to: cut[1], mark }),
        }
    }
    join_ends(&mut merged);
    out.append(&mut merged);
}

/// Joins the last arc with the first where the parameter begins anew.
fn join_ends(arcs: &mut Vec<ArcPiece>) {
    if let [first, .., last] = &mut arcs[..]
        && first.from == 0.0
        && last.to == TAU
        && first.mark == last.mark
    {
        last.to += first.to;
        arcs.remove(0);
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Class, Kind};

    #[test]
    fn short_curves_on_an_ellipse_become_arcs_of_it() {
        let ellipse =
            Ellipse { center: dvec2(1.0, 2.0), major: DVec2::X * 3.0, minor: DVec2::Y * 3.0 };
        let mark =
            Mark { class: Class::Hidden, order: 1, kind: Kind::Contour, id: 0, loose: false };
        let mut arcs = vec![ArcPiece { ellipse, from: 0.0, to: 3.0, mark }];
        let [p, q] = [0.5, 0.48].map(|t| ellipse.at(t));
        let along = |t: f64| {
            let (sin, cos) = libm::sincos(t);
            dvec2(-sin, cos) * 0.02
        };
        let (first, second) = (p - along(0.5), q + along(0.48));
        let curve = |first: DVec2| (Path::of(p, Segment::Cubic { first, second, to: q }), mark);
        let others = adopted(vec![curve(first), curve(first * 1.1)], &mut arcs, 1e-6);
        assert_eq!((others.len(), arcs.len()), (1, 2));
        assert!((arcs[1].from - 0.48).abs() < 1e-9 && (arcs[1].to - 0.5).abs() < 1e-9);
    }

    #[test]
    fn overlapping_arcs_are_drawn_once() {
        let ellipse = Ellipse { center: dvec2(1.0, 2.0), major: DVec2::X * 3.0, minor: DVec2::Y };
        let mark = |class, order| Mark { class, order, kind: Kind::Sharp, id: 0, loose: false };
        let (seen, unseen) = (mark(Class::Visible, 0), mark(Class::Hidden, 1));
        let arc = |from, to, mark| ArcPiece { ellipse, from, to, mark };
        let out = merged(&[arc(1.0, 1.0 + TAU, unseen), arc(-1.0, 2.0, seen)], 1e-9);
        let length = |class| -> f64 {
            out.iter().filter(|a| a.mark.class == class).map(|a| a.to - a.from).sum()
        };
        assert!((length(Class::Visible) - 3.0).abs() < 1e-12);
        assert!((length(Class::Hidden) - (TAU - 3.0)).abs() < 1e-12);
        assert_eq!(out.len(), 2);
    }
}
