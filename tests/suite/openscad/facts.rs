//! What is compared of two solids, and how near it must be.

use glam::DVec3;
use katachi::{
    geom::Tolerance,
    kernel::brep::{
        Polyhedron,
        boolean::{Tree, evaluate},
        measure,
    },
    session::Measures,
};
use serde_json::Value;

/// What six digits leave open.
///
/// OpenSCAD writes coordinates with six significant digits: each is off by at most 5e-6 of its size, a
/// point by at most sqrt(3) * 5e-6 = 8.7e-6 of the largest coordinate. So the boundary moves by less
/// than 1e-5 of that coordinate, and what lies between the two boundaries has less volume than
/// area * 1e-5 * largest coordinate. Volume and area themselves come out far better, because the
/// errors of many points are as often outwards as inwards; they are held to 1e-5 of their value.
pub const SIX_DIGITS: f64 = 1e-5;

/// Measures of a solid.
#[derive(Clone, Debug)]
pub struct Facts {
    /// mm^3.
    pub volume: f64,
    /// mm^2.
    pub area: f64,
    /// Smallest and largest corner.
    pub bounds: [DVec3; 2],
    /// Handles.
    pub genus: i64,
    /// Connected components of the boundary.
    pub shells: usize,
    /// Whether every edge borders two faces.
    pub closed: bool,
}

impl From<&Measures> for Facts {
    fn from(m: &Measures) -> Facts {
        let bounds = m.bounds.unwrap_or_default();
        let (volume, area, genus) = (m.volume, m.area, m.genus());
        Facts { volume, area, bounds, genus, shells: m.shells, closed: m.closed }
    }
}

impl From<&Polyhedron> for Facts {
    fn from(solid: &Polyhedron) -> Facts {
        Facts {
            volume: measure::volume(solid),
            area: measure::area(solid),
            bounds: measure::bounds(solid).unwrap_or_default(),
            genus: measure::genus(solid),
            shells: measure::shells(solid),
            closed: true,
        }
    }
}

impl Facts {
    /// Those of an `expected.json`; `None` where a number is missing.
    pub fn from_json(json: &Value) -> Option<Facts> {
        let corner = |corner: &Value| {
            let number = |i: usize| corner[i].as_f64();
            Some(DVec3::new(number(0)?, number(1)?, number(2)?))
        };
        Some(Facts {
            volume: json["volume"].as_f64()?,
            area: json["area"].as_f64()?,
            bounds: [corner(&json["bbox"][0])?, corner(&json["bbox"][1])?],
            genus: json["genus"].as_i64()?,
            shells: json["shells"].as_u64()? as usize,
            closed: true,
        })
    }

    /// Where these facts differ from the expected ones: volume, area and bounds by more than `relative`
    /// of their value or of the largest edge, the others at all.
    pub fn differences(&self, expected: &Facts, relative: f64) -> Vec<String> {
        let mut found = vec![];
        let numbers =
            [("volume", self.volume, expected.volume), ("area", self.area, expected.area)];
        for (name, here, there) in numbers {
            if off(here, there) > relative {
                found
                    .push(format!("{name} {here}, expected {there}, {:.1e} off", off(here, there)));
            }
        }
        let [min, max] = expected.bounds;
        let apart = |i: usize| (self.bounds[i] - expected.bounds[i]).abs().max_element();
        if apart(0).max(apart(1)) > relative * (max - min).max_element() {
            found.push(format!("bounds {:?}, expected {:?}", self.bounds, expected.bounds));
        }
        if !self.closed {
            found.push("it is not closed".to_string());
        }
        let topology = |f: &Facts| format!("genus {} in {} shells", f.genus, f.shells);
        if topology(self) != topology(expected) {
            found.push(format!("{}, expected {}", topology(self), topology(expected)));
        }
        found
    }

    /// What six digits leave open of the largest edge: more when the solid lies far from the origin.
    pub fn precision(&self) -> f64 {
        let edge = (self.bounds[1] - self.bounds[0]).max_element();
        SIX_DIGITS * (self.reach() / edge).max(1.0)
    }

    /// The largest coordinate.
    pub fn reach(&self) -> f64 {
        self.bounds[0].abs().max(self.bounds[1].abs()).max_element()
    }
}

/// The thickness to allow between solids that are compared to `relative`. It is nothing where facets
/// correspond. Else both programs keep to the default tolerance on curved walls, which are less than
/// half of the boundary in what is compared here.
pub fn arcs(relative: f64) -> f64 {
    if relative > SIX_DIGITS { Tolerance::DEFAULT.mm() } else { 0.0 }
}

/// Relative difference.
pub fn off(here: f64, there: f64) -> f64 {
    if here == there { 0.0 } else { (here - there).abs() / there.abs() }
}

/// What is to be said when more lies between two solids than six digits leave open, and `arcs`:
/// the share of arcs that each program draws with facets of its own, as a mean thickness in mm over the
/// whole boundary. The symmetric difference is computed by our own exact set operations.
pub fn apart(ours: &Polyhedron, theirs: &Polyhedron, arcs: f64) -> Option<String> {
    let facts = Facts::from(theirs);
    let limit = facts.area * (SIX_DIGITS * facts.reach() + arcs);
    match symmetric_difference(ours, theirs) {
        Ok(volume) if volume <= limit => None,
        Ok(volume) => {
            Some(format!("{volume} mm^3 lie in one solid only, at most {limit} expected"))
        }
        Err(words) => Some(format!("no symmetric difference: {words}")),
    }
}

/// The volume of what is in one solid only, mm^3.
pub fn symmetric_difference(a: &Polyhedron, b: &Polyhedron) -> Result<f64, String> {
    let leaf = |solid: &Polyhedron| Tree::Leaf(solid.clone().into());
    let less = |a: &Polyhedron, b: &Polyhedron| Tree::Difference(vec![leaf(a), leaf(b)]);
    let tree = Tree::Union(vec![less(a, b), less(b, a)]);
    let found = evaluate(&tree).map_err(|e| e.to_string())?;
    Ok(measure::volume(&found.solid))
}
