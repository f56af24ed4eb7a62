//! 3MF, the 3D Manufacturing Format (core specification 1.3): a zip archive with one XML model.
//!
//! Every part is an object of its own with its name. Colours are base materials, the only kind that
//! the core specification has: a part of one colour bears it as a whole, another one by triangle.
//! All entries bear the date 1980-01-01, the first that zip can hold, so that bytes repeat.

use std::{
    collections::BTreeSet,
    fmt::Write as _,
    io::{Cursor, Write as _},
};

use zip::{CompressionMethod, DateTime, ZipWriter, write::SimpleFileOptions};

use super::{
    WriteError,
    part::{PLAIN, Part},
};
use crate::{geom::mesh::Color, output::number::Shortest};

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

/// The resource number of the list of colours; objects are numbered from the next one.
const MATERIALS: usize = 1;

pub(super) fn write(parts: &[Part]) -> Result<Vec<u8>, WriteError> {
    let failed = |error: &dyn std::fmt::Display| WriteError::Archive(error.to_string());
    let model = model(parts);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .large_file(model.len() as u64 >= u64::from(u32::MAX));
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let entries = [
        ("[Content_Types].xml", CONTENT_TYPES),
        ("_rels/.rels", RELATIONS),
        ("3D/3dmodel.model", &model),
    ];
    for (name, content) in entries {
        archive.start_file(name, options).map_err(|e| failed(&e))?;
        archive.write_all(content.as_bytes()).map_err(|e| failed(&e))?;
    }
    Ok(archive.finish().map_err(|e| failed(&e))?.into_inner())
}

fn model(parts: &[Part]) -> String {
    let mut xml = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n\
         <metadata name=\"Application\">Katachi</metadata>\n<resources>\n",
    );
    // An object needs a face; an empty part has none to show.
    let parts: Vec<&Part> = parts.iter().filter(|part| !part.mesh.is_empty()).collect();
    let palette = Palette::of(&parts);
    // Writing to memory cannot fail.
    let _ = palette.write(&mut xml);
    for (i, part) in parts.iter().enumerate() {
        let _ = write_object(&mut xml, part, MATERIALS + 1 + i, &palette);
    }
    xml.push_str("</resources>\n<build>\n");
    for i in 0..parts.len() {
        let _ = writeln!(xml, "<item objectid=\"{}\"/>", MATERIALS + 1 + i);
    }
    xml.push_str("</build>\n</model>\n");
    xml
}

/// The colours of all parts: the plain one first, the others in order.
struct Palette(Vec<Color>);

impl Palette {
    fn of(parts: &[&Part]) -> Palette {
        let origins = parts.iter().flat_map(|part| part.mesh.origins());
        let colors: BTreeSet<Color> = origins.filter_map(|origin| origin.color).collect();
        let plain = (!colors.is_empty()).then_some(PLAIN);
        Palette(plain.into_iter().chain(colors.into_iter().filter(|&c| c != PLAIN)).collect())
    }

    fn index(&self, color: Option<Color>) -> usize {
        let color = color.unwrap_or(PLAIN);
        self.0.iter().position(|&c| c == color).unwrap_or(0)
    }

    fn write(&self, xml: &mut String) -> std::fmt::Result {
        if self.0.is_empty() {
            return Ok(());
        }
        writeln!(xml, "<basematerials id=\"{MATERIALS}\">")?;
        for Color { r, g, b } in &self.0 {
            let code = format!("#{r:02X}{g:02X}{b:02X}");
            writeln!(xml, "<base name=\"{code}\" displaycolor=\"{code}\"/>")?;
        }
        writeln!(xml, "</basematerials>")
    }
}

fn write_object(xml: &mut String, part: &Part, id: usize, palette: &Palette) -> std::fmt::Result {
    let mut colors = part.mesh.faces().map(|face| face.origin().color);
    let first = colors.next().flatten();
    let common = if colors.all(|color| color == first) { first } else { None };
    let coloured = part.is_coloured();
    write!(xml, "<object id=\"{id}\" type=\"model\" name=\"{}\"", escaped(part.name))?;
    if coloured {
        write!(xml, " pid=\"{MATERIALS}\" pindex=\"{}\"", palette.index(common))?;
    }
    writeln!(xml, ">\n<mesh>\n<vertices>")?;
    for p in &part.mesh.points {
        let [x, y, z] = [p.x, p.y, p.z].map(Shortest);
        writeln!(xml, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
    }
    writeln!(xml, "</vertices>\n<triangles>")?;
    for (face, triangles) in part.faces() {
        let color = face.origin().color.filter(|_| common.is_none());
        let paint = color.map_or(String::new(), |color| {
            format!(" pid=\"{MATERIALS}\" p1=\"{}\"", palette.index(Some(color)))
        });
        for [a, b, c] in triangles {
            writeln!(xml, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"{paint}/>")?;
        }
    }
    writeln!(xml, "</triangles>\n</mesh>\n</object>")
}

/// Text as it may stand in an attribute; characters that XML cannot hold are dropped.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
}
