//! Drawings on paper: pens, dimensions, hatching, pages, and the files they are written to.
//!
//! A [`Figure`] is a [`Drawing`](super::drawing::Drawing) with what is written on it. Alone it makes a
//! [`Page`] of its own size; [`arrange`] puts several on a sheet with frame and title block. A page is ink in
//! layers, and each writer turns the same page into bytes: [`svg`], [`pdf`], [`dxf`]. Same page, same bytes.
//!
//! Sources: ISO 128-2 (lines), 128-3 (views and sections), 129-1 (dimensions), 3098 (lettering heights), 5457
//! (frame), 7200 (title block).

mod arrange;
mod cutting;
mod dimension;
pub mod dxf;
mod figure;
mod frame;
mod hatch;
mod isometric_grid;
mod lettering;
mod page;
pub mod pdf;
mod pen;
pub mod svg;
mod tone;

pub use arrange::{Misfit, Placing, Sheet, Spot, Subject, arrange, scale_text};
pub use cutting::CuttingLine;
pub use dimension::{Dimension, Shape, dimension_number};
pub use figure::Figure;
pub use frame::Title;
pub use hatch::{Cut, hatched};
pub use isometric_grid::{IsometricGrid, MOST_LINES};
pub use lettering::{Anchor, Lettering, Unlettered};
pub use page::{Group, Ink, Letters, Mark, Page, bounds};
pub use pen::{Layer, Pen, Style};
pub use tone::{Print, Tone};

/// The formats that pages are written in.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum DrawingFormat {
    /// Scalable Vector Graphics.
    Svg,
    /// Portable Document Format.
    Pdf,
    /// AutoCAD's exchange format.
    Dxf,
}

impl DrawingFormat {
    /// All of them.
    pub const ALL: [DrawingFormat; 3] =
        [DrawingFormat::Svg, DrawingFormat::Pdf, DrawingFormat::Dxf];

    /// Its name on the command line and the extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            DrawingFormat::Svg => "svg",
            DrawingFormat::Pdf => "pdf",
            DrawingFormat::Dxf => "dxf",
        }
    }

    /// The format of a name or extension, in any case.
    pub fn from_name(name: &str) -> Option<DrawingFormat> {
        DrawingFormat::ALL.into_iter().find(|format| format.name().eq_ignore_ascii_case(name))
    }
}

/// The page as the bytes of a file.
pub fn write(format: DrawingFormat, page: &Page) -> Vec<u8> {
    match format {
        DrawingFormat::Svg => svg::write(page),
        DrawingFormat::Pdf => pdf::write(page),
        DrawingFormat::Dxf => dxf::write(page),
    }
}
