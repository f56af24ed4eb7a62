//! Construction trees from bytes, for fuzzing: every string of bytes is a tree, short strings are small trees,
//! and each tree can be written down as a model.
//!
//! libFuzzer is built by a C++ compiler. Stable Rust does, as long as no sanitizer is asked for:
//!
//! ```sh
//! cargo fuzz run -s none trees                # until something is wrong
//! cargo fuzz tmin -s none trees <artifact>    # shrink it
//! cargo run --release show <artifact>         # print it as a model for tests/regressions
//! cargo run --release try 1 100000            # random bytes from so many seeds, without coverage
//! ```

use std::{fmt, sync::Arc};

use glam::{DMat3, DVec3};
use katachi::{
    geom::Placement,
    kernel::brep::{
        boolean::{Evaluated, Tree, evaluate},
        crossing::crossings,
        measure::{area, volume},
        primitive::{cone, cuboid, sphere},
    },
};

/// A solid as a modeller writes it.
#[derive(Clone, Debug)]
pub enum Part {
    Box([f64; 3]),
    Cone { r1: f64, r2: f64, h: f64, sides: u32 },
    Sphere { r: f64, sides: u32 },
    Placed { scale: f64, degrees: [f64; 3], by: [f64; 3], part: Box<Part> },
    Union(Vec<Part>),
    Difference(Vec<Part>),
    Intersection(Vec<Part>),
}

/// Bytes, and zeros after their end.
pub struct Bytes<'a>(pub &'a [u8]);

/// Larger trees are slow and show nothing new.
const MOST_LEAVES: usize = 12;

/// Tries two trees and what they make: each has a closed result that crosses itself nowhere, and volumes add
/// up. `None` if the trees are too large.
pub fn check(data: &[u8]) -> Option<Result<(), String>> {
    let mut bytes = Bytes(data);
    let parts = [bytes.part(0), bytes.part(0)];
    let small = parts.iter().all(|part| part.leaves() <= MOST_LEAVES);
    small.then(|| laws(parts.map(|part| part.tree())))
}

fn laws([a, b]: [Tree; 2]) -> Result<(), String> {
    let both = vec![a.clone(), b.clone()];
    let [a, b] = [sound(&a)?, sound(&b)?];
    let union = sound(&Tree::Union(both.clone()))?;
    let common = sound(&Tree::Intersection(both.clone()))?;
    let less = sound(&Tree::Difference(both))?;
    let all = [&a, &b, &union, &common, &less];
    let surface = all.iter().map(|e| area(&e.solid)).sum::<f64>();
    let slack = all.iter().map(|e| 16.0 * (e.snap + e.step) * area(&e.solid)).sum::<f64>();
    let [a, b, union, common, less] = all.map(|e| volume(&e.solid));
    // Volumes are sums of tetrahedra as long as the whole is wide.
    let points = all.iter().flat_map(|e| &e.solid.mesh().points);
    let reach = points.fold(0.0, |reach: f64, p| reach.max(p.abs().max_element()));
    let slack = slack + 1e-9 * (a + b + union) + 64.0 * f64::EPSILON * reach * surface;
    if (a + b - union - common).abs() > slack {
        return Err(format!("{a} + {b} is not {union} + {common}"));
    }
    if (a - common - less).abs() > slack {
        return Err(format!("{a} is not {common} + {less}"));
    }
    Ok(())
}

fn sound(tree: &Tree) -> Result<Evaluated, String> {
    let found = evaluate(tree).map_err(|e| e.to_string())?;
    // A leaf that is too small for doubles where it stands is flat before anything is done to it.
    let is_leaf = found.step == 0.0;
    match (crossings(found.solid.mesh()).first(), found.crossing) {
        (Some(place), None) if !is_leaf => {
            Err(format!("crosses itself at {place} and does not say so"))
        }
        _ => Ok(found),
    }
}

/// How deep trees are.
const DEEPEST: u32 = 6;

impl Bytes<'_> {
    fn next(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[usize::from(self.next()) % list.len()]
    }

    /// A whole number, mostly; else one that nearly is, or an odd one.
    fn length(&mut self) -> f64 {
        let whole = f64::from(self.next() % 6);
        whole
            + self.pick(&[
                0.0,
                0.0,
                0.0,
                0.0,
                0.5,
                1e-3,
                -1e-5,
                1e-6,
                -1e-7,
                1e-8,
                1e-9,
                0.1,
                1.0 / 3.0,
            ])
    }

    fn size(&mut self) -> f64 {
        self.length().max(0.0) + 1.0
    }

    fn vector(&mut self) -> [f64; 3] {
        [(); 3].map(|()| self.length())
    }

    /// A tree.
    pub fn part(&mut self, depth: u32) -> Part {
        match self.next() % 12 {
            0 | 1 => Part::Box([(); 3].map(|()| self.size())),
            2 => Part::Sphere { r: self.size(), sides: self.pick(&[4, 6, 7, 12]) },
            3 => {
                let (r1, r2, h) = (self.size(), self.pick(&[1.0, 0.0, 0.5]), self.size());
                Part::Cone { r1, r2: r1 * r2, h, sides: self.pick(&[3, 4, 6, 9, 16]) }
            }
            _ if depth == DEEPEST => Part::Box([1.0; 3]),
            4..7 => self.placed(depth),
            7 | 8 => Part::Union(self.parts(depth)),
            9 | 10 => Part::Difference(self.parts(depth)),
            _ => Part::Intersection(self.parts(depth)),
        }
    }

    fn parts(&mut self, depth: u32) -> Vec<Part> {
        let count = 2 + usize::from(self.next() % 3);
        (0..count).map(|_| self.part(depth + 1)).collect()
    }

    fn placed(&mut self, depth: u32) -> Part {
        let turns = [0.0, 0.0, 0.0, 90.0, 45.0, 17.0, 23.0, 180.0, 1e-6];
        let degrees =
            if self.next() % 2 == 0 { [0.0; 3] } else { [(); 3].map(|()| self.pick(&turns)) };
        let scale = self.pick(&[1.0, 1.0, 1.0, 1.0, 1.0, 1e-3, 1e-6, 1e3, -1.0]);
        let far = self.pick(&[1.0, 1.0, 1.0, -1.0, 1e3, 1e5]);
        let by = self.vector().map(|c| c * far);
        Part::Placed { scale, degrees, by, part: Box::new(self.part(depth + 1)) }
    }
}

impl Part {
    /// The same as the kernel takes it.
    pub fn tree(&self) -> Tree {
        let all = |parts: &[Part]| parts.iter().map(Part::tree).collect();
        let leaf = |solid| Tree::Leaf(Arc::new(solid));
        match self {
            Part::Box(size) => leaf(cuboid(DVec3::ZERO, DVec3::from_array(*size))),
            &Part::Cone { r1, r2, h, sides } => leaf(cone(r1, r2, h, sides)),
            &Part::Sphere { r, sides } => leaf(sphere(r, sides)),
            Part::Placed { scale, degrees, by, part } => {
                let linear = rotation(*degrees) * DMat3::from_diagonal(DVec3::splat(*scale));
                let placement = Placement::new(linear, DVec3::from_array(*by));
                Tree::Placed(placement, Box::new(part.tree()))
            }
            Part::Union(parts) => Tree::Union(all(parts)),
            Part::Difference(parts) => Tree::Difference(all(parts)),
            Part::Intersection(parts) => Tree::Intersection(all(parts)),
        }
    }

    /// The number of solids in it.
    pub fn leaves(&self) -> usize {
        match self {
            Part::Placed { part, .. } => part.leaves(),
            Part::Union(parts) | Part::Difference(parts) | Part::Intersection(parts) => {
                parts.iter().map(Part::leaves).sum()
            }
            _ => 1,
        }
    }
}

/// About x, then y, then z.
fn rotation(degrees: [f64; 3]) -> DMat3 {
    let about = |axis: usize, degrees: f64| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (s, c) = match degrees {
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            _ => (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians())),
        };
        let mut m = DMat3::IDENTITY;
        (m.col_mut(i)[i], m.col_mut(i)[j], m.col_mut(j)[i], m.col_mut(j)[j]) = (c, s, -s, c);
        m
    };
    about(2, degrees[2]) * about(1, degrees[1]) * about(0, degrees[0])
}

impl fmt::Display for Part {
    /// As an expression of the language.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut list = |parts: &[Part], sign: &str| {
            let parts: Vec<String> = parts.iter().map(Part::to_string).collect();
            write!(f, "({})", parts.join(sign))
        };
        match self {
            Part::Union(parts) => list(parts, " + "),
            Part::Difference(parts) => list(parts, " - "),
            Part::Intersection(parts) => list(parts, " & "),
            Part::Box([x, y, z]) => write!(f, "box([0, 0, 0], [{x}, {y}, {z}])"),
            Part::Cone { r1, r2, h, sides } => write!(f, "cone({r1}, {r2}, {h}, sides = {sides})"),
            Part::Sphere { r, sides } => write!(f, "sphere({r}, sides = {sides})"),
            Part::Placed { scale, degrees: [x, y, z], by, part } => {
                write!(f, "{part}")?;
                if *scale != 1.0 {
                    write!(f, ".scale({scale})")?;
                }
                if [*x, *y, *z] != [0.0; 3] {
                    write!(f, ".rotate(x = {x}deg, y = {y}deg, z = {z}deg)")?;
                }
                write!(f, ".move({by:?})")
            }
        }
    }
}
