//! Expressions.

use super::{Resolver, function::Ending};
use crate::{
    base::{self, Diagnostic, Span},
    eval::{
        dimension::{literal, unit_factor, unit_text},
        stack::deep,
        unit::{
            ArgumentCode, BinderCode, CallCode, ChainCode, Code, CodeId, ForCode, MethodCode,
            RangeCode, RecordPart, TextPart,
        },
        value::{Value, number_text},
    },
    syntax::ast::{self, BinaryOp, Expr, ExprKind, UnaryOp},
};

impl Resolver<'_> {
    pub fn expression(&mut self, expr: &Expr) -> CodeId {
        deep(|| self.expression_here(expr))
    }

    fn expression_here(&mut self, expr: &Expr) -> CodeId {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number { value, unit } => self.number(*value, unit.as_ref(), span),
            ExprKind::Text(text) => self.text(text),
            ExprKind::Bool(value) => self.constant(Value::Bool(*value), span),
            ExprKind::Name(name) => self.name(name),
            ExprKind::Paren(inner) => self.expression(inner),
            ExprKind::List(items) => {
                let items = items.iter().map(|item| self.expression(item)).collect();
                self.add(Code::List(items), span)
            }
            ExprKind::Record(fields) => self.record(fields, span),
            ExprKind::Do(block) => self.block(block, Ending::Value),
            ExprKind::If(decision) => self.decision(decision, Ending::Value, span),
            ExprKind::For(repeat) => self.repeat(repeat, span),
            ExprKind::Lambda { params, body } => {
                let index = self.lambda(params, body);
                self.add(Code::Closure(index), span)
            }
            ExprKind::Unary { op, operand, .. } => {
                let operand = self.expression(operand);
                let code = match op {
                    UnaryOp::Negate => Code::Negate(operand),
                    UnaryOp::Not => Code::Not(operand),
                };
                self.add(code, span)
            }
            ExprKind::Binary(binary) => self.binary(binary, span),
            ExprKind::Chain(chain) => self.chain(chain),
            ExprKind::Range(range) => self.range(range, span),
            ExprKind::Call { callee, arguments } => self.call(callee, arguments, span),
            ExprKind::Member(member) => {
                let object = self.expression(&member.object);
                self.add(Code::Member(object, Box::new(member.name.clone())), span)
            }
            ExprKind::Index { object, index } => {
                let (object, index) = (self.expression(object), self.expression(index));
                self.add(Code::Index(object, index), span)
            }
            ExprKind::Error => self.add(Code::Broken, span),
        }
    }

    fn number(&mut self, value: f64, unit: Option<&ast::Unit>, span: Span) -> CodeId {
        match literal(value, unit) {
            Some((number, dimension)) if number.is_finite() => {
                self.constant(Value::Number(number, dimension), span)
            }
            _ => {
                let error = Diagnostic::error(base::Code::BadToken, "this number is too large")
                    .label(span, "the largest is about 1.8e308");
                self.broken(error, span)
            }
        }
    }

    pub fn text(&mut self, text: &ast::Text) -> CodeId {
        if let [ast::Piece::Literal(literal)] = &text.pieces[..] {
            return self.constant(Value::text(&**literal), text.span);
        }
        let parts = text.pieces.iter().map(|piece| match piece {
            ast::Piece::Literal(literal) => TextPart::Literal(literal.clone()),
            ast::Piece::Expr(expr) => TextPart::Value(self.expression(expr)),
        });
        let parts = parts.collect();
        self.add(Code::Text(parts), text.span)
    }

    fn record(&mut self, fields: &[ast::Field], span: Span) -> CodeId {
        let mut parts = Vec::with_capacity(fields.len());
        let mut seen: Vec<&ast::Name> = vec![];
        for field in fields {
            match field {
                ast::Field::Spread(expr) => parts.push(RecordPart::Spread(self.expression(expr))),
                ast::Field::Named { name, value } => {
                    if let Some(first) = seen.iter().find(|first| first.text == name.text) {
                        let twice = super::duplicate(&name.text, name.span, first.span);
                        self.diagnostics.push(twice);
                    }
                    seen.push(name);
                    let code = match value {
                        Some(value) => self.expression(value),
                        None => self.name(name),
                    };
                    parts.push(RecordPart::Field(name.text.clone(), code));
                }
            }
        }
        self.add(Code::Record(parts.into()), span)
    }

    fn repeat(&mut self, repeat: &ast::For, span: Span) -> CodeId {
        let binders = &repeat.binders;
        for _ in binders {
            self.scope().open();
        }
        // Each binder opens a scope of its own, so that a later source sees the earlier names and
        // the slots are given back together.
        let binders: Vec<BinderCode> = binders
            .iter()
            .map(|binder| {
                let source = self.expression(&binder.source);
                let slot = self.bind(&binder.name);
                let index = binder.index.as_ref().map(|index| self.bind(index));
                BinderCode { slot, index, source }
            })
            .collect();
        let condition = repeat.condition.as_ref().map(|condition| self.expression(condition));
        let body = self.block(&repeat.body, Ending::Element);
        for _ in &binders {
            self.scope().close();
        }
        let code = ForCode { binders: binders.into(), condition, body };
        self.add(Code::For(Box::new(code)), span)
    }

    fn binary(&mut self, binary: &ast::Binary, span: Span) -> CodeId {
        let ast::Binary { op, left, right, .. } = binary;
        if *op == BinaryOp::Divide {
            self.note_fraction(left, right, span);
        }
        let (left, right) = (self.expression(left), self.expression(right));
        let code = match op {
            BinaryOp::And => Code::And(left, right),
            BinaryOp::Or => Code::Or(left, right),
            op => Code::Binary(*op, left, right),
        };
        self.add(code, span)
    }

    fn chain(&mut self, chain: &ast::Chain) -> CodeId {
        let first = &chain.links[0];
        if first.op == BinaryOp::Divide {
            let span = chain.first.span.to(first.right.span);
            self.note_fraction(&chain.first, &first.right, span);
        }
        let start = self.expression(&chain.first);
        let links = chain.links.iter().map(|link| (link.op, self.expression(&link.right)));
        let links: Box<[(BinaryOp, CodeId)]> = links.collect();
        let last = chain.links.last().map_or(chain.first.span, |link| link.right.span);
        let code = Code::Chain(Box::new(ChainCode { first: start, links }));
        self.add(code, chain.first.span.to(last))
    }

    /// Remembers `1/4in`, which is 1/length, with the `0.25in` that was probably meant.
    fn note_fraction(&mut self, left: &Expr, right: &Expr, span: Span) {
        let ExprKind::Number { value: over, unit: None } = left.kind else { return };
        let ExprKind::Number { value: under, unit: Some(unit) } = &right.kind else { return };
        if unit.exponent == 1 && *under != 0.0 {
            let meant = format!("{}{}", number_text(over / under), unit_text(unit.name));
            self.unit.fractions.push((span, meant));
        }
    }

    fn range(&mut self, range: &ast::Range, span: Span) -> CodeId {
        let ast::Range { start, end, inclusive, step } = range;
        let unit = written_unit(start).or_else(|| written_unit(end)).unwrap_or(1.0);
        let (start, end) = (self.expression(start), self.expression(end));
        let step = step.as_ref().map(|step| self.expression(step));
        let code = RangeCode { start, end, inclusive: *inclusive, step, unit };
        self.add(Code::Range(Box::new(code)), span)
    }

    fn call(&mut self, callee: &Expr, arguments: &[ast::Argument], span: Span) -> CodeId {
        if let ExprKind::Member(member) = &callee.kind {
            let ast::Member { object, name } = &**member;
            let object = self.expression(object);
            let function = self.find(&name.text).map(|code| self.add(code, name.span));
            let arguments = self.arguments(arguments);
            let code = MethodCode { object, name: name.clone(), function, arguments };
            return self.add(Code::Method(Box::new(code)), span);
        }
        if let ExprKind::Name(name) = &callee.kind
            && &*name.text == "self"
            && self.find("self").is_none()
        {
            let arguments = self.arguments(arguments);
            return self.add(Code::Again(arguments), span);
        }
        if let Some(native) = self.native_value(callee, arguments) {
            return self.add(Code::Native(native), span);
        }
        let callee = self.expression(callee);
        let arguments = self.arguments(arguments);
        let plain = arguments.iter().all(|a| matches!(a, ArgumentCode::Positional(_)));
        self.add(Code::Call(Box::new(CallCode { callee, arguments, plain })), span)
    }

    fn arguments(&mut self, arguments: &[ast::Argument]) -> Box<[ArgumentCode]> {
        let mut codes = Vec::with_capacity(arguments.len());
        for argument in arguments {
            codes.push(match argument {
                ast::Argument::Positional(expr) => ArgumentCode::Positional(self.expression(expr)),
                ast::Argument::Named { name, value } => {
                    ArgumentCode::Named(name.clone(), self.expression(value))
                }
                ast::Argument::Spread(expr) => ArgumentCode::Spread(self.expression(expr)),
            });
        }
        codes.into()
    }
}

/// The size of one of the unit a number is written in: 25.4 for `3in` and `-3in`.
fn written_unit(expr: &Expr) -> Option<f64> {
    match &expr.kind {
        ExprKind::Number { unit: Some(unit), .. } if unit.exponent == 1 => {
            Some(unit_factor(unit.name).0)
        }
        ExprKind::Unary { op: UnaryOp::Negate, operand, .. } => written_unit(operand),
        ExprKind::Paren(inner) => written_unit(inner),
        _ => None,
    }
}
