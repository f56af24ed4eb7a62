//! Random construction trees, each from one number.

use glam::DVec2;
use katachi::{geom::Surface, kernel::brep::boolean::Tree};

use super::solids::*;

/// A generator of random numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number from 0 to n - 1.
    pub fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// A number from 0 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// How a tree is made.
pub struct Style {
    /// Coordinates on a coarse grid, so that faces touch and are coplanar.
    pub coarse: bool,
    /// Leaves turned by odd angles.
    pub turned: bool,
}

/// The style of a tree: half are coarse, a third turned.
pub fn style(seed: u64) -> Style {
    Style { coarse: seed.is_multiple_of(2), turned: seed.is_multiple_of(3) }
}

/// A random tree of at most so many levels.
pub fn tree(random: &mut Random, style: &Style, levels: u32) -> Tree {
    if levels == 0 || random.below(5) == 0 {
        return placed(random, style);
    }
    let parts = (0..2 + random.below(2)).map(|_| tree(random, style, levels - 1)).collect();
    let operation = match random.below(5) {
        0 | 1 => Tree::Union(parts),
        2 | 3 => Tree::Difference(parts),
        _ => Tree::Intersection(parts),
    };
    if random.below(4) == 0 { shifted(random, style, operation) } else { operation }
}

fn shifted(random: &mut Random, style: &Style, tree: Tree) -> Tree {
    let by = [(); 3].map(|()| coordinate(random, style, 2.0));
    moved(by, tree)
}

fn coordinate(random: &mut Random, style: &Style, reach: f64) -> f64 {
    if style.coarse { random.below(reach as u64 + 1) as f64 } else { random.unit() * reach }
}

fn placed(random: &mut Random, style: &Style) -> Tree {
    let solid = primitive(random, style);
    let by = [(); 3].map(|()| coordinate(random, style, 4.0));
    let here = moved(by, solid);
    if style.turned && random.below(2) == 0 {
        let angles = [[17.0, 23.0, 41.0], [90.0, 0.0, 0.0], [7.0, 0.0, 0.0], [33.0, 61.0, 5.0]];
        return turned(angles[random.below(4) as usize], here);
    }
    here
}

fn primitive(random: &mut Random, style: &Style) -> Tree {
    let mut size = || 1.0 + coordinate(random, style, 3.0);
    let (x, y, z) = (size(), size(), size());
    match random.below(4) {
        0 | 1 => block([0.0; 3], [x, y, z]),
        2 => {
            let shape = [(0.0, 0.0), (x, 0.0), (x, y / 2.0), (x / 2.0, y), (0.0, y)];
            let corners = 3 + random.below(3) as usize;
            let outline: Vec<DVec2> =
                shape[..corners].iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            leaf(prism(&outline, 0.0, z, Surface::Plane))
        }
        _ => {
            let sides = [4, 6, 8, 12, 17][random.below(5) as usize];
            leaf(cylinder([x / 2.0, y / 2.0], x / 2.0, 0.0, z, sides))
        }
    }
}
