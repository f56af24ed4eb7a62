//! Wireframes drawn in ISO and read back.

use std::fmt::Write;

use glam::{DVec3, dvec3};
use katachi::{
    geom::{
        View,
        isometric::{IsoDrawing, IsoScale},
        wireframe::faces,
    },
    input::read_isometric,
    kernel::brep::{faces::polyhedron, measure::volume},
    output::drawing::Camera,
};

use crate::random::Random;

/// What a pen draws: full lines, and dashed ones whose end is marked.
#[derive(Default)]
struct Pen {
    lines: Vec<(Vec<DVec3>, bool)>,
}

impl Pen {
    fn draw(&mut self, points: &[DVec3]) {
        self.lines.push((points.to_vec(), false));
    }

    fn lead(&mut self, from: DVec3, to: DVec3) {
        let x = dvec3(to.x, from.y, from.z);
        self.lines.push((vec![from, x, dvec3(to.x, to.y, from.z), to], true));
    }

    /// A ring, and the same ring again at a distance.
    fn prism(&mut self, ring: &[DVec3], up: DVec3) {
        let closed: Vec<DVec3> = ring.iter().chain(&ring[..1]).copied().collect();
        self.draw(&closed);
        ring.iter().for_each(|p| self.draw(&[*p, *p + up]));
        let lifted: Vec<DVec3> = closed.iter().map(|p| *p + up).collect();
        self.draw(&lifted);
    }

    /// The points that a reader should register.
    fn vertices(&self) -> Vec<DVec3> {
        let mut vertices: Vec<DVec3> = vec![];
        for (line, dashed) in &self.lines {
            let skipped = if *dashed { line.len() - 1 } else { 0 };
            for p in &line[skipped..] {
                if vertices.iter().all(|known| known.distance(*p) > 1e-9) {
                    vertices.push(*p);
                }
            }
        }
        vertices
    }

    /// An SVG file on paper of some size, in units of some millimetres, drawn in a group that is moved.
    fn svg(&self, mm: f64) -> String {
        let camera = Camera::view(View::Iso);
        let size = 400.0 / mm;
        let mut text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="400mm" height="40cm" viewBox="0 0 {size} {size}"><g transform="translate(150 170) scale({})" style="fill:none">"#,
            1.0 / mm
        );
        for (points, dashed) in &self.lines {
            let mut data = String::new();
            for p in points.iter().chain(points.last().filter(|_| *dashed)) {
                let at = camera.project(*p).expect("parallel");
                write!(data, "{}{} {}", if data.is_empty() { "M " } else { " L " }, at.x, -at.y)
                    .expect("text");
            }
            let dash = if *dashed { r#" style="stroke-dasharray:3,1""# } else { "" };
            write!(text, r#"<path d="{data}"{dash}/>"#).expect("text");
        }
        text + "</g></svg>"
    }
}

/// A wireframe of one of four kinds, and its volume if it encloses one.
fn wireframe(kind: usize, random: &mut Random) -> (Pen, Option<f64>) {
    let mut number = |low: f64, high: f64| low + random.next() * (high - low);
    let o = dvec3(number(-30., 30.), number(-30., 30.), number(-30., 30.));
    let (x, y, z) = (number(20., 60.), number(20., 60.), number(20., 60.));
    let (a, b, c) = (number(4., 16.), number(4., 16.), number(4., 16.));
    let at = |x: f64, y: f64, z: f64| o + dvec3(x, y, z);
    let base = [at(0., 0., 0.), at(x, 0., 0.), at(x, y, 0.), at(0., y, 0.)];
    let mut pen = Pen::default();
    match kind {
        0 => {
            let step = [at(x, y - b, 0.), at(x - a, y - b, 0.), at(x - a, y, 0.)];
            pen.prism(&[base[0], base[1], step[0], step[1], step[2], base[3]], DVec3::Z * z);
            (pen, Some(z * (x * y - a * b)))
        }
        1 => {
            // At 45 degrees the rafters would look like strokes along x.
            let c = a + c / 2.0;
            pen.prism(&base, DVec3::Z * z);
            let ridge = [at(0., y - a, z + c), at(x, y - a, z + c)];
            pen.lead(at(0., 0., z), ridge[0]);
            pen.draw(&ridge);
            pen.draw(&[at(0., 0., z), ridge[0], at(0., y, z)]);
            pen.draw(&[at(x, 0., z), ridge[1], at(x, y, z)]);
            (pen, Some(x * y * z + x * y * c / 2.0))
        }
        2 => {
            let k = number(0.3, 0.7);
            let top = base.map(|p| o + (p - o) * k + dvec3(a, b, z));
            pen.draw(&[base[0], base[1], base[2], base[3], base[0]]);
            pen.lead(base[0], top[0]);
            pen.draw(&[top[0], top[1], top[2], top[3], top[0]]);
            base.iter().zip(top).for_each(|(p, q)| pen.draw(&[*p, q]));
            (pen, Some(z * x * y * (1.0 + k + k * k) / 3.0))
        }
        _ => {
            let start = at(0., 0., 0.);
            let points: Vec<DVec3> =
                (0..6).map(|_| at(number(-x, x), number(-y, y), number(-z, z))).collect();
            pen.draw(&[start, start + DVec3::X * a]);
            points.iter().for_each(|p| pen.lead(start, *p));
            for (i, p) in points.iter().enumerate() {
                points[i + 1..].iter().for_each(|q| pen.draw(&[*p, *q]));
            }
            (pen, None)
        }
    }
}

fn edges(drawing: &IsoDrawing) -> Vec<[DVec3; 2]> {
    let full = drawing.lines.iter().filter(|line| line.is_edge);
    full.flat_map(|line| line.points.windows(2).map(|pair| [pair[0], pair[1]])).collect()
}

#[test]
fn random_wireframes_drawn_in_iso_are_read_back() {
    let mut random = Random(11);
    for i in 0..52 {
        let (pen, expected) = wireframe(i % 4, &mut random);
        let scale = IsoScale { origin: pen.lines[0].0[0], ..IsoScale::default() };
        let mm = 0.2 + random.next() * 3.0;
        let found = read_isometric("wires.svg", pen.svg(mm).as_bytes(), &scale);
        let found = found.unwrap_or_else(|error| panic!("{i}: {error}"));
        let vertices = pen.vertices();
        assert_eq!(found.vertices.len(), vertices.len(), "{i}");
        for (a, b) in found.vertices.iter().zip(&vertices) {
            assert!(a.distance(*b) < 1e-9, "{i}: {a} for {b}");
        }
        assert!(found.notes.is_empty(), "{i}: {:?}", found.notes);
        if let Some(expected) = expected {
            let closed = faces(&edges(&found)).unwrap_or_else(|error| panic!("{i}: {error}"));
            let solid = polyhedron(&closed.points, &closed.rings()).expect("closed");
            assert!((volume(&solid) - expected).abs() < 1e-9 * expected, "{i}");
        }
    }
}

#[test]
fn a_drawing_of_one_unit_for_another_scales() {
    let (pen, _) = wireframe(0, &mut Random(5));
    let scale = IsoScale { unit: Some(2.0), ..IsoScale::default() };
    let found = read_isometric("wires.svg", pen.svg(1.0).as_bytes(), &scale).expect("resolved");
    let shrink = katachi::geom::isometric::SHRINK;
    let first = pen.lines[0].0[0];
    for (a, b) in found.vertices.iter().zip(pen.vertices()) {
        assert!(a.distance((b - first) * 2.0 * shrink) < 1e-9);
    }
}
