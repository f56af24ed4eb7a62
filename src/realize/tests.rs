//! Shapes from graphs written by hand.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3, dvec3};

use super::*;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::{
    base::{Shelf, Span, watch::Unwatched},
    geom::mesh::Color,
    shape::Geometry,
};

/// A graph and what is made of it.
struct Bench {
    graph: ShapeGraph,
    realizer: Realizer<'static>,
}

impl Bench {
    fn new() -> Bench {
        Bench {
            graph: ShapeGraph::default(),
            realizer: Realizer::new(&Shelf(&[]), &Unwatched, None),
        }
    }

    fn add(&mut self, node: Node) -> ShapeId {
        self.graph.add(node, Span::default())
    }

    fn cube(&mut self, size: f64) -> ShapeId {
        self.add(Node::Box { min: DVec3::ZERO, max: DVec3::splat(size) })
    }

    fn moved(&mut self, child: ShapeId, v: DVec3) -> ShapeId {
        self.add(Node::Transform { placement: Placement::translation(v), child })
    }

    fn list(&mut self, make: fn(Arc<[ShapeId]>) -> Node, ids: &[ShapeId]) -> ShapeId {
        self.add(make(Arc::from(ids)))
    }

    fn volume(&self, id: ShapeId) -> f64 {
        self.realizer.measures(&self.graph, id).expect("made").volume
    }

    fn code(&self, id: ShapeId) -> Code {
        self.realizer.measures(&self.graph, id).expect_err("refused").diagnostic.code
    }
}

#[test]
fn set_operations_nest() {
    let mut bench = Bench::new();
    let (big, small) = (bench.cube(4.0), bench.cube(2.0));
    let far = bench.moved(small, DVec3::splat(3.0));
    let both = bench.list(Node::Union, &[big, far]);
    let cut = bench.list(Node::Difference, &[both, small]);
    assert_eq!(bench.volume(both), 64.0 + 8.0 - 1.0);
    assert_eq!(bench.volume(cut), 64.0 + 8.0 - 1.0 - 8.0);
}

#[test]
fn shared_growth_is_made_in_steps() {
    let mut bench = Bench::new();
    let mut shape = bench.cube(1.0);
    for i in 0..18 {
        let next = bench.moved(shape, dvec3(0.5 * f64::from(1 << i), 0.0, 0.0));
        shape = bench.list(Node::Union, &[shape, next]);
    }
    assert_eq!(bench.volume(shape), 0.5 * f64::from(1 << 18) + 0.5);
}

#[test]
fn tags_and_colours_reach_the_faces() {
    let mut bench = Bench::new();
    let (big, small) = (bench.cube(4.0), bench.cube(2.0));
    let (red, blue) = (Color { r: 9, g: 0, b: 0 }, Color { r: 0, g: 0, b: 9 });
    let small = bench.add(Node::Paint { color: red, child: small });
    let cut = bench.list(Node::Difference, &[big, small]);
    let cut = bench.add(Node::Paint { color: blue, child: cut });
    let cut = bench.add(Node::Tag { name: "cut".into(), child: cut });
    let solid = bench.realizer.solid(&bench.graph, cut).expect("made");
    let faces: Vec<_> = solid.polyhedron.mesh().faces().map(|f| f.origin().clone()).collect();
    assert!(faces.iter().all(|origin| origin.tags == ["cut".into()]));
    let count = |color| faces.iter().filter(|origin| origin.color == Some(color)).count();
    assert_eq!((count(red), count(blue)), (3, 6));
}

#[test]
fn an_empty_part_is_warned_of_with_both_boxes() {
    let mut bench = Bench::new();
    let (big, small) = (bench.cube(4.0), bench.cube(2.0));
    let gone = bench.list(Node::Difference, &[small, big]);
    let found = warnings(&bench.realizer, &bench.graph, gone);
    assert_eq!(found[0].code, Code::EmptyResult);
    assert!(found[0].notes[0].ends_with("x 0..2, y 0..2, z 0..2 mm"), "{:?}", found[0].notes);
    assert!(found[0].notes[1].ends_with("x 0..4, y 0..4, z 0..4 mm"), "{:?}", found[0].notes);
    assert_eq!(warnings(&bench.realizer, &bench.graph, big), []);
}

#[test]
fn profiles_keep_their_plane() {
    let mut bench = Bench::new();
    let upright = Placement::new(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y), DVec3::ZERO);
    let rect = bench.add(Node::Rect { size: DVec2::new(4.0, 2.0) });
    let standing = bench.add(Node::Transform { placement: upright, child: rect });
    let higher = bench.moved(standing, dvec3(0.0, 0.0, 2.0));
    let both = bench.list(Node::Union, &[standing, higher]);
    let plate =
        bench.add(Node::Extrude { profile: both, height: 5.0, twist: 0.0, scale: DVec2::ONE });
    let measures = bench.realizer.measures(&bench.graph, plate).expect("made");
    assert_eq!(measures.volume, 4.0 * 4.0 * 5.0);
    assert_eq!(measures.bounds, Some([dvec3(-2.0, -5.0, -1.0), dvec3(2.0, 0.0, 3.0)]));
    let mixed = bench.list(Node::Union, &[rect, standing]);
    assert_eq!(bench.code(mixed), Code::Degenerate);
}

#[test]
fn a_standing_profile_turns_about_its_own_vertical() {
    let mut bench = Bench::new();
    let upright = Placement::new(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y), DVec3::ZERO);
    let rect = bench.add(Node::Rect { size: DVec2::new(2.0, 2.0) });
    let lying = bench.moved(rect, dvec3(20.0, 0.0, 0.0));
    let standing = bench.add(Node::Transform { placement: upright, child: rect });
    let standing = bench.moved(standing, dvec3(20.0, 0.0, 0.0));
    let ring = |profile| Node::Revolve { profile, angle: 360.0, sides: Some(4) };
    let (one, other) = (bench.add(ring(lying)), bench.add(ring(standing)));
    assert_eq!(bench.volume(one), bench.volume(other));
}

#[test]
fn flat_and_endless_shapes_are_refused() {
    let mut bench = Bench::new();
    let cube = bench.cube(1.0);
    let flat = Placement::new(DMat3::from_diagonal(dvec3(1.0, 1.0, 0.0)), DVec3::ZERO);
    let flat = bench.add(Node::Transform { placement: flat, child: cube });
    assert_eq!(bench.code(flat), Code::Degenerate);
    let ball = bench.add(Node::Sphere { r: 1.0, sides: Some(1_000_000) });
    assert_eq!(bench.code(ball), Code::Limit);
}

/// A circle of radius 5 about (20, 0) becomes a torus: no point of its mesh may be farther from the true
/// one than the tolerance, though both the circle and its way around are made of chords.
#[test]
fn a_curve_that_is_bent_again_keeps_the_tolerance() {
    let mut bench = Bench::new();
    let circle = bench.add(Node::Ellipse { radii: DVec2::splat(5.0), sides: None });
    let profile = bench.moved(circle, DVec3::X * 20.0);
    let ring = bench.add(Node::Revolve { profile, angle: 360.0, sides: None });
    let solid = bench.realizer.solid(&bench.graph, ring).expect("made");
    let mesh = solid.polyhedron.mesh();
    let error = |p: DVec3| (DVec2::new(p.truncate().length() - 20.0, p.z).length() - 5.0).abs();
    let triangles = crate::geom::triangulate::triangulate(mesh);
    let middles = triangles.corners.iter().flat_map(|corners| {
        let [a, b, c] = corners.map(|corner| mesh.points[corner as usize]);
        [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0]
    });
    let worst = middles.map(error).fold(0.0, f64::max);
    assert!(worst <= bench.realizer.tolerance().mm(), "{worst}");
}

/// Counts the units that are made.
#[derive(Default)]
struct Counted(AtomicUsize);

impl Watch for Counted {
    fn enter(&self, _: Phase) {}
    fn leave(&self) {}
    fn expect(&self, _: usize) {}
    fn step(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
    fn stage(&self, _: &'static str) {}
}

/// A node is made once in a run: by whichever name, wherever it is placed, however often it is asked about.
#[test]
fn a_node_is_made_once() {
    let counted = Counted::default();
    let mut graph = ShapeGraph::default();
    let mut add = |node: Node| graph.add(node, Span::default());
    let cube = |low: f64| Node::Box { min: DVec3::splat(low), max: DVec3::splat(low + 2.0) };
    let (a, b) = (add(cube(0.0)), add(cube(1.0)));
    let cut = add(Node::Difference(Arc::new([a, b])));
    let again = add(Node::Difference(Arc::new([a, b])));
    let moved =
        |child, x| Node::Transform { placement: Placement::translation(DVec3::X * x), child };
    let copies = [0.0, 5.0, 10.0, 15.0].map(|x| add(moved(cut, x)));
    let row = add(Node::Union(Arc::new(copies)));
    assert_eq!(cut, again);
    let realizer = Realizer::new(&Shelf(&[]), &counted, None);
    let made = || counted.0.load(Ordering::Relaxed);
    let volume = |id| realizer.measures(&graph, id).expect("made").volume;
    assert_eq!((volume(cut), made()), (7.0, 3));
    assert_eq!((volume(copies[2]), made()), (7.0, 3));
    assert_eq!((volume(row), made()), (28.0, 4));
    assert_eq!((volume(row), volume(cut), made()), (28.0, 7.0, 4));
}
