use std::f64::consts::{PI, TAU};

use glam::dvec3;

use super::*;

fn square(r: f64) -> [DVec3; 4] {
    [dvec3(r, r, 0.0), dvec3(-r, r, 0.0), dvec3(-r, -r, 0.0), dvec3(r, -r, 0.0)]
}

#[test]
fn a_square_makes_a_circle() {
    let circle = Curve::smooth(&square(7.0), true).expect("a circle");
    for i in 0..1000 {
        let p = circle.at(4.0 * f64::from(i) / 1000.0);
        assert!((p.length() - 7.0).abs() < 1e-12, "{i}: {p}");
    }
    // Equal steps of the parameter are equal angles.
    let angles: Vec<f64> = (0..8)
        .map(|i| circle.at(f64::from(i) / 8.0).angle_between(circle.at(f64::from(i + 1) / 8.0)))
        .collect();
    assert!(angles.iter().all(|a| (a - PI / 16.0).abs() < 1e-7), "{angles:?}");
}

/// The paper's formula, by its own parameter.
#[test]
fn quarters_are_the_papers_conics() {
    let points = [dvec3(1., 2., 3.), dvec3(4., -1., 2.), dvec3(5., 3., 7.), dvec3(0., 4., 1.)];
    let curve = Curve::smooth(&points, false).expect("a curve");
    let [p, q, r] = [points[0], points[1], points[1].midpoint(points[2])];
    for i in 0..=20 {
        let s = f64::from(i) / 20.0;
        let t = libm::tan(PI * s / 4.0);
        let sum = p * ((1.0 - t) * (1.0 - t)) + q * (2.0 * t * (1.0 - t)) + r * (2.0 * t * t);
        assert!(curve.at(s).distance(sum / (1.0 + t * t)) < 1e-14);
    }
    assert_eq!((curve.at(0.0), curve.at(2.0)), (points[0], points[3]));
}

#[test]
fn an_ellipse_from_a_rectangle() {
    let corners = square(1.0).map(|p| dvec3(5.0 * p.x, 2.0 * p.y, 0.0));
    let ellipse = Curve::smooth(&corners, true).expect("an ellipse");
    for i in 0..1000 {
        let p = ellipse.at(4.0 * f64::from(i) / 1000.0);
        assert!(((p.x / 5.0).powi(2) + (p.y / 2.0).powi(2) - 1.0).abs() < 1e-12);
    }
    // The perimeter of the ellipse with half axes 5 and 2, from the complete elliptic integral.
    assert!((ellipse.length() - 23.013_112_595_664_84).abs() < 1e-9, "{}", ellipse.length());
}

#[test]
fn lengths_of_helices_have_a_closed_form() {
    let turn = Turn {
        center: DVec3::ZERO,
        x: DVec3::X * 5.0,
        y: DVec3::Y * 5.0,
        rise: DVec3::Z * 2.0,
        from: 0.0,
        to: 1080.0,
    };
    let helix = Curve::turn(turn);
    assert!((helix.length() - 3.0 * libm::hypot(10.0 * PI, 2.0)).abs() < 1e-12);
    assert!((helix.at(helix.place(0.5)) - dvec3(-5.0, 0.0, 3.0)).length() < 1e-12);
    assert!((helix.curvature(0.3).length() - 5.0 / (25.0 + 1.0 / (PI * PI))).abs() < 1e-12);
}

#[test]
fn splines_are_smooth_to_the_second_derivative() {
    let points: Vec<DVec3> =
        (0..7).map(|i| dvec3(f64::from(i * i), f64::from(i % 3), f64::from(i % 2))).collect();
    for closed in [false, true] {
        let curve = Curve::spline(&points, closed, [None; 2]).expect("a spline");
        let steps: Vec<f64> =
            curve.pieces().iter().map(|p| p.ends()[0].distance(p.ends()[1])).collect();
        let count = curve.pieces().len();
        let joints = if closed { 0..count } else { 1..count };
        for i in joints {
            let before = (i + count - 1) % count;
            let jets = [curve.pieces()[before].jet(1.0), curve.pieces()[i].jet(0.0)];
            let scale = [steps[before], steps[i]];
            let first = [0, 1].map(|k| jets[k].first / scale[k]);
            let second = [0, 1].map(|k| jets[k].second / (scale[k] * scale[k]));
            assert!(first[0].distance(first[1]) < 1e-12, "{closed} {i}");
            assert!(second[0].distance(second[1]) < 1e-12, "{closed} {i}: {second:?}");
        }
    }
}

#[test]
fn a_curve_is_cut_and_put_together() {
    let curve = Curve::smooth(
        &[dvec3(0., 0., 0.), dvec3(9., 0., 1.), dvec3(9., 9., 2.), dvec3(0., 9., 5.)],
        false,
    )
    .expect("a curve");
    for part in [0.1, 0.35, 0.5, 0.9] {
        let place = curve.place(part);
        assert!((curve.part(place) - part).abs() < 1e-12);
        let [a, b] = curve.split(place).expect("inside");
        assert!((a.length() - part * curve.length()).abs() < 1e-10);
        let whole = Curve::joined(&[&a, &b]).expect("they meet");
        assert!((whole.length() - curve.length()).abs() < 1e-10);
        let near = curve.nearest(curve.at(place));
        assert!((near - place).abs() < 1e-7, "{near} {place}");
    }
    let back = curve.reversed();
    assert!(back.at(back.place(0.25)).distance(curve.at(curve.place(0.75))) < 1e-10);
    assert!(matches!(Curve::joined(&[&curve, &curve]), Err(CurveError::Gap { number: 1, .. })));
}

#[test]
fn points_keep_within_the_tolerance() {
    let wave = [dvec3(0., 0., 0.), dvec3(30., 50., 0.), dvec3(60., -50., 20.), dvec3(90., 0., 0.)];
    let tolerance = Tolerance::new(0.01).expect("a tolerance");
    for curve in
        [Curve::bezier(&wave), Curve::smooth(&wave, true), Curve::spline(&wave, false, [None; 2])]
    {
        let curve = curve.expect("a curve");
        let points = curve.points(tolerance);
        assert_eq!(points.len() as u64, curve.chords(tolerance) + 1);
        for pair in points.windows(2) {
            let middle = pair[0].midpoint(pair[1]);
            assert!(curve.at(curve.nearest(middle)).distance(middle) <= 0.01);
        }
    }
    let circle = Curve::smooth(&square(10.0), true).expect("a circle");
    assert!((circle.length() - TAU * 10.0).abs() < 1e-11);
}

#[test]
fn corners_are_rounded_where_arcs_fit() {
    let square = Curve::polyline(&square(5.0), true).expect("a square");
    let round = square.rounded(2.0).expect("it fits");
    assert_eq!(round.pieces().len(), 8);
    assert!((round.length() - (24.0 + 4.0 * PI)).abs() < 1e-12);
    assert!((0..8).all(|joint| round.is_smooth_at(joint)));
    assert!(matches!(square.rounded(6.0), Err(PlaneError::Tight { fits, .. }) if fits == 5.0));
}

#[test]
fn parallels_keep_their_distance() {
    let corner = [dvec3(0., 0., 0.), dvec3(10., 0., 0.), dvec3(10., 8., 0.)];
    let corner = Curve::polyline(&corner, false).expect("a corner");
    // To the right of its way is outside, where the corner is an arc; inside both sides are cut.
    let (out, inside) =
        (corner.offset(2.0).expect("outside"), corner.offset(-2.0).expect("inside"));
    assert!((out.length() - (18.0 + PI)).abs() < 1e-12, "{}", out.length());
    assert!((inside.length() - 14.0).abs() < 1e-6, "{}", inside.length());
    let corners = square(1.0).map(|p| dvec3(9.0 * p.x, 6.0 * p.y, 0.0));
    let ellipse = Curve::smooth(&corners, true).expect("an ellipse");
    for d in [1.5, -1.5] {
        let parallel = ellipse.offset(d).expect("wide enough");
        for i in 0..100 {
            let p = parallel.at(parallel.place(f64::from(i) / 100.0));
            let off = ellipse.at(ellipse.nearest(p)).distance(p);
            assert!((off - d.abs()).abs() < 1e-5, "{d} {i}: {off}");
        }
    }
    // Its narrowest radius is 36 / 9.
    assert!(matches!(ellipse.offset(-5.0), Err(PlaneError::Narrow { .. })));
    let helix = Turn {
        center: DVec3::ZERO,
        x: DVec3::X,
        y: DVec3::Y,
        rise: DVec3::Z,
        from: 0.0,
        to: 360.0,
    };
    assert_eq!(Curve::turn(helix).offset(0.1), Err(PlaneError::NotFlat));
}
