//! The volume of a construction tree over convex leaves, in rational numbers: slow, simple, and without
//! a line in common with the kernel.
//!
//! A convex cell that holds everything is cut by the planes of one leaf after the other; each piece is
//! inside or outside all leaves so far, and is measured or dropped as soon as that decides the tree.

use dashu::rational::RBig;
use katachi::{
    geom::Placement,
    kernel::brep::{Polyhedron, boolean::Tree},
};

type Vector = [RBig; 3];

/// The half-space of all points p with `normal` . p <= `offset`.
struct HalfSpace {
    normal: Vector,
    offset: RBig,
}

/// A convex polyhedron: its faces, counter-clockwise from outside.
#[derive(Clone)]
struct Cell(Vec<Vec<Vector>>);

/// The volume of a tree whose leaves are convex, and the area of all leaves.
pub fn volume_and_area(tree: &Tree) -> (f64, f64) {
    let mut leaves = vec![];
    let formula = formula(tree, &Placement::IDENTITY, &mut leaves);
    let reach = leaves.iter().flat_map(|l| &l.mesh().points).map(|p| p.abs().max_element());
    let around = Cell::cube(reach.fold(0.0, f64::max) + 1.0);
    let area = leaves.iter().map(super::solids::area).sum();
    let spaces: Vec<Vec<HalfSpace>> = leaves.iter().map(half_spaces).collect();
    let mut known = vec![None; leaves.len()];
    let volume = measured(around, &formula, &spaces, 0, &mut known);
    (volume.to_f64().value(), area)
}

/// A tree over the numbers of its leaves.
enum Formula {
    Leaf(usize),
    Any(Vec<Formula>),
    All(Vec<Formula>),
    FirstOnly(Vec<Formula>),
}

fn formula(tree: &Tree, at: &Placement, leaves: &mut Vec<Polyhedron>) -> Formula {
    let mut all = |parts: &[Tree]| parts.iter().map(|p| formula(p, at, leaves)).collect();
    match tree {
        Tree::Leaf(solid) => {
            leaves.push(solid.placed(at));
            Formula::Leaf(leaves.len() - 1)
        }
        Tree::Placed(inner, child) => formula(child, &at.after(inner), leaves),
        Tree::Union(parts) => Formula::Any(all(parts)),
        Tree::Difference(parts) => Formula::FirstOnly(all(parts)),
        Tree::Intersection(parts) => Formula::All(all(parts)),
    }
}

impl Formula {
    /// Whether a place belongs to the tree, as far as the leaves that are known decide it.
    fn decided(&self, known: &[Option<bool>]) -> Option<bool> {
        let any = |parts: &[Formula]| {
            let mut found = parts.iter().map(|p| p.decided(known));
            if found.clone().any(|f| f == Some(true)) {
                return Some(true);
            }
            found.all(|f| f == Some(false)).then_some(false)
        };
        match self {
            Formula::Leaf(number) => known[*number],
            Formula::Any(parts) => any(parts),
            Formula::All(parts) => {
                let mut found = parts.iter().map(|p| p.decided(known));
                if parts.is_empty() || found.clone().any(|f| f == Some(false)) {
                    return Some(false);
                }
                found.all(|f| f == Some(true)).then_some(true)
            }
            Formula::FirstOnly(parts) => {
                let Some((first, rest)) = parts.split_first() else { return Some(false) };
                match (first.decided(known), any(rest)) {
                    (Some(false), _) | (_, Some(true)) => Some(false),
                    (Some(true), Some(false)) => Some(true),
                    _ => None,
                }
            }
        }
    }
}

/// The volume of what a cell has in common with the tree, the leaves before `leaf` being known.
fn measured(
    mut cell: Cell,
    formula: &Formula,
    spaces: &[Vec<HalfSpace>],
    leaf: usize,
    known: &mut [Option<bool>],
) -> RBig {
    match formula.decided(known) {
        Some(true) => return cell.volume(),
        Some(false) => return RBig::ZERO,
        None => {}
    }
    let mut sum = RBig::ZERO;
    known[leaf] = Some(false);
    // A leaf without faces holds nothing.
    let mut is_left = !spaces[leaf].is_empty();
    if !is_left {
        sum += measured(cell.clone(), formula, spaces, leaf + 1, known);
    }
    for space in &spaces[leaf] {
        let (inside, outside) = cell.split(space);
        if let Some(outside) = outside {
            sum += measured(outside, formula, spaces, leaf + 1, known);
        }
        let Some(inside) = inside else {
            is_left = false;
            break;
        };
        cell = inside;
    }
    if is_left {
        known[leaf] = Some(true);
        sum += measured(cell, formula, spaces, leaf + 1, known);
    }
    known[leaf] = None;
    sum
}

fn half_spaces(solid: &Polyhedron) -> Vec<HalfSpace> {
    let mesh = solid.mesh();
    let exact = |c: &u32| mesh.points[*c as usize].to_array().map(rational);
    let of = |corners: &[u32]| {
        let points: Vec<Vector> = corners.iter().map(exact).collect();
        let normals =
            points.windows(2).map(|w| cross(&minus(&w[0], &points[0]), &minus(&w[1], &points[0])));
        let normal = normals.into_iter().find(|n| n.iter().any(|c| *c != RBig::ZERO))?;
        let offset = dot(&normal, &points[0]);
        Some(HalfSpace { normal, offset })
    };
    mesh.faces().filter_map(|f| of(f.outer())).collect()
}

fn rational(x: f64) -> RBig {
    RBig::try_from(x).expect("finite")
}

impl Cell {
    /// The cube about the origin.
    fn cube(reach: f64) -> Cell {
        let solid = super::solids::cuboid([-reach; 3], [reach; 3]);
        let mesh = solid.mesh();
        let exact = |c: &u32| mesh.points[*c as usize].to_array().map(rational);
        Cell(mesh.faces().map(|f| f.outer().iter().map(exact).collect()).collect())
    }

    /// What lies in a half-space and what lies beyond, where there is any.
    fn split(&self, space: &HalfSpace) -> (Option<Cell>, Option<Cell>) {
        let height = |p: &Vector| dot(&space.normal, p) - &space.offset;
        let heights: Vec<Vec<RBig>> =
            self.0.iter().map(|f| f.iter().map(height).collect()).collect();
        let mut all = heights.iter().flatten();
        if all.clone().all(|h| *h <= RBig::ZERO) {
            return (Some(self.clone()), None);
        }
        if all.all(|h| *h >= RBig::ZERO) {
            return (None, Some(self.clone()));
        }
        let lower: Vec<_> = heights.iter().map(|f| f.iter().map(|h| -h).collect()).collect();
        (Some(self.part(&lower)), Some(self.part(&heights)))
    }

    /// The part where the heights are not negative, closed by the cut face.
    fn part(&self, heights: &[Vec<RBig>]) -> Cell {
        let (mut faces, mut rim) = (vec![], vec![]);
        for (face, heights) in self.0.iter().zip(heights) {
            let (kept, edge) = clipped(face, heights);
            if kept.len() > 2 {
                faces.push(kept);
            }
            rim.extend(edge);
        }
        faces.push(chained(rim));
        Cell(faces)
    }

    /// By the divergence theorem.
    fn volume(&self) -> RBig {
        let base = &self.0[0][0];
        let mut sum = RBig::ZERO;
        for face in &self.0 {
            let corner: Vec<Vector> = face.iter().map(|p| minus(p, base)).collect();
            for pair in corner[1..].windows(2) {
                sum += dot(&corner[0], &cross(&pair[0], &pair[1]));
            }
        }
        sum / RBig::from(6)
    }
}

/// The part of a face where the heights are not negative, and the edge of the cut that borders on it.
fn clipped(face: &[Vector], heights: &[RBig]) -> (Vec<Vector>, Option<(Vector, Vector)>) {
    let is_low = |i: usize| heights[i] < RBig::ZERO;
    let (mut kept, mut enter, mut leave) = (vec![], None, None);
    for i in 0..face.len() {
        let j = (i + 1) % face.len();
        if !is_low(i) {
            kept.push(face[i].clone());
        }
        if is_low(i) != is_low(j) {
            let place = between(&face[i], &face[j], &heights[i], &heights[j]);
            *(if is_low(i) { &mut enter } else { &mut leave }) = Some(place.clone());
            kept.push(place);
        }
    }
    kept.dedup();
    if kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    (kept, enter.zip(leave))
}

/// The face that has these edges.
fn chained(mut edges: Vec<(Vector, Vector)>) -> Vec<Vector> {
    edges.retain(|(a, b)| a != b);
    let mut face = vec![];
    let Some((first, mut at)) = edges.pop() else { return face };
    face.push(first);
    while let Some(i) = edges.iter().position(|(a, _)| *a == at) {
        let (here, next) = edges.swap_remove(i);
        face.push(here);
        at = next;
    }
    face
}

/// The point of an edge at height 0, its ends being at heights h and k.
fn between(a: &Vector, b: &Vector, h: &RBig, k: &RBig) -> Vector {
    let share = h / (h - k);
    std::array::from_fn(|i| &a[i] + (&b[i] - &a[i]) * &share)
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::{super::solids::*, *};

    #[test]
    fn volumes_of_simple_trees() {
        let (a, b) = (block([0.0; 3], [2.0; 3]), block([1.0; 3], [3.0; 3]));
        let both = vec![a, b];
        assert_eq!(volume_and_area(&Tree::Union(both.clone())).0, 15.0);
        assert_eq!(volume_and_area(&Tree::Intersection(both.clone())).0, 1.0);
        let cut = Tree::Difference(vec![Tree::Difference(both.clone()), Tree::Union(both)]);
        assert_eq!(volume_and_area(&cut).0, 0.0);
    }
}
