//! Threads for one piece of work.
//!
//! A thread of a pool that has slept for a while is woken on the processor of the one that wakes it where the
//! scheduler cannot tell whether another processor is free, as in many virtual machines; both then share one for
//! milliseconds. New threads are started where least is going on. So long work that falls apart into large pieces at
//! once gets a pool of new threads, at 0.1 ms, rather than those that have slept.

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};

/// Does work in a pool of new threads, as many as the pool at hand has; in that pool if it is a part of its work
/// already.
pub(super) fn crew<R: Send>(work: impl Fn() -> R + Sync) -> R {
    let count = rayon::current_num_threads();
    if rayon::current_thread_index().is_some() || count == 1 {
        return rayon::scope(|_| work());
    }
    let threads = ThreadPoolBuilder::new().num_threads(count);
    let made = threads.build_scoped(ThreadBuilder::run, |crew: &ThreadPool| crew.install(&work));
    made.unwrap_or_else(|_| rayon::scope(|_| work()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crew_is_as_many_as_the_pool() {
        let count = rayon::current_num_threads();
        let own = || rayon::current_thread_index().map(|_| rayon::current_num_threads());
        assert_eq!(crew(own), Some(count));
        assert_eq!(crew(|| crew(own)), Some(count));
    }
}
