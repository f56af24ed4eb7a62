//! How the command is linked where the GNU linker's driver is known.
//!
//! Most runs of the command take a few milliseconds, and a good part of that is the system putting the program
//! together. At a fixed address there is nothing to relocate, and with the libraries of the system inside there are
//! none to find. Where their archives are not found, they are linked as usual.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The libraries that the standard library asks for, and the archives that hold the same.
const LIBRARIES: [(&str, &str); 7] = [
    ("c", "c"),
    ("m", "m"),
    ("dl", "dl"),
    ("rt", "rt"),
    ("util", "util"),
    ("pthread", "pthread"),
    ("gcc_s", "gcc_eh"),
];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| env::var(key).is_ok_and(|found| found == value);
    let is_native = env::var("HOST") == env::var("TARGET");
    if !(is_native && is("CARGO_CFG_TARGET_OS", "linux") && is("CARGO_CFG_TARGET_ENV", "gnu")) {
        return;
    }
    println!("cargo:rustc-link-arg-bins=-no-pie");
    if let Some(folder) = archives() {
        println!("cargo:rustc-link-arg-bins=-static");
        println!("cargo:rustc-link-arg-bins=-L{}", folder.display());
    }
}

/// A folder where the linker finds the archives first, each by a script that names it; `None` if one is missing or a
/// program of them cannot be linked.
fn archives() -> Option<PathBuf> {
    let folder = Path::new(&env::var_os("OUT_DIR")?).join("archives");
    if folder.exists() {
        fs::remove_dir_all(&folder).ok()?;
    }
    fs::create_dir(&folder).ok()?;
    for (library, archive) in LIBRARIES {
        let script = format!("INPUT(\"{}\")\n", found(archive)?);
        fs::write(folder.join(format!("lib{library}.a")), script).ok()?;
    }
    let (source, program) = (folder.join("trial.c"), folder.join("trial"));
    fs::write(&source, "int main(void) { return 0; }\n").ok()?;
    let mut compiler = Command::new("cc");
    let trial = compiler.args(["-static", "-no-pie", "-o"]).args([program, source]).output();
    trial.is_ok_and(|output| output.status.success()).then_some(folder)
}

/// Where the compiler's driver finds an archive.
fn found(archive: &str) -> Option<String> {
    let name = format!("-print-file-name=lib{archive}.a");
    let output = Command::new("cc").arg(name).output().ok()?;
    let file = String::from_utf8(output.stdout).ok()?.trim().to_string();
    // A name that is not found comes back without a folder.
    Path::new(&file).is_absolute().then_some(file)
}
