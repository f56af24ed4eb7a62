//! `katachi view`: one drawing of any model or mesh, or a picture in characters.

use std::{io, io::Write, path::Path};

use glam::DVec3;

use super::{
    Exit, args,
    desk::{Desk, write_beside},
    fail,
};
use crate::{
    app::render::Style,
    session::{Format, Hidden, Projection, Sight, View},
};

/// Draws all parts as one view, writes the file and prints its path.
pub fn run(arguments: &args::View, style: Style) -> io::Result<Exit> {
    let asked = sight(arguments).and_then(|sight| Ok((sight, target(arguments)?)));
    let (sight, (path, format)) = match asked {
        Ok(asked) => asked,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let desk = match Desk::open(&arguments.model, Some(&arguments.making), style) {
        Ok(desk) => desk.importing(),
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = match desk.compile_asked(&session, &arguments.part) {
        Ok(compiled) => compiled,
        Err(diagnostics) => return desk.report(&session, &diagnostics),
    };
    if arguments.text {
        let size = characters(arguments.columns);
        let text = model.preview(&arguments.part, &sight, size, &mut diagnostics);
        desk.watch().end_bar();
        write!(io::stdout().lock(), "{}", text.unwrap_or_default())?;
        return desk.report(&session, &diagnostics);
    }
    let sketch = model.sketch(&arguments.part, &sight, (&path, format), &mut diagnostics);
    let mut written = false;
    diagnostics.extend(model.build(sketch.as_slice(), &mut |artifact, bytes| {
        write_beside(Path::new(&artifact.file), bytes)?;
        written = true;
        Ok(())
    }));
    desk.watch().end_bar();
    if written {
        writeln!(io::stdout().lock(), "{path}")?;
    }
    desk.report(&session, &diagnostics)
}

/// Columns and rows of characters: as many as are asked for, else those of the terminal, one row left free, else 80
/// by 40. So many columns have as many rows as they need.
fn characters(columns: Option<u32>) -> [u32; 2] {
    match (columns, console::Term::stdout().size_checked()) {
        (Some(columns), _) => [columns, MOST_ROWS],
        (None, Some((rows, columns))) => {
            [columns.max(1), rows.saturating_sub(1).max(1)].map(u32::from)
        }
        (None, None) => [80, 40],
    }
}

/// Rows of characters at most.
const MOST_ROWS: u32 = 10_000;

/// The file to write: what `-o` names, else `out/<stem>.svg`.
fn target(arguments: &args::View) -> Result<(String, Format), String> {
    let Some(path) = &arguments.output else {
        let stem = Path::new(&arguments.model.file).file_stem().unwrap_or_default();
        let stem =
            if arguments.model.file == "-" { "stdin".into() } else { stem.to_string_lossy() };
        return Ok((format!("out/{stem}.svg"), Format::SVG));
    };
    let path = path.to_string_lossy().into_owned();
    match Format::of_file(&path).filter(|format| format.is_drawing()) {
        Some(format) => Ok((path, format)),
        None => Err(format!("`{path}`: a view is written as .svg, .pdf or .dxf")),
    }
}

fn sight(arguments: &args::View) -> Result<Sight, String> {
    let target = arguments.target.as_deref().map_or(Ok(DVec3::ZERO), point)?;
    let projection = match &arguments.eye {
        Some(eye) => Projection::Perspective { eye: point(eye)?, fov: None },
        None => from(&arguments.from)?,
    };
    let alone = match projection {
        Projection::Perspective { eye, .. } => eye == target,
        Projection::Direction(direction) => direction == DVec3::ZERO,
        Projection::Side(_) => false,
    };
    if alone {
        return Err("the eye is at the target; they need to be apart".into());
    }
    Ok(Sight { projection, target, hidden: hidden(&arguments.hidden)? })
}

/// A side, or a direction such as `1,-2,1`.
fn from(text: &str) -> Result<Projection, String> {
    let sides = [
        ("front", View::Front),
        ("back", View::Back),
        ("left", View::Left),
        ("right", View::Right),
        ("top", View::Top),
        ("bottom", View::Bottom),
        ("iso", View::Iso),
        ("dimetric", View::Dimetric),
    ];
    if let Some((_, side)) = sides.iter().find(|(name, _)| text.eq_ignore_ascii_case(name)) {
        return Ok(Projection::Side(*side));
    }
    point(text).map(Projection::Direction).map_err(|_| {
        let names = sides.map(|(name, _)| name.to_uppercase()).join(", ");
        format!("`--from {text}`: a side ({names}) or a direction X,Y,Z is needed")
    })
}

fn hidden(text: &str) -> Result<Hidden, String> {
    let depth = text.strip_prefix("depth:").and_then(|k| k.parse().ok());
    match (text.to_ascii_lowercase().as_str(), depth) {
        ("off", _) => Ok(Hidden::Off),
        ("dashed", _) => Ok(Hidden::Dashed),
        (_, Some(k)) => Ok(Hidden::Depth(k)),
        _ => Err(format!("`--hidden {text}`: off, dashed or depth:K is needed")),
    }
}

/// Three finite numbers with commas between them, millimetres.
fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && [x, y, z].iter().all(|c| c.is_finite()) => {
            Ok(DVec3::new(x, y, z))
        }
        _ => Err(format!("`{text}`: a point X,Y,Z is needed")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_sides_or_vectors() {
        assert_eq!(from("ISO"), Ok(Projection::Side(View::Iso)));
        assert_eq!(from("1,-2, 3"), Ok(Projection::Direction(DVec3::new(1.0, -2.0, 3.0))));
        assert!(from("1,2").is_err() && from("isometric").is_err() && from("1,nan,2").is_err());
        assert_eq!(hidden("depth:2"), Ok(Hidden::Depth(2)));
        assert!(hidden("depth:-1").is_err());
    }
}
