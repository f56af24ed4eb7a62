//! What a view shows beside its solids: surfaces as bodies and grid lines, curves and outlines of plane figures as lines.

use glam::DVec3;

use super::{drafting::style, outline::Outline, shadows};
use crate::{
    geom::{Hidden, PolyMesh},
    output::{
        drawing::{
            Body, Camera, Drawing, HeightField, Kind, Options, Scene, Stroke, grid_strokes,
            horizon_lines, visible_lines,
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
        let sheets: Vec<PolyMesh> = view.surfaces.iter().map(|s| s.mesh()).collect();
        let scene = Scene { bodies: self.bodies(&sheets), strokes: vec![] };
        let pitch = style(&view.style).hatch_pitch / 2.0;
        shadows::add(drawing, &scene, camera, options, (&sun, cast.ground, pitch));
    }

    fn bodies<'a>(&'a self, sheets: &'a [PolyMesh]) -> Vec<Body<'a>> {
        let solids = self.solids.iter().map(|&mesh| (mesh, false));
        let meshes = solids.chain(sheets.iter().map(|mesh| (mesh, true))).zip(0..);
        meshes.map(|((mesh, smooth), id)| Body { mesh, id, smooth }).collect()
    }

    fn scene_lines(&self, view: &ViewSpec, camera: &Camera, options: &Options) -> Drawing {
        let sheets: Vec<PolyMesh> = view.surfaces.iter().map(|s| s.mesh()).collect();
        let scene = Scene { bodies: self.bodies(&sheets), strokes: self.strokes(view, camera) };
        visible_lines(&scene, camera, options)
    }

    fn strokes(&self, view: &ViewSpec, camera: &Camera) -> Vec<Stroke> {
        let first = self.solids.len() as u32;
        let grids = view.surfaces.iter().zip(first..);
        let mut strokes: Vec<Stroke> =
            grids.flat_map(|(grid, id)| grid_strokes(grid, camera, id)).collect();
        strokes.extend_from_slice(&self.patterns);
        let mut next = first + view.surfaces.len() as u32;
        let mut add = |line: &Outline, kind: Kind| {
            let (points, round) = (line.points.clone(), line.round);
            strokes.push(Stroke { points, kind, id: next, round });
            next += 1;
        };
        self.free.iter().for_each(|line| add(line, Kind::Free));
        self.axes.iter().for_each(|line| add(&line.to_vec().into(), Kind::Centre));
        strokes
    }
}
