//! The half-tones that are timed, alone and against POV-Ray by `compare_halftones.py`: the scenes, and a process that
//! makes one of them each time it is asked to. Light, shadows and pixels are timed, not the making of the solids.
//!
//! ```sh
//! cargo bench --bench halftone -- list
//! cargo bench --bench halftone -- serve city        # a line in, milliseconds out
//! cargo bench --bench halftone -- povray city       # the scene for POV-Ray
//! ```

use std::{
    io::{self, BufRead, Write},
    time::Instant,
};

use glam::{DVec2, DVec3, dvec2, dvec3};
use katachi::{
    geom::{
        Origin, PolyMesh, Surface,
        triangulate::triangulate,
        trig::{cos_deg, sin_deg},
    },
    kernel::brep::primitive::{cuboid, sphere},
    output::{
        drawing::{Camera, Scene, Window},
        halftone::{DotShape, Frame, Halftone, Light, Screen, Sun, Tones, picture},
        sheet::{self, DrawingFormat, Style},
    },
};
use serde_json::json;

/// A scene and how it is looked at.
struct Subject {
    meshes: Vec<PolyMesh>,
    eye: DVec3,
    target: DVec3,
    /// Half of the window on the plane through the target, mm.
    half: DVec2,
    /// Columns.
    width: u32,
    screen: Option<Screen>,
}

type Made = (&'static str, fn() -> Subject);

const SCENES: &[Made] =
    &[("city", city), ("hospital", hospital), ("triangles", triangles), ("dots", dots)];

const SUN: DVec3 = dvec3(-1.0, -2.0, 2.5);

fn main() {
    // Cargo adds `--bench`; without a command there is nothing to do.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let subject = |name: &str| {
        let found = SCENES.iter().find(|scene| scene.0 == name);
        found.unwrap_or_else(|| panic!("no scene `{name}`")).1()
    };
    match arguments[..] {
        ["list"] => SCENES.iter().for_each(|scene| println!("{}", scene.0)),
        ["serve", name] => serve(&subject(name)),
        ["povray", name] => print!("{}", povray(&subject(name))),
        _ => println!("list | serve <scene> | povray <scene>"),
    }
}

/// Makes the picture for each line of the input.
#[allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
fn serve(subject: &Subject) {
    let camera = Camera::perspective(subject.eye, subject.target).expect("apart");
    let window = Window { min: -subject.half, max: subject.half };
    let dpi = f64::from(subject.width) * 25.4 / (2.0 * subject.half.x);
    let frame = Frame::new(window, dpi * (1.0 - 1e-9)).expect("a picture");
    let suns = vec![Sun::new(SUN, 0.2).expect("a direction")];
    let light = Light { suns, ground: Some(0.0) };
    let scene = Scene::of(&subject.meshes);
    for _ in io::stdin().lock().lines() {
        let start = Instant::now();
        let made = picture(&scene, &camera, &light, &frame);
        let picture_ms = start.elapsed().as_secs_f64() * 1e3;
        let ink = subject.screen.map(|screen| screen.ink(&made).expect("a coarse screen"));
        let marks = ink.as_ref().map_or(0, |ink| ink.marks.len());
        let print = ink.map(|ink| {
            let (tones, style) = (Tones::Ink(ink), Style::default());
            Halftone { tones, lines: vec![], style }.print().page("dots")
        });
        let written = |format| print.as_ref().map_or(0, |page| sheet::write(format, page).len());
        let bytes = written(DrawingFormat::Svg);
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let pdf_bytes = written(DrawingFormat::Pdf);
        let pdf_ms = start.elapsed().as_secs_f64() * 1e3 - ms;
        println!(
            "{}",
            json!({
                "ms": ms, "picture_ms": picture_ms, "size": frame.size, "marks": marks, "bytes": bytes,
                "pdf_ms": pdf_ms, "pdf_bytes": pdf_bytes,
            })
        );
        io::stdout().flush().expect("standard output is open");
    }
}

/// Sixty cuboids in rows: the picture of the paper of 1972.
fn city() -> Subject {
    let house = |i: u32| {
        let corner = dvec3(f64::from(i % 10) * 18.0, f64::from(i / 10) * 18.0, 0.0);
        cuboid(corner, corner + dvec3(10.0, 10.0, 14.0 + f64::from(i * 7 % 11) * 2.0))
            .mesh()
            .clone()
    };
    let meshes = (0..60).map(house).collect();
    let (eye, target) = (dvec3(-90.0, -160.0, 120.0), dvec3(86.0, 50.0, 0.0));
    Subject { meshes, eye, target, half: dvec2(128.0, 96.0), width: 1024, screen: None }
}

/// Wings, towers and rows of windows: some 250 faces.
fn hospital() -> Subject {
    let block = |x: f64, y: f64, size: DVec3| {
        cuboid(dvec3(x, y, 0.0), dvec3(x, y, 0.0) + size).mesh().clone()
    };
    let mut meshes = vec![
        block(0.0, 0.0, dvec3(120.0, 20.0, 30.0)),
        block(0.0, 20.0, dvec3(20.0, 60.0, 24.0)),
        block(100.0, 20.0, dvec3(20.0, 60.0, 24.0)),
        block(50.0, 5.0, dvec3(20.0, 14.0, 55.0)),
    ];
    meshes.extend((0..38).map(|i| {
        let (column, row) = (f64::from(i % 19), f64::from(i / 19));
        let corner = dvec3(3.0 + column * 6.0, -1.5, 6.0 + row * 12.0);
        cuboid(corner, corner + dvec3(4.0, 1.5, 5.0)).mesh().clone()
    }));
    let (eye, target) = (dvec3(-60.0, -180.0, 130.0), dvec3(60.0, 30.0, 10.0));
    Subject { meshes, eye, target, half: dvec2(108.0, 81.0), width: 1024, screen: None }
}

/// A bent ring of 100,000 triangles over a ball.
fn triangles() -> Subject {
    let (around, tube) = (500u32, 100u32);
    let at = |i: u32, j: u32| {
        let [a, b] = [(i, around), (j, tube)].map(|(k, n)| f64::from(k) / f64::from(n) * 360.0);
        let r = 30.0 + (9.0 + sin_deg(5.0 * a) * 2.0) * cos_deg(b);
        let height = 15.0 + 9.0 * sin_deg(b) + 4.0 * sin_deg(3.0 * a);
        dvec3(r * cos_deg(a), r * sin_deg(a), height)
    };
    let points = (0..around).flat_map(|i| (0..tube).map(move |j| at(i, j))).collect();
    let mut mesh = PolyMesh::with_points(points);
    let origin = mesh.add_origin(Origin::of(Surface::Facets));
    for (i, j) in (0..around).flat_map(|i| (0..tube).map(move |j| (i, j))) {
        let number = |i: u32, j: u32| (i % around) * tube + j % tube;
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        for corners in [[a, b, c], [a, c, d]] {
            let plane = mesh.add_plane();
            mesh.push_face(&[corners], plane, origin);
        }
    }
    let meshes = vec![mesh, sphere(8.0, 40).mesh().clone()];
    let (eye, target) = (dvec3(-60.0, -120.0, 110.0), dvec3(0.0, 0.0, 10.0));
    Subject { meshes, eye, target, half: dvec2(64.0, 48.0), width: 2048, screen: None }
}

/// The city in twenty thousand dots.
fn dots() -> Subject {
    let screen = Some(Screen::Dots { pitch: 0.75, angle: 45.0, shape: DotShape::Round });
    Subject { screen, ..city() }
}

/// The scene as POV-Ray reads it: triangles, one light with sharp shadows, the same eye.
fn povray(subject: &Subject) -> String {
    let vector = |p: DVec3| format!("<{},{},{}>", p.x, p.z, p.y);
    let far = subject.target + SUN.normalize() * 1e5;
    let away = subject.eye.distance(subject.target);
    // Half the width of a picture as long as the eye is away is half a unit of POV-Ray's `right`.
    let right = 2.0 * subject.half.x / away;
    let mut text = format!(
        "global_settings {{ assumed_gamma 1 }}\nbackground {{ rgb 1 }}\ncamera {{ perspective location {} \
         right x*{right} up y*{} sky y direction z look_at {} }}\nlight_source {{ {} rgb 1 parallel point_at {} }}\n\
         plane {{ y, 0 pigment {{ rgb 1 }} finish {{ ambient 0.2 diffuse 0.8 }} }}\n",
        vector(subject.eye),
        2.0 * subject.half.y / away,
        vector(subject.target),
        vector(far),
        vector(subject.target),
    );
    for mesh in &subject.meshes {
        text += "mesh {\n";
        for corners in triangulate(mesh).corners {
            let [a, b, c] = corners.map(|corner| vector(mesh.points[corner as usize]));
            text += &format!("triangle {{ {a}, {b}, {c} }}\n");
        }
        text += "pigment { rgb 1 } finish { ambient 0.2 diffuse 0.8 } }\n";
    }
    text
}
