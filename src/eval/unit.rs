//! A file after the resolve pass: expressions as numbered code in one arena, names as slots.

use std::sync::Arc;

use super::{builtin::Native, types::Type, value::Value};
use crate::{
    base::Span,
    syntax::ast::{self, BinaryOp, OutputKind},
};

/// Names one expression of a [`Unit`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CodeId(pub u32);

/// An expression whose names are resolved.
#[derive(Debug)]
pub enum Code {
    Constant(Value),
    Local(u32),
    Captured(u32),
    /// The function that is running: a local function that calls itself.
    Myself,
    Global(u32),
    Library(u32),
    Text(Box<[TextPart]>),
    List(Box<[CodeId]>),
    Record(Box<[RecordPart]>),
    Block(Box<[Step]>, CodeId),
    If {
        condition: CodeId,
        then: CodeId,
        otherwise: Option<CodeId>,
    },
    For(Box<ForCode>),
    Closure(u32),
    Not(CodeId),
    Negate(CodeId),
    And(CodeId, CodeId),
    Or(CodeId, CodeId),
    Binary(BinaryOp, CodeId, CodeId),
    Chain(Box<ChainCode>),
    Range(Box<RangeCode>),
    Call(Box<CallCode>),
    Method(Box<MethodCode>),
    /// `self(...)`.
    Again(Box<[ArgumentCode]>),
    Member(CodeId, Box<ast::Name>),
    Index(CodeId, CodeId),
    /// A constant of the library.
    Native(Native),
    /// What was wrong with it has been said.
    Broken,
}

#[derive(Debug)]
pub enum TextPart {
    Literal(Arc<str>),
    Value(CodeId),
}

#[derive(Debug)]
pub enum RecordPart {
    Field(Arc<str>, CodeId),
    Spread(CodeId),
}

/// A statement of a block.
#[derive(Debug)]
pub enum Step {
    Bind { slot: u32, value: CodeId, ty: Option<Type> },
    Assert(AssertCode),
    Drop(CodeId),
}

#[derive(Clone, Copy, Debug)]
pub struct AssertCode {
    pub condition: CodeId,
    pub message: Option<CodeId>,
}

#[derive(Debug)]
pub struct ForCode {
    pub binders: Box<[BinderCode]>,
    pub condition: Option<CodeId>,
    pub body: CodeId,
}

#[derive(Debug)]
pub struct BinderCode {
    pub slot: u32,
    pub index: Option<u32>,
    pub source: CodeId,
}

/// Operators that bind alike, from left to right: `a + b - c`, `a and b and c`.
#[derive(Debug)]
pub struct ChainCode {
    pub first: CodeId,
    pub links: Box<[(BinaryOp, CodeId)]>,
}

#[derive(Debug)]
pub struct RangeCode {
    pub start: CodeId,
    pub end: CodeId,
    pub inclusive: bool,
    pub step: Option<CodeId>,
    /// The step when none is written: 1 of the unit the bounds are written in.
    pub unit: f64,
}

#[derive(Debug)]
pub struct CallCode {
    pub callee: CodeId,
    pub arguments: Box<[ArgumentCode]>,
    /// Whether all arguments are positional.
    pub plain: bool,
}

/// `object.name(arguments)`.
#[derive(Debug)]
pub struct MethodCode {
    pub object: CodeId,
    pub name: ast::Name,
    /// The function of that name in scope.
    pub function: Option<CodeId>,
    pub arguments: Box<[ArgumentCode]>,
}

#[derive(Debug)]
pub enum ArgumentCode {
    Positional(CodeId),
    Named(ast::Name, CodeId),
    Spread(CodeId),
}

/// A function whose names are resolved.
#[derive(Debug)]
pub struct FunctionCode {
    pub name: Option<Arc<str>>,
    pub params: Box<[Parameter]>,
    pub captures: Box<[Capture]>,
    /// Slots of its frame, parameters first.
    pub frame: u32,
    pub body: Body,
    pub result: Option<Type>,
    /// No parameter has a type or default: arguments go straight to the frame.
    pub simple: bool,
}

#[derive(Debug)]
pub enum Body {
    Code(CodeId),
    Native(Native),
}

#[derive(Debug)]
pub struct Parameter {
    pub name: Arc<str>,
    pub ty: Option<Type>,
    pub default: Option<CodeId>,
}

/// Where a closure takes a value from when it is made.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Capture {
    Local(u32),
    Captured(u32),
    Myself,
}

impl FunctionCode {
    /// The signature as a modeller reads it: `cylinder(r: Length, h: Length, sides: Count =)`.
    pub fn signature(&self) -> String {
        let params: Vec<String> = self.params.iter().map(Parameter::text).collect();
        let name = self.name.as_deref().unwrap_or("");
        format!("{name}({})", params.join(", "))
    }

    /// Parameters that take a positional argument.
    pub fn positional(&self) -> impl Iterator<Item = usize> {
        let params = self.params.iter().enumerate();
        params.filter(|(_, param)| param.default.is_none()).map(|(i, _)| i)
    }
}

impl Parameter {
    fn text(&self) -> String {
        let ty = self.ty.as_ref().map_or(String::new(), |ty| format!(": {ty}"));
        let default = if self.default.is_some() { " =" } else { "" };
        format!("{}{ty}{default}", self.name)
    }
}

/// What a parameter takes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum ParamKind {
    /// A string.
    Text,
    /// A number of some dimension.
    Number,
}

/// What a top-level name stands for.
#[derive(Clone, PartialEq, Debug)]
pub enum GlobalKind {
    /// A binding or a function.
    Value,
    /// A parameter of the file, by number.
    Param(u32),
    /// An output.
    Output(OutputKind),
    /// A shape without a name.
    Anonymous,
    /// A file taken in, by the number of its `use`.
    Module(u32),
    /// A name of a file taken in.
    Imported(u32, Arc<str>),
    /// `export`: evaluated like a name, but not reachable.
    Export,
}

/// A top-level definition.
#[derive(Debug)]
pub struct Global {
    pub name: ast::Name,
    pub kind: GlobalKind,
    pub public: bool,
    pub doc: Option<Arc<str>>,
    pub ty: Option<Type>,
    pub value: CodeId,
    pub frame: u32,
}

#[derive(Debug)]
pub struct ParamCode {
    pub global: u32,
    pub group: Option<Arc<str>>,
    pub domain: Option<CodeId>,
    pub condition: Option<CodeId>,
    pub frame: u32,
}

#[derive(Debug)]
pub struct ExportCode {
    pub file: CodeId,
    pub global: u32,
}

#[derive(Debug)]
pub struct UseCode {
    pub path: Arc<str>,
    pub span: Span,
    pub with: Option<CodeId>,
    pub frame: u32,
}

#[derive(Debug)]
pub struct TestCode {
    pub title: CodeId,
    pub fails: Option<CodeId>,
    pub body: CodeId,
    pub frame: u32,
    pub span: Span,
}

#[derive(Debug)]
pub struct Setting {
    pub name: ast::Name,
    pub value: CodeId,
    pub frame: u32,
}

/// A file after the resolve pass.
#[derive(Debug)]
pub struct Unit {
    pub path: Arc<str>,
    pub text: Arc<str>,
    /// Part of the library: its errors are shown at the call that led into it.
    pub library: bool,
    pub code: Vec<Code>,
    pub spans: Vec<Span>,
    pub functions: Vec<Arc<FunctionCode>>,
    pub globals: Vec<Global>,
    pub names: rustc_hash::FxHashMap<Arc<str>, u32>,
    pub params: Vec<ParamCode>,
    pub exports: Vec<ExportCode>,
    pub uses: Vec<UseCode>,
    pub asserts: Vec<AssertCode>,
    pub tests: Vec<TestCode>,
    pub settings: Vec<Setting>,
    /// Slots of the frame of top-level asserts.
    pub frame: u32,
    /// Quotients such as `1/4in` and the length that was probably meant.
    pub fractions: Vec<(Span, String)>,
}

impl Unit {
    pub fn span(&self, id: CodeId) -> Span {
        self.spans[id.0 as usize]
    }

    /// The characters of a span of this file.
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// Takes the definition or assert around a syntax error out of use: what is left of it after
    /// recovery is not what was meant.
    pub fn disable(&mut self, error: Option<Span>) {
        let Some(error) = error else { return };
        let mut broken = vec![];
        for global in &self.globals {
            if let Some(value) = self.spans.get(global.value.0 as usize) {
                let start = global.name.span.start.min(value.start);
                if (start..value.end).contains(&error.start) {
                    broken.push(global.value);
                }
            }
        }
        for assert in &self.asserts {
            let span = self.span(assert.condition);
            if (span.start..span.end).contains(&error.start) {
                broken.push(assert.condition);
            }
        }
        for code in broken {
            self.code[code.0 as usize] = Code::Broken;
        }
    }

    /// What a parameter is, as far as its declaration tells without evaluating it.
    pub fn param_kind(&self, name: &str) -> Option<ParamKind> {
        let number = *self.names.get(name)?;
        let global = &self.globals[number as usize];
        let GlobalKind::Param(_) = global.kind else { return None };
        let default = self.code.get(global.value.0 as usize);
        match (&global.ty, default) {
            (Some(Type::String), _) => Some(ParamKind::Text),
            (Some(Type::Number(_) | Type::Quantity | Type::Count), _) => Some(ParamKind::Number),
            (None, Some(Code::Text(_) | Code::Constant(Value::Text(_)))) => Some(ParamKind::Text),
            (
                None,
                Some(
                    Code::Constant(Value::Number(..))
                    | Code::Binary(..)
                    | Code::Chain(_)
                    | Code::Negate(_),
                ),
            ) => Some(ParamKind::Number),
            _ => None,
        }
    }

    /// The file's name without folder and ending.
    pub fn stem(&self) -> &str {
        stem(&self.path)
    }
}

/// A file's name without folder and ending; that of `<stdin>` is `stdin`.
pub fn stem(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.strip_suffix(".kata").unwrap_or(name).trim_matches(['<', '>'])
}
