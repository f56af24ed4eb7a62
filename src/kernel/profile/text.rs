//! Text as a plane figure: shaped with harfrust, outlines read with skrifa.
//!
//! Sizes are OpenSCAD's, so that the same text has the same extent there and here: `size` is about the
//! height of an ascending letter, the em square is 100 / 72 of it, and letters advance by 1000 / 1024 of
//! what the font says (as measured on exports of OpenSCAD 2021.01).

use glam::{DVec2, dvec2};
use harfrust::{Buffer, ShapeOptions, ShaperFont};
use skrifa::font::{
    Font,
    glyph::outline::{DrawMemory, DrawOptions, PathSink},
};

use super::ProfileError;
use crate::geom::{
    Contour, Region, Tolerance,
    flatten::MOST_CHORDS,
    outline::Outline,
    overlay::{Fill, Rule, overlay},
};

/// The font of a text that names none: Liberation Sans Regular (SIL Open Font License).
pub static LIBERATION_SANS: &[u8] =
    include_bytes!("../../../assets/fonts/LiberationSans-Regular.ttf");

/// Ems for each millimetre of size.
const EM: f64 = 100.0 / 72.0;

/// How far letters advance, and how high they count when they are aligned, relative to what the font says.
const SPACING: f64 = 1000.0 / 1024.0;

/// The most characters set in one piece.
pub const MOST_CHARACTERS: usize = 20_000;

/// Where a line of text stands along x, by its advance width.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub enum Align {
    /// It begins at x = 0.
    #[default]
    Left,
    /// Its middle is at x = 0.
    Center,
    /// It ends at x = 0.
    Right,
}

/// Where a line of text stands along y, by how far its own letters rise and fall. As there the rise
/// counts for [`SPACING`] of what it is, so a capital set at the top ends 0.2 mm above y = 0 at size 10.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub enum Baseline {
    /// Letters stand on y = 0.
    #[default]
    Baseline,
    /// The upper edge is at y = 0.
    Top,
    /// The middle between upper and lower edge is at y = 0.
    Center,
    /// The lower edge is at y = 0; the base line when nothing lies below it.
    Bottom,
}

/// How a text is set.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TextOptions {
    /// Height of an ascending letter, about, in mm.
    pub size: f64,
    /// Along x.
    pub halign: Align,
    /// Along y.
    pub valign: Baseline,
    /// Chord error of the outlines.
    pub tolerance: Tolerance,
}

impl Default for TextOptions {
    fn default() -> TextOptions {
        TextOptions {
            size: 10.0,
            halign: Align::Left,
            valign: Baseline::Baseline,
            tolerance: Tolerance::DEFAULT,
        }
    }
}

/// A text that was set.
#[derive(Clone, PartialEq, Debug)]
pub struct Text {
    /// The letters; empty for blanks.
    pub region: Region,
    /// The advance width in mm: where the next letter would begin.
    pub width: f64,
}

/// One line of text in the font of `font` (the bytes of a TrueType or OpenType file), else in
/// [`LIBERATION_SANS`]. Kerning and ligatures are those of the font.
///
/// # Errors
/// A font that cannot be read, a character it has no glyph for, a size that is not positive, a curve of more
/// than [`MOST_CHORDS`].
///
/// ```
/// use katachi::kernel::profile::{TextOptions, text};
/// let set = text("Katachi", &TextOptions::default(), None).unwrap();
/// assert_eq!(set.region.pieces.len(), 8); // the dot of the i is a piece of its own
/// assert!((set.width - 45.24).abs() < 0.01);
/// ```
pub fn text(text: &str, options: &TextOptions, font: Option<&[u8]>) -> Result<Text, ProfileError> {
    let size = options.size;
    if !(size > 0.0 && size <= crate::geom::overlay::REACH) {
        return Err(ProfileError::Size { what: "the text size", value: size });
    }
    let count = text.chars().count();
    if count > MOST_CHARACTERS {
        return Err(ProfileError::LongText { count });
    }
    let font = open(font)?;
    let units = f64::from(font.units_per_em());
    let scale = size * EM / units;
    let glyphs = shaped(&font, text)?;
    let width = glyphs.iter().map(|g| g.advance).sum::<f64>() * scale;
    let shift = dvec2(shift_x(options.halign, width), 0.0);
    let mut pen = Pen { outline: Outline::new(options.tolerance), origin: shift, scale };
    let outlines = font.outline_glyphs();
    let mut x = 0.0;
    for glyph in &glyphs {
        pen.origin = shift + (dvec2(x, 0.0) + glyph.offset) * scale;
        x += glyph.advance;
        let Some(outline) = outlines.get(glyph.id.into()) else { continue };
        outline
            .draw(&DrawOptions::default(), DrawMemory::Scratch, &mut pen)
            .map_err(|error| ProfileError::Font { reason: error.to_string() })?;
    }
    let needed = pen.outline.most_chords();
    if needed > MOST_CHORDS {
        return Err(ProfileError::FineCurve { needed });
    }
    let mut contours: Vec<Contour> = pen.outline.take();
    let rise = shift_y(options.valign, &contours);
    contours.iter_mut().flat_map(|contour| &mut contour.points).for_each(|point| point.y += rise);
    Ok(Text { region: overlay(&contours, [], Rule::Union, Fill::NonZero), width })
}

fn open(font: Option<&[u8]>) -> Result<Font, ProfileError> {
    let broken = |reason: &str| ProfileError::Font { reason: reason.to_string() };
    let opened = match font {
        Some(bytes) => Font::new(bytes.to_vec(), 0),
        None => Font::new(LIBERATION_SANS, 0),
    };
    let font = opened.ok_or_else(|| broken("it is in no known format"))?;
    match font {
        font if font.units_per_em() == 0 => Err(broken("it has no em square")),
        font if font.outline_glyphs().is_empty() => Err(broken("it has no outlines")),
        font => Ok(font),
    }
}

/// A glyph in its place, font units.
struct Glyph {
    id: u32,
    advance: f64,
    offset: DVec2,
}

fn shaped(font: &Font, text: &str) -> Result<Vec<Glyph>, ProfileError> {
    let map = font.charmap();
    if let Some(character) = text.chars().find(|&c| map.map_unicode(c).is_none_or(is_missing)) {
        return Err(ProfileError::Glyph { character });
    }
    let mut buffer = Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    if text.is_empty() {
        return Ok(vec![]);
    }
    harfrust::shape(&ShaperFont::new(font), &mut buffer, ShapeOptions::new())
        .map_err(|error| ProfileError::Font { reason: format!("{error:?}") })?;
    let glyphs = buffer.glyph_infos().iter().zip(buffer.glyph_positions());
    let placed = glyphs.map(|(info, position)| Glyph {
        id: info.glyph_id,
        advance: f64::from(position.x_advance) * SPACING,
        offset: dvec2(f64::from(position.x_offset), f64::from(position.y_offset)),
    });
    Ok(placed.collect())
}

fn is_missing(glyph: skrifa::GlyphId) -> bool {
    glyph.to_u32() == 0
}

fn shift_x(align: Align, width: f64) -> f64 {
    match align {
        Align::Left => 0.0,
        Align::Center => -width / 2.0,
        Align::Right => -width,
    }
}

fn shift_y(align: Baseline, contours: &[Contour]) -> f64 {
    let heights = || contours.iter().flat_map(|contour| &contour.points).map(|point| point.y);
    let ascent = heights().fold(0.0, f64::max) * SPACING;
    let descent = -heights().fold(0.0, f64::min) * SPACING;
    match align {
        Baseline::Baseline => 0.0,
        Baseline::Top => -ascent,
        Baseline::Center => (descent - ascent) / 2.0,
        Baseline::Bottom => descent,
    }
}

/// Draws glyphs in font units into an outline in millimetres.
struct Pen {
    outline: Outline,
    origin: DVec2,
    scale: f64,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> DVec2 {
        self.origin + dvec2(f64::from(x), f64::from(y)) * self.scale
    }
}

impl PathSink for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.outline.move_to(self.at(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.outline.line_to(self.at(x, y));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.outline.quad_to(self.at(cx, cy), self.at(x, y));
    }

    fn curve_to(&mut self, cx: f32, cy: f32, dx: f32, dy: f32, x: f32, y: f32) {
        self.outline.cubic_to(self.at(cx, cy), self.at(dx, dy), self.at(x, y));
    }

    fn close(&mut self) {
        self.outline.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::profile::measure::bounds;

    fn set(s: &str, halign: Align, valign: Baseline) -> Text {
        let tolerance = Tolerance::new(0.001).unwrap();
        text(s, &TextOptions { halign, valign, tolerance, ..TextOptions::default() }, None).unwrap()
    }

    /// Bounds of OpenSCAD 2021.01's export of `text("AVATAR fig", size = 10, font = "Liberation Sans",
    /// $fn = 64)`, and the width it aligns by.
    #[test]
    fn sizes_and_kerning_are_those_of_openscad() {
        let left = set("AVATAR fig", Align::Left, Baseline::Baseline);
        let (low, high) = bounds(&left.region).unwrap();
        let theirs = [0.0271, -2.882, 67.619, 10.0634];
        for (ours, theirs) in [low.x, low.y, high.x, high.y].iter().zip(theirs) {
            assert!((ours - theirs).abs() < 0.01, "{ours} {theirs}");
        }
        assert!((left.width - 68.3336).abs() < 0.01, "{}", left.width);
        let right = set("AVATAR fig", Align::Right, Baseline::Top);
        assert!((bounds(&right.region).unwrap().1.x - (high.x - left.width)).abs() < 1e-9);
    }

    /// OpenSCAD 2021.01 with the same font: `valign` goes by the letters, not by the font's line.
    #[test]
    fn letters_align_by_their_own_edges() {
        let edges = |s, valign| {
            let (low, high) = bounds(&set(s, Align::Left, valign).region).unwrap();
            (low.y, high.y)
        };
        let (foot, head) = edges("H", Baseline::Baseline);
        assert_eq!(foot, 0.0);
        assert!((edges("H", Baseline::Top).1 - head * (1.0 - SPACING)).abs() < 1e-9);
        assert!((edges("H", Baseline::Center).1 - head * (1.0 - SPACING / 2.0)).abs() < 1e-9);
        assert_eq!(edges("H", Baseline::Bottom).0, 0.0);
        let (foot, _) = edges("g", Baseline::Baseline);
        assert!((edges("g", Baseline::Bottom).0 - foot * (1.0 - SPACING)).abs() < 1e-9);
    }

    #[test]
    fn bounds_of_katachi_are_those_of_openscad() {
        let set = set("Katachi", Align::Left, Baseline::Baseline);
        let (low, high) = bounds(&set.region).unwrap();
        let theirs = [1.1393, -0.13559, 44.3763, 10.0634];
        for (ours, theirs) in [low.x, low.y, high.x, high.y].iter().zip(theirs) {
            assert!((ours - theirs).abs() < 0.01, "{ours} {theirs}");
        }
    }

    #[test]
    fn letters_count_their_holes() {
        let set = set("8o", Align::Center, Baseline::Center);
        assert_eq!(set.region.pieces.len(), 2);
        assert_eq!(set.region.pieces[0].holes.len(), 2);
        assert!(text(" ", &TextOptions::default(), None).unwrap().region.is_empty());
        assert_eq!(text("", &TextOptions::default(), None).unwrap().width, 0.0);
    }

    #[test]
    fn letters_grow_shrink_and_round() {
        let set = set("Katachi & more: 0123456789 @%", Align::Left, Baseline::Baseline).region;
        let (area, length) = (set.area(), crate::kernel::profile::measure::perimeter(&set));
        let fine = Tolerance::new(0.001).unwrap();
        let grown = crate::kernel::profile::offset(&set, 0.01, fine).area();
        let shrunk = crate::kernel::profile::offset(&set, -0.01, fine).area();
        assert!((grown - area - 0.01 * length).abs() < 0.05, "{grown} {area} {length}");
        assert!((area - shrunk - 0.01 * length).abs() < 0.05, "{shrunk} {area} {length}");
        let gone = crate::kernel::profile::offset(&set, -2.0, fine);
        assert!(gone.is_empty());
        let round = crate::kernel::profile::round(&set, 0.1, fine);
        assert!(!round.is_empty() && (round.area() - area).abs() < 0.05 * area);
    }

    #[test]
    fn what_has_no_glyph_is_named() {
        let error = text("a漢", &TextOptions::default(), None).unwrap_err();
        assert_eq!(error.to_string(), "the font has no glyph for '漢' (U+6F22)");
        let rubbish = text("a", &TextOptions::default(), Some(b"rubbish")).unwrap_err();
        assert!(rubbish.to_string().starts_with("the font cannot be read"), "{rubbish}");
    }
}
