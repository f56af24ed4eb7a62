//! What each pixel of a picture shows, and the parameter lines of what it shows.

use glam::{DVec2, DVec3, dvec2};

use super::{
    chart::Chart,
    facet::{Bend, Facet},
    picture::Frame,
};
use crate::{
    geom::{CurvedGrid, Surface, Tolerance},
    output::drawing::Camera,
};

/// Lets strokes follow the faces that a picture shows.
pub struct Guide<'a> {
    frame: Frame,
    camera: Camera,
    /// How much larger the picture is made than the camera sees.
    scale: f64,
    /// The facet seen in the middle of each pixel, counted from 1; 0 is paper.
    seen: Vec<u32>,
    facets: Vec<Place>,
    charts: Vec<Chart<'a>>,
    /// For each chart how much larger than the surface its image is at most where it is seen; 0 where it is not.
    magnified: Vec<f64>,
    /// True surfaces are nearer to their facets than this, mm.
    near: f64,
}

/// A facet's plane, and the chart of its surface.
struct Place {
    base: DVec3,
    normal: DVec3,
    chart: Option<u32>,
}

impl Place {
    /// How much larger the image of a length across the sight line is than the length, in the middle of a pixel.
    fn magnification(&self, pixel: usize, (camera, frame): (&Camera, &Frame)) -> f64 {
        if !camera.is_perspective() {
            return 1.0;
        }
        let width = frame.size[0] as usize;
        let at = dvec2((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
        let (from, away) = camera.ray(frame.place(at));
        let way = self.normal.dot(self.base - from) / self.normal.dot(away);
        let found = camera.magnification(from + away * way);
        if found.is_finite() { found.max(f64::MIN_POSITIVE) } else { f64::MIN_POSITIVE }
    }
}

/// True surfaces may be so many times the tolerance from their facets: once for the chord, once for rounding.
const SLACK: f64 = 2.0;

/// What a pixel shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shown {
    /// Nothing.
    Paper,
    /// A face that has no parameter lines.
    Flat,
    /// A face with a chart, by its number.
    Round(u32),
}

impl<'a> Guide<'a> {
    /// For facets of bodies, of which grids are those of given numbers, as they are seen.
    pub(super) fn new(
        facets: &[Facet],
        grids: &[(u32, &'a CurvedGrid)],
        seen: Vec<u32>,
        (camera, frame): (&Camera, &Frame),
        tolerance: Tolerance,
    ) -> Guide<'a> {
        let mut charts: Vec<Chart<'a>> = grids.iter().map(|(_, g)| Chart::of_grid(g)).collect();
        let surfaces = surfaces(facets);
        let mut number: Vec<Option<u32>> = vec![None; surfaces.len()];
        for (known, number) in surfaces.iter().zip(&mut number) {
            if let Some(chart) = Chart::of_surface(known.surface, &known.points) {
                *number = Some(charts.len() as u32);
                charts.push(chart);
            }
        }
        let mut facets: Vec<Place> = facets.iter().map(|facet| place(facet, grids)).collect();
        for (known, number) in surfaces.iter().zip(number) {
            known.facets.iter().for_each(|&i| facets[i as usize].chart = number);
        }
        let near = tolerance.mm() * SLACK;
        let mut magnified: Vec<f64> = vec![0.0; charts.len()];
        for (pixel, number) in seen.iter().enumerate().filter(|(_, number)| **number > 0) {
            let facet = &facets[*number as usize - 1];
            if let Some(chart) = facet.chart {
                let known = &mut magnified[chart as usize];
                *known = known.max(facet.magnification(pixel, (camera, frame)));
            }
        }
        Guide { frame: *frame, camera: *camera, scale: 1.0, seen, facets, charts, magnified, near }
    }

    /// For the same picture made so many times as large.
    pub fn scaled(self, scale: f64) -> Guide<'a> {
        Guide { frame: self.frame.scaled(scale), scale: self.scale * scale, ..self }
    }

    pub(super) fn charts(&self) -> &[Chart<'a>] {
        &self.charts
    }

    /// How much larger than the surface of a chart its image is at most where it is seen; `None` where it is not.
    pub(super) fn magnification(&self, chart: u32) -> Option<f64> {
        let found = self.magnified[chart as usize] * self.scale;
        (found > 0.0).then_some(found)
    }

    /// Where on paper a point of space is.
    pub(super) fn project(&self, p: DVec3) -> Option<DVec2> {
        self.camera.project(p).map(|at| at * self.scale)
    }

    /// What is seen at a place on paper.
    pub(super) fn shown(&self, at: DVec2) -> Shown {
        match self.facet(at) {
            None => Shown::Paper,
            Some(facet) => facet.chart.map_or(Shown::Flat, Shown::Round),
        }
    }

    /// Whether a point of a chart is what is seen where it lies on paper.
    pub(super) fn sees(&self, chart: u32, p: DVec3, at: DVec2) -> bool {
        self.facet(at).is_some_and(|facet| {
            let off = facet.normal.dot(p - facet.base).abs();
            facet.chart == Some(chart) && off <= self.near
        })
    }

    fn facet(&self, at: DVec2) -> Option<&Place> {
        let place = self.frame.column_row(at).floor();
        let [width, height] = self.frame.size;
        let inside = place.cmpge(DVec2::ZERO).all() && place.x < f64::from(width);
        if !inside || place.y >= f64::from(height) {
            return None;
        }
        let number = self.seen[place.y as usize * width as usize + place.x as usize];
        self.facets.get((number as usize).checked_sub(1)?)
    }
}

fn place(facet: &Facet, grids: &[(u32, &CurvedGrid)]) -> Place {
    let grid = grids.iter().position(|(body, _)| *body == facet.face.0);
    Place { base: facet.loops[0][0], normal: facet.normal, chart: grid.map(|i| i as u32) }
}

/// A true surface with the facets that stand for it, and their corners.
struct Known {
    surface: Surface,
    facets: Vec<u32>,
    points: Vec<DVec3>,
}

fn surfaces(facets: &[Facet]) -> Vec<Known> {
    let mut all: Vec<Known> = vec![];
    let mut last = 0;
    for (number, facet) in (0u32..).zip(facets) {
        let Bend::Surface { surface, .. } = facet.bend else { continue };
        // Facets of one surface follow each other.
        if all.get(last).is_none_or(|known| known.surface != surface) {
            last = all.iter().position(|known| known.surface == surface).unwrap_or(all.len());
        }
        if last == all.len() {
            all.push(Known { surface, facets: vec![], points: vec![] });
        }
        all[last].facets.push(number);
        all[last].points.extend(facet.loops.iter().flatten());
    }
    all
}
