//! Set operations on plane figures, on the overlay engine of the crate `i_overlay` (64-bit integers).
//!
//! Corners are rounded to a square grid whose step is a power of two, about 2^-40 of the largest
//! coordinate (0.1 picometre for a model of 100 mm), the engine works on integers of 41 bits with exact
//! products, and its result is mapped back:
//!
//! * a corner that was given keeps the coordinates it was given, to the bit; corners that round to the
//!   same or to neighbouring grid points are one corner, the one given first;
//! * a corner where two edges cross is computed anew from the edges as given, to a few units in the last
//!   place; on an edge along an axis that coordinate is the one given;
//! * every edge keeps the [`EdgeCurve`](super::region::EdgeCurve) of the edge it is a part of;
//! * a corner nearer than a grid step to an edge lies on it, so that figures turned by odd angles still
//!   meet along their common border;
//! * a corner in the middle of a straight edge is left out.
//!
//! The result depends on the input alone: pieces, holes and the corners of a contour begin with the
//! least (x, y). Contours are simple: figures that meet at a point only are separate contours there.
//!
//! Coordinates beyond [`REACH`] millimetres and infinite ones are no figures: such contours are left out.

mod contours;
mod grid;

use i_overlay::core::{
    edge_data::{EdgeDataMerge, OverlayEdgeData},
    edge_overlay::{EdgeOverlay, InputEdge},
    fill_rule::FillRule,
    overlay::ShapeType,
    overlay_rule::OverlayRule,
};
use i_overlay::segm::boolean::ShapeCountBoolean;

use super::region::{Contour, Region};
use grid::Grid;

/// The largest coordinate, in millimetres, an overlay takes.
pub const REACH: f64 = 1e12;

/// Which points a set of contours encloses, by the number of times they wind around the point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fill {
    /// An odd number of times.
    EvenOdd,
    /// Any number of times but none.
    NonZero,
    /// Counter-clockwise more often than clockwise.
    Positive,
}

/// What is kept of two figures.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Rule {
    /// What lies in one of them.
    Union,
    /// What lies in both.
    Intersection,
    /// What lies in the subject and not in the clip.
    Difference,
}

/// The number of the given edge that an edge is a part of.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Source(u32);

impl OverlayEdgeData for Source {
    type Store = ();

    fn merge(pair: EdgeDataMerge<ShapeCountBoolean, Source>, _: &mut ()) -> Source {
        pair.lhs_data.min(pair.rhs_data)
    }
}

/// The figure that `rule` makes of two sets of contours, each filled by `fill`.
///
/// ```
/// use glam::dvec2;
/// use katachi::geom::{Contour, overlay::{Fill, Rule, overlay}};
/// let square = |x: f64| {
///     Contour::polygon(vec![dvec2(x, 0.), dvec2(x + 2., 0.), dvec2(x + 2., 2.), dvec2(x, 2.)])
/// };
/// let both = overlay([&square(0.)], [&square(1.)], Rule::Intersection, Fill::NonZero);
/// assert_eq!(both.area(), 2.0);
/// ```
pub fn overlay<'a>(
    subject: impl IntoIterator<Item = &'a Contour>,
    clip: impl IntoIterator<Item = &'a Contour>,
    rule: Rule,
    fill: Fill,
) -> Region {
    let subject: Vec<&Contour> = subject.into_iter().filter(|c| fits(c)).collect();
    let clip: Vec<&Contour> = clip.into_iter().filter(|c| fits(c)).collect();
    let grid = Grid::new(&subject, &clip);
    let mut engine = EdgeOverlay::<i64, Source>::new(grid.edges.len());
    engine.solver.multithreading = None;
    for (number, edge) in grid.edges.iter().enumerate() {
        let kind = if number < grid.clip_start { ShapeType::Subject } else { ShapeType::Clip };
        for (a, b) in grid.parts(edge) {
            engine.add_edge(InputEdge { a, b, data: Source(number as u32) }, kind);
        }
    }
    let rule = match rule {
        Rule::Union => OverlayRule::Union,
        Rule::Intersection => OverlayRule::Intersect,
        Rule::Difference => OverlayRule::Difference,
    };
    let fill = match fill {
        Fill::EvenOdd => FillRule::EvenOdd,
        Fill::NonZero => FillRule::NonZero,
        Fill::Positive => FillRule::Positive,
    };
    contours::region(&grid, engine.build_vector_shapes(rule, fill))
}

fn fits(contour: &Contour) -> bool {
    contour.points.len() >= 3
        && contour.points.iter().all(|p| p.x.abs() <= REACH && p.y.abs() <= REACH)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, dvec2};

    use super::*;
    use crate::geom::EdgeCurve;

    fn union(contours: &[Contour]) -> Region {
        overlay(contours, [], Rule::Union, Fill::NonZero)
    }

    fn square(x: f64, y: f64, side: f64) -> Vec<DVec2> {
        vec![dvec2(x, y), dvec2(x + side, y), dvec2(x + side, y + side), dvec2(x, y + side)]
    }

    fn turned(points: Vec<DVec2>, degrees: f64) -> Contour {
        let (s, c) = (crate::geom::trig::sin_deg(degrees), crate::geom::trig::cos_deg(degrees));
        let turn = DVec2::new(c, s);
        Contour::polygon(points.into_iter().map(|p| turn.rotate(p)).collect())
    }

    #[test]
    fn corners_no_cut_touches_keep_their_bits() {
        let odd = [dvec2(0.1, 0.2), dvec2(7.3, 0.3), dvec2(6.7, 5.1 / 3.0)];
        let far = square(100.7, 0.0, 1.1);
        let result = union(&[Contour::polygon(odd.to_vec()), Contour::polygon(far.clone())]);
        assert_eq!(result.pieces[0].outer.points, odd);
        assert_eq!(result.pieces[1].outer.points, far);
    }

    #[test]
    fn neighbours_turned_by_odd_angles_join_without_slits() {
        for step in 0..60 {
            let angle = 0.37 + 6.1 * f64::from(step);
            let row = (0..10).map(|i| turned(square(f64::from(i) * 3.3, 0.7, 3.3), angle));
            let mut contours: Vec<Contour> = row.collect();
            // A second row, shifted by a third: its corners lie in the middle of edges.
            contours
                .extend((0..10).map(|i| turned(square(f64::from(i) * 3.3 + 1.1, 4.0, 3.3), angle)));
            let result = union(&contours);
            assert_eq!(result.contours().count(), 1, "{angle}");
            assert!((result.area() - 217.8).abs() < 1e-9);
            let shortest = result.contours().flat_map(Contour::edges);
            let shortest = shortest.map(|e| e.from.distance(e.to)).fold(9.0, f64::min);
            assert!(shortest > 1.0, "{angle}: {shortest}");
        }
    }

    #[test]
    fn figures_that_meet_in_a_point_are_simple_contours() {
        let checkers =
            [square(0., 0., 1.), square(1., 1., 1.), square(2., 0., 1.), square(1., -1., 1.)];
        let result = union(&checkers.map(Contour::polygon));
        // A ring of four squares around an empty one, touching at four points.
        assert_eq!(result.area(), 4.0);
        for contour in result.contours() {
            let mut points: Vec<_> = contour.points.iter().map(|p| (p.x, p.y)).collect();
            points.sort_by(|p, q| p.partial_cmp(q).unwrap());
            points.dedup();
            assert_eq!(points.len(), contour.points.len());
        }
    }

    #[test]
    fn edges_keep_their_curves() {
        let circle = EdgeCurve::Circle { center: DVec2::ZERO, radius: 1.0 };
        let mut round =
            Contour::polygon((0..16).map(|i| crate::geom::trig::unit_circle(16, i)).collect());
        round.curves.fill(circle);
        let plate = Contour::polygon(square(-3.0, -3.0, 6.0));
        let result = overlay([&plate], [&round], Rule::Difference, Fill::NonZero);
        let hole = &result.pieces[0].holes[0];
        assert!(hole.curves.iter().all(|c| *c == circle) && hole.points.len() == 16);
        let half = Contour::polygon(square(0.1, -3.0, 6.0));
        let cut = overlay([&round], [&half], Rule::Difference, Fill::NonZero);
        let straight = cut.pieces[0].outer.curves.iter().filter(|c| **c == EdgeCurve::Line);
        assert_eq!(straight.count(), 1);
    }

    #[test]
    fn crossings_are_computed_from_the_given_edges() {
        let a = Contour::polygon(vec![dvec2(0., 0.), dvec2(3., 1.), dvec2(3., 4.)]);
        let b = Contour::polygon(square(1.0, 0.0, 1.0));
        let both = overlay([&a], [&b], Rule::Intersection, Fill::NonZero);
        let near = |p: &&DVec2| p.x == 1.0 && (p.y - 1.0 / 3.0).abs() < 1e-15;
        assert_eq!(both.pieces[0].outer.points.iter().filter(near).count(), 1);
    }

    #[test]
    fn what_is_not_finite_or_flat_is_left_out() {
        let bad = Contour::polygon(vec![dvec2(0., 0.), dvec2(f64::NAN, 1.), dvec2(1., 1.)]);
        let flat = Contour::polygon(vec![dvec2(0., 0.), dvec2(1., 1.), dvec2(2., 2.)]);
        let far = Contour::polygon(vec![dvec2(0., 0.), dvec2(1e13, 1.), dvec2(1., 1.)]);
        assert!(union(&[bad, flat, far]).is_empty());
        assert!(union(&[]).is_empty());
    }

    /// |A| + |B| = |A + B| + |A & B| on random rings, half of them on a coarse grid.
    #[test]
    fn areas_add_up() {
        let mut seed = 7_u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 40) as f64 / (1 << 24) as f64
        };
        for round in 0..400 {
            let mut star = || {
                let n = 3 + (random() * 9.0) as u32;
                let corner = |i| {
                    let p = crate::geom::trig::unit_circle(n, i) * (1.0 + 4.0 * random());
                    let p = p + dvec2(random(), random()) * 4.0;
                    if round % 2 == 0 { p.round() } else { p }
                };
                let star = Contour::polygon((0..n).map(corner).collect());
                overlay([&star], [], Rule::Union, Fill::NonZero)
            };
            let (a, b) = (star(), star());
            let of = |rule| overlay(a.contours(), b.contours(), rule, Fill::NonZero).area();
            let union = of(Rule::Union);
            assert!((a.area() + b.area() - union - of(Rule::Intersection)).abs() < 1e-9);
            assert!((union - b.area() - of(Rule::Difference)).abs() < 1e-9);
        }
    }
}
