//! Drawings against sight lines: an independent check on random scenes.

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot, dvec3};
use katachi::{
    geom::{Placement, PolyMesh, triangulate::triangulate},
    kernel::brep::{
        Polyhedron,
        primitive::{cuboid, sphere},
    },
    output::drawing::{
        Camera, Class, Drawing, Hidden, Method, Options, Scene, Segment, visible_lines,
    },
};

use super::scenes::{drawn, near, union};
use crate::random::Random;

impl Random {
    fn within(&mut self, half: f64) -> DVec3 {
        (DVec3::from_array(std::array::from_fn(|_| self.next())) - 0.5) * 2.0 * half
    }

    /// A box of sides up to 20 mm, turned anyhow, within 40 mm of the origin.
    fn cuboid(&mut self) -> Polyhedron {
        let half = self.within(1.0).abs() * 9.0 + 1.0;
        let [x, y, z] = (self.within(3.0)).to_array();
        let turn = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, x, y, z));
        cuboid(-half, half).placed(&Placement::new(turn, self.within(25.0)))
    }

    fn camera(&mut self) -> Camera {
        let direction = self.within(1.0).normalize() * 120.0;
        if self.next() < 0.5 {
            Camera::parallel(direction).expect("a direction")
        } else {
            Camera::perspective(direction, self.within(10.0)).expect("apart")
        }
    }
}

/// Triangles, and the sight lines they cut.
struct Triangles(Vec<[DVec3; 3]>);

impl Triangles {
    fn of<'a>(meshes: impl Iterator<Item = &'a PolyMesh>) -> Triangles {
        let all = meshes.flat_map(|mesh| {
            let corners = triangulate(mesh).corners;
            corners.into_iter().map(|t| t.map(|c| mesh.points[c as usize])).collect::<Vec<_>>()
        });
        Triangles(all.collect())
    }

    /// Whether something is between a point and the eye, farther from the point than a hair.
    fn hide(&self, camera: &Camera, p: DVec3) -> bool {
        let sight = camera.sight(p);
        let (unit, end) =
            (sight.normalize(), camera.eye().map_or(f64::INFINITY, |_| sight.length()));
        self.0.iter().any(|&[a, b, c]| {
            // Möller and Trumbore.
            let (u, v, w) = (b - a, c - a, p - a);
            let n = unit.cross(v);
            let det = u.dot(n);
            let (s, m) = (w.dot(n) / det, w.cross(u));
            let (t, far) = (unit.dot(m) / det, v.dot(m) / det);
            s >= 0.0 && t >= 0.0 && s + t <= 1.0 && far > 1e-6 && far < end
        })
    }
}

/// The distance of a place from the nearest visible line.
fn off(drawing: &Drawing, at: DVec2) -> f64 {
    let visible = drawing.lines.iter().filter(|l| l.class == Class::Visible);
    let distance = |(p, segment): (DVec2, &Segment)| {
        let q = segment.end();
        let t = (at - p).dot(q - p) / (q - p).length_squared();
        p.lerp(q, t.clamp(0.0, 1.0)).distance(at)
    };
    visible.flat_map(|l| l.path.pieces().map(distance)).fold(f64::INFINITY, f64::min)
}

/// Holds points of all edges against the drawing: seen points are drawn, unseen points are not.
fn check(solids: &[Polyhedron], camera: &Camera, drawing: &Drawing, scene: u64) {
    let triangles = Triangles::of(solids.iter().map(Polyhedron::mesh));
    for mesh in solids.iter().map(Polyhedron::mesh) {
        for face in mesh.faces() {
            for corners in face.loops() {
                for (i, &a) in corners.iter().enumerate() {
                    let b = corners[(i + 1) % corners.len()];
                    let [p, q] = [a, b].map(|c| mesh.points[c as usize]);
                    check_edge(&triangles, camera, drawing, [p, q], scene);
                }
            }
        }
    }
}

fn check_edge(
    triangles: &Triangles,
    camera: &Camera,
    drawing: &Drawing,
    [p, q]: [DVec3; 2],
    scene: u64,
) {
    for i in 0..5 {
        let on = p.lerp(q, 0.117 + 0.19 * f64::from(i));
        let hidden = triangles.hide(camera, on);
        let at = camera.project(on).expect("before the eye");
        // Points so near to where the line changes that a hair decides are left out.
        let aside = (q - p).any_orthonormal_vector() * 1e-5;
        let sure = [aside, -aside].iter().all(|d| triangles.hide(camera, on + *d) == hidden);
        let distance = off(drawing, at);
        if hidden && sure {
            assert!(distance > 1e-8, "scene {scene}: {on} is drawn and not seen");
        } else if !hidden {
            assert!(distance < 1e-6, "scene {scene}: {on} is seen and not drawn ({distance} mm)");
        }
    }
}

/// Bodies with a gap between the balls around them.
fn apart(random: &mut Random, count: usize) -> Vec<Polyhedron> {
    let ball = |s: &Polyhedron| {
        let points = &s.mesh().points;
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        (middle, points[0].distance(middle))
    };
    let mut solids: Vec<Polyhedron> = vec![];
    for _ in 0..count {
        let next = random.cuboid();
        let (m, r) = ball(&next);
        if solids.iter().map(ball).all(|(n, s)| m.distance(n) > r + s) {
            solids.push(next);
        }
    }
    solids
}

#[test]
fn random_boxes_are_drawn_as_they_are_seen() {
    for scene in 0..120 {
        let mut random = Random(scene);
        let solids = apart(&mut random, 12);
        let camera = random.camera();
        let [auto, count, clip] =
            [Method::Auto, Method::Count, Method::Clip].map(|m| drawn(&solids, &camera, m));
        for other in [&count, &clip] {
            assert!(near(other.visible, auto.visible, 1e-9), "scene {scene}");
            assert!(near(other.hidden, auto.hidden, 1e-9), "scene {scene}");
        }
        check(&solids, &camera, &auto, scene);
    }
}

#[test]
fn random_unions_are_drawn_as_they_are_seen() {
    for scene in 0..40 {
        let mut random = Random(1000 + scene);
        let solids = [union((0..5).map(|_| random.cuboid()).collect())];
        let camera = random.camera();
        let [auto, clip] = [Method::Auto, Method::Clip].map(|m| drawn(&solids, &camera, m));
        assert!(near(clip.visible, auto.visible, 1e-9), "scene {scene}");
        assert!(near(clip.hidden, auto.hidden, 1e-9), "scene {scene}");
        check(&solids, &camera, &auto, scene);
    }
}

/// The ball that a sight line meets first.
fn first(balls: &[(DVec3, f64)], camera: &Camera, at: DVec2) -> Option<usize> {
    let (p, away) = camera.ray(at);
    let unit = away.normalize();
    let met = balls.iter().enumerate().filter_map(|(i, &(center, radius))| {
        let v = center - p;
        let along = v.dot(unit);
        let square = radius * radius - (v.length_squared() - along * along);
        (square > 0.0).then(|| (along - square.sqrt(), i))
    });
    met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, i)| i)
}

/// Holds points of an outline against what is seen on both sides of it.
fn check_outline(
    balls: &[(DVec3, f64)],
    camera: &Camera,
    class: Class,
    (start, segment): (DVec2, &Segment),
    scene: u64,
) {
    for i in 0..9 {
        let t = 0.05 + 0.1 * f64::from(i);
        let [p, q] = [t, t + 1e-6].map(|t| segment.at(start, t));
        let across = (q - p).perp().normalize() * 1e-6;
        let [left, right] = [p + across, p - across].map(|p| first(balls, camera, p));
        assert_eq!(left != right, class == Class::Visible, "scene {scene} at {p}");
    }
}

#[test]
fn outlines_of_balls_part_what_is_seen() {
    for scene in 0..40 {
        let mut random = Random(2000 + scene);
        let mut balls: Vec<(DVec3, f64)> = vec![];
        for _ in 0..12 {
            let (center, radius) = (random.within(30.0), 2.0 + 8.0 * random.next());
            if balls.iter().all(|&(c, r)| c.distance(center) > radius + r) {
                balls.push((center, radius));
            }
        }
        let camera = random.camera();
        let solid = |&(center, radius): &(DVec3, f64)| {
            sphere(radius, 60).placed(&Placement::translation(center))
        };
        let solids: Vec<Polyhedron> = balls.iter().map(solid).collect();
        let drawing = drawn(&solids, &camera, Method::Auto);
        let mut length = 0.0;
        for line in drawing.lines.iter() {
            for (start, segment) in line.path.pieces() {
                check_outline(&balls, &camera, line.class, (start, segment), scene);
            }
            length += line.path.length();
        }
        assert!(near(length, drawing.visible + drawing.hidden, 1e-9));
    }
}

#[test]
fn the_order_counts_the_faces_in_front() {
    let wall = |y: f64| cuboid(dvec3(-5.0, y, -5.0), dvec3(5.0, y + 1.0, 5.0));
    let small = cuboid(dvec3(-1.0, 50.0, -1.0), dvec3(1.0, 51.0, 1.0));
    let solids = [wall(0.0), wall(10.0), wall(20.0), small];
    let camera = Camera::parallel(dvec3(0.01, -1.0, 0.02)).expect("a direction");
    for method in [Method::Auto, Method::Count, Method::Clip] {
        let options = Options { method, hidden: Hidden::Depth(9), ..Options::default() };
        let scene = Scene::of(solids.iter().map(Polyhedron::mesh));
        let drawing = visible_lines(&scene, &camera, &options);
        let orders = drawing.lines.iter().filter(|l| l.id == 3).map(|l| l.order);
        let orders: Vec<u32> = orders.collect();
        assert!(orders.iter().all(|o| [3, 4].contains(o)), "{method:?}: {orders:?}");
        assert!(orders.contains(&3) && orders.contains(&4));
    }
}
