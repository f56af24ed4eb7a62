//! Which argument goes to which parameter, and what is said when they do not fit.

use super::super::{
    evaluator::Evaluator,
    failure::{Failure, Outcome},
    nearest::did_you_mean,
    types::Misfit,
    unit::{FunctionCode, Parameter},
    value::{Function, Value},
};
use crate::{
    base::{Code, Diagnostic, Span},
    syntax::ast,
};

/// The evaluated arguments of a call.
#[derive(Debug, Default)]
pub struct Call {
    pub positional: Vec<(Value, Span)>,
    pub named: Vec<(ast::Name, Value, Span)>,
    /// The whole call.
    pub span: Span,
    /// The name that is called.
    pub callee: Span,
}

/// For each parameter its argument's value and place; `None` takes the default.
pub type Bound = Vec<Option<(Value, Span)>>;

/// Why a signature does not take the arguments.
#[derive(Debug)]
enum Mismatch {
    /// The named argument of that number is no parameter, though `known` others are.
    Unknown { argument: usize, known: usize },
    /// A named argument stands twice.
    Twice(usize),
    /// The positional argument of that number has no parameter left.
    TooMany(usize),
    /// The parameter of that number got nothing.
    Missing(usize),
    /// The parameter of that number got a value that does not fit.
    Kind { param: usize, at: Span, misfit: Misfit },
}

impl Mismatch {
    /// How close the signature came: the best one is reported.
    fn closeness(&self) -> (usize, usize) {
        match self {
            Mismatch::TooMany(_) => (0, 0),
            Mismatch::Unknown { known, .. } => (1, *known),
            Mismatch::Kind { param, .. } => (2, *param),
            Mismatch::Twice(_) => (3, 0),
            Mismatch::Missing(_) => (4, 0),
        }
    }
}

impl Evaluator<'_> {
    /// The first signature that takes the arguments, and the arguments in its order.
    pub(super) fn bind(&mut self, function: &Function, call: &Call) -> Outcome<(usize, Bound)> {
        let signatures = function.signatures();
        let mut best: Option<(usize, Mismatch)> = None;
        for (number, signature) in signatures.iter().enumerate() {
            match self.fit(&signature.code, call) {
                Ok(bound) => return Ok((number, self.converted(&signature.code, bound))),
                Err(mismatch) => {
                    let better =
                        best.as_ref().is_none_or(|(_, b)| mismatch.closeness() > b.closeness());
                    if better {
                        best = Some((number, mismatch));
                    }
                }
            }
        }
        let (spread, help) = self.unspread(function, call).unzip();
        match spread.or(best) {
            Some((number, mismatch)) => {
                let failure = self.explain(function, number, mismatch, call);
                Err(failure.map(|error| match help {
                    Some(help) => error.help(help),
                    None => error,
                }))
            }
            None => Err(Failure::TOLD),
        }
    }

    /// `box([1, 2, 3])`: where the elements of the only argument would fit one by one, the signature
    /// that takes them so, why it does not take the list, and how to write it.
    fn unspread(&self, function: &Function, call: &Call) -> Option<((usize, Mismatch), String)> {
        /// Longer lists are not meant as arguments.
        const MOST: usize = 8;
        let [(Value::List(list), at)] = &call.positional[..] else { return None };
        if list.len() > MOST {
            return None;
        }
        let spread = Call {
            positional: list.iter().map(|value| (value.clone(), *at)).collect(),
            named: call.named.clone(),
            ..*call
        };
        let signatures = function.signatures();
        let number = signatures.iter().position(|s| self.fit(&s.code, &spread).is_ok())?;
        let mismatch = self.fit(&signatures[number].code, call).err()?;
        let values: Vec<String> = list.iter().map(|value| value.literal().to_string()).collect();
        let name = function.name().unwrap_or("f");
        let help = format!("without the brackets: `{name}({})`", values.join(", "));
        Some(((number, mismatch), help))
    }

    fn fit(&self, code: &FunctionCode, call: &Call) -> Result<Bound, Mismatch> {
        let mut bound: Bound = vec![None; code.params.len()];
        for (argument, (name, value, span)) in call.named.iter().enumerate() {
            let find = |name: &ast::Name| code.params.iter().position(|p| p.name == name.text);
            let Some(index) = find(name) else {
                let known = call.named.iter().filter(|named| find(&named.0).is_some()).count();
                return Err(Mismatch::Unknown { argument, known });
            };
            if bound[index].replace((value.clone(), *span)).is_some() {
                return Err(Mismatch::Twice(argument));
            }
        }
        let free: Vec<usize> = code.positional().filter(|&i| bound[i].is_none()).collect();
        for (i, argument) in call.positional.iter().enumerate() {
            let index = *free.get(i).ok_or(Mismatch::TooMany(i))?;
            bound[index] = Some(argument.clone());
        }
        for (param, (bound, parameter)) in bound.iter().zip(&code.params).enumerate() {
            if let (Some((value, at)), Some(ty)) = (bound, &parameter.ty) {
                let checked = ty.check(&self.graph, value);
                checked.map_err(|misfit| Mismatch::Kind { param, at: *at, misfit })?;
            }
        }
        let missing = |i: &usize| bound[*i].is_none() && code.params[*i].default.is_none();
        match (0..bound.len()).find(missing) {
            Some(param) => Err(Mismatch::Missing(param)),
            None => Ok(bound),
        }
    }

    fn converted(&mut self, code: &FunctionCode, bound: Bound) -> Bound {
        let pairs = bound.into_iter().zip(&code.params);
        pairs
            .map(|(argument, param)| match (argument, &param.ty) {
                (Some((value, at)), Some(ty)) => Some((ty.convert(&mut self.graph, value), at)),
                (argument, _) => argument,
            })
            .collect()
    }

    fn explain(
        &self,
        function: &Function,
        number: usize,
        mismatch: Mismatch,
        call: &Call,
    ) -> Failure {
        let signatures = function.signatures();
        let code = &signatures[number].code;
        let name = function.name().unwrap_or("this function");
        let error = match mismatch {
            Mismatch::Unknown { argument, .. } => {
                unknown_argument(function, &call.named[argument].0, name)
            }
            Mismatch::Twice(i) => {
                let message = format!("`{}` is given twice", call.named[i].0.text);
                Diagnostic::error(Code::BadCall, message).label(call.named[i].0.span, "")
            }
            Mismatch::TooMany(i) => too_many(code, call, i, name),
            Mismatch::Missing(i) => missing(&code.params[i], call, name),
            Mismatch::Kind { param, at, misfit } => {
                let message = format!("`{}` of `{name}` {}", code.params[param].name, misfit.words);
                self.with_fraction(Diagnostic::error(misfit.code, message).label(at, ""), at)
            }
        };
        let texts = signatures.iter().map(|signature| signature.code.signature());
        let texts: Vec<String> = texts.collect();
        error.note(format!("signature: {}", texts.join("\n           "))).into()
    }
}

fn unknown_argument(function: &Function, given: &ast::Name, name: &str) -> Diagnostic {
    let message = format!("`{name}` has no parameter `{}`", given.text);
    let error = Diagnostic::error(Code::UnknownArgument, message).label(given.span, "");
    let params = || {
        let codes = function.signatures().iter().flat_map(|signature| signature.code.params.iter());
        codes.map(|param| &*param.name)
    };
    match did_you_mean(&given.text, params()) {
        Some((help, first)) => error.help(help).fix(given.span, first),
        None => error,
    }
}

fn too_many(code: &FunctionCode, call: &Call, first: usize, name: &str) -> Diagnostic {
    let takes = code.positional().count();
    let message = match takes {
        0 => format!("`{name}` takes no positional arguments"),
        1 => format!("`{name}` takes one positional argument, got {}", call.positional.len()),
        n => format!("`{name}` takes {n} positional arguments, got {}", call.positional.len()),
    };
    let error =
        Diagnostic::error(Code::BadCall, message).label(call.positional[first].1, "one too many");
    match code.params.iter().find(|param| param.default.is_some()) {
        Some(param) => error.help(format!(
            "a parameter with a default is given by name: `{} = {}`",
            param.name, call.positional[first].0
        )),
        None => error,
    }
}

fn missing(param: &Parameter, call: &Call, name: &str) -> Diagnostic {
    let message = format!("missing `{}` in the call of `{name}`", param.name);
    let error = Diagnostic::error(Code::MissingArgument, message);
    let given = call.positional.iter().map(|(_, span)| *span);
    let given: Vec<Span> = given.chain(call.named.iter().map(|(_, _, span)| *span)).collect();
    match given[..] {
        [] => error.label(call.span, "nothing is given"),
        _ => given.into_iter().fold(error, |error, span| error.label(span, "given")),
    }
}
