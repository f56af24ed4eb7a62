//! 3MF: a zip archive with an XML model of objects, components, colours and a build plate.
//!
//! Read is the main model part: what stands on the build plate, in its place, in millimetres. Colours are
//! those of `basematerials` and `colorgroup`, of a triangle's first corner or of its object; names of objects
//! become tags. Extensions that move objects into other files are refused by the missing object.
//!
//! Limits: [`MOST_TEXT`] bytes of XML, [`MOST_FACES`](super::soup::MOST_FACES) triangles and vertices
//! after all components are placed.

use std::io::{Cursor, Read};

use glam::{DMat3, DVec3, dvec3};
use quick_xml::{
    Reader, XmlVersion,
    events::{BytesStart, Event},
};
use rustc_hash::FxHashMap;

use super::{
    Place, ReadError,
    error::{Format, shortened},
    soup::{MOST_FACES, Soup},
};
use crate::geom::{Placement, PolyMesh, mesh::Color};

const THREEMF: Format = Format("3MF");

/// The most bytes the model may unpack to.
pub const MOST_TEXT: u64 = 1 << 30;

/// The mesh of all items on the build plate of a 3MF file.
///
/// # Errors
/// An archive without a model, broken XML, numbers out of place, references to what does not exist,
/// and more than the limits.
pub fn read(bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    let text = model_text(bytes)?;
    let mut reader = Reader::from_str(&text);
    let mut model = Model::default();
    loop {
        let at = reader.buffer_position() as usize;
        let wrong =
            |found: String| THREEMF.error(Place::Byte(at), found, "well-formed XML is needed");
        match reader.read_event().map_err(|e| wrong(e.to_string()))? {
            Event::Start(tag) => model.open(&Tag { tag: &tag, at })?,
            Event::Empty(tag) => {
                model.open(&Tag { tag: &tag, at })?;
                model.close(tag.local_name().as_ref())?;
            }
            Event::End(tag) => model.close(tag.local_name().as_ref())?,
            Event::Eof => break,
            _ => {}
        }
    }
    model.built()
}

/// The XML of the model part, unpacked no further than the limit.
fn model_text(bytes: &[u8]) -> Result<String, ReadError> {
    let broken = |error: String| {
        THREEMF.error(Place::File, error, "a zip archive with a part 3D/3dmodel.model is needed")
    };
    let mut archive =
        zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| broken(e.to_string()))?;
    let is_model = |name: &String| name.to_lowercase().ends_with(".model");
    let names = archive.file_names().filter_map(|name| Some(name.ok()?.into_owned()));
    let mut names: Vec<String> = names.filter(is_model).collect();
    names.sort_by_key(|name| (!name.eq_ignore_ascii_case("3D/3dmodel.model"), name.clone()));
    let Some(name) = names.first() else { return Err(broken("an archive without a model".into())) };
    let part = archive.by_name(name).map_err(|e| broken(e.to_string()))?;
    let mut text = String::new();
    part.take(MOST_TEXT + 1).read_to_string(&mut text).map_err(|e| broken(e.to_string()))?;
    if text.len() as u64 > MOST_TEXT {
        return Err(THREEMF.limit("the unpacked model", format!("{MOST_TEXT} bytes")));
    }
    Ok(text)
}

/// An XML element and the byte it begins at.
struct Tag<'a> {
    tag: &'a BytesStart<'a>,
    at: usize,
}

impl Tag<'_> {
    fn error(&self, found: String, needed: &str) -> ReadError {
        THREEMF.error(Place::Byte(self.at), found, needed)
    }

    fn text(&self, name: &str) -> Result<Option<String>, ReadError> {
        let broken = |e: String| self.error(e, "well-formed attributes are needed");
        let attribute = self.tag.try_get_attribute(name).map_err(|e| broken(e.to_string()))?;
        let Some(attribute) = attribute else { return Ok(None) };
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        Ok(Some(value.map_err(|e| broken(e.to_string()))?.into_owned()))
    }

    fn need(&self, name: &str) -> Result<String, ReadError> {
        self.text(name)?.ok_or_else(|| {
            let element =
                String::from_utf8_lossy(self.tag.local_name().as_ref().as_bytes()).into_owned();
            self.error(format!("\"{element}\" without \"{name}\""), "it must be there")
        })
    }

    fn number(&self, name: &str) -> Result<f64, ReadError> {
        THREEMF.number(self.need(name)?.trim(), Place::Byte(self.at))
    }

    fn index(&self, name: &str) -> Result<Option<u32>, ReadError> {
        let Some(word) = self.text(name)? else { return Ok(None) };
        let index = word.trim().parse().map(Some);
        index.map_err(|_| {
            self.error(format!("{name}=\"{}\"", shortened(&word)), "a whole number is needed")
        })
    }

    fn need_index(&self, name: &str) -> Result<u32, ReadError> {
        self.need(name)?;
        Ok(self.index(name)?.unwrap_or_default())
    }

    /// The attribute `transform`: twelve numbers, the images of x, y, z and the origin.
    fn transform(&self) -> Result<Placement, ReadError> {
        let Some(text) = self.text("transform")? else { return Ok(Placement::IDENTITY) };
        let numbers = text.split_whitespace().map(|w| THREEMF.number(w, Place::Byte(self.at)));
        let n: Vec<f64> = numbers.collect::<Result<_, _>>()?;
        if n.len() != 12 {
            return Err(self.error(format!("a transform of {} numbers", n.len()), "12 are needed"));
        }
        let column = |i: usize| dvec3(n[i], n[i + 1], n[i + 2]);
        Ok(Placement::new(DMat3::from_cols(column(0), column(3), column(6)), column(9)))
    }
}

/// An object: a mesh, or components placed.
#[derive(Default)]
struct Object {
    name: String,
    points: Vec<DVec3>,
    triangles: Vec<([u32; 3], Option<Color>)>,
    components: Vec<(u32, Placement)>,
    color: Option<Color>,
    /// Triangles, vertices and placements in all, components included.
    weight: usize,
}

/// What has been read of a model.
#[derive(Default)]
struct Model {
    unit: Option<f64>,
    colors: FxHashMap<u32, Vec<Color>>,
    group: Option<u32>,
    objects: FxHashMap<u32, Object>,
    open: Option<(u32, Object)>,
    items: Vec<(u32, Placement)>,
}

impl Model {
    fn open(&mut self, tag: &Tag) -> Result<(), ReadError> {
        match tag.tag.local_name().as_ref() {
            "model" => self.unit = Some(unit(tag)?),
            "basematerials" | "colorgroup" => {
                let id = tag.need_index("id")?;
                self.group = Some(id);
                self.colors.insert(id, vec![]);
            }
            "base" => self.color(tag, "displaycolor")?,
            "color" => self.color(tag, "color")?,
            "object" => self.object(tag)?,
            "vertex" => {
                let point = dvec3(tag.number("x")?, tag.number("y")?, tag.number("z")?);
                if let Some((_, object)) = &mut self.open {
                    object.points.push(point);
                }
            }
            "triangle" => self.triangle(tag)?,
            "component" => self.component(tag)?,
            "item" => {
                let id = self.known(tag, "objectid")?;
                self.items.push((id, tag.transform()?));
            }
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, name: &str) -> Result<(), ReadError> {
        match name {
            "basematerials" | "colorgroup" => self.group = None,
            "object" => {
                if let Some((id, mut object)) = self.open.take() {
                    let parts = object.components.iter().map(|(c, _)| self.objects[c].weight);
                    let start = object.triangles.len() + object.points.len() + 1;
                    object.weight = parts.fold(start, usize::saturating_add);
                    self.objects.insert(id, object);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn color(&mut self, tag: &Tag, name: &str) -> Result<(), ReadError> {
        let Some(list) = self.group.and_then(|g| self.colors.get_mut(&g)) else { return Ok(()) };
        let text = tag.need(name)?;
        let color = hexadecimal(&text).ok_or_else(|| {
            tag.error(
                format!("{name}=\"{}\"", shortened(&text)),
                "a colour like \"#FF8000\" is needed",
            )
        })?;
        list.push(color);
        Ok(())
    }

    fn object(&mut self, tag: &Tag) -> Result<(), ReadError> {
        let id = tag.need_index("id")?;
        let color = self.property(tag.index("pid")?, tag.index("pindex")?);
        let name = tag.text("name")?.unwrap_or_default();
        self.open = Some((id, Object { name, color, ..Object::default() }));
        Ok(())
    }

    fn property(&self, group: Option<u32>, index: Option<u32>) -> Option<Color> {
        self.colors.get(&group?)?.get(index? as usize).copied()
    }

    fn triangle(&mut self, tag: &Tag) -> Result<(), ReadError> {
        let corners = [tag.need_index("v1")?, tag.need_index("v2")?, tag.need_index("v3")?];
        let color = self.property(tag.index("pid")?, tag.index("p1")?);
        let Some((_, object)) = &mut self.open else { return Ok(()) };
        let points = object.points.len();
        if let Some(bad) = corners.iter().find(|c| **c as usize >= points) {
            return Err(tag.error(
                format!("a triangle with vertex {bad}"),
                &format!("there are {points} vertices"),
            ));
        }
        object.triangles.push((corners, color));
        Ok(())
    }

    fn component(&mut self, tag: &Tag) -> Result<(), ReadError> {
        let id = self.known(tag, "objectid")?;
        let transform = tag.transform()?;
        if let Some((_, object)) = &mut self.open {
            object.components.push((id, transform));
        }
        Ok(())
    }

    /// The number of an object that came before: so no object contains itself.
    fn known(&self, tag: &Tag, name: &str) -> Result<u32, ReadError> {
        let id = tag.need_index(name)?;
        if self.objects.contains_key(&id) {
            return Ok(id);
        }
        Err(tag.error(format!("{name}=\"{id}\""), "an object that came before is needed"))
    }

    fn built(self) -> Result<PolyMesh, ReadError> {
        let weights = self.items.iter().map(|(id, _)| self.objects[id].weight);
        if weights.fold(0, usize::saturating_add) > MOST_FACES {
            return Err(THREEMF.limit(
                "the size of the build plate",
                format!("{MOST_FACES} triangles and vertices"),
            ));
        }
        let unit = Placement::new(
            DMat3::from_diagonal(DVec3::splat(self.unit.unwrap_or(1.0))),
            DVec3::ZERO,
        );
        let mut soup = Soup::new(THREEMF);
        let mut open: Vec<(u32, Placement)> = vec![];
        open.extend(self.items.iter().rev().map(|(id, place)| (*id, unit.after(place))));
        while let Some((id, place)) = open.pop() {
            let object = &self.objects[&id];
            add(&mut soup, object, &place)?;
            let parts = object.components.iter().rev();
            open.extend(parts.map(|(part, inner)| (*part, place.after(inner))));
        }
        soup.finish()
    }
}

fn add(soup: &mut Soup, object: &Object, place: &Placement) -> Result<(), ReadError> {
    if object.triangles.is_empty() {
        return Ok(());
    }
    soup.name(&object.name);
    let base = soup.mesh.points.len() as u32;
    for point in &object.points {
        let point = place.point(*point);
        if !point.is_finite() {
            let found = format!("a vertex placed at ({}, {}, {})", point.x, point.y, point.z);
            return Err(THREEMF.error(Place::File, found, "coordinates must be finite numbers"));
        }
        soup.mesh.points.push(point);
    }
    for ([a, b, c], color) in &object.triangles {
        let [b, c] = if place.mirrors() { [c, b] } else { [b, c] };
        soup.face(&[base + a, base + b, base + c], color.or(object.color))?;
    }
    Ok(())
}

fn unit(tag: &Tag) -> Result<f64, ReadError> {
    let name = tag.text("unit")?.unwrap_or_else(|| "millimeter".to_string());
    Ok(match name.as_str() {
        "micron" => 0.001,
        "millimeter" => 1.0,
        "centimeter" => 10.0,
        "inch" => 25.4,
        "foot" => 304.8,
        "meter" => 1000.0,
        _ => {
            let needed = "micron, millimeter, centimeter, inch, foot or meter is needed";
            return Err(tag.error(format!("unit=\"{}\"", shortened(&name)), needed));
        }
    })
}

/// `#RRGGBB` or `#RRGGBBAA`.
fn hexadecimal(text: &str) -> Option<Color> {
    let digits = text.trim().strip_prefix('#')?.as_bytes();
    if digits.len() != 6 && digits.len() != 8 {
        return None;
    }
    let part =
        |i: usize| u8::from_str_radix(std::str::from_utf8(digits.get(i..i + 2)?).ok()?, 16).ok();
    Some(Color { r: part(0)?, g: part(2)?, b: part(4)? })
}
