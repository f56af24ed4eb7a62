//! Where planes merely touch facets.

use super::{
    facet::Facets,
    space::{Offset, Space},
};

/// A corner, both ends the same, or an edge of a facet in which a plane touches it: all of the facet that is
/// on the plane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Rim {
    /// The end with the smaller number.
    a: u32,
    /// The other end.
    b: u32,
}

impl Rim {
    /// Where a plane touches a facet, given how far the facet's corners are from it; `None` if it has more
    /// of it, or nothing.
    pub fn of(facet: u32, facets: &Facets, offsets: &[Offset]) -> Option<Rim> {
        let keeps_off = |side: i32| offsets.iter().all(|o| o.sign != side);
        if !keeps_off(1) && !keeps_off(-1) {
            return None;
        }
        let mut loops = facets.loops(facet);
        let (Some(corners), None) = (loops.next(), loops.next()) else { return None };
        let mut on = (0..corners.len()).filter(|&i| offsets[i].sign == 0);
        let first = on.next()?;
        let Some(second) = on.next() else {
            return Some(Rim::between(corners[first], corners[first]));
        };
        let is_edge = second == first + 1 || (first == 0 && second + 1 == corners.len());
        (is_edge && on.next().is_none()).then(|| Rim::between(corners[first], corners[second]))
    }

    fn between(a: u32, b: u32) -> Rim {
        Rim { a: a.min(b), b: a.max(b) }
    }

    fn has(self, point: u32) -> bool {
        point == self.a || point == self.b
    }

    /// Whether all that this rim has in common with another one on the same line is a corner or an edge of
    /// both, or nothing. Facets that share it need no trace of it.
    pub fn shares_all(self, other: Rim, space: &Space) -> bool {
        match (self.a == self.b, other.a == other.b) {
            (true, true) => true,
            (true, false) => other.has(self.a),
            (false, true) => self.has(other.a),
            (false, false) => self == other || self.leads_to(other, space),
        }
    }

    /// Whether this edge ends where another one on the same line goes on.
    fn leads_to(self, other: Rim, space: &Space) -> bool {
        let (from, end) = if other.has(self.a) { (self.b, self.a) } else { (self.a, self.b) };
        let to = if end == other.a { other.b } else { other.a };
        let (axis, sign) = space.direction(from, end);
        other.has(end) && space.compare(to, end, axis) as i32 == sign
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Edges on the x axis, given by where they start and end.
    fn shares([a, b]: [i64; 2], [c, d]: [i64; 2]) -> bool {
        let mut space = Space::default();
        let mut at = |x: i64| space.add_lattice_point([x, 0, 0]);
        let (first, second) = (Rim::between(at(a), at(b)), Rim::between(at(c), at(d)));
        let found = first.shares_all(second, &space);
        assert_eq!(second.shares_all(first, &space), found);
        found
    }

    #[test]
    fn what_ends_at_ends_of_both_is_shared() {
        assert!(shares([1, 5], [5, 1]) && shares([1, 5], [5, 9]) && shares([1, 5], [-3, 1]));
        assert!(shares([1, 5], [1, 1]) && shares([1, 1], [1, 1]) && shares([1, 1], [2, 2]));
    }

    #[test]
    fn what_ends_inside_of_one_is_not() {
        assert!(!shares([1, 5], [5, 3]) && !shares([1, 5], [1, 9]) && !shares([1, 5], [3, 9]));
        assert!(!shares([1, 5], [2, 4]) && !shares([1, 5], [3, 3]));
    }

    /// The plane x = 0 touches a square in an edge or a corner, or crosses it.
    #[test]
    fn planes_touch_in_edges_and_corners() {
        let rim = |signs: [i32; 4]| {
            let mut facets = Facets::default();
            let mut space = Space::default();
            let square = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]];
            let corners = square.map(|at| space.add_lattice_point(at));
            facets.push_loop(corners.into_iter().map(|corner| (corner, super::super::space::NONE)));
            let source =
                super::super::facet::Source { leaf: 0, face: 0, flat: true, flipped: false };
            facets.push(source, 1, None, &space);
            Rim::of(0, &facets, &signs.map(|sign| Offset { sign, value: 0.0, error: 0.0 }))
        };
        assert_eq!(rim([0, 1, 1, 0]), Some(Rim { a: 0, b: 3 }));
        assert_eq!(rim([1, 0, 0, 1]), Some(Rim { a: 1, b: 2 }));
        assert_eq!(rim([-1, -1, 0, -1]), Some(Rim { a: 2, b: 2 }));
        for crossing in [[0, 1, 0, -1], [0, 1, 0, 1], [1, -1, -1, 0], [1, 1, 1, 1]] {
            assert_eq!(rim(crossing), None);
        }
    }
}
