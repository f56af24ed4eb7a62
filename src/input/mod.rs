//! Readers, one file a format: bytes become meshes, plane figures or values, or an error that says
//! what was found, what is needed, and where. No input panics, hangs or takes memory beyond a small multiple
//! of its size; the limits stand in the readers.

mod corners;
pub mod data;
pub mod dxf;
pub mod error;
pub mod heightmap;
pub mod iso;
pub mod obj;
pub mod off;
mod order;
pub mod ply;
pub mod soup;
pub mod stl;
pub mod svg;
pub mod threemf;
pub mod weld;

pub use data::Data;
pub use error::{Place, ReadError};
pub use heightmap::read_heights;
pub use iso::read as read_isometric;
pub use weld::weld;

use crate::geom::{PolyMesh, Region, Tolerance};
use error::Format;

/// The ending of a file name, in lower case.
fn ending(name: &str) -> String {
    let file = name.rsplit(['/', '\\']).next().unwrap_or_default();
    file.rsplit_once('.').map(|(_, ending)| ending.to_lowercase()).unwrap_or_default()
}

/// The mesh of a file, its format told by the ending of `name`: stl, obj, off, ply or 3mf.
///
/// Millimetres; 3MF files say their unit, others are taken as they are. Faces are those of the file,
/// each with a plane of its own; nothing is promised about closedness.
pub fn read_mesh(name: &str, bytes: &[u8]) -> Result<PolyMesh, ReadError> {
    check_size(bytes)?;
    match ending(name).as_str() {
        "stl" => stl::read(bytes),
        "obj" => obj::read(bytes),
        "off" => off::read(bytes),
        "ply" => ply::read(bytes),
        "3mf" => threemf::read(bytes),
        _ => {
            let known = ".stl, .obj, .off, .ply or .3mf";
            Err(ReadError::Extension { name: name.to_string(), known })
        }
    }
}

/// The most bytes of a file that are read: points and corners are numbered with 32 bits.
pub const MOST_BYTES: usize = u32::MAX as usize;

fn check_size(bytes: &[u8]) -> Result<(), ReadError> {
    if bytes.len() <= MOST_BYTES {
        return Ok(());
    }
    Err(Format("the file")
        .limit(format!("its size of {} bytes", bytes.len()), format!("{MOST_BYTES} bytes")))
}

/// A plane figure from a drawing.
#[derive(Clone, PartialEq, Debug)]
pub struct Figure {
    /// The figure, mm, y up.
    pub region: Region,
    /// What of the drawing was left out, one sentence each.
    pub notes: Vec<String>,
}

/// The figure of a drawing, its format told by the ending of `name`: svg or dxf. Curves follow
/// `tolerance`.
pub fn read_profile(name: &str, bytes: &[u8], tolerance: Tolerance) -> Result<Figure, ReadError> {
    check_size(bytes)?;
    match ending(name).as_str() {
        "svg" => svg::read(bytes, tolerance),
        "dxf" => dxf::read(bytes, tolerance),
        _ => Err(ReadError::Extension { name: name.to_string(), known: ".svg or .dxf" }),
    }
}

/// The values of a file, its format told by the ending of `name`: json or csv.
pub fn read_data(name: &str, bytes: &[u8]) -> Result<Data, ReadError> {
    check_size(bytes)?;
    match ending(name).as_str() {
        "json" => data::read_json(bytes),
        "csv" => data::read_csv(bytes),
        _ => Err(ReadError::Extension { name: name.to_string(), known: ".json or .csv" }),
    }
}
