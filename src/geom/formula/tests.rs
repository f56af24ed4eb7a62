//! Values and derivatives at points lie between those over boxes around them.

use glam::DVec3;

use super::*;

const UNARY: [Unary; 15] = [
    Unary::Negate,
    Unary::Abs,
    Unary::Sqrt,
    Unary::Sin,
    Unary::Cos,
    Unary::Tan,
    Unary::Asin,
    Unary::Acos,
    Unary::Atan,
    Unary::Exp,
    Unary::Ln,
    Unary::Floor,
    Unary::Ceil,
    Unary::Round,
    Unary::Sign,
];
const BINARY: [Binary; 13] = [
    Binary::Add,
    Binary::Subtract,
    Binary::Multiply,
    Binary::Divide,
    Binary::Remainder,
    Binary::Modulo,
    Binary::Power,
    Binary::Min,
    Binary::Max,
    Binary::Atan2,
    Binary::Less,
    Binary::LessEqual,
    Binary::Equal,
];

/// Numbers in [0, 1), the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, reach: f64) -> DVec3 {
        (DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0) * reach
    }

    fn formula(&mut self) -> Formula {
        let mut recording = Recording::default();
        let mut steps: Vec<u32> = (0..3).map(|axis| recording.step(Op::Axis(axis))).collect();
        steps.push(recording.step(Op::Constant((self.next() * 6.0).round() - 2.0)));
        for _ in 0..2 + (self.next() * 5.0) as usize {
            let pick = |random: &mut Random| steps[(random.next() * steps.len() as f64) as usize];
            let (a, b, c) = (pick(self), pick(self), pick(self));
            let op = match (self.next() * 5.0) as usize {
                0 | 1 => Op::Unary(UNARY[(self.next() * 15.0) as usize], a),
                2 | 3 => Op::Binary(BINARY[(self.next() * 13.0) as usize], a, b),
                _ => Op::Choose(a, b, c),
            };
            steps.push(recording.step(op));
        }
        recording.formula(*steps.last().expect("some"))
    }
}

#[test]
fn boxes_hold_what_their_points_have() {
    let mut random = Random(5);
    for _ in 0..4000 {
        let formula = random.formula();
        let (low, size) = (random.point(3.0), random.next() * 2.0);
        let cell = Bounds { min: low, max: low + size };
        let over = formula.over(&cell);
        for _ in 0..10 {
            let p = low + DVec3::new(random.next(), random.next(), random.next()) * size;
            let value = formula.value(p);
            if !value.is_finite() {
                continue;
            }
            let slack = 1e-9 * (1.0 + value.abs());
            let held = over.value.low - slack <= value && value <= over.value.high + slack;
            assert!(held, "{formula:?} at {p}: {value}, over {cell:?} {:?}", over.value);
            let q = p + DVec3::X * ((low.x + size - p.x) * random.next());
            let rise = formula.value(q) - value;
            let allowed = over.slope[0] * Interval::new(q.x - p.x, q.x - p.x);
            let slack = 1e-9 * (1.0 + value.abs() + rise.abs());
            let held = allowed.low - slack <= rise && rise <= allowed.high + slack;
            assert!(held || !rise.is_finite(), "{formula:?} from {p} to {q}: {rise}, {allowed:?}");
        }
    }
}

#[test]
fn a_product_with_itself_is_not_negative() {
    let mut recording = Recording::default();
    let x = recording.step(Op::Axis(0));
    let square = recording.step(Op::Binary(Binary::Multiply, x, x));
    let cell = Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(2.0) };
    assert_eq!(recording.formula(square).over(&cell).value, Interval::new(0.0, 4.0));
}
