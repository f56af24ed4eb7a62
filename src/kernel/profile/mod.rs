//! Plane figures: primitives, set algebra, offset, rounding, text, measures.
//!
//! A figure is a [`Region`](crate::geom::Region): disjoint pieces bounded by simple polygons in
//! millimetres, whose edges know the curve they stand for. The algebra runs on
//! [`geom::overlay`](crate::geom::overlay), where the precision is stated.

pub mod algebra;
pub mod curve;
pub mod error;
pub mod hull;
pub mod measure;
pub mod offset;
pub mod orientation;
pub mod place;
pub mod polygon;
pub mod primitive;
pub mod round;
pub mod text;

pub use algebra::{difference, intersection, union};
pub use curve::enclosed;
pub use error::ProfileError;
pub use hull::hull;
pub use offset::offset;
pub use place::{Affine, placed};
pub use polygon::polygon;
pub use primitive::{MOST_SIDES, circle, ellipse, ngon, rect};
pub use round::{fillet, round};
pub use text::{Align, Baseline, Text, TextOptions, text};
