//! The tolerance holds where the output stands, whatever was scaled on the way there.

use glam::{DMat2, DMat3, DVec2, DVec3};
use katachi::{
    base::{Shelf, Span, watch::Unwatched},
    geom::{
        Placement, PolyMesh,
        triangulate::triangulate,
        trig::{cos_deg, sin_deg},
    },
    realize::Realizer,
    session::Format,
    shape::{Node, ShapeGraph, ShapeId},
};

use super::{
    laws::Random,
    made::{Made, OFF},
};

/// The default of the language, mm.
const TOLERANCE: f64 = 0.05;

/// What rounding may add to it, and how far corners may be from the true surface, mm.
const ROUNDING: f64 = 1e-6;

/// The nearest point of a true surface about the origin.
type Nearest = fn(DVec3) -> DVec3;

fn on_ball(p: DVec3) -> DVec3 {
    p.normalize() * 5.0
}

/// Height of what has a height.
const HEIGHT: f64 = 9.0;

/// A point of the top or the bottom of something stands for itself.
fn between_ends(p: DVec3, side: impl Fn(DVec2) -> DVec2) -> DVec3 {
    let end = p.z.abs() < 1e-6 || (p.z - HEIGHT).abs() < 1e-6;
    if end { p } else { side(p.truncate()).extend(p.z) }
}

fn on_cylinder(p: DVec3) -> DVec3 {
    between_ends(p, |p| p.normalize() * 5.0)
}

/// A cylinder whose top is six times as wide as its bottom.
fn on_funnel(p: DVec3) -> DVec3 {
    between_ends(p, |q| q.normalize() * 5.0 * (1.0 + 5.0 * p.z / HEIGHT))
}

/// A circle of radius 2 about (10, 0) that makes a quarter turn on its way up.
fn on_screw(p: DVec3) -> DVec3 {
    let angle = 90.0 * p.z / HEIGHT;
    let centre = 10.0 * DVec2::new(cos_deg(angle), sin_deg(angle));
    between_ends(p, |q| centre + (q - centre).normalize() * 2.0)
}

/// A square of 14 with corners rounded by 2.
fn on_pillow(p: DVec3) -> DVec3 {
    between_ends(p, |q| {
        let corner = q.signum() * 5.0;
        match q.abs().min_element() > 5.0 {
            true => corner + (q - corner).normalize() * 2.0,
            false => q,
        }
    })
}

fn on_torus(p: DVec3) -> DVec3 {
    let core = (p.truncate().normalize() * 8.0).extend(0.0);
    core + (p - core).normalize() * 3.0
}

fn rotation(random: &mut Random) -> DMat3 {
    let mut whole = DMat3::IDENTITY;
    for axis in 0..3 {
        let (c, s) = {
            let a = 360.0 * random.unit();
            (cos_deg(a), sin_deg(a))
        };
        let turn = DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z);
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let basis = DMat3::from_cols(axes[axis], axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        whole = basis * turn * basis.transpose() * whole;
    }
    whole
}

/// Rotations about a scale from 0.05 to 10, in half of the cases one that differs by direction.
fn placement(random: &mut Random) -> Placement {
    let mut size = || 0.05 * libm::pow(200.0, random.unit());
    let mut sizes = DVec3::new(size(), size(), size());
    if random.below(2) == 0 {
        sizes = DVec3::splat(sizes.x);
    }
    let linear = rotation(random) * DMat3::from_diagonal(sizes) * rotation(random);
    Placement::new(linear, 10.0 * DVec3::new(random.unit(), random.unit(), random.unit()))
}

/// Corners, and points on the edges and within the triangles, of the faces that bear a name, or of all.
fn samples(mesh: &PolyMesh, tag: Option<&str>) -> [Vec<DVec3>; 2] {
    const WEIGHTS: [[f64; 3]; 5] =
        [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.2, 0.3, 0.5], [0.4, 0.3, 0.3]];
    let triangles = triangulate(mesh);
    let mut found = [vec![], vec![]];
    for (corners, &face) in triangles.corners.iter().zip(&triangles.face) {
        let tags = &mesh.face(face as usize).origin().tags;
        if tag.is_some_and(|tag| !tags.iter().any(|t| **t == *tag)) {
            continue;
        }
        let [a, b, c] = corners.map(|corner| mesh.points[corner as usize]);
        found[0].extend([a, b, c]);
        found[1].extend(WEIGHTS.map(|w| a * w[0] + b * w[1] + c * w[2]));
    }
    found
}

#[derive(Default)]
struct Bench(ShapeGraph);

impl Bench {
    fn add(&mut self, node: Node) -> ShapeId {
        self.0.add(node, Span::default())
    }

    fn placed(&mut self, child: ShapeId, placement: Placement) -> ShapeId {
        self.add(Node::Transform { placement, child })
    }

    fn circle(&mut self, r: f64) -> ShapeId {
        self.add(Node::Ellipse { radii: DVec2::splat(r), sides: None })
    }

    fn extruded(&mut self, profile: ShapeId, height: f64, twist: f64, scale: f64) -> ShapeId {
        self.add(Node::Extrude { profile, height, twist, scale: DVec2::splat(scale) })
    }

    fn mesh(&self, id: ShapeId) -> PolyMesh {
        let realizer = Realizer::new(&Shelf(&[]), &Unwatched, None);
        realizer.solid(&self.0, id).expect("made").polyhedron.mesh().clone()
    }

    /// No point of a shape is farther than the tolerance from the true surface, and no corner is off it.
    fn check(&self, id: ShapeId, way: &Placement, nearest: Nearest, what: &str) {
        check(&self.mesh(id), None, way, nearest, what);
    }
}

/// The leaves of the tests: what they are, and their true surface.
fn leaves() -> [(Node, Nearest); 3] {
    [
        (Node::Sphere { r: 5.0, sides: None }, on_ball),
        (Node::Cone { r1: 5.0, r2: 5.0, h: HEIGHT, sides: None }, on_cylinder),
        (Node::Torus { major: 8.0, minor: 3.0, sides: None }, on_torus),
    ]
}

fn check(mesh: &PolyMesh, tag: Option<&str>, way: &Placement, nearest: Nearest, what: &str) {
    let back = way.inverse().expect("no flattening");
    let error = |p: &DVec3| {
        let inner = back.point(*p);
        way.vector(inner - nearest(inner)).length()
    };
    let [corners, within] = samples(mesh, tag);
    assert!(!corners.is_empty(), "{what}");
    let off = corners.iter().map(error).fold(0.0, f64::max);
    assert!(off <= ROUNDING, "{what}: a corner is {off} mm off");
    let worst = within.iter().map(error).fold(0.0, f64::max);
    assert!(worst <= TOLERANCE + ROUNDING, "{what}: {worst} mm");
}

#[test]
fn placed_curves_keep_the_tolerance() {
    let mut random = Random(1);
    for round in 0..40 {
        for (node, nearest) in leaves() {
            let mut bench = Bench::default();
            let what = format!("round {round}: {node:?}");
            let (outer, inner) = (placement(&mut random), placement(&mut random));
            let leaf = bench.add(node);
            let once = bench.placed(leaf, outer);
            bench.check(once, &outer, nearest, &what);
            let leaf = bench.placed(leaf, inner);
            let leaf = bench.add(Node::Tag { name: "t".into(), child: leaf });
            let twice = bench.placed(leaf, outer);
            bench.check(twice, &outer.after(&inner), nearest, &what);
        }
    }
}

/// Operations inside one another, each placed: two copies are taken into one expression, three are made first.
#[test]
fn curves_in_set_operations_keep_the_tolerance() {
    let mut random = Random(2);
    for round in 0..12 {
        for (node, nearest) in leaves() {
            let mut bench = Bench::default();
            let what = format!("round {round}: {node:?}");
            let leaf = bench.add(node);
            let chip = bench.add(Node::Box { min: DVec3::splat(1e4), max: DVec3::splat(2e4) });
            let inner = bench.add(Node::Difference([leaf, chip].into()));
            let steps: Vec<Placement> = (0..2 + round % 2)
                .map(|i| {
                    Placement::translation(DVec3::X * 3e2 * i as f64).after(&placement(&mut random))
                })
                .collect();
            let copy = |bench: &mut Bench, step: &Placement| {
                let child = bench.placed(inner, *step);
                let name = format!("at {}", step.offset()).into();
                bench.add(Node::Tag { name, child })
            };
            let copies: Vec<ShapeId> = steps.iter().map(|step| copy(&mut bench, step)).collect();
            let all = bench.add(Node::Union(copies.into()));
            let outer = placement(&mut random);
            let whole = bench.placed(all, outer);
            let mesh = bench.mesh(whole);
            for step in steps {
                let tag = format!("at {}", step.offset());
                check(&mesh, Some(&tag), &outer.after(&step), nearest, &what);
            }
        }
    }
}

#[test]
fn scaled_profiles_keep_the_tolerance() {
    let mut random = Random(3);
    for round in 0..40 {
        let mut bench = Bench::default();
        let (outer, flat) = (placement(&mut random), placement(&mut random).linear());
        let plane = DMat2::from_cols(flat.x_axis.truncate(), flat.y_axis.truncate());
        if plane.determinant().abs() < 0.01 {
            continue;
        }
        let columns = [plane.x_axis, plane.y_axis].map(|c| c.extend(0.0));
        let inner = Placement::new(DMat3::from_cols(columns[0], columns[1], DVec3::Z), DVec3::ONE);
        let circle = bench.circle(5.0);
        let placed = bench.placed(circle, inner);
        let solid = bench.extruded(placed, HEIGHT, 0.0, 1.0);
        let whole = bench.placed(solid, outer);
        bench.check(whole, &outer.after(&inner), on_cylinder, &format!("round {round}"));
    }
}

#[test]
fn what_is_made_of_curves_keeps_the_tolerance() {
    let mut random = Random(4);
    for round in 0..10 {
        let mut bench = Bench::default();
        let way = placement(&mut random);
        let circle = bench.circle(5.0);
        let funnel = bench.extruded(circle, HEIGHT, 0.0, 6.0);
        let small = bench.circle(2.0);
        let small = bench.placed(small, Placement::translation(DVec3::X * 10.0));
        let screw = bench.extruded(small, HEIGHT, 90.0, 1.0);
        let tube = bench.circle(3.0);
        let profile = bench.placed(tube, Placement::translation(DVec3::X * 8.0));
        let ring = bench.add(Node::Revolve { profile, angle: 360.0, sides: None });
        let square = bench.add(Node::Rect { size: DVec2::splat(10.0) });
        let grown = bench.add(Node::OffsetProfile { profile: square, d: 2.0 });
        let pillow = bench.extruded(grown, HEIGHT, 0.0, 1.0);
        let square = bench.add(Node::Rect { size: DVec2::splat(14.0) });
        let rounded = bench.add(Node::RoundProfile { profile: square, r: 2.0 });
        let cushion = bench.extruded(rounded, HEIGHT, 0.0, 1.0);
        let half = Placement::new(DMat3::from_diagonal(DVec3::splat(0.1)), DVec3::ZERO);
        let large = bench.add(Node::Sphere { r: 50.0, sides: None });
        let ball = bench.placed(large, half);
        let hull = bench.add(Node::Hull([ball].into()));
        let all: [(ShapeId, Nearest); 6] = [
            (funnel, on_funnel),
            (screw, on_screw),
            (ring, on_torus),
            (pillow, on_pillow),
            (cushion, on_pillow),
            (hull, on_ball),
        ];
        for (i, (shape, nearest)) in all.into_iter().enumerate() {
            let placed = bench.placed(shape, way);
            bench.check(placed, &way, nearest, &format!("round {round}, shape {i}"));
        }
    }
}

/// Triangles of the one part of a model.
fn triangles(text: &str) -> usize {
    let made = Made::of(&Shelf(&[("m.kata", text)]), "m.kata", &[]);
    made.unwrap_or_else(|e| panic!("{text}: {e}")).parts[0].1.triangles
}

#[test]
fn a_scaled_shape_has_the_facets_of_one_made_in_its_size() {
    let same: [&[&str]; 5] = [
        &[
            "sphere(50)",
            "sphere(5).scale(10)",
            "sphere(500).scale(0.1)",
            "sphere(5).scale(2).scale(5)",
        ],
        &[
            "sphere(50) - box(60, 60, 60)",
            "(sphere(5) - box(6, 6, 6)).scale(10)",
            "sphere(5).scale(10) - box(60, 60, 60)",
            "sphere(5).rotate(z = 90).scale(10).rotate(z = -90) - box(60, 60, 60)",
        ],
        &[
            "circle(30).extrude(10)",
            "circle(3).scale(10).extrude(10)",
            "circle(3).extrude(1).scale(10)",
            "circle(3).scale(x = 10, y = 10).extrude(10)",
            "circle(300).scale(x = 0.1, y = 0.1).extrude(10)",
            "circle(3).extrude(1).scale(x = 10, y = 2)",
        ],
        &[
            "text(\"Sg\", size = 40).extrude(1)",
            "text(\"Sg\", size = 4).scale(10).extrude(1)",
            "text(\"Sg\", size = 400).extrude(10).scale(0.1)",
        ],
        &["cylinder(50, 8, sides = 12)", "cylinder(5, 8, sides = 12).scale(10)"],
    ];
    for list in same {
        let counts: Vec<usize> = list.iter().map(|text| triangles(text)).collect();
        assert!(counts.windows(2).all(|w| w[0] == w[1]), "{list:?}: {counts:?}");
    }
    assert!(triangles("sphere(50)") > triangles("sphere(5)"));
}

/// The same ball at three sizes: no part hangs on which others are asked for, or on their order.
#[test]
fn what_is_made_does_not_hang_on_other_outputs() {
    let parts = [
        "part a = sphere(5) - box(9, 9, 9)",
        "part b = (sphere(5) - box(9, 9, 9)).scale(10)",
        "part c = (sphere(5) - box(9, 9, 9)).scale(0.1) + (sphere(5) - box(9, 9, 9)).scale(10).move(x = 99)",
    ];
    let files = |text: &str| -> Vec<(String, Vec<u8>)> {
        let made = Made::of(&Shelf(&[("m.kata", text)]), "m.kata", &[OFF]).expect("made");
        made.files
    };
    let all = files(&parts.join("\n"));
    let mut reversed = files(&[parts[2], parts[1], parts[0]].join("\n"));
    reversed.reverse();
    assert!(all == reversed, "the order counts");
    for (file, text) in all.iter().zip(parts) {
        assert!(files(text)[..] == [file.clone()], "{text}");
    }
}

#[test]
fn measures_follow_the_scale() {
    let text = "a = sphere(5).scale(10)\nb = sphere(50)\n\
                assert near(volume(a), volume(b), tol = 1e-9)\n\
                p = [28.85, 28.85, 28.85]\nassert inside(a, p) == inside(b, p)\n\
                assert near(distance(a, [90, 0, 0]), distance(b, [90, 0, 0]))\n\
                assert distance(a, [50, 0, 0]) < 0.05mm\n\
                assert near(area(circle(5).scale(10)), area(circle(50)), tol = 1e-9)\npart c = a";
    Made::of(&Shelf(&[("m.kata", text)]), "m.kata", &[]).expect("all holds");
}

#[test]
fn openscad_is_asked_for_the_same_facets() {
    let source = |text: &str| {
        let made = Made::of(&Shelf(&[("m.kata", text)]), "m.kata", &[Format::Scad]).expect("made");
        String::from_utf8(made.files[0].1.clone()).expect("text")
    };
    let counts = |text: &str| -> Vec<String> {
        let source = source(text);
        let words = source.split("$fn = ").skip(1);
        words.map(|rest| rest.chars().take_while(char::is_ascii_digit).collect()).collect()
    };
    assert_eq!(counts("sphere(5).scale(10)"), counts("sphere(50)"));
    assert_eq!(
        counts("rect(4, 4).offset(1).scale(10).extrude(3)"),
        counts("rect(40, 40).offset(10).extrude(3)")
    );
    let both =
        "a = sphere(5) - box(5, 5, 5)\npart p = a + a.move(x = 20) + a.scale(10).move(z = 99)";
    let mut expected = counts("sphere(5)");
    expected.extend(counts("sphere(50)"));
    assert_eq!(counts(both), expected);
}

#[test]
fn too_fine_a_mesh_is_refused() {
    let made = Made::of(&Shelf(&[("m.kata", "sphere(5).scale(1e9)")]), "m.kata", &[]);
    assert!(made.err().is_some_and(|e| e.contains("triangles; the limit is")));
}
