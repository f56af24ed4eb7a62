//! Where points stand: the corners they come from, the levels they keep, the lattice.

use rustc_hash::FxHashMap;

use glam::DVec3;

use super::{
    facet::Facets,
    frame::{Leaf, Plan},
    hierarchy::Bounds,
    lattice::Lattice,
    patch::Snapped,
    space::{NONE, Space},
};

/// Where the lattice points of an operation come from.
#[derive(Default)]
pub(super) struct Sources {
    /// The leaf of each point and its number there.
    pub list: Vec<(u32, u32)>,
    /// Largest movement of a corner, in mm of the operation's frame.
    pub snap: f64,
}

impl Sources {
    /// Adds the corners of a leaf that faces outside of patches have; for each of its points the
    /// number in `space`.
    pub fn add_leaf(
        &mut self,
        (number, leaf, snapped): (u32, &Leaf, &Snapped),
        lattice: &Lattice,
        space: &mut Space,
    ) -> Vec<u32> {
        let mesh = leaf.solid.mesh();
        let mut points = vec![NONE; mesh.points.len()];
        for face in mesh.faces().filter(|f| !snapped.rests(f.index())) {
            for &corner in face.loops().flatten() {
                let slot = &mut points[corner as usize];
                if *slot != NONE {
                    continue;
                }
                let local = snapped.points[corner as usize];
                let placed = leaf.local.point(mesh.points[corner as usize]);
                let moved = (lattice.place(local.map(f64::from)) - placed).length();
                self.snap = self.snap.max(moved);
                *slot = space.add_lattice_point(local.map(i64::from));
                if *slot as usize == self.list.len() {
                    self.list.push((number, corner));
                }
            }
        }
        points
    }
}

/// Where the points of an operation stand in its result.
pub(super) struct Places<'a> {
    plan: &'a Plan,
    lattice: &'a Lattice,
    sources: &'a Sources,
    /// Where the faces across an axis were before they were snapped: their new corners go there too,
    /// so that they stay exactly flat.
    levels: FxHashMap<(usize, i64), f64>,
}

impl<'a> Places<'a> {
    /// The places of points; `facets` are those of the leaves.
    pub fn new(
        plan: &'a Plan,
        lattice: &'a Lattice,
        sources: &'a Sources,
        facets: &Facets,
    ) -> Places<'a> {
        let mut levels = FxHashMap::default();
        for (number, facet) in (0u32..).zip(facets.list()) {
            let Bounds { min, max } = facet.bounds;
            for axis in (0..3).filter(|&axis| min[axis] == max[axis]) {
                let corner = facets.loops(number).next().map_or(0, |l| l[0]);
                let (leaf, source) = sources.list[corner as usize];
                let leaf = &plan.leaves[leaf as usize];
                let there = leaf.local.point(leaf.solid.mesh().points[source as usize]);
                levels.entry((axis, i64::from(min[axis]))).or_insert(there[axis]);
            }
        }
        Places { plan, lattice, sources, levels }
    }

    /// The leaf that each point is a corner of, and its number there.
    pub fn sources(&self) -> &[(u32, u32)] {
        &self.sources.list
    }

    /// Where a point stands on the lattice, however that moves a corner.
    pub fn on_lattice(&self, point: u32, space: &Space) -> DVec3 {
        self.plan.frame.point(self.lattice.place(space.near(point)))
    }

    /// Whether a point is a corner that is not at its place on the lattice.
    pub fn is_moved(&self, point: u32, space: &Space) -> bool {
        self.sources.list.get(point as usize).is_some_and(|&(leaf, corner)| {
            let leaf = &self.plan.leaves[leaf as usize];
            let there = leaf.local.point(leaf.solid.mesh().points[corner as usize]);
            there != self.lattice.place(space.near(point))
        })
    }

    /// Where a point stands in the result. A corner of a leaf stands where the leaf's placement puts
    /// it, untouched by the lattice.
    pub fn of(&self, point: u32, space: &Space) -> DVec3 {
        if let Some(&(leaf, corner)) = self.sources.list.get(point as usize) {
            let leaf = &self.plan.leaves[leaf as usize];
            return leaf.full.point(leaf.solid.mesh().points[corner as usize]);
        }
        let near = space.near(point);
        let mut place = self.lattice.place(near);
        for axis in (0..3).filter(|&axis| near[axis].fract() == 0.0) {
            if let Some(&level) = self.levels.get(&(axis, near[axis] as i64)) {
                place[axis] = level;
            }
        }
        self.plan.frame.point(place)
    }
}
