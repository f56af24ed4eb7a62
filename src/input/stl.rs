//! STL, binary and ASCII: triangles with their corners written out.
//!
//! A file of exactly 84 + 50 n bytes, n from its header, is binary, whatever it begins with: many
//! binary files begin with "solid". Equal corners become one point. Read in memory of about 50 bytes for each
//! triangle. Triangles are taken in the order of the file, those of a large one in no order along a curve.

use glam::dvec3;

use super::{
    Place, ReadError,
    corners::Corners,
    error::{Format, MOST_COORDINATE, shortened},
    order::along_curve,
    soup::MOST_FACES,
};
use crate::geom::{Origin, PolyMesh, Surface};

const STL: Format = Format("STL");
const HEADER: usize = 84;
const RECORD: usize = 50;

/// The mesh of an STL file, coordinates as in the file (millimetres by custom).
///
/// # Errors
/// A length that does not fit the number of triangles, NaN or infinite coordinates (with the number
/// of the triangle), words out of place (with the line), more than [`MOST_FACES`] triangles, none.
pub fn read(bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    let count =
        bytes.get(80..HEADER).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize);
    let fits = count.is_some_and(|n| bytes.len() == HEADER + RECORD * n);
    if !fits && is_ascii(bytes) {
        return read_ascii(STL.text(bytes)?);
    }
    let Some(count) = count else {
        let found = format!("{} bytes", bytes.len());
        return Err(STL.error(
            Place::File,
            found,
            "a binary file has a header of 84 bytes, an ASCII file begins with \"solid\"",
        ));
    };
    if !fits {
        let found = format!(
            "the header announces {count} triangles, which take {} bytes, and the file has {}",
            HEADER + RECORD * count,
            bytes.len()
        );
        return Err(STL.error(
            Place::Byte(80),
            found,
            "the file must be as long as its header says",
        ));
    }
    read_binary(&bytes[HEADER..], count)
}

/// Whether the first word is "solid" and there is text of a facet or of the end behind it.
fn is_ascii(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let head = &start[..start.len().min(2000)];
    let has = |word: &[u8]| head.windows(word.len()).any(|w| w.eq_ignore_ascii_case(word));
    start.len() >= 5
        && start[..5].eq_ignore_ascii_case(b"solid")
        && !head.contains(&0)
        && (has(b"facet") || has(b"endsolid"))
}

fn read_binary(records: &[u8], count: usize) -> Result<PolyMesh, ReadError> {
    check_count(count)?;
    let triangle = |number: usize| corners_of(&records[number * RECORD..][..RECORD]);
    let whole = |point: &[f32; 3]| point.iter().all(|c| c.abs() <= MOST_COORDINATE as f32);
    for number in 0..count {
        if let Some(point) = triangle(number).into_iter().find(|point| !whole(point)) {
            return Err(not_finite(number, point));
        }
    }
    let mut corners = Corners::with_triangles(count);
    let mut take = |number: usize| {
        let numbers = triangle(number).map(|point| corners.number(point));
        corners.triangle(numbers);
    };
    match along_curve(count, triangle) {
        Some(order) => order.into_iter().for_each(|number| take(number as usize)),
        None => (0..count).for_each(take),
    }
    finish(corners)
}

/// The corners in a record.
fn corners_of(record: &[u8]) -> [[f32; 3]; 3] {
    let value = |at: usize| {
        f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]])
    };
    [12, 24, 36].map(|at| [value(at), value(at + 4), value(at + 8)])
}

fn check_count(count: usize) -> Result<(), ReadError> {
    match count {
        0 => Err(STL.error(Place::File, "no triangles", "at least one is needed")),
        n if n > MOST_FACES => {
            Err(STL.limit(format!("a mesh of {n} triangles"), format!("{MOST_FACES} triangles")))
        }
        _ => Ok(()),
    }
}

fn not_finite(number: usize, [x, y, z]: [f32; 3]) -> ReadError {
    let found = format!("a corner at ({x}, {y}, {z})");
    STL.error(Place::Triangle(number), found, "coordinates must be finite numbers")
}

fn finish(corners: Corners) -> Result<PolyMesh, ReadError> {
    let (points, triangles) = corners.into_parts();
    check_count(triangles.len())?;
    let points = points.iter().map(|p| dvec3(p[0].into(), p[1].into(), p[2].into()));
    let mut mesh = PolyMesh::with_points(points.collect());
    mesh.reserve(triangles.len(), 3 * triangles.len());
    let origin = mesh.add_origin(Origin::of(Surface::Facets));
    for triangle in triangles {
        let plane = mesh.add_plane();
        mesh.push_face(&[triangle], plane, origin);
    }
    Ok(mesh)
}

/// The lines of an ASCII file that say something, numbered from 1.
struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    last: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<std::str::SplitWhitespace<'a>> {
        for (number, line) in self.lines.by_ref() {
            self.last = number + 1;
            if !line.trim().is_empty() {
                return Some(line.split_whitespace());
            }
        }
        None
    }

    /// The next line must be these words.
    fn expect(&mut self, words: &[&str]) -> Result<(), ReadError> {
        let line: Option<Vec<&str>> = self.next().map(Iterator::collect);
        let found = line.as_deref().unwrap_or(&[]);
        let same = |(word, found): (&&str, &&str)| word.eq_ignore_ascii_case(found);
        if found.len() >= words.len() && words.iter().zip(found).all(same) {
            return Ok(());
        }
        Err(self.error(line.map(|l| l.join(" ")), &format!("\"{}\" is needed", words.join(" "))))
    }

    fn error(&self, line: Option<String>, needed: &str) -> ReadError {
        let found =
            line.map_or("the end of the file".to_string(), |l| format!("\"{}\"", shortened(&l)));
        STL.error(Place::Line(self.last), found, needed)
    }

    fn vertex(&mut self) -> Result<[f32; 3], ReadError> {
        let words: Vec<&str> = self.next().map(Iterator::collect).unwrap_or_default();
        let [name, coordinates @ ..] = words.as_slice() else {
            return Err(self.error(None, "\"vertex x y z\" is needed"));
        };
        if !name.eq_ignore_ascii_case("vertex") || coordinates.len() != 3 {
            return Err(self.error(Some(words.join(" ")), "\"vertex x y z\" is needed"));
        }
        let mut point = [0.0; 3];
        for (value, word) in point.iter_mut().zip(coordinates) {
            *value = STL.number(word, Place::Line(self.last))? as f32;
        }
        Ok(point)
    }
}

fn read_ascii(text: &str) -> Result<PolyMesh, ReadError> {
    let mut lines = Lines { lines: text.lines().enumerate(), last: 0 };
    let mut corners = Corners::with_triangles(0);
    while let Some(mut words) = lines.next() {
        let word = words.next().unwrap_or_default();
        let is = |name: &str| word.eq_ignore_ascii_case(name);
        if is("solid") || is("endsolid") {
            continue;
        }
        if !is("facet") {
            return Err(lines.error(Some(word.to_string()), "\"facet\" or \"endsolid\" is needed"));
        }
        check_count(corners.len() + 1)?;
        lines.expect(&["outer", "loop"])?;
        let points = [lines.vertex()?, lines.vertex()?, lines.vertex()?];
        let triangle = points.map(|p| corners.number(p));
        corners.triangle(triangle);
        lines.expect(&["endloop"])?;
        lines.expect(&["endfacet"])?;
    }
    finish(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    /// A tetrahedron, binary, with the given first bytes.
    pub(crate) fn binary(head: &[u8]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, 0);
        bytes.extend(4_u32.to_le_bytes());
        for face in FACES {
            bytes.extend([0; 12]);
            for value in face.iter().flat_map(|&c| CORNERS[c]) {
                bytes.extend(value.to_le_bytes());
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    pub(crate) fn ascii() -> String {
        let mut text = "solid a b\n".to_string();
        for face in FACES {
            text += " facet normal 0 0 0\n  outer loop\n";
            for [x, y, z] in face.map(|c| CORNERS[c]) {
                text += &format!("   vertex {x} {y:e} {z}\n");
            }
            text += "  endloop\n endfacet\n";
        }
        text + "endsolid a b\n"
    }

    #[test]
    fn binary_and_ascii_are_told_apart() {
        let plain = read(&binary(b"")).unwrap();
        assert_eq!((plain.points.len(), plain.face_count()), (4, 4));
        assert_eq!(read(&binary(b"solid facet trap")).unwrap(), plain);
        assert_eq!(read(ascii().as_bytes()).unwrap(), plain);
    }

    #[test]
    fn a_count_that_does_not_fit_is_refused() {
        let mut bytes = binary(b"");
        bytes.pop();
        let message = read(&bytes).unwrap_err().to_string();
        assert_eq!(
            message,
            "STL byte 80: the header announces 4 triangles, which take 284 bytes, and the file has 283; \
             the file must be as long as its header says"
        );
        assert!(read(b"").is_err() && read(b"solid").is_err());
    }

    #[test]
    fn a_corner_that_is_no_number_is_refused_by_its_triangle() {
        let mut bytes = binary(b"");
        bytes[84 + 2 * 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        let message = read(&bytes).unwrap_err().to_string();
        assert!(message.starts_with("STL triangle 2: a corner at (NaN, 0, 0)"), "{message}");
        let text = ascii().replace("vertex 0 0e0 1", "vertex 0 inf 1");
        let message = read(text.as_bytes()).unwrap_err().to_string();
        assert!(
            message.starts_with("STL line 13: \"inf\"; a finite number is needed"),
            "{message}"
        );
    }
}
