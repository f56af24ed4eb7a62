//! Drawings of the examples against sight lines through their meshes: what is drawn parts two things that are seen, and
//! where two things part a line is drawn. Nothing of the drawing's own code is used: lines come from the SVG file, meshes
//! from the STL file.

use std::{fs, path::Path};

use glam::{DVec2, DVec3, dvec2, dvec3};
use usvg::tiny_skia_path::PathSegment;

use crate::{
    errors::run,
    examples::{folder, models},
};

/// Chord error of the meshes, mm.
const TOLERANCE: f64 = 0.01;
/// How far beside a line is looked, mm: beyond what chords may be off.
const BESIDE: f64 = 0.04;
/// How far a line may be from where two things part, mm.
const BOUND: f64 = 0.05;
/// Jumps of depth that part two things, mm.
const JUMP: f64 = 0.02;
/// Facets of one surface meet at a smaller angle than this (its cosine) at that chord error; edges are above the other.
const SMOOTH: f64 = 0.82;
const FLAT: f64 = 0.999_99;
/// Share of the samples that may fail: those beside a corner or a part thinner than what is looked at.
const SHARE: f64 = 0.01;

/// Examples that the check finds fault with, one or two percent of their lines.
const WRONG: [&str; 2] = ["hinge.kata", "name_plate.kata"];

/// A triangle in the picture: x to the right, y up, z towards the eye.
struct Triangle {
    corners: [DVec3; 3],
    normal: DVec3,
}

/// What a sight line meets first.
#[derive(Clone, Copy)]
struct Hit {
    at: DVec3,
    normal: DVec3,
}

struct Sights {
    triangles: Vec<Triangle>,
    bins: Vec<Vec<u32>>,
    min: DVec2,
    max: DVec2,
    cell: f64,
    columns: usize,
}

/// A point seen from (1, -1, 1) with z up.
fn isometric(p: DVec3) -> DVec3 {
    let toward = dvec3(1.0, -1.0, 1.0).normalize();
    let right = dvec3(1.0, 1.0, 0.0).normalize();
    dvec3(right.dot(p), toward.cross(right).dot(p), toward.dot(p))
}

impl Sights {
    /// The triangles of a binary STL file.
    fn read(stl: &[u8]) -> Sights {
        let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().expect("four")));
        let triangle = |record: &[u8]| {
            let corner = |i: usize| {
                let at = |k: usize| number(&record[12 + 12 * i + 4 * k..16 + 12 * i + 4 * k]);
                isometric(dvec3(at(0), at(1), at(2)))
            };
            let corners = [corner(0), corner(1), corner(2)];
            let [a, b, c] = corners;
            Triangle { corners, normal: (b - a).cross(c - a).normalize_or_zero() }
        };
        Sights::new(stl[84..].chunks_exact(50).map(triangle).collect())
    }

    fn new(triangles: Vec<Triangle>) -> Sights {
        let corners = || triangles.iter().flat_map(|t| t.corners).map(DVec3::truncate);
        let (min, max) = corners()
            .fold((DVec2::MAX, DVec2::MIN), |(min, max), p: DVec2| (min.min(p), max.max(p)));
        let cell = (max - min).max_element() / 128.0;
        let columns = 130;
        let mut sights =
            Sights { triangles, bins: vec![vec![]; columns * columns], min, max, cell, columns };
        for i in 0..sights.triangles.len() {
            let corners = sights.triangles[i].corners.map(DVec3::truncate);
            let low = sights.bin(corners[0].min(corners[1]).min(corners[2]));
            let high = sights.bin(corners[0].max(corners[1]).max(corners[2]));
            for row in low[1]..=high[1] {
                for column in low[0]..=high[0] {
                    sights.bins[row * columns + column].push(i as u32);
                }
            }
        }
        sights
    }

    fn bin(&self, p: DVec2) -> [usize; 2] {
        let place = (p - self.min) / self.cell;
        [place.x, place.y].map(|x| (x.max(0.0) as usize).min(self.columns - 1))
    }

    fn first(&self, p: DVec2) -> Option<Hit> {
        let [column, row] = self.bin(p);
        let hits = self.bins[row * self.columns + column].iter().filter_map(|&i| {
            let Triangle { corners: [a, b, c], normal } = self.triangles[i as usize];
            let turn = |u: DVec3, v: DVec3| (v - u).truncate().perp_dot(p - u.truncate());
            let inside = turn(a, b) >= 0.0 && turn(b, c) >= 0.0 && turn(c, a) >= 0.0;
            (inside && normal.z > 1e-9).then(|| {
                let z = a.z - (normal.x * (p.x - a.x) + normal.y * (p.y - a.y)) / normal.z;
                Hit { at: p.extend(z), normal }
            })
        });
        hits.max_by(|a, b| a.at.z.total_cmp(&b.at.z))
    }
}

/// Whether two sight lines that are near to each other meet two things, edges being where normals differ by more than an
/// angle given by its cosine.
fn differ(one: Option<Hit>, other: Option<Hit>, cosine: f64) -> bool {
    let (Some(a), Some(b)) = (one, other) else { return one.is_some() != other.is_some() };
    let off = |a: Hit, b: Hit| a.normal.dot(b.at - a.at).abs();
    a.normal.dot(b.normal) < cosine || off(a, b).min(off(b, a)) > JUMP
}

/// The visible lines of an SVG file as chains of short chords, in the picture.
fn lines(svg: &str, sights: &Sights) -> Vec<Vec<DVec2>> {
    let Some(from) = svg.find("<g class=\"visible\"") else { return vec![] };
    let group = &svg[from..from + svg[from..].find("</g>").expect("an end") + 4];
    let group = group.replace("inkscape:", "data-");
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\" height=\"1000\">{group}</svg>"
    );
    let tree = usvg::Tree::from_str(&text, &usvg::Options::default()).expect("SVG");
    let mut lines = vec![];
    collect(tree.root(), &mut lines);
    let picture = |p: DVec2| dvec2(p.x - 5.0 + sights.min.x, sights.max.y + 5.0 - p.y);
    lines.into_iter().map(|line: Vec<DVec2>| line.into_iter().map(picture).collect()).collect()
}

fn collect(group: &usvg::Group, lines: &mut Vec<Vec<DVec2>>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => collect(group, lines),
            usvg::Node::Path(path) => chords(path.data().segments(), lines),
            _ => {}
        }
    }
}

fn chords(segments: impl Iterator<Item = PathSegment>, lines: &mut Vec<Vec<DVec2>>) {
    let point = |p: usvg::tiny_skia_path::Point| dvec2(f64::from(p.x), f64::from(p.y));
    for segment in segments {
        let before = lines.last().and_then(|line| line.last()).copied().unwrap_or_default();
        let mut add = |curve: &dyn Fn(f64) -> DVec2| {
            let parts = (before.distance(curve(1.0)) / 0.2).ceil().clamp(8.0, 4000.0) as u32;
            let line = lines.last_mut().expect("a path begins with a move");
            line.extend((1..=parts).map(|i| curve(f64::from(i) / f64::from(parts))));
        };
        match segment {
            PathSegment::MoveTo(p) => lines.push(vec![point(p)]),
            PathSegment::LineTo(p) => add(&|t| before.lerp(point(p), t)),
            PathSegment::CubicTo(a, b, c) => {
                let [a, b, c] = [a, b, c].map(point);
                add(&|t| {
                    let s = 1.0 - t;
                    before * (s * s * s)
                        + a * (3.0 * s * s * t)
                        + b * (3.0 * s * t * t)
                        + c * (t * t * t)
                });
            }
            PathSegment::Close => {
                let first = lines.last().map_or(before, |line| line[0]);
                lines.last_mut().expect("a path begins with a move").push(first);
            }
            PathSegment::QuadTo(..) => panic!("no such segment is written"),
        }
    }
}

/// The share of drawn points that part nothing, and one of them.
fn drawn_unseen(sights: &Sights, lines: &[Vec<DVec2>]) -> (f64, DVec2) {
    let (mut all, mut bad, mut place) = (0.0, 0.0, DVec2::ZERO);
    for pair in lines.iter().flat_map(|line| line.windows(2)).step_by(3) {
        let (middle, along) = ((pair[0] + pair[1]) / 2.0, pair[1] - pair[0]);
        let aside = along.perp().normalize_or_zero() * BESIDE;
        all += 1.0;
        if !differ(sights.first(middle + aside), sights.first(middle - aside), FLAT) {
            (bad, place) = (bad + 1.0, middle);
        }
    }
    (bad / f64::max(all, 1.0), place)
}

/// The share of places where two things part and nothing is drawn, and one of them.
fn seen_undrawn(sights: &Sights, lines: &[Vec<DVec2>]) -> (f64, DVec2) {
    let step = (sights.max - sights.min).max_element() / 90.0;
    let (mut all, mut bad, mut place) = (0.0, 0.0, DVec2::ZERO);
    for i in 0..92 {
        for j in 0..92 {
            let p = sights.min + step * (dvec2(f64::from(i), f64::from(j)) - 0.613);
            let Some(at) = parting(sights, p, p + step * dvec2(0.83, 0.55)) else { continue };
            all += 1.0;
            if off(lines, at) > BOUND {
                (bad, place) = (bad + 1.0, at);
            }
        }
    }
    (bad / f64::max(all, 1.0), place)
}

/// A place between two where what is seen changes.
fn parting(sights: &Sights, mut p: DVec2, mut q: DVec2) -> Option<DVec2> {
    let apart = |p, q| differ(sights.first(p), sights.first(q), SMOOTH);
    if !apart(p, q) {
        return None;
    }
    while p.distance(q) > 1e-3 {
        let middle = (p + q) / 2.0;
        if apart(p, middle) { q = middle } else { p = middle }
    }
    apart(p, q).then_some((p + q) / 2.0)
}

fn off(lines: &[Vec<DVec2>], at: DVec2) -> f64 {
    let pairs = lines.iter().flat_map(|line| line.windows(2));
    let distance = |pair: &[DVec2]| {
        let along = pair[1] - pair[0];
        let t = (at - pair[0]).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        at.distance(pair[0].lerp(pair[1], t.clamp(0.0, 1.0)))
    };
    pairs.map(distance).fold(f64::INFINITY, f64::min)
}

/// What is wrong with the drawing of a part.
fn faults(root: &Path, model: &str, part: &Path) -> Vec<String> {
    let name = part.file_stem().expect("named").to_str().expect("plain");
    let sights = Sights::read(&fs::read(part).expect("written"));
    let svg = part.with_extension("svg");
    let path = svg.to_str().expect("plain");
    let tolerance = TOLERANCE.to_string();
    let view = ["view", model, "-p", name, "--from", "ISO", "--tolerance", &tolerance, "-o", path];
    let output = run(root, &view);
    if !output.status.success() {
        return vec![format!("{model}: {}", String::from_utf8_lossy(&output.stderr))];
    }
    let lines = lines(&fs::read_to_string(&svg).expect("written"), &sights);
    let mut faults = vec![];
    for (what, (share, at)) in [
        ("drawn and not seen", drawn_unseen(&sights, &lines)),
        ("seen and not drawn", seen_undrawn(&sights, &lines)),
    ] {
        if share > SHARE {
            faults.push(format!("{model}: {name}: {:.2} % is {what}, at {at}", share * 100.0));
        }
    }
    faults
}

#[test]
fn examples_are_drawn_as_they_are_seen() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = vec![];
    for name in models().iter().filter(|name| !WRONG.contains(&name.as_str())) {
        let model = folder().join(name);
        let model = model.to_str().expect("plain");
        let out = tempfile::tempdir().expect("a temporary folder");
        let target = out.path().to_str().expect("plain");
        let tolerance = TOLERANCE.to_string();
        run(root, &["build", model, "--format", "stl", "--tolerance", &tolerance, "-o", target]);
        let mut parts: Vec<_> = fs::read_dir(out.path())
            .expect("readable")
            .map(|e| e.expect("readable").path())
            .collect();
        parts.retain(|path| path.extension().is_some_and(|e| e == "stl"));
        parts.sort();
        found.extend(parts.iter().flat_map(|part| faults(root, model, part)));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
