//! From the edges of a polyhedron to its faces.
//!
//! # Paper
//! G. Markowsky, M. A. Wesley: Fleshing out wire frames, IBM Journal of Research and Development 24 (5), 1980. In every
//! plane that two edges span at a point the edges of that plane bound regions; regions that an edge pierces are none of
//! the solid's; of the others those are its faces that meet two and two at every edge.
//!
//! # Departures
//! The paper assembles cells of space and lists all solids of a wireframe. Here faces are chosen, by forced moves first and
//! then by a search with a limit, and one solid is given: the search begins with faces that have all points on one side,
//! so that what can lie outside does. Edges that cross without a common point are not cut there.

mod choice;
mod graph;
mod plane;
mod region;

use glam::DVec3;
use thiserror::Error;

use self::graph::Graph;
use super::triangulate::triangulate_face;

/// The most edges of a wireframe, after cutting them at points that lie on them.
pub const MOST_EDGES: usize = 4000;

/// Points nearer than this part of the size of all are one.
const SAME: f64 = 1e-7;

/// A point nearer to a plane than this part of the size of all lies in it. Larger than [`SAME`]: a plane is spanned by two
/// edges, which may be shorter than what lies in it.
const FLAT: f64 = 1e-6;

/// The faces that close a wireframe, not oriented: neighbours may run the same way along their edge.
#[derive(Clone, PartialEq, Debug)]
pub struct Wireframe {
    /// The points where edges meet, mm, in the order in which they were first met.
    pub points: Vec<DVec3>,
    /// For each face its outer loop and then its holes, as point numbers.
    pub faces: Vec<Vec<Vec<u32>>>,
}

/// Why edges do not close.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum WireframeError {
    /// Fewer edges than the smallest solid has.
    #[error("{0} edges; a solid has at least 6")]
    Few(usize),
    /// More than are taken.
    #[error("{found} edges; the limit is {limit}")]
    Many {
        /// How many there are, at least.
        found: usize,
        /// How many are taken.
        limit: usize,
    },
    /// More planes than are looked at, each for all edges.
    #[error("edges that span more than {0} planes; fewer must meet at a point")]
    Planes(usize),
    /// A coordinate that is NaN or infinite.
    #[error("edge {0} has a coordinate that is not finite")]
    NotFinite(usize),
    /// A point where an edge ends alone, or two that are not in line.
    #[error("{} at {}: {edges} {} there; a corner needs at least 3", count(*.points, "point"), place(.at), meet(*.edges))]
    Loose {
        /// Where it is.
        at: DVec3,
        /// How many edges meet there.
        edges: usize,
        /// How many such points there are.
        points: usize,
    },
    /// Edges with fewer than two possible faces.
    #[error("{} not between two faces; one is from {} to {} with {faces}", count(*.edges, "edge"), place(&.ends[0]), place(&.ends[1]))]
    Open {
        /// The ends of the first of them.
        ends: [DVec3; 2],
        /// How many faces it could bound.
        faces: usize,
        /// How many such edges there are.
        edges: usize,
    },
    /// No choice of faces has two at each edge.
    #[error("no choice of faces has two at each edge; it fails at the edge from {} to {}", place(&.0[0]), place(&.0[1]))]
    Contradiction([DVec3; 2]),
    /// The search for the faces took too long.
    #[error("more than {0} choices of faces were tried and none has two at each edge")]
    Undecided(usize),
}

fn place(p: &DVec3) -> String {
    let [x, y, z] = p.to_array().map(|c| (c * 1e6).round() / 1e6 + 0.0);
    format!("[{x}, {y}, {z}]")
}

fn count(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what} is") } else { format!("{n} {what}s are") }
}

fn meet(n: usize) -> &'static str {
    if n == 1 { "edge ends" } else { "edges end" }
}

/// The faces of the polyhedron whose edges these are, pairs of points in mm in any order. Points within 1e-7 of the size of
/// all are one; edges are cut at points that lie on them.
///
/// # Errors
/// What does not close, with its coordinates, and more than [`MOST_EDGES`].
///
/// ```
/// use glam::DVec3;
/// use katachi::geom::wireframe::faces;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3], [3, 1]];
/// let edges = pairs.map(|pair| pair.map(|i: usize| corners[i]));
/// assert_eq!(faces(&edges).unwrap().faces.len(), 4);
/// assert!(faces(&edges[1..]).is_err());
/// ```
pub fn faces(edges: &[[DVec3; 2]]) -> Result<Wireframe, WireframeError> {
    if let Some(bad) = edges.iter().position(|e| !e.iter().all(|p| p.is_finite())) {
        return Err(WireframeError::NotFinite(bad));
    }
    let graph = Graph::new(edges)?;
    graph.check()?;
    let regions = region::regions(&graph)?;
    let chosen = choice::choose(&graph, &regions)?;
    let faces = chosen.into_iter().map(|i| regions[i].loops.clone()).collect();
    Ok(Wireframe { points: graph.points, faces })
}

impl Wireframe {
    /// The faces as single loops: those with holes cut into triangles.
    pub fn rings(&self) -> Vec<Vec<u32>> {
        let mut rings = vec![];
        for face in &self.faces {
            match &face[..] {
                [ring] => rings.push(ring.clone()),
                loops => {
                    let loops: Vec<&[u32]> = loops.iter().map(Vec::as_slice).collect();
                    let mut triangles = vec![];
                    triangulate_face(&self.points, &loops, &mut triangles);
                    rings.extend(triangles.iter().map(|t| t.to_vec()));
                }
            }
        }
        rings
    }
}
