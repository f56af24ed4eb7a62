//! Drawings of the examples against sight lines through their meshes: what is drawn parts two things that are seen, and
//! where two things part a line is drawn, and no line lies on another. Nothing of the drawing's own code is used: lines come from the SVG file, meshes
//! from the STL file.

use std::{fs, path::Path};

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use rayon::prelude::*;
use usvg::tiny_skia_path::PathSegment;

use super::overdraw::{distance, overdraw};
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
/// Jumps of depth that part two things, mm; a line may stand for smaller ones, down to chord errors.
const JUMP: f64 = 0.02;
const STEP: f64 = 0.004;
/// What is shorter than the digits of the file, mm.
const DOT: f64 = 2e-4;
/// Facets of one surface meet at a smaller angle than this (its cosine) at that chord error; edges are above the other.
const SMOOTH: f64 = 0.82;
const FLAT: f64 = 0.999_99;
/// Share of the samples that may fail: those beside a corner or a part thinner than what is looked at.
const SHARE: f64 = 0.01;

/// Share of the length that may be drawn twice, where lines touch: the overdraw ratio is 1.00.
const OVERDRAWN: f64 = 0.005;
/// The same for visible and hidden lines together: different lines may come that near to each other by chance.
const OVERDRAWN_IN_ALL: f64 = 0.01;

/// Where the examples are looked at from.
#[derive(Clone, Copy, Debug)]
enum View {
    Iso,
    Top,
    Front,
    /// From nearby, with an eye that stands this far from the middle of what is seen, in its sizes.
    Near(DVec3),
}

const VIEWS: [View; 4] = [View::Iso, View::Top, View::Front, View::Near(dvec3(0.7, -1.6, 1.1))];

/// An eye.
struct Eye {
    /// To the right, up and towards the eye.
    axes: DMat3,
    target: DVec3,
    /// From the target to an eye that is not far away.
    distance: Option<f64>,
}

/// A triangle in the picture and in space.
struct Triangle {
    corners: [DVec2; 3],
    on: DVec3,
    normal: DVec3,
}

/// What a sight line meets first.
#[derive(Clone, Copy)]
struct Hit {
    at: DVec3,
    normal: DVec3,
    far: f64,
}

struct Sights {
    eye: Eye,
    triangles: Vec<Triangle>,
    bins: Vec<Vec<u32>>,
    min: DVec2,
    max: DVec2,
    cell: f64,
    columns: usize,
}

impl Eye {
    /// The eye of a view of something between two corners.
    fn new(view: View, min: DVec3, max: DVec3) -> Eye {
        let (toward, up) = match view {
            View::Iso => (dvec3(1.0, -1.0, 1.0), DVec3::Z),
            View::Top => (DVec3::Z, DVec3::Y),
            View::Front => (DVec3::NEG_Y, DVec3::Z),
            View::Near(v) => (v * (max - min).max_element(), DVec3::Z),
        };
        let right = up.cross(toward).normalize();
        let axes = DMat3::from_cols(right, toward.cross(right).normalize(), toward.normalize());
        let distance = matches!(view, View::Near(_)).then(|| toward.length());
        let target = if distance.is_some() { min.midpoint(max) } else { DVec3::ZERO };
        Eye { axes, target, distance }
    }

    /// The picture of a point.
    fn image(&self, p: DVec3) -> DVec2 {
        let v = self.axes.transpose() * (p - self.target);
        v.truncate() * self.distance.map_or(1.0, |far| far / (far - v.z))
    }

    /// The point of the picture plane and the unit direction of the sight line through it.
    fn ray(&self, p: DVec2) -> (DVec3, DVec3) {
        let on = self.target + self.axes * p.extend(0.0);
        let away = self
            .distance
            .map_or(-self.axes.z_axis, |far| on - self.target - self.axes.z_axis * far);
        (on, away.normalize())
    }

    /// How the command line is told.
    fn arguments(&self, view: View) -> Vec<String> {
        let numbers = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let [eye, target] =
            [self.target + self.axes.z_axis * self.distance.unwrap_or(0.0), self.target]
                .map(numbers);
        match view {
            View::Near(_) => vec![format!("--eye={eye}"), format!("--target={target}")],
            side => vec!["--from".into(), format!("{side:?}").to_uppercase()],
        }
    }
}

/// The triangles of a binary STL file.
fn triangles(stl: &[u8]) -> Vec<[DVec3; 3]> {
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes(bytes.try_into().expect("four")));
    let corner = |record: &[u8], i: usize| {
        let at = |k: usize| number(&record[12 + 12 * i + 4 * k..16 + 12 * i + 4 * k]);
        dvec3(at(0), at(1), at(2))
    };
    stl[84..].chunks_exact(50).map(|r| [0, 1, 2].map(|i| corner(r, i))).collect()
}

impl Sights {
    fn new(triangles: &[[DVec3; 3]], view: View) -> Sights {
        let space = || triangles.iter().flatten();
        let low = space().fold(DVec3::MAX, |min, p| min.min(*p));
        let high = space().fold(DVec3::MIN, |max, p| max.max(*p));
        let eye = Eye::new(view, low, high);
        let image = |&[a, b, c]: &[DVec3; 3]| Triangle {
            corners: [a, b, c].map(|p| eye.image(p)),
            on: a,
            normal: (b - a).cross(c - a).normalize_or_zero(),
        };
        let triangles: Vec<Triangle> = triangles.iter().map(image).collect();
        let corners = || triangles.iter().flat_map(|t| t.corners);
        let (min, max) = corners()
            .fold((DVec2::MAX, DVec2::MIN), |(min, max), p: DVec2| (min.min(p), max.max(p)));
        let (cell, columns) = ((max - min).max_element() / 128.0, 130);
        let bins = vec![vec![]; columns * columns];
        let mut sights = Sights { eye, triangles, bins, min, max, cell, columns };
        for i in 0..sights.triangles.len() {
            let corners = sights.triangles[i].corners;
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
        let ([column, row], (from, away)) = (self.bin(p), self.eye.ray(p));
        let hits = self.bins[row * self.columns + column].iter().filter_map(|&i| {
            let Triangle { corners: [a, b, c], on, normal } = self.triangles[i as usize];
            let turn = |u: DVec2, v: DVec2| (v - u).perp_dot(p - u);
            let inside = turn(a, b) >= 0.0 && turn(b, c) >= 0.0 && turn(c, a) >= 0.0;
            let slope = normal.dot(away);
            (inside && slope < -1e-9).then(|| {
                let far = normal.dot(on - from) / slope;
                Hit { at: from + away * far, normal, far }
            })
        });
        hits.min_by(|a, b| a.far.total_cmp(&b.far))
    }
}

/// Whether two sight lines that are near to each other meet two things, edges being where normals differ by more than an
/// angle given by its cosine.
fn differ(one: Option<Hit>, other: Option<Hit>, cosine: f64, jump: f64) -> bool {
    let (Some(a), Some(b)) = (one, other) else { return one.is_some() != other.is_some() };
    let off = |a: Hit, b: Hit| a.normal.dot(b.at - a.at).abs();
    a.normal.dot(b.normal) < cosine || off(a, b).min(off(b, a)) > jump
}

/// The lines of a class in an SVG file as chains of short chords, y down.
fn lines(svg: &str, class: &str) -> Vec<Vec<DVec2>> {
    let Some(from) = svg.find(&format!("<g class=\"{class}\"")) else { return vec![] };
    let group = &svg[from..from + svg[from..].find("</g>").expect("an end") + 4];
    let group = group.replace("inkscape:", "data-");
    let text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\" height=\"1000\">{group}</svg>"
    );
    let tree = usvg::Tree::from_str(&text, &usvg::Options::default()).expect("SVG");
    let mut lines = vec![];
    collect(tree.root(), &mut lines);
    lines
}

/// Moves lines to where they are in the picture: they reach as far as what is seen.
fn place(lines: &mut [Vec<DVec2>], sights: &Sights) {
    lines.iter_mut().flatten().for_each(|p| p.y = -p.y);
    let corners = || lines.iter().flatten();
    let min = corners().fold(DVec2::MAX, |min, p| min.min(*p));
    let max = corners().fold(DVec2::MIN, |max, p| max.max(*p));
    let shift = sights.min.midpoint(sights.max) - min.midpoint(max);
    lines.iter_mut().flatten().for_each(|p| *p += shift);
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
        let mut add = |step: f64, curve: &dyn Fn(f64) -> DVec2| {
            let parts = (before.distance(curve(1.0)) / step).ceil().clamp(8.0, 4000.0) as u32;
            let line = lines.last_mut().expect("a path begins with a move");
            line.extend((1..=parts).map(|i| curve(f64::from(i) / f64::from(parts))));
        };
        match segment {
            PathSegment::MoveTo(p) => lines.push(vec![point(p)]),
            PathSegment::LineTo(p) => add(0.2, &|t| before.lerp(point(p), t)),
            PathSegment::CubicTo(a, b, c) => {
                let [a, b, c] = [a, b, c].map(point);
                add(0.05, &|t| {
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

/// The share of drawn points that part nothing, and one of them; dots part nothing.
fn drawn_unseen(sights: &Sights, lines: &[Vec<DVec2>]) -> (f64, DVec2) {
    let (mut all, mut bad, mut place) = (0.0, 0.0, DVec2::ZERO);
    let length = |line: &[DVec2]| line.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
    for dot in lines.iter().filter(|line| length(line) < DOT) {
        (all, bad, place) = (all + 1.0, bad + 1.0, dot[0]);
    }
    let chords = lines.iter().flat_map(|line| line.windows(2));
    for pair in chords.filter(|pair| pair[0].distance(pair[1]) >= DOT / 16.0).step_by(3) {
        let (middle, along) = ((pair[0] + pair[1]) / 2.0, pair[1] - pair[0]);
        let aside = along.perp().normalize_or_zero() * BESIDE;
        all += 1.0;
        if !differ(sights.first(middle + aside), sights.first(middle - aside), FLAT, STEP) {
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
    let apart = |p, q| differ(sights.first(p), sights.first(q), SMOOTH, JUMP);
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
    pairs.map(|pair| distance(at, [pair[0], pair[1]])).fold(f64::INFINITY, f64::min)
}

/// What is wrong with the drawing of a part.
fn faults(root: &Path, model: &str, part: &Path, view: View) -> Vec<String> {
    let name = part.file_stem().expect("named").to_str().expect("plain");
    let sights = Sights::new(&triangles(&fs::read(part).expect("written")), view);
    let svg = part.with_file_name(format!("{name} {}.svg", view_name(view)));
    let (path, tolerance) = (svg.to_str().expect("plain"), TOLERANCE.to_string());
    let from = sights.eye.arguments(view);
    let mut arguments =
        vec!["view", model, "-p", name, "--tolerance", &tolerance, "-o", path, "--hidden=dashed"];
    arguments.extend(from.iter().map(String::as_str));
    let output = run(root, &arguments);
    if !output.status.success() {
        return vec![format!("{model}: {}", String::from_utf8_lossy(&output.stderr))];
    }
    let text = fs::read_to_string(&svg).expect("written");
    let mut lines = lines(&text, "visible");
    let both = [&lines[..], &self::lines(&text, "hidden")].concat();
    place(&mut lines, &sights);
    let mut faults = vec![];
    for (what, lines, most) in [("visible", &lines, OVERDRAWN), ("all", &both, OVERDRAWN_IN_ALL)] {
        let (twice, at, all) = overdraw(lines);
        let ratio = all / (all - twice).max(1e-9);
        if ratio > 1.0 + most {
            faults.push(format!(
                "{model}: {name} {view:?}: {what} lines overlap {ratio:.4}, at {at}"
            ));
        }
    }
    for (what, (share, at)) in [
        ("drawn and not seen", drawn_unseen(&sights, &lines)),
        ("seen and not drawn", seen_undrawn(&sights, &lines)),
    ] {
        if share > SHARE {
            let share = share * 100.0;
            faults.push(format!("{model}: {name} {view:?}: {share:.2} % is {what}, at {at}"));
        }
    }
    faults
}

fn view_name(view: View) -> &'static str {
    match view {
        View::Iso => "iso",
        View::Top => "top",
        View::Front => "front",
        View::Near(_) => "near",
    }
}

/// What is wrong with the drawings of an example.
fn faults_of_model(root: &Path, name: &str) -> Vec<String> {
    let model = folder().join(name);
    let model = model.to_str().expect("plain");
    let out = tempfile::tempdir().expect("a temporary folder");
    let (target, tolerance) = (out.path().to_str().expect("plain"), TOLERANCE.to_string());
    run(root, &["build", model, "--format", "stl", "--tolerance", &tolerance, "-o", target]);
    let entries = fs::read_dir(out.path()).expect("readable");
    let mut parts: Vec<_> = entries.map(|e| e.expect("readable").path()).collect();
    parts.retain(|path| path.extension().is_some_and(|e| e == "stl"));
    parts.sort();
    let views = parts.iter().flat_map(|part| VIEWS.map(|view| (part, view)));
    views.flat_map(|(part, view)| faults(root, model, part, view)).collect()
}

#[test]
fn examples_are_drawn_as_they_are_seen() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found: Vec<Vec<String>> =
        models().par_iter().map(|name| faults_of_model(root, name)).collect();
    let found = found.concat();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
