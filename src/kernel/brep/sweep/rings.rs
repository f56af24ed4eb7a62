//! Facets between rings of points.

use std::collections::BTreeMap;

use glam::DVec3;

use super::stations::Station;
use crate::{
    geom::{EdgeCurve, Form, Origin, PolyMesh, Surface},
    kernel::brep::{Polyhedron, band::add_point},
};

/// Points nearer than this part of the size are one.
const ONE: f64 = 1e-12;

/// What is swept by an edge over a run of steps: facets of one such surface share an origin.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    contour: usize,
    /// The edge, or the curve that it is of.
    edge: (u8, [u64; 3]),
    run: usize,
}

/// A contour that is swept.
pub(super) struct Swept<'a> {
    /// Its points at each station.
    pub stations: &'a [Station],
    /// For each edge the curve it stands for.
    pub curves: &'a [EdgeCurve],
    /// If the way is closed, how many points the last ring is turned against the first, whose place it takes.
    pub closing: Option<usize>,
}

/// What is between two stations.
#[derive(Clone, Copy)]
pub(super) struct Step {
    /// Steps of one run sweep one surface.
    pub run: usize,
    /// Whether edges are moved without a turn, so that each sweeps a plane.
    pub is_flat: bool,
}

/// A boundary while it is put together.
pub(super) struct Builder<'a> {
    mesh: PolyMesh,
    origins: BTreeMap<Key, u32>,
    flat: Option<u32>,
    contours: usize,
    size: f64,
    /// What a curve sweeps in a run.
    surface: &'a dyn Fn(usize, EdgeCurve) -> Surface,
    /// The parameter surface of that.
    form: &'a dyn Fn(&Part) -> Option<Form>,
}

/// What sweeps one surface: edges of a contour over a run of steps.
pub(super) struct Part {
    /// The number of the contour.
    pub contour: usize,
    /// The edges, which follow one another, each from its corner.
    pub edges: Vec<usize>,
    /// The run.
    pub run: usize,
}

impl<'a> Builder<'a> {
    pub fn new(
        size: f64,
        surface: &'a dyn Fn(usize, EdgeCurve) -> Surface,
        form: &'a dyn Fn(&Part) -> Option<Form>,
    ) -> Builder<'a> {
        let (mesh, origins) = (PolyMesh::default(), BTreeMap::new());
        Builder { mesh, origins, flat: None, contours: 0, size, surface, form }
    }

    /// Adds the facets of a contour, and gives its first and last ring.
    pub fn add(&mut self, swept: &Swept, steps: &[Step]) -> [Vec<u32>; 2] {
        let mut first: Vec<u32> = vec![];
        let mut before: Vec<u32> = vec![];
        let last = swept.stations.len() - 1;
        for (i, station) in swept.stations.iter().enumerate() {
            let ring = match swept.closing {
                Some(shift) if i == last => {
                    (0..first.len()).map(|j| first[(j + shift) % first.len()]).collect()
                }
                _ => self.ring(&station.points, &before),
            };
            if i == 0 {
                first.clone_from(&ring);
            } else {
                self.facets([&before, &ring], swept.curves, steps[i - 1]);
            }
            before = ring;
        }
        self.contours += 1;
        [first, before]
    }

    /// The numbers of a ring's points; one that stays where it was keeps its number, and so do neighbours at one place.
    fn ring(&mut self, points: &[DVec3], before: &[u32]) -> Vec<u32> {
        let mut ring: Vec<u32> = Vec::with_capacity(points.len());
        for (j, p) in points.iter().enumerate() {
            let is_at =
                |known: &&u32| self.mesh.points[**known as usize].distance(*p) <= ONE * self.size;
            let known = before.get(j).filter(is_at).or_else(|| ring.last().filter(is_at)).copied();
            let closing =
                if j + 1 == points.len() { ring.first().filter(is_at).copied() } else { None };
            let number = known.or(closing);
            ring.push(number.unwrap_or_else(|| add_point(&mut self.mesh, *p)));
        }
        ring
    }

    fn facets(&mut self, [lower, upper]: [&[u32]; 2], curves: &[EdgeCurve], step: Step) {
        for j in 0..curves.len() {
            let k = (j + 1) % curves.len();
            let corners = [lower[j], lower[k], upper[k], upper[j]];
            let origin = self.origin(j, curves, step);
            let mut apart = corners.to_vec();
            apart.dedup();
            if apart.len() > 1 && apart[0] == apart[apart.len() - 1] {
                apart.pop();
            }
            match apart[..] {
                [a, b, c, d] if !step.is_flat => {
                    let at = |i: u32| self.mesh.points[i as usize];
                    let straight = at(a).distance_squared(at(c)) <= at(b).distance_squared(at(d));
                    let halves =
                        if straight { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                    halves.iter().for_each(|half| self.facet(half, origin));
                }
                [_, _, _, ..] => self.facet(&apart, origin),
                _ => {}
            }
        }
    }

    fn facet(&mut self, corners: &[u32], origin: u32) {
        let plane = self.mesh.add_plane();
        self.mesh.push_face(&[corners], plane, origin);
    }

    fn origin(&mut self, edge: usize, curves: &[EdgeCurve], step: Step) -> u32 {
        let curve = curves[edge];
        let surface = (self.surface)(step.run, curve);
        if surface == Surface::Plane {
            return self.flat();
        }
        let key = Key { contour: self.contours, edge: number(edge, curve), run: step.run };
        let (mesh, form) = (&mut self.mesh, self.form);
        *self.origins.entry(key).or_insert_with(|| {
            let part = || Part { contour: key.contour, edges: chain(edge, curves), run: key.run };
            let form = if surface == Surface::Smooth { form(&part()) } else { None };
            mesh.add_origin(Origin { form, ..Origin::of(surface) })
        })
    }

    fn flat(&mut self) -> u32 {
        *self.flat.get_or_insert_with(|| self.mesh.add_origin(Origin::of(Surface::Plane)))
    }

    /// Adds a flat end: an outline and holes as they run where the way comes from below. Rings of one point need none.
    pub fn cap(&mut self, mut rings: Vec<Vec<u32>>, is_start: bool) {
        rings.iter_mut().for_each(|ring| {
            ring.dedup();
            if is_start {
                ring.reverse();
            }
        });
        rings.retain(|ring| ring.len() > 2);
        if !rings.is_empty() {
            let (plane, origin) = (self.mesh.add_plane(), self.flat());
            self.mesh.push_face(&rings, plane, origin);
        }
    }

    /// The solid.
    pub fn solid(self) -> Polyhedron {
        Polyhedron::trusted(self.mesh)
    }
}

/// What tells an edge, or the curve that it is of, from others of its contour.
fn number(edge: usize, curve: EdgeCurve) -> (u8, [u64; 3]) {
    match curve {
        EdgeCurve::Line => (0, [edge as u64, 0, 0]),
        EdgeCurve::Circle { center, radius } => (1, [center.x, center.y, radius].map(f64::to_bits)),
        EdgeCurve::Smooth(number) => (2, [u64::from(number), 0, 0]),
    }
}

/// The edges around one that are of the same curve, in order.
fn chain(edge: usize, curves: &[EdgeCurve]) -> Vec<usize> {
    let count = curves.len();
    let own = number(edge, curves[edge]);
    let same = |i: usize| number(i % count, curves[i % count]) == own;
    let back = (1..count).take_while(|k| same(edge + count - k)).count();
    let ahead = (1..count - back).take_while(|k| same(edge + k)).count();
    (0..=back + ahead).map(|k| (edge + count - back + k) % count).collect()
}
