//! Nodes as OpenSCAD statements.

use glam::{DVec2, DVec3};

use super::{ScadError, Writer, plane, points};
use crate::{
    geom::{Placement, Region, Tolerance, mesh::Color, sides},
    output::number::Shortest,
    shape::{Kind, Node, ShapeId, Stretched},
};

/// What stands for nothing: a union of no children.
const NOTHING: &str = "union() {}";

impl Writer<'_> {
    /// A shape as statements at a depth.
    pub(super) fn shape(&mut self, shape: Stretched, depth: usize) -> Result<(), ScadError> {
        if let Some(name) = self.modules.get(&shape) {
            let call = format!("{name}();");
            self.line(depth, &call);
            return Ok(());
        }
        let node = self.graph.node(shape.id).clone();
        match &node {
            Node::Extrude { profile, height, twist, scale } => {
                let words = self.extrusion(shape, *profile, *height, *twist, *scale)?;
                let frame = self.frame_of(*profile)?;
                let depth = depth + self.place(&frame, depth);
                self.line(depth, &words);
                let profile = self.graph.part(shape, *profile);
                self.figure(profile, &plane::inverse(&frame), depth + 1)
            }
            Node::Revolve { profile, angle, sides } => {
                let frame = self.frame_of(*profile)?;
                let words = self.revolution(shape, *profile, *angle, *sides)?;
                let depth = self.prefixes(&words, depth);
                self.figure(self.graph.part(shape, *profile), &plane::unrolled(&frame), depth)
            }
            Node::OffsetProfile { profile, .. } | Node::RoundProfile { profile, .. } => {
                let words = self.offsets(shape);
                let depth = self.prefixes(&words, depth);
                self.shape(self.graph.part(shape, *profile), depth)
            }
            Node::Offset { .. } | Node::Fillet { .. } => {
                let leaf = self.leaf(shape)?;
                self.line(depth, &leaf);
                Ok(())
            }
            Node::Transform { placement, child } => {
                let depth = depth + self.place(placement, depth);
                self.shape(self.graph.part(shape, *child), depth)
            }
            node if node.children().is_empty() => {
                let leaf = self.leaf(shape)?;
                self.line(depth, &leaf);
                Ok(())
            }
            node => {
                self.open(node, depth);
                for &child in node.children() {
                    self.shape(self.graph.part(shape, child), depth + 1)?;
                }
                self.line(depth, "}");
                Ok(())
            }
        }
    }

    /// The start of a block of shapes.
    pub(super) fn open(&mut self, node: &Node, depth: usize) {
        let word = match node {
            Node::Difference(_) => "difference()".to_string(),
            Node::Intersection(_) => "intersection()".to_string(),
            Node::Hull(_) => "hull()".to_string(),
            Node::Paint { color, .. } => paint(*color),
            _ => "union()".to_string(),
        };
        self.line(depth, &format!("{word} {{"));
    }

    /// One line for each word, each deeper than the one before; returns the depth of what they act on.
    pub(super) fn prefixes(&mut self, words: &[String], depth: usize) -> usize {
        for (i, word) in words.iter().enumerate() {
            self.line(depth + i, word);
        }
        depth + words.len()
    }

    /// A placement before what it moves; returns the number of lines, 0 for the identity.
    pub(super) fn place(&mut self, placement: &Placement, depth: usize) -> usize {
        if placement.is_identity() {
            return 0;
        }
        let (m, t) = (placement.linear(), placement.offset());
        let word = if *placement == Placement::translation(t) {
            format!("translate({})", points::triple(t))
        } else {
            let number = |i: usize, j: usize| Shortest(if j < 3 { m.col(j)[i] } else { t[i] });
            let rows = (0..3).map(|i| points::list((0..4).map(|j| number(i, j))));
            format!("multmatrix({})", points::list(rows.chain(["[0, 0, 0, 1]".to_string()])))
        };
        self.line(depth, &word);
        1
    }

    /// `offset` in the words of OpenSCAD, outermost first.
    pub(super) fn offsets(&self, shape: Stretched) -> Vec<String> {
        let (steps, radius) = match *self.graph.node(shape.id) {
            Node::OffsetProfile { d, .. } => (vec![d], d.abs()),
            // Opening rounds convex corners, closing concave ones; the two middle steps are one.
            Node::RoundProfile { r, .. } => (vec![-r, 2.0 * r, -r], r),
            _ => (vec![], 1.0),
        };
        let sides = sides::circle(radius, self.tolerance_of(shape));
        steps.iter().map(|&r| format!("offset(r = {}, $fn = {sides})", Shortest(r))).collect()
    }

    fn tolerance_of(&self, shape: Stretched) -> Tolerance {
        self.tolerance.before(shape.stretch)
    }

    fn region(&self, shape: Stretched, what: &'static str) -> Result<Region, ScadError> {
        self.realized.region(shape).ok_or(ScadError::Unrealized { shape: shape.id, what })
    }

    fn mesh(&self, shape: Stretched, what: &'static str) -> Result<String, ScadError> {
        let unmade = ScadError::Unrealized { shape: shape.id, what };
        Ok(points::mesh(&self.realized.mesh(shape).ok_or(unmade)?))
    }

    fn extrusion(
        &self,
        shape: Stretched,
        profile: ShapeId,
        height: f64,
        twist: f64,
        scale: DVec2,
    ) -> Result<String, ScadError> {
        let mut words = format!("linear_extrude(height = {}", Shortest(height));
        if twist != 0.0 || scale.x != scale.y {
            let region = self.region(self.graph.part(shape, profile), "extruded profile")?;
            let slices = sides::slices(&region, twist, scale, self.tolerance_of(shape));
            words += &format!(", twist = {}, slices = {slices}", Shortest(-twist));
        }
        if scale != DVec2::ONE {
            words += &format!(", scale = {}", points::pair(scale));
        }
        Ok(words + ", convexity = 10)")
    }

    fn revolution(
        &self,
        shape: Stretched,
        profile: ShapeId,
        angle: f64,
        sides: Option<u32>,
    ) -> Result<Vec<String>, ScadError> {
        let region = self.region(self.graph.part(shape, profile), "revolved profile")?;
        let count = sides::turned(&region, angle, sides, self.tolerance_of(shape));
        if angle == 360.0 {
            // A full turn starts at -x in OpenSCAD.
            let turn = "rotate([0, 0, 180])".to_string();
            return Ok(vec![turn, format!("rotate_extrude($fn = {count}, convexity = 10)")]);
        }
        let full = sides::full_turn(count, angle);
        Ok(vec![format!(
            "rotate_extrude(angle = {}, $fn = {full}, convexity = 10)",
            Shortest(angle)
        )])
    }

    fn leaf(&self, shape: Stretched) -> Result<String, ScadError> {
        let tolerance = self.tolerance_of(shape);
        Ok(match self.graph.node(shape.id) {
            Node::Box { min, max } => cuboid(*min, *max),
            Node::Cone { r1, r2, h, sides } => {
                let sides = sides.unwrap_or_else(|| sides::circle(r1.max(*r2), tolerance));
                cone(*r1, *r2, *h, sides)
            }
            Node::Sphere { r, sides } => {
                let sides = sides.unwrap_or_else(|| sides::sphere(*r, tolerance));
                format!("sphere(r = {}, $fn = {sides});", Shortest(*r))
            }
            Node::Torus { major, minor, sides } => {
                let both = sides.map(|n| (n, n));
                torus(
                    *major,
                    *minor,
                    both.unwrap_or_else(|| sides::torus(*major, *minor, tolerance)),
                )
            }
            Node::Polyhedron { points: corners, faces } => {
                points::polyhedron(corners, faces.iter().map(|face| &**face))
            }
            Node::Rect { size } => format!("square({}, center = true);", points::pair(*size)),
            Node::Ellipse { radii, sides } => {
                let largest = radii.max_element();
                ellipse(*radii, sides.unwrap_or_else(|| sides::circle(largest, tolerance)))
            }
            Node::Polygon { points: outer, holes } => {
                points::polygon(std::iter::once(&**outer).chain(holes.iter().map(|h| &**h)))
            }
            Node::Fillet { .. } if self.graph.kind(shape.id) == Kind::Profile => {
                points::region(&self.region(shape, "fillet")?)
            }
            Node::Offset { .. } => self.mesh(shape, "offset")?,
            Node::Fillet { .. } => self.mesh(shape, "fillet")?,
            Node::Metaball { .. } => self.mesh(shape, "metaball")?,
            Node::Formula { .. } => self.mesh(shape, "field")?,
            Node::ImportSolid { .. } => self.mesh(shape, "import")?,
            Node::Thickened { .. } | Node::Filled { .. } => self.mesh(shape, "surface")?,
            Node::Text(_) => points::region(&self.region(shape, "text")?),
            Node::ImportProfile { .. } => points::region(&self.region(shape, "import")?),
            _ => NOTHING.to_string(),
        })
    }
}

fn cone(r1: f64, r2: f64, h: f64, sides: u32) -> String {
    let radii = if r1 == r2 {
        format!("r = {}", Shortest(r1))
    } else {
        format!("r1 = {}, r2 = {}", Shortest(r1), Shortest(r2))
    };
    format!("cylinder(h = {}, {radii}, $fn = {sides});", Shortest(h))
}

fn torus(major: f64, minor: f64, (around, tube): (u32, u32)) -> String {
    format!(
        "rotate([0, 0, 180]) rotate_extrude($fn = {around}, convexity = 10) \
         translate([{}, 0]) circle(r = {}, $fn = {tube});",
        Shortest(major),
        Shortest(minor)
    )
}

fn ellipse(radii: DVec2, sides: u32) -> String {
    if radii.x == radii.y {
        format!("circle(r = {}, $fn = {sides});", Shortest(radii.x))
    } else {
        format!("scale({}) circle(r = 1, $fn = {sides});", points::pair(radii))
    }
}

fn cuboid(min: DVec3, max: DVec3) -> String {
    let size = DVec3::from_array(std::array::from_fn(|i| extent(min[i], max[i])));
    let cube = format!("cube({});", points::triple(size));
    if min == DVec3::ZERO { cube } else { format!("translate({}) {cube}", points::triple(min)) }
}

/// A size that leads from `min` to `max` to the bit: OpenSCAD adds the two, and faces that meet must not
/// be a rounding apart there.
fn extent(min: f64, max: f64) -> f64 {
    let size = max - min;
    let sizes = [size, size.next_down(), size.next_up()];
    sizes.into_iter().find(|s| min + s == max).unwrap_or(size)
}

fn paint(Color { r, g, b }: Color) -> String {
    let parts = [r, g, b].map(|c| Shortest(f64::from(c) / 255.0));
    format!("color({})", points::list(parts))
}
