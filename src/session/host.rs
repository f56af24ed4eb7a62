//! What evaluation asks of a session: files, and answers about shapes.

use std::sync::Arc;

use glam::DVec3;

use super::{Session, hold};
use crate::{
    base::{Diagnostic, FileError, Phase, SourceId, watch::during},
    eval::{Host, Loaded, library},
    geom::{
        Curve, CurvedGrid, Raster,
        isometric::{IsoDrawing, IsoScale},
    },
    realize,
    shape::{
        Geometry, GeometryError, Measures, ShapeGraph, ShapeId, SweptSurface,
        geometry::{Imported, InsideMethod, TetrahedraCount},
        node::TextSpec,
    },
    syntax,
};

impl Host for Session<'_> {
    fn load(&self, path: &str) -> Result<Arc<Loaded>, Diagnostic> {
        if let Some(loaded) = hold(&self.loaded).get(path) {
            return Ok(loaded.clone());
        }
        let bytes = self.source_bytes(path)?;
        let loaded = during(self.watch, Phase::Parse, || Arc::new(self.parsed(path, &bytes)));
        hold(&self.loaded).insert(path.to_string(), loaded.clone());
        Ok(loaded)
    }
}

impl Session<'_> {
    fn source_bytes(&self, path: &str) -> Result<Vec<u8>, Diagnostic> {
        if path.starts_with("std/") {
            let text = library::module(path).ok_or(FileError::NotFound);
            return text.map(|t| t.as_bytes().to_vec()).map_err(|e| realize::unreadable(path, &e));
        }
        self.world.read(path).map_err(|error| realize::unreadable(path, &error))
    }

    /// The syntax tree of a file. What is not text is an empty file with one diagnostic.
    fn parsed(&self, path: &str, bytes: &[u8]) -> Loaded {
        let mut sources = self.sources();
        let next = SourceId(sources.iter().count() as u32);
        let (text, refused): (Arc<str>, _) = match syntax::decode(next, bytes) {
            Ok(text) => (text.into(), None),
            Err(diagnostic) => ("".into(), Some(diagnostic)),
        };
        let source = sources.add(path, text.clone());
        debug_assert_eq!(source, next);
        let (program, mut diagnostics) = syntax::parse(source, &text);
        diagnostics.extend(refused);
        Loaded { path: path.into(), text, source, program, diagnostics }
    }
}

impl Geometry for Session<'_> {
    fn settle_tolerance(&self, mm: f64) {
        self.realizer.settle_tolerance(mm);
    }

    fn measures(&self, graph: &ShapeGraph, shape: ShapeId) -> Result<Arc<Measures>, GeometryError> {
        self.realizer.measures(graph, shape)
    }

    fn inside(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
        by: InsideMethod,
    ) -> Result<bool, GeometryError> {
        self.realizer.inside(graph, shape, point, by)
    }

    fn solid_angle(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError> {
        self.realizer.solid_angle(graph, shape, point)
    }

    fn tetrahedra(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
    ) -> Result<TetrahedraCount, GeometryError> {
        Geometry::tetrahedra(&self.realizer, graph, shape)
    }

    fn distance_to_point(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError> {
        self.realizer.distance_to_point(graph, shape, point)
    }

    fn distance_to_curve(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        curve: &Curve,
    ) -> Result<f64, GeometryError> {
        self.realizer.distance_to_curve(graph, shape, curve)
    }

    fn distance(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError> {
        self.realizer.distance(graph, a, b)
    }

    fn hausdorff(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError> {
        self.realizer.hausdorff(graph, a, b)
    }

    fn text_width(&self, text: &TextSpec) -> Result<f64, GeometryError> {
        self.realizer.text_width(text)
    }

    fn import(&self, file: &str) -> Result<Imported, GeometryError> {
        self.realizer.import(file)
    }

    fn surface(&self, surface: &SweptSurface) -> Result<CurvedGrid, GeometryError> {
        self.realizer.surface(surface)
    }

    fn heights(&self, file: &str) -> Result<Raster, GeometryError> {
        self.realizer.heights(file)
    }

    fn isometric(&self, file: &str, scale: &IsoScale) -> Result<IsoDrawing, GeometryError> {
        self.realizer.isometric(file, scale)
    }

    fn read(&self, file: &str) -> Result<Vec<u8>, FileError> {
        self.realizer.read(file)
    }
}
