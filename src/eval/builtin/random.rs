//! Numbers that look random and are the same in every run.

use super::{Args, Native, coordinates};
use crate::{
    base::{Code, Span},
    eval::{
        evaluator::Evaluator,
        failure::{Outcome, fail},
        instance::{Cell, InstanceId},
        types::Type,
        unit::Unit,
        value::Value,
    },
};

pub const TABLE: &[(&str, Native)] = &[("random.rand", rand), ("random.noise", noise)];

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input moves every bit of
/// the output.
const fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Whole numbers hash as integers, others by their bits.
fn key(x: f64) -> u64 {
    if x.fract() == 0.0 && x.abs() < 9e15 { x as i64 as u64 } else { x.to_bits() }
}

/// mix(mix(seed) xor i), its upper 53 bits as a fraction.
fn rand(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let hash = mix(mix(key(args.number(0)?)) ^ key(args.number(1)?));
    Ok(Value::bare((hash >> 11) as f64 / (1u64 << 53) as f64))
}

/// Gradient noise (Perlin 2002): 0 at whole coordinates, about -1..1 between, smooth to the second
/// derivative.
fn noise(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let seed = match args.given(1) {
        true => args.number(1)?,
        false => evaluator.seed(args.caller.instance, args.call)?,
    };
    let seed = key(seed);
    let p = match args.value(0) {
        Value::Number(x, _) => [*x, 0.0, 0.0],
        list => match coordinates(list) {
            Some(point) => point.to_array(),
            None => return args.fail(0, Code::WrongKind, "`p` needs a number or a point"),
        },
    };
    let cell = p.map(f64::floor);
    let inside = [p[0] - cell[0], p[1] - cell[1], p[2] - cell[2]];
    let fade = inside.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let mut sum = 0.0;
    for corner in 0..8 {
        let bit = |axis: usize| f64::from((corner >> axis) & 1);
        let hash = (0..3).fold(mix(seed), |h, axis| mix(h ^ key(cell[axis] + bit(axis))));
        let weight: f64 =
            (0..3).map(|a| if bit(a) == 1.0 { fade[a] } else { 1.0 - fade[a] }).product();
        sum += weight * gradient(hash, inside[0] - bit(0), inside[1] - bit(1), inside[2] - bit(2));
    }
    Ok(Value::bare(sum))
}

impl Evaluator<'_> {
    /// What `set seed = n` in the file of an instance says, else 0; evaluated once.
    pub(in crate::eval) fn seed(&mut self, id: InstanceId, at: Span) -> Outcome<f64> {
        let Some(instance) = self.instances.get_mut(id.0 as usize) else { return Ok(0.0) };
        if let Cell::Todo = instance.seed {
            instance.seed = Cell::Busy;
            let unit = instance.unit.clone();
            let found = self.evaluated_seed(id, &unit);
            self.instances[id.0 as usize].seed = match found {
                Ok(value) => Cell::Done(value),
                Err(failure) => Cell::Failed(failure),
            };
        }
        match &self.instances[id.0 as usize].seed {
            Cell::Done(Value::Number(seed, _)) => Ok(*seed),
            Cell::Failed(failure) => Err(failure.clone()),
            _ => fail(Code::Cycle, at, "the seed of this file needs itself"),
        }
    }

    fn evaluated_seed(&mut self, id: InstanceId, unit: &Unit) -> Outcome<Value> {
        let setting = unit.settings.iter().rfind(|setting| &*setting.name.text == "seed");
        let Some(setting) = setting else { return Ok(Value::bare(0.0)) };
        let value = self.eval_in(id, setting.value, setting.frame)?;
        self.typed(value, Some(&Type::Count), unit.span(setting.value))
    }
}

/// The dot product with one of the twelve directions to the middle of a cube's edges.
fn gradient(hash: u64, x: f64, y: f64, z: f64) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = match h {
        0..4 => y,
        12 | 14 => x,
        _ => z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}
