//! Constants that stand for themselves.

use super::Native;
use crate::eval::value::{Symbol, Value};

pub const TABLE: &[(&str, Native)] = &[
    ("constant.none", |_, _| Ok(Value::Symbol(Symbol::None))),
    ("constant.left", |_, _| Ok(Value::Symbol(Symbol::Left))),
    ("constant.center", |_, _| Ok(Value::Symbol(Symbol::Center))),
    ("constant.right", |_, _| Ok(Value::Symbol(Symbol::Right))),
    ("constant.top", |_, _| Ok(Value::Symbol(Symbol::Top))),
    ("constant.bottom", |_, _| Ok(Value::Symbol(Symbol::Bottom))),
    ("constant.baseline", |_, _| Ok(Value::Symbol(Symbol::Baseline))),
    ("constant.front", |_, _| Ok(Value::Symbol(Symbol::Front))),
    ("constant.back", |_, _| Ok(Value::Symbol(Symbol::Back))),
    ("constant.winding", |_, _| Ok(Value::Symbol(Symbol::Winding))),
    ("constant.sphere", |_, _| Ok(Value::Symbol(Symbol::Sphere))),
    ("constant.exact", |_, _| Ok(Value::Symbol(Symbol::Exact))),
    ("constant.quadtree", |_, _| Ok(Value::Symbol(Symbol::Quadtree))),
    ("constant.inverse", |_, _| Ok(Value::Symbol(Symbol::Inverse))),
    ("constant.inverse_square", |_, _| Ok(Value::Symbol(Symbol::InverseSquare))),
    ("constant.wyvill", |_, _| Ok(Value::Symbol(Symbol::Wyvill))),
    ("constant.blinn", |_, _| Ok(Value::Symbol(Symbol::Blinn))),
    ("constant.iso", |_, _| Ok(Value::Symbol(Symbol::Iso))),
    ("constant.dimetric", |_, _| Ok(Value::Symbol(Symbol::Dimetric))),
    ("constant.off", |_, _| Ok(Value::Symbol(Symbol::Off))),
    ("constant.grey", |_, _| Ok(Value::Symbol(Symbol::Grey))),
    ("constant.dashed", |_, _| Ok(Value::Symbol(Symbol::Dashed))),
    ("constant.first_angle", |_, _| Ok(Value::Symbol(Symbol::FirstAngle))),
    ("constant.third_angle", |_, _| Ok(Value::Symbol(Symbol::ThirdAngle))),
    ("constant.auto", |_, _| Ok(Value::Symbol(Symbol::Auto))),
    ("constant.count", |_, _| Ok(Value::Symbol(Symbol::Count))),
    ("constant.clip", |_, _| Ok(Value::Symbol(Symbol::Clip))),
    ("constant.a0", |_, _| Ok(Value::Symbol(Symbol::A0))),
    ("constant.a1", |_, _| Ok(Value::Symbol(Symbol::A1))),
    ("constant.a2", |_, _| Ok(Value::Symbol(Symbol::A2))),
    ("constant.a3", |_, _| Ok(Value::Symbol(Symbol::A3))),
    ("constant.a4", |_, _| Ok(Value::Symbol(Symbol::A4))),
];
