//! PLY, the Stanford polygon format: ASCII and binary of either byte order, polygons, face colours.
//!
//! Elements other than `vertex` and `face`, and properties other than positions, corner lists and face
//! colours, are skipped.

use glam::{DVec3, dvec3};

use super::{
    Place, ReadError,
    error::{Format, MOST_COORDINATE, shortened},
    soup::Soup,
};
use crate::geom::{PolyMesh, mesh::Color};

const PLY: Format = Format("PLY");

/// The types of numbers.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The number in `bytes`, which are as many as its size, least first.
    fn decode(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(bytes),
        }
    }
}

struct Property {
    name: String,
    /// The type of the length, for a list.
    length: Option<Scalar>,
    scalar: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// The mesh of a PLY file.
///
/// # Errors
/// A header that announces more than the file holds, words or numbers out of place, numbers of points
/// that do not exist, coordinates that are not finite.
pub fn read(bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    let (encoding, elements, body) = header(bytes)?;
    let mut source = Source { encoding, bytes, at: body };
    let mut soup = Soup::new(PLY);
    for element in &elements {
        source.check_room(element)?;
        if element.properties.is_empty() {
            continue;
        }
        for _ in 0..element.count {
            row(&mut source, element, &mut soup)?;
        }
    }
    soup.finish()
}

/// The encoding, the elements, and where the body begins.
fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, usize), ReadError> {
    if !bytes.starts_with(b"ply") {
        return Err(PLY.error(
            Place::Byte(0),
            "another beginning",
            "a PLY file begins with \"ply\"",
        ));
    }
    let (mut encoding, mut elements): (Option<Encoding>, Vec<Element>) = (None, vec![]);
    let (mut at, mut number) = (0, 0);
    while let Some(length) = bytes[at..].iter().position(|b| *b == b'\n') {
        let line = String::from_utf8_lossy(&bytes[at..at + length]).trim().to_string();
        at += length + 1;
        number += 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong = |needed: &str| {
            PLY.error(Place::Line(number), format!("\"{}\"", shortened(&line)), needed)
        };
        match words.as_slice() {
            ["format", name, ..] => {
                encoding = Some(encoding_named(name).ok_or_else(|| {
                    wrong("ascii, binary_little_endian or binary_big_endian is needed")
                })?)
            }
            ["element", name, count] => {
                let count =
                    count.parse().map_err(|_| wrong("a whole number of elements is needed"))?;
                elements.push(Element { name: name.to_string(), count, properties: vec![] });
            }
            ["property", rest @ ..] => {
                let property = property(rest).ok_or_else(|| {
                    wrong("\"property type name\" or \"property list type type name\" is needed")
                })?;
                let element =
                    elements.last_mut().ok_or_else(|| wrong("\"element\" must come before"))?;
                element.properties.push(property);
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| wrong("\"format\" must come before"))?;
                return Ok((encoding, elements, at));
            }
            ["ply" | "comment" | "obj_info", ..] | [] => {}
            _ => return Err(wrong("format, element, property, comment or end_header is needed")),
        }
    }
    Err(PLY.error(Place::Line(number), "the end of the file", "\"end_header\" is needed"))
}

fn encoding_named(name: &str) -> Option<Encoding> {
    match name {
        "ascii" => Some(Encoding::Ascii),
        "binary_little_endian" => Some(Encoding::Little),
        "binary_big_endian" => Some(Encoding::Big),
        _ => None,
    }
}

fn property(words: &[&str]) -> Option<Property> {
    match words {
        ["list", length, scalar, name] => Some(Property {
            name: name.to_string(),
            length: Some(Scalar::named(length)?),
            scalar: Scalar::named(scalar)?,
        }),
        [scalar, name] => {
            Some(Property { name: name.to_string(), length: None, scalar: Scalar::named(scalar)? })
        }
        _ => None,
    }
}

/// The body of the file and how far it is read.
struct Source<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    at: usize,
}

impl Source<'_> {
    /// Whether so many elements can be in what is left, before anything is set aside for them.
    fn check_room(&self, element: &Element) -> Result<(), ReadError> {
        let least = element.properties.iter().map(|p| match self.encoding {
            Encoding::Ascii => 2,
            _ => p.length.unwrap_or(p.scalar).size(),
        });
        // The last number of an ASCII file need not be followed by a blank.
        let left = self.bytes.len() - self.at + 1;
        let size: usize = least.sum();
        if element.count.saturating_mul(size) <= left {
            return Ok(());
        }
        let found =
            format!("{} elements \"{}\" announced", element.count, shortened(&element.name));
        Err(PLY.error(
            Place::Byte(self.at),
            found,
            format!("the {left} bytes that are left cannot hold them"),
        ))
    }

    fn number(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        let size = scalar.size();
        let Some(bytes) = self.bytes.get(self.at..self.at + size) else {
            return Err(PLY.error(
                Place::Byte(self.at),
                "the end of the file",
                "more numbers are needed",
            ));
        };
        let mut least_first = [0; 8];
        least_first[..size].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            least_first[..size].reverse();
        }
        self.at += size;
        Ok(scalar.decode(least_first))
    }

    fn word(&mut self) -> Result<f64, ReadError> {
        let rest = &self.bytes[self.at..];
        let blank = rest.iter().take_while(|b| b.is_ascii_whitespace()).count();
        let rest = &rest[blank..];
        let word = &rest[..rest.iter().take_while(|b| !b.is_ascii_whitespace()).count()];
        let value = std::str::from_utf8(word).ok().and_then(|w| w.parse::<f64>().ok());
        let place = Place::Byte(self.at + blank);
        self.at += blank + word.len();
        value.ok_or_else(|| {
            let found = match word {
                [] => "the end of the file".to_string(),
                word => format!("\"{}\"", shortened(&String::from_utf8_lossy(word))),
            };
            PLY.error(place, found, "a number is needed")
        })
    }

    /// A length that is not negative and fits what is left.
    fn length(&mut self, scalar: Scalar, item: Scalar) -> Result<usize, ReadError> {
        let place = Place::Byte(self.at);
        let length = self.number(scalar)?;
        let least = if self.encoding == Encoding::Ascii { 1 } else { item.size() };
        let most = (self.bytes.len() - self.at) / least;
        if length >= 0.0 && length <= most as f64 && length.fract() == 0.0 {
            return Ok(length as usize);
        }
        Err(PLY.error(
            place,
            format!("a list of {length} numbers"),
            format!("0 to {most} fit the file"),
        ))
    }
}

fn row(source: &mut Source, element: &Element, soup: &mut Soup) -> Result<(), ReadError> {
    let (mut point, mut corners) = (DVec3::ZERO, vec![]);
    let mut color = [None; 3];
    let place = Place::Byte(source.at);
    for property in &element.properties {
        let Some(length) = property.length else {
            let value = source.number(property.scalar)?;
            scalar(property, value, &mut point, &mut color);
            continue;
        };
        let length = source.length(length, property.scalar)?;
        let is_face = matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
        for _ in 0..length {
            let value = source.number(property.scalar)?;
            if is_face && element.name == "face" {
                corners.push(corner(value, soup.mesh.points.len(), place)?);
            }
        }
    }
    match element.name.as_str() {
        "vertex" if point.abs().max_element() <= MOST_COORDINATE && point.is_finite() => {
            soup.mesh.points.push(point);
            Ok(())
        }
        "vertex" => {
            let found = format!("a point at ({}, {}, {})", point.x, point.y, point.z);
            Err(PLY.error(place, found, "coordinates must be finite numbers"))
        }
        "face" => {
            let [r, g, b] = color;
            soup.face(&corners, r.zip(g).zip(b).map(|((r, g), b)| Color { r, g, b }))
        }
        _ => Ok(()),
    }
}

fn scalar(property: &Property, value: f64, point: &mut DVec3, color: &mut [Option<u8>; 3]) {
    let part = || match property.scalar {
        Scalar::F32 | Scalar::F64 => (value * 255.0).round().clamp(0.0, 255.0) as u8,
        _ => value.clamp(0.0, 255.0) as u8,
    };
    match property.name.as_str() {
        "x" => *point = dvec3(value, point.y, point.z),
        "y" => *point = dvec3(point.x, value, point.z),
        "z" => *point = dvec3(point.x, point.y, value),
        "red" => color[0] = Some(part()),
        "green" => color[1] = Some(part()),
        "blue" => color[2] = Some(part()),
        _ => {}
    }
}

fn corner(value: f64, points: usize, place: Place) -> Result<u32, ReadError> {
    if value >= 0.0 && value < points as f64 && value.fract() == 0.0 {
        return Ok(value as u32);
    }
    let needed = format!("a whole number below {points} is needed, there are so many points");
    Err(PLY.error(place, format!("a face with point {value}"), needed))
}
