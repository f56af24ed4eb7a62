//! Which pen draws which line: ISO 128 unless a style says otherwise.

use crate::geom::mesh::Color;

/// What an ink stands for; files keep each in a layer of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Layer {
    /// The guide mesh of isometric drawing.
    Grid,
    /// Half-tones.
    Tone,
    /// Outlines of cast shadows and lines in them.
    Shadow,
    /// Hatching of cut faces.
    Hatch,
    /// Hidden lines.
    Hidden,
    /// Figures on faces.
    Pattern,
    /// Lines in space.
    Free,
    /// Grid lines of a surface seen on its lower side.
    Lower,
    /// Grid lines of a surface seen on its upper side.
    Upper,
    /// Visible edges and contours.
    Visible,
    /// Outlines of cut faces.
    Section,
    /// Where a section is cut.
    Cutting,
    /// Centre lines.
    Center,
    /// Dimensions and their text.
    Dimension,
    /// The title block and its text.
    Title,
    /// The frame of the page.
    Frame,
}

impl Layer {
    /// All of them, from the lowest to the topmost.
    pub const ALL: [Layer; 16] = [
        Layer::Grid,
        Layer::Tone,
        Layer::Shadow,
        Layer::Hatch,
        Layer::Hidden,
        Layer::Pattern,
        Layer::Free,
        Layer::Lower,
        Layer::Upper,
        Layer::Visible,
        Layer::Section,
        Layer::Cutting,
        Layer::Center,
        Layer::Dimension,
        Layer::Title,
        Layer::Frame,
    ];

    /// Its name in files: the class in SVG, the layer in DXF and PDF.
    pub fn name(self) -> &'static str {
        match self {
            Layer::Grid => "grid",
            Layer::Tone => "tone",
            Layer::Shadow => "shadow",
            Layer::Hatch => "hatch",
            Layer::Hidden => "hidden",
            Layer::Pattern => "pattern",
            Layer::Free => "free",
            Layer::Lower => "lower",
            Layer::Upper => "upper",
            Layer::Visible => "visible",
            Layer::Section => "section",
            Layer::Cutting => "cutting",
            Layer::Center => "center",
            Layer::Dimension => "dimension",
            Layer::Title => "title",
            Layer::Frame => "frame",
        }
    }

    /// The pen of ISO 128-2 for the line group 0.5.
    ///
    /// ```
    /// use katachi::output::sheet::Layer;
    /// assert_eq!(Layer::Visible.pen().width, 0.5);
    /// assert_eq!(Layer::Hidden.pen().dash, [3.0, 0.75]);
    /// ```
    pub fn pen(self) -> Pen {
        let (width, dash): (f64, &[f64]) = match self {
            Layer::Visible | Layer::Section => (0.5, &[]),
            Layer::Hidden => (0.25, &DASHED),
            Layer::Center => (0.25, &CHAIN),
            Layer::Cutting => (0.5, &CHAIN),
            Layer::Free | Layer::Title => (0.35, &[]),
            Layer::Frame => (0.7, &[]),
            Layer::Lower | Layer::Grid => (0.13, &[]),
            Layer::Shadow => (0.18, &[]),
            Layer::Tone | Layer::Hatch | Layer::Pattern | Layer::Upper | Layer::Dimension => {
                (0.25, &[])
            }
        };
        let dash = dash.iter().map(|part| part * width).collect();
        let color = if self == Layer::Grid { PALE } else { BLACK };
        Pen { width, dash, color }
    }
}

/// Dash and gap of line type 02 in line widths.
const DASHED: [f64; 2] = [12.0, 3.0];
/// Long dash, gap, dot, gap of line type 04 in line widths.
const CHAIN: [f64; 4] = [24.0, 3.0, 0.5, 3.0];
const BLACK: Color = Color { r: 0, g: 0, b: 0 };
/// The blue of graph paper.
const PALE: Color = Color { r: 143, g: 170, b: 199 };

/// How a line is drawn.
#[derive(Clone, PartialEq, Debug)]
pub struct Pen {
    /// Width on paper, mm.
    pub width: f64,
    /// Lengths of dashes and gaps in turn, mm on paper; empty for a full line.
    pub dash: Vec<f64>,
    /// Colour.
    pub color: Color,
}

/// The pens of a drawing and the sizes of what is written on it.
#[derive(Clone, PartialEq, Debug)]
pub struct Style {
    pens: Vec<Pen>,
    /// Distance of hatch lines, mm on paper.
    pub hatch_pitch: f64,
    /// Height of capitals in dimensions, mm on paper (ISO 3098).
    pub text_height: f64,
}

impl Default for Style {
    fn default() -> Style {
        let pens = Layer::ALL.iter().map(|layer| layer.pen()).collect();
        Style { pens, hatch_pitch: 3.0, text_height: 3.5 }
    }
}

impl Style {
    /// The pen of a layer.
    pub fn pen(&self, layer: Layer) -> &Pen {
        &self.pens[layer as usize]
    }

    /// The pen of a layer, to be changed.
    pub fn pen_mut(&mut self, layer: Layer) -> &mut Pen {
        &mut self.pens[layer as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layer_has_its_own_pen() {
        let mut style = Style::default();
        for layer in Layer::ALL {
            assert_eq!(*style.pen(layer), layer.pen());
        }
        style.pen_mut(Layer::Hidden).width = 0.18;
        assert_eq!(style.pen(Layer::Hidden).width, 0.18);
        assert_eq!(style.pen(Layer::Visible).width, 0.5);
    }
}
