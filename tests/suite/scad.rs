//! The OpenSCAD source we write, read by OpenSCAD itself: volume, area and placing against closed
//! forms. Where OpenSCAD is not installed the sources are still written, and nothing is compared.

use std::{f64::consts::PI, fs, path::Path, process::Command, sync::Arc};

use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use katachi::{
    base::Span,
    geom::{
        Contour, Origin, Placement, PolyMesh, Region, Surface, Tolerance,
        mesh::Color,
        region::Piece,
        trig::{cos_deg, sin_deg},
    },
    output::scad,
    shape::{
        Kind, Node, ShapeGraph, ShapeId, Stretched,
        node::{HorizontalAlign, TextSpec, VerticalAlign},
    },
};

/// OpenSCAD prints six digits.
const PRECISION: f64 = 1e-5;

/// A graph under construction.
#[derive(Default)]
struct Model(ShapeGraph);

impl Model {
    fn add(&mut self, node: Node) -> ShapeId {
        self.0.add(node, Span::default())
    }

    fn cuboid(&mut self, min: [f64; 3], max: [f64; 3]) -> ShapeId {
        self.add(Node::Box { min: min.into(), max: max.into() })
    }

    fn rect(&mut self, x: f64, y: f64) -> ShapeId {
        self.add(Node::Rect { size: dvec2(x, y) })
    }

    fn circle(&mut self, r: f64, sides: u32) -> ShapeId {
        self.add(Node::Ellipse { radii: DVec2::splat(r), sides: Some(sides) })
    }

    fn at(&mut self, child: ShapeId, v: [f64; 3]) -> ShapeId {
        self.add(Node::Transform { placement: Placement::translation(v.into()), child })
    }

    fn turned(&mut self, child: ShapeId, linear: DMat3) -> ShapeId {
        self.add(Node::Transform { placement: Placement::new(linear, DVec3::ZERO), child })
    }

    fn extrude(&mut self, profile: ShapeId, height: f64) -> ShapeId {
        self.add(Node::Extrude { profile, height, twist: 0.0, scale: DVec2::ONE })
    }
}

/// Stands in for realisation: one mesh and one region for whatever is asked.
struct Fixed;

impl scad::Realized for Fixed {
    fn mesh(&self, _: Stretched) -> Option<PolyMesh> {
        let corners = [dvec3(0., 0., 0.), dvec3(3., 0., 0.), dvec3(0., 4., 0.), dvec3(0., 0., 2.)];
        let mut mesh = PolyMesh::with_points(corners.to_vec());
        let origin = mesh.add_origin(Origin::of(Surface::Plane));
        for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
            let plane = mesh.add_plane();
            mesh.push_face(&[face], plane, origin);
        }
        Some(mesh)
    }

    fn region(&self, _: Stretched) -> Option<Region> {
        let ring = |r: f64| vec![dvec2(-r, -r), dvec2(r, -r), dvec2(r, r), dvec2(-r, r)];
        let hole = ring(2.0).into_iter().rev().collect();
        let piece =
            Piece { outer: Contour::polygon(ring(5.0)), holes: vec![Contour::polygon(hole)] };
        Some(Region { pieces: vec![piece] })
    }
}

/// What OpenSCAD made.
struct Export {
    points: Vec<DVec3>,
    volume: f64,
    area: f64,
}

impl Export {
    /// Runs OpenSCAD on the source; `None` if it is not installed.
    fn of(name: &str, source: &str) -> Option<Export> {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scad");
        fs::create_dir_all(&folder).expect("a folder for the exports");
        let (input, output) =
            (folder.join(format!("{name}.scad")), folder.join(format!("{name}.off")));
        fs::write(&input, source).expect("writable");
        let run = Command::new("openscad").arg("-o").arg(&output).arg(&input).output().ok()?;
        let said = String::from_utf8_lossy(&run.stderr);
        let fine = run.status.success() && !said.contains("WARNING") && !said.contains("ERROR");
        assert!(fine, "{name}: {said}\n{source}");
        Some(Export::read(&fs::read_to_string(&output).expect("an OFF file")))
    }

    fn read(text: &str) -> Export {
        let mut words =
            text.split_whitespace().skip(1).map(|w| w.parse::<f64>().expect("a number"));
        let mut next = || words.next().expect("more numbers");
        let (points, faces) = (next() as usize, next() as usize);
        next();
        let points: Vec<DVec3> = (0..points).map(|_| dvec3(next(), next(), next())).collect();
        let mut export = Export { points, volume: 0.0, area: 0.0 };
        for _ in 0..faces {
            let corners: Vec<usize> = (0..next() as usize).map(|_| next() as usize).collect();
            for w in corners.windows(2).skip(1) {
                let [a, b, c] = [corners[0], w[0], w[1]].map(|i| export.points[i]);
                export.volume += a.dot(b.cross(c)) / 6.0;
                export.area += (b - a).cross(c - a).length() / 2.0;
            }
        }
        export
    }

    fn has(&self, p: [f64; 3]) -> bool {
        self.points.iter().any(|q| q.distance(p.into()) < 1e-3)
    }
}

fn export(name: &str, model: &Model, part: ShapeId) -> Option<Export> {
    let source = scad::write(&model.0, &[(name, part)], Tolerance::DEFAULT, &Fixed);
    Export::of(name, &source.expect("expressible"))
}

/// Compares with closed forms and returns the export for more questions.
fn check(name: &str, model: &Model, part: ShapeId, volume: f64, area: f64) -> Option<Export> {
    let export = export(name, model, part)?;
    let near = |a: f64, b: f64| (a - b).abs() <= PRECISION * b;
    assert!(near(export.volume, volume), "{name}: volume {} for {volume}", export.volume);
    assert!(near(export.area, area), "{name}: area {} for {area}", export.area);
    Some(export)
}

/// Area of the n-gon in the unit circle.
fn ngon(n: u32) -> f64 {
    let n = f64::from(n);
    n / 2.0 * sin_deg(360.0 / n)
}

/// Area of the n facets that an edge from radius and height `a` to `b` sweeps about z.
fn band(n: u32, a: DVec2, b: DVec2) -> f64 {
    let half = 180.0 / f64::from(n);
    let slant = dvec2((b.x - a.x) * cos_deg(half), b.y - a.y).length();
    f64::from(n) * (a.x + b.x) * sin_deg(half) * slant
}

/// Volume and area of the solid that a closed polygon (counter-clockwise, x >= 0) makes about z.
fn revolved(n: u32, corners: &[DVec2]) -> (f64, f64) {
    let next = corners.iter().cycle().skip(1);
    let edges: Vec<(DVec2, DVec2)> = corners.iter().copied().zip(next.copied()).collect();
    let moment = |&(a, b): &(DVec2, DVec2)| (b.y - a.y) * (a.x * a.x + a.x * b.x + b.x * b.x) / 3.0;
    let volume = ngon(n) * edges.iter().map(moment).sum::<f64>();
    (volume, edges.iter().map(|&(a, b)| band(n, a, b)).sum())
}

fn polar(r: f64, degrees: f64) -> DVec2 {
    r * dvec2(cos_deg(degrees), sin_deg(degrees))
}

#[test]
fn boxes_and_polyhedra() {
    let mut m = Model::default();
    let cuboid = m.cuboid([-20., -15., 0.], [20., 15., 5.]);
    check("box", &m, cuboid, 6000., 2. * (1200. + 200. + 150.));
    let points = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].map(|p| 6.0 * p);
    let faces: Vec<Arc<[u32]>> =
        [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
            .map(|f| Arc::from(f.as_slice()))
            .to_vec();
    let octahedron = m.add(Node::Polyhedron { points: points.into(), faces: faces.into() });
    check("octahedron", &m, octahedron, 288., 72. * 2. * 3f64.sqrt());
}

#[test]
fn round_primitives_have_the_facets_asked_for() {
    let mut m = Model::default();
    let rod = m.add(Node::Cone { r1: 4., r2: 4., h: 9., sides: Some(7) });
    let (v, a) = revolved(7, &[dvec2(0., 0.), dvec2(4., 0.), dvec2(4., 9.), dvec2(0., 9.)]);
    check("rod", &m, rod, v, a);
    let cone = m.add(Node::Cone { r1: 5., r2: 2., h: 9., sides: Some(12) });
    let (v, a) = revolved(12, &[dvec2(0., 0.), dvec2(5., 0.), dvec2(2., 9.), dvec2(0., 9.)]);
    check("cone", &m, cone, v, a);
    let spike = m.add(Node::Cone { r1: 5., r2: 0., h: 9., sides: Some(12) });
    let (v, a) = revolved(12, &[dvec2(0., 0.), dvec2(5., 0.), dvec2(0., 9.)]);
    check("spike", &m, spike, v, a);
    let sphere = m.add(Node::Sphere { r: 6., sides: Some(15) });
    let ring = |i: u32| polar(6., -90. + (f64::from(i) + 0.5) * 180. / 8.);
    let mut outline: Vec<DVec2> = (0..8).map(ring).collect();
    outline.push(dvec2(0., outline[7].y));
    outline.push(dvec2(0., outline[0].y));
    let (v, a) = revolved(15, &outline);
    check("sphere", &m, sphere, v, a);
    let torus = m.add(Node::Torus { major: 10., minor: 3., sides: Some(9) });
    let tube: Vec<DVec2> = (0..9).map(|i| dvec2(10., 0.) + polar(3., 40. * f64::from(i))).collect();
    let (v, a) = revolved(9, &tube);
    if let Some(export) = check("torus", &m, torus, v, a) {
        assert!(export.has([13., 0., 0.]));
    }
}

#[test]
fn true_curves_keep_to_the_tolerance() {
    let mut m = Model::default();
    let ball = m.add(Node::Sphere { r: 10., sides: None });
    let Some(export) = export("ball", &m, ball) else { return };
    let volume = 4.0 / 3.0 * PI * 1000.0;
    let shell = 4.0 * PI * 100.0 * Tolerance::DEFAULT.mm();
    assert!(export.volume < volume && export.volume > volume - shell, "{}", export.volume);
}

#[test]
fn extrusions_scale_and_twist_to_the_right() {
    let mut m = Model::default();
    let square = m.rect(10., 6.);
    let scale = dvec2(0.5, 0.25);
    let taper = m.add(Node::Extrude { profile: square, height: 8., twist: 0., scale });
    // Sections are 10 (1 - t/2) by 6 (1 - 3t/4).
    let volume = 8. * (60. - 37.5 + 7.5);
    let sides = 2. * (15. / 2. * dvec2(8., 2.25).length() + 7.5 / 2. * dvec2(8., 2.5).length());
    check("taper", &m, taper, volume, 60. + 7.5 + sides);
    let plate = m.add(Node::Extrude { profile: square, height: 8., twist: 30., scale: DVec2::ONE });
    if let Some(export) = export("twist", &m, plate) {
        let corner = DVec2::from_angle(PI / 6.).rotate(dvec2(5., 3.));
        assert!(export.has([corner.x, corner.y, 8.]));
        let lateral = 8. * 32. * Tolerance::DEFAULT.mm();
        assert!((export.volume - 480.).abs() < lateral, "{}", export.volume);
    }
}

#[test]
fn revolutions_start_on_x() {
    let mut m = Model::default();
    let rect = m.rect(4., 6.);
    let profile = m.at(rect, [10., 1., 0.]);
    let outline = [dvec2(8., -2.), dvec2(12., -2.), dvec2(12., 4.), dvec2(8., 4.)];
    let full = m.add(Node::Revolve { profile, angle: 360., sides: Some(5) });
    let (v, a) = revolved(5, &outline);
    if let Some(export) = check("ring", &m, full, v, a) {
        assert!(export.has([12., 0., 4.]));
    }
    let part = m.add(Node::Revolve { profile, angle: 90., sides: Some(16) });
    let (v, a) = revolved(16, &outline);
    if let Some(export) = check("quarter", &m, part, v / 4., a / 4. + 48.) {
        assert!(export.has([12., 0., 4.]) && export.has([0., 12., -2.]));
    }
}

#[test]
fn a_revolution_sees_the_coordinates_in_the_plane_of_a_turned_profile() {
    let mut m = Model::default();
    let rect = m.rect(4., 6.);
    let up = m.turned(rect, DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y));
    let profile = m.at(up, [10., 7., 1.]);
    let ring = m.add(Node::Revolve { profile, angle: 360., sides: Some(8) });
    let outline = [dvec2(8., -2.), dvec2(12., -2.), dvec2(12., 4.), dvec2(8., 4.)];
    let (v, a) = revolved(8, &outline);
    if let Some(export) = check("turned_ring", &m, ring, v, a) {
        assert!(export.has([12., 0., 4.]) && export.has([8., 0., -2.]));
    }
}

#[test]
fn set_operations_with_coplanar_faces() {
    let mut m = Model::default();
    let a = m.cuboid([0., 0., 0.], [10., 10., 10.]);
    let b = m.cuboid([10., 0., 0.], [20., 10., 5.]);
    let both = m.add(Node::Union([a, b].into()));
    check("step", &m, both, 1500., 2. * (100. + 200. + 150.));
    let hole = m.cuboid([2., 2., 0.], [8., 8., 10.]);
    let frame = m.add(Node::Difference([both, hole].into()));
    check("frame", &m, frame, 1140., 900. - 72. + 240.);
    let c = m.cuboid([5., 5., 0.], [15., 15., 10.]);
    // 28 - 2.4 + 2.4 is not 28; the cut must end flush all the same.
    let block = m.cuboid([0., 0., 0.], [10., 10., 28.]);
    let cut = m.cuboid([2., 2., 2.4], [8., 8., 28.]);
    let cup = m.add(Node::Difference([block, cut].into()));
    check("cup", &m, cup, 2800. - 36. * 25.6, 200. + 1120. + 24. * 25.6);
    let common = m.add(Node::Intersection([a, c].into()));
    check("common", &m, common, 250., 2. * (25. + 50. + 50.));
    let far = m.at(b, [0., 0., 5.]);
    let hull = m.add(Node::Hull([a, far].into()));
    check("hull", &m, hull, 1750., 350. + 10. * (45. + 125f64.sqrt()));
}

#[test]
fn placements_colours_names_and_shared_shapes() {
    let mut m = Model::default();
    let cuboid = m.cuboid([0., 0., 0.], [1., 2., 3.]);
    let shear = DMat3::from_cols(DVec3::X, dvec3(0.5, 1., 0.), dvec3(0., 0., -2.));
    let sheared = m.turned(cuboid, shear);
    let post = m.add(Node::Tag { name: "a post".into(), child: sheared });
    let away = m.at(post, [10., 0., 0.]);
    let red = m.add(Node::Paint { color: Color { r: 255, g: 0, b: 51 }, child: away });
    let both = m.add(Node::Union([post, red].into()));
    // 1 by 6 walls at the front and back, slanted ones of length sqrt(5) at the sides.
    let area = 2. * (2. * 2. + 2. * 6. + 2. * 5f64.sqrt() * 6.);
    check("posts", &m, both, 24., area);
    let source = scad::write(&m.0, &[("posts", both)], Tolerance::DEFAULT, &Fixed).unwrap();
    assert!(source.contains("module tag_a_post() {") && source.contains("color([1, 0, 0.2]) {"));
    assert_eq!(source.matches("cube(").count(), 1);
    let nothing = m.add(Node::Empty(Kind::Solid));
    let same = m.add(Node::Union([both, nothing].into()));
    check("posts_and_nothing", &m, same, 24., area);
}

#[test]
fn plane_figures() {
    let mut m = Model::default();
    let (square, disc) = (m.rect(20., 20.), m.circle(5., 24));
    let ring = m.add(Node::Difference([square, disc].into()));
    let smaller = m.add(Node::OffsetProfile { profile: square, d: -2. });
    let common = m.add(Node::Intersection([ring, smaller].into()));
    let plate = m.extrude(common, 2.);
    let (hole, rim) = (25. * ngon(24), 24. * 10. * sin_deg(7.5));
    check("plate", &m, plate, 2. * (256. - hole), 2. * (256. - hole) + 2. * (64. + rim));
    let corners = |r: f64| vec![dvec2(-r, -r), dvec2(r, -r), dvec2(r, r), dvec2(-r, r)];
    let holes: Arc<[Arc<[DVec2]>]> = [corners(3.).into()].into();
    let frame = m.add(Node::Polygon { points: corners(5.).into(), holes });
    let frame = m.extrude(frame, 4.);
    check("picture_frame", &m, frame, 256., 2. * 64. + 4. * (40. + 24.));
    let oval = m.add(Node::Ellipse { radii: dvec2(6., 3.), sides: Some(40) });
    let oval = m.extrude(oval, 10.);
    let corner = |i: u32| polar(1., 9. * f64::from(i)) * dvec2(6., 3.);
    let rim: f64 = (0..40).map(|i| corner(i).distance(corner(i + 1))).sum();
    check("oval", &m, oval, 180. * ngon(40), 36. * ngon(40) + 10. * rim);
    let rounded = m.add(Node::RoundProfile { profile: square, r: 3. });
    let rounded = m.extrude(rounded, 1.);
    if let Some(export) = export("rounded", &m, rounded) {
        let (volume, arcs) = (400. - 9. * (4. - PI), 6. * PI * Tolerance::DEFAULT.mm());
        assert!((export.volume - volume).abs() < 2. * arcs, "{}", export.volume);
    }
}

#[test]
fn profiles_out_of_xy_are_extruded_along_their_normal() {
    let mut m = Model::default();
    let (square, disc) = (m.rect(6., 4.), m.circle(1., 8));
    let up = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
    let (square, disc) = (m.turned(square, up), m.turned(disc, up));
    let disc = m.at(disc, [1., 0., 1.]);
    let plate = m.add(Node::Difference([square, disc].into()));
    let plate = m.at(plate, [0., 5., 0.]);
    let plate = m.extrude(plate, 3.);
    let (hole, rim) = (ngon(8), 16. * sin_deg(22.5));
    let area = 2. * (24. - hole) + 3. * (20. + rim);
    if let Some(export) = check("upright", &m, plate, 3. * (24. - hole), area) {
        // The normal of the turned plane is -y.
        assert!(export.has([3., 2., 2.]) && export.has([3., 5., 2.]) && export.has([2., 2., 1.]));
    }
}

#[test]
fn what_openscad_has_no_word_for_is_written_as_points() {
    let mut m = Model::default();
    let wedge = m.add(Node::ImportSolid { file: "wedge.stl".into(), heal: None });
    check("wedge", &m, wedge, 4., 6. + 3. + 4. + 61f64.sqrt());
    let text = Arc::new(TextSpec {
        text: "o".into(),
        size: 10.,
        font: None,
        halign: HorizontalAlign::Center,
        valign: VerticalAlign::Center,
    });
    let text = m.add(Node::Text(text));
    let text = m.extrude(text, 2.);
    check("text", &m, text, 168., 168. + 2. * 56.);
    let figure = m.add(Node::ImportProfile { file: "logo.svg".into() });
    let figure = m.extrude(figure, 1.);
    check("figure", &m, figure, 84., 168. + 56.);
}

#[test]
fn a_tree_of_ten_thousand_levels_does_not_exhaust_the_stack() {
    let mut m = Model::default();
    let mut tower = m.cuboid([0., 0., 0.], [1., 1., 1.]);
    for i in 0..10_000 {
        let next = m.cuboid([0., 0., f64::from(i) + 1.], [1., 1., f64::from(i) + 2.]);
        tower = m.add(Node::Union([tower, next].into()));
    }
    let source = scad::write(&m.0, &[("tower", tower)], Tolerance::DEFAULT, &Fixed).unwrap();
    assert_eq!(source.matches("cube(").count(), 10_001);
    assert!(source.len() < 2_000_000, "{}", source.len());
}
