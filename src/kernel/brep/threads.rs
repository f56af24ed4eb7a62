//! Work on one thread or on many.
//!
//! Work outside of a pool of threads is done by the thread that calls: small work is done before a pool has started.
//! What is large is put into a pool, and its lists and pairs of tasks are then shared out there.
//!
//! A thread of a pool that has slept for a while is woken on the processor of the one that wakes it where the
//! scheduler cannot tell whether another processor is free, as in many virtual machines; both then share one for
//! milliseconds. New threads are started where least is going on. So long work that falls apart into large pieces at
//! once gets a pool of new threads, at 0.1 ms, rather than those that have slept.

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder, prelude::*};

fn is_pooled() -> bool {
    rayon::current_thread_index().is_some()
}

/// What work finds in the parts that a list is cut into, in order; so many items are worth handing over.
pub(super) fn parts<T: Sync, R: Send>(
    list: &[T],
    chunk: usize,
    work: impl Fn(&[T]) -> R + Sync,
) -> Vec<R> {
    match is_pooled() && list.len() > chunk {
        true => list.par_chunks(chunk).map(&work).collect(),
        false => vec![work(list)],
    }
}

/// What work finds for each item of a list, in order; each is worth handing over.
pub(super) fn each<T: Sync, R: Send>(list: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    match is_pooled() && list.len() > 1 {
        true => list.par_iter().map(&work).collect(),
        false => list.iter().map(work).collect(),
    }
}

/// What two pieces of work find; each is worth handing over.
pub(super) fn both<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_pooled() { rayon::join(first, second) } else { (first(), second()) }
}

/// Does work in the pool at hand.
pub(super) fn pooled<R: Send>(work: impl Fn() -> R + Sync) -> R {
    // Tasks are handed over faster among the threads of a pool than from outside.
    rayon::scope(|_| work())
}

/// Does work in a pool of new threads, as many as the pool at hand has; in that pool if it is a part of its work
/// already.
pub(super) fn crew<R: Send>(work: impl Fn() -> R + Sync) -> R {
    let count = rayon::current_num_threads();
    if is_pooled() || count == 1 {
        return pooled(work);
    }
    let threads = ThreadPoolBuilder::new().num_threads(count);
    let made = threads.build_scoped(ThreadBuilder::run, |crew: &ThreadPool| crew.install(&work));
    made.unwrap_or_else(|_| pooled(work))
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

    #[test]
    fn parts_are_in_order_wherever_they_are_found() {
        let list: Vec<u32> = (0..1000).collect();
        for chunk in [1, 7, 300, 5000] {
            let found = || parts(&list, chunk, <[u32]>::to_vec).concat();
            assert_eq!((found(), pooled(found)), (list.clone(), list.clone()));
        }
        assert_eq!(pooled(|| each(&list, |item| *item)), list);
        assert_eq!((both(|| 1, || 2), pooled(|| both(|| 1, || 2))), ((1, 2), (1, 2)));
    }
}
