//! Which regions are faces: two at each edge.

use super::{WireframeError, graph::Graph, region::Region};

/// The most choices that are tried.
const MOST_CHOICES: usize = 20_000;

/// The regions, by number, of which two meet at each edge.
pub fn choose(graph: &Graph, regions: &[Region]) -> Result<Vec<usize>, WireframeError> {
    let mut search = Search::new(graph, regions);
    search.check_open(graph)?;
    let contradiction = |edge| WireframeError::Contradiction(graph.ends(edge));
    search.settle((0..graph.edges.len() as u32).collect()).map_err(contradiction)?;
    let mut order: Vec<usize> = (0..regions.len()).collect();
    let rank = |i: &usize| (!regions[*i].outside, -regions[*i].area);
    order.sort_by(|i, j| {
        let (a, b) = (rank(i), rank(j));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(i.cmp(j))
    });
    search.complete(&order).map_err(|stuck| match stuck {
        Some(edge) => contradiction(edge),
        None => WireframeError::Undecided(MOST_CHOICES),
    })?;
    Ok((0..regions.len()).filter(|&i| search.state[i] == Some(true)).collect())
}

struct Search<'a> {
    regions: &'a [Region],
    /// For each edge the regions that it bounds.
    at: Vec<Vec<usize>>,
    /// Whether each region is a face, where that is known.
    state: Vec<Option<bool>>,
    /// For each edge how many faces it has, and how many more it may have.
    faces: Vec<usize>,
    open: Vec<usize>,
    /// Regions in the order in which they were settled.
    trail: Vec<usize>,
}

impl<'a> Search<'a> {
    fn new(graph: &Graph, regions: &'a [Region]) -> Search<'a> {
        let mut at = vec![vec![]; graph.edges.len()];
        for (number, region) in regions.iter().enumerate() {
            region.edges.iter().for_each(|&edge| at[edge as usize].push(number));
        }
        let open = at.iter().map(Vec::len).collect();
        let (state, faces) = (vec![None; regions.len()], vec![0; at.len()]);
        Search { regions, at, state, faces, open, trail: vec![] }
    }

    /// Fails where an edge has fewer than two regions.
    fn check_open(&self, graph: &Graph) -> Result<(), WireframeError> {
        let open: Vec<usize> = (0..self.at.len()).filter(|&e| self.open[e] < 2).collect();
        let Some(&first) = open.first() else { return Ok(()) };
        let ends = graph.ends(first as u32);
        Err(WireframeError::Open { ends, faces: self.open[first], edges: open.len() })
    }

    fn set(&mut self, region: usize, is_face: bool) {
        self.state[region] = Some(is_face);
        self.trail.push(region);
        for &edge in &self.regions[region].edges {
            self.open[edge as usize] -= 1;
            self.faces[edge as usize] += usize::from(is_face);
        }
    }

    /// Takes back what was settled after the trail had a length.
    fn undo(&mut self, length: usize) {
        for region in self.trail.split_off(length) {
            let was_face = self.state[region].take() == Some(true);
            for &edge in &self.regions[region].edges {
                self.open[edge as usize] += 1;
                self.faces[edge as usize] -= usize::from(was_face);
            }
        }
    }

    /// Settles what the edges of a list leave no choice about, and what follows from it; the edge that fails.
    fn settle(&mut self, mut pending: Vec<u32>) -> Result<(), u32> {
        while let Some(edge) = pending.pop() {
            let (faces, open) = (self.faces[edge as usize], self.open[edge as usize]);
            if faces > 2 || faces + open < 2 {
                return Err(edge);
            }
            if open == 0 || (faces < 2 && faces + open > 2) {
                continue;
            }
            let unknown = |&&r: &&usize| self.state[r].is_none();
            let regions: Vec<usize> =
                self.at[edge as usize].iter().filter(unknown).copied().collect();
            for region in regions {
                self.set(region, faces < 2);
                pending.extend(&self.regions[region].edges);
            }
        }
        Ok(())
    }

    /// Settles all regions, those of `order` first that come first; the edge that fails, none when it took too long.
    fn complete(&mut self, order: &[usize]) -> Result<(), Option<u32>> {
        // Regions chosen as faces, each with the length of the trail before.
        let mut choices: Vec<(usize, usize)> = vec![];
        for _ in 0..MOST_CHOICES {
            let Some(&region) = order.iter().find(|&&r| self.state[r].is_none()) else {
                return Ok(());
            };
            choices.push((region, self.trail.len()));
            let mut settled = self.take(region, true);
            while let Err(edge) = settled {
                let Some((region, length)) = choices.pop() else { return Err(Some(edge)) };
                self.undo(length);
                settled = self.take(region, false);
            }
        }
        Err(None)
    }

    fn take(&mut self, region: usize, is_face: bool) -> Result<(), u32> {
        self.set(region, is_face);
        self.settle(self.regions[region].edges.clone())
    }
}
