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
];
