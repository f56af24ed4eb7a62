//! Functions on lists.

use std::cmp::Ordering;

use super::{Args, Native};
use crate::{
    base::Code,
    eval::{
        evaluator::Evaluator,
        failure::{Failure, Outcome},
        interpret::arithmetic::{Operands, clash},
        types::shown,
        value::{Function, Value},
    },
    syntax::ast::BinaryOp,
};

pub const TABLE: &[(&str, Native)] = &[
    ("list.len", |_, a| Ok(Value::bare(a.value(0).count().unwrap_or(0) as f64))),
    ("list.map", map),
    ("list.filter", filter),
    ("list.fold", fold),
    ("list.sort", sort),
    ("list.reverse", reverse),
    ("list.zip", zip),
    ("list.sum", sum),
    ("list.flatten", flatten),
    ("list.range", range),
    ("list.insert", insert),
    ("list.contains", contains),
    ("list.find", find),
    ("record.keys", keys),
    ("record.values", values),
];

/// How many parameters a function takes: two mean that it wants the index too.
fn wants_index(function: &Value) -> bool {
    let Value::Function(function) = function else { return false };
    match &**function {
        Function::Closure(closure) => closure.code.positional().count() == 2,
        Function::Overloads { .. } => false,
    }
}

/// Calls a function with an element, and its index if it wants it.
fn apply(
    evaluator: &mut Evaluator,
    args: &Args,
    i: usize,
    item: Value,
    index: u64,
    wants: bool,
) -> Outcome<Value> {
    let at = args.span(i);
    match wants {
        true => evaluator.call_with(args, args.value(i), &[item, Value::bare(index as f64)], at),
        false => evaluator.call_with(args, args.value(i), &[item], at),
    }
}

fn map(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (list, wants) = (args.value(0), wants_index(args.value(1)));
    let mut items = vec![];
    for index in 0..list.count().unwrap_or(0) {
        evaluator.tick(1, args.call)?;
        let Some(item) = list.element(index) else { break };
        items.push(apply(evaluator, args, 1, item, index, wants)?);
        evaluator.room(items.len(), args.call)?;
    }
    Ok(Value::list(items))
}

fn filter(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (list, wants) = (args.value(0), wants_index(args.value(1)));
    let mut items = vec![];
    for index in 0..list.count().unwrap_or(0) {
        evaluator.tick(1, args.call)?;
        let Some(item) = list.element(index) else { break };
        match apply(evaluator, args, 1, item.clone(), index, wants)? {
            Value::Bool(true) => items.push(item),
            Value::Bool(false) => {}
            other => {
                let words = format!(
                    "`filter` needs a truth value from its function, got {}",
                    shown(&other)
                );
                return args.fail(1, Code::WrongKind, words);
            }
        }
        evaluator.room(items.len(), args.call)?;
    }
    Ok(Value::list(items))
}

fn fold(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (list, function) = (args.value(0), args.value(2));
    let mut state = args.value(1).clone();
    for index in 0..list.count().unwrap_or(0) {
        evaluator.tick(1, args.call)?;
        let Some(item) = list.element(index) else { break };
        state = evaluator.call_with(args, function, &[state, item], args.span(2))?;
    }
    Ok(state)
}

/// A stable sort by the elements, or by what `key` makes of them.
fn sort(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    evaluator.tick(items.len() as u64, args.call)?;
    evaluator.room(2 * items.len(), args.call)?;
    let mut pairs: Vec<(Value, Value)> = Vec::with_capacity(items.len());
    for item in items.iter() {
        let key = match args.given(1) {
            true => evaluator.call_with(
                args,
                args.value(1),
                std::slice::from_ref(item),
                args.span(1),
            )?,
            false => item.clone(),
        };
        pairs.push((key, item.clone()));
    }
    let mut failure = None;
    let mut steps = evaluator.steps_left();
    pairs.sort_by(|(a, _), (b, _)| {
        order(args, a, b, &mut steps).unwrap_or_else(|found| {
            failure.get_or_insert(found);
            Ordering::Equal
        })
    });
    match failure {
        Some(failure) => Err(failure),
        None => Ok(Value::list(pairs.into_iter().map(|(_, item)| item).collect())),
    }
}

/// Numbers by size, strings by their characters, lists by the first element that differs.
fn order(args: &Args, a: &Value, b: &Value, steps: &mut u64) -> Result<Ordering, Failure> {
    let at = args.span(0);
    match steps.checked_sub(1) {
        Some(left) => *steps = left,
        None => return args.fail(0, Code::Limit, "sorting takes more steps than the limit allows"),
    }
    match (a, b) {
        (Value::Number(a, x), Value::Number(b, y)) => match x.common(*y) {
            Some(_) => Ok(a.partial_cmp(b).unwrap_or(Ordering::Equal)),
            None => Err(clash(*x, *y, (at, at), "`sort`")),
        },
        (Value::Text(a), Value::Text(b)) => Ok(a.cmp(b)),
        (Value::Bool(a), Value::Bool(b)) => Ok(a.cmp(b)),
        (Value::List(a), Value::List(b)) => {
            for (a, b) in a.iter().zip(b.iter()) {
                let order = crate::eval::stack::deep(|| order(args, a, b, steps))?;
                if order.is_ne() {
                    return Ok(order);
                }
            }
            Ok(a.len().cmp(&b.len()))
        }
        _ => args.fail(
            0,
            Code::WrongKind,
            format!("cannot put {} and {} in order", a.words(), b.words()),
        ),
    }
}

fn reverse(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    evaluator.room(items.len(), args.call)?;
    Ok(Value::list(items.iter().rev().cloned().collect()))
}

/// Pairs of the elements of two lists, as many as the shorter one has.
fn zip(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let (a, b) = (args.value(0), args.value(1));
    let count = a.count().unwrap_or(0).min(b.count().unwrap_or(0));
    evaluator.tick(count, args.call)?;
    evaluator.room(4 * count as usize, args.call)?;
    let pairs = (0..count).filter_map(|i| Some(Value::list(vec![a.element(i)?, b.element(i)?])));
    Ok(Value::list(pairs.collect()))
}

/// The sum of numbers or vectors, from left to right; 0 for an empty list.
fn sum(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let list = args.value(0);
    let count = list.count().unwrap_or(0);
    let at = Operands { whole: args.call, left: args.span(0), right: args.span(0) };
    let Some(mut total) = list.element(0) else { return Ok(Value::bare(0.0)) };
    evaluator.tick(count, args.call)?;
    for i in 1..count {
        let Some(item) = list.element(i) else { break };
        total = evaluator.binary(BinaryOp::Add, total, item, at)?;
    }
    Ok(total)
}

/// All elements of lists within lists, at every level, in order.
fn flatten(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let mut flat = vec![];
    let mut pending = vec![(args.value(0).clone(), 0)];
    while let Some((list, index)) = pending.pop() {
        evaluator.tick(1, args.call)?;
        let Some(item) = list.element(index) else { continue };
        pending.push((list, index + 1));
        match item.count() {
            Some(_) => pending.push((item, 0)),
            None => flat.push(item),
        }
        evaluator.room(flat.len(), args.call)?;
    }
    Ok(Value::list(flat))
}

/// The whole numbers 0..<n.
fn range(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let n = args.number(0)?;
    let range = crate::eval::value::Range::new(0.0, n, None, 1.0, false);
    Ok(Value::Range(std::sync::Arc::new(range)))
}

fn insert(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    let items = evaluator.items(args.value(0), args.span(0))?;
    let index = args.count(1, 0)? as usize;
    if index > items.len() {
        let words = format!("`{}` is {index}; the list takes 0 to {}", args.name(1), items.len());
        return args.fail(1, Code::OutOfRange, words);
    }
    evaluator.room(items.len() + 1, args.call)?;
    let mut items = items.to_vec();
    items.insert(index, args.value(2).clone());
    Ok(Value::list(items))
}

fn position(evaluator: &mut Evaluator, args: &Args) -> Outcome<Option<u64>> {
    let (list, wanted) = (args.value(0), args.value(1));
    let count = list.count().unwrap_or(0);
    for i in 0..count {
        evaluator.tick(1, args.call)?;
        let Some(item) = list.element(i) else { break };
        if evaluator.same(&item, wanted, args.call)? {
            return Ok(Some(i));
        }
    }
    Ok(None)
}

fn contains(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    Ok(Value::Bool(position(evaluator, args)?.is_some()))
}

fn find(evaluator: &mut Evaluator, args: &Args) -> Outcome<Value> {
    Ok(position(evaluator, args)?.map_or(Value::NONE, |i| Value::bare(i as f64)))
}

fn keys(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    match args.value(0) {
        Value::Record(record) => {
            Ok(Value::list(record.fields().iter().map(|(key, _)| Value::text(&**key)).collect()))
        }
        _ => args.fail(0, Code::WrongKind, "needs a record"),
    }
}

fn values(_: &mut Evaluator, args: &Args) -> Outcome<Value> {
    match args.value(0) {
        Value::Record(record) => {
            Ok(Value::list(record.fields().iter().map(|(_, value)| value.clone()).collect()))
        }
        _ => args.fail(0, Code::WrongKind, "needs a record"),
    }
}
