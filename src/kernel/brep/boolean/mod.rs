//! Set operations on polyhedra, exactly.
//!
//! A whole tree of unions, differences and intersections is evaluated in one arrangement:
//!
//! 0. [`clusters`] divides an operation into groups of leaves that do not touch: each is evaluated
//!    on its own.
//! 1. [`frame`] moves placements out of the operation and flattens it: leaves, one expression.
//! 2. [`lattice`] chooses a decimal lattice; [`facet`] snaps the faces of all leaves to it, and
//!    [`place`] remembers where corners come from. Faces of large leaves that no other leaf touches
//!    stay out of the arrangement ([`patch`]).
//! 3. [`space`] numbers planes and points: coplanar means the same number, and so does coincident.
//! 4. [`intersect`] finds pairs of facets that meet ([`hierarchy`], [`grid`]) and the traces they
//!    leave.
//! 5. [`arrange`] (with [`graph`] and [`nesting`]) cuts everything in one plane into cells; facets
//!    that nothing touches stay whole. [`cells`] holds all cells and links them along edges.
//! 6. [`classify`] spreads winding numbers over the regions of space between cells ([`region`]), from
//!    one known region for every connected component ([`seed`]), and asks the [`expression`] on both
//!    sides.
//! 7. [`boundary`] keeps the cells whose sides differ, [`outline`] merges them into polygons and
//!    splits where solids merely touch, [`assemble`] rounds the vertices, once, and builds the mesh;
//!    [`carry`] adds the patches, and [`origins`] carries surfaces, tags and colours through.
//!
//! Where many leaves overlap in one place, most of what that would cut is hidden in others. Such an
//! operation is evaluated in several [stages](stage) ([`schedule`], [`staged`]): each is an
//! arrangement as above of what stages before it left, but cuts only what is near ([`rest`]), finds
//! out where components stand by the surfaces themselves ([`locate`]), and leaves a surface whose
//! corners are not rounded. Where stages cannot tell something, one arrangement of all does.
//!    Stages that do not wait for each other are evaluated at the same time ([`fork`]).
//!
//! Every decision is the exact sign of an integer expression (`geom::predicates` states the bit
//! budget); doubles only filter. There is no tolerance. Coplanar and touching operands are ordinary:
//! a cell lies in a plane once, however many facets cover it.
//!
//! What is approximate: corners are moved to the lattice on the way in, by at most half a step per
//! axis ([`Evaluated::snap`]; coordinates written in decimals usually not at all), and new vertices
//! are rounded on the way out. A corner that no cut touches comes out with the coordinates it had.
//! Faces that this could make cross others are tested, and put together anew where they do ([`assemble`],
//! [`flat`], [`mend`]).
//!
//! # Sources
//! Winding vectors and an integer lattice: Trettner, Nehring-Wirxel and Kobbelt, *EMBER: exact mesh
//! booleans via efficient and robust local arrangements*, 2022. Implicit points: Attene, *Indirect
//! predicates for geometric constructions*, 2020. Regions around edges: Zhou, Grinspun, Zorin and
//! Jacobson, *Mesh arrangements for solid geometry*, 2016. Seeds: Nagashima 1986.
//!
//! # Departures
//! The arrangement is made per plane over polygons, not per triangle, so that coplanar facets need
//! no case of their own and nothing is triangulated that was planar.

mod arrange;
mod assemble;
mod boundary;
mod carry;
mod cells;
mod classify;
mod clusters;
mod expression;
mod facet;
mod flat;
mod fork;
mod frame;
mod graph;
mod grid;
mod hierarchy;
mod intersect;
mod lattice;
mod locate;
mod mend;
mod nesting;
mod origins;
mod outline;
mod patch;
mod place;
mod polygon;
mod region;
mod rest;
mod rim;
mod schedule;
mod seed;
mod space;
mod stage;
mod staged;
mod union_find;
mod whole;

use std::sync::Arc;

use glam::DVec3;
use thiserror::Error;

use self::{
    assemble::Assembly,
    classify::{Links, classify},
    facet::Facets,
    frame::Plan,
    lattice::Lattice,
    patch::Patches,
    place::Places,
    region::Regions,
    seed::Surroundings,
    space::Space,
};
use super::{
    crossing::{Tangled, is_crossed},
    polyhedron::Polyhedron,
    resolution::lost,
    threads,
};
use crate::geom::{Placement, PolyMesh};

/// A construction tree of solids.
#[derive(Clone, Debug)]
pub enum Tree {
    /// A solid.
    Leaf(Arc<Polyhedron>),
    /// A tree, placed.
    Placed(Placement, Box<Tree>),
    /// What is in any part.
    Union(Vec<Tree>),
    /// What is in the first part and in no other.
    Difference(Vec<Tree>),
    /// What is in every part; of no parts, nothing.
    Intersection(Vec<Tree>),
}

impl Tree {
    /// How many leaves there are, and how many corners of leaves.
    fn size(&self) -> [usize; 2] {
        let (mut size, mut rest) = ([0; 2], vec![self]);
        while let Some(tree) = rest.pop() {
            match tree {
                Tree::Leaf(solid) => size = [size[0] + 1, size[1] + solid.mesh().points.len()],
                Tree::Placed(_, child) => rest.push(child),
                Tree::Union(list) | Tree::Difference(list) | Tree::Intersection(list) => {
                    rest.extend(list);
                }
            }
        }
        size
    }
}

/// So many leaves take longer than new threads to start, and so many corners longer than a pool to wake.
const MANY: usize = 24;
const LARGE: usize = 2000;

/// The result of a set operation.
#[derive(Clone, Debug)]
pub struct Evaluated {
    /// The solid.
    pub solid: Polyhedron,
    /// The largest distance that a corner was moved to a lattice point, mm. Corners that no cut touches
    /// do not move at all.
    pub snap: f64,
    /// The step of the lattice of the outermost operation, the largest if groups of it have lattices of
    /// their own, mm; 0 for a leaf alone.
    pub step: f64,
    /// A place in mm where the result crosses itself because features finer than the lattice, or than
    /// coordinates [where it stands](super::resolution), could not be rounded apart; `None` nearly always.
    pub crossing: Option<DVec3>,
}

/// Why a set operation has no result.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Error)]
pub enum BooleanError {
    /// A placement has moved a corner out of the range of doubles.
    #[error("a corner has coordinates that are not finite; a set operation needs finite ones")]
    NotFinite,
    /// An operand does not enclose a volume.
    #[error(
        "an operand of a set operation is not closed or contradicts itself; it needs faces that enclose a volume"
    )]
    NotClosed,
    /// More pieces than numbers.
    #[error("the operands of a set operation have more than {limit} corners together", limit = CORNERS)]
    TooLarge,
    /// A surface to be freed of its crossings that has too many.
    #[error(transparent)]
    Tangled(#[from] Tangled),
}

/// Largest number of corners of all operands together: numbers of half-edges are 32 bits wide, and
/// cutting adds some.
pub const CORNERS: usize = 1 << 28;

/// Evaluates a tree of set operations.
///
/// The result is closed and oriented by index; where solids touch in edges or points it comes apart
/// there. Faces in one plane with equal tags and colours are merged into polygons with holes. Faces
/// keep their origin. Fails only for coordinates that are not finite and for operands that are not
/// closed.
///
/// ```
/// use std::sync::Arc;
/// use glam::dvec3;
/// use katachi::kernel::brep::{boolean::{Tree, evaluate}, measure::volume, primitive::cuboid};
/// let cube = |low: f64, high: f64| {
///     let corner = |c: f64| dvec3(c, c, c);
///     Tree::Leaf(Arc::new(cuboid(corner(low), corner(high))))
/// };
/// let notched = evaluate(&Tree::Difference(vec![cube(0.0, 2.0), cube(1.0, 3.0)]))?;
/// assert_eq!(volume(&notched.solid), 7.0);
/// assert_eq!(notched.solid.mesh().triangle_count(), 24);
/// # Ok::<(), katachi::kernel::brep::boolean::BooleanError>(())
/// ```
pub fn evaluate(tree: &Tree) -> Result<Evaluated, BooleanError> {
    let work = || evaluate_at(tree, &Placement::IDENTITY);
    let [leaves, corners] = tree.size();
    match (leaves, corners) {
        (MANY.., _) => threads::crew(work),
        (_, LARGE..) => threads::pooled(work),
        _ => work(),
    }
}

/// Evaluates a tree whose result stands at `outer`.
fn evaluate_at(tree: &Tree, outer: &Placement) -> Result<Evaluated, BooleanError> {
    let (mut placement, mut inner) = (*outer, tree);
    while let Tree::Placed(outer, child) = inner {
        placement = placement.after(outer);
        inner = child;
    }
    match inner {
        Tree::Leaf(solid) => {
            let solid = solid.placed(&placement);
            let crossing = lost(&solid);
            Ok(Evaluated { solid, snap: 0.0, step: 0.0, crossing })
        }
        operation => evaluate_operation(operation, &placement),
    }
}

/// What a closed surface that crosses or covers itself encloses: the region around which it winds
/// at least once.
///
/// Parts that are turned inside out wind negatively and are dropped, overlaps are united.
pub fn self_union(solid: &Polyhedron) -> Result<Evaluated, BooleanError> {
    let tree = Tree::Union(vec![Tree::Leaf(Arc::new(solid.clone()))]);
    let plan = frame::plan(&tree, &Placement::IDENTITY)?;
    arranged(&plan, false, false)?.ok_or(BooleanError::NotClosed)
}

/// The solid as it is if its boundary does not cross itself, else what that [encloses](self_union). Fails where it
/// crosses itself at more places than are united.
pub fn untangled(solid: Polyhedron) -> Result<Polyhedron, BooleanError> {
    match is_crossed(solid.mesh())? {
        true => Ok(self_union(&solid)?.solid),
        false => Ok(solid),
    }
}

/// Evaluates a set operation whose result stands at `outer`.
fn evaluate_operation(tree: &Tree, outer: &Placement) -> Result<Evaluated, BooleanError> {
    if let Some(groups) = clusters::apart(tree, &frame::inverse(tree)) {
        return side_by_side(&groups, outer);
    }
    let mut plan = frame::plan(tree, outer)?;
    let mut found = arranged(&plan, true, true)?;
    // A leaf that crosses itself, as it came or after snapping: compare all facets with all. If what they make
    // can still not be rounded to a closed surface, leave out what is finer than a coarser lattice.
    let mut grades =
        [None].into_iter().chain(mend::GRADES.into_iter().filter(|&grades| grades > 0).map(Some));
    while let (None, Some(mending)) = (&found, grades.next()) {
        plan.mending = mending;
        found = arranged(&plan, false, false)?;
    }
    let found = found.ok_or(BooleanError::NotClosed)?;
    Ok(match (found.crossing, lost(&found.solid)) {
        (Some(_), None) => mend::mended(&plan, found),
        (crossing, lost) => Evaluated { crossing: crossing.or(lost), ..found },
    })
}

/// Evaluates trees that do not touch, each for itself.
fn side_by_side(trees: &[Tree], outer: &Placement) -> Result<Evaluated, BooleanError> {
    let parts = threads::each(trees, |tree| frame::deeper(|| evaluate_at(tree, outer)));
    let parts: Vec<Evaluated> = parts.into_iter().collect::<Result<_, _>>()?;
    let mut all = Evaluated { solid: Polyhedron::empty(), snap: 0.0, step: 0.0, crossing: None };
    let mut mesh = PolyMesh::default();
    for part in &parts {
        mesh.append(part.solid.mesh());
        (all.snap, all.step) = (all.snap.max(part.snap), all.step.max(part.step));
        all.crossing = all.crossing.or(part.crossing);
    }
    all.solid = Polyhedron::trusted(mesh);
    Ok(all)
}

/// Evaluates a plan; `None` if its leaves contradict themselves. Faces may rest in patches only in
/// leaves that are trusted not to cross themselves.
fn arranged(plan: &Plan, trusted: bool, resting: bool) -> Result<Option<Evaluated>, BooleanError> {
    let corners: usize = plan.leaves.iter().map(|l| l.solid.mesh().points.len()).sum();
    if corners > CORNERS {
        return Err(BooleanError::TooLarge);
    }
    let (min, max) = facet::extent(&plan.leaves);
    let lattice = Lattice::covering(min, max).ok_or(BooleanError::NotFinite)?;
    let lattice = plan.mending.map_or(lattice, |grades| lattice.coarsened(grades));
    let mut space = Space::default();
    let patches = Patches::of(&plan.leaves, &lattice, resting);
    let (mut facets, sources) = Facets::of(&plan.leaves, &patches, &lattice, &mut space);
    if facets.has_dropped && !patches.list.is_empty() {
        // What is left of a dropped facet may have to split an edge of a patch.
        return arranged(plan, trusted, false);
    }
    if trusted
        && let Some((solid, crossing)) =
            staged::evaluate(plan, &lattice, (&facets, &sources, &patches), &mut space)
    {
        return Ok(Some(plan.evaluated(solid, crossing, (sources.snap, lattice.step()))));
    }
    let pairs = intersect::candidates(&facets, trusted);
    let resting = patches.list.iter().map(|p| facets.of_owner(p.leaf as usize).start as u32);
    let resting: Vec<u32> = resting.collect();
    let complex = arrange::complex(&mut facets, &pairs, &resting, &mut space, trusted);
    let borders = patches.borders(&sources.list);
    let mut links = Links::of(&complex, &borders, &mut facets, &mut space);
    let surroundings = Surroundings { complex: &complex, leaves: &plan.leaves, patches: &patches };
    let seeds = surroundings.seeds(&mut links, &mut facets, &mut space);
    let regions = Regions::of_sets(&complex, &mut links.regions);
    let Some(sides) = classify(&regions, links.radial, &seeds, &plan.expression, &facets) else {
        return Ok(None);
    };
    let places = Places::new(plan, &lattice, &sources, &facets);
    let (facets, space, complex, sides) = (&facets, &space, &complex, &sides);
    let (patches, borders, places) = (&patches, &borders, &places);
    let assembly = Assembly { plan, patches, borders, places, facets, space, complex, sides };
    let Some((solid, crossing)) = assembly.solid() else { return Ok(None) };
    Ok(Some(plan.evaluated(solid, crossing, (sources.snap, lattice.step()))))
}
