//! A host of string literals with simple answers about shapes.

use std::sync::{Arc, Mutex};

use glam::{DMat3, DVec3};
use katachi::{
    base::{Code, Diagnostic, FileError, Shelf, SourceMap, World},
    eval::{Evaluator, Host, InstanceId, Limits, Loaded, Override, library},
    geom::{
        Curve, CurvedGrid, Raster,
        isometric::{IsoDrawing, IsoScale},
    },
    shape::{
        Geometry, GeometryError, Measures, Node, ShapeGraph, ShapeId, SweptSurface,
        geometry::{Data, Imported, InsideMethod, TetrahedraCount},
        node::TextSpec,
    },
    syntax,
};

/// Files by name; shapes are measured as if boxes were all there is.
pub struct Bench<'a> {
    shelf: Shelf<'a>,
    pub sources: Mutex<SourceMap>,
}

impl<'a> Bench<'a> {
    pub fn new(files: &'a [(&'a str, &'a str)]) -> Bench<'a> {
        Bench { shelf: Shelf(files), sources: Mutex::default() }
    }

    pub fn slice(&self, span: katachi::base::Span) -> String {
        self.sources.lock().expect("one thread").slice(span).to_string()
    }
}

impl Host for Bench<'_> {
    fn load(&self, path: &str) -> Result<Arc<Loaded>, Diagnostic> {
        let bytes = match library::module(path) {
            Some(text) => text.as_bytes().to_vec(),
            None => self.shelf.read(path).map_err(|error| {
                Diagnostic::error(Code::UnreadableFile, format!("cannot read `{path}`: {error}"))
            })?,
        };
        let text: Arc<str> = String::from_utf8_lossy(&bytes).into();
        let source = self.sources.lock().expect("one thread").add(path, text.clone());
        let (program, diagnostics) = syntax::parse(source, &text);
        Ok(Arc::new(Loaded { path: path.into(), text, source, program, diagnostics }))
    }
}

fn size_of(graph: &ShapeGraph, id: ShapeId) -> (f64, Option<[DVec3; 2]>) {
    match graph.node(id) {
        Node::Box { min, max } => ((*max - *min).element_product(), Some([*min, *max])),
        Node::Sphere { r, .. } => (r * r * r, Some([DVec3::splat(-r), DVec3::splat(*r)])),
        Node::Cone { r1, h, .. } => {
            (r1 * r1 * h, Some([DVec3::new(-r1, -r1, 0.0), DVec3::new(*r1, *r1, *h)]))
        }
        Node::Transform { placement, child } => {
            let (volume, bounds) = size_of(graph, *child);
            let moved = bounds.map(|[a, b]| {
                let (a, b) = (placement.point(a), placement.point(b));
                [a.min(b), a.max(b)]
            });
            (volume * placement.linear().determinant().abs(), moved)
        }
        Node::Tag { child, .. } | Node::Paint { child, .. } => size_of(graph, *child),
        Node::Union(list) => {
            let parts: Vec<_> = list.iter().map(|id| size_of(graph, *id)).collect();
            let bounds = parts.iter().filter_map(|part| part.1);
            let joined = bounds.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            (parts.iter().map(|part| part.0).sum(), joined)
        }
        Node::Difference(list) => {
            let (first, bounds) = size_of(graph, list[0]);
            (first - list[1..].iter().map(|id| size_of(graph, *id).0).sum::<f64>(), bounds)
        }
        Node::ImportSolid { .. } => (6.0, Some([DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)])),
        _ => (0.0, None),
    }
}

impl Geometry for Bench<'_> {
    fn measures(&self, graph: &ShapeGraph, id: ShapeId) -> Result<Arc<Measures>, GeometryError> {
        let (volume, bounds) = size_of(graph, id);
        let centroid = bounds.map_or(DVec3::ZERO, |[a, b]| (a + b) / 2.0);
        Ok(Arc::new(Measures {
            volume,
            area: 22.0,
            length: 6.0,
            bounds,
            centroid,
            inertia: DMat3::IDENTITY,
            triangles: 12,
            euler: 2,
            shells: 1,
            closed: true,
        }))
    }

    fn inside(
        &self,
        graph: &ShapeGraph,
        id: ShapeId,
        p: DVec3,
        _: InsideMethod,
    ) -> Result<bool, GeometryError> {
        let (_, bounds) = size_of(graph, id);
        Ok(bounds.is_some_and(|[a, b]| p.cmpge(a).all() && p.cmple(b).all()))
    }

    fn solid_angle(&self, _: &ShapeGraph, _: ShapeId, _: DVec3) -> Result<f64, GeometryError> {
        Ok(4.0 * std::f64::consts::PI)
    }

    fn tetrahedra(&self, _: &ShapeGraph, _: ShapeId) -> Result<TetrahedraCount, GeometryError> {
        let histogram = vec![0; 18];
        Ok(TetrahedraCount { count: 6, flat: 0, smallest: 45.0, largest: 120.0, histogram })
    }

    fn distance_to_point(
        &self,
        _: &ShapeGraph,
        _: ShapeId,
        p: DVec3,
    ) -> Result<f64, GeometryError> {
        Ok(p.length())
    }

    fn distance_to_curve(
        &self,
        _: &ShapeGraph,
        _: ShapeId,
        curve: &Curve,
    ) -> Result<f64, GeometryError> {
        Ok(curve.at(0.0).length())
    }

    fn distance(&self, _: &ShapeGraph, _: ShapeId, _: ShapeId) -> Result<f64, GeometryError> {
        Ok(1.5)
    }

    fn hausdorff(&self, _: &ShapeGraph, _: ShapeId, _: ShapeId) -> Result<f64, GeometryError> {
        Ok(0.001)
    }

    fn text_width(&self, text: &TextSpec) -> Result<f64, GeometryError> {
        Ok(text.size * text.text.chars().count() as f64)
    }

    fn import(&self, file: &str) -> Result<Imported, GeometryError> {
        if self.shelf.read(file).is_err() {
            let error = Diagnostic::error(Code::UnreadableFile, format!("cannot read {file}"));
            return Err(GeometryError { diagnostic: Box::new(error) });
        }
        Ok(match file.rsplit('.').next() {
            Some("svg") => Imported::Profile,
            Some("json") => Imported::Data(Data::List(vec![Data::Number(1.5), Data::Null])),
            _ => Imported::Solid,
        })
    }

    fn surface(&self, _: &SweptSurface) -> Result<CurvedGrid, GeometryError> {
        let row = |x: f64| vec![DVec3::X * x, DVec3::X * x + DVec3::Y];
        Ok(CurvedGrid::new(&[row(0.0), row(1.0)], false, false).expect("a cell"))
    }

    fn heights(&self, _: &str) -> Result<Raster, GeometryError> {
        Ok(Raster::new(2, vec![0.0, 1.0, 2.0, 3.0]).expect("2 x 2 numbers"))
    }

    fn isometric(&self, _: &str, scale: &IsoScale) -> Result<IsoDrawing, GeometryError> {
        Ok(IsoDrawing { vertices: vec![scale.origin], ..IsoDrawing::default() })
    }

    fn read(&self, file: &str) -> Result<Vec<u8>, FileError> {
        self.shelf.read(file)
    }
}

/// What came of a file.
pub struct Ran {
    pub diagnostics: Vec<Diagnostic>,
    /// Text under each diagnostic's first label.
    pub marked: Vec<String>,
}

impl Ran {
    /// All messages, notes and helps in one text.
    pub fn words(&self) -> String {
        let mut words = String::new();
        for (diagnostic, marked) in self.diagnostics.iter().zip(&self.marked) {
            words += &format!("{}: {} @{marked}@\n", diagnostic.code, diagnostic.message);
            for label in &diagnostic.labels {
                words += &format!("  label {}\n", label.message);
            }
            for note in diagnostic.notes.iter().chain(&diagnostic.help) {
                words += &format!("  {note}\n");
            }
        }
        words
    }
}

/// Evaluates everything of `main.kata`: outputs, exports, and tests, which must pass.
pub fn run_files(files: &[(&str, &str)], overrides: &[(&str, &str)]) -> Ran {
    run_limited(files, overrides, Limits::default())
}

pub fn run_limited(files: &[(&str, &str)], overrides: &[(&str, &str)], limits: Limits) -> Ran {
    let bench = Bench::new(files);
    let mut evaluator = Evaluator::new(&bench, limits);
    let given: Vec<(String, Override)> = overrides
        .iter()
        .map(|(name, text)| {
            let source = bench.sources.lock().expect("one thread").add("<-D>", *text);
            (name.to_string(), Override::Source { source, text: (*text).into() })
        })
        .collect();
    let mut diagnostics = vec![];
    if let Some(instance) = evaluator.open("main.kata", &given) {
        diagnostics = evaluate_all(&mut evaluator, instance);
    }
    diagnostics.extend(evaluator.take_diagnostics());
    let marked = diagnostics.iter().map(|d| d.span().map_or(String::new(), |s| bench.slice(s)));
    Ran { marked: marked.collect(), diagnostics }
}

fn evaluate_all(evaluator: &mut Evaluator, instance: InstanceId) -> Vec<Diagnostic> {
    for output in evaluator.outputs(instance) {
        let _ = evaluator.product_of(instance, &output.name);
    }
    for i in 0..evaluator.exports(instance).len() {
        let _ = evaluator.export_products(instance, i);
    }
    evaluator.check(instance, &[]);
    let mut diagnostics = vec![];
    for i in 0..evaluator.tests(instance).len() {
        let outcome = evaluator.run_test(instance, i, false);
        assert_eq!(outcome.passed, outcome.diagnostics.iter().all(|d| !d.is_error()));
        diagnostics.extend(outcome.diagnostics);
    }
    diagnostics
}

/// The words of all diagnostics of one file.
pub fn say(text: &str) -> String {
    run_files(&[("main.kata", text)], &[]).words()
}

/// Asserts that a file is evaluated without any message.
pub fn holds(text: &str) {
    let words = say(text);
    assert!(words.is_empty(), "{text}\n{words}");
}

/// Asserts that the messages of a file hold all these words.
pub fn refuses(text: &str, needed: &[&str]) {
    let words = say(text);
    for part in needed {
        assert!(words.contains(part), "{text}\nshould say {part:?}, says\n{words}");
    }
}
