//! How the command is linked where the GNU linker's driver is known.
//!
//! Most runs of the command take a few milliseconds, and a good part of that is the system putting the program
//! together. At a fixed address there is nothing to relocate, and with the unwinder inside there is one
//! library less to find. Where the unwinder's archive is not found, the library is linked as usual.

use std::{env, path::Path, process::Command};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| env::var(key).is_ok_and(|found| found == value);
    let is_native = env::var("HOST") == env::var("TARGET");
    if !(is_native && is("CARGO_CFG_TARGET_OS", "linux") && is("CARGO_CFG_TARGET_ENV", "gnu")) {
        return;
    }
    println!("cargo:rustc-link-arg-bins=-no-pie");
    let asked = Command::new("cc").arg("-print-file-name=libgcc_eh.a").output();
    let answer = asked.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    // A name that is not found comes back without a folder.
    let folder = answer.ok().and_then(|file| Some(Path::new(&file).parent()?.to_owned()));
    if let Some(folder) = folder.filter(|folder| folder.is_absolute()) {
        println!("cargo:rustc-link-search=native={}", folder.display());
        println!("cargo:rustc-link-lib=static:-bundle=gcc_eh");
    }
}
