//! From the shape graph to solids and plane figures: picks the kernel, keeps results by node, and puts
//! the place in the source on what the kernels report.
//!
//! Work is planned as waves of independent units (see [`structure`]); the units of a wave are made at
//! the same time where that pays, and what is made depends on the graph and the tolerance alone.
//!
//! The tolerance holds where the output stands. What is stretched on its way there is made with the
//! tolerance divided by the [`Stretch`] of that way: a ball of radius 5 scaled by 10 has the facets of a
//! ball of radius 50, and so has a ball of radius 500 scaled by 0.1. A scale that differs by direction
//! counts with its largest. Things are kept by node and stretch, so that what is asked of a shape does not
//! depend on who else asks for it.

mod answers;
mod empty;
mod expression;
mod failure;
mod figure;
mod files;
mod heal;
mod import;
mod measure;
mod morphology;
mod paint;
mod plane;
mod primitive;
mod store;
mod structure;
mod sweep;
#[cfg(test)]
mod tests;

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock, PoisonError, RwLock, RwLockReadGuard},
};

use rayon::prelude::*;

pub use self::{empty::warnings, failure::Made, figure::Figure, files::unreadable, store::Solid};
use self::{
    failure::failure,
    paint::Paint,
    store::{Entries, Entry, Store},
    structure::Structure,
};
use crate::{
    base::{Code, Diagnostic, Phase, Watch, World, watch::during},
    geom::{Placement, Stretch, Tolerance, spherical_projection::Projection},
    kernel::{
        brep::{Polyhedron, resolution::lost},
        field::Polyhedral,
        tet::complex::Complex,
    },
    shape::{Kind, Measures, Node, ShapeGraph, ShapeId, Stretched},
};

/// Triangles that one solid, or all operands of one set operation together, may have: at most about
/// 3 GB while they are made.
pub const MOST_TRIANGLES: usize = 20_000_000;

/// Makes shapes of one graph and keeps them.
pub struct Realizer<'w> {
    world: &'w dyn World,
    watch: &'w dyn Watch,
    tolerance: OnceLock<Tolerance>,
    structure: RwLock<Structure>,
    entries: Entries,
    files: Store<String, Arc<Vec<u8>>>,
    measures: Store<ShapeId, Arc<Measures>>,
    /// Boundaries that were asked about, made ready for more questions.
    projections: Store<ShapeId, Arc<Projection>>,
    fields: Store<ShapeId, Arc<Polyhedral>>,
    complexes: Store<ShapeId, Arc<Complex>>,
    /// What readers left out, by the node that asked.
    remarks: Mutex<BTreeMap<ShapeId, Diagnostic>>,
}

impl<'w> Realizer<'w> {
    /// Reads files from `world` and tells `watch` what it is at. A tolerance given here holds against
    /// what the model sets.
    pub fn new(world: &'w dyn World, watch: &'w dyn Watch, tolerance: Option<Tolerance>) -> Self {
        Realizer {
            world,
            watch,
            tolerance: tolerance.map_or_else(OnceLock::new, OnceLock::from),
            structure: RwLock::default(),
            entries: Store::default(),
            files: Store::default(),
            measures: Store::default(),
            projections: Store::default(),
            fields: Store::default(),
            complexes: Store::default(),
            remarks: Mutex::default(),
        }
    }

    /// The chord error of all curves: what was given first, else the default.
    pub fn tolerance(&self) -> Tolerance {
        *self.tolerance.get_or_init(Tolerance::default)
    }

    /// The chord error of what is stretched after it is made.
    fn tolerance_of(&self, unit: Stretched) -> Tolerance {
        self.tolerance().before(unit.stretch)
    }

    /// Makes everything that `roots` need, independent units at the same time. Failures are kept and
    /// come out when a shape is asked for.
    pub fn realize(&self, graph: &ShapeGraph, roots: &[ShapeId]) {
        let units = roots.iter().filter_map(|&id| structure::unit_of(graph, id, Stretch::ONE));
        self.realize_units(graph, units);
    }

    fn realize_units(&self, graph: &ShapeGraph, units: impl IntoIterator<Item = Stretched>) {
        let mut structure = self.structure.write().unwrap_or_else(PoisonError::into_inner);
        structure.extend(graph);
        let waves = structure.plan(graph, units, |unit| self.entries.has(&unit));
        drop(structure);
        if waves.is_empty() {
            return;
        }
        self.watch.expect(waves.iter().map(Vec::len).sum());
        during(self.watch, Phase::Solids, || {
            for wave in waves {
                self.make_wave(graph, &wave);
            }
        });
    }

    fn make_wave(&self, graph: &ShapeGraph, wave: &[Stretched]) {
        let make = |&unit: &Stretched| {
            let entry = self.make(graph, unit);
            self.watch.step();
            (unit, entry)
        };
        let heavy = wave.iter().filter(|unit| is_heavy(graph, unit.id)).count();
        let made: Vec<_> = match heavy {
            0 | 1 => wave.iter().map(make).collect(),
            _ => wave.par_iter().map(make).collect(),
        };
        self.entries.extend(made);
    }

    fn make(&self, graph: &ShapeGraph, unit: Stretched) -> Made<Entry> {
        match graph.kind(unit.id) {
            Kind::Profile => figure::make(self, graph, unit).map(|f| Entry::Figure(Arc::new(f))),
            Kind::Solid if structure::operands(graph.node(unit.id)).is_some() => {
                expression::make(self, graph, unit).map(Entry::Solid)
            }
            Kind::Solid => {
                let solid = primitive::make(self, graph, unit)?;
                check_size(graph, unit.id, solid.mesh().triangle_count())?;
                Ok(Entry::Solid(Solid::exact(solid)))
            }
        }
    }

    /// The solid of a node.
    ///
    /// # Panics
    /// When the node is a profile.
    pub fn solid(&self, graph: &ShapeGraph, id: ShapeId) -> Made<Solid> {
        self.solid_under(graph, Stretched { id, stretch: Stretch::ONE })
    }

    /// The solid of a node, as fine as it must be to be stretched.
    ///
    /// # Panics
    /// When the node is a profile.
    pub fn solid_under(&self, graph: &ShapeGraph, shape: Stretched) -> Made<Solid> {
        self.realize_units(graph, structure::unit_of(graph, shape.id, shape.stretch));
        self.solid_made(graph, shape.id, shape.stretch)
    }

    /// The figure of a profile node.
    ///
    /// # Panics
    /// When the node is a solid.
    pub fn figure(&self, graph: &ShapeGraph, id: ShapeId) -> Made<Arc<Figure>> {
        self.figure_under(graph, Stretched { id, stretch: Stretch::ONE })
    }

    /// The figure of a profile node, as fine as it must be to be stretched.
    ///
    /// # Panics
    /// When the node is a solid.
    pub fn figure_under(&self, graph: &ShapeGraph, shape: Stretched) -> Made<Arc<Figure>> {
        let unit = graph.stretched(shape.id, shape.stretch);
        self.realize_units(graph, [unit]);
        self.figure_made(unit)
    }

    /// The figure of a profile whose entry is made.
    fn figure_made(&self, unit: Stretched) -> Made<Arc<Figure>> {
        match self.entries.get(&unit).expect("planned before")? {
            Entry::Figure(figure) => Ok(figure),
            Entry::Solid(_) => panic!("{unit:?} is a solid"),
        }
    }

    /// The solid of a node whose unit under a stretch is made: placed, tagged and painted.
    fn solid_made(&self, graph: &ShapeGraph, id: ShapeId, outer: Stretch) -> Made<Solid> {
        let wrapped = unwrap(graph, id, Paint::default())?;
        let mut solid = self.unit_made(structure::placed(graph, &wrapped, outer))?;
        if !wrapped.paint.is_none() {
            let mesh = wrapped.paint.applied(solid.polyhedron.mesh());
            solid.polyhedron = Arc::new(Polyhedron::trusted(mesh));
        }
        if !wrapped.placement.is_identity() {
            solid.polyhedron = Arc::new(solid.polyhedron.placed(&wrapped.placement));
            solid.snap *= Stretch::of(wrapped.placement.linear()).factor();
            solid.lost = lost(&solid.polyhedron);
        }
        Ok(solid)
    }

    /// The solid of a unit that is made.
    fn unit_made(&self, unit: Stretched) -> Made<Solid> {
        match self.entries.get(&unit).expect("planned before")? {
            Entry::Solid(solid) => Ok(solid),
            Entry::Figure(_) => panic!("{unit:?} is a profile"),
        }
    }

    /// Warnings about files since the last call, in the order of the nodes.
    pub fn take_remarks(&self) -> Vec<Diagnostic> {
        let mut remarks = self.remarks.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut *remarks).into_values().collect()
    }

    /// Remembers what a reader left out.
    fn remark(&self, graph: &ShapeGraph, id: ShapeId, file: &str, notes: &[String]) {
        if notes.is_empty() {
            return;
        }
        let words = format!("`{file}` was not read whole");
        let warning = Diagnostic::warning(Code::BadFile, words).label(graph.origin(id), "");
        let warning = notes.iter().fold(warning, |warning, note| warning.note(note));
        let mut remarks = self.remarks.lock().unwrap_or_else(PoisonError::into_inner);
        remarks.insert(id, warning);
    }

    fn structure(&self) -> RwLockReadGuard<'_, Structure> {
        self.structure.read().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A solid taken out of its wrappers.
struct Unwrapped {
    core: ShapeId,
    placement: Placement,
    paint: Paint,
}

/// Takes the wrappers off a solid. Fails on a placement that flattens space.
fn unwrap(graph: &ShapeGraph, id: ShapeId, paint: Paint) -> Made<Unwrapped> {
    let mut found = Unwrapped { core: id, placement: Placement::IDENTITY, paint };
    loop {
        let node = graph.node(found.core);
        let Some(child) = structure::wrapped(node) else { return Ok(found) };
        match node {
            Node::Transform { placement, .. } => {
                if placement.inverse().is_none() {
                    return Err(figure::flattened(graph, found.core));
                }
                found.placement = found.placement.after(placement);
            }
            Node::Tag { name, .. } => found.paint = found.paint.tagged(name),
            Node::Paint { color, .. } => found.paint = found.paint.painted(*color),
            _ => {}
        }
        found.core = child;
    }
}

/// Whether making a unit is worth a thread.
fn is_heavy(graph: &ShapeGraph, id: ShapeId) -> bool {
    match graph.node(id) {
        Node::Hull(_)
        | Node::ImportSolid { .. }
        | Node::Revolve { .. }
        | Node::Thickened { .. }
        | Node::SweptAlong(_)
        | Node::SweptBetween(_)
        | Node::Loft { .. }
        | Node::Filled { .. }
        | Node::Metaball { .. }
        | Node::Formula { .. }
        | Node::Offset { .. }
        | Node::Fillet { .. } => true,
        Node::Extrude { twist, .. } => *twist != 0.0,
        node => graph.kind(id) == Kind::Solid && structure::operands(node).is_some(),
    }
}

/// Refuses more triangles than the limit.
fn check_size(graph: &ShapeGraph, id: ShapeId, triangles: usize) -> Made<()> {
    if triangles <= MOST_TRIANGLES {
        return Ok(());
    }
    let words = format!("this needs {triangles} triangles; the limit is {MOST_TRIANGLES}");
    let diagnostic = Diagnostic::error(Code::Limit, words)
        .label(graph.origin(id), "")
        .help("give a larger tolerance or fewer sides");
    Err(failure(diagnostic))
}
