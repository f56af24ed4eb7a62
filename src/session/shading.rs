//! From what a model says of a picture to tones: makes the bodies, finds what the picture holds, and lights it.

use std::cell::Cell;

use glam::DVec2;

use super::{
    drafting::{Drafter, Letterer, at, refused, sight, style},
    outline::Tracer,
    patterns,
};
use crate::{
    base::{Code, Diagnostic, Phase},
    geom::{CurvedGrid, PolyMesh, Screen},
    output::{
        drawing::{Body, Camera, Hidden, Kind, Options, Scene, Window, visible_lines},
        halftone::{
            self, Frame, Halftone, Light, LightError, Picture, Sun, Tones, cell_dpi, cell_width,
            ground_shadow, overstrike, preview,
        },
        sheet::{Figure, Ink},
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
    /// A picture at a scale, paper over model, and what is to be said about it. Its screen and pixels are as fine on
    /// paper at any scale. Fails with the diagnostic of a shape that cannot be made, and for pictures without or with
    /// too many pixels.
    pub fn shade(
        &self,
        spec: &ShadeSpec,
        scale: f64,
    ) -> Result<(Halftone, Vec<Diagnostic>), Diagnostic> {
        self.lit(spec, scale, &|_| spec.dpi * scale)
    }

    /// A picture in characters, at most so many columns and rows, and what is to be said about it.
    pub fn preview(
        &self,
        spec: &ShadeSpec,
        size: [u32; 2],
    ) -> Result<(String, Vec<Diagnostic>), Diagnostic> {
        let width = Cell::new(1.0);
        let dpi = |window: &Window| {
            width.set(cell_width(window, size));
            cell_dpi(width.get())
        };
        let grey = ShadeSpec { screen: ScreenSpec::Grey, ..spec.clone() };
        let (halftone, warnings) = self.lit(&grey, 1.0, &dpi)?;
        Ok((preview(&halftone.picture(), &Letterer, width.get()), warnings))
    }

    /// A picture with pixels so fine as its window asks for.
    fn lit(
        &self,
        spec: &ShadeSpec,
        scale: f64,
        dpi: &dyn Fn(&Window) -> f64,
    ) -> Result<(Halftone, Vec<Diagnostic>), Diagnostic> {
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
        let light = light(spec).map_err(|error| at(Code::Degenerate, error.to_string(), place))?;
        self.timed(Phase::Halftones, || {
            let own: Vec<&PolyMesh> = solids.iter().map(|s| s.mesh()).collect();
            let tracer = Tracer { realizer: self.realizer, graph: self.graph };
            let strokes = patterns::all(&tracer, &spec.shapes, &own)?;
            let sheets: Vec<PolyMesh> = spec.surfaces.iter().map(|s| s.mesh()).collect();
            let meshes = own.into_iter().map(|mesh| (mesh, false));
            let meshes = meshes.chain(sheets.iter().map(|mesh| (mesh, true))).zip(0..);
            let bodies = meshes.map(|((mesh, smooth), id)| Body { mesh, id, smooth }).collect();
            let scene = Scene { bodies, strokes, ..Scene::default() };
            let Some(window) = camera.window().or_else(|| shown(&scene, &camera, &light)) else {
                let words = "the picture shows nothing: its shapes are empty or behind the eye";
                return Err(at(Code::EmptyResult, words, place));
            };
            let frame = Frame::new(window, dpi(&window)).map_err(|error| {
                let help = "change `window` or `dpi`";
                at(Code::Limit, error.to_string(), place).help(help)
            })?;
            let tones = self.tones(spec, (&scene, &camera, &light, &frame), scale)?;
            let pens = style(spec.lines.as_ref().unwrap_or(&StyleSpec::default()));
            let figure = Figure { style: pens, ..self.lines(scene, &camera, &frame, spec) };
            let lines: Vec<Ink> = figure.inks(scale, &Letterer);
            Ok((Halftone { tones, lines, style: figure.style }, warnings))
        })
    }

    /// The tones of a picture as its screen makes them.
    fn tones(
        &self,
        spec: &ShadeSpec,
        (scene, camera, light, frame): (&Scene, &Camera, &Light, &Frame),
        scale: f64,
    ) -> Result<Tones, Diagnostic> {
        let larger = |picture| Picture { frame: frame.scaled(scale), ..picture };
        let plain = || larger(halftone::picture(scene, camera, light, frame));
        let ink = match spec.screen {
            ScreenSpec::Grey => return Ok(Tones::Pixels(plain())),
            ScreenSpec::Overstrike { levels } => {
                return Ok(Tones::Text(overstrike(&plain(), &Letterer, levels as usize)));
            }
            ScreenSpec::Ink(screen @ Screen::Hatch { .. }) => {
                let first = scene.bodies.len() - spec.surfaces.len();
                let grids = spec.surfaces.iter().map(|grid| &**grid);
                let grids: Vec<(u32, &CurvedGrid)> = (first as u32..).zip(grids).collect();
                let tolerance = self.realizer.tolerance();
                let (picture, guide) =
                    halftone::guided(scene, (camera, light, frame), &grids, tolerance);
                screen.ink_along(&larger(picture), Some(&guide.scaled(scale)))
            }
            ScreenSpec::Ink(screen) => screen.ink(&plain()),
        };
        ink.map(Tones::Ink).map_err(|error| {
            let help = "make the pitch larger, or more pixels with `dpi`";
            at(Code::Limit, error.to_string(), spec.place.0).help(help)
        })
    }

    /// The edges that are seen in a picture, if they are wanted, and the figures on faces.
    fn lines(&self, scene: Scene, camera: &Camera, frame: &Frame, spec: &ShadeSpec) -> Figure {
        let standard = Options::default();
        let crease = spec.lines.as_ref().and_then(|style| style.crease);
        let options = Options {
            hidden: Hidden::Off,
            tolerance: self.realizer.tolerance(),
            crease: crease.unwrap_or(standard.crease),
            ..standard
        };
        let window = camera.with_window(frame.window).ok();
        let wanted = spec.lines.is_some() || !scene.strokes.is_empty();
        let Some(camera) = window.filter(|_| wanted) else { return Figure::default() };
        let mut drawing = visible_lines(&scene, &camera, &options);
        drawing.lines.retain(|line| spec.lines.is_some() || line.kind == Kind::Pattern);
        Figure { drawing, ..Figure::default() }
    }
}

fn light(spec: &ShadeSpec) -> Result<Light, LightError> {
    let suns = spec.suns.iter();
    let suns = suns.map(|sun| Sun::new(sun.toward, sun.ambient)?.with_strength(sun.strength));
    Ok(Light { suns: suns.collect::<Result<_, _>>()?, ground: spec.ground })
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
