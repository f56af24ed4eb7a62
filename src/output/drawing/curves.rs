//! Cubic curves that coincide are drawn once: the most important class wins (ISO 128).

use glam::DVec2;

use super::{
    drawing::{Path, Segment},
    merge::Mark,
};

/// A segment of one of the curves.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// Number of the curve, and of the segment in it.
    at: [usize; 2],
    /// Start, points at a quarter, half and three quarters of the way, and end.
    points: [DVec2; 5],
    mark: Mark,
}

impl Piece {
    /// Whether another runs the same way, or the same way back.
    fn is_like(&self, other: &Piece, tolerance: f64) -> bool {
        let alike = |back: bool| {
            let of = |i: usize| other.points[if back { 4 - i } else { i }];
            (0..5).all(|i| self.points[i].distance(of(i)) <= tolerance)
        };
        alike(false) || alike(true)
    }
}

/// The curves without segments that another curve has too, up to `tolerance` mm.
pub fn merged(curves: Vec<(Path, Mark)>, tolerance: f64) -> Vec<(Path, Mark)> {
    let dropped = repeated(&curves, tolerance);
    if dropped.is_empty() {
        return curves;
    }
    let mut out: Vec<(Path, Mark)> = vec![];
    for (number, (path, mark)) in curves.iter().enumerate() {
        let mut open = false;
        for (i, (start, segment)) in path.pieces().enumerate() {
            let kept = dropped.binary_search(&[number, i]).is_err();
            match out.last_mut().filter(|_| open && kept) {
                Some((path, _)) => path.segments.push(*segment),
                None if kept => out.push((Path::of(start, *segment), *mark)),
                None => {}
            }
            open = kept;
        }
    }
    out
}

/// The segments that a more important one covers, in order.
fn repeated(curves: &[(Path, Mark)], tolerance: f64) -> Vec<[usize; 2]> {
    let mut pieces: Vec<Piece> = vec![];
    for (number, (path, mark)) in curves.iter().enumerate() {
        let points =
            |start, segment: &Segment| [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| segment.at(start, t));
        pieces.extend(path.pieces().enumerate().map(|(i, (start, segment))| Piece {
            at: [number, i],
            points: points(start, segment),
            mark: *mark,
        }));
    }
    pieces.sort_by(|a, b| a.points[2].x.total_cmp(&b.points[2].x));
    let mut dropped = vec![];
    for (i, piece) in pieces.iter().enumerate() {
        let near = |other: &&Piece| other.points[2].x - piece.points[2].x <= tolerance;
        for other in pieces[i + 1..].iter().take_while(near) {
            if piece.is_like(other, tolerance) {
                let first = (piece.mark, piece.at) < (other.mark, other.at);
                dropped.push(if first { other.at } else { piece.at });
            }
        }
    }
    dropped.sort_unstable();
    dropped.dedup();
    dropped
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Class, Kind};

    #[test]
    fn a_curve_drawn_twice_is_drawn_once() {
        let mark = |class, id| Mark { class, order: 0, kind: Kind::Contour, id, loose: false };
        let cubic = |first, second, to| Segment::Cubic { first, second, to };
        let [a, b, c, d] = [(0., 0.), (1., 3.), (4., 3.), (5., 1.)].map(|(x, y)| dvec2(x, y));
        let tail = cubic(dvec2(6., 0.), dvec2(7., 0.), dvec2(8., 2.));
        let there = Path { start: a, segments: vec![cubic(b, c, d), tail] };
        let back = Path::of(d, cubic(c, b, a));
        let hidden = (there.clone(), mark(Class::Hidden, 0));
        let visible = (back, mark(Class::Visible, 1));
        let found = merged(vec![hidden, visible.clone()], 1e-9);
        assert_eq!(found, [(Path::of(d, tail), mark(Class::Hidden, 0)), visible]);
    }
}
