//! Mesh files: one writer a format, `&[NamedMesh]` to bytes.
//!
//! | format | unit | precision | several parts | colours | faces |
//! |---|---|---|---|---|---|
//! | [`stl`] binary | mm | `f32` | united | no | triangles |
//! | [`stl`] ASCII | mm | `f64` | one `solid` each | no | triangles |
//! | [`obj`] | mm | `f64` | one object each | no | polygons |
//! | [`off`] | mm | `f64` | united | by face | triangles |
//! | [`ply`] | mm | `f64` | united | by face | triangles |
//! | [`threemf`] | mm | `f64` | one object each | by face | triangles |
//! | [`glb`] | m, y up | `f32` | one node each | by face | triangles |
//!
//! Where faces stay polygons, it is the convex ones without holes that do: common readers cut a
//! polygon into a fan from its first corner, which is wrong for any other. No format gets a point
//! that the mesh does not have, so a mesh closed by index stays closed.
//!
//! The same meshes give the same bytes; no file holds a date.

use thiserror::Error;

use crate::geom::PolyMesh;

mod glb;
mod obj;
mod off;
pub(in crate::output) mod part;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod threemf;

use part::Part;

/// A mesh and what it is called in formats that hold names.
#[derive(Clone, Copy, Debug)]
pub struct NamedMesh<'a> {
    /// Its name; any text, each format replaces what it cannot hold.
    pub name: &'a str,
    /// The mesh, millimetres.
    pub mesh: &'a PolyMesh,
}

/// The mesh formats that are written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum MeshFormat {
    /// Binary STL.
    Stl,
    /// ASCII STL.
    StlAscii,
    /// Wavefront OBJ.
    Obj,
    /// Object file format.
    Off,
    /// Binary PLY, little endian.
    Ply,
    /// 3D Manufacturing Format.
    ThreeMf,
    /// Binary glTF 2.0.
    Glb,
}

impl MeshFormat {
    /// All of them.
    pub const ALL: [MeshFormat; 7] = [
        MeshFormat::Stl,
        MeshFormat::StlAscii,
        MeshFormat::Obj,
        MeshFormat::Off,
        MeshFormat::Ply,
        MeshFormat::ThreeMf,
        MeshFormat::Glb,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            MeshFormat::StlAscii => "stl-ascii",
            other => other.extension(),
        }
    }

    /// The extension of its files, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            MeshFormat::Stl | MeshFormat::StlAscii => "stl",
            MeshFormat::Obj => "obj",
            MeshFormat::Off => "off",
            MeshFormat::Ply => "ply",
            MeshFormat::ThreeMf => "3mf",
            MeshFormat::Glb => "glb",
        }
    }

    /// The format of a name, in any case; `None` for an unknown one.
    ///
    /// ```
    /// use katachi::output::mesh::MeshFormat;
    /// assert_eq!(MeshFormat::from_name("STL-ascii"), Some(MeshFormat::StlAscii));
    /// assert_eq!(MeshFormat::from_name("step"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<MeshFormat> {
        MeshFormat::ALL.into_iter().find(|format| format.name().eq_ignore_ascii_case(name))
    }

    /// The format of a file extension without its dot, in any case; `stl` is the binary one.
    pub fn from_extension(extension: &str) -> Option<MeshFormat> {
        let same = |format: &MeshFormat| format.extension().eq_ignore_ascii_case(extension);
        MeshFormat::ALL.into_iter().find(same)
    }

    /// Whether several parts keep their names in one file. The others unite them into one soup, so a
    /// record of parts is better written as one file each.
    pub fn holds_parts(self) -> bool {
        matches!(self, MeshFormat::Obj | MeshFormat::ThreeMf | MeshFormat::Glb)
    }
}

/// Why meshes cannot be written.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum WriteError {
    /// More of something than the format can count.
    #[error("{found} {what}; {format} holds at most {limit}")]
    TooMany {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: u64,
        /// How many fit.
        limit: u64,
        /// The format.
        format: &'static str,
    },
    /// A coordinate that the format cannot hold.
    #[error(
        "a coordinate of {value} mm in part `{part}`; {format} needs finite numbers up to {limit:e}"
    )]
    Coordinate {
        /// The part.
        part: String,
        /// The coordinate.
        value: f64,
        /// The format.
        format: &'static str,
        /// The largest one that fits.
        limit: f64,
    },
    /// The archive could not be made.
    #[error("the zip archive could not be made: {0}")]
    Archive(String),
}

/// The meshes as the bytes of one file.
///
/// Fails when a coordinate is not finite (or beyond `f32` in STL and GLB), or when there are more
/// triangles or bytes than the format can count (2^32 - 1).
///
/// ```
/// use glam::dvec3;
/// use katachi::geom::{Origin, PolyMesh, Surface};
/// use katachi::output::mesh::{MeshFormat, NamedMesh, write};
/// let corners = [dvec3(0., 0., 0.), dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(0., 0., 1.)];
/// let mut mesh = PolyMesh::with_points(corners.to_vec());
/// let origin = mesh.add_origin(Origin::of(Surface::Plane));
/// for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
///     let plane = mesh.add_plane();
///     mesh.push_face(&[face], plane, origin);
/// }
/// let bytes = write(MeshFormat::Stl, &[NamedMesh { name: "corner", mesh: &mesh }]).unwrap();
/// assert_eq!(bytes.len(), 84 + 4 * 50);
/// ```
pub fn write(format: MeshFormat, parts: &[NamedMesh]) -> Result<Vec<u8>, WriteError> {
    let limit = match format {
        MeshFormat::Stl | MeshFormat::Glb => f64::from(f32::MAX),
        _ => f64::MAX,
    };
    for part in parts {
        check_coordinates(part, format.name(), limit)?;
    }
    let parts: Vec<Part> = parts.iter().map(Part::new).collect();
    let triangles = parts.iter().map(|part| part.triangles.corners.len() as u64).sum();
    check_count("triangles", triangles, format.name())?;
    check_count("points", parts.iter().map(|p| p.mesh.points.len() as u64).sum(), format.name())?;
    match format {
        MeshFormat::Stl => Ok(stl::binary(&parts)),
        MeshFormat::StlAscii => Ok(stl::ascii(&parts)),
        MeshFormat::Obj => Ok(obj::write(&parts)),
        MeshFormat::Off => Ok(off::write(&parts)),
        MeshFormat::Ply => Ok(ply::write(&parts)),
        MeshFormat::ThreeMf => threemf::write(&parts),
        MeshFormat::Glb => glb::write(&parts),
    }
}

fn check_coordinates(part: &NamedMesh, format: &'static str, limit: f64) -> Result<(), WriteError> {
    let fits = |p: &glam::DVec3| p.abs().max_element() <= limit && p.is_finite();
    let Some(point) = part.mesh.points.iter().find(|p| !fits(p)) else { return Ok(()) };
    let bad = point.to_array().into_iter().find(|x| x.is_nan() || x.abs() > limit);
    let value = bad.unwrap_or(f64::NAN);
    Err(WriteError::Coordinate { part: part.name.to_string(), value, format, limit })
}

/// Fails when a count does not fit 32 bits.
fn check_count(what: &'static str, found: u64, format: &'static str) -> Result<(), WriteError> {
    let limit = u64::from(u32::MAX);
    if found <= limit { Ok(()) } else { Err(WriteError::TooMany { what, found, limit, format }) }
}
