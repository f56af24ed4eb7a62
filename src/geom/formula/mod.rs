//! Functions of space as data: what a modeller's formula computes, step by step.
//!
//! A [`Recording`] takes steps down; a [`Formula`] is the part of it that one result needs. It is evaluated at
//! points, and over boxes by interval arithmetic, derivatives included ([`Formula::over`]).

mod interval;
mod jet;

use glam::DVec3;
use rustc_hash::FxHashMap;

pub use self::{interval::Interval, jet::Jet};
use super::{Bounds, trig};

/// A function of one number. Angles are in degrees.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Unary {
    /// -x.
    Negate,
    /// |x|.
    Abs,
    /// The square root.
    Sqrt,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The tangent.
    Tan,
    /// The inverse sine.
    Asin,
    /// The inverse cosine.
    Acos,
    /// The inverse tangent.
    Atan,
    /// e^x.
    Exp,
    /// The natural logarithm.
    Ln,
    /// The largest whole number not above.
    Floor,
    /// The smallest whole number not below.
    Ceil,
    /// The nearest whole number.
    Round,
    /// -1, 0 or 1.
    Sign,
}

/// A function of two numbers. Comparisons and connectives give 1 for true and 0 for false.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Binary {
    /// a + b.
    Add,
    /// a - b.
    Subtract,
    /// a b.
    Multiply,
    /// a / b.
    Divide,
    /// What is left after division, with the sign of a.
    Remainder,
    /// What is left after division, with the sign of b.
    Modulo,
    /// a^b.
    Power,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
    /// The angle of the point (b, a), degrees.
    Atan2,
    /// a < b.
    Less,
    /// a <= b.
    LessEqual,
    /// a = b.
    Equal,
}

/// A step; operands are numbers of earlier steps.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Op {
    /// A coordinate of the point: 0, 1 or 2.
    Axis(usize),
    /// A number.
    Constant(f64),
    /// A function of a step.
    Unary(Unary, u32),
    /// A function of two steps.
    Binary(Binary, u32, u32),
    /// The second step where the first is not 0, else the third.
    Choose(u32, u32, u32),
}

impl Op {
    fn operands(self) -> Vec<u32> {
        match self {
            Op::Axis(_) | Op::Constant(_) => vec![],
            Op::Unary(_, a) => vec![a],
            Op::Binary(_, a, b) => vec![a, b],
            Op::Choose(a, b, c) => vec![a, b, c],
        }
    }

    fn renamed(self, number: impl Fn(u32) -> u32) -> Op {
        match self {
            Op::Unary(op, a) => Op::Unary(op, number(a)),
            Op::Binary(op, a, b) => Op::Binary(op, number(a), number(b)),
            Op::Choose(a, b, c) => Op::Choose(number(a), number(b), number(c)),
            leaf => leaf,
        }
    }
}

/// What tells steps apart.
type Key = (u8, u64, u64, u64);

/// Steps taken down, each once.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    ops: Vec<Op>,
    known: FxHashMap<Key, u32>,
}

impl Recording {
    /// The number of a step, which is added if it is new.
    pub fn step(&mut self, op: Op) -> u32 {
        let next = self.ops.len() as u32;
        let found = *self.known.entry(key(op)).or_insert(next);
        if found == next {
            self.ops.push(op);
        }
        found
    }

    /// The formula whose result is a step.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::formula::{Binary, Op, Recording};
    /// let mut recording = Recording::default();
    /// let [x, two] = [Op::Axis(0), Op::Constant(2.0)].map(|op| recording.step(op));
    /// let double = recording.step(Op::Binary(Binary::Multiply, x, two));
    /// assert_eq!(recording.formula(double).value(DVec3::new(3.0, 0.0, 0.0)), 6.0);
    /// ```
    pub fn formula(&self, result: u32) -> Formula {
        Formula { ops: needed(&self.ops, result) }
    }
}

/// The steps that a result needs, numbered anew.
fn needed(all: &[Op], result: u32) -> Vec<Op> {
    let mut needed = vec![false; result as usize + 1];
    needed[result as usize] = true;
    for i in (0..needed.len()).rev() {
        if needed[i] {
            all[i].operands().iter().for_each(|&o| needed[o as usize] = true);
        }
    }
    let mut number = vec![0; needed.len()];
    let mut ops = vec![];
    for i in (0..needed.len()).filter(|&i| needed[i]) {
        number[i] = ops.len() as u32;
        ops.push(all[i].renamed(|o| number[o as usize]));
    }
    ops
}

fn key(op: Op) -> Key {
    match op {
        Op::Axis(axis) => (0, axis as u64, 0, 0),
        Op::Constant(x) => (1, x.to_bits(), 0, 0),
        Op::Unary(op, a) => (2, op as u64, u64::from(a), 0),
        Op::Binary(op, a, b) => (3, op as u64, u64::from(a), u64::from(b)),
        Op::Choose(a, b, c) => (4, u64::from(a), u64::from(b), u64::from(c)),
    }
}

/// A function of a point, mm. The last step is its result.
#[derive(Clone, PartialEq, Debug)]
pub struct Formula {
    ops: Vec<Op>,
}

impl Formula {
    /// Its steps.
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// The value at a point; NaN where there is none.
    pub fn value(&self, p: DVec3) -> f64 {
        self.values(p).last().copied().unwrap_or(f64::NAN)
    }

    /// The values of all steps at a point.
    fn values(&self, p: DVec3) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let of = |i: u32| values[i as usize];
            let value = match *op {
                Op::Axis(axis) => p[axis],
                Op::Constant(x) => x,
                Op::Unary(op, a) => unary(op, of(a)),
                Op::Binary(op, a, b) => binary(op, of(a), of(b)),
                Op::Choose(a, b, c) => match of(a) {
                    x if x.is_nan() => x,
                    0.0 => of(c),
                    _ => of(b),
                },
            };
            values.push(value);
        }
        values
    }

    /// What values and derivatives lie between over a box.
    pub fn over(&self, cell: &Bounds) -> Jet {
        self.jets(cell).last().copied().unwrap_or(Jet::constant(f64::NAN))
    }

    /// What derivatives lie between over a box, apart for each of the functions that it is the smallest or the
    /// largest of.
    pub fn slopes(&self, cell: &Bounds) -> Vec<[Interval; 3]> {
        let jets = self.jets(cell);
        let fixed = |i: u32| jets[i as usize].slope == [Interval::ZERO; 3];
        let (mut open, mut found) = (vec![self.ops.len() as u32 - 1], vec![]);
        while let Some(i) = open.pop() {
            let [x, y] = match self.ops[i as usize] {
                Op::Binary(_, a, b) => [a, b].map(|i| jets[i as usize].value),
                _ => [Interval::ALL; 2],
            };
            match self.ops[i as usize] {
                Op::Binary(Binary::Min | Binary::Max, a, b)
                    if x.low <= y.high && y.low <= x.high =>
                {
                    open.extend([a, b]);
                }
                Op::Binary(Binary::Min, a, b) => open.push(if x.low < y.low { a } else { b }),
                Op::Binary(Binary::Max, a, b) => open.push(if x.low > y.low { a } else { b }),
                Op::Binary(Binary::Add | Binary::Subtract, a, b) if fixed(b) => open.push(a),
                Op::Binary(Binary::Add, a, b) if fixed(a) => open.push(b),
                _ => found.push(jets[i as usize].slope),
            }
        }
        found
    }

    /// The formula without the branches that are not taken in a box; `None` if all may be.
    ///
    /// ```
    /// use glam::DVec3;
    /// use katachi::geom::{Bounds, formula::{Binary, Op, Recording}};
    /// let mut recording = Recording::default();
    /// let [x, y] = [0, 1].map(|axis| recording.step(Op::Axis(axis)));
    /// let least = recording.step(Op::Binary(Binary::Min, x, y));
    /// let left = Bounds { min: DVec3::new(0.0, 2.0, 0.0), max: DVec3::new(1.0, 3.0, 1.0) };
    /// assert_eq!(recording.formula(least).within(&left).unwrap().ops(), [Op::Axis(0)]);
    /// ```
    pub fn within(&self, cell: &Bounds) -> Option<Formula> {
        let branches = |op: &Op| {
            matches!(
                op,
                Op::Binary(Binary::Min | Binary::Max, ..)
                    | Op::Choose(..)
                    | Op::Unary(Unary::Abs, _)
            )
        };
        if !self.ops.iter().any(branches) {
            return None;
        }
        let jets = self.jets(cell);
        let value = |i: u32| jets[i as usize].value;
        let mut taken: Vec<u32> = (0..self.ops.len() as u32).collect();
        for (i, op) in self.ops.iter().enumerate() {
            let branch = match *op {
                Op::Binary(Binary::Min, a, b) if value(a).high < value(b).low => a,
                Op::Binary(Binary::Min, a, b) if value(b).high < value(a).low => b,
                Op::Binary(Binary::Max, a, b) if value(a).low > value(b).high => a,
                Op::Binary(Binary::Max, a, b) if value(b).low > value(a).high => b,
                Op::Choose(a, _, c) if value(a) == Interval::ZERO => c,
                Op::Choose(a, b, _) if !value(a).contains(0.0) => b,
                Op::Unary(Unary::Abs, a) if value(a).low > 0.0 => a,
                _ => continue,
            };
            taken[i] = taken[branch as usize];
        }
        let fewer = taken.iter().zip(0..).any(|(t, i)| *t != i);
        let renamed = self.ops.iter().map(|op| op.renamed(|i| taken[i as usize]));
        let result = *taken.last()?;
        fewer.then(|| Formula { ops: needed(&renamed.collect::<Vec<Op>>(), result) })
    }

    /// Values and derivatives of all steps over a box.
    fn jets(&self, cell: &Bounds) -> Vec<Jet> {
        let half = (cell.max - cell.min) / 2.0;
        let middle = if half == DVec3::ZERO { vec![] } else { self.values(cell.center()) };
        let mut jets: Vec<Jet> = Vec::with_capacity(self.ops.len());
        for (i, op) in self.ops.iter().enumerate() {
            let of = |i: u32| &jets[i as usize];
            let jet = match *op {
                Op::Axis(axis) => Jet::axis(axis, Interval::new(cell.min[axis], cell.max[axis])),
                Op::Constant(x) => Jet::constant(x),
                Op::Unary(op, a) => jet::unary(op, of(a)),
                Op::Binary(op, a, b) => jet::binary(op, of(a), of(b)),
                Op::Choose(a, b, c) => jet::choose(of(a), of(b), of(c)),
            };
            jets.push(middle.get(i).map_or(jet, |&value| jet.around(value, half)));
        }
        jets
    }
}

/// A function of one number.
fn unary(op: Unary, x: f64) -> f64 {
    match op {
        Unary::Negate => -x,
        Unary::Abs => x.abs(),
        Unary::Sqrt => x.sqrt(),
        Unary::Sin => trig::sin_deg(x),
        Unary::Cos => trig::cos_deg(x),
        Unary::Tan => trig::tan_deg(x),
        Unary::Asin => trig::asin_deg(x),
        Unary::Acos => trig::acos_deg(x),
        Unary::Atan => trig::atan_deg(x),
        Unary::Exp => libm::exp(x),
        Unary::Ln if x < 0.0 => f64::NAN,
        Unary::Ln => libm::log(x),
        Unary::Floor => x.floor(),
        Unary::Ceil => x.ceil(),
        Unary::Round => x.round(),
        Unary::Sign if x == 0.0 => 0.0,
        Unary::Sign => x.signum(),
    }
}

/// A function of two numbers.
fn binary(op: Binary, a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        return f64::NAN;
    }
    let truth = |t: bool| f64::from(u8::from(t));
    match op {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Remainder => a % b,
        Binary::Modulo => {
            let rest = a % b;
            if rest != 0.0 && (rest < 0.0) != (b < 0.0) { rest + b } else { rest }
        }
        Binary::Power => power(a, b),
        Binary::Min => a.min(b),
        Binary::Max => a.max(b),
        Binary::Atan2 => trig::atan2_deg(a, b),
        Binary::Less => truth(a < b),
        Binary::LessEqual => truth(a <= b),
        Binary::Equal => truth(a == b),
    }
}

/// a^b: by products for small whole exponents.
fn power(a: f64, b: f64) -> f64 {
    /// Exponents up to here are taken by products.
    const SMALL: f64 = 8.0;
    if b.fract() == 0.0 && (0.0..=SMALL).contains(&b) {
        return (0..b as u32).fold(1.0, |product, _| product * a);
    }
    libm::pow(a, b)
}

#[cfg(test)]
mod tests;
