//! JSON in and out of the language's values.

use serde_json::{Map, Value as Json};

use crate::{eval::Value, shape::geometry::Data};

/// A JSON value as plain data.
pub fn from_json(json: &Json) -> Data {
    match json {
        Json::Null => Data::Null,
        Json::Bool(truth) => Data::Bool(*truth),
        Json::Number(number) => Data::Number(number.as_f64().unwrap_or(f64::NAN)),
        Json::String(text) => Data::Text(text.as_str().into()),
        Json::Array(items) => Data::List(items.iter().map(from_json).collect()),
        Json::Object(fields) => {
            let field = |(key, value): (&String, &Json)| (key.as_str().into(), from_json(value));
            Data::Record(fields.iter().map(field).collect())
        }
    }
}

/// A value as JSON: lengths in millimetres, angles in degrees, what JSON has no word for as the text
/// the language prints.
pub fn to_json(value: &Value) -> Json {
    match value {
        Value::Bool(truth) => Json::from(*truth),
        Value::Number(number, _) => Json::from(*number),
        Value::List(list) => list.iter().map(to_json).collect(),
        Value::Record(record) => {
            let fields = record.fields().iter();
            let fields: Map<_, _> = fields.map(|(k, v)| (k.to_string(), to_json(v))).collect();
            Json::Object(fields)
        }
        other => Json::from(other.to_string()),
    }
}
