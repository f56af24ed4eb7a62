//! From what a model says of a picture to pixels: makes the bodies, finds what the picture holds, and lights it.

use glam::DVec2;

use super::drafting::{Drafter, Letterer, at, refused, sight, style};
use crate::{
    base::{Code, Diagnostic, Phase},
    geom::PolyMesh,
    output::{
        drawing::{Body, Camera, Hidden, Options, Scene, Window, visible_lines},
        halftone::{
            self, Frame, Halftone, Light, Mark, Screen, Sun, Tones, ground_shadow, overstrike,
        },
        sheet::Layer,
    },
    realize,
    shape::{
        drawing::StyleSpec,
        halftone::{ScreenSpec, ShadeSpec},
    },
};

/// White around what a picture shows, as a part of its larger side.
const MARGIN: f64 = 0.03;

/// Shadows are shown up to so many times as far from the bodies as these are large.
const REACH: f64 = 1.0;

impl Drafter<'_> {
    /// A picture, and what is to be said about it. Fails with the diagnostic of a shape that cannot be made, and for
    /// pictures without or with too many pixels.
    pub fn shade(&self, spec: &ShadeSpec) -> Result<(Halftone, Vec<Diagnostic>), Diagnostic> {
        self.realizer.realize(self.graph, &spec.shapes);
        let mut warnings = vec![];
        let mut solids = vec![];
        for &shape in &spec.shapes {
            let solid = self.realizer.solid(self.graph, shape).map_err(|e| *e.diagnostic)?;
            warnings.extend(realize::warnings(self.realizer, self.graph, shape));
            solids.push(solid.polyhedron);
        }
        let place = spec.place.0;
        let camera = sight(spec.projection, spec.target, spec.window);
        let camera = camera.map_err(|error| refused(&error, place))?;
        let suns = spec.suns.iter().map(|sun| {
            let sun = Sun::new(sun.toward, sun.ambient)?.with_strength(sun.strength)?;
            Ok(sun)
        });
        let suns = suns.collect::<Result<Vec<Sun>, halftone::LightError>>();
        let suns = suns.map_err(|error| at(Code::Degenerate, error.to_string(), place))?;
        let light = Light { suns, ground: spec.ground };
        self.timed(Phase::Drawings, || {
            let sheets: Vec<PolyMesh> = spec.surfaces.iter().map(|s| s.mesh()).collect();
            let meshes = solids.iter().map(|s| (s.mesh(), false));
            let meshes = meshes.chain(sheets.iter().map(|mesh| (mesh, true))).zip(0..);
            let bodies = meshes.map(|((mesh, smooth), id)| Body { mesh, id, smooth }).collect();
            let scene = Scene { bodies, ..Scene::default() };
            let Some(window) = camera.window().or_else(|| shown(&scene, &camera, &light)) else {
                let words = "the picture shows nothing: its shapes are empty or behind the eye";
                return Err(at(Code::EmptyResult, words, place));
            };
            let frame = Frame::new(window, spec.dpi);
            let frame = frame.map_err(|error| {
                let help = "change `window` or `dpi`";
                at(Code::Limit, error.to_string(), place).help(help)
            })?;
            let picture = halftone::picture(&scene, &camera, &light, &frame);
            let lines = match &spec.lines {
                Some(style) => self.lines(&scene, &camera, &frame, style),
                None => vec![],
            };
            if let ScreenSpec::Overstrike { levels } = spec.screen {
                let text = overstrike(&picture, &Letterer, levels as usize);
                return Ok((Halftone { tones: Tones::Text(text), lines }, warnings));
            }
            let Some(screen) = screen(spec.screen) else {
                return Ok((Halftone { tones: Tones::Pixels(picture), lines }, warnings));
            };
            let ink = screen.ink(&picture).map_err(|error| {
                let help = "make the pitch larger, or more pixels with `dpi`";
                at(Code::Limit, error.to_string(), place).help(help)
            })?;
            Ok((Halftone { tones: Tones::Ink(ink), lines }, warnings))
        })
    }

    /// The edges that are seen in a picture.
    fn lines(&self, scene: &Scene, camera: &Camera, frame: &Frame, spec: &StyleSpec) -> Vec<Mark> {
        let standard = Options::default();
        let options = Options {
            hidden: Hidden::Off,
            tolerance: self.realizer.tolerance(),
            crease: spec.crease.unwrap_or(standard.crease),
            ..standard
        };
        let Ok(camera) = camera.with_window(frame.window) else { return vec![] };
        let drawing = visible_lines(scene, &camera, &options);
        halftone::lines(&drawing, style(spec).pen(Layer::Visible).width)
    }
}

/// The screen that is asked for, if tones are not to stay pixels.
fn screen(spec: ScreenSpec) -> Option<Screen> {
    Some(match spec {
        ScreenSpec::Grey | ScreenSpec::Overstrike { .. } => return None,
        ScreenSpec::Dots { pitch, angle } => Screen::Dots { pitch, angle },
        ScreenSpec::Lines { pitch, angle } => Screen::Lines { pitch, angle },
        ScreenSpec::Hatch { pitch, angle } => Screen::Hatch { pitch, angle },
        ScreenSpec::Stipple { pitch, seed } => Screen::Stipple { pitch, seed },
        ScreenSpec::Diffusion { side, atkinson } => Screen::Diffusion { side, atkinson },
    })
}

/// The rectangle around the images of all bodies, and of their shadows as far as these are not much farther.
fn shown(scene: &Scene, camera: &Camera, light: &Light) -> Option<Window> {
    let corners = scene.bodies.iter().flat_map(|body| &body.mesh.points);
    let around = |points: &mut dyn Iterator<Item = DVec2>| {
        points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    };
    let (min, max) = around(&mut corners.filter_map(|p| camera.project(*p)))?;
    let size = (max - min).max_element();
    let (mut low, mut high) = (min, max);
    if let Some(z) = light.ground {
        let shadows = light.suns.iter().flat_map(|sun| ground_shadow(scene, sun, z)).flatten();
        if let Some((from, to)) = around(&mut shadows.filter_map(|p| camera.project(p))) {
            let most = DVec2::splat(size * REACH);
            (low, high) = (min.min(from.max(min - most)), max.max(to.min(max + most)));
        }
    }
    let margin = DVec2::splat((high - low).max_element() * MARGIN);
    (size > 0.0).then(|| Window { min: low - margin, max: high + margin })
}
