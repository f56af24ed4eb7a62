//! Named constants that are values of their own.

use std::fmt;

macro_rules! symbols {
    ($($(#[$doc:meta])* $variant:ident = $text:literal,)*) => {
        /// A constant that stands for itself, such as `LEFT`.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum Symbol { $($(#[$doc])* $variant,)* }

        impl Symbol {
            /// The constant of that name.
            pub fn from_name(name: &str) -> Option<Symbol> {
                match name { $($text => Some(Symbol::$variant),)* _ => None }
            }

            /// How it is written.
            pub const fn name(self) -> &'static str {
                match self { $(Symbol::$variant => $text,)* }
            }
        }
    };
}

symbols! {
    /// No value where one is optional.
    None = "NONE",
    /// Towards -x; the start of a text.
    Left = "LEFT",
    /// The middle.
    Center = "CENTER",
    /// Towards +x; the end of a text.
    Right = "RIGHT",
    /// Towards +z; the upper edge of a text.
    Top = "TOP",
    /// Towards -z; the lower edge of a text.
    Bottom = "BOTTOM",
    /// The base line of a text.
    Baseline = "BASELINE",
    /// Towards -y.
    Front = "FRONT",
    /// Towards +y.
    Back = "BACK",
    /// Healing by winding number.
    Winding = "WINDING",
    /// The spherical projection.
    Sphere = "SPHERE",
    /// The distance field.
    Field = "FIELD",
    /// Tetrahedra.
    Tet = "TET",
    /// The exact kernel.
    Exact = "EXACT",
    /// The spherical quadtree.
    Quadtree = "QUADTREE",
    /// A potential of 1 / d.
    Inverse = "INVERSE",
    /// A potential of 1 / d^2.
    InverseSquare = "INVERSE_SQUARE",
    /// Wyvill's potential, 0 beyond a radius.
    Wyvill = "WYVILL",
    /// Blinn's potential, exp(-(d / r)^2).
    Blinn = "BLINN",
    /// A profile that turns as little as it can.
    RotationMinimising = "ROTATION_MINIMISING",
    /// A profile that does not turn.
    Fixed = "FIXED",
    /// A profile whose x points to the centre of curvature.
    Frenet = "FRENET",
    /// A profile whose y points upwards.
    Upright = "UPRIGHT",
    /// Through all sections.
    Through = "THROUGH",
    /// Half-way between sections.
    Mid = "MID",
    /// Corners cut in the plane between their sides.
    Mitred = "MITRED",
    /// Corners that are turned.
    Rounded = "ROUNDED",
    /// What overlaps is united.
    Union = "UNION",
    /// Isometric: from (1, -1, 1).
    Iso = "ISO",
    /// From (1, -sqrt 7, 1).
    Dimetric = "DIMETRIC",
    /// No hidden lines.
    Off = "OFF",
    /// Hidden lines dashed.
    Dashed = "DASHED",
    /// The view from above stands below.
    FirstAngle = "FIRST_ANGLE",
    /// The view from above stands above.
    ThirdAngle = "THIRD_ANGLE",
    /// Whatever suits.
    Auto = "AUTO",
    /// Hidden lines by counting faces.
    Count = "COUNT",
    /// Tones as pixels.
    Grey = "GREY",
    /// Dots that are discs.
    Round = "ROUND",
    /// Dots that are ellipses.
    Ellipse = "ELLIPSE",
    /// Dots that are squares.
    Square = "SQUARE",
    /// Dots that are squares on their corners.
    Diamond = "DIAMOND",
    /// Dots that are bars.
    Line = "LINE",
    /// The end of a stroke is a vertex.
    Mark = "MARK",
    /// Hidden lines by clipping.
    Clip = "CLIP",
    /// The paper size A0.
    A0 = "A0",
    /// The paper size A1.
    A1 = "A1",
    /// The paper size A2.
    A2 = "A2",
    /// The paper size A3.
    A3 = "A3",
    /// The paper size A4.
    A4 = "A4",
}

impl fmt::Display for Symbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
