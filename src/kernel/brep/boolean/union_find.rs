//! Disjoint sets of numbers (Galler and Fischer 1964, with path halving).

/// Numbers from 0 in disjoint sets; the least member stands for its set.
#[derive(Clone)]
pub(super) struct Sets(Vec<u32>);

impl Sets {
    /// So many sets of one member.
    pub fn new(count: usize) -> Sets {
        Sets((0..count as u32).collect())
    }

    /// The least member of the set that holds a number.
    #[inline]
    pub fn find(&mut self, mut number: u32) -> u32 {
        while self.0[number as usize] != number {
            let above = self.0[number as usize];
            self.0[number as usize] = self.0[above as usize];
            number = above;
        }
        number
    }

    /// Joins the set whose least member is given with that of a number; the least member of both.
    #[inline]
    pub fn join_least(&mut self, least: u32, number: u32) -> u32 {
        if self.0[number as usize] == least {
            return least;
        }
        let other = self.find(number);
        self.0[least.max(other) as usize] = least.min(other);
        least.min(other)
    }

    /// Makes a number a set of its own; all others of its set must be parted too.
    pub fn part(&mut self, number: u32) {
        self.0[number as usize] = number;
    }

    /// Joins the sets of two numbers.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
