//! Calls: the callee, its arguments, its frame.

use std::sync::Arc;

use super::{
    super::{
        builtin::{Args, Native},
        evaluator::{CallRecord, Evaluator},
        failure::{Failure, Outcome, fail},
        library::LIBRARY,
        stack::deep,
        types::shown,
        unit::{ArgumentCode, Body, CallCode, Capture, Code, CodeId, FunctionCode, MethodCode},
        value::{Closure, Function, Value},
    },
    Call, Frame,
    bind::Bound,
};
use crate::base::{self, Diagnostic, Span};

/// Call records that are looked through for the repeating cycle of an endless recursion.
const LONGEST_CYCLE: usize = 32;

impl Evaluator<'_> {
    #[inline(never)]
    pub(super) fn eval_call(
        &mut self,
        frame: &Frame,
        id: CodeId,
        call: &CallCode,
    ) -> Outcome<Value> {
        let callee = self.eval(frame, call.callee)?;
        let span = frame.unit.span(id);
        if let (true, Value::Function(function)) = (call.plain, &callee)
            && let Function::Closure(closure) = &**function
            && closure.code.simple
            && closure.code.params.len() == call.arguments.len()
        {
            return self.call_simple(frame, function, closure, &call.arguments, span);
        }
        let mut given = Call { span, callee: frame.unit.span(call.callee), ..Call::default() };
        self.arguments(frame, &call.arguments, &mut given)?;
        self.call(frame, &callee, given)
    }

    /// The frequent case: positional arguments go straight into the new frame.
    fn call_simple(
        &mut self,
        frame: &Frame,
        function: &Arc<Function>,
        closure: &Closure,
        arguments: &[ArgumentCode],
        span: Span,
    ) -> Outcome<Value> {
        let base = self.stack.len();
        for argument in arguments {
            if let ArgumentCode::Positional(code) = argument {
                match self.eval(frame, *code) {
                    Ok(value) => self.stack.push(value),
                    Err(failure) => {
                        self.stack.truncate(base);
                        return Err(failure);
                    }
                }
            }
        }
        self.run_closure(function, closure, base, span)
    }

    /// Runs a closure whose parameters stand on the stack from `base` on.
    fn run_closure(
        &mut self,
        function: &Arc<Function>,
        closure: &Closure,
        base: usize,
        span: Span,
    ) -> Outcome<Value> {
        let result = self.enter_closure(closure, span).and_then(|()| {
            self.stack.resize(base + closure.code.frame as usize, Value::NONE);
            let frame = Frame {
                unit: &closure.unit,
                instance: closure.instance,
                base,
                captures: closure.captures(),
                myself: Some(function),
            };
            let result = match closure.code.body {
                Body::Code(code) => self.eval(&frame, code),
                Body::Native(_) => Err(Failure::TOLD),
            };
            self.leave();
            result
        });
        self.stack.truncate(base);
        result
    }

    fn enter_closure(&mut self, closure: &Closure, span: Span) -> Outcome<()> {
        self.tick(1, span)?;
        if self.calls.len() as u32 >= self.limits.depth {
            let name = closure.code.name.clone().unwrap_or_else(|| "a lambda".into());
            return Err(self.too_deep(name, span));
        }
        let name = closure.code.name.clone();
        self.calls.push(CallRecord { name, span });
        Ok(())
    }

    /// Enters something that may call itself without end.
    pub(in crate::eval) fn enter(&mut self, name: Arc<str>, span: Span) -> Outcome<()> {
        if self.calls.len() as u32 >= self.limits.depth {
            return Err(self.too_deep(name, span));
        }
        self.calls.push(CallRecord { name: Some(name), span });
        Ok(())
    }

    pub(in crate::eval) fn leave(&mut self) {
        self.calls.pop();
    }

    /// The error for calls nested too deep, with the cycle of calls that repeats.
    fn too_deep(&self, name: Arc<str>, span: Span) -> Failure {
        let calls = &self.calls;
        let same = |period: usize| {
            let (tail, before) = (calls.len() - period, calls.len() - 2 * period);
            (0..period).all(|i| calls[tail + i] == calls[before + i])
        };
        let longest = LONGEST_CYCLE.min(calls.len() / 2);
        let period = (1..=longest).find(|&period| same(period));
        let limit = self.limits.depth;
        let at = self.shown_at(span);
        let Some(period) = period else {
            let message = format!("calls nest deeper than {limit}");
            return Diagnostic::error(base::Code::EndlessRecursion, message)
                .label(at, format!("the call of `{name}`"))
                .into();
        };
        let cycle = &calls[calls.len() - period..];
        let mut names: Vec<String> = cycle.iter().map(CallRecord::shown).collect();
        names.push(names[0].clone());
        let message = format!("endless recursion: {}", names.join(" -> "));
        let mut error = Diagnostic::error(base::Code::EndlessRecursion, message);
        for call in cycle.iter().rev() {
            let label = format!("{} is called here", call.shown());
            let at = self.shown_at(call.span);
            if !error.labels.iter().any(|known| known.span == at) {
                error = error.label(at, label);
            }
        }
        let depth = format!("calls may nest {limit} deep");
        error.note(depth).help("end the recursion with an `if`").into()
    }

    pub(super) fn arguments(
        &mut self,
        frame: &Frame,
        arguments: &[ArgumentCode],
        given: &mut Call,
    ) -> Outcome<()> {
        for argument in arguments {
            match argument {
                ArgumentCode::Positional(code) => {
                    let value = self.eval(frame, *code)?;
                    given.positional.push((value, frame.unit.span(*code)));
                }
                ArgumentCode::Named(name, code) => {
                    let value = self.eval(frame, *code)?;
                    given.named.push((name.clone(), value, frame.unit.span(*code)));
                }
                ArgumentCode::Spread(code) => {
                    let value = self.eval(frame, *code)?;
                    self.spread(value, frame.unit.span(*code), given)?;
                }
            }
        }
        Ok(())
    }

    fn spread(&mut self, value: Value, at: Span, given: &mut Call) -> Outcome<()> {
        match &value {
            Value::Record(record) => {
                for (key, value) in record.fields() {
                    let name = crate::syntax::ast::Name { text: key.clone(), span: at };
                    given.named.push((name, value.clone(), at));
                }
            }
            Value::List(_) | Value::Range(_) => {
                let items = self.items(&value, at)?;
                given.positional.extend(items.iter().map(|item| (item.clone(), at)));
            }
            other => {
                let words = format!("only a list or record can be spread, got {}", shown(other));
                return fail(base::Code::WrongKind, at, words);
            }
        }
        Ok(())
    }

    #[inline(never)]
    pub(super) fn eval_method(
        &mut self,
        frame: &Frame,
        id: CodeId,
        call: &MethodCode,
    ) -> Outcome<Value> {
        let object = self.eval(frame, call.object)?;
        let at = frame.unit.span(call.object);
        let mut given =
            Call { span: frame.unit.span(id), callee: call.name.span, ..Call::default() };
        let callee = match self.callable_member(&object, &call.name)? {
            Some(member) => member,
            None => {
                let Some(function) = call.function else {
                    return self.unknown_method(frame, call.object, &object, &call.name);
                };
                given.positional.push((object, at));
                self.eval(frame, function)?
            }
        };
        self.arguments(frame, &call.arguments, &mut given)?;
        self.call(frame, &callee, given)
    }

    /// Calls a value with evaluated arguments; `frame` is where the call stands.
    pub(in crate::eval) fn call(
        &mut self,
        frame: &Frame,
        callee: &Value,
        given: Call,
    ) -> Outcome<Value> {
        let called = match callee {
            Value::Symbol(symbol) => self.called_constant(*symbol)?,
            _ => None,
        };
        let Value::Function(function) = called.as_ref().unwrap_or(callee) else {
            let words = format!("{} cannot be called", callee.words());
            return fail(base::Code::WrongKind, given.callee, words);
        };
        let (number, bound) = self.bind(function, &given)?;
        let closure = &function.signatures()[number];
        if closure.unit.library && frame.unit.library {
            return self.run(frame, function, closure, bound, given.span);
        }
        if !closure.unit.library {
            return self.run(frame, function, closure, bound, given.span);
        }
        let here = self.shown_at(given.span);
        let before = std::mem::replace(&mut self.library_call, here);
        let result = self.run(frame, function, closure, bound, given.span);
        self.library_call = before;
        result.map_err(|failure| failure.map(|error| at_call(error, given.span)))
    }

    fn run(
        &mut self,
        caller: &Frame,
        function: &Arc<Function>,
        closure: &Closure,
        bound: Bound,
        span: Span,
    ) -> Outcome<Value> {
        let base = self.stack.len();
        let spans: Vec<Span> = bound.iter().map(|b| b.as_ref().map_or(span, |b| b.1)).collect();
        let given: Vec<bool> = bound.iter().map(Option::is_some).collect();
        let values = bound.into_iter().map(|b| b.map_or(Value::NONE, |b| b.0));
        self.stack.extend(values);
        let result =
            self.defaults(function, closure, base, &given).and_then(|()| match closure.code.body {
                Body::Native(native) => {
                    let values = self.stack.split_off(base);
                    self.run_native(caller, &closure.code, native, &values, &spans, span)
                }
                Body::Code(_) => deep(|| self.run_closure(function, closure, base, span)),
            });
        self.stack.truncate(base);
        let result = result?;
        match &closure.code.result {
            Some(_) if closure.unit.library => Ok(result),
            ty => {
                let at = match closure.code.body {
                    Body::Code(code) => closure.unit.span(code),
                    Body::Native(_) => span,
                };
                self.typed(result, ty.as_ref(), at)
            }
        }
    }

    fn run_native(
        &mut self,
        caller: &Frame,
        code: &FunctionCode,
        native: Native,
        values: &[Value],
        spans: &[Span],
        call: Span,
    ) -> Outcome<Value> {
        self.tick(1, call)?;
        self.room(0, call)?;
        let params = &code.params;
        let args = Args { values, spans, params, call, caller };
        args.within_reach()?;
        if self.tracing > 0
            && let Some(name) = &code.name
            && let Some(found) = self.traced_function(name, &args)
        {
            return found;
        }
        native(self, &args)
    }

    /// Evaluates the defaults of parameters that got nothing, from left to right.
    fn defaults(
        &mut self,
        function: &Arc<Function>,
        closure: &Closure,
        base: usize,
        given: &[bool],
    ) -> Outcome<()> {
        for (i, param) in closure.code.params.iter().enumerate() {
            let Some(default) = param.default.filter(|_| !given[i]) else { continue };
            let value = match &closure.unit.code[default.0 as usize] {
                Code::Constant(value) => value.clone(),
                _ => {
                    self.stack.resize(base + closure.code.frame as usize, Value::NONE);
                    let frame = Frame {
                        unit: &closure.unit,
                        instance: closure.instance,
                        base,
                        captures: closure.captures(),
                        myself: Some(function),
                    };
                    let value = self.eval(&frame, default)?;
                    self.stack.truncate(base + closure.code.params.len());
                    value
                }
            };
            let span = closure.unit.span(default);
            self.stack[base + i] = self.typed(value, param.ty.as_ref(), span)?;
        }
        Ok(())
    }

    /// Calls a function value with positional arguments, as `map` and `fold` do.
    pub(in crate::eval) fn call_with(
        &mut self,
        args: &Args,
        function: &Value,
        values: &[Value],
        at: Span,
    ) -> Outcome<Value> {
        if let Value::Function(shared) = function
            && let Function::Closure(closure) = &**shared
            && closure.code.simple
            && closure.code.params.len() == values.len()
        {
            let base = self.stack.len();
            self.stack.extend_from_slice(values);
            return self.run_closure(shared, closure, base, at);
        }
        let positional = values.iter().map(|value| (value.clone(), at)).collect();
        let given = Call { positional, named: vec![], span: at, callee: at };
        self.call(args.caller, function, given)
    }

    /// A closure over the values it captures here.
    pub(super) fn closure(&mut self, frame: &Frame, index: u32) -> Value {
        let code = frame.unit.functions[index as usize].clone();
        let captures = code.captures.iter().map(|capture| match capture {
            Capture::Local(slot) => self.stack[frame.base + *slot as usize].clone(),
            Capture::Captured(index) => frame.captures[*index as usize].clone(),
            Capture::Myself => frame.myself.cloned().map_or(Value::NONE, Value::Function),
        });
        let captures = captures.collect();
        let closure = Closure::new(frame.unit.clone(), frame.instance, code, captures);
        Value::Function(Arc::new(Function::Closure(closure)))
    }

    pub(super) fn native_constant(
        &mut self,
        frame: &Frame,
        native: Native,
        span: Span,
    ) -> Outcome<Value> {
        native(self, &Args { values: &[], spans: &[], params: &[], call: span, caller: frame })
    }
}

/// An error from inside the library, shown at the call that led into it.
fn at_call(mut error: Diagnostic, call: Span) -> Diagnostic {
    let visible = |span: Span| span.source != LIBRARY;
    error.labels.retain(|label| visible(label.span));
    error.fix = error.fix.filter(|fix| visible(fix.span));
    if error.labels.is_empty() { error.label(call, "") } else { error }
}
