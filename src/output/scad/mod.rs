//! OpenSCAD source: the construction tree of shapes, written for OpenSCAD 2021 and later.
//!
//! Every part is a module `part_<name>`, every tagged shape a module `tag_<name>`, every other shape
//! used twice a module `shape_<n>`; the parts are called at the end. What differs between the two
//! languages is turned here: twist is left-handed there, a full `rotate_extrude` starts at -x there,
//! faces of a `polyhedron` run clockwise there, and a profile must lie in xy there.
//!
//! What OpenSCAD cannot express (imported meshes, and texts and imported figures, whose fonts and
//! files it may not have) is asked of [`Realized`] and written as points.
//!
//! # Departures
//! True curves get the facet count that the tolerance asks for, divided by what the placements around them
//! stretch. Where both languages approximate
//! (offsets with round corners, twists) facets need not correspond, both are within the tolerance.
//! OpenSCAD takes every number for exact: faces that only rounding keeps apart (0.1 + 0.2 and 0.3) are one
//! on our lattice and two there, with a skin of no thickness between them.
//! Of nested colours the outermost shows in OpenSCAD, the innermost here; shapes do not differ.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write,
};

use rustc_hash::FxHashMap;
use thiserror::Error;

use crate::{
    geom::{PolyMesh, Region, Stretch, Tolerance},
    shape::{Node, ShapeGraph, ShapeId, Stretched},
};

mod plane;
mod points;
mod source;

/// Deeper trees are cut into modules: keeps the source readable and this writer's stack small.
const DEEPEST: u32 = 24;

/// Shapes made real: what the writer asks for where a construction has no word in OpenSCAD.
pub trait Realized {
    /// The boundary of a solid in mm; `None` if it cannot be made.
    fn mesh(&self, shape: Stretched) -> Option<PolyMesh>;

    /// A profile as polygons of its plane in mm; `None` if it cannot be made.
    fn region(&self, shape: Stretched) -> Option<Region>;
}

/// Why there is no OpenSCAD source.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum ScadError {
    /// [`Realized`] did not give what was asked for.
    #[error(
        "the {what} could not be made, and OpenSCAD has no other way to say it than its points"
    )]
    Unrealized {
        /// The shape.
        shape: ShapeId,
        /// Which kind it is of.
        what: &'static str,
    },
    /// A profile seen edge-on: its placement flattens it.
    #[error("a profile is flattened to a line by its placement; it needs an area")]
    Flattened {
        /// The profile.
        shape: ShapeId,
    },
}

/// The source of named parts. Fails only where `realized` does not give what has to be written as
/// points, or a profile is flattened.
///
/// ```
/// use katachi::base::Span;
/// use katachi::geom::{PolyMesh, Region, Tolerance};
/// use katachi::output::scad;
/// use katachi::shape::{Node, ShapeGraph, Stretched};
/// struct Nothing;
/// impl scad::Realized for Nothing {
///     fn mesh(&self, _: Stretched) -> Option<PolyMesh> { None }
///     fn region(&self, _: Stretched) -> Option<Region> { None }
/// }
/// let mut graph = ShapeGraph::default();
/// let pin = graph.add(Node::Cone { r1: 2., r2: 2., h: 9., sides: Some(6) }, Span::default());
/// let text = scad::write(&graph, &[("pin", pin)], Tolerance::DEFAULT, &Nothing).unwrap();
/// assert!(text.contains("module part_pin() {\n  cylinder(h = 9, r = 2, $fn = 6);\n}"));
/// ```
pub fn write(
    graph: &ShapeGraph,
    parts: &[(&str, ShapeId)],
    tolerance: Tolerance,
    realized: &dyn Realized,
) -> Result<String, ScadError> {
    let plan = Plan::new(graph, parts);
    let mut writer = Writer {
        graph,
        tolerance,
        realized,
        modules: FxHashMap::default(),
        text: String::from("// Made by Katachi. Unit: millimetre.\n\n"),
    };
    let mut names = Names::default();
    for (shape, name) in plan.modules {
        let name = names.claim(&name);
        writer.module(&name, shape)?;
        writer.modules.insert(shape, name);
    }
    let mut calls = String::new();
    for &(name, id) in parts {
        let name = names.claim(&format!("part_{name}"));
        writer.module(&name, graph.stretched(id, Stretch::ONE))?;
        let _ = writeln!(calls, "{name}();");
    }
    writer.text.push_str(&calls);
    Ok(writer.text)
}

/// What is written as a module of its own, children first.
struct Plan {
    modules: Vec<(Stretched, String)>,
}

impl Plan {
    /// A child's number is always below its parent's, so one walk down the numbers counts the uses of
    /// all shapes and one walk up finds their heights.
    fn new(graph: &ShapeGraph, parts: &[(&str, ShapeId)]) -> Plan {
        let mut rest: BTreeMap<Stretched, u32> = BTreeMap::new();
        for &(_, id) in parts {
            *rest.entry(graph.stretched(id, Stretch::ONE)).or_default() += 1;
        }
        let mut uses = vec![];
        while let Some((shape, count)) = rest.pop_last() {
            uses.push((shape, count));
            for &child in graph.node(shape.id).children() {
                *rest.entry(graph.part(shape, child)).or_default() += 1;
            }
        }
        let mut heights: FxHashMap<Stretched, u32> = FxHashMap::default();
        let mut modules = vec![];
        for (shape, count) in uses.into_iter().rev() {
            let node = graph.node(shape.id);
            let under = node.children().iter().map(|&child| heights[&graph.part(shape, child)] + 1);
            let height = under.max().unwrap_or(0);
            let name = match node {
                Node::Tag { name, .. } => Some(format!("tag_{name}")),
                _ if height >= DEEPEST || (count > 1 && is_long(node)) => {
                    Some(format!("shape_{}", modules.len() + 1))
                }
                _ => None,
            };
            heights.insert(shape, if name.is_some() { 0 } else { height });
            modules.extend(name.map(|name| (shape, name)));
        }
        Plan { modules }
    }
}

/// Whether a second writing of the node would be longer than a call.
fn is_long(node: &Node) -> bool {
    !matches!(
        node,
        Node::Empty(_)
            | Node::Box { .. }
            | Node::Cone { .. }
            | Node::Sphere { .. }
            | Node::Rect { .. }
            | Node::Ellipse { .. }
    )
}

/// Identifiers, each given once.
#[derive(Default)]
struct Names(BTreeSet<String>);

impl Names {
    /// The wish with what OpenSCAD's names cannot hold replaced, and numbered if it is taken.
    fn claim(&mut self, wish: &str) -> String {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let plain: String = wish.chars().map(letter).collect();
        let mut name = plain.clone();
        let mut number = 2;
        while !self.0.insert(name.clone()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    }
}

/// The source as it grows.
struct Writer<'a> {
    graph: &'a ShapeGraph,
    tolerance: Tolerance,
    realized: &'a dyn Realized,
    modules: FxHashMap<Stretched, String>,
    text: String,
}

impl Writer<'_> {
    fn module(&mut self, name: &str, shape: Stretched) -> Result<(), ScadError> {
        let _ = writeln!(self.text, "module {name}() {{");
        self.shape(shape, 1)?;
        self.text.push_str("}\n\n");
        Ok(())
    }

    /// One line at a depth.
    fn line(&mut self, depth: usize, line: &str) {
        let _ = writeln!(self.text, "{:1$}{line}", "", 2 * depth);
    }
}
