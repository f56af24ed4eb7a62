//! Numbering equal corners: a hash table made for millions of them.

/// Triangles over points, equal points given one number in order of first use.
pub(super) struct Corners {
    points: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Open addressing with linear steps: the number of a point plus 1, 0 for a free slot. At most half full.
    slots: Vec<u32>,
}

impl Corners {
    /// Room for a closed mesh of so many triangles, which has about half as many points.
    pub fn with_triangles(count: usize) -> Corners {
        let slots = (count + 16).next_power_of_two();
        let points = Vec::with_capacity(count / 2 + 16);
        Corners { points, triangles: Vec::with_capacity(count), slots: vec![0; slots] }
    }

    /// The number of a point; -0 and 0 are equal.
    pub fn number(&mut self, point: [f32; 3]) -> u32 {
        let point = point.map(|c| c + 0.0);
        let mask = self.slots.len() - 1;
        let mut slot = hash(point) as usize & mask;
        loop {
            match self.slots[slot] {
                0 => break,
                taken if self.points[taken as usize - 1] == point => return taken - 1,
                _ => slot = (slot + 1) & mask,
            }
        }
        self.points.push(point);
        self.slots[slot] = self.points.len() as u32;
        if 2 * self.points.len() > self.slots.len() {
            self.grow();
        }
        self.points.len() as u32 - 1
    }

    fn grow(&mut self) {
        let mask = 2 * self.slots.len() - 1;
        self.slots = vec![0; mask + 1];
        for (number, point) in self.points.iter().enumerate() {
            let mut slot = hash(*point) as usize & mask;
            while self.slots[slot] != 0 {
                slot = (slot + 1) & mask;
            }
            self.slots[slot] = number as u32 + 1;
        }
    }

    /// Adds a triangle, unless two of its corners are one.
    pub fn triangle(&mut self, [a, b, c]: [u32; 3]) {
        if a != b && b != c && c != a {
            self.triangles.push([a, b, c]);
        }
    }

    /// The number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The points and the triangles.
    pub fn into_parts(self) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        (self.points, self.triangles)
    }
}

/// Multiplies and folds the 96 bits; the multipliers are those of Steele and Vigna's table of
/// good ones for multiplicative generators (2021).
fn hash([x, y, z]: [f32; 3]) -> u64 {
    let low = u64::from(x.to_bits()) | u64::from(y.to_bits()) << 32;
    let mixed = low.wrapping_mul(0xd134_2543_de82_ef95) ^ u64::from(z.to_bits());
    let product = u128::from(mixed).wrapping_mul(0xaf25_1af3_b0f0_25b5_u128);
    (product >> 64) as u64 ^ product as u64
}
