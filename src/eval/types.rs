//! Declared types: what they are called, which values fit, and how a bare number becomes a length.

use std::{fmt, sync::Arc};

use rustc_hash::FxHashSet;

use super::{
    dimension::Dimension,
    nearest::did_you_mean,
    value::{Symbol, Traced, Value},
};
use crate::{
    base::{Code, Diagnostic},
    shape::{Kind, Node, ShapeGraph, ShapeId},
    syntax::ast,
};

/// A declared type.
#[derive(Clone, PartialEq, Debug)]
pub enum Type {
    /// Any value.
    Any,
    /// A number of that dimension; a bare number fits a length or an angle.
    Number(Dimension),
    /// A number of any dimension.
    Quantity,
    /// A whole bare number, not negative.
    Count,
    /// A truth value.
    Bool,
    /// A string.
    String,
    /// A list or range.
    List(Box<Type>),
    /// A record or module.
    Record,
    /// A range.
    Range,
    /// A function.
    Function,
    /// A solid, or a list of solids as its union.
    Solid,
    /// A profile, or a list of profiles as its union.
    Profile,
    /// A solid or a profile.
    Shape,
    /// The type or `NONE`.
    Optional(Box<Type>),
    /// A curve.
    Curve,
    /// A surface.
    Surface,
    /// The distance from a solid, everywhere.
    Field,
    /// What can be moved: a solid, profile, curve or surface.
    Figure,
    /// A drawing.
    Drawing,
    /// A picture.
    Picture,
    /// A page.
    Page,
    /// A list of two or three lengths.
    Point,
    /// A list of two or three numbers of one dimension.
    Vector,
}

const NAMES: &[&str] = &[
    "Any", "Number", "Length", "Angle", "Area", "Volume", "Quantity", "Count", "Bool", "String",
    "List", "Record", "Range", "Function", "Solid", "Profile", "Shape", "Curve", "Surface",
    "Field", "Figure", "Drawing", "Picture", "Page", "Optional", "Point", "Vector",
];

/// Why a value does not fit.
#[derive(Clone, PartialEq, Debug)]
pub struct Misfit {
    /// The kind of error.
    pub code: Code,
    /// `needs a length, got 30deg (an angle)`.
    pub words: String,
}

impl Type {
    /// The type that is written; an error for unknown names and wrong numbers of arguments.
    pub fn read(written: &ast::Type) -> Result<Type, Diagnostic> {
        let simple = match &*written.name.text {
            "Any" => Type::Any,
            "Number" => Type::Number(Dimension::BARE),
            "Length" => Type::Number(Dimension::LENGTH),
            "Angle" => Type::Number(Dimension::ANGLE),
            "Area" => Type::Number(Dimension::AREA),
            "Volume" => Type::Number(Dimension::VOLUME),
            "Quantity" => Type::Quantity,
            "Count" => Type::Count,
            "Bool" => Type::Bool,
            "String" => Type::String,
            "Record" => Type::Record,
            "Range" => Type::Range,
            "Function" => Type::Function,
            "Solid" => Type::Solid,
            "Profile" => Type::Profile,
            "Shape" => Type::Shape,
            "Curve" => Type::Curve,
            "Surface" => Type::Surface,
            "Field" => Type::Field,
            "Figure" => Type::Figure,
            "Drawing" => Type::Drawing,
            "Picture" => Type::Picture,
            "Page" => Type::Page,
            "Point" => Type::Point,
            "Vector" => Type::Vector,
            "List" | "Optional" => return Type::read_generic(written),
            name => return Err(unknown_type(name, written)),
        };
        if written.arguments.is_empty() {
            return Ok(simple);
        }
        let message = format!("the type `{}` takes nothing in brackets", written.name.text);
        Err(Diagnostic::error(Code::WrongKind, message).label(written.span, ""))
    }

    fn read_generic(written: &ast::Type) -> Result<Type, Diagnostic> {
        let list = &*written.name.text == "List";
        match &written.arguments[..] {
            [] if list => Ok(Type::List(Box::new(Type::Any))),
            [inner] if list => Ok(Type::List(Box::new(Type::read(inner)?))),
            [inner] => Ok(Type::Optional(Box::new(Type::read(inner)?))),
            _ => {
                let message = format!("`{}` takes one type in brackets", written.name.text);
                Err(Diagnostic::error(Code::WrongKind, message).label(written.span, ""))
            }
        }
    }

    /// Whether the value fits.
    pub fn check(&self, graph: &ShapeGraph, value: &Value) -> Result<(), Misfit> {
        match (self, value) {
            (Type::Any, _)
            | (Type::Quantity, Value::Number(..))
            | (Type::Bool, Value::Bool(_))
            | (Type::String, Value::Text(_))
            | (Type::Record, Value::Record(_) | Value::Module(_))
            | (Type::Range, Value::Range(_))
            | (Type::Function, Value::Function(_))
            | (Type::Curve, Value::Curve(_))
            | (Type::Surface, Value::Surface(_))
            | (Type::Field, Value::Field(_))
            | (Type::Quantity, Value::Traced(Traced { dimension: Some(_), .. }))
            | (Type::Bool, Value::Traced(Traced { dimension: None, .. }))
            | (Type::Figure, Value::Curve(_) | Value::Surface(_))
            | (Type::Drawing, Value::Drawing(_))
            | (Type::Picture, Value::Picture(_))
            | (Type::Page, Value::Page(_))
            | (Type::Optional(_), Value::Symbol(Symbol::None)) => Ok(()),
            (Type::Optional(inner), value) => inner.check(graph, value),
            (Type::Number(needed), Value::Number(_, found)) => {
                self.check_number(*needed, *found, value)
            }
            (Type::Number(needed), Value::Traced(Traced { dimension: Some(found), .. })) => {
                self.check_number(*needed, *found, value)
            }
            (Type::Count, Value::Number(number, Dimension::BARE)) => {
                self.check_count(*number, value)
            }
            (Type::List(inner), Value::List(list)) => self.check_items(inner, graph, list),
            (Type::List(inner), Value::Range(range)) if range.count() > 0 => {
                inner.check(graph, &range.element(0))
            }
            (Type::List(_), Value::Range(_)) => Ok(()),
            (Type::Solid | Type::Profile | Type::Shape | Type::Figure, value) => {
                self.check_shape(graph, value)
            }
            (Type::Point | Type::Vector, Value::List(list)) => self.check_point(list, value),
            _ => Err(self.misfit(value)),
        }
    }

    fn misfit(&self, value: &Value) -> Misfit {
        Misfit {
            code: Code::WrongKind,
            words: format!("needs {}, got {}", self.words(), shown(value)),
        }
    }

    fn check_number(
        &self,
        needed: Dimension,
        found: Dimension,
        value: &Value,
    ) -> Result<(), Misfit> {
        let takes_bare = matches!(needed, Dimension::LENGTH | Dimension::ANGLE);
        if needed == found || (takes_bare && found == Dimension::BARE) {
            return Ok(());
        }
        Err(Misfit { code: Code::Dimension, ..self.misfit(value) })
    }

    fn check_count(&self, number: f64, value: &Value) -> Result<(), Misfit> {
        /// The whole numbers up to here are exact: 2^53.
        const LARGEST: f64 = 9_007_199_254_740_992.0;
        let whole = number >= 0.0 && number.fract() == 0.0;
        if whole && number <= LARGEST {
            return Ok(());
        }
        let words = match whole {
            true => format!("is at most {LARGEST}, got {value}"),
            false => self.misfit(value).words,
        };
        Err(Misfit { code: Code::OutOfRange, words })
    }

    /// The first length or coordinate in a value of this type that is larger than `reach` mm.
    pub fn beyond(&self, value: &Value, reach: f64) -> Option<f64> {
        match (self, value) {
            (Type::Number(Dimension::LENGTH), Value::Number(number, _)) => {
                (number.abs() > reach).then_some(*number)
            }
            (Type::Point, Value::List(list)) => {
                let length = Type::Number(Dimension::LENGTH);
                list.iter().find_map(|item| length.beyond(item, reach))
            }
            (Type::List(inner), Value::List(list)) if inner.measures() => {
                list.iter().find_map(|item| inner.beyond(item, reach))
            }
            (Type::Optional(inner), value) => inner.beyond(value, reach),
            _ => None,
        }
    }

    /// Whether a value of this type can hold a length that [`beyond`](Type::beyond) sees.
    fn measures(&self) -> bool {
        match self {
            Type::Number(dimension) => *dimension == Dimension::LENGTH,
            Type::Point => true,
            Type::List(inner) | Type::Optional(inner) => inner.measures(),
            _ => false,
        }
    }

    fn check_items(&self, inner: &Type, graph: &ShapeGraph, list: &[Value]) -> Result<(), Misfit> {
        if *inner == Type::Any {
            return Ok(());
        }
        for (i, item) in list.iter().enumerate() {
            inner.check(graph, item).map_err(|misfit| Misfit {
                words: format!("needs {}; element {i} {}", self.words(), misfit.words),
                ..misfit
            })?;
        }
        Ok(())
    }

    fn check_shape(&self, graph: &ShapeGraph, value: &Value) -> Result<(), Misfit> {
        let mut shapes = vec![];
        let found = match value {
            Value::Solid(_) | Value::Profile(_) | Value::List(_) => {
                collect_shapes(value, &mut shapes)
            }
            _ => false,
        };
        let fits = |id: &ShapeId| match (self, graph.kind(*id)) {
            (Type::Shape | Type::Figure, _) => true,
            (Type::Solid, kind) => kind == Kind::Solid,
            (_, kind) => kind == Kind::Profile || is_empty(graph, *id),
        };
        let mixed = |shapes: &[ShapeId]| {
            let mut kinds = shapes.iter().map(|id| graph.kind(*id));
            let first = kinds.next();
            kinds.any(|kind| Some(kind) != first)
        };
        if found && shapes.iter().all(fits) && !mixed(&shapes) {
            return Ok(());
        }
        Err(self.misfit(value))
    }

    fn check_point(&self, list: &[Value], value: &Value) -> Result<(), Misfit> {
        let mut dimension = Dimension::BARE;
        let sized = list.len() == 2 || list.len() == 3;
        let uniform = list.iter().all(|item| match item {
            Value::Number(_, found) | Value::Traced(Traced { dimension: Some(found), .. }) => {
                match dimension.common(*found) {
                    Some(common) => {
                        dimension = common;
                        true
                    }
                    None => false,
                }
            }
            _ => false,
        });
        let lengths = matches!(dimension, Dimension::BARE | Dimension::LENGTH);
        if sized && uniform && (lengths || *self == Type::Vector) {
            return Ok(());
        }
        Err(self.misfit(value))
    }

    /// The value as the type sees it: a bare number beside a length or angle in mm or deg, a list of
    /// shapes as its union. The value must fit.
    pub fn convert(&self, graph: &mut ShapeGraph, value: Value) -> Value {
        match (self, value) {
            (Type::Number(needed), Value::Number(number, Dimension::BARE)) => {
                Value::Number(number, *needed)
            }
            (Type::Number(needed), Value::Traced(traced)) => {
                Value::Traced(Traced { dimension: Some(*needed), ..traced })
            }
            (Type::Optional(inner), value) if !matches!(value, Value::Symbol(Symbol::None)) => {
                inner.convert(graph, value)
            }
            (Type::List(inner), Value::List(list)) if inner.converts() => {
                Value::list(list.iter().map(|item| inner.convert(graph, item.clone())).collect())
            }
            (Type::Solid | Type::Profile | Type::Shape | Type::Figure, list @ Value::List(_)) => {
                self.union(graph, &list)
            }
            (Type::Profile, Value::Solid(id)) if is_empty(graph, id) => {
                let origin = graph.origin(id);
                Value::Profile(graph.add(Node::Empty(Kind::Profile), origin))
            }
            (Type::Point, Value::List(list)) => {
                let lengths = list.iter().map(|item| match item {
                    Value::Number(number, _) => Value::length(*number),
                    Value::Traced(Traced { step, .. }) => {
                        let dimension = Some(Dimension::LENGTH);
                        Value::Traced(Traced { step: *step, dimension })
                    }
                    other => other.clone(),
                });
                Value::list(lengths.collect())
            }
            (_, value) => value,
        }
    }

    fn converts(&self) -> bool {
        match self {
            Type::Number(needed) => *needed != Dimension::BARE,
            Type::Solid | Type::Profile | Type::Shape | Type::Figure | Type::Point => true,
            Type::List(inner) | Type::Optional(inner) => inner.converts(),
            _ => false,
        }
    }

    fn union(&self, graph: &mut ShapeGraph, list: &Value) -> Value {
        let mut shapes = vec![];
        collect_shapes(list, &mut shapes);
        let kind = match (self, shapes.first()) {
            (Type::Profile, _) => Kind::Profile,
            (_, Some(id)) => graph.kind(*id),
            _ => Kind::Solid,
        };
        let origin = shapes.first().map(|id| graph.origin(*id)).unwrap_or_default();
        let id = match shapes[..] {
            [] => graph.add(Node::Empty(kind), origin),
            [one] => one,
            _ => graph.add(Node::Union(shapes.into()), origin),
        };
        match kind {
            Kind::Solid => Value::Solid(id),
            Kind::Profile => Value::Profile(id),
        }
    }

    /// In plain words with an article.
    pub fn words(&self) -> String {
        match self {
            Type::Any => "any value".into(),
            Type::Number(dimension) => dimension.words(),
            Type::Quantity => "a number".into(),
            Type::Count => "a whole number, 0 or more".into(),
            Type::Bool => "a truth value".into(),
            Type::String => "a string".into(),
            Type::List(inner) if **inner == Type::Any => "a list".into(),
            Type::List(inner) => format!("a list, each element {}", inner.words()),
            Type::Record => "a record".into(),
            Type::Range => "a range".into(),
            Type::Function => "a function".into(),
            Type::Solid => "a solid".into(),
            Type::Profile => "a profile".into(),
            Type::Shape => "a solid or a profile".into(),
            Type::Curve => "a curve".into(),
            Type::Surface => "a surface".into(),
            Type::Field => "a field".into(),
            Type::Figure => "a solid, profile, curve or surface".into(),
            Type::Drawing => "a drawing".into(),
            Type::Picture => "a picture".into(),
            Type::Page => "a page".into(),
            Type::Optional(inner) => inner.words(),
            Type::Point => "a point (two or three lengths)".into(),
            Type::Vector => "a vector (two or three numbers)".into(),
        }
    }
}

fn is_empty(graph: &ShapeGraph, id: ShapeId) -> bool {
    matches!(graph.node(id), Node::Empty(_))
}

/// Gathers the shapes of a value, lists opened at every level; false when something else is among
/// them. A list that is met again is not opened again: to a set operation it adds nothing.
pub fn collect_shapes(value: &Value, shapes: &mut Vec<ShapeId>) -> bool {
    let mut opened = FxHashSet::default();
    let mut pending = vec![(value.clone(), 0)];
    while let Some((value, index)) = pending.pop() {
        match &value {
            Value::Solid(id) | Value::Profile(id) => shapes.push(*id),
            Value::List(list) if index > 0 || opened.insert(Arc::as_ptr(list)) => {
                if let Some(item) = list.get(index).cloned() {
                    pending.push((value, index + 1));
                    pending.push((item, 0));
                }
            }
            Value::List(_) => {}
            _ => return false,
        }
    }
    true
}

/// A value with its kind: `30deg (an angle)`.
pub fn shown(value: &Value) -> String {
    match value {
        Value::Number(..) => format!("`{value}` ({})", value.words()),
        Value::Text(text) if text.len() <= 40 => format!("the string {text:?}", text = &***text),
        Value::List(_) => {
            let text = value.to_string();
            if text.len() <= 60 { format!("the list {text}") } else { "a list".into() }
        }
        value => value.words(),
    }
}

fn unknown_type(name: &str, written: &ast::Type) -> Diagnostic {
    let message = format!("there is no type `{name}`");
    let found = Diagnostic::error(Code::UnknownName, message).label(written.name.span, "");
    match did_you_mean(name, NAMES.iter().copied()) {
        Some((help, first)) => found.help(help).fix(written.name.span, first),
        None => found.help(format!("the types are {}", NAMES.join(", "))),
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Type::Number(Dimension::BARE) => "Number",
            Type::Number(Dimension::LENGTH) => "Length",
            Type::Number(Dimension::ANGLE) => "Angle",
            Type::Number(Dimension::AREA) => "Area",
            Type::Number(_) => "Volume",
            Type::List(inner) if **inner == Type::Any => "List",
            Type::List(inner) => return write!(f, "List[{inner}]"),
            Type::Optional(inner) => return write!(f, "{inner}"),
            Type::Any => "Any",
            Type::Quantity => "Quantity",
            Type::Count => "Count",
            Type::Bool => "Bool",
            Type::String => "String",
            Type::Record => "Record",
            Type::Range => "Range",
            Type::Function => "Function",
            Type::Solid => "Solid",
            Type::Profile => "Profile",
            Type::Shape => "Shape",
            Type::Curve => "Curve",
            Type::Surface => "Surface",
            Type::Field => "Field",
            Type::Figure => "Figure",
            Type::Drawing => "Drawing",
            Type::Picture => "Picture",
            Type::Page => "Page",
            Type::Point => "Point",
            Type::Vector => "Vector",
        };
        f.write_str(name)
    }
}
