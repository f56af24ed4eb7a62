use glam::{DVec3, dvec3};

use super::*;
use crate::geom::isometric::{SHRINK, image};

/// One user unit is a millimetre along an axis.
const TRUE: IsoScale = IsoScale { origin: DVec3::ZERO, unit: Some(1.0), snap: None };

fn drawing(body: &str, scale: &IsoScale) -> Result<IsoDrawing, ReadError> {
    let svg = format!(r#"<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>"#);
    read("drawing.svg", svg.as_bytes(), scale)
}

/// A polyline through the images of points, shown from (100, 100).
fn line(points: &[DVec3], attributes: &str) -> String {
    let place = |p: &DVec3| {
        let at = image(*p) / SHRINK;
        format!("{},{}", 100.0 + at.x, 100.0 - at.y)
    };
    let places: Vec<String> = points.iter().map(place).collect();
    format!(r#"<polyline {attributes} points="{}"/>"#, places.join(" "))
}

fn near(found: &[DVec3], expected: &[DVec3]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!(a.distance(*b) < 1e-9, "{found:?}");
    }
}

#[test]
fn strokes_change_one_coordinate_each() {
    let corners = [DVec3::ZERO, dvec3(5., 0., 0.), dvec3(5., 4., 0.), dvec3(5., 4., -3.)];
    let found = drawing(&line(&corners, ""), &TRUE).expect("resolved");
    near(&found.vertices, &corners);
    let scale = IsoScale { origin: dvec3(1., 2., 3.), unit: Some(0.5), snap: None };
    let moved = corners.map(|p| p * 0.5 + scale.origin);
    near(&drawing(&line(&corners, ""), &scale).expect("resolved").vertices, &moved);
}

#[test]
fn other_strokes_join_known_points() {
    let [o, x, z] = [DVec3::ZERO, dvec3(7., 0., 0.), dvec3(0., 0., 4.)];
    let body = line(&[x, z], "") + &line(&[o, x], "");
    let error = drawing(&body, &TRUE).expect_err("z is not known").to_string();
    assert!(error.contains("no known point at"), "{error}");
    assert!(error.contains("runs at 128.9°, not along -x at 150°"), "{error}");
    let body = line(&[o, x], "") + &line(&[x, z], r#"id="slope""#) + &line(&[o, z], "");
    let found = drawing(&body, &TRUE).expect("resolved");
    near(&found.vertices, &[o, x, z]);
    assert_eq!(found.lines[1].name.as_deref(), Some("slope"));
    near(&found.lines[1].points, &[x, z]);
}

#[test]
fn dashed_lines_lead_to_marked_points() {
    let [o, x, p] = [DVec3::ZERO, dvec3(7., 0., 0.), dvec3(7., 0., 4.)];
    let dashed = line(&[o, x, p, p], r#"stroke-dasharray="2 1""#);
    let found = drawing(&(dashed + &line(&[p, dvec3(7., 9., 4.)], "")), &TRUE).expect("resolved");
    near(&found.vertices, &[p, dvec3(7., 9., 4.)]);
    assert!(!found.lines[0].is_edge && found.lines[1].is_edge);
    near(&found.lines[0].marks, &[p]);
}

#[test]
fn of_points_with_one_image_the_nearest_counts_or_the_marked_one() {
    let (far, close) = (dvec3(0., 1., 0.), dvec3(1., 0., 1.));
    let both = |attributes: &str| {
        line(&[DVec3::ZERO, dvec3(1., 0., 0.), close], attributes) + &line(&[DVec3::ZERO, far], "")
    };
    let up = line(&[far, far + DVec3::Z * 5.0], "");
    let found = drawing(&(both("") + &up), &TRUE).expect("resolved");
    near(&found.lines[2].points, &[close, close + DVec3::Z * 5.0]);
    assert_eq!(found.notes.len(), 1, "{:?}", found.notes);
    let marked = line(&[DVec3::ZERO, far, far], "");
    let found = drawing(&(both("") + &marked + &up), &TRUE).expect("resolved");
    near(&found.lines[3].points, &[far, far + DVec3::Z * 5.0]);
}

#[test]
fn a_cube_is_read_though_two_corners_coincide() {
    let corner = |i: u32| dvec3(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 10.0;
    let mut body = String::new();
    for [a, b] in [[0, 1], [0, 2], [0, 4], [1, 3], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5]] {
        body += &line(&[corner(a), corner(b)], "");
    }
    for [a, b] in [[4, 6], [5, 7], [6, 7]] {
        body += &line(&[corner(a), corner(b)], "");
    }
    let found = drawing(&body, &TRUE).expect("resolved");
    assert_eq!(found.vertices.len(), 8, "{:?}", found.vertices);
}

#[test]
fn lines_that_join_do_so_whatever_their_direction() {
    let [o, ridge, eave] = [DVec3::ZERO, dvec3(0., 3., 3.), dvec3(0., 6., 0.)];
    let known = line(&[o, eave], "") + &line(&[o, dvec3(0., 3., 0.), ridge], "");
    let rafter = known.clone() + &line(&[ridge, eave], "");
    assert_eq!(drawing(&rafter, &TRUE).expect("resolved").vertices.len(), 5);
    let joined = known + &line(&[ridge, eave], r#"class="thick join""#);
    let found = drawing(&joined, &TRUE).expect("resolved");
    near(&found.lines[2].points, &[ridge, eave]);
    assert_eq!(found.vertices.len(), 4);
}

#[test]
fn strokes_about_along_an_axis_count_where_they_join_nothing() {
    let [o, up, aside] = [DVec3::ZERO, dvec3(0., 0., 50.), dvec3(0.2, 0., 50.)];
    let found = drawing(&line(&[o, aside, aside + DVec3::Y * 3.0], ""), &TRUE).expect("resolved");
    assert!(found.vertices[1].distance(up) < 0.2 && found.vertices[1].y == 0.0);
    assert_eq!(found.vertices[1].x, 0.0);
    let body = line(&[o, up, aside], "") + &line(&[o, aside], "");
    let found = drawing(&body, &TRUE).expect("resolved");
    near(&found.lines[1].points, &[o, aside]);
}

#[test]
fn transforms_and_sizes_are_followed() {
    let path = r#"<path d="M 0 0 v -10"/>"#;
    let turned = format!(r#"<g transform="translate(5 5) scale(2) rotate(60)">{path}</g>"#);
    let found = drawing(&turned, &TRUE).expect("resolved");
    near(&found.vertices, &[DVec3::ZERO, dvec3(0., 20., 0.)]);
    let svg = format!(r#"<svg width="10cm" height="10cm" viewBox="0 0 50 50">{path}</svg>"#);
    let found = read("a.svg", svg.as_bytes(), &IsoScale::default()).expect("resolved");
    near(&found.vertices, &[DVec3::ZERO, dvec3(0., 0., 20.0 / SHRINK)]);
}

#[test]
fn lengths_snap_to_a_pitch() {
    let scale = IsoScale { snap: Some(5.0), ..TRUE };
    let found = drawing(r#"<path d="M 0 0 v -10.2 v -2.4"/>"#, &scale).expect("resolved");
    near(&found.vertices, &[DVec3::ZERO, dvec3(0., 0., 10.), dvec3(0., 0., 12.4)]);
}

#[test]
fn what_is_no_drawing_is_refused() {
    let curved = drawing(r#"<path d="M 0 0 C 1 1 2 2 3 0"/>"#, &TRUE).expect_err("curved");
    assert!(curved.to_string().contains("control polygon"), "{curved}");
    assert!(drawing("", &TRUE).expect_err("empty").to_string().contains("no lines"));
    let grid = r#"<g class="grid"><path d="M 0 0 v 5"/></g>"#;
    assert!(drawing(grid, &TRUE).is_err());
    assert!(read("a.svg", b"<svg><path d='M 0 0", &TRUE).is_err());
    assert!(read("a.dxf", b"", &TRUE).is_err());
    let deep = "<g>".repeat(50_000) + &"</g>".repeat(50_000);
    assert!(drawing(&deep, &TRUE).is_err());
    let many = "<path d='M 0 0 v 1'/>".repeat(3000);
    assert!(matches!(drawing(&many, &TRUE), Err(ReadError::Limit { .. })));
}
