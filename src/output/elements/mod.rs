//! Files of tetrahedra, for analysis: one writer a format, `&[NamedElements]` to bytes.
//!
//! | format | of | tetrahedra by part | triangles of the boundary by tag |
//! |---|---|---|---|
//! | [`msh`] | Gmsh 4.1 | physical volumes | physical surfaces |
//! | [`vtu`] | VTK | cell data `group` | cell data `group` |
//! | [`inp`] | Abaqus | element sets | surfaces |
//! | [`medit`] | Medit | references | references |
//!
//! Lengths are millimetres, text, the shortest digits that read back the same. A group of triangles is what has the
//! same tags, named `part.tag`; without a tag `part.boundary`. Parts share no points. The same meshes give the same
//! bytes.

use thiserror::Error;

use crate::geom::TetMesh;

mod group;
mod inp;
mod medit;
mod msh;
#[cfg(test)]
mod tests;
mod vtu;

use group::Groups;

/// Tetrahedra and what they are called.
#[derive(Clone, Copy, Debug)]
pub struct NamedElements<'a> {
    /// Its name; any text, each format replaces what it cannot hold.
    pub name: &'a str,
    /// The tetrahedra, millimetres.
    pub mesh: &'a TetMesh,
}

/// The formats that hold tetrahedra.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ElementFormat {
    /// Gmsh 4.1, ASCII.
    Msh,
    /// VTK unstructured grid, XML.
    Vtu,
    /// Abaqus input deck: nodes, elements and sets.
    Inp,
    /// Medit mesh.
    Medit,
}

impl ElementFormat {
    /// All of them.
    pub const ALL: [ElementFormat; 4] =
        [ElementFormat::Msh, ElementFormat::Vtu, ElementFormat::Inp, ElementFormat::Medit];

    /// Its name on the command line, and the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            ElementFormat::Msh => "msh",
            ElementFormat::Vtu => "vtu",
            ElementFormat::Inp => "inp",
            ElementFormat::Medit => "mesh",
        }
    }

    /// The format of a name or an extension without its dot, in any case; `None` for an unknown one.
    ///
    /// ```
    /// use katachi::output::elements::ElementFormat;
    /// assert_eq!(ElementFormat::from_name("VTU"), Some(ElementFormat::Vtu));
    /// assert_eq!(ElementFormat::from_name("stl"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<ElementFormat> {
        ElementFormat::ALL.into_iter().find(|format| format.name().eq_ignore_ascii_case(name))
    }
}

/// Why tetrahedra cannot be written.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum ElementError {
    /// A coordinate that is no number.
    #[error("a coordinate of {value} mm in part `{part}`; it needs to be a finite number")]
    Coordinate {
        /// The part.
        part: String,
        /// The coordinate.
        value: f64,
    },
}

/// Tetrahedra as the bytes of one file.
///
/// # Errors
/// When a coordinate is not finite.
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::TetMesh;
/// use katachi::output::elements::{ElementFormat, NamedElements, write};
/// let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TetMesh { points, tetrahedra: vec![[0, 1, 2, 3]], ..TetMesh::default() };
/// let file = write(ElementFormat::Medit, &[NamedElements { name: "corner", mesh: &mesh }]).unwrap();
/// assert!(String::from_utf8(file).unwrap().contains("Tetrahedra\n1\n1 2 3 4 1\n"));
/// ```
pub fn write(format: ElementFormat, parts: &[NamedElements]) -> Result<Vec<u8>, ElementError> {
    for part in parts {
        let mut coordinates = part.mesh.points.iter().flat_map(|p| p.to_array());
        if let Some(value) = coordinates.find(|x| !x.is_finite()) {
            return Err(ElementError::Coordinate { part: part.name.to_string(), value });
        }
    }
    let groups = Groups::new(parts);
    Ok(match format {
        ElementFormat::Msh => msh::write(parts, &groups),
        ElementFormat::Vtu => vtu::write(parts, &groups),
        ElementFormat::Inp => inp::write(parts, &groups),
        ElementFormat::Medit => medit::write(parts, &groups),
    })
}
