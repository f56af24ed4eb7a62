//! Contours of surfaces that are known by their facets alone: where the normals of the facets' corners turn away from the
//! eye, and not where facets do.
//!
//! Facets of a surface without a closed form turn away from the eye in a zigzag, whose pieces lie over each other in the
//! picture. So corners get the normal of the surface, the mean of the facets around them up to the next edge, and the
//! contour runs through a facet from side to side where the normal between two corners is square to the sight line; sides
//! are bent as the normals at their ends ask for. What hides are the facets: a point of the contour is asked for so
//! far outside the surface that the facets around it are not before it. Faces that are known better are asked where it is.
//!
//! Source: A. Hertzmann and D. Zorin, Illustrating smooth surfaces, 2000; the bent sides are those of A. Vlachos and others,
//! Curved PN triangles, 2001.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

use super::{
    Camera,
    links::{Link, NONE},
    model::{CHORD, Model},
    scene::Kind,
    thread::{Knot, Thread},
};
use crate::geom::{FaceRef, PolyMesh, Surface, triangulate::triangulate_face};

/// A surface is seen edge-on where the sine of the angle to the sight line is below this: rounding of small facets' corners
/// turns upright walls by that.
const EDGE_ON: f64 = 1e-5;

/// Where a flat or round face goes on smoothly into facets, its normal differs from theirs by no more than this, a cosine:
/// facets turn by about as much from one to the next.
const GOES_ON: f64 = 0.98;

/// A facet that is so many times as long as it is wide, and narrower than chords may be off, has no normal of its own.
const NARROW: f64 = 8.0;

/// A side is bent out by this part of its length at most: more asks for normals that facets do not have.
const MOST_BENT: f64 = 0.25;

/// Facets around a contour stick out by so many times as much as their sides are bent, at most.
const OUTSIDE: f64 = 2.0;

/// Facets before and after one that tell with it how the surface bends.
const FEW: usize = 3;

/// Facets of a surface that is made anew are off by no more than this part of the tolerance.
const KEPT: f64 = 1.5;

/// Whether faces, of which normals and twice the areas are given, are facets of a surface that is known by its facets alone,
/// and keep to it as drawings ask. Where neighbours
/// mostly turn so much that a surface through them would be farther off than `most` mm, they stand for themselves.
pub fn bent_faces(
    mesh: &PolyMesh,
    links: &[Link],
    (normals, sizes): (&[DVec3], &[f64]),
    most: f64,
) -> Vec<bool> {
    let is_known =
        |face: FaceRef| matches!(face.origin().surface, Surface::Smooth | Surface::Facets);
    let mut off: Vec<Vec<f64>> = vec![vec![]; mesh.origins().len()];
    if !mesh.origins().iter().any(|o| matches!(o.surface, Surface::Smooth | Surface::Facets)) {
        return vec![false; mesh.face_count()];
    }
    for link in links.iter().filter(|link| link.right != NONE) {
        let faces = [link.left, link.right].map(|f| mesh.face(f as usize));
        let origin = faces[0].origin_index();
        if !is_known(faces[0]) || origin != faces[1].origin_index() {
            continue;
        }
        let side = mesh.points[link.a as usize].distance(mesh.points[link.b as usize]);
        let across = |f: &FaceRef| {
            let sides = if f.outer().len() == 3 { 1.0 } else { 2.0 };
            sizes[f.index()] / (sides * side)
        };
        let wide: f64 = faces.iter().map(across).sum();
        let turn = normals[link.left as usize].distance(normals[link.right as usize]);
        // The height of an arc over a chord as wide as both facets are in the mean.
        off[origin as usize].push(turn * wide / 16.0);
    }
    let is_coarse = |mut off: Vec<f64>| {
        let middle = off.len() / 2;
        !off.is_empty() && *off.select_nth_unstable_by(middle, f64::total_cmp).1 > most * KEPT
    };
    let coarse: Vec<bool> = off.into_iter().map(is_coarse).collect();
    mesh.faces().map(|face| is_known(face) && !coarse[face.origin_index() as usize]).collect()
}

/// The unit normals of faces, of which normals and twice the areas are given, those of narrow bent faces as those of the face beyond their longest side: `width` mm of
/// rounding and chord errors turn them any way.
pub fn steady_normals(
    mesh: &PolyMesh,
    links: &[Link],
    (normals, sizes): (&[DVec3], &[f64]),
    bent: &[bool],
    width: f64,
) -> Vec<DVec3> {
    let narrow = |face: FaceRef| {
        let corners = face.outer();
        let side = |i: usize| {
            let next = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
            mesh.points[corners[i] as usize].distance_squared(mesh.points[next as usize])
        };
        let long = (0..corners.len()).map(side).fold(0.0, f64::max).sqrt();
        bent[face.index()] && sizes[face.index()] < long * width.min(long / NARROW)
    };
    let narrow: Vec<bool> = mesh.faces().map(narrow).collect();
    if !narrow.contains(&true) {
        return normals.to_vec();
    }
    let mut longest = vec![[(0.0, NONE); 2]; mesh.face_count()];
    let length = |link: &Link| mesh.points[link.a as usize].distance(mesh.points[link.b as usize]);
    for link in links.iter().filter(|link| link.right != NONE) {
        let length = length(link);
        for (face, other) in [(link.left, link.right), (link.right, link.left)] {
            let [first, second] = &mut longest[face as usize];
            if length > first.0 {
                (*first, *second) = ((length, other), *first);
            } else if length > second.0 {
                *second = (length, other);
            }
        }
    }
    let beyond = |face: u32| {
        let [(_, one), (_, other)] = longest[face as usize];
        let back = narrow[one as usize] && longest[one as usize][0].1 == face && other != NONE;
        if back && face < one { other } else { one }
    };
    let of = |face: usize| {
        let mut found = face as u32;
        for _ in 0..FARTHEST {
            if !narrow[found as usize] {
                return normals[found as usize];
            }
            found = beyond(found);
        }
        normals[face]
    };
    (0..mesh.face_count()).map(of).collect()
}

/// Narrow facets in a row, at most.
const FARTHEST: usize = 16;

/// Whether faces are bent or go on smoothly into bent ones; `joined` tells of each link whether it lies within one surface.
pub fn loose_faces(links: &[Link], joined: &[bool], bent: &[bool]) -> Vec<bool> {
    let mut loose = bent.to_vec();
    for (link, _) in links.iter().zip(joined).filter(|(_, joined)| **joined) {
        [link.left, link.right].iter().for_each(|&face| loose[face as usize] = true);
    }
    loose
}

/// Corners of bent faces, and the normals of the surface there.
struct Corners<'a> {
    mesh: &'a PolyMesh,
    /// The number of the first corner of each face, or [`NONE`] if it is not bent.
    starts: Vec<u32>,
    /// Another corner with the same normal, or the corner itself.
    fan: Vec<u32>,
    /// The normal of each fan at its first corner.
    normals: Vec<DVec3>,
    /// How far the surface is turned to the eye at the first corner of each fan: a sine, and 0 where it is seen edge-on.
    turned: Vec<f64>,
}

impl<'a> Corners<'a> {
    fn of(mesh: &'a PolyMesh, bent: &[bool]) -> Corners<'a> {
        let mut count = 0;
        let starts = mesh.faces().zip(bent).map(|(face, bent)| {
            let start = if *bent { count } else { NONE };
            count += if *bent { face.loops().map(|l| l.len() as u32).sum() } else { 0 };
            start
        });
        let starts = starts.collect();
        let fan = (0..count).collect();
        let normals = vec![DVec3::ZERO; count as usize];
        Corners { mesh, starts, fan, normals, turned: vec![0.0; count as usize] }
    }

    /// The corner of a bent face at a point.
    fn at(&self, face: u32, point: u32) -> Option<u32> {
        let start = self.starts[face as usize];
        let found = || self.mesh.face(face as usize).corners().iter().position(|&c| c == point);
        (start != NONE).then(found)?.map(|i| start + i as u32)
    }

    fn first(&mut self, mut corner: u32) -> u32 {
        while self.fan[corner as usize] != corner {
            let next = self.fan[self.fan[corner as usize] as usize];
            self.fan[corner as usize] = next;
            corner = next;
        }
        corner
    }

    /// Lets two bent faces have one normal at a point.
    fn join(&mut self, link: &Link, point: u32) {
        if let (Some(a), Some(b)) = (self.at(link.left, point), self.at(link.right, point)) {
            let (a, b) = (self.first(a), self.first(b));
            self.fan[a.max(b) as usize] = a.min(b);
        }
    }

    /// Lets every corner know the first one of its fan.
    fn settle(&mut self) {
        (0..self.fan.len() as u32)
            .for_each(|corner| self.fan[corner as usize] = self.first(corner));
    }

    /// Gives every fan the mean of its facets' normals, by their angles.
    fn add_normals(&mut self, normals: &[DVec3]) {
        let mesh = self.mesh;
        let way = |a: u32, b: u32| {
            (mesh.points[b as usize] - mesh.points[a as usize]).normalize_or_zero()
        };
        for face in mesh.faces().filter(|face| self.starts[face.index()] != NONE) {
            let mut corner = self.starts[face.index()] as usize;
            for points in face.loops() {
                let mut before = way(points[points.len() - 1], points[0]);
                for i in 0..points.len() {
                    let next = points[if i + 1 == points.len() { 0 } else { i + 1 }];
                    let after = way(points[i], next);
                    let weight = angle(-before.dot(after));
                    self.normals[self.fan[corner] as usize] += normals[face.index()] * weight;
                    before = after;
                    corner += 1;
                }
            }
        }
        self.normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
    }

    /// Finds how far the surface is turned to the eye at each fan; where one of its facets is seen edge-on, so is the surface.
    fn turn(&mut self, normals: &[DVec3], camera: &Camera) {
        let sights: Vec<DVec3> =
            self.mesh.points.iter().map(|p| camera.sight(*p).normalize_or_zero()).collect();
        let mut edge_on = vec![];
        for face in self.mesh.faces().filter(|face| self.starts[face.index()] != NONE) {
            let start = self.starts[face.index()];
            for (corner, &point) in (start..).zip(face.corners()) {
                let first = self.fan[corner as usize] as usize;
                let sight = sights[point as usize];
                if normals[face.index()].dot(sight).abs() < EDGE_ON {
                    edge_on.push(first);
                }
                if first == corner as usize {
                    let sine = self.normals[first].dot(sight);
                    self.turned[first] = if sine.abs() < EDGE_ON { 0.0 } else { sine };
                }
            }
        }
        edge_on.into_iter().for_each(|first| self.turned[first] = 0.0);
    }

    /// The normal of a face's surface at a point.
    fn normal(&self, face: u32, point: u32) -> DVec3 {
        let corner = self.at(face, point);
        corner.map_or(DVec3::ZERO, |c| self.normals[self.fan[c as usize] as usize])
    }

    /// How far a face's surface is turned to the eye at a point.
    fn turned(&self, face: u32, point: u32) -> f64 {
        self.at(face, point).map_or(0.0, |c| self.turned[self.fan[c as usize] as usize])
    }

    /// Whether a contour may pass a face: it is in front at some corners and not at others.
    fn is_mixed(&self, face: FaceRef) -> bool {
        let start = self.starts[face.index()];
        let front = |i: usize| self.turned[self.fan[start as usize + i] as usize] > 0.0;
        start != NONE && (1..face.corners().len()).any(|i| front(i) != front(0))
    }
}

/// An angle by its cosine, to four digits: it is but a weight (M. Abramowitz and I. Stegun, 1964, 4.4.45).
fn angle(cosine: f64) -> f64 {
    let x = cosine.abs().min(1.0);
    let series = 1.570_728_8 + x * (-0.212_114_4 + x * (0.074_261 - x * 0.018_729_3));
    let sharp = (1.0 - x).sqrt() * series;
    if cosine < 0.0 { PI - sharp } else { sharp }
}

/// A place where a contour passes a side.
#[derive(Clone, Copy, Debug)]
struct Passage {
    at: DVec3,
    normal: DVec3,
    /// The corner it is at, or [`NONE`].
    corner: u32,
    /// How far facets around it may be off.
    off: f64,
    /// The passages before and after it.
    beside: [u32; 2],
    /// How the surface bends along the sight line on the way to each of them: see [`Tracer::bend`].
    bends: [f64; 2],
}

/// Follows the contours of the bent faces of a body.
pub struct Tracer<'a, 'b> {
    model: &'a mut Model,
    corners: Corners<'b>,
    base: u32,
    passages: Vec<Passage>,
    /// Passages by side and face.
    known: FxHashMap<([u32; 2], u32), u32>,
}

/// Adds the contours of the bent faces of a body, whose points begin at `base`. `joined` tells of each link whether it lies
/// within one surface; `beside` is the normal of another face that goes on into bent ones, at a point of the mesh.
pub fn add_contours(
    model: &mut Model,
    mesh: &PolyMesh,
    (base, id): (u32, u32),
    (links, joined): (&[Link], &[bool]),
    (normals, bent): (&[DVec3], &[bool]),
    beside: impl Fn(&Model, u32, u32) -> DVec3,
) {
    let mut corners = Corners::of(mesh, bent);
    let inner = |link: &Link| [link.left, link.right].map(|f| bent[f as usize]);
    let joined = || links.iter().zip(joined).filter(|(_, joined)| **joined).map(|(link, _)| link);
    for link in joined().filter(|link| inner(link) == [true; 2]) {
        corners.join(link, link.a);
        corners.join(link, link.b);
    }
    corners.settle();
    corners.add_normals(normals);
    for link in joined() {
        let (face, other) = match inner(link) {
            [true, false] => (link.left, link.right),
            [false, true] => (link.right, link.left),
            _ => continue,
        };
        for point in [link.a, link.b] {
            let normal = beside(model, other, point);
            let corner = corners.at(face, point).map(|c| corners.fan[c as usize] as usize);
            if let Some(slot) = corner.map(|c| &mut corners.normals[c])
                && slot.dot(normal) > GOES_ON
            {
                *slot = normal;
            }
        }
    }
    corners.turn(normals, &model.camera);
    let mixed: Vec<bool> = mesh.faces().map(|face| corners.is_mixed(face)).collect();
    let mut tracer = Tracer { model, corners, base, passages: vec![], known: FxHashMap::default() };
    let is_mixed = |link: &&Link| [link.left, link.right].map(|f| mixed[f as usize]) == [true; 2];
    for link in joined().filter(is_mixed) {
        if let Some(passage) = tracer.passage(link.left, [link.a, link.b]) {
            tracer.known.insert((key(link.a, link.b), link.right), passage);
        }
    }
    for face in mesh.faces().filter(|face| mixed[face.index()]) {
        tracer.follow(face);
    }
    tracer.add_threads(id);
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Tracer<'_, '_> {
    fn space(&self, point: u32) -> DVec3 {
        self.model.space[(self.base + point) as usize]
    }

    /// How far a side of a face is bent out, mm.
    fn bent(&self, face: u32, [a, b]: [u32; 2]) -> f64 {
        let chord = self.space(a) - self.space(b);
        let turn = self.corners.normal(face, a) - self.corners.normal(face, b);
        let most = MOST_BENT * chord.length();
        (turn.dot(chord) / 8.0).clamp(-most, most)
    }

    /// The passage of the contour through a side of a face, if it passes there.
    fn passage(&mut self, face: u32, [a, b]: [u32; 2]) -> Option<u32> {
        let [s, t] = [a, b].map(|p| self.corners.turned(face, p));
        if (s > 0.0) == (t > 0.0) {
            return None;
        }
        let key = (key(a, b), face);
        if let Some(&known) = self.known.get(&key) {
            return Some(known);
        }
        let way = s / (s - t);
        let normal = self.corners.normal(face, a).lerp(self.corners.normal(face, b), way);
        let on = self.space(a).lerp(self.space(b), way);
        let normal = normal.reject_from(self.model.camera.sight(on)).normalize_or_zero();
        let at = on + normal * (self.bent(face, [a, b]) * 4.0 * way * (1.0 - way));
        let corner = [a, b].into_iter().zip([s, t]).find(|c| c.1 == 0.0).map_or(NONE, |c| c.0);
        self.passages.push(Passage {
            at,
            normal,
            corner,
            off: 0.0,
            beside: [NONE; 2],
            bends: [0.0; 2],
        });
        let number = self.passages.len() as u32 - 1;
        self.known.insert(key, number);
        Some(number)
    }

    /// Follows the contour through a face.
    fn follow(&mut self, face: FaceRef) {
        let number = face.index() as u32;
        let mut triangles = vec![];
        let loops: Vec<&[u32]> = face.loops().collect();
        triangulate_face(&self.corners.mesh.points, &loops, &mut triangles);
        for [a, b, c] in triangles {
            let sides = [[a, b], [b, c], [c, a]];
            let found: Vec<u32> =
                sides.into_iter().filter_map(|side| self.passage(number, side)).collect();
            if let &[p, q] = &found[..] {
                let off = sides.map(|side| self.bent(number, side).abs());
                let bend = self.bend(number, [a, b, c]);
                self.connect([p, q], off.into_iter().fold(0.0, f64::max), bend);
            }
        }
    }

    /// How the surface bends along the sight line in a facet that a contour runs through: how fast it turns to the eye on the
    /// way to the eye, 1/mm. Where that is negative, the sight line comes to the contour through the inside of the body, so
    /// that the contour is hidden (J. Koenderink, What does the occluding contour tell us about solid shape?, 1984).
    fn bend(&self, face: u32, corners: [u32; 3]) -> f64 {
        let [f, g, h] = corners.map(|p| self.corners.turned(face, p));
        let [a, b, c] = corners.map(|p| self.space(p));
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let slope =
            (v.cross(normal) * (g - f) + normal.cross(u) * (h - f)) / normal.length_squared();
        let sight = self.model.camera.sight(a + (u + v) / 3.0);
        let bend = slope.dot(sight.reject_from(normal).normalize_or_zero());
        if bend.is_finite() { bend } else { 0.0 }
    }

    fn connect(&mut self, [p, q]: [u32; 2], off: f64, bend: f64) {
        for (one, other) in [(p, q), (q, p)] {
            let passage = &mut self.passages[one as usize];
            passage.off = passage.off.max(off);
            if let Some(slot) = passage.beside.iter().position(|b| *b == NONE) {
                (passage.beside[slot], passage.bends[slot]) = (other, bend);
            }
        }
    }

    /// Makes threads of the passages that follow each other.
    fn add_threads(&mut self, id: u32) {
        let mut used = vec![false; self.passages.len()];
        let ends = |p: &Passage| p.beside[1] == NONE;
        let (mut starts, rest): (Vec<u32>, Vec<u32>) =
            (0..self.passages.len() as u32).partition(|&i| ends(&self.passages[i as usize]));
        starts.extend(rest);
        for start in starts {
            if !used[start as usize] {
                let run = self.run(start, &mut used);
                self.add_run(&run, id);
            }
        }
    }

    /// The passages from one on; the first one comes again at the end of a closed contour.
    fn run(&self, start: u32, used: &mut [bool]) -> Vec<u32> {
        let mut run = vec![start];
        used[start as usize] = true;
        loop {
            let last = run[run.len() - 1];
            let beside = self.passages[last as usize].beside;
            let Some(&next) = beside.iter().find(|&&b| b != NONE && !used[b as usize]) else {
                if run.len() > 2 && beside.contains(&start) {
                    run.push(start);
                }
                return run;
            };
            used[next as usize] = true;
            run.push(next);
        }
    }

    /// Adds a run of passages. From corner to corner it is straight, so that it falls together with the other end of an
    /// upright wall.
    fn add_run(&mut self, run: &[u32], id: u32) {
        let mut from = 0;
        for i in 1..run.len() {
            let [a, b] = [run[i - 1], run[i]].map(|p| self.passages[p as usize].corner);
            if a != NONE && b != NONE {
                self.add_curve(&run[from..i], id);
                from = i;
                if a != b {
                    let tangent = self.space(b) - self.space(a);
                    let knots = [i - 1, i].map(|k| Knot { tangent, ..self.knot(run, k, false) });
                    let thread = Thread::free(Kind::Contour, id, knots.to_vec(), &[false]);
                    self.model.threads.push(thread);
                }
            }
        }
        self.add_curve(&run[from..], id);
    }

    /// Adds a run of passages as a smooth curve, cut where its picture turns back. What is shorter than facets may be off is
    /// none of the surface.
    fn add_curve(&mut self, run: &[u32], id: u32) {
        let image = |&p: &u32| self.model.camera.image(self.passages[p as usize].at).0;
        let images: Vec<DVec2> = run.iter().map(image).collect();
        let turns_back =
            |i: &usize| (images[*i] - images[i - 1]).dot(images[i + 1] - images[*i]) < 0.0;
        let last = run.len() - 1;
        let cusps: Vec<usize> = (1..last.max(1)).filter(turns_back).collect();
        let sinks = self.sinks(run);
        let mut from = 0;
        for &to in cusps.iter().chain([&last]) {
            let cusp = |i: usize| cusps.binary_search(&i).is_ok();
            let length: f64 = images[from..=to].windows(2).map(|p| p[0].distance(p[1])).sum();
            if length > self.model.bound / CHORD {
                let knots = (from..=to).map(|i| self.knot(run, i, cusp(i))).collect();
                let thread = Thread::free(Kind::Contour, id, knots, &sinks[from..to]);
                self.model.threads.push(thread);
            }
            from = to;
        }
    }

    /// Whether each chord of a run is hidden by the surface it is on. Facets tell together how that bends, each as far as the
    /// contour runs in it: corners of slivers have no normals to go by.
    fn sinks(&self, run: &[u32]) -> Vec<bool> {
        let bend = |pair: &[u32]| {
            let passage = &self.passages[pair[0] as usize];
            let slot = passage.beside.iter().position(|b| *b == pair[1]);
            let length = passage.at.distance(self.passages[pair[1] as usize].at);
            slot.map_or(0.0, |slot| length.copysign(passage.bends[slot]))
        };
        let bends: Vec<f64> = run.windows(2).map(bend).collect();
        let around = |i: usize| &bends[i.saturating_sub(FEW)..(i + FEW + 1).min(bends.len())];
        (0..bends.len()).map(|i| around(i).iter().sum::<f64>() < 0.0).collect()
    }

    fn knot(&mut self, run: &[u32], i: usize, cusp: bool) -> Knot {
        let around = &run[i.saturating_sub(1)..(i + 2).min(run.len())];
        let off = around.iter().map(|&p| self.passages[p as usize].off).fold(0.0, f64::max);
        let Passage { at, normal, .. } = self.passages[run[i] as usize];
        let tangent = normal.cross(self.model.camera.sight(at));
        let outside = at + normal * (off * OUTSIDE + self.model.bound);
        let [point, _] = [outside, at].map(|p| self.model.add_point(p));
        Knot { point, drawn: Some(at), tangent, stops: false, cusp }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geom::Origin, output::drawing::links::links};

    #[test]
    fn narrow_facets_take_the_normal_of_those_beside_them() {
        // A square whose diagonal has a sliver with its corner lifted.
        let at = [[0., 0., 0.], [8., 0., 0.], [8., 8., 0.], [0., 8., 0.], [4., 4.001, 0.003]];
        let mut mesh = PolyMesh::with_points(at.map(DVec3::from).to_vec());
        let origin = mesh.add_origin(Origin::of(Surface::Facets));
        for face in [[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]] {
            let plane = mesh.add_plane();
            mesh.push_face(&[face], plane, origin);
        }
        let normals: Vec<DVec3> = mesh.faces().map(|f| f.area_vector().normalize()).collect();
        let links = links(&mesh);
        let sizes: Vec<f64> = mesh.faces().map(|f| f.area_vector().length()).collect();
        let steady = steady_normals(&mesh, &links, (&normals, &sizes), &[true; 4], 0.01);
        assert!(normals[1].z < 0.5 && steady[1] == DVec3::Z);
        assert_eq!(steady[2..], normals[2..]);
    }
}
