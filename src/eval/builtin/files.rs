//! `import`.

use std::sync::Arc;

use super::{Args, Native};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::Outcome,
        types::shown,
        value::{Symbol, Value},
    },
    shape::{
        Node,
        geometry::{Data, Imported},
        node::Heal,
    },
};

pub const TABLE: &[(&str, Native)] = &[("file.import", import)];

fn import(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let file: Arc<str> = evaluator.relative(args.caller.unit, args.text(0)?, args.span(0))?;
    let heal = match args.value(1) {
        Value::Symbol(Symbol::None) => None,
        Value::Symbol(Symbol::Winding) => Some(Heal::Winding),
        Value::Number(mm, dimension)
            if dimension.length <= 1 && dimension.angle == 0 && *mm > 0.0 =>
        {
            Some(Heal::Weld(*mm))
        }
        other => {
            let words = format!("`heal` is a length above 0 or WINDING, got {}", shown(other));
            return args.fail(1, Code::WrongKind, words);
        }
    };
    let imported = evaluator.ask(args.span(0), |host, _| host.import(&file))?;
    match (imported, heal) {
        (Imported::Solid, heal) => {
            Ok(Value::Solid(evaluator.add_node(Node::ImportSolid { file, heal }, args.call)))
        }
        (_, Some(_)) => args.fail(1, Code::BadCall, "`heal` is for meshes; this file holds none"),
        (Imported::Profile, None) => {
            Ok(Value::Profile(evaluator.add_node(Node::ImportProfile { file }, args.call)))
        }
        (Imported::Data(data), None) => Ok(data_value(&data)),
    }
}

/// A value from a JSON or CSV file; `null` is `NONE`.
pub fn data_value(data: &Data) -> Value {
    match data {
        Data::Null => Value::NONE,
        Data::Bool(value) => Value::Bool(*value),
        Data::Number(value) => Value::bare(*value),
        Data::Text(text) => Value::text(&**text),
        Data::List(items) => Value::list(
            items.iter().map(|item| crate::eval::stack::deep(|| data_value(item))).collect(),
        ),
        Data::Record(fields) => {
            let value = |data| crate::eval::stack::deep(|| data_value(data));
            Value::record(fields.iter().map(|(key, data)| (key.clone(), value(data))).collect())
        }
    }
}
