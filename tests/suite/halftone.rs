//! Half-tones: the cosine law, shadows on the ground, and the same bytes on any number of threads.

use glam::{DMat3, DQuat, DVec2, DVec3, EulerRot, dvec2, dvec3};
use katachi::{
    geom::{CurvedGrid, FaceRef, Placement, PolyMesh, Tolerance, trig::cos_deg},
    kernel::{
        brep::primitive::{cuboid, sphere, torus},
        profile::{self, TextOptions},
    },
    output::{
        drawing::{Camera, Scene, View, Window},
        halftone::{
            DotShape, Frame, Light, Mark, Picture, Screen, Sun, ground_shadow, guided, levels,
            lit_parts, overstrike, picture, png,
        },
        sheet::Lettering,
    },
};

use crate::random::Random;

fn frame(half: f64, pixels: f64) -> Frame {
    let window = Window { min: DVec2::splat(-half), max: DVec2::splat(half) };
    Frame::new(window, 25.4 * pixels / (2.0 * half)).expect("a small picture")
}

fn lit(meshes: &[&PolyMesh], camera: &Camera, suns: &[Sun], frame: &Frame) -> Picture {
    let light = Light { suns: suns.to_vec(), ground: Some(0.0) };
    picture(&Scene::of(meshes.iter().copied()), camera, &light, frame)
}

#[test]
fn a_ball_in_full_light_follows_the_cosine() {
    let ball = sphere(10.0, 200);
    let sun = Sun::new(DVec3::Z, 0.0).expect("a direction");
    let frame = frame(10.5, 1050.0);
    let picture = lit(&[ball.mesh()], &Camera::view(View::Top), &[sun], &frame);
    for step in 0..100 {
        let r = f64::from(step) / 100.0;
        let column = (f64::from(frame.size[0]) / 2.0 + r * 500.0) as u32;
        let row = frame.size[1] / 2;
        let place = frame.place(dvec2(f64::from(column) + 0.5, f64::from(row) + 0.5)) / 10.0;
        let cosine = (1.0 - place.length_squared()).max(0.0).sqrt();
        let tone = f64::from(picture.at(column, row)[0]);
        assert!((tone - cosine).abs() < 0.01, "at {r}: {tone} for {cosine}");
    }
}

/// The convex hull of points of the plane, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = vec![];
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - a) <= 1e-12
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut points.iter().copied());
    lower.extend(half(&mut points.iter().rev().copied()));
    lower
}

#[test]
fn the_shadow_of_a_box_is_the_hull_of_its_corners() {
    let cube = cuboid(dvec3(-3.0, -2.0, 0.0), dvec3(4.0, 5.0, 6.5));
    for toward in [dvec3(1.0, -1.0, 2.0), dvec3(-0.3, 0.7, 0.4), dvec3(0.0, 1.0, 1.0), DVec3::Z] {
        let sun = Sun::new(toward, 0.0).expect("a direction");
        let outline = ground_shadow(&Scene::of([cube.mesh()]), &sun, 0.0);
        assert_eq!(outline.len(), 1);
        let cast = |p: &DVec3| (*p - toward * (p.z / toward.z)).truncate();
        let hull = hull(cube.mesh().points.iter().map(cast).collect());
        assert_eq!(outline[0].len(), hull.len());
        for p in &outline[0] {
            let gap = hull.iter().map(|q| q.distance(p.truncate())).fold(f64::INFINITY, f64::min);
            assert!(gap < 1e-9 && p.z.abs() < 1e-12, "{p} is {gap} off");
        }
    }
}

#[test]
fn shadow_and_light_have_their_tones() {
    let cube = cuboid(dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, 10.0));
    let sun = Sun::new(dvec3(1.0, 0.0, 1.0), 0.2).expect("a direction");
    let frame = frame(20.0, 400.0);
    let picture = lit(&[cube.mesh()], &Camera::view(View::Top), &[sun], &frame);
    let tone = |x: f64, y: f64| {
        let at = frame.column_row(dvec2(x, y));
        picture.at(at.x as u32, at.y as u32)[0]
    };
    let top = 0.2 + 0.8 * std::f32::consts::FRAC_1_SQRT_2;
    assert!((tone(0.0, 0.0) - top).abs() < 1e-6);
    assert!((tone(-10.0, 0.0) - 0.2).abs() < 1e-6);
    assert_eq!((tone(-16.0, 0.0), tone(10.0, 0.0)), (1.0, 1.0));
    let dark = picture.pixels.iter().map(|p| 1.0 - f64::from(p[0])).sum::<f64>() / 100.0;
    let expected = 100.0 * f64::from(1.0 - top) + 100.0 * 0.8;
    assert!((dark - expected).abs() < 1e-2, "{dark} for {expected}");
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let (ball, cube) = (sphere(6.0, 40), cuboid(dvec3(2.0, 2.0, -7.0), dvec3(9.0, 8.0, 3.0)));
    let sun = Sun::new(dvec3(1.0, -1.0, 2.0), 0.1).expect("a direction");
    let camera = Camera::perspective(dvec3(30.0, -40.0, 25.0), DVec3::ZERO).expect("apart");
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            png(&lit(&[ball.mesh(), cube.mesh()], &camera, &[sun], &frame(20.0, 300.0)))
        })
    };
    assert!(made(1) == made(2));
}

impl Random {
    fn vector(&mut self) -> DVec3 {
        dvec3(self.next(), self.next(), self.next())
    }
}

/// A face of a scene.
struct Face {
    body: usize,
    number: usize,
    loops: Vec<Vec<DVec3>>,
    normal: DVec3,
}

fn faces(meshes: &[PolyMesh]) -> Vec<Face> {
    let of_body = |(body, mesh): (usize, &PolyMesh)| {
        let face = move |face: FaceRef| {
            let place = |l: &[u32]| l.iter().map(|&c| mesh.points[c as usize]).collect();
            let (loops, normal) =
                (face.loops().map(place).collect(), face.area_vector().normalize());
            Face { body, number: face.index(), loops, normal }
        };
        mesh.faces().map(face).collect::<Vec<_>>()
    };
    meshes.iter().enumerate().flat_map(of_body).collect()
}

fn edges(corners: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// Whether outlines in a plane go an odd number of times around a point of it.
fn holds(loops: &[Vec<DVec3>], p: DVec3, normal: DVec3) -> bool {
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |q: DVec3| ((q - p).dot(x), (q - p).dot(y));
    let above = |(a, b): &(DVec3, DVec3)| {
        let ((ax, ay), (bx, by)) = (flat(*a), flat(*b));
        (ay > 0.0) != (by > 0.0) && (ax - ay * (bx - ax) / (by - ay)) > 0.0
    };
    loops.iter().flat_map(|l| edges(l)).filter(above).count() % 2 == 1
}

/// Whether something is between a point and the sun.
fn is_shaded(p: DVec3, toward: DVec3, faces: &[Face]) -> bool {
    faces.iter().any(|face| {
        let along = face.normal.dot(toward);
        let ahead = (face.loops[0][0] - p).dot(face.normal) / along;
        along != 0.0 && ahead > 1e-7 && holds(&face.loops, p + toward * ahead, face.normal)
    })
}

/// The distance to the nearest edge.
fn gap(loops: &[Vec<DVec3>], p: DVec3) -> f64 {
    let to_edge = |(a, b): (DVec3, DVec3)| {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, t))
    };
    loops.iter().flat_map(|l| edges(l)).map(to_edge).fold(f64::INFINITY, f64::min)
}

/// How many points of a scene rays find in the light where there is shadow or the other way round, of how many.
fn wrong(meshes: &[PolyMesh], toward: DVec3, random: &mut Random) -> (usize, usize) {
    let faces = faces(meshes);
    let sun = Sun::new(toward, 0.0).expect("a direction");
    let parts = lit_parts(&Scene::of(meshes), &sun);
    let (mut wrong, mut asked) = (0, 0);
    for _ in 0..100 {
        let face = &faces[(random.next() * faces.len() as f64) as usize];
        let weights: Vec<f64> = face.loops[0].iter().map(|_| random.next()).collect();
        let sum: DVec3 = face.loops[0].iter().zip(&weights).map(|(p, w)| *p * *w).sum();
        let p = sum / weights.iter().sum::<f64>();
        let own = || parts.iter().filter(|l| (l.body, l.face) == (face.body, face.number));
        let near = own().map(|part| gap(&part.outline, p)).fold(gap(&face.loops, p), f64::min);
        if face.normal.dot(sun.toward()) < 1e-3 || near < 1e-6 {
            continue;
        }
        let shines = own().any(|part| holds(&part.outline, p, face.normal));
        asked += 1;
        wrong += usize::from(shines == is_shaded(p, sun.toward(), &faces));
    }
    (wrong, asked)
}

#[test]
fn shadows_agree_with_rays() {
    let mut random = Random(7);
    let mut sum = (0, 0);
    for scene in 0..300 {
        let meshes: Vec<PolyMesh> = (0..6)
            .map(|i| {
                let size = random.vector() * 6.0 + 1.0;
                let solid = match i % 3 {
                    0 => sphere(size.x / 2.0, 14),
                    _ => cuboid(-size / 2.0, size / 2.0),
                };
                let angles = random.vector() * 6.0;
                let turned = DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
                let place = random.vector() * 9.0;
                solid.mesh().placed(&Placement::new(DMat3::from_quat(turned), place))
            })
            .collect();
        let toward = random.vector() - dvec3(0.5, 0.5, f64::from(scene % 2) / 2.0);
        let (wrong, asked) = wrong(&meshes, toward, &mut random);
        sum = (sum.0 + wrong, sum.1 + asked);
    }
    assert!(sum.0 == 0 && sum.1 > 10_000, "{sum:?}");
}

/// Blocks side by side and on each other: light neither leaks between them nor do they shade themselves.
#[test]
fn blocks_that_touch_do_not_leak() {
    let mut random = Random(11);
    let mut sum = (0, 0);
    for _ in 0..60 {
        let block = |random: &mut Random| {
            let corner = (random.vector() * 4.0).floor();
            let size = (random.vector() * 2.0).floor() + 1.0;
            cuboid(corner, corner + size).mesh().clone()
        };
        let meshes: Vec<PolyMesh> = (0..12).map(|_| block(&mut random)).collect();
        let suns = [dvec3(1.0, 1.0, 1.0), dvec3(1.0, 0.0, 2.0), dvec3(-1.0, 2.0, 1.0), DVec3::Z];
        let toward = suns[(random.next() * 4.0) as usize];
        let (wrong, asked) = wrong(&meshes, toward, &mut random);
        sum = (sum.0 + wrong, sum.1 + asked);
    }
    assert!(sum.0 == 0 && sum.1 > 1500, "{sum:?}");
}

/// A flat patch of each tone comes out of each screen as dark as it went in.
#[test]
fn screens_keep_the_mean_tone() {
    let frame = frame(20.0, 400.0);
    let screens = [
        Screen::Dots { pitch: 1.0, angle: 45.0, shape: DotShape::Round },
        Screen::Dots { pitch: 1.0, angle: 20.0, shape: DotShape::Ellipse },
        Screen::Dots { pitch: 1.0, angle: 45.0, shape: DotShape::Square },
        Screen::Dots { pitch: 1.0, angle: 10.0, shape: DotShape::Diamond },
        Screen::Dots { pitch: 1.0, angle: 30.0, shape: DotShape::Line },
        Screen::Lines { pitch: 0.8, angle: 20.0 },
        Screen::Hatch { pitch: 0.5, angle: 30.0 },
        Screen::Stipple { pitch: 0.5, seed: 1 },
        Screen::Diffusion { side: 0.2, atkinson: false },
        Screen::Diffusion { side: 0.2, atkinson: true },
    ];
    for screen in screens {
        for level in 0..20 {
            let tone = 0.05 + 0.9 * f64::from(level) / 19.0;
            let pixels = vec![[tone as f32; 3]; (frame.size[0] * frame.size[1]) as usize];
            let ink = screen.ink(&Picture { frame, pixels }).expect("a coarse screen");
            // Away from the border of the paper.
            let made = ink.picture();
            let inside = 60..340u32;
            let rows =
                inside.clone().flat_map(|row| inside.clone().map(move |column| (column, row)));
            let tones: Vec<f64> = rows.map(|(c, r)| f64::from(made.at(c, r)[0])).collect();
            let mean = tones.iter().sum::<f64>() / tones.len() as f64;
            assert!((mean - tone).abs() < 0.01, "{screen:?}: {mean} for {tone}");
        }
    }
}

/// A ring, a ball and a wavy surface in strokes along their parameter lines: as dark as they should be all over, no stroke
/// twice, and little way between strokes.
#[test]
fn strokes_follow_round_faces() {
    let (ring, ball) = (torus(18.0, 6.0, 120, 60), sphere(9.0, 80));
    let rows: Vec<Vec<DVec3>> = (0..40)
        .map(|u| {
            let at = |v: i32| {
                let (x, y) = (f64::from(u) - 20.0, f64::from(v) - 20.0);
                dvec3(x, y, 3.0 * cos_deg(12.0 * x) * cos_deg(9.0 * y))
            };
            (0..40).map(at).collect()
        })
        .collect();
    let grid = CurvedGrid::new(&rows, false, false).expect("a grid");
    let wavy = grid.mesh();
    let sun = Sun::new(dvec3(-1.0, -1.0, 1.5), 0.1).expect("a direction");
    let light = Light { suns: vec![sun], ground: None };
    let camera = Camera::parallel(dvec3(0.4, -1.0, 1.2)).expect("a direction");
    let frame = frame(26.0, 520.0);
    for (mesh, grids) in
        [(ring.mesh(), vec![]), (ball.mesh(), vec![]), (&wavy, vec![(0u32, &grid)])]
    {
        let scene = Scene::of([mesh]);
        let (tones, guide) = guided(&scene, (&camera, &light, &frame), &grids, Tolerance::DEFAULT);
        let screen = Screen::Hatch { pitch: 0.4, angle: 45.0 };
        let ink = screen.ink_along(&tones, Some(&guide)).expect("a coarse screen");
        let mean = |picture: &Picture| {
            let tones = picture.tones();
            tones.iter().map(|t| f64::from(*t)).sum::<f64>() / tones.len() as f64
        };
        let dark = [&tones, &ink.picture()].map(|picture| 1.0 - mean(picture));
        assert!((dark[0] - dark[1]).abs() < 0.03 * dark[0], "{dark:?}");
        let strokes: Vec<&Vec<DVec2>> = ink
            .marks
            .iter()
            .map(|mark| match mark {
                Mark::Stroke { points, .. } => points,
                other => panic!("{other:?}"),
            })
            .collect();
        assert!(strokes.iter().any(|points| points.len() > 3), "none bends");
        let mut ends: Vec<[u64; 4]> = strokes
            .iter()
            .map(|s| {
                let mut ends = [s[0], s[s.len() - 1]].map(|p| [p.x.to_bits(), p.y.to_bits()]);
                ends.sort_unstable();
                [ends[0][0], ends[0][1], ends[1][0], ends[1][1]]
            })
            .collect();
        ends.sort_unstable();
        ends.dedup();
        assert_eq!(ends.len(), strokes.len());
        let way: f64 =
            strokes.windows(2).map(|s| s[0][s[0].len() - 1].distance(s[1][0])).sum::<f64>();
        assert!(way / (strokes.len() as f64) < 5.0 * 0.4, "{way} mm between {}", strokes.len());
    }
}

/// The signs of the embedded font.
struct Font;

impl Lettering for Font {
    fn outlines(&self, text: &str, height: f64) -> Option<(Vec<Vec<DVec2>>, f64)> {
        let options = TextOptions { size: height, ..TextOptions::default() };
        let set = profile::text(text, &options, None).ok()?;
        Some((set.region.contours().map(|contour| contour.points.clone()).collect(), set.width))
    }
}

/// Twenty tones come out of struck signs as twenty different amounts of ink, each more than the one before, and as dark
/// as they should be where the most ink there is stands for black.
#[test]
fn levels_of_struck_signs_grow_in_ink() {
    let levels = levels(&Font, 20);
    assert_eq!((levels.len(), levels[0].ink), (20, 0.0));
    let most = levels[19].ink;
    assert!(levels.windows(2).all(|pair| pair[0].ink < pair[1].ink));
    // Forty cells by 24.
    let frame = frame(50.8, 800.0);
    let mut before = 0.0;
    for step in 0..20 {
        let tone = 0.95 - 0.9 * f64::from(step) / 19.0;
        let pixels = vec![[tone as f32; 3]; (frame.size[0] * frame.size[1]) as usize];
        let struck = overstrike(&Picture { frame, pixels }, &Font, 20);
        let made = struck.ink.picture().tones();
        let ink = 1.0 - made.iter().map(|t| f64::from(*t)).sum::<f64>() / made.len() as f64;
        assert!(ink > before, "{tone}: {ink} after {before}");
        assert!((ink / most - (1.0 - tone)).abs() < 0.01, "{tone}: {ink} of {most}");
        before = ink;
    }
}
