//! Line-printer pictures: each cell of a text is struck up to three times, so that some twenty levels of ink come of
//! the signs of a typewriter.
//!
//! # Paper
//! METHODS 3.4: the paper printed its pictures in 20 levels by overstriking.
//!
//! # Departures
//! The paper's levels are a table for one printer. Here the ink of every strike is measured on the outlines of a font,
//! and the levels are those whose ink is nearest to equal steps from none to the most there is, which stands for black.
//! What a cell is wrong by is passed on to its neighbours.

use glam::{DVec2, dvec2};

use super::{
    average::Average,
    diffusion::{FLOYD_STEINBERG, scan},
    ink::{Ink, Mark},
    picture::Picture,
};
use crate::{
    geom::{
        Contour,
        overlay::{Fill, Rule, overlay},
    },
    output::sheet::Lettering,
};

/// A cell of a line printer: ten to the inch across, six to the inch down, mm.
const CELL: DVec2 = dvec2(25.4 / 10.0, 25.4 / 6.0);

/// Height of capitals, and of the base line above the cell's lower edge, mm.
const HEIGHT: f64 = 2.6;
const BASE: f64 = 1.0;

/// The signs that are struck: from little ink to much, of different shapes.
const SIGNS: &str = ".,-:;=+*/)(!ITXHOANMWB8#$%&@0";

/// Strikes to a cell at most.
const STRIKES: usize = 3;

/// Levels at most: more than strikes differ by.
pub const LEVELS: usize = 40;

/// A text that is a picture when its strikes are printed over each other.
#[derive(Clone, PartialEq, Debug)]
pub struct Overstrike {
    /// Of each line what is struck first, second and third.
    pub lines: Vec<[String; STRIKES]>,
    /// The signs as ink.
    pub ink: Ink,
}

/// Signs struck over each other, and how much of a cell they cover.
#[derive(Clone, PartialEq, Debug)]
pub struct Level {
    /// The signs.
    pub signs: Vec<char>,
    /// The part of the cell that is black.
    pub ink: f64,
}

/// What a sign covers of its cell, with its lower left corner at the origin. As with a typewriter's, all signs are as wide
/// as a cell: wider ones are made narrow.
pub(super) struct Sign {
    sign: char,
    outlines: Vec<Contour>,
}

pub(super) fn signs(lettering: &dyn Lettering) -> Vec<Sign> {
    let sign = |sign: char| {
        let (outlines, width) = lettering.outlines(&sign.to_string(), HEIGHT)?;
        let (low, high) = outlines
            .iter()
            .flatten()
            .fold((0.0, width), |(low, high), p| (p.x.min(low), p.x.max(high)));
        let narrowed = (CELL.x / (high - low)).min(1.0);
        let shift = dvec2((CELL.x - (high - low) * narrowed) / 2.0 - low * narrowed, BASE);
        let moved = |points: Vec<DVec2>| {
            let place = |p: DVec2| dvec2(p.x * narrowed, p.y) + shift;
            Contour::polygon(points.into_iter().map(place).collect())
        };
        Some(Sign { sign, outlines: outlines.into_iter().map(moved).collect() })
    };
    SIGNS.chars().filter_map(sign).collect()
}

/// So many levels from white to the most ink there is, in nearly equal steps of ink; fewer if strikes do not differ
/// by that many.
pub fn levels(lettering: &dyn Lettering, count: usize) -> Vec<Level> {
    levels_of(&signs(lettering), count)
}

fn levels_of(signs: &[Sign], count: usize) -> Vec<Level> {
    let mut all = vec![(vec![], 0.0)];
    for i in 0..signs.len() {
        all.push(struck(signs, vec![i]));
        for j in 0..i {
            all.push(struck(signs, vec![j, i]));
            all.extend((0..j).map(|k| struck(signs, vec![k, j, i])));
        }
    }
    evenly(signs, all, count)
}

/// The same of one strike each.
pub(super) fn single_levels(signs: &[Sign], count: usize) -> Vec<Level> {
    let single = (0..signs.len()).map(|i| struck(signs, vec![i]));
    evenly(signs, single.chain([(vec![], 0.0)]).collect(), count)
}

/// Signs by their places, and the part of a cell that they cover.
type Strike = (Vec<usize>, f64);

fn struck(signs: &[Sign], chosen: Vec<usize>) -> Strike {
    let contours = chosen.iter().flat_map(|&i| &signs[i].outlines);
    let area = overlay(contours, [], Rule::Union, Fill::NonZero).area();
    (chosen, area / CELL.element_product())
}

/// Of many strikes those whose ink is nearest to equal steps.
fn evenly(signs: &[Sign], mut all: Vec<Strike>, count: usize) -> Vec<Level> {
    // Of strikes with as much ink those with fewer signs come first.
    all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.len().cmp(&b.0.len())).then(a.0.cmp(&b.0)));
    let most = all.last().map_or(0.0, |last| last.1);
    let mut levels: Vec<Level> = vec![];
    for step in 0..count {
        let wanted = most * step as f64 / (count.max(2) - 1) as f64;
        let reached = levels.last().map_or(-1.0, |level| level.ink);
        let above = all.iter().filter(|strike| strike.1 > reached);
        let nearest = above.min_by(|a, b| (a.1 - wanted).abs().total_cmp(&(b.1 - wanted).abs()));
        if let Some((chosen, ink)) = nearest {
            let signs = chosen.iter().map(|&i| signs[i].sign).collect();
            levels.push(Level { signs, ink: *ink });
        }
    }
    levels
}

/// A picture in so many levels of struck signs.
pub fn overstrike(picture: &Picture, lettering: &dyn Lettering, count: usize) -> Overstrike {
    let signs = signs(lettering);
    let levels = levels_of(&signs, count.clamp(2, LEVELS));
    let tones = Average::of(picture);
    let window = picture.frame.window;
    let size = ((window.max - window.min) / CELL).ceil();
    let mut text = Overstrike { lines: vec![], ink: Ink { frame: picture.frame, marks: vec![] } };
    let size = [size.x, size.y].map(|n| n as usize);
    let corner = |row: usize, column: usize| {
        window.min.with_y(window.max.y) + dvec2(column as f64, -(row as f64 + 1.0)) * CELL
    };
    let chosen = chosen(&levels, size, |row, column| {
        1.0 - tones.over(corner(row, column) + CELL / 2.0, CELL)
    });
    for (row, chosen) in chosen.chunks(size[0].max(1)).enumerate() {
        let mut line = <[String; STRIKES]>::default();
        for (column, &level) in chosen.iter().enumerate() {
            let (level, corner) = (&levels[level], corner(row, column));
            for (strike, line) in line.iter_mut().enumerate() {
                line.push(level.signs.get(strike).copied().unwrap_or(' '));
            }
            for sign in signs.iter().filter(|s| level.signs.contains(&s.sign)) {
                let placed = |c: &Contour| c.points.iter().map(|p| *p + corner).collect();
                text.ink.marks.push(Mark::Area(sign.outlines.iter().map(placed).collect()));
            }
        }
        text.lines.push(line.map(|strike| strike.trim_end().to_string()));
    }
    text
}

/// The level of each cell, row by row, given how dark it is of what levels can be. What a level is wrong by is passed on,
/// so that the mean tone is right; paper stays clean.
fn chosen(levels: &[Level], size: [usize; 2], dark: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let most = levels.last().map_or(1.0, |level| level.ink).max(f64::MIN_POSITIVE);
    let mut chosen = vec![0; size[0] * size[1]];
    scan(size, FLOYD_STEINBERG, |row, column, owed| {
        let dark = dark(row, column);
        if dark < BLANK {
            return 0.0;
        }
        let wanted = (dark + owed) * most;
        let above = levels.partition_point(|level| level.ink < wanted).min(levels.len() - 1);
        let below = above.saturating_sub(1);
        let is_below = wanted - levels[below].ink < levels[above].ink - wanted;
        let level = if is_below { below } else { above };
        chosen[row * size[0] + column] = level;
        (wanted - levels[level].ink) / most
    });
    chosen
}

/// Cells are paper below this part of black.
const BLANK: f64 = 1.0 / 512.0;

impl Overstrike {
    /// The text for a printer that goes back to the start of the line at a carriage return.
    pub fn text(&self) -> String {
        let line = |strikes: &[String; STRIKES]| {
            let struck: Vec<&str> =
                strikes.iter().map(String::as_str).filter(|s| !s.is_empty()).collect();
            struck.join("\r") + "\n"
        };
        self.lines.iter().map(line).collect()
    }
}
