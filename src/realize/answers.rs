//! Answers to what evaluation asks about shapes and files.

use std::sync::Arc;

use glam::DVec3;

use super::{
    Realizer,
    failure::{Made, failure},
    figure, import, measure, sweep,
};
use crate::{
    base::{Code, Diagnostic, FileError, Phase, watch::during},
    geom::{
        Curve, CurvedGrid, Raster, Tolerance,
        isometric::{IsoDrawing, IsoScale},
        spherical_projection::{Projection, solid_angle},
    },
    input,
    kernel::{
        brep::distance,
        field::{Field, Polyhedral},
        tet::{
            complex::Complex,
            constrained::{NoTetrahedra, tetrahedralize},
            walk::Walk,
        },
    },
    shape::{
        Geometry, GeometryError, Kind, Measures, ShapeGraph, ShapeId, SweptSurface,
        geometry::{Data, Imported, InsideMethod, TetrahedraCount},
        node::TextSpec,
    },
};

impl Geometry for Realizer<'_> {
    fn settle_tolerance(&self, mm: f64) {
        if let Some(tolerance) = Tolerance::new(mm) {
            self.tolerance.get_or_init(|| tolerance);
        }
    }

    fn measures(&self, graph: &ShapeGraph, shape: ShapeId) -> Result<Arc<Measures>, GeometryError> {
        if let Some(measures) = self.measures.get(&shape) {
            return Ok(measures);
        }
        let measures = Arc::new(match graph.kind(shape) {
            Kind::Solid => measure::of_solid(&self.solid(graph, shape)?.polyhedron),
            Kind::Profile => measure::of_figure(&*self.figure(graph, shape)?),
        });
        self.measures.extend([(shape, measures.clone())]);
        Ok(measures)
    }

    fn inside(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
        by: InsideMethod,
    ) -> Result<bool, GeometryError> {
        match by {
            InsideMethod::Field => {
                return Ok(self.field(graph, shape)?.is_some_and(|field| field.holds(point)));
            }
            InsideMethod::Tetrahedra => {
                let complex = self.complex(graph, shape)?;
                return Ok(Walk::new(&complex).locate(point).is_some());
            }
            InsideMethod::Sphere => {}
        }
        if let Some(boundary) = self.projections.get(&shape) {
            return Ok(boundary.inside(point));
        }
        let solid = self.solid(graph, shape)?;
        let boundary = Arc::new(Projection::new(solid.polyhedron.mesh()));
        self.projections.extend([(shape, boundary.clone())]);
        Ok(boundary.inside(point))
    }

    fn solid_angle(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError> {
        let solid = self.solid(graph, shape)?;
        Ok(solid_angle(solid.polyhedron.mesh(), point))
    }

    fn tetrahedra(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
    ) -> Result<TetrahedraCount, GeometryError> {
        let complex = self.complex(graph, shape)?;
        let quality = complex.quality();
        Ok(TetrahedraCount {
            count: complex.mesh().tetrahedra.len(),
            flat: complex.flat_count(),
            smallest: quality.smallest,
            largest: quality.largest,
            histogram: quality.histogram.to_vec(),
        })
    }

    fn distance_to_point(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        point: DVec3,
    ) -> Result<f64, GeometryError> {
        let field = self.field(graph, shape)?;
        field.map(|field| field.distance(point)).ok_or_else(nowhere)
    }

    fn distance_to_curve(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
        curve: &Curve,
    ) -> Result<f64, GeometryError> {
        let solid = self.solid(graph, shape)?;
        distance::curve(&solid.polyhedron, curve).ok_or_else(nowhere)
    }

    fn distance(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError> {
        let (a, b) = (self.solid(graph, a)?, self.solid(graph, b)?);
        distance::solids(&a.polyhedron, &b.polyhedron).ok_or_else(nowhere)
    }

    fn hausdorff(&self, graph: &ShapeGraph, a: ShapeId, b: ShapeId) -> Result<f64, GeometryError> {
        let (a, b) = (self.solid(graph, a)?, self.solid(graph, b)?);
        let found = distance::hausdorff(&a.polyhedron, &b.polyhedron).ok_or_else(nowhere)?;
        Ok(found.least)
    }

    fn text_width(&self, text: &TextSpec) -> Result<f64, GeometryError> {
        figure::text(self, text, self.tolerance()).map(|text| text.width)
    }

    fn import(&self, file: &str) -> Result<Imported, GeometryError> {
        let extension = file.rsplit_once('.').map_or("", |(_, e)| e).to_ascii_lowercase();
        let bytes = self.bytes(file)?;
        match extension.as_str() {
            "stl" | "obj" | "off" | "ply" | "3mf" => Ok(Imported::Solid),
            "svg" | "dxf" => Ok(Imported::Profile),
            "json" | "csv" => input::read_data(file, &bytes)
                .map(|data| Imported::Data(converted(data)))
                .map_err(|error| import::unreadable(file, &error)),
            _ => {
                let words = format!("`{file}` is of no format that is read");
                let help = "stl, obj, off, ply, 3mf, svg, dxf, json and csv are";
                Err(failure(Diagnostic::error(Code::BadFile, words).help(help)))
            }
        }
    }

    fn surface(&self, surface: &SweptSurface) -> Result<CurvedGrid, GeometryError> {
        sweep::surface(surface, self.tolerance())
    }

    fn heights(&self, file: &str) -> Result<Raster, GeometryError> {
        let bytes = self.bytes(file)?;
        input::read_heights(file, &bytes).map_err(|error| import::unreadable(file, &error))
    }

    fn isometric(&self, file: &str, scale: &IsoScale) -> Result<IsoDrawing, GeometryError> {
        let bytes = self.bytes(file)?;
        let found = input::read_isometric(file, &bytes, scale);
        found.map_err(|error| import::unreadable(file, &error))
    }

    fn read(&self, file: &str) -> Result<Vec<u8>, FileError> {
        self.world.read(file)
    }
}

impl Realizer<'_> {
    /// The distance field of a solid, made once; `None` for the empty one.
    fn field(
        &self,
        graph: &ShapeGraph,
        shape: ShapeId,
    ) -> Result<Option<Arc<Polyhedral>>, GeometryError> {
        if let Some(field) = self.fields.get(&shape) {
            return Ok(Some(field));
        }
        let solid = self.solid(graph, shape)?;
        let field = Polyhedral::new(solid.polyhedron.mesh()).map(Arc::new);
        self.fields.extend(field.iter().map(|field| (shape, field.clone())));
        Ok(field)
    }
}

impl Realizer<'_> {
    /// The tetrahedra that fill a solid, made once.
    ///
    /// # Errors
    /// When the solid cannot be made, or not be filled.
    pub fn complex(&self, graph: &ShapeGraph, shape: ShapeId) -> Made<Arc<Complex>> {
        if let Some(complex) = self.complexes.get(&shape) {
            return Ok(complex);
        }
        let solid = self.solid(graph, shape)?;
        let made = during(self.watch, Phase::Solids, || tetrahedralize(solid.polyhedron.mesh()));
        let unfilled = |error: NoTetrahedra| {
            let words = format!("this solid cannot be filled with tetrahedra: {error}");
            failure(Diagnostic::error(Code::Degenerate, words))
        };
        let complex = Arc::new(made.map_err(unfilled)?);
        self.complexes.extend([(shape, complex.clone())]);
        Ok(complex)
    }
}

/// The error for a distance that does not exist.
fn nowhere() -> GeometryError {
    let words = "an empty solid has no distance to anything";
    failure(Diagnostic::error(Code::Degenerate, words))
}

/// Values of a reader as evaluation takes them.
fn converted(data: input::Data) -> Data {
    match data {
        input::Data::Null => Data::Null,
        input::Data::Bool(truth) => Data::Bool(truth),
        input::Data::Number(number) => Data::Number(number),
        input::Data::Text(text) => Data::Text(text.into()),
        input::Data::List(items) => Data::List(items.into_iter().map(converted).collect()),
        input::Data::Record(fields) => {
            let field = |(name, value): (String, _)| (name.into(), converted(value));
            Data::Record(fields.into_iter().map(field).collect())
        }
    }
}
