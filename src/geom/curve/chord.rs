//! Parts of curves and the chords across them.

use glam::DVec3;

use super::Piece;

/// A part of a piece with the chord across it. No point of the part is farther than `off` from the point of the chord that
/// has the same share of the way.
#[derive(Clone, Debug)]
pub struct Chord<'a> {
    piece: &'a Piece,
    from: f64,
    to: f64,
    /// Where the part starts and ends, mm.
    pub ends: [DVec3; 2],
    /// The bound, mm.
    pub off: f64,
}

impl<'a> Chord<'a> {
    /// The chord of a whole piece.
    pub fn of(piece: &'a Piece) -> Chord<'a> {
        Chord::between(piece, [0.0, 1.0], piece.ends())
    }

    fn between(piece: &'a Piece, [from, to]: [f64; 2], ends: [DVec3; 2]) -> Chord<'a> {
        let step = to - from;
        Chord { piece, from, to, ends, off: piece.bend() * step * step / 8.0 }
    }

    /// Its two halves.
    pub fn halves(&self) -> [Chord<'a>; 2] {
        let middle = (self.from + self.to) / 2.0;
        let at = self.piece.at(middle);
        let [a, b] = self.ends;
        [
            Chord::between(self.piece, [self.from, middle], [a, at]),
            Chord::between(self.piece, [middle, self.to], [at, b]),
        ]
    }

    /// The point of the curve that has the same share of the way as the point of the chord nearest to `p`.
    pub fn at(&self, p: DVec3) -> DVec3 {
        let along = self.ends[1] - self.ends[0];
        let share = (p - self.ends[0]).dot(along) / along.length_squared();
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        self.piece.at(self.from + (self.to - self.from) * share)
    }
}
