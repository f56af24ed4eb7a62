//! Shells: connected pieces of the surface, and which way they face.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{Soup, twins};
use crate::geom::{Bounds, bvh::Bvh, parity::is_below, sum::Sum};

const NONE: u32 = u32::MAX;

/// Turns shells over so that the outermost face outwards, those directly inside them inwards (cavities),
/// the next outwards again, and so on.
pub(super) fn turn_outwards(soup: &mut Soup, twin: &mut [u32]) {
    let shell_of = label(soup, twin);
    let count = shell_of.iter().max().map_or(0, |m| *m as usize + 1);
    let mut members: Vec<Vec<u32>> = vec![vec![]; count];
    for (t, &shell) in shell_of.iter().enumerate() {
        members[shell as usize].push(t as u32);
    }
    let nesting = Nesting::new(soup, &members);
    let wrong: Vec<bool> = (0..count)
        .map(|shell| {
            let outwards = nesting.depth(shell).is_multiple_of(2);
            (volume(soup, &members[shell]) > 0.0) != outwards
        })
        .collect();
    if wrong.contains(&true) {
        let chosen = |t: usize| wrong[shell_of[t] as usize];
        soup.turn_over(chosen);
        twins::turn_over(twin, chosen);
    }
}

/// The number of each triangle's shell.
fn label(soup: &Soup, twin: &[u32]) -> Vec<u32> {
    let mut shell_of = vec![NONE; soup.triangles.len()];
    let mut open = vec![];
    let mut shells = 0;
    for first in 0..shell_of.len() {
        if shell_of[first] != NONE {
            continue;
        }
        shell_of[first] = shells;
        open.push(first);
        while let Some(t) = open.pop() {
            for across in twin[3 * t..3 * t + 3].iter().map(|h| *h as usize / 3) {
                if shell_of[across] == NONE {
                    shell_of[across] = shells;
                    open.push(across);
                }
            }
        }
        shells += 1;
    }
    shell_of
}

/// Six times the volume that a shell encloses.
fn volume(soup: &Soup, members: &[u32]) -> f64 {
    let base = soup.corners(members[0] as usize)[0];
    let cone = |&t: &u32| {
        let [a, b, c] = soup.corners(t as usize).map(|p| p - base);
        a.dot(b.cross(c))
    };
    members.iter().map(cone).collect::<Sum>().value()
}

/// Which shells lie inside which.
struct Nesting<'a> {
    soup: &'a Soup,
    members: &'a [Vec<u32>],
    boxes: Vec<Bounds>,
    by_box: Bvh,
    /// Triangles of the shells that may hold others.
    trees: BTreeMap<u32, Bvh>,
}

impl<'a> Nesting<'a> {
    fn new(soup: &'a Soup, members: &'a [Vec<u32>]) -> Nesting<'a> {
        let around = |t: &u32| Bounds::of(soup.corners(*t as usize));
        let bounds = |m: &Vec<u32>| m.iter().fold(Bounds::EMPTY, |b, t| b.joined(&around(t)));
        let boxes: Vec<Bounds> = members.iter().map(bounds).collect();
        let by_box = Bvh::new(&boxes);
        let mut nesting = Nesting { soup, members, boxes, by_box, trees: BTreeMap::new() };
        let holders: Vec<u32> = (0..members.len()).flat_map(|s| nesting.candidates(s)).collect();
        for shell in holders {
            nesting.trees.entry(shell).or_insert_with(|| {
                Bvh::new(&members[shell as usize].iter().map(around).collect::<Vec<_>>())
            });
        }
        nesting
    }

    /// The other shells whose box holds the box of this one.
    fn candidates(&self, shell: usize) -> Vec<u32> {
        let own = self.boxes[shell];
        let mut found = self.by_box.overlapping(&Bounds::of([own.min]));
        found.retain(|&s| s as usize != shell && self.boxes[s as usize].contains(own.max));
        // One shell given twice lies on itself, not inside.
        found.retain(|&s| {
            self.boxes[s as usize] != own || self.places(s as usize) != self.places(shell)
        });
        found
    }

    /// The corners of a shell's triangles, in an order of their own.
    fn places(&self, shell: usize) -> Vec<[u64; 3]> {
        let corners = self.members[shell].iter().flat_map(|&t| self.soup.corners(t as usize));
        let mut places: Vec<_> = corners.map(|p| p.to_array().map(f64::to_bits)).collect();
        places.sort_unstable();
        places
    }

    /// In how many other shells a shell lies.
    fn depth(&self, shell: usize) -> usize {
        let [a, b, c] = self.soup.corners(self.members[shell][0] as usize);
        let p = (a + b + c) / 3.0;
        self.candidates(shell).into_iter().filter(|&s| self.holds(s, p)).count()
    }

    /// Parity of the triangles of a shell straight above a point, by exact signs.
    fn holds(&self, shell: u32, p: DVec3) -> bool {
        let column = Bounds { min: p, max: p.with_z(f64::INFINITY) };
        let mut odd = false;
        self.trees[&shell].visit(&column, |k| {
            let t = self.members[shell as usize][k as usize];
            odd ^= is_below(p, self.soup.corners(t as usize));
        });
        odd
    }
}
