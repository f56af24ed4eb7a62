//! Facets that nothing touches, as cells.
//!
//! What a [stage](super::stage) leaves has loops that meet no point twice, so two loops of one facet may meet in a
//! point. Around it the facet is several wedges. The walks around its cell go from one side of a wedge to the other,
//! as they do in cells that were [arranged](super::arrange): which faces make one fan follows from that.

use super::{
    cells::Complex,
    facet::Facets,
    graph::Graph,
    space::{NONE, Space},
};

impl Complex {
    /// Adds a facet that nothing touches.
    pub fn add_whole(&mut self, facet: u32, facets: &mut Facets, space: &mut Space) {
        self.begin_cell(NONE, [(facet, 1)].into_iter());
        if loops_meet(facet, facets) {
            return self.add_joined(facet, facets, space);
        }
        for (corners, supports) in facets.supported_loops(facet) {
            corners.iter().zip(supports).for_each(|(&corner, &s)| self.push_half(corner, s));
            self.end_loop();
        }
    }

    /// Adds the walks around a facet whose loops meet.
    fn add_joined(&mut self, facet: u32, facets: &mut Facets, space: &mut Space) {
        facets.find_supports(facet, space);
        let (plane, turned) = facets.plane(facet, space);
        let mut graph = Graph::of(plane, space);
        for (a, b, support) in facets.supported_edges(facet) {
            graph.add_edge((a, b), support, 0, space);
        }
        graph.sort_fans(space);
        graph.link();
        graph.number_walks();
        // Where the facet faces against the plane, it is to the left of its edges run backwards.
        let is_inside = |&walk: &u32| graph.walks[walk as usize] & 1 == u32::from(turned);
        for walk in (0..graph.walks.len() as u32).filter(is_inside) {
            let mut edges = vec![];
            graph.around(walk, |half| edges.push(&graph.edges[half as usize / 2]));
            if turned {
                edges.reverse();
            }
            edges.iter().for_each(|edge| self.push_half(edge.a, edge.support));
            self.end_loop();
        }
    }
}

/// Whether loops of a facet have a point in common.
fn loops_meet(facet: u32, facets: &Facets) -> bool {
    if facets.loops(facet).nth(1).is_none() {
        return false;
    }
    let mut corners: Vec<u32> = facets.loops(facet).flatten().copied().collect();
    corners.sort_unstable();
    corners.windows(2).any(|pair| pair[0] == pair[1])
}
