//! Chords of one curve, strung together.

use super::{links::NONE, model::Model};

/// A chord of a chain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Chord {
    /// The edge of the model.
    pub edge: u32,
    /// Its ends in the direction of the chain.
    pub ends: [u32; 2],
}

/// The curved edges of a model in runs, each along one curve from a point where something else begins or ends,
/// or a cusp, to the next; or once around.
pub fn chains(model: &Model) -> Vec<Vec<Chord>> {
    if model.curves.is_empty() {
        return vec![];
    }
    let beside = Beside::new(model);
    let mut used = vec![false; model.edges.len()];
    let mut chains = vec![];
    for edge in 0..model.edges.len() as u32 {
        if model.edges[edge as usize].curve != NONE && !used[edge as usize] {
            chains.push(beside.chain(model, edge, &mut used));
        }
    }
    chains
}

/// The two edges at every point where a chain goes on.
struct Beside {
    edges: Vec<[u32; 2]>,
}

impl Beside {
    fn new(model: &Model) -> Beside {
        let mut count = vec![0u8; model.at.len()];
        let mut edges = vec![[NONE; 2]; model.at.len()];
        for (number, edge) in model.edges.iter().enumerate() {
            for point in [edge.a, edge.b].map(|p| p as usize) {
                if count[point] < 2 {
                    edges[point][usize::from(count[point])] = number as u32;
                }
                count[point] = count[point].saturating_add(1);
            }
        }
        let curve = |e: u32| model.edges[e as usize].curve;
        for (point, count) in count.iter().enumerate() {
            if *count != 2 || curve(edges[point][0]) != curve(edges[point][1]) {
                edges[point] = [NONE; 2];
            }
        }
        model.cusps.iter().for_each(|&c| edges[c as usize] = [NONE; 2]);
        Beside { edges }
    }

    /// The chord that goes on from the end of another.
    fn next(&self, model: &Model, chord: Chord) -> Option<Chord> {
        let [a, b] = self.edges[chord.ends[1] as usize];
        let edge = if a == chord.edge { b } else { a };
        let found = model.edges.get(edge as usize)?;
        let end = if found.a == chord.ends[1] { found.b } else { found.a };
        Some(Chord { edge, ends: [chord.ends[1], end] })
    }

    /// The whole chain through an edge.
    fn chain(&self, model: &Model, edge: u32, used: &mut [bool]) -> Vec<Chord> {
        let found = model.edges[edge as usize];
        let start = Chord { edge, ends: [found.a, found.b] };
        let mut chain = self.walk(model, start, used);
        let back = Chord { edge, ends: [found.b, found.a] };
        let mut before = match self.next(model, back) {
            Some(next) if !used[next.edge as usize] => self.walk(model, next, used),
            _ => vec![],
        };
        if before.is_empty() {
            return chain;
        }
        before.reverse();
        before.iter_mut().for_each(|c| c.ends.reverse());
        before.append(&mut chain);
        before
    }

    /// Goes on from a chord to the end of its chain.
    fn walk(&self, model: &Model, start: Chord, used: &mut [bool]) -> Vec<Chord> {
        let mut chain = vec![];
        let mut chord = start;
        loop {
            used[chord.edge as usize] = true;
            chain.push(chord);
            match self.next(model, chord) {
                Some(next) if !used[next.edge as usize] => chord = next,
                _ => return chain,
            }
        }
    }
}
