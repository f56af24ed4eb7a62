//! How long work is followed from outside: phases for timings, steps for a progress bar.
//!
//! The library knows no clock and prints nothing; it tells a [`Watch`] what it is at.

/// The kinds of work that are timed apart.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Phase {
    /// From text to syntax tree.
    Parse,
    /// From syntax tree to values and the shape graph.
    Eval,
    /// From the shape graph to solids.
    Solids,
    /// Line drawings.
    Drawings,
    /// Halftones.
    Halftones,
    /// Encoding and writing of files.
    Write,
}

/// Follows the work. Phases nest and are entered and left on one thread; steps may come from any.
pub trait Watch: Sync {
    /// A phase begins; the one around it pauses.
    fn enter(&self, phase: Phase);

    /// The innermost phase ends.
    fn leave(&self);

    /// So many more steps are known to lie ahead.
    fn expect(&self, steps: usize);

    /// One step is done.
    fn step(&self);

    /// A long stage of a step begins, such as "fillet"; from any thread.
    fn stage(&self, name: &'static str);
}

/// A watch that looks away.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn enter(&self, _: Phase) {}
    fn leave(&self) {}
    fn expect(&self, _: usize) {}
    fn step(&self) {}
    fn stage(&self, _: &'static str) {}
}

/// Runs `work` as one phase.
pub fn during<T>(watch: &dyn Watch, phase: Phase, work: impl FnOnce() -> T) -> T {
    watch.enter(phase);
    let result = work();
    watch.leave();
    result
}
