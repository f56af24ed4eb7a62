//! OFF, the object file format of Geomview: text, polygons over shared points, face colours.
//!
//! Read are `OFF` and its variants with normals, texture coordinates or colours at the points (`COFF`,
//! `NOFF`, `STOFF` ...), whose additions are left out. Face colours are kept.

use glam::dvec3;

use super::{
    Place, ReadError,
    error::{Format, shortened},
    soup::Soup,
};
use crate::geom::{PolyMesh, mesh::Color};

const OFF: Format = Format("OFF");

/// The lines that say something, numbered from 1, comments left out.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text
        .lines()
        .enumerate()
        .map(|(number, line)| (number + 1, line.split('#').next().unwrap_or_default().trim()));
    lines.filter(|(_, line)| !line.is_empty())
}

/// The mesh of an OFF file.
///
/// # Errors
/// Counts that do not fit the file, words out of place, numbers of points that do not exist, all with
/// their line.
pub fn read(bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    let text = OFF.text(bytes)?;
    let mut lines = lines(text).peekable();
    let (points, faces) = counts(&mut lines)?;
    let end = text.lines().count();
    if points.saturating_add(faces) > end {
        let found = format!("{points} points and {faces} faces announced in {end} lines");
        return Err(OFF.error(Place::File, found, "each takes a line"));
    }
    let mut soup = Soup::new(OFF);
    let missing = |what: &str| OFF.error(Place::Line(end), "the end of the file", what);
    for _ in 0..points {
        let (number, line) = lines.next().ok_or_else(|| missing("another point is needed"))?;
        let mut words = line.split_whitespace();
        let mut next = || OFF.number(words.next().unwrap_or_default(), Place::Line(number));
        soup.mesh.points.push(dvec3(next()?, next()?, next()?));
    }
    for _ in 0..faces {
        let (number, line) = lines.next().ok_or_else(|| missing("another face is needed"))?;
        face(&mut soup, number, line)?;
    }
    soup.finish()
}

fn counts<'a>(
    lines: &mut std::iter::Peekable<impl Iterator<Item = (usize, &'a str)>>,
) -> Result<(usize, usize), ReadError> {
    let head = |line: &str| line.split_whitespace().next().unwrap_or_default().to_string();
    let first = lines.peek().map(|(_, line)| head(line)).unwrap_or_default();
    let mut skipped = 0;
    if first.ends_with("OFF") {
        if first.contains(['4', 'n']) {
            return Err(OFF.error(
                Place::Line(1),
                format!("\"{first}\""),
                "points of three coordinates are needed",
            ));
        }
        let alone = lines.peek().is_some_and(|(_, line)| line.split_whitespace().count() == 1);
        if alone {
            lines.next();
        } else {
            skipped = 1;
        }
    }
    let needed = "a line with the numbers of points, faces and edges is needed";
    let Some((number, line)) = lines.next() else {
        return Err(OFF.error(Place::File, "the end of the file", needed));
    };
    let mut words = line.split_whitespace().skip(skipped).map(str::parse::<usize>);
    match (words.next(), words.next()) {
        (Some(Ok(points)), Some(Ok(faces))) => Ok((points, faces)),
        _ => Err(OFF.error(Place::Line(number), format!("\"{}\"", shortened(line)), needed)),
    }
}

fn face(soup: &mut Soup, number: usize, line: &str) -> Result<(), ReadError> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let count = words[0].parse::<usize>().ok().filter(|&n| n >= 1 && n < words.len());
    let Some(count) = count else {
        let found = format!("\"{}\"", shortened(line));
        return Err(OFF.error(
            Place::Line(number),
            found,
            "a face is its number of corners, then so many numbers of points",
        ));
    };
    let mut corners = Vec::with_capacity(count);
    for word in &words[1..=count] {
        let index = word.parse::<u32>().ok().filter(|&i| (i as usize) < soup.mesh.points.len());
        corners.push(index.ok_or_else(|| {
            let needed = format!(
                "a number below {} is needed, there are so many points",
                soup.mesh.points.len()
            );
            OFF.error(Place::Line(number), format!("point \"{}\"", shortened(word)), needed)
        })?);
    }
    soup.face(&corners, color(&words[count + 1..]))
}

/// Three or four numbers: whole ones up to 255, or fractions up to 1.
fn color(words: &[&str]) -> Option<Color> {
    let [r, g, b] = words.get(..3)?.first_chunk::<3>()?;
    let fractions = [r, g, b].iter().any(|w| w.contains('.'));
    let part = |word: &str| {
        let value = word.parse::<f64>().ok()? * if fractions { 255.0 } else { 1.0 };
        (0.0..=255.0).contains(&value).then(|| value.round() as u8)
    };
    Some(Color { r: part(r)?, g: part(g)?, b: part(b)? })
}
