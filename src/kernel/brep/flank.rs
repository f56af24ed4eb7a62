//! What the flanks of extrusions and turned solids have in common: one origin for all facets of one
//! curve, one plane number for all facets of one line.

use std::collections::BTreeMap;

use crate::geom::{
    Contour, Origin, PolyMesh, Region, Surface,
    orient::orient2d,
    region::{Edge, EdgeCurve},
};

/// A curve as a key: edges of one circle or one smooth curve share it.
type CurveKey = (u8, [u64; 3]);

fn key(curve: EdgeCurve) -> CurveKey {
    match curve {
        EdgeCurve::Line => (0, [0; 3]),
        EdgeCurve::Circle { center, radius } => (1, [center.x, center.y, radius].map(f64::to_bits)),
        EdgeCurve::Smooth(number) => (2, [u64::from(number), 0, 0]),
    }
}

/// The origins given so far, one for each curve.
#[derive(Default)]
pub(super) struct Origins {
    known: BTreeMap<CurveKey, u32>,
    plane: Option<u32>,
}

impl Origins {
    /// The origin shared by all flat faces.
    pub(super) fn flat(&mut self, mesh: &mut PolyMesh) -> u32 {
        *self.plane.get_or_insert_with(|| mesh.add_origin(Origin::of(Surface::Plane)))
    }

    /// The origin of the flank of an edge; `surface` says what the edge's curve sweeps. Facets of a
    /// straight edge share an origin only with each other, unless they are flat.
    pub(super) fn of(&mut self, mesh: &mut PolyMesh, curve: EdgeCurve, surface: Surface) -> u32 {
        if surface == Surface::Plane {
            return self.flat(mesh);
        }
        if curve == EdgeCurve::Line {
            return mesh.add_origin(Origin::of(surface));
        }
        *self.known.entry(key(curve)).or_insert_with(|| mesh.add_origin(Origin::of(surface)))
    }
}

/// Whether every contour of a region, which has at least one, has three corners, all finite.
pub(super) fn encloses(region: &Region) -> bool {
    let sound = |c: &Contour| c.points.len() > 2 && c.points.iter().all(|p| p.is_finite());
    !region.is_empty() && region.contours().all(sound)
}

/// Directions and offsets that differ by less, relative to the profile's size, may be those of one
/// line; exact signs decide. Far above rounding, far below what tells two lines apart.
const NEARLY_ONE_LINE: f64 = 1e-9;

/// For each edge of the region, in order of its contours, a number that edges on one line with one
/// direction share.
pub(super) fn lines(region: &Region) -> Vec<u32> {
    let all: Vec<Edge> = region.contours().flat_map(Contour::edges).collect();
    let reach = all.iter().map(|e| e.from.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let rough = |e: &Edge| {
        let direction = (e.to - e.from).normalize_or_zero();
        let offset = direction.perp_dot(e.from) / reach;
        [direction.x, direction.y, offset].map(|v| (v / NEARLY_ONE_LINE).round() as i64)
    };
    let mut order: Vec<([i64; 3], usize)> = all.iter().map(rough).zip(0..).collect();
    order.sort_unstable();
    let mut numbers = vec![0; all.len()];
    let mut first: Option<Edge> = None;
    let mut number = 0;
    for &(_, i) in &order {
        if first.is_none_or(|f| !on_one_line(&f, &all[i])) {
            number += 1;
            first = Some(all[i]);
        }
        numbers[i] = number - 1;
    }
    numbers
}

fn on_one_line(a: &Edge, b: &Edge) -> bool {
    orient2d(a.from, a.to, b.from) == 0.0
        && orient2d(a.from, a.to, b.to) == 0.0
        && (a.to - a.from).dot(b.to - b.from) > 0.0
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::geom::region::Piece;

    #[test]
    fn edges_on_one_line_share_a_number() {
        let comb = [[0., 0.], [7., 0.], [7., 3.], [5., 3.], [5., 1.], [2., 1.], [2., 3.], [0., 3.]];
        let outer = Contour::polygon(comb.map(|[x, y]| dvec2(x, y)).to_vec());
        let region = Region { pieces: vec![Piece { outer, holes: vec![] }] };
        let numbers = lines(&region);
        assert_eq!(numbers[2], numbers[6]);
        let mut distinct = numbers.clone();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), 7);
    }
}
