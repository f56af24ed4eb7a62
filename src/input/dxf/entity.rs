//! The pairs of code and value a DXF file is made of, gathered to entities.

use std::collections::BTreeMap;

use glam::{DAffine2, DVec2, dvec2};

use super::{Block, DXF};
use crate::input::{Place, ReadError, error::shortened};

/// A group code, its value, and the line the value stands on.
#[derive(Clone, Copy)]
struct Pair<'a> {
    code: i32,
    value: &'a str,
    line: usize,
}

/// An entity: what follows a code 0.
pub(super) struct Entity<'a> {
    /// Its name: `LINE`, `ARC` ...
    pub kind: &'a str,
    pairs: Vec<Pair<'a>>,
    line: usize,
}

/// A corner of a polyline and the bulge of the edge behind it: the tangent of a quarter of its arc.
pub(super) type Vertex = (DVec2, f64);

impl<'a> Entity<'a> {
    /// An error at this entity.
    pub fn error(&self, found: String, needed: &str) -> ReadError {
        DXF.error(Place::Line(self.line), format!("{}: {found}", self.kind), needed)
    }

    /// The first value of a code.
    pub fn text(&self, code: i32) -> Option<&'a str> {
        self.pairs.iter().find(|p| p.code == code).map(|p| p.value)
    }

    /// The first number of a code.
    pub fn number(&self, code: i32, default: f64) -> Result<f64, ReadError> {
        let pair = self.pairs.iter().find(|p| p.code == code);
        pair.map_or(Ok(default), |p| DXF.number(p.value, Place::Line(p.line)))
    }

    /// The value of a header variable, which follows its name.
    fn variable(&self, name: &str) -> Option<&'a str> {
        let at = self.pairs.iter().position(|p| p.code == 9 && p.value == name)?;
        self.pairs.get(at + 1).map(|p| p.value)
    }

    /// All numbers of a code, in order.
    pub fn numbers(&self, code: i32) -> Result<Vec<f64>, ReadError> {
        let pairs = self.pairs.iter().filter(|p| p.code == code);
        pairs.map(|p| DXF.number(p.value, Place::Line(p.line))).collect()
    }

    /// The point whose x has this code, and whose y the code 10 above.
    pub fn point(&self, code: i32) -> Result<DVec2, ReadError> {
        Ok(dvec2(self.number(code, 0.0)?, self.number(code + 10, 0.0)?))
    }

    /// All points of a code.
    pub fn points(&self, code: i32) -> Result<Vec<DVec2>, ReadError> {
        let (x, y) = (self.numbers(code)?, self.numbers(code + 10)?);
        if x.len() != y.len() {
            return Err(self
                .error(format!("{} x and {} y", x.len(), y.len()), "as many of both are needed"));
        }
        Ok(x.into_iter().zip(y).map(|(x, y)| dvec2(x, y)).collect())
    }

    /// A number of copies, at least 1.
    pub fn count(&self, code: i32) -> Result<usize, ReadError> {
        Ok(self.number(code, 1.0)?.clamp(1.0, 1e9) as usize)
    }

    /// A bit of the flags, code 70.
    pub fn flag(&self, bit: i64) -> Result<bool, ReadError> {
        Ok(self.number(70, 0.0)? as i64 & bit != 0)
    }

    /// Entities drawn on the back of the plane have x turned round.
    pub fn side(&self) -> Result<DAffine2, ReadError> {
        let on_plane = matches!(self.kind, "LINE" | "ELLIPSE" | "SPLINE");
        let back = !on_plane && self.number(230, 1.0)? < 0.0;
        Ok(DAffine2::from_scale(dvec2(if back { -1.0 } else { 1.0 }, 1.0)))
    }

    /// The corners of an LWPOLYLINE.
    pub fn vertices(&self) -> Result<Vec<Vertex>, ReadError> {
        let mut vertices: Vec<Vertex> = vec![];
        for pair in &self.pairs {
            if !matches!(pair.code, 10 | 20 | 42) {
                continue;
            }
            let value = DXF.number(pair.value, Place::Line(pair.line))?;
            match (pair.code, vertices.last_mut()) {
                (10, _) => vertices.push((dvec2(value, 0.0), 0.0)),
                (20, Some(last)) => last.0.y = value,
                (42, Some(last)) => last.1 = value,
                _ => {}
            }
        }
        Ok(vertices)
    }

    /// The corner a VERTEX stands for; `None` for control points of splines.
    pub fn vertex(&self) -> Option<Result<Vertex, ReadError>> {
        match self.flag(16) {
            Ok(true) => None,
            _ => Some(self.point(10).and_then(|p| Ok((p, self.number(42, 0.0)?)))),
        }
    }
}

/// What is read of a drawing.
pub(super) struct Drawing<'a> {
    /// Millimetres for each unit.
    pub unit: f64,
    /// The blocks by name.
    pub blocks: BTreeMap<&'a str, Block<'a>>,
    /// The entities of the model.
    pub entities: Vec<Entity<'a>>,
}

/// The drawing that a text holds.
pub(super) fn drawing(text: &str) -> Result<Drawing<'_>, ReadError> {
    let mut drawing = Drawing { unit: 1.0, blocks: BTreeMap::new(), entities: vec![] };
    let (mut section, mut block): (&str, Option<(&str, Block)>) = ("", None);
    for entity in entities(text)? {
        match entity.kind {
            "SECTION" => {
                section = entity.text(2).unwrap_or_default();
                drawing.unit = entity.variable("$INSUNITS").map_or(drawing.unit, unit);
            }
            "ENDSEC" => section = "",
            "EOF" => break,
            "BLOCK" if section == "BLOCKS" => {
                let name = entity.text(2).unwrap_or_default();
                block = Some((name, Block { base: entity.point(10)?, entities: vec![] }));
            }
            "ENDBLK" => drawing.blocks.extend(block.take()),
            _ if section == "ENTITIES" => drawing.entities.push(entity),
            _ => {
                if let Some((_, block)) = &mut block {
                    block.entities.push(entity);
                }
            }
        }
    }
    Ok(drawing)
}

/// All entities of a file, section marks and block marks among them.
fn entities(text: &str) -> Result<Vec<Entity<'_>>, ReadError> {
    let mut entities: Vec<Entity> = vec![];
    for pair in pairs(text) {
        let pair = pair?;
        if pair.code == 0 {
            entities.push(Entity { kind: pair.value, pairs: vec![], line: pair.line });
        } else if let Some(entity) = entities.last_mut() {
            entity.pairs.push(pair);
        }
    }
    if entities.is_empty() {
        let needed = "pairs of lines, a code and a value, are needed";
        return Err(DXF.error(Place::Line(1), "no entities", needed));
    }
    Ok(entities)
}

fn pairs(text: &str) -> impl Iterator<Item = Result<Pair<'_>, ReadError>> {
    let mut lines = text.lines().map(str::trim).enumerate();
    std::iter::from_fn(move || {
        let (number, code) = lines.next()?;
        let Some((line, value)) = lines.next() else {
            let blank = code.is_empty();
            let error = || {
                DXF.error(Place::Line(number + 1), "a code without a value", "lines come in pairs")
            };
            return (!blank).then(|| Err(error()));
        };
        let pair = code.parse().map(|code| Pair { code, value, line: line + 1 });
        Some(pair.map_err(|_| {
            let found = format!("\"{}\"", shortened(code));
            DXF.error(Place::Line(number + 1), found, "a group code, a whole number, is needed")
        }))
    })
}

/// Millimetres for each unit by the code of `$INSUNITS`.
fn unit(code: &str) -> f64 {
    match code {
        "1" => 25.4,
        "2" => 304.8,
        "5" => 10.0,
        "6" => 1000.0,
        "8" => 25.4e-6,
        "9" => 0.0254,
        "10" => 914.4,
        "13" => 0.001,
        "14" => 100.0,
        _ => 1.0,
    }
}
