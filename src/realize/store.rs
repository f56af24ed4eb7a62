//! What was made, by node and stretch.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{failure::Made, figure::Figure};
use crate::{kernel::brep::Polyhedron, shape::Stretched};

/// A solid and how far rounding moved it.
#[derive(Clone, PartialEq, Debug)]
pub struct Solid {
    /// The solid itself.
    pub polyhedron: Arc<Polyhedron>,
    /// The largest movement of a corner by a set operation on the way here, mm.
    pub snap: f64,
    /// A place in mm, where the set operation stood, in which rounding made the boundary cross itself.
    pub crossing: Option<DVec3>,
    /// A place in mm in which coordinates cannot hold it where it was placed last.
    pub lost: Option<DVec3>,
}

impl Solid {
    /// A solid that no set operation has touched.
    pub fn exact(polyhedron: Polyhedron) -> Solid {
        Solid { polyhedron: Arc::new(polyhedron), snap: 0.0, crossing: None, lost: None }
    }
}

/// One thing made.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A solid.
    Solid(Solid),
    /// A plane figure.
    Figure(Arc<Figure>),
}

/// A map behind a lock: things are made once and shared.
#[derive(Debug)]
pub struct Store<K, V>(Mutex<FxHashMap<K, V>>);

impl<K, V> Default for Store<K, V> {
    fn default() -> Self {
        Store(Mutex::new(FxHashMap::default()))
    }
}

impl<K: Eq + std::hash::Hash, V: Clone> Store<K, V> {
    /// What is kept under a key.
    pub fn get(&self, key: &K) -> Option<V> {
        self.hold().get(key).cloned()
    }

    /// Whether anything is kept under a key.
    pub fn has(&self, key: &K) -> bool {
        self.hold().contains_key(key)
    }

    /// Keeps things.
    pub fn extend(&self, things: impl IntoIterator<Item = (K, V)>) {
        self.hold().extend(things);
    }

    /// Gives a thing away.
    pub fn take(&self, key: &K) -> Option<V> {
        self.hold().remove(key)
    }

    fn hold(&self) -> MutexGuard<'_, FxHashMap<K, V>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Everything made for one graph.
pub type Entries = Store<Stretched, Made<Entry>>;
