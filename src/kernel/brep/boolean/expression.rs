//! Whether a place belongs to the result, kept up to date while leaves are entered and left.

/// A set operation over numbered leaves.
#[derive(Clone, Debug)]
pub(super) enum Expression {
    /// A leaf.
    Leaf(u32),
    /// In any part.
    Union(Vec<Expression>),
    /// In the first part and in no other.
    Difference(Vec<Expression>),
    /// In all parts (and there is one).
    Intersection(Vec<Expression>),
}

impl Expression {
    /// The same over leaves numbered from another start.
    pub fn shifted(self, by: u32) -> Expression {
        let all = |parts: Vec<Expression>| {
            parts.into_iter().map(|part| super::frame::deeper(|| part.shifted(by))).collect()
        };
        match self {
            Expression::Leaf(leaf) => Expression::Leaf(leaf + by),
            Expression::Union(parts) => Expression::Union(all(parts)),
            Expression::Difference(parts) => Expression::Difference(all(parts)),
            Expression::Intersection(parts) => Expression::Intersection(all(parts)),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Rule {
    Any,
    All,
    FirstOnly,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    /// The node above and whether this is its first part; the root points at itself.
    parent: u32,
    first: bool,
    rule: Rule,
    parts: u32,
    /// Parts that hold, and whether the first one does.
    holding: u32,
    first_holds: bool,
    holds: bool,
}

impl Node {
    fn evaluate(&self) -> bool {
        match self.rule {
            Rule::Any => self.holding > 0,
            Rule::All => self.parts > 0 && self.holding == self.parts,
            Rule::FirstOnly => self.first_holds && self.holding == 1,
        }
    }
}

/// The state at one place: the winding number of every leaf around it, and what follows.
pub(super) struct State {
    nodes: Vec<Node>,
    /// For every leaf the node above it and whether the leaf is its first part.
    leaves: Vec<(u32, bool)>,
    winding: Vec<i32>,
}

impl State {
    /// The state outside all leaves.
    pub fn new(expression: &Expression, leaves: usize) -> State {
        let mut state =
            State { nodes: vec![], leaves: vec![(0, false); leaves], winding: vec![0; leaves] };
        state.add_node(0, true, Rule::Any, 1);
        state.add(expression, 0, true);
        state
    }

    fn add_node(&mut self, parent: u32, first: bool, rule: Rule, parts: usize) -> u32 {
        let (parts, holding) = (parts as u32, 0);
        self.nodes.push(Node {
            parent,
            first,
            rule,
            parts,
            holding,
            first_holds: false,
            holds: false,
        });
        self.nodes.len() as u32 - 1
    }

    fn add(&mut self, expression: &Expression, parent: u32, first: bool) {
        let (rule, parts) = match expression {
            Expression::Leaf(leaf) => {
                self.leaves[*leaf as usize] = (parent, first);
                return;
            }
            Expression::Union(parts) => (Rule::Any, parts),
            Expression::Difference(parts) => (Rule::FirstOnly, parts),
            Expression::Intersection(parts) => (Rule::All, parts),
        };
        let node = self.add_node(parent, first, rule, parts.len());
        for (i, part) in parts.iter().enumerate() {
            super::frame::deeper(|| self.add(part, node, i == 0));
        }
    }

    /// Whether this place belongs to the result.
    pub fn inside(&self) -> bool {
        self.nodes[0].holds
    }

    /// Changes the winding number of a leaf.
    pub fn change(&mut self, leaf: u32, delta: i32) {
        let winding = &mut self.winding[leaf as usize];
        let before = *winding > 0;
        *winding += delta;
        let after = *winding > 0;
        if before != after {
            let (node, first) = self.leaves[leaf as usize];
            self.raise(node, first, after);
        }
    }

    /// Carries a change of truth upwards as far as it reaches.
    fn raise(&mut self, mut at: u32, mut first: bool, mut holds: bool) {
        loop {
            let node = &mut self.nodes[at as usize];
            if holds {
                node.holding += 1;
            } else {
                node.holding -= 1;
            }
            if first {
                node.first_holds = holds;
            }
            let value = node.evaluate();
            if value == node.holds {
                return;
            }
            node.holds = value;
            (first, holds) = (node.first, value);
            if node.parent == at {
                return;
            }
            at = node.parent;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn truth_follows_the_windings() {
        use Expression::*;
        let tree =
            Difference(vec![Union(vec![Leaf(0), Leaf(1)]), Intersection(vec![Leaf(2), Leaf(3)])]);
        let mut state = State::new(&tree, 4);
        assert!(!state.inside());
        state.change(1, 1);
        assert!(state.inside());
        state.change(2, 1);
        assert!(state.inside());
        state.change(3, 2);
        assert!(!state.inside());
        state.change(3, -1);
        assert!(!state.inside());
        state.change(3, -1);
        assert!(state.inside());
        state.change(1, -1);
        assert!(!state.inside());
    }

    #[test]
    fn empty_operations_hold_nowhere() {
        let tree = Expression::Union(vec![
            Expression::Intersection(vec![]),
            Expression::Difference(vec![]),
        ]);
        assert!(!State::new(&tree, 0).inside());
    }
}
