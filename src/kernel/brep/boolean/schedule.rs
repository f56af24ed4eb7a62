//! In which stages an operation is evaluated.
//!
//! One arrangement of all leaves is best where few of them overlap: plates with holes, lattices of
//! bars. In a crowd, where many leaves overlap in one place, most of what an arrangement of all
//! would cut is hidden in others; there, parts of the operation are evaluated on their own first,
//! so that what they hide is gone. Only boxes are looked at.

use super::{
    expression::Expression,
    frame::deeper,
    hierarchy::{Bounds, Hierarchy, widest},
};

/// What a stage takes up.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Operand {
    /// A leaf.
    Leaf(u32),
    /// What a stage before it left.
    Stage(u32),
}

/// A part of the operation: an expression over operands.
#[derive(Debug)]
pub(super) struct Stage {
    /// What is taken up, in the order of their numbers in the expression.
    pub operands: Vec<Operand>,
    /// What is made of them.
    pub expression: Expression,
}

/// The stages of an operation, each after those it takes up; the last one is the whole.
pub(super) fn stages(expression: &Expression, boxes: &[Bounds]) -> Vec<Stage> {
    let mut schedule = Schedule { boxes, done: vec![] };
    let whole = schedule.part(expression);
    schedule.done.push(whole.stage());
    schedule.done
}

/// Largest number of pairs of operands in one stage that overlap each other and a third one: three
/// solids that all overlap are the most for which one arrangement pays.
const CROWD: usize = 1;

struct Schedule<'a> {
    boxes: &'a [Bounds],
    done: Vec<Stage>,
}

/// An expression that is not yet evaluated.
struct Open {
    operands: Vec<(Operand, Bounds)>,
    expression: Expression,
    /// Where the result can be.
    bounds: Bounds,
    /// Operands looked at so far, again and again.
    looked: usize,
}

/// How often operands are looked at before they are evaluated, so that a long row of steps costs no
/// more than in proportion to its length.
const PATIENCE: usize = 40;

impl Open {
    fn one(operand: Operand, bounds: Bounds) -> Open {
        let (operands, expression) = (vec![(operand, bounds)], Expression::Leaf(0));
        Open { operands, expression, bounds, looked: 1 }
    }

    fn nothing() -> Open {
        let (operands, expression) = (vec![], Expression::Union(vec![]));
        Open { operands, expression, bounds: Bounds::EMPTY, looked: 0 }
    }

    fn stage(self) -> Stage {
        let operands = self.operands.into_iter().map(|o| o.0).collect();
        Stage { operands, expression: self.expression }
    }

    fn with(mut self, rule: Rule, other: Open) -> Open {
        let shift = self.operands.len() as u32;
        let parts = vec![self.expression, other.expression.shifted(shift)];
        self.expression = match rule {
            Rule::Union => Expression::Union(parts),
            Rule::Intersection => Expression::Intersection(parts),
            Rule::Difference => Expression::Difference(parts),
        };
        self.bounds = match rule {
            Rule::Union => self.bounds.with(other.bounds),
            Rule::Intersection => self.bounds.common(other.bounds),
            Rule::Difference => self.bounds,
        };
        self.looked += other.looked + self.operands.len() + other.operands.len();
        self.operands.extend(other.operands);
        self
    }
}

/// How two parts go together.
#[derive(Clone, Copy)]
enum Rule {
    Union,
    Intersection,
    Difference,
}

impl Schedule<'_> {
    fn part(&mut self, expression: &Expression) -> Open {
        deeper(|| match expression {
            Expression::Leaf(leaf) => Open::one(Operand::Leaf(*leaf), self.boxes[*leaf as usize]),
            Expression::Union(parts) => self.all(Rule::Union, parts),
            Expression::Intersection(parts) => self.all(Rule::Intersection, parts),
            Expression::Difference(parts) => match parts.split_first() {
                None => Open::nothing(),
                Some((first, rest)) => {
                    let first = self.part(first);
                    if rest.is_empty() {
                        return first;
                    }
                    let rest = self.all(Rule::Union, rest);
                    self.join(Rule::Difference, first, rest)
                }
            },
        })
    }

    /// Parts of which any or all count, joined where they are near to each other first.
    fn all(&mut self, rule: Rule, parts: &[Expression]) -> Open {
        let open = parts.iter().map(|part| self.part(part)).collect();
        self.halves(rule, open)
    }

    fn halves(&mut self, rule: Rule, mut parts: Vec<Open>) -> Open {
        if parts.len() < 2 {
            return parts.pop().unwrap_or_else(Open::nothing);
        }
        let axis = widest(parts.iter().map(|part| part.bounds));
        parts.sort_by_key(|part| part.bounds.middle(axis));
        let upper = parts.split_off(parts.len() / 2);
        let lower = self.halves(rule, parts);
        let upper = self.halves(rule, upper);
        self.join(rule, lower, upper)
    }

    /// Joins two parts; what would be crowded is evaluated first.
    fn join(&mut self, rule: Rule, a: Open, b: Open) -> Open {
        let count = a.operands.len() + b.operands.len();
        let weary = a.looked + b.looked > PATIENCE * count;
        let boxes = a.operands.iter().chain(&b.operands).map(|o| o.1);
        if weary || is_crowded(boxes.collect()) {
            let (a, b) = (self.settled(a), self.settled(b));
            return a.with(rule, b);
        }
        a.with(rule, b)
    }

    /// Evaluates a part in a stage of its own.
    fn settled(&mut self, part: Open) -> Open {
        if part.operands.len() < 2 {
            return part;
        }
        let bounds = part.bounds;
        self.done.push(part.stage());
        Open::one(Operand::Stage(self.done.len() as u32 - 1), bounds)
    }
}

/// Whether so many boxes overlap in one place that one arrangement of what is in them does not pay.
fn is_crowded(boxes: Vec<Bounds>) -> bool {
    let mut near: Vec<Vec<u32>> = vec![vec![]; boxes.len()];
    Hierarchy::new(boxes.iter().copied()).own_pairs(|a, b| {
        if boxes[a as usize].overlaps(&boxes[b as usize]) {
            near[a as usize].push(b);
            near[b as usize].push(a);
        }
    });
    near.iter_mut().for_each(|list| list.sort_unstable());
    let mut triples = vec![0; near.len()];
    for (a, list) in (0u32..).zip(&near) {
        for &b in list.iter().filter(|&&b| b > a) {
            let other = &near[b as usize];
            let (short, long) =
                if list.len() < other.len() { (list, other) } else { (other, list) };
            for &c in short.iter().filter(|&c| *c > b && long.binary_search(c).is_ok()) {
                for one in [a, b, c] {
                    triples[one as usize] += 1;
                    if triples[one as usize] > CROWD {
                        return true;
                    }
                }
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: [i32; 3], size: i32) -> Bounds {
        Bounds { min: low, max: low.map(|c| c + size) }
    }

    fn leaves(count: u32) -> Vec<Expression> {
        (0..count).map(Expression::Leaf).collect()
    }

    #[test]
    fn a_plate_with_holes_is_one_stage() {
        let holes = (0..100).map(|i| cube([10 * i, 0, 0], 8));
        let boxes: Vec<Bounds> = [cube([0; 3], 1000)].into_iter().chain(holes).collect();
        let stages = stages(&Expression::Difference(leaves(101)), &boxes);
        assert_eq!(stages.len(), 1);
        assert_eq!(stages[0].operands.len(), 101);
    }

    #[test]
    fn a_crowd_takes_stages_that_use_every_leaf_once() {
        let boxes: Vec<Bounds> = (0..40).map(|i| cube([i, 2 * i % 7, 3 * i % 5], 100)).collect();
        let stages = stages(&Expression::Union(leaves(40)), &boxes);
        assert!(stages.len() > 10, "{}", stages.len());
        let mut used = [0; 40];
        let mut results = vec![0; stages.len()];
        for (number, stage) in stages.iter().enumerate() {
            for operand in &stage.operands {
                match *operand {
                    Operand::Leaf(leaf) => used[leaf as usize] += 1,
                    Operand::Stage(before) => {
                        assert!((before as usize) < number);
                        results[before as usize] += 1;
                    }
                }
            }
        }
        assert!(used.iter().all(|&count| count == 1));
        assert!(results[..stages.len() - 1].iter().all(|&count| count == 1));
    }

    #[test]
    fn a_long_row_of_steps_is_cut_into_stages() {
        let boxes: Vec<Bounds> = (0..1000).map(|i| cube([20 * i, 0, 0], 10)).collect();
        let row = (1..1000).fold(Expression::Leaf(0), |row, leaf| {
            Expression::Union(vec![row, Expression::Leaf(leaf)])
        });
        let stages = stages(&row, &boxes);
        assert!(stages.len() > 1 && stages.iter().all(|s| s.operands.len() < 200));
    }
}
