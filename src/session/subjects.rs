//! What a view shows beside its solids: surfaces as bodies and grid lines, curves and outlines of plane figures as lines.

use glam::DVec3;

use super::{drafting::style, outline::Outline, shadows};
use crate::{
    geom::{Hidden, PolyMesh},
    output::{
        drawing::{
            Body, Camera, Drawing, HeightField, Kind, Options, Scene, Stroke, grid_strokes,
            horizon_lines, is_drawn_smooth, visible_lines,
        },
        halftone::Sun,
    },
    shape::{ViewSpec, drawing::CastSpec},
};

/// All that one view shows, made.
pub struct Subjects<'a> {
    pub solids: Vec<&'a PolyMesh>,
    /// Curves and the outlines of plane figures.
    pub free: Vec<Outline>,
    pub axes: Vec<[DVec3; 2]>,
    /// Figures on faces.
    pub patterns: Vec<Stroke>,
}

impl Subjects<'_> {
    /// The lines of a view. A surface on its own that is a function of x and y, with nothing hidden to draw, is drawn by
    /// its horizon.
    pub fn lines(&self, view: &ViewSpec, camera: &Camera, options: &Options) -> Drawing {
        match self.horizon(view, camera) {
            Some(drawing) => drawing,
            None => self.scene_lines(view, camera, options),
        }
    }

    fn horizon(&self, view: &ViewSpec, camera: &Camera) -> Option<Drawing> {
        let others = view.shapes.len() + view.profiles.len() + view.curves.len();
        let ([surface], 0, Hidden::Off) = (&view.surfaces[..], others, view.hidden) else {
            return None;
        };
        horizon_lines(&HeightField::of(surface)?, camera, 0).ok()
    }

    /// Adds the shadows that solids and surfaces cast on each other and on the ground.
    pub fn cast(
        &self,
        drawing: &mut Drawing,
        cast: &CastSpec,
        view: &ViewSpec,
        (camera, options): (&Camera, &Options),
    ) {
        let Ok(sun) = Sun::new(cast.toward, 0.0) else { return };
        let numbers = self.solids.len() as u32..;
        let sheets = view.surfaces.iter().map(|surface| surface.mesh()).zip(numbers);
        let sheets: Vec<(PolyMesh, u32)> = sheets.collect();
        let scene = Scene { bodies: self.bodies(&sheets), ..Scene::default() };
        let pitch = style(&view.style).hatch_pitch / 2.0;
        shadows::add(drawing, &scene, camera, options, (&sun, cast.ground, pitch));
    }

    /// The solids and some surfaces, these with their numbers.
    fn bodies<'a>(&'a self, sheets: &'a [(PolyMesh, u32)]) -> Vec<Body<'a>> {
        let solids = self.solids.iter().zip(0..).map(|(&mesh, id)| (mesh, id, false));
        let meshes = solids.chain(sheets.iter().map(|(mesh, id)| (mesh, *id, true)));
        meshes.map(|(mesh, id, smooth)| Body { mesh, id, smooth }).collect()
    }

    fn scene_lines(&self, view: &ViewSpec, camera: &Camera, options: &Options) -> Drawing {
        let first = self.solids.len() as u32;
        let surfaces = view.surfaces.iter().map(|s| &**s).zip(first..);
        let (grids, rough): (Vec<_>, Vec<_>) = surfaces.partition(|s| is_drawn_smooth(s.0));
        let sheets: Vec<(PolyMesh, u32)> = rough.iter().map(|s| (s.0.mesh(), s.1)).collect();
        let next = first + view.surfaces.len() as u32;
        let mut strokes: Vec<Stroke> =
            rough.into_iter().flat_map(|(grid, id)| grid_strokes(grid, camera, id)).collect();
        self.add_strokes(next, &mut strokes);
        let bodies = self.bodies(&sheets);
        visible_lines(&Scene { bodies, strokes, grids }, camera, options)
    }

    /// Adds figures on faces, curves and centre lines, these with numbers from `next` on.
    fn add_strokes(&self, mut next: u32, strokes: &mut Vec<Stroke>) {
        strokes.extend_from_slice(&self.patterns);
        let mut add = |line: &Outline, kind: Kind| {
            let (points, round) = (line.points.clone(), line.round);
            strokes.push(Stroke { points, kind, id: next, round, drawn: vec![] });
            next += 1;
        };
        self.free.iter().for_each(|line| add(line, Kind::Free));
        self.axes.iter().for_each(|line| add(&line.to_vec().into(), Kind::Centre));
    }
}
