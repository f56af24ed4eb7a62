//! Two hundred random scenes of all kinds of solids against sight lines that are marched through distance functions: nothing
//! of the drawing's own code, meshes included, is used. Eyes are far away, near, and among the solids.

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot, Vec2Swizzles, dvec2, dvec3};
use katachi::{
    geom::{Placement, Tolerance, sides},
    kernel::brep::{
        Polyhedron,
        primitive::{cone, cuboid, sphere, torus},
    },
    output::drawing::{Camera, Class, Drawing, Options, Scene, visible_lines},
};
use rayon::prelude::*;

use super::overdraw::overdraw;
use crate::random::Random;

/// How far beside a line is looked, mm.
const BESIDE: f64 = 2e-3;
/// Two things part where points seen beside each other are farther apart than this along a normal, mm.
const JUMP: f64 = 0.02;
/// Edges are where normals turn by more than this, its cosine.
const EDGE: f64 = 0.98;
/// How near to a line two things part, mm.
const BOUND: f64 = 5e-3;
/// A sight line meets what it comes so near to, mm.
const MET: f64 = 1e-7;
/// Pieces are looked at once for each of these lengths, mm, and four times at most.
const SHORT: f64 = 0.5;
const STEPS: usize = 60_000;
const FAR: f64 = 1000.0;

#[derive(Clone, Copy, Debug)]
enum Shape {
    Cuboid(DVec3),
    Ball(f64),
    /// Radii below and above, height; centred.
    Cone(f64, f64, f64),
    Ring(f64, f64),
}

#[derive(Clone, Copy, Debug)]
struct Solid {
    shape: Shape,
    turn: DMat3,
    at: DVec3,
}

impl Shape {
    fn random(random: &mut Random, kind: u64) -> Shape {
        let [a, b, c] = [0; 3].map(|_| 2.0 + 7.0 * random.next());
        match kind % 5 {
            0 => Shape::Cuboid(dvec3(a, b, c)),
            1 => Shape::Ball(a),
            2 => Shape::Cone(a, a, 2.0 * b),
            3 => Shape::Cone(a, if random.next() < 0.5 { 0.0 } else { b / 2.0 }, 2.0 * c),
            _ => Shape::Ring(a + 3.0, 0.3 * a),
        }
    }

    /// The radius of a ball around it.
    fn reach(&self) -> f64 {
        match *self {
            Shape::Cuboid(half) => half.length(),
            Shape::Ball(r) => r,
            Shape::Cone(a, b, h) => libm::hypot(a.max(b), h / 2.0),
            Shape::Ring(major, minor) => major + minor,
        }
    }

    fn made(&self, tolerance: Tolerance) -> Polyhedron {
        match *self {
            Shape::Cuboid(half) => cuboid(-half, half),
            Shape::Ball(r) => sphere(r, sides::sphere(r, tolerance)),
            Shape::Cone(a, b, h) => cone(a, b, h, sides::circle(a.max(b), tolerance))
                .placed(&Placement::translation(DVec3::NEG_Z * (h / 2.0))),
            Shape::Ring(major, minor) => {
                let (around, tube) = sides::torus(major, minor, tolerance);
                torus(major, minor, around, tube)
            }
        }
    }

    /// The distance of a point, negative inside (I. Quilez, distance functions).
    fn distance(&self, p: DVec3) -> f64 {
        let flat = dvec2(p.truncate().length(), p.z);
        match *self {
            Shape::Cuboid(half) => {
                let q = p.abs() - half;
                q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
            }
            Shape::Ball(r) => p.length() - r,
            Shape::Ring(major, minor) => (flat - dvec2(major, 0.0)).length() - minor,
            Shape::Cone(a, b, h) => {
                let (top, side) = (dvec2(b, h / 2.0), dvec2(b - a, h));
                let rim = if flat.y < 0.0 { a } else { b };
                let to_cap = dvec2(flat.x - flat.x.min(rim), flat.y.abs() - h / 2.0);
                let t = ((top - flat).dot(side) / side.length_squared()).clamp(0.0, 1.0);
                let to_side = flat - top + side * t;
                let inside = to_side.x < 0.0 && to_cap.y < 0.0;
                let distance = to_cap.length_squared().min(to_side.length_squared()).sqrt();
                if inside { -distance } else { distance }
            }
        }
    }
}

impl Solid {
    fn distance(&self, p: DVec3) -> f64 {
        self.shape.distance(self.turn.transpose() * (p - self.at))
    }

    fn normal(&self, p: DVec3) -> DVec3 {
        let small = 1e-6;
        let slope = |d: DVec3| self.distance(p + d * small) - self.distance(p - d * small);
        DVec3::from_array(DVec3::AXES.map(slope)).normalize_or_zero()
    }
}

/// Solids with a gap between the balls around them, and around an eye.
fn apart(random: &mut Random, scene: u64, eye: Option<DVec3>) -> Vec<Solid> {
    let mut solids: Vec<Solid> = vec![];
    for i in 0..14 {
        let shape = Shape::random(random, scene + i);
        let mut vector = || DVec3::from_array([0; 3].map(|_| 2.0 * random.next() - 1.0));
        let ([x, y, z], at) = ((vector() * 3.0).to_array(), vector() * 30.0);
        let turn = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, x, y, z));
        let clear = |s: &Solid| s.at.distance(at) > s.shape.reach() + shape.reach();
        let before = eye.is_none_or(|e| e.distance(at) > shape.reach() + 0.5);
        if before && solids.iter().all(clear) {
            solids.push(Solid { shape, turn, at });
        }
    }
    solids
}

/// The camera of a scene, and its eye.
fn camera(random: &mut Random, scene: u64) -> Camera {
    let mut vector = || DVec3::from_array([0; 3].map(|_| 2.0 * random.next() - 1.0));
    let direction = vector().normalize();
    let aim = vector() * 10.0;
    match scene % 4 {
        0 => Camera::parallel(direction).expect("a direction"),
        1 => Camera::perspective(direction * 120.0, aim).expect("apart"),
        2 => Camera::perspective(direction * 45.0, aim)
            .and_then(|c| c.with_field_of_view(90.0, 1.0))
            .expect("apart"),
        _ => Camera::perspective(aim, aim + direction * 25.0)
            .and_then(|c| c.with_field_of_view(90.0, 1.0))
            .expect("apart"),
    }
}

/// What a sight line meets first: the solid, the point and the normal there.
fn first(solids: &[Solid], camera: &Camera, at: DVec2) -> Option<(usize, DVec3, DVec3)> {
    let (on, away) = camera.ray(at);
    let unit = away.normalize();
    let from = camera.eye().unwrap_or(on - unit * FAR / 2.0);
    let mut far = 0.0;
    for _ in 0..STEPS {
        let p = from + unit * far;
        let distances = solids.iter().map(|s| s.distance(p)).enumerate();
        let (i, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1))?;
        if distance < MET {
            return Some((i, p, solids[i].normal(p)));
        }
        far += distance;
        if far > FAR {
            return None;
        }
    }
    None
}

/// Whether two sight lines beside each other meet two things.
fn differ(solids: &[Solid], camera: &Camera, [a, b]: [DVec2; 2]) -> bool {
    match [a, b].map(|at| first(solids, camera, at)) {
        [Some((i, p, m)), Some((k, q, n))] => {
            let jump = m.dot(q - p).abs().min(n.dot(p - q).abs());
            i != k || m.dot(n) < EDGE || jump > JUMP
        }
        [a, b] => a.is_some() != b.is_some(),
    }
}

/// Points of drawn lines that are drawn wrong, of so many: visible ones part what is seen, hidden ones do not.
fn drawn_wrong(solids: &[Solid], camera: &Camera, drawing: &Drawing) -> [usize; 2] {
    let (mut wrong, mut all) = (0, 0);
    for line in &drawing.lines {
        for (start, segment) in line.path.pieces() {
            // Pieces so short that a hair beside them is beyond their ends say nothing.
            for i in 0..(segment.length(start) / SHORT).min(4.0) as i32 {
                let t = 0.11 + 0.25 * f64::from(i);
                let [p, q] = [t, t + 1e-5].map(|t| segment.at(start, t));
                let across = (q - p).yx() * dvec2(-1.0, 1.0);
                let across = across.normalize_or_zero() * BESIDE;
                let parted = differ(solids, camera, [p + across, p - across]);
                all += 1;
                wrong += usize::from(parted != (line.class == Class::Visible));
            }
        }
    }
    [wrong, all]
}

/// Places where two solids part and nothing is drawn, of so many.
fn undrawn(
    solids: &[Solid],
    camera: &Camera,
    drawing: &Drawing,
    random: &mut Random,
) -> [usize; 2] {
    let Some((min, max)) = drawing.bounds() else { return [0; 2] };
    let seen = drawing.lines.iter().filter(|l| l.class == Class::Visible);
    let chords: Vec<[DVec2; 2]> = seen
        .flat_map(|l| l.path.pieces())
        .flat_map(|(start, segment)| {
            let at = move |i: i32| segment.at(start, f64::from(i) / 512.0);
            (0..512).map(move |i| [at(i), at(i + 1)])
        })
        .collect();
    let of = |at: DVec2| first(solids, camera, at).map(|hit| hit.0);
    let (mut wrong, mut all) = (0, 0);
    for _ in 0..40 {
        let mut place = || min + (max - min) * dvec2(random.next(), random.next());
        let (mut p, mut q) = (place(), place());
        let (a, b) = (of(p), of(q));
        if a == b {
            continue;
        }
        while p.distance(q) > 1e-5 {
            let middle = p.midpoint(q);
            if of(middle) == a { p = middle } else { q = middle }
        }
        let distance = |[a, b]: &[DVec2; 2]| {
            let t = (p - *a).dot(*b - *a) / (*b - *a).length_squared().max(f64::MIN_POSITIVE);
            a.lerp(*b, t.clamp(0.0, 1.0)).distance(p)
        };
        all += 1;
        wrong += usize::from(chords.iter().map(distance).fold(f64::INFINITY, f64::min) > BOUND);
    }
    [wrong, all]
}

/// What is wrong with the drawing of a scene.
fn faults(scene: u64) -> Option<String> {
    let mut random = Random(5000 + scene);
    let camera = camera(&mut random, scene);
    let solids = apart(&mut random, scene, camera.eye());
    let tolerance = Tolerance::new(0.01).expect("positive");
    let made: Vec<Polyhedron> = solids
        .iter()
        .map(|s| s.shape.made(tolerance).placed(&Placement::new(s.turn, s.at)))
        .collect();
    let options = Options { tolerance, ..Options::default() };
    let drawing = visible_lines(&Scene::of(made.iter().map(Polyhedron::mesh)), &camera, &options);
    let [wrong, all] = drawn_wrong(&solids, &camera, &drawing);
    let [missing, looked] = undrawn(&solids, &camera, &drawing, &mut random);
    let twice = [Class::Visible, Class::Hidden].map(|class| {
        let lines = drawing.lines.iter().filter(|l| l.class == class);
        let chords = lines.map(|l| {
            let pieces = l.path.pieces().flat_map(|(start, segment)| {
                let count = (segment.length(start) / 0.1).ceil().clamp(8.0, 400.0) as i32;
                (0..=count).map(move |i| segment.at(start, f64::from(i) / f64::from(count)))
            });
            pieces.collect::<Vec<DVec2>>()
        });
        let (twice, _, all) = overdraw(&chords.collect::<Vec<_>>());
        twice / all.max(1.0)
    });
    // Points so near to a corner or a crossing that a hair decides.
    let many = wrong * 50 > all || missing * 10 > looked || twice.iter().any(|t| *t > 0.005);
    many.then(|| {
        format!("{scene}: {wrong} of {all} wrong, {missing} of {looked} missing, twice {twice:?}")
    })
}

#[test]
fn random_solids_are_drawn_as_they_are_seen() {
    let found: Vec<String> = (0..200u64).into_par_iter().filter_map(faults).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
