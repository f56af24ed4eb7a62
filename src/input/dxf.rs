//! DXF drawings (ASCII): the outlines among its entities become a plane figure.
//!
//! Read are LINE, LWPOLYLINE, POLYLINE, ARC, CIRCLE, ELLIPSE, SPLINE and INSERT of the model, in millimetres by
//! `$INSUNITS` (millimetres where it says nothing). Open entities whose ends meet within [`JOIN`] are
//! joined; every outline must close. What lies in an odd number of outlines is filled. Other entities are
//! left out with a note.

mod chain;
mod entity;
mod spline;

use std::collections::BTreeMap;

use glam::{DAffine2, DMat2, DVec2, dvec2};

use super::{Figure, Place, ReadError, error::Format};
use crate::geom::{
    Stretch, Tolerance,
    overlay::{Fill, Rule, overlay},
    trig,
};
use chain::{Chain, joined};
use entity::{Entity, drawing};

const DXF: Format = Format("DXF");

/// How far apart, in mm, ends of lines and arcs may be that are meant to meet.
pub const JOIN: f64 = 1e-3;

/// The most edges a drawing may have after its blocks are placed.
pub const MOST_EDGES: usize = 1 << 22;

/// How deep blocks may hold blocks.
const MOST_DEPTH: usize = 32;

/// The figure of a DXF file.
///
/// # Errors
/// A binary file, lines that are no pairs of code and value, numbers out of place, outlines that do
/// not close (with their ends), curves of more chords than are drawn, blocks nested without end, no outlines.
pub fn read(bytes: &[u8], tolerance: Tolerance) -> Result<Figure, ReadError> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(DXF.error(
            Place::Byte(0),
            "a binary DXF file",
            "an ASCII one is needed: save it as such",
        ));
    }
    let text = String::from_utf8_lossy(bytes);
    let drawing = drawing(&text)?;
    let mut tracer = Tracer {
        blocks: &drawing.blocks,
        tolerance,
        chains: vec![],
        edges: 0,
        curves: 0,
        left_out: BTreeMap::new(),
    };
    let millimetres = DAffine2::from_scale(DVec2::splat(drawing.unit));
    tracer.trace(&drawing.entities, &millimetres, 0)?;
    let notes = tracer.left_out.iter().map(|(kind, n)| format!("{n} {kind} left out"));
    let notes: Vec<String> = notes.collect();
    let contours = joined(tracer.chains)?;
    let region = overlay(&contours, [], Rule::Union, Fill::EvenOdd);
    if region.is_empty() {
        let found = format!("no outlines {}", notes.join(", "));
        return Err(DXF.error(
            Place::File,
            found.trim(),
            "closed lines, arcs, circles or polylines are needed",
        ));
    }
    Ok(Figure { region, notes })
}

/// A block: its base point and its entities.
struct Block<'a> {
    base: DVec2,
    entities: Vec<Entity<'a>>,
}

/// Turns entities into chains of edges.
struct Tracer<'a> {
    blocks: &'a BTreeMap<&'a str, Block<'a>>,
    tolerance: Tolerance,
    chains: Vec<Chain>,
    edges: usize,
    curves: u32,
    left_out: BTreeMap<String, usize>,
}

impl Tracer<'_> {
    fn trace(
        &mut self,
        entities: &[Entity],
        map: &DAffine2,
        depth: usize,
    ) -> Result<(), ReadError> {
        for (i, entity) in entities.iter().enumerate() {
            let fine = self.tolerance.before(Stretch::of_plane(map.matrix2));
            let map = *map * entity.side()?;
            let chain = match entity.kind {
                "LINE" => Some(Chain::line(entity)?),
                "CIRCLE" => Some(Chain::arc(entity, (0.0, 360.0), fine)?),
                "ARC" => Some(Chain::arc(
                    entity,
                    (entity.number(50, 0.0)?, entity.number(51, 360.0)?),
                    fine,
                )?),
                "ELLIPSE" => Some(Chain::ellipse(entity, fine, self.number())?),
                "SPLINE" => Some(spline::chain(entity, fine, self.number())?),
                "LWPOLYLINE" => Some(Chain::polyline(entity, &entity.vertices()?, fine)?),
                "POLYLINE" => {
                    let rest = entities[i + 1..].iter().take_while(|e| e.kind == "VERTEX");
                    let vertices: Result<Vec<_>, _> = rest.filter_map(Entity::vertex).collect();
                    Some(Chain::polyline(entity, &vertices?, fine)?)
                }
                "INSERT" => {
                    self.insert(entity, &map, depth)?;
                    None
                }
                "VERTEX" | "SEQEND" | "VIEWPORT" => None,
                other => {
                    *self.left_out.entry(other.chars().take(40).collect()).or_default() += 1;
                    None
                }
            };
            if let Some(chain) = chain.filter(|c| c.points.len() >= 2) {
                self.push(chain.placed(&map, self.curves))?;
            }
        }
        Ok(())
    }

    fn push(&mut self, chain: Chain) -> Result<(), ReadError> {
        self.curves += 2;
        self.edges += chain.points.len();
        self.check()?;
        self.chains.push(chain);
        Ok(())
    }

    fn check(&self) -> Result<(), ReadError> {
        if self.edges <= MOST_EDGES {
            return Ok(());
        }
        Err(DXF.limit("the number of edges", format!("{MOST_EDGES} edges")))
    }

    /// The number of a smooth curve.
    fn number(&self) -> u32 {
        self.curves
    }

    fn insert(&mut self, entity: &Entity, map: &DAffine2, depth: usize) -> Result<(), ReadError> {
        let name = entity.text(2).unwrap_or_default();
        let blocks = self.blocks;
        let Some(block) = blocks.get(name) else {
            return Err(
                entity.error(format!("the block \"{name}\""), "it must be among the blocks")
            );
        };
        if depth >= MOST_DEPTH {
            return Err(
                entity.error(format!("blocks nested deeper than {MOST_DEPTH}"), "fewer are needed")
            );
        }
        let scale = dvec2(entity.number(41, 1.0)?, entity.number(42, 1.0)?);
        let turn = entity.number(50, 0.0)?;
        let (s, c) = (trig::sin_deg(turn), trig::cos_deg(turn));
        let turn = DMat2::from_cols(dvec2(c, s), dvec2(-s, c));
        let (columns, rows) = (entity.count(70)?, entity.count(71)?);
        let step = dvec2(entity.number(44, 0.0)?, entity.number(45, 0.0)?);
        for cell in 0..columns.saturating_mul(rows) {
            // An empty block placed often costs too.
            self.edges += 1;
            self.check()?;
            let shift = turn * (step * dvec2((cell % columns) as f64, (cell / columns) as f64));
            let linear = turn * DMat2::from_diagonal(scale);
            let place = DAffine2 {
                matrix2: linear,
                translation: entity.point(10)? + shift - linear * block.base,
            };
            self.trace(&block.entities, &(*map * place), depth + 1)?;
        }
        Ok(())
    }
}
