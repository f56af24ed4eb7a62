//! What is connected with what.

/// Numbered things in pieces; a piece is named by its smallest number.
#[derive(Clone, Debug)]
pub(super) struct Pieces(Vec<u32>);

impl Pieces {
    /// So many things, each a piece of its own.
    pub fn new(count: usize) -> Pieces {
        Pieces((0..count as u32).collect())
    }

    /// The piece of a thing.
    pub fn of(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let next = self.0[i as usize];
            self.0[i as usize] = self.0[next as usize];
            i = self.0[i as usize];
        }
        i
    }

    /// Makes the pieces of some things one.
    pub fn join<const N: usize>(&mut self, things: [u32; N]) {
        let roots = things.map(|i| self.of(i));
        let least = roots.iter().copied().min().unwrap_or(0);
        roots.iter().for_each(|root| self.0[*root as usize] = least);
    }
}
