//! Recursion on the heap.

/// Stack that must be left for one level of any recursion here, without the check.
const RED_ZONE: usize = 256 * 1024;
/// Size of each further piece of stack.
const PIECE: usize = 4 * 1024 * 1024;

/// Runs `work` with enough stack, taking a new piece from the heap when little is left.
#[inline]
pub fn deep<R>(work: impl FnOnce() -> R) -> R {
    stacker::maybe_grow(RED_ZONE, PIECE, work)
}
