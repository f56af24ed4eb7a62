//! Set operations on any trees: they have a closed result that crosses itself nowhere, and volumes add up.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|data: &[u8]| -> Corpus {
    match katachi_fuzz::check(data) {
        Some(Err(fault)) => panic!("{fault}"),
        Some(Ok(())) => Corpus::Keep,
        None => Corpus::Reject,
    }
});
