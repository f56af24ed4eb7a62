//! Prints what bytes stand for, and tries random ones.

use katachi_fuzz::{Bytes, check};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["show", path] => show(&std::fs::read(path).expect("the file can be read")),
        ["try", first, count] => {
            let number = |text: &str| text.parse::<u64>().expect("a number");
            (number(first)..).take(number(count) as usize).for_each(attempt);
        }
        _ => println!("show <file> | try <first seed> <how many>"),
    }
}

fn show(bytes: &[u8]) {
    let mut bytes = Bytes(bytes);
    println!("part a = {}\npart b = {}", bytes.part(0), bytes.part(0));
}

/// Tries the bytes of a seed; shrinks and shows what fails.
fn attempt(seed: u64) {
    let mut state = seed;
    let mut next = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as u8
    };
    let bytes: Vec<u8> = (0..120).map(|_| next()).collect();
    if fails(&bytes).is_some() {
        let small = shrunk(bytes);
        println!("\n// seed {seed}: {}", fails(&small).unwrap_or_default());
        show(&small);
    }
}

fn fails(bytes: &[u8]) -> Option<String> {
    let found = std::panic::catch_unwind(|| check(bytes));
    found.unwrap_or_else(|_| Some(Err("panics".to_string())))?.err()
}

/// Fewer and smaller bytes that still fail.
fn shrunk(mut bytes: Vec<u8>) -> Vec<u8> {
    loop {
        let before = bytes.clone();
        for at in (0..bytes.len()).rev() {
            for length in [16, 4, 1] {
                let mut fewer = bytes.clone();
                fewer.drain(at.min(fewer.len())..(at + length).min(fewer.len()));
                if fewer.len() < bytes.len() && fails(&fewer).is_some() {
                    bytes = fewer;
                }
            }
            for smaller in [0, 1, 2] {
                if at < bytes.len() && bytes[at] > smaller {
                    let mut simpler = bytes.clone();
                    simpler[at] = smaller;
                    if fails(&simpler).is_some() {
                        bytes = simpler;
                        break;
                    }
                }
            }
        }
        if bytes == before {
            return bytes;
        }
    }
}
