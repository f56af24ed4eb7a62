//! Tags and colours on their way from the nodes that give them to the faces that bear them.

use std::sync::Arc;

use crate::geom::{
    PolyMesh,
    mesh::{Color, Origin},
};

/// What wrappers around a shape put on its faces.
#[derive(Clone, PartialEq, Eq, Hash, Debug, Default)]
pub struct Paint {
    /// Names, the outermost first.
    tags: Vec<Arc<str>>,
    /// The innermost colour.
    color: Option<Color>,
}

impl Paint {
    /// With a name given further inside.
    pub fn tagged(mut self, name: &Arc<str>) -> Paint {
        self.tags.push(name.clone());
        self
    }

    /// With a colour given further inside, which holds against the ones around it.
    pub fn painted(mut self, color: Color) -> Paint {
        self.color = Some(color);
        self
    }

    /// This paint with another one around it.
    pub fn within(&self, outer: &Paint) -> Paint {
        let tags = outer.tags.iter().chain(&self.tags).cloned().collect();
        Paint { tags, color: self.color.or(outer.color) }
    }

    /// Whether it changes nothing.
    pub fn is_none(&self) -> bool {
        self.tags.is_empty() && self.color.is_none()
    }

    /// The mesh with this paint on all faces. A colour that a face has already holds.
    pub fn applied(&self, mesh: &PolyMesh) -> PolyMesh {
        mesh.clone().with_origins(|origin: &mut Origin| {
            origin.tags.extend(self.tags.iter().rev().cloned());
            origin.color = origin.color.or(self.color);
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Surface;

    #[test]
    fn the_innermost_colour_holds_and_names_pile_up() {
        let (red, blue) = (Color { r: 255, g: 0, b: 0 }, Color { r: 0, g: 0, b: 255 });
        let paint = Paint::default().tagged(&"out".into()).painted(blue);
        let paint = paint.painted(red).tagged(&"in".into());
        let mut mesh = PolyMesh::default();
        mesh.add_origin(Origin::of(Surface::Plane));
        let origin = paint.applied(&mesh).origins()[0].clone();
        assert_eq!(origin.color, Some(red));
        assert_eq!(origin.tags, ["in".into(), "out".into()]);
    }
}
