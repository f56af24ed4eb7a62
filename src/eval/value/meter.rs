//! How many values are alive: what the limit on memory counts.

use std::cell::Cell;

thread_local! {
    /// Elements of all living lists, records, strings and captures of this thread. One evaluation
    /// runs on one thread, so the count, and with it the limit, is the same in every run.
    static LIVE: Cell<u64> = const { Cell::new(0) };
}

/// Characters of a string that count as one value: both take about 16 bytes.
pub const BYTES_A_VALUE: usize = 16;

/// Elements alive on this thread.
pub fn live() -> u64 {
    LIVE.get()
}

pub(super) fn take(count: usize) {
    LIVE.set(LIVE.get().saturating_add(count as u64));
}

pub(super) fn give_back(count: usize) {
    // A thread that ends may drop its last values after the counter.
    let _ = LIVE.try_with(|live| live.set(live.get().saturating_sub(count as u64)));
}
