//! What is wrong with the input of a plane figure.

use glam::DVec2;

/// Why a plane figure cannot be made: what was found and what is needed.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ProfileError {
    /// A size that encloses nothing.
    #[error("{what} is {value}; it must be greater than 0 and finite")]
    Size {
        /// The name of the size.
        what: &'static str,
        /// The value given, mm.
        value: f64,
    },
    /// A regular polygon of too few or too many sides.
    #[error("{sides} sides; 3 to {most} are made", most = super::primitive::MOST_SIDES)]
    Sides {
        /// The number given.
        sides: u32,
    },
    /// A corner that is infinite, not a number, or too far away.
    #[error("corner {index}{of} is ({x}, {y}); coordinates must be numbers of at most {reach} mm",
        of = Outline(*contour), x = at.x, y = at.y, reach = crate::geom::overlay::REACH)]
    Coordinate {
        /// 0 for the outline, 1 for the first hole.
        contour: usize,
        /// The number of the corner.
        index: usize,
        /// The corner.
        at: DVec2,
    },
    /// A contour of fewer than three corners.
    #[error("a polygon needs at least 3 corners, {which} has {count}", which = Named(*contour))]
    Corners {
        /// 0 for the outline, 1 for the first hole.
        contour: usize,
        /// The number of corners.
        count: usize,
    },
    /// Two corners in a row at one place.
    #[error("corners {index} and {next}{of} are both at ({x}, {y}); each corner is given once, the last joins the first by itself",
        of = Outline(*contour), x = at.x, y = at.y)]
    Repeated {
        /// 0 for the outline, 1 for the first hole.
        contour: usize,
        /// The number of the first of the two.
        index: usize,
        /// The number of the second.
        next: usize,
        /// The corner.
        at: DVec2,
    },
    /// A contour whose corners lie on one line.
    #[error("{which} encloses no area: all corners lie on one line", which = Named(*contour))]
    Flat {
        /// 0 for the outline, 1 for the first hole.
        contour: usize,
    },
    /// Two segments that cross or lie on each other.
    #[error("the polygon crosses itself at ({x}, {y}): {first} and {second} meet there",
        x = at.x, y = at.y, first = segments[0], second = segments[1])]
    SelfCrossing {
        /// Where, mm.
        at: DVec2,
        /// The two segments, in order.
        segments: [Segment; 2],
    },
    /// A hole that lies outside the outline or within another hole.
    #[error("{which} does not lie inside the polygon; it must be inside the outline and outside the other holes",
        which = Named(*contour))]
    StrayHole {
        /// 1 for the first hole.
        contour: usize,
    },
    /// Points that span no area.
    #[error("a hull needs 3 points that are not on one line; {count} were given")]
    FlatHull {
        /// The number of points.
        count: usize,
    },
    /// A font file that cannot be read.
    #[error(
        "the font cannot be read: {reason}; a TrueType or OpenType font with outlines is needed"
    )]
    Font {
        /// What the reader says.
        reason: String,
    },
    /// A character without a glyph.
    #[error("the font has no glyph for {character:?} (U+{code:04X})", code = u32::from(*character))]
    Glyph {
        /// The character.
        character: char,
    },
    /// A text that shapes into too much.
    #[error("the text has {count} characters; at most {most} are set in one piece", most = super::text::MOST_CHARACTERS)]
    LongText {
        /// The number of characters.
        count: usize,
    },
    /// A curve that the tolerance asks for more chords of than are drawn.
    #[error("a curve needs {needed} chords at this tolerance; the limit is {most}", most = crate::geom::flatten::MOST_CHORDS)]
    FineCurve {
        /// The number of chords.
        needed: u32,
    },
}

/// A segment of a polygon: the one from corner `index` to the next.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Segment {
    /// 0 for the outline, 1 for the first hole.
    pub contour: usize,
    /// The number of its first corner.
    pub index: usize,
    /// The number of its second corner.
    pub next: usize,
}

impl std::fmt::Display for Segment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the segment from corner {} to {}{}",
            self.index,
            self.next,
            Outline(self.contour)
        )
    }
}

/// " of hole 0", nothing for the outline.
struct Outline(usize);

impl std::fmt::Display for Outline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            0 => Ok(()),
            hole => write!(f, " of hole {}", hole - 1),
        }
    }
}

/// "the outline" or "hole 0".
struct Named(usize);

impl std::fmt::Display for Named {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            0 => write!(f, "the outline"),
            hole => write!(f, "hole {}", hole - 1),
        }
    }
}
