//! The scene as the eye has it: faces that hide, edges that may be drawn.

use std::ops::Range;

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;

use super::{
    Camera,
    cells::around,
    field::{Curve, Field},
    folded::Folded,
    frustum::{Visible, before_eye, is_near},
    lattice::{Lattice, Plane},
    links::{self, Link, NONE, links},
    mesh_contour::{add_contours, bent_faces, loose_faces, steady_normals},
    patches::faithful_origins,
    pieces::{Homes, Sides},
    round::Bow,
    scene::{Kind, Options, Scene, Stroke},
    smooth,
    thread::{Thread, threads},
};
use crate::geom::{Bounds, FaceRef, PolyMesh, Surface, bvh::Bvh};

/// A point nearer than this part of the scene's size to a face's plane lies in it: set operations round
/// points to 2^-29 of the size, and a plane through rounded points misses others by a few times that.
const CONTACT: f64 = 1.0 / (1u64 << 26) as f64;

/// Spans of edges shorter than this part of the picture are rounding: 64 lattice steps and more.
const DUST: f64 = 1.0 / (1u64 << 38) as f64;

/// Spans of edges longer than this part of the picture are no specks, however far chords may be off.
const SPECK: f64 = 1e-3;

/// A face whose picture is thinner than [`CONTACT`] is seen edge-on where the sine of the angle to the sight line is
/// below this; others are small.
const EDGE_ON: f64 = 1e-6;

/// Faces narrower than so many times the size of contact have no normal that tells how they are seen.
const WIDE: f64 = 1e4;

/// What is magnified more than this is behind the plane before the eye in which the picture ends.
const MOST_MAGNIFIED: f64 = 200.0;

/// Chords are this part of the modeller's tolerance off their curve at most.
pub const CHORD: f64 = 0.25;

/// Bodies of more faces are not treated as convex: asking grows with the square, and so does each comparison.
const MOST_CONVEX: usize = 32;

/// Faces whose unit normals differ by less than this meet smoothly: rounded corners turn a plane of a few
/// percent of the scene's size by 1e-7.
const FLAT: f64 = 1e-6;

/// Facets of one smooth surface meet in an edge where the surface is folded over itself: where the cosine of the angle
/// between them is below this. Tolerances as large as a radius make corners of less than a right angle.
pub const FOLDED: f64 = 0.0;

/// A face that hides what is behind it.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    /// Its plane, in front towards the eye.
    pub plane: Plane,
    /// Its sides: a range of [`Model::sides`].
    pub sides: [u32; 2],
    /// Corners of its box on the lattice.
    pub min: DVec2,
    /// See `min`.
    pub max: DVec2,
    /// The true surface it stands for: a place in [`Model::fields`], or [`NONE`].
    pub field: u32,
    /// A corner where that surface has a normal, as a cone has none at its apex.
    pub corner: u32,
    /// Whether it is one of a surface that is known by its facets alone, or goes on smoothly into one.
    pub loose: bool,
}

/// A line that is drawn where nothing hides it.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Its ends.
    pub a: u32,
    /// See `a`.
    pub b: u32,
    /// What it stands for.
    pub kind: Kind,
    /// The caller's number of its body or stroke.
    pub id: u32,
    /// The curve it is a chord of: a place in [`Model::curves`], or [`NONE`].
    pub curve: u32,
    /// Whether no face beside it is in front.
    pub back: bool,
    /// Whether a face beside it is known by its facets alone: then it is known no better than chords may be off.
    pub loose: bool,
}

/// A body as ranges of the model's lists.
#[derive(Clone, Debug)]
pub struct Hull {
    /// Its points.
    pub points: Range<usize>,
    /// Its facets.
    pub facets: Range<usize>,
    /// Its outlines.
    pub outlines: Range<usize>,
    /// Its edges.
    pub edges: Range<usize>,
    /// Corners of its picture's box on the lattice.
    pub min: DVec2,
    /// See `min`.
    pub max: DVec2,
    /// Whether it is a convex polyhedron.
    pub convex: bool,
    /// Whether its box reaches into that of another body.
    pub reached: bool,
}

/// A side of a facet across which hiding begins or ends: not shared with another facet.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// Its ends; the facet is on the left.
    pub a: u32,
    /// See `a`.
    pub b: u32,
    /// The facet.
    pub facet: u32,
    /// The curve it is a chord of: a place in [`Model::curves`], or [`NONE`].
    pub curve: u32,
}

/// Points, hiding faces, lines to draw.
#[derive(Clone, Debug)]
pub struct Model {
    /// Points on the picture's lattice.
    pub at: Vec<DVec2>,
    /// The same points in space.
    pub space: Vec<DVec3>,
    /// Their magnification.
    pub gain: Vec<f64>,
    /// Faces that hide.
    pub facets: Vec<Facet>,
    /// Directed sides of facets.
    pub sides: Vec<[u32; 2]>,
    /// Where hiding begins and ends.
    pub outlines: Vec<Outline>,
    /// Lines to draw.
    pub edges: Vec<Edge>,
    /// The bodies.
    pub hulls: Vec<Hull>,
    /// True surfaces of facets.
    pub fields: Vec<Field>,
    /// True curves of edges and outlines.
    pub curves: Vec<Curve>,
    /// Points where a chain of chords is cut although it goes on: cusps of contours and
    /// apexes of cones.
    pub cusps: Vec<u32>,
    /// Strokes that are arcs.
    pub bows: Vec<Bow>,
    /// Ends of edges that are drawn elsewhere than they are hidden, by their number, mm.
    pub moved: FxHashMap<usize, [DVec2; 2]>,
    /// Lines on curved grids.
    pub threads: Vec<Thread>,
    /// Where the facets of curved grids come from.
    pub homes: Homes,
    /// The camera.
    pub camera: Camera,
    /// Picture to lattice.
    pub lattice: Lattice,
    /// Largest distance from a plane that is contact, mm.
    pub contact: f64,
    /// How far chords may be off their curve, mm.
    pub bound: f64,
    /// Largest length of a span that is dust, steps.
    pub dust: f64,
}

/// What is known of the faces of one mesh.
struct Faces {
    /// Unit normals, outwards.
    normals: Vec<DVec3>,
    /// Twice their areas, mm^2.
    sizes: Vec<f64>,
    /// The same normals without those of narrow facets; empty where all are flat or round.
    steady: Vec<DVec3>,
    /// The sign of their picture's area: positive when they face the eye.
    area: Vec<f64>,
    /// The facet each became, or [`NONE`].
    facet: Vec<u32>,
}

impl Model {
    /// The model of what is before the eye.
    pub fn new(scene: &Scene, camera: &Camera, options: &Options) -> Model {
        let (bodies, strokes) = before_eye(scene, camera, options.crease);
        let grids = folded_grids(scene, camera, options);
        let mut model = Model::placed(&bodies, &strokes, &grids, camera, options);
        let mut base = 0;
        for body in &bodies {
            let starts = [model.facets.len(), model.outlines.len(), model.edges.len()];
            let links = links(&body.mesh);
            let round = faithful_origins(&body.mesh, &links, options.tolerance);
            let known = (&links[..], &round[..]);
            let smooth = smooth::add_body(&mut model, body, base, known);
            let convex = !smooth && model.add_body(body, base, known);
            let end = base + body.mesh.points.len() as u32;
            model.add_hull(base as usize..end as usize, starts, convex);
            base = end;
        }
        let lines: u32 = strokes.iter().map(|s| s.points.len() as u32).sum();
        model.add_grids(grids, base + lines);
        model.mark_reached();
        for stroke in &strokes {
            let corners = base..base + stroke.points.len() as u32;
            let first = model.edges.len();
            model.bows.extend(stroke.round.map(|round| Bow::new(round, &stroke.points, first)));
            for (a, b) in corners.clone().zip(corners.skip(1)) {
                model.edges.push(Edge {
                    a,
                    b,
                    kind: stroke.kind,
                    id: stroke.id,
                    curve: NONE,
                    back: false,
                    loose: false,
                });
            }
            base += stroke.points.len() as u32;
            let images: Vec<DVec2> = stroke.drawn.iter().map(|p| camera.image(*p).0).collect();
            let ends = images.windows(2).map(|pair| [pair[0], pair[1]]);
            model.moved.extend((first..).zip(ends));
        }
        model
    }

    /// All points in space and on the lattice.
    fn placed(
        bodies: &[Visible],
        strokes: &[Stroke],
        grids: &[(Folded, u32)],
        camera: &Camera,
        options: &Options,
    ) -> Model {
        let corners = bodies.iter().flat_map(|b| &b.mesh.points);
        let ends = strokes.iter().flat_map(|s| &s.points);
        // Points of the cut before the eye are a rounding error behind it.
        let before = |p: &DVec3| {
            let seen = (0.0..MOST_MAGNIFIED).contains(&camera.magnification(*p));
            if seen { *p } else { camera.target() }
        };
        let knots = grids.iter().flat_map(|g| &g.0.points);
        let space: Vec<DVec3> = corners.chain(ends).chain(knots).map(before).collect();
        let images: Vec<(DVec2, f64)> = space.iter().map(|p| camera.image(*p)).collect();
        let (min, max) = around(images.iter().map(|i| i.0));
        let lattice = Lattice::around(min, max);
        let size = space.iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
        Model {
            at: images.iter().map(|i| lattice.place(i.0)).collect(),
            gain: images.iter().map(|i| i.1).collect(),
            space,
            facets: vec![],
            sides: vec![],
            outlines: vec![],
            edges: vec![],
            hulls: vec![],
            fields: vec![],
            curves: vec![],
            cusps: vec![],
            bows: vec![],
            moved: FxHashMap::default(),
            threads: vec![],
            homes: Homes::default(),
            camera: *camera,
            lattice,
            contact: size * CONTACT,
            bound: options.tolerance.mm() * CHORD,
            dust: lattice.steps((max - min).max_element().max(0.0)) * DUST,
        }
    }

    /// Adds curved grids, whose points begin at a number.
    fn add_grids(&mut self, grids: Vec<(Folded, u32)>, mut base: u32) {
        self.homes.first = self.facets.len();
        for (mut folded, id) in grids {
            let sides = Sides::of(&folded.pieces);
            let starts = [base, self.homes.triangles.len() as u32];
            self.add_folded(&folded, &sides, base);
            base += folded.points.len() as u32;
            self.threads.extend(threads(&mut folded, &sides, id, starts));
        }
    }

    /// Notes what a body brought; `starts` are the lengths of facets, outlines and edges before it.
    pub fn add_hull(&mut self, points: Range<usize>, starts: [usize; 3], convex: bool) {
        let (min, max) = around(self.at[points.clone()].iter().copied());
        let [facets, outlines, edges] = starts;
        self.hulls.push(Hull {
            points,
            facets: facets..self.facets.len(),
            outlines: outlines..self.outlines.len(),
            edges: edges..self.edges.len(),
            min,
            max,
            convex,
            reached: false,
        });
    }

    /// Marks bodies whose boxes reach into each other: their edges may run through faces.
    fn mark_reached(&mut self) {
        let boxes: Vec<Bounds> = self
            .hulls
            .iter()
            .map(|h| Bounds::of(self.space[h.points.clone()].iter().copied()).grown(-self.contact))
            .collect();
        if boxes.len() > 1 {
            Bvh::new(&boxes).self_pairs(|a, b| {
                self.hulls[a as usize].reached = true;
                self.hulls[b as usize].reached = true;
            });
        }
    }

    /// Adds a body whose facets stand for themselves; whether it is convex.
    fn add_body(&mut self, body: &Visible, base: u32, (links, round): (&[Link], &[bool])) -> bool {
        let (mesh, id) = (&*body.mesh, body.id);
        let open = links.iter().any(|l| l.right == NONE && !body.is_cut(l.a, l.b));
        let mut faces = self.add_facets(mesh, base, open);
        let tolerance = self.bound / CHORD;
        let known = (&faces.normals[..], &faces.sizes[..]);
        let bent = bent_faces(mesh, links, known, tolerance);
        if bent.contains(&true) {
            faces.steady = steady_normals(mesh, links, known, &bent, tolerance);
        }
        let faces = faces;
        let inner = |link: &Link| {
            let sides = [link.left, link.right];
            let bends = link.right != NONE && sides.iter().any(|&f| bent[f as usize]);
            !open && bends && !is_sharp(mesh, link, &faces, round, body.crease)
        };
        let inner: Vec<bool> = links.iter().map(inner).collect();
        if inner.contains(&true) {
            let normal = |_: &Model, face: u32, _: u32| faces.normals[face as usize];
            add_contours(self, mesh, (base, id), (links, &inner), (&faces.steady, &bent), normal);
            for (face, loose) in loose_faces(links, &inner, &bent).into_iter().enumerate() {
                if faces.facet[face] != NONE {
                    self.facets[faces.facet[face] as usize].loose = loose;
                }
            }
        }
        for (link, inner) in links.iter().zip(&inner) {
            let turns = || kind(mesh, link, &faces, round, body.crease);
            let kind = if *inner { None } else { turns() };
            if let Some(kind) = kind.filter(|_| !body.is_cut(link.a, link.b)) {
                let (a, b) = (base + link.a, base + link.b);
                let hides = |f: u32| f != NONE && faces.facet[f as usize] != NONE;
                let back = !hides(link.left) && !hides(link.right);
                let is_bent = |f: u32| f != NONE && bent[f as usize];
                let loose = is_bent(link.left) || is_bent(link.right);
                self.edges.push(Edge { a, b, kind, id, curve: NONE, back, loose });
            }
            self.add_outlines(link, base, &faces);
        }
        !open && body.cut as usize == mesh.points.len() && self.is_convex(mesh, &faces.normals)
    }

    /// Whether all points of a mesh are behind the planes of all its faces. Bodies of many faces are not asked.
    fn is_convex(&self, mesh: &PolyMesh, normals: &[DVec3]) -> bool {
        mesh.face_count() <= MOST_CONVEX
            && mesh.faces().zip(normals).all(|(face, normal)| {
                let offset = normal.dot(mesh.points[face.outer()[0] as usize]);
                mesh.points.iter().all(|p| normal.dot(*p) - offset <= self.contact)
            })
    }

    /// Makes facets of the faces towards the eye, or of both sides of an open surface.
    fn add_facets(&mut self, mesh: &PolyMesh, base: u32, open: bool) -> Faces {
        let count = mesh.face_count();
        let mut faces = Faces {
            normals: Vec::with_capacity(count),
            sizes: Vec::with_capacity(count),
            steady: vec![],
            area: Vec::with_capacity(count),
            facet: Vec::with_capacity(count),
        };
        let mut area = vec![0.0; count];
        links::each_side(mesh, |face, a, b| {
            let (p, q) = (self.at[(base + a) as usize], self.at[(base + b) as usize]);
            area[face as usize] += p.x * q.y - p.y * q.x;
        });
        for (face, mut area) in mesh.faces().zip(area) {
            let size = face.area_vector();
            let normal = size.normalize_or_zero();
            faces.sizes.push(size.length());
            if self.is_edge_on(face, base, area, normal) {
                area = 0.0;
            }
            let hides = area > 0.0 || open && area < 0.0;
            faces.normals.push(normal);
            faces.area.push(area);
            faces.facet.push(if hides { self.facets.len() as u32 } else { NONE });
            if hides {
                self.add_facet(face, base, normal, area < 0.0);
            }
        }
        faces
    }

    /// Whether a face is seen as a line: its picture, of twice the area given, is as thin as set operations round
    /// corners. It may fold over itself, and its plane does not tell what is behind it.
    pub fn is_edge_on(&self, face: FaceRef, base: u32, area: f64, normal: DVec3) -> bool {
        let thin = self.dust * (CONTACT / DUST);
        let length = |p: DVec2| 2.0 * thin * p.max_element();
        let picture = DVec2::splat(self.dust / DUST);
        if area.abs() > length(picture) {
            return false;
        }
        let corners = || face.outer().iter().map(|&c| (base + c) as usize);
        let bounds = Bounds::of(corners().map(|c| self.space[c]));
        let size = (bounds.max - bounds.min).max_element();
        if face.area_vector().length() < WIDE * self.contact * size {
            return false;
        }
        let (min, max) = around(corners().map(|c| self.at[c]));
        let on = corners().next().map_or(DVec3::ZERO, |c| self.space[c]);
        let sine = normal.dot(self.camera.sight(on).normalize_or_zero());
        area.abs() <= length(max - min) && sine.abs() <= EDGE_ON
    }

    /// Makes a facet of a face with its normal outwards, `turned` if its back is towards the eye.
    fn add_facet(&mut self, face: FaceRef, base: u32, normal: DVec3, turned: bool) {
        let normal = if turned { -normal } else { normal };
        let first = self.sides.len();
        for corners in face.loops() {
            let before = corners[corners.len() - 1];
            corners.iter().fold(before, |before, &corner| {
                let side = [base + before, base + corner];
                self.sides.push(if turned { [side[1], side[0]] } else { side });
                corner
            });
        }
        let corners = self.sides[first..].iter();
        let (min, max) = around(corners.map(|s| self.at[s[1] as usize]));
        let corner = self.sides[first][0];
        let plane = Plane { normal, offset: normal.dot(self.space[corner as usize]) };
        let sides = [first as u32, self.sides.len() as u32];
        self.facets.push(Facet { plane, sides, min, max, field: NONE, corner, loose: false });
    }

    /// Adds a point.
    pub fn add_point(&mut self, p: DVec3) -> u32 {
        let (image, gain) = self.camera.image(p);
        self.at.push(self.lattice.place(image));
        self.gain.push(gain);
        self.space.push(p);
        self.at.len() as u32 - 1
    }

    /// Moves a point.
    pub fn move_point(&mut self, point: u32, p: DVec3) {
        let (image, gain) = self.camera.image(p);
        let i = point as usize;
        (self.at[i], self.gain[i], self.space[i]) = (self.lattice.place(image), gain, p);
    }

    /// An edge is an outline of the facets beside it, unless they go on into each other.
    fn add_outlines(&mut self, link: &Link, base: u32, faces: &Faces) {
        let area = |face: u32| if face == NONE { 0.0 } else { faces.area[face as usize] };
        let facet = |face: u32| if face == NONE { NONE } else { faces.facet[face as usize] };
        let (left, right) = (facet(link.left), facet(link.right));
        if left != NONE && right != NONE && area(link.left) * area(link.right) > 0.0 {
            return;
        }
        let (a, b) = (base + link.a, base + link.b);
        for (face, facet, a, b) in [(link.left, left, a, b), (link.right, right, b, a)] {
            if facet != NONE {
                let (a, b) = if area(face) > 0.0 { (a, b) } else { (b, a) };
                self.outlines.push(Outline { a, b, facet, curve: NONE });
            }
        }
    }

    /// What is shorter than this, mm, is a speck if it belongs to a line that is known no better than chords may be off: a
    /// gap so small between faces opens and closes with the facets, and whether it is there is not known. No feature goes
    /// with it: the lines of one are longer, all together, unless it is smaller than the facets tell.
    pub fn speck(&self) -> f64 {
        self.bound.min(self.picture_size() * SPECK)
    }

    /// Spans of an edge shorter than this are not told from rounding, steps.
    pub fn dust_of(&self, edge: &Edge) -> f64 {
        if edge.loose { self.lattice.steps(self.speck()).max(self.dust) } else { self.dust }
    }

    /// The larger side of the picture, mm.
    pub fn picture_size(&self) -> f64 {
        let size = self.dust / DUST / self.lattice.steps(1.0);
        let window = self.camera.window();
        window.map_or(size, |w| size.min((w.max - w.min).max_element()))
    }

    /// The place in space, 0 to 1 along a straight edge, of the point at t in the picture.
    pub fn place_in_space(&self, [a, b]: [u32; 2], t: f64) -> f64 {
        let [k, l] = [self.gain[a as usize] * (1.0 - t), self.gain[b as usize] * t];
        l / (k + l)
    }

    /// The point of a straight edge at t in the picture.
    pub fn point_on(&self, edge: &Edge, t: f64) -> DVec3 {
        let s = self.place_in_space([edge.a, edge.b], t);
        self.space[edge.a as usize].lerp(self.space[edge.b as usize], s)
    }

    /// Height of an edge's ends over a plane, each times its magnification, so that it is linear along the
    /// image; 0 in contact.
    #[inline]
    pub fn heights(&self, edge: &Edge, plane: &Plane) -> [f64; 2] {
        [edge.a, edge.b].map(|p| {
            let height = plane.distance(self.space[p as usize]);
            if height.abs() <= self.contact { 0.0 } else { height * self.gain[p as usize] }
        })
    }
}

/// The grids of a scene as the eye has them; those that reach too far are left out.
fn folded_grids<'a>(
    scene: &Scene<'a>,
    camera: &'a Camera,
    options: &Options,
) -> Vec<(Folded<'a>, u32)> {
    let bound = options.tolerance.mm() * CHORD;
    let near = scene.grids.iter().filter(|(grid, _)| grid.points().iter().all(is_near));
    near.map(|&(grid, id)| (Folded::new(grid, camera, bound), id)).collect()
}

/// What an edge is drawn as; `None` when it only parts facets of one surface.
fn kind(mesh: &PolyMesh, link: &Link, faces: &Faces, round: &[bool], crease: f64) -> Option<Kind> {
    if link.right == NONE {
        return Some(Kind::Border);
    }
    let [left, right] = [link.left as usize, link.right as usize];
    if (faces.area[left] > 0.0) != (faces.area[right] > 0.0) {
        return Some(Kind::Contour);
    }
    is_sharp(mesh, link, faces, round, crease).then_some(Kind::Sharp)
}

/// Whether two faces meet at an angle that is drawn.
fn is_sharp(mesh: &PolyMesh, link: &Link, faces: &Faces, round: &[bool], crease: f64) -> bool {
    let [left, right] = [link.left as usize, link.right as usize];
    let [one, other] = [left, right].map(|f| mesh.face(f));
    if one.plane() == other.plane() {
        return false;
    }
    let steady = if faces.steady.is_empty() { &faces.normals } else { &faces.steady };
    let cosine = steady[left].dot(steady[right]);
    let [s, t] = [one, other].map(|f| f.origin().surface);
    let [curved, bent] = [one, other].map(|f| round[f.origin_index() as usize]);
    let same = one.origin_index() == other.origin_index();
    match (s, t) {
        (Surface::Smooth, _) if same => cosine < FOLDED,
        (Surface::Smooth | Surface::Facets, _) | (_, Surface::Smooth | Surface::Facets) => {
            cosine < crease
        }
        _ if curved && bent => s != t,
        _ if curved || bent => true,
        _ => cosine <= 0.0 || faces.normals[left].cross(faces.normals[right]).length() > FLAT,
    }
}
