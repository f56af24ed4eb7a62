//! Edges between the same two points that belong to different pairs of triangles.
//!
//! Where four triangles meet at an edge, each pair of neighbours has an edge of its own; its ends are points of
//! their own where the pairs are not connected around them. Where they are, at both ends, the two edges would be
//! one by index. Then one of them gets a point in its middle.

use rustc_hash::FxHashMap;

use super::{Soup, following};

/// Splits edges until no two run between the same points. `crowded` are half-edges, one of each pair, where
/// that may be.
pub(super) fn split(soup: &mut Soup, twin: &mut Vec<u32>, crowded: Vec<u32>) {
    let mut known: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut open = crowded;
    while let Some(half_edge) = open.pop() {
        let back = twin[half_edge as usize];
        let half_edge = if soup.start(half_edge) < soup.end(half_edge) { half_edge } else { back };
        let ends = soup.ends(half_edge);
        match known.get(&ends) {
            Some(&other) if other != half_edge && soup.ends(other) == ends => {
                open.extend(halve(soup, twin, half_edge));
            }
            _ => {
                known.insert(ends, half_edge);
            }
        }
    }
}

/// Puts a point in the middle of an edge. Gives the half-edges that another number stands for now.
fn halve(soup: &mut Soup, twin: &mut Vec<u32>, half_edge: u32) -> [u32; 2] {
    let back = twin[half_edge as usize];
    let middle = soup.points.len() as u32;
    soup.points.push(soup.middle(half_edge));
    let first = 3 * soup.triangles.len() as u32;
    let second = first + 3;
    for (old, new) in [(half_edge, first), (back, second)] {
        let next = following(old);
        let (end, apex) = (soup.start(next), soup.end(next));
        soup.triangles[next as usize / 3][next as usize % 3] = middle;
        soup.triangles.push([middle, end, apex]);
        soup.origin.push(soup.origin[old as usize / 3]);
        twin.extend([0, twin[next as usize], next]);
        let across = twin[next as usize] as usize;
        twin[across] = new + 1;
        twin[next as usize] = new + 2;
    }
    for (a, b) in [(half_edge, second), (back, first)] {
        (twin[a as usize], twin[b as usize]) = (b, a);
    }
    [first + 1, second + 1]
}
