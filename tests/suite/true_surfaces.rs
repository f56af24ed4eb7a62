//! Facets of sweeps, lofts and patches against the surfaces they stand for, worked out here from the formulas in METHODS 4
//! and in the documentation, without the kernel: middles of facets and of their edges keep within the tolerance.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use katachi::{
    geom::{
        Contour, Curve, EdgeCurve, Piece, Placement, PolyMesh, Region, Surface, Tolerance,
        curve::Turn,
        sweep::{Frame, Repair, Stations},
    },
    kernel::brep::sweep::{Along, Between, Placed, along, between, coons, loft, surface},
};

use crate::random::Random;

/// A true surface over u and v from 0 to 1.
type Patch<'a> = Box<dyn Fn(f64, f64) -> DVec3 + 'a>;

fn tolerance(mm: f64) -> Tolerance {
    Tolerance::new(mm).expect("positive")
}

fn polygon(points: &[DVec2]) -> Region {
    let curves = vec![EdgeCurve::Line; points.len()];
    let outer = Contour { points: points.to_vec(), curves };
    Region { pieces: vec![Piece { outer, holes: vec![] }] }
}

/// Middles of curved facets and of their edges, every so many of them.
fn looked_at(mesh: &PolyMesh, most: usize) -> Vec<DVec3> {
    let curved: Vec<_> =
        mesh.faces().filter(|face| face.origin().surface != Surface::Plane).collect();
    let step = curved.len().div_ceil(most);
    let middles = |face: &katachi::geom::FaceRef| {
        let corners: Vec<DVec3> = face.outer().iter().map(|&c| mesh.points[c as usize]).collect();
        let next = corners.iter().cycle().skip(1);
        let edges: Vec<DVec3> = corners.iter().zip(next).map(|(a, b)| a.midpoint(*b)).collect();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        edges.into_iter().chain([middle])
    };
    curved.iter().step_by(step).flat_map(middles).collect()
}

/// The distance of a point from a patch: Gauss and Newton's method from some places.
fn off(patch: &Patch, p: DVec3, starts: &[DVec2]) -> f64 {
    const STEP: f64 = 1e-5;
    let from = |start: &DVec2| {
        let mut at = start.clamp(DVec2::ZERO, DVec2::ONE);
        let mut best = patch(at.x, at.y).distance(p);
        for _ in 0..12 {
            let slope = |d: DVec2| {
                let (low, high) = ((at - d).max(DVec2::ZERO), (at + d).min(DVec2::ONE));
                (patch(high.x, high.y) - patch(low.x, low.y)) / (high - low).element_sum()
            };
            let (u, v) = (slope(DVec2::X * STEP), slope(DVec2::Y * STEP));
            let away = p - patch(at.x, at.y);
            let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
            let det = uu * vv - uv * uv;
            if det <= 1e-12 * uu * vv {
                break;
            }
            let (du, dv) = (u.dot(away), v.dot(away));
            let step = dvec2(du * vv - dv * uv, dv * uu - du * uv) / det;
            at = (at + step).clamp(DVec2::ZERO, DVec2::ONE);
            best = best.min(patch(at.x, at.y).distance(p));
        }
        best
    };
    starts.iter().map(from).fold(f64::INFINITY, f64::min)
}

fn spread(nu: u32, nv: u32) -> Vec<DVec2> {
    let part = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..nu).flat_map(|i| (0..nv).map(move |j| dvec2(part(i, nu), part(j, nv)))).collect()
}

/// The largest distance of what is looked at from the nearest of some patches.
fn farthest(points: &[DVec3], patches: &[Patch], starts: impl Fn(DVec3) -> Vec<DVec2>) -> f64 {
    let distance = |p: &DVec3| {
        let starts = starts(*p);
        patches.iter().map(|patch| off(patch, *p, &starts)).fold(f64::INFINITY, f64::min)
    };
    points.iter().map(distance).fold(0.0, f64::max)
}

/// A profile upright on a helix, twisted and scaled.
struct Wound {
    r: f64,
    rise: f64,
    turns: f64,
    twist: f64,
    scale: f64,
}

impl Wound {
    fn path(&self) -> Curve {
        let (x, y, rise) = (DVec3::X * self.r, DVec3::Y * self.r, DVec3::Z * self.rise);
        let to = 360.0 * self.turns;
        Curve::turn(Turn { center: DVec3::ZERO, x, y, rise, from: 0.0, to })
    }

    /// A point of the profile at a part of the way: its y as near to +z as can be, turned by the twist.
    fn at(&self, p: DVec2, v: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(v * self.turns * TAU);
        let tangent = dvec3(-sin * self.r * TAU, cos * self.r * TAU, self.rise).normalize();
        let up = (DVec3::Z - tangent * tangent.z).normalize();
        let (s, c) = libm::sincos((self.twist * v).to_radians());
        let p = dvec2(p.x * c - p.y * s, p.x * s + p.y * c) * (1.0 + (self.scale - 1.0) * v);
        let on = dvec3(self.r * cos, self.r * sin, self.rise * self.turns * v);
        on + up.cross(tangent) * p.x + up * p.y
    }

    /// The largest distance of its facets from it, as a part of the tolerance.
    fn share(&self, profile: &[DVec2], mm: f64) -> f64 {
        let path = self.path();
        let Wound { twist, scale, .. } = *self;
        let way = Along { frame: Frame::Upright, twist, scale, ..Along::path(&path) };
        let solid = along(&polygon(profile), &way, tolerance(mm)).expect("a wound bar");
        let edge = |j: usize| -> Patch {
            let (a, b) = (profile[j], profile[(j + 1) % profile.len()]);
            Box::new(move |u, v| self.at(a.lerp(b, u), v))
        };
        let patches: Vec<Patch> = (0..profile.len()).map(edge).collect();
        let height = self.rise * self.turns;
        let starts = |p: DVec3| {
            // The turns whose height and angle are those of the point.
            let own = libm::atan2(p.y, p.x) / TAU;
            let near = (p.z / self.rise - own).round() + own;
            let parts = [-1.0, 0.0, 1.0].map(|k| (near + k) * self.rise / height);
            parts.into_iter().flat_map(|v| [0.2, 0.8].map(|u| dvec2(u, v))).collect()
        };
        farthest(&looked_at(solid.mesh(), 120), &patches, starts) / mm
    }
}

#[test]
fn sweeps_and_threads_keep_within_the_tolerance() {
    // The ridge of an M8 thread as the library winds it.
    let core: f64 = 4.0 - 0.541_266 * 1.25;
    let slope = libm::cos(libm::atan2(1.25, TAU * core));
    let at = |r: f64, z: f64| dvec2(core - r, z * 1.25 * slope);
    let foot = core - 0.15 * 1.25;
    let sides = [(foot, 0.375), (core, 0.375), (4.0, 0.0625)];
    let mut ridge: Vec<DVec2> = sides.iter().map(|(r, z)| at(*r, -z)).collect();
    ridge.extend(sides.iter().rev().map(|(r, z)| at(*r, *z)));
    ridge.reverse();
    let thread = Wound { r: core, rise: 1.25, turns: 4.0, twist: 0.0, scale: 1.0 };
    for mm in [0.05, 0.02, 0.005] {
        let share = thread.share(&ridge, mm);
        assert!(share <= 1.0, "thread at {mm}: {share} of the tolerance");
    }
    // Whole turns of path and twist, whose halves and quarters are all on one chord.
    let bar = [dvec2(-1., -1.), dvec2(1., -1.), dvec2(1., 1.), dvec2(-1., 1.)];
    for (turns, twist) in [(1.0, 0.0), (4.0, 0.0), (8.0, 360.0), (0.5, 1440.0)] {
        let share = Wound { r: 8.0, rise: 5.0, turns, twist, scale: 1.0 }.share(&bar, 0.05);
        assert!(share <= 1.0, "{turns} turns, a twist of {twist}: {share} of the tolerance");
    }
    let mut random = Random(41);
    for case in 0..16 {
        let mut between = |a: f64, b: f64| a + (b - a) * random.next();
        let count = between(3.0, 7.0) as u32;
        let profile: Vec<DVec2> = (0..count)
            .map(|i| {
                let (s, c) = libm::sincos(TAU * f64::from(i) / f64::from(count));
                dvec2(c, s) * between(1.0, 2.0)
            })
            .collect();
        let wound = Wound {
            r: between(8.0, 20.0),
            rise: between(6.0, 15.0),
            turns: between(0.3, 2.5),
            twist: if case % 2 == 0 { 0.0 } else { between(-300.0, 300.0) },
            scale: if case % 3 == 0 { 1.0 } else { between(0.4, 1.3) },
        };
        let share = wound.share(&profile, [0.1, 0.03, 0.01][case % 3]);
        assert!(share <= 1.0, "{case}: {share} of the tolerance");
    }
}

#[test]
fn lofts_keep_within_the_tolerance() {
    let mut random = Random(43);
    for case in 0..12 {
        let count = 3 + case % 4;
        let heights = [0.0, 10.0 + 10.0 * random.next(), 40.0];
        let rings: Vec<Vec<DVec2>> = (0..3)
            .map(|_| {
                let size = 5.0 + 10.0 * random.next();
                let corner = |i: usize| {
                    let (s, c) = libm::sincos(TAU * i as f64 / count as f64);
                    dvec2(c, s) * size
                };
                (0..count).map(corner).collect()
            })
            .collect();
        let regions: Vec<Region> = rings.iter().map(|ring| polygon(ring)).collect();
        let placed: Vec<Placed> = regions
            .iter()
            .zip(heights)
            .map(|(region, z)| Placed { region, frame: Placement::translation(DVec3::Z * z) })
            .collect();
        let mm = [0.1, 0.02][case % 2];
        let solid = loft(&placed, false, tolerance(mm)).expect("a vase");
        // A natural cubic spline through three points over the mean distances of the rings.
        let point = |k: usize, j: usize| rings[k][j % count].extend(heights[k]);
        let mean = |k: usize| {
            let sum: f64 = (0..count).map(|j| point(k, j).distance(point(k + 1, j))).sum();
            sum / count as f64
        };
        let h = [mean(0), mean(1)];
        let column = |j: usize, v: f64| {
            let y = [0, 1, 2].map(|k| point(k, j));
            let bend = ((y[2] - y[1]) / h[1] - (y[1] - y[0]) / h[0]) * 3.0 / (h[0] + h[1]);
            let (a, b, h, x) = match v < 0.5 {
                true => (y[0], y[1], h[0], 2.0 * v * h[0]),
                false => (y[2], y[1], h[1], 2.0 * (1.0 - v) * h[1]),
            };
            a.lerp(b, x / h) + bend * (x * (x * x - h * h) / (6.0 * h))
        };
        let side = |j: usize| -> Patch {
            let column = &column;
            Box::new(move |u, v| column(j, v).lerp(column(j + 1, v), u))
        };
        let patches: Vec<Patch> = (0..count).map(side).collect();
        let starts = spread(2, 6);
        let share = farthest(&looked_at(solid.mesh(), 80), &patches, |_| starts.clone()) / mm;
        assert!(share <= 1.0, "{case}: {share} of the tolerance");
    }
}

/// De Casteljau's algorithm.
fn bezier(points: &[DVec3], t: f64) -> DVec3 {
    let mut rest = points.to_vec();
    while rest.len() > 1 {
        rest = rest.windows(2).map(|pair| pair[0].lerp(pair[1], t)).collect();
    }
    rest[0]
}

#[test]
fn patches_keep_within_the_tolerance() {
    let mut random = Random(47);
    for case in 0..12 {
        let mut jitter = |p: DVec3, by: f64| {
            p + dvec3(random.next() - 0.5, random.next() - 0.5, random.next() - 0.5) * by
        };
        let corners: Vec<DVec3> = [(0., 0.), (30., 0.), (30., 20.), (0., 20.)]
            .map(|(x, y)| jitter(dvec3(x, y, 0.0), 6.0))
            .to_vec();
        let sides: Vec<Vec<DVec3>> = (0..4)
            .map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                let inner = |t: f64| a.lerp(b, t);
                vec![a, jitter(inner(0.33), 12.0), jitter(inner(0.67), 12.0), b]
            })
            .collect();
        let curves: Vec<Curve> =
            sides.iter().map(|side| Curve::bezier(side).expect("a side")).collect();
        let mm = [0.1, 0.02][case % 2];
        let grid = coons([&curves[0], &curves[1], &curves[2], &curves[3]], tolerance(mm))
            .expect("a patch");
        let patch: Patch = Box::new(|u, v| {
            let (low, high) = (bezier(&sides[0], u), bezier(&sides[2], 1.0 - u));
            let (left, right) = (bezier(&sides[3], 1.0 - v), bezier(&sides[1], v));
            let corner = |i: usize| corners[i];
            let flat = corner(0).lerp(corner(1), u).lerp(corner(3).lerp(corner(2), u), v);
            low.lerp(high, v) + left.lerp(right, u) - flat
        });
        let starts = spread(4, 4);
        let points = looked_at(&grid.mesh(), 150);
        let share = farthest(&points, &[patch], |_| starts.clone()) / mm;
        assert!(share <= 1.0, "{case}: {share} of the tolerance");
    }
}

/// Rails in a plane, where the turn onto the chord is about one axis: METHODS 4.3 as written.
#[test]
fn surfaces_on_two_rails_keep_within_the_tolerance() {
    let mut random = Random(53);
    for case in 0..12 {
        let mut next = |by: f64| (random.next() - 0.5) * by;
        let mut rail = |y: f64| {
            let point = |x: f64, a: f64, b: f64| dvec3(x + a, y + b, 0.0);
            [0.0, 20.0, 40.0, 60.0].map(|x| point(x, next(8.0), next(8.0)))
        };
        let rails = [rail(0.0), rail(20.0)];
        let mut section = |a: DVec3, b: DVec3| {
            [a, a.lerp(b, 0.3) + DVec3::Z * next(30.0), a.lerp(b, 0.7) + DVec3::Z * next(30.0), b]
        };
        let sections = [section(rails[0][0], rails[1][0]), section(rails[0][3], rails[1][3])];
        let curves = rails.map(|rail| Curve::bezier(&rail).expect("a rail"));
        let rows = sections.map(|section| Curve::bezier(&section).expect("a section"));
        let mm = [0.1, 0.02][case % 2];
        let grid = surface(
            &[&rows[0], &rows[1]],
            [&curves[0], &curves[1]],
            Stations::Through,
            tolerance(mm),
        )
        .expect("a surface");
        let chord = |v: f64| bezier(&rails[1], v) - bezier(&rails[0], v);
        let angle = |c: DVec3| libm::atan2(c.y, c.x);
        let about = |turn: f64| DMat3::from_rotation_z(turn);
        let (a, b) = (chord(0.0), chord(1.0));
        let patch: Patch = Box::new(|u, v| {
            let first = bezier(&sections[0], u) - rails[0][0];
            let last = about(angle(a) - angle(b)) * (bezier(&sections[1], u) - rails[0][3]);
            let c = chord(v);
            let stretch = c.length() / ((1.0 - v) * a.length() + v * b.length());
            bezier(&rails[0], v) + about(angle(c) - angle(a)) * first.lerp(last, v) * stretch
        });
        let starts = spread(4, 4);
        let points = looked_at(&grid.mesh(), 150);
        let share = farthest(&points, &[patch], |_| starts.clone()) / mm;
        assert!(share <= 1.0, "{case}: {share} of the tolerance");
    }
}

/// The forms that faces know: facets keep within the tolerance of them and look their way, also where a placement has
/// mirrored them.
#[test]
fn faces_know_their_parameter_surfaces() {
    let mm = 0.02;
    let wave = [0.0, 20.0, 40.0, 60.0].map(|x| dvec3(x, 8.0 * libm::sin(x), 5.0 * libm::cos(x)));
    let path = Curve::spline(&wave, false, [None; 2]).expect("a path");
    let square = polygon(&[dvec2(-2., -2.), dvec2(2., -2.), dvec2(2., 2.), dvec2(-2., 2.)]);
    let way = Along { twist: 90.0, scale: 0.5, ..Along::path(&path) };
    let bar = along(&square, &way, tolerance(mm)).expect("a bar");
    let wide = polygon(&[dvec2(-4., -3.), dvec2(4., -3.), dvec2(4., 3.), dvec2(-4., 3.)]);
    let at = |region, z: f64| Placed { region, frame: Placement::translation(DVec3::Z * z) };
    let sections = [at(&square, 0.0), at(&wide, 10.0), at(&square, 25.0)];
    let vase = loft(&sections, false, tolerance(mm)).expect("a vase");
    let rail = |side: f64| {
        let points = [0.0, 10.0, 25.0].map(|z| dvec3(side * (5.0 + 0.02 * z * z), 0.0, z));
        Curve::smooth(&points, false).expect("a rail")
    };
    let rails = [rail(-1.0), rail(1.0)];
    let way =
        Between { rails: [&rails[0], &rails[1]], stations: Stations::Through, repair: Repair::No };
    let horn = between(&[at(&square, 0.0), at(&wide, 25.0)], &way, tolerance(mm)).expect("a horn");
    let mirror = Placement::new(DMat3::from_diagonal(dvec3(-2.0, 1.0, 1.5)), DVec3::ONE);
    for (name, solid) in [("bar", bar), ("vase", vase), ("horn", horn)] {
        for (solid, stretch) in [(solid.clone(), 1.0), (solid.placed(&mirror), 2.0)] {
            let mesh = solid.mesh();
            let curved = mesh.faces().filter(|face| face.origin().surface == Surface::Smooth);
            let mut count = 0;
            for face in curved.step_by(7) {
                let form = face.origin().form.as_ref().expect("a form");
                let sum: DVec3 = face.outer().iter().map(|&c| mesh.points[c as usize]).sum();
                let middle = sum / face.outer().len() as f64;
                let [u, v] = form.nearest(middle);
                let off = form.at(u, v).distance(middle);
                assert!(off <= mm * stretch, "{name}: {off}");
                let looks = form.normal(u, v).dot(face.area_vector().normalize());
                assert!(looks > 0.95, "{name}: {looks}");
                count += 1;
            }
            assert!(count > 10, "{name}: {count}");
        }
    }
}
