//! `katachi new`: a folder with a model that builds and a test that passes.

use std::{
    fs,
    io::{self, Write},
    path::Path,
};

use super::{Exit, args::New, fail};
use crate::app::{disk::ROOT_MARK, render::Style, write::write_whole};

/// What the model of a new project says.
const MODEL: &str = "\
//! A plate with a hole.

/// Edge of the plate.
param width = 40mm in 10mm..200mm

plate = box(width, width, 5mm)
hole = cylinder(d = width / 2, h = 20mm).move(z = -5mm)

part NAME = plate - hole

test \"the hole goes through\" {
    assert genus(NAME) == 1
}
";

/// Makes the folder. An existing one must be empty.
pub fn run(arguments: &New, style: Style) -> io::Result<Exit> {
    let folder = &arguments.name;
    let Some(name) = folder.file_name().map(|name| identifier(&name.to_string_lossy())) else {
        return fail(style, Exit::Usage, format!("`{}` does not name a folder", folder.display()));
    };
    if is_taken(folder) {
        let words = format!("`{}` exists and is not empty", folder.display());
        return fail(style, Exit::Usage, words);
    }
    let file = format!("{name}.kata");
    let readme = format!("# {name}\n\n`katachi build {file}` writes `out/{name}.stl`.\n");
    let files = [
        (
            ROOT_MARK,
            format!(
                "# The presence of this file makes this folder the project's root.\nname = \"{name}\"\n"
            ),
        ),
        (&*file, MODEL.replace("NAME", &name)),
        ("README.md", readme),
    ];
    for (path, text) in files {
        if let Err(words) = write_whole(folder, path, text.as_bytes()) {
            return fail(style, Exit::Model, words);
        }
    }
    writeln!(io::stdout(), "{}", folder.join(&file).display())?;
    Ok(Exit::Ok)
}

/// Whether something stands in the way.
fn is_taken(folder: &Path) -> bool {
    match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_some(),
        Err(_) => folder.symlink_metadata().is_ok(),
    }
}

/// The folder's name with everything replaced that a name in the language cannot have.
fn identifier(folder: &str) -> String {
    let fits = |c: char| if c.is_alphanumeric() || c == '_' { c } else { '_' };
    let name: String = folder.chars().map(fits).collect();
    match name.starts_with(|c: char| c.is_alphabetic()) {
        true => name,
        false => format!("model_{name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_become_names() {
        assert_eq!(identifier("lid"), "lid");
        assert_eq!(identifier("my-box 2"), "my_box_2");
        assert_eq!(identifier("3d"), "model_3d");
    }
}
