//! The one road from a source file to results: sources, evaluation, solids, files.
//!
//! ```
//! use katachi::{base::{Shelf, watch::Unwatched}, session::Session};
//! let shelf = Shelf(&[("plate.kata", "box(40, 30, 5)")]);
//! let session = Session::new(&shelf, &Unwatched, None);
//! let (mut model, diagnostics) = session.compile("plate.kata", &[]);
//! assert!(diagnostics.is_empty());
//! let measured = model.measure(&[]);
//! assert_eq!(measured.found[0].0, "plate");
//! assert_eq!(measured.found[0].1.volume, 6000.0);
//! ```

mod artifact;
mod axes;
mod clash;
mod cut;
mod data;
mod drafting;
mod host;
mod model;
mod outline;
mod patterns;
mod shading;
mod shadows;
mod sheet;
mod subjects;
mod wrapped;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rustc_hash::FxHashMap;

pub use self::data::to_json;
pub use self::{
    artifact::{Artifact, Content, Format, Paper, PaperKind, Part},
    model::{Lines, Measured, Model, Sight},
};
use crate::{
    base::{Diagnostic, SourceMap, Watch, World},
    eval::{Loaded, Override},
    realize::Realizer,
};
pub use crate::{
    eval::{Domain, ParamInfo, TestInfo, TestOutcome, Value},
    geom::{Hidden, Tolerance, View},
    shape::{Measures, drawing::Projection},
};

/// A parameter's value given from outside.
#[derive(Clone, PartialEq, Debug)]
pub enum Given {
    /// An expression of the language.
    Text(String),
    /// A value from a JSON file.
    Json(serde_json::Value),
}

/// Files and solids of one run. Everything read and made is kept until it ends.
pub struct Session<'w> {
    world: &'w dyn World,
    watch: &'w dyn Watch,
    sources: Mutex<SourceMap>,
    loaded: Mutex<FxHashMap<String, Arc<Loaded>>>,
    realizer: Realizer<'w>,
}

impl<'w> Session<'w> {
    /// A run over the files of `world`. A tolerance given here holds against `set tolerance`.
    pub fn new(
        world: &'w dyn World,
        watch: &'w dyn Watch,
        tolerance: Option<Tolerance>,
    ) -> Session<'w> {
        Session {
            world,
            watch,
            sources: Mutex::default(),
            loaded: Mutex::default(),
            realizer: Realizer::new(world, watch, tolerance),
        }
    }

    /// Reads the file `entry` and all it uses and evaluates its top level with the given parameters.
    /// What can be had in spite of errors is in the model.
    pub fn compile(&self, entry: &str, given: &[(String, Given)]) -> (Model<'_>, Vec<Diagnostic>) {
        let overrides =
            given.iter().map(|(name, value)| (name.clone(), self.override_of(name, value)));
        Model::open(self, entry, overrides.collect())
    }

    /// A parameter as the evaluator takes it. Its text becomes a source, so that errors can show it.
    fn override_of(&self, name: &str, given: &Given) -> Override {
        match given {
            Given::Json(value) => Override::Data(data::from_json(value)),
            Given::Text(text) => {
                let source = self.sources().add(format!("-D {name}"), &**text);
                Override::Source { source, text: (&**text).into() }
            }
        }
    }

    /// The texts read so far, which the spans of diagnostics speak of.
    pub fn sources(&self) -> MutexGuard<'_, SourceMap> {
        hold(&self.sources)
    }
}

fn hold<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
