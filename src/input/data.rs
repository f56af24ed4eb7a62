//! JSON and CSV: plain values.

use std::{collections::BTreeSet, fmt};

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};

use super::{
    Place, ReadError,
    error::{Format, shortened},
};

const JSON: Format = Format("JSON");
const CSV: Format = Format("CSV");

/// A plain value.
#[derive(Clone, PartialEq, Debug)]
pub enum Data {
    /// JSON `null`.
    Null,
    /// A truth value.
    Bool(bool),
    /// A number, finite.
    Number(f64),
    /// A string.
    Text(String),
    /// A list.
    List(Vec<Data>),
    /// A record, in the order of the file; no name occurs twice.
    Record(Vec<(String, Data)>),
}

/// The value of a JSON file.
///
/// # Errors
/// Broken syntax, numbers beyond the range of a float, a name given twice in one record, nesting deeper
/// than 128.
///
/// ```
/// use katachi::input::{Data, data::read_json};
/// assert_eq!(read_json(b"[1, true]").unwrap(), Data::List(vec![Data::Number(1.0), Data::Bool(true)]));
/// ```
pub fn read_json(bytes: &[u8]) -> Result<Data, ReadError> {
    serde_json::from_str(JSON.text(bytes)?).map_err(|error| {
        let found = error.to_string();
        let found = found.split(" at line ").next().unwrap_or_default().to_string();
        let needed = format!("well-formed JSON is needed (column {})", error.column());
        JSON.error(Place::Line(error.line()), found, needed)
    })
}

impl<'de> Deserialize<'de> for Data {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Data, D::Error> {
        deserializer.deserialize_any(DataVisitor)
    }
}

struct DataVisitor;

impl<'de> Visitor<'de> for DataVisitor {
    type Value = Data;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_unit<E: Error>(self) -> Result<Data, E> {
        Ok(Data::Null)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Data, E> {
        Ok(Data::Bool(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Data, E> {
        Ok(Data::Number(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Data, E> {
        Ok(Data::Number(value as f64))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Data, E> {
        if value.is_finite() {
            Ok(Data::Number(value))
        } else {
            Err(E::custom("number out of range"))
        }
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Data, E> {
        Ok(Data::Text(value.to_string()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Data, A::Error> {
        let mut values = vec![];
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        Ok(Data::List(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Data, A::Error> {
        let (mut fields, mut names) = (vec![], BTreeSet::new());
        while let Some((name, value)) = map.next_entry::<String, Data>()? {
            if !names.insert(name.clone()) {
                return Err(A::Error::custom(format!(
                    "the name \"{}\" for the second time",
                    shortened(&name)
                )));
            }
            fields.push((name, value));
        }
        Ok(Data::Record(fields))
    }
}

/// The rows of a CSV file as records named by its first line. Cells that read as finite numbers
/// are numbers, others are text.
///
/// # Errors
/// No first line, a name that is empty or given twice, a row that is longer or shorter than the first line, bytes
/// that are no UTF-8.
///
/// ```
/// use katachi::input::{Data, data::read_csv};
/// let Data::List(rows) = read_csv(b"d,name\n5,M5\n").unwrap() else { unreachable!() };
/// let Data::Record(row) = &rows[0] else { unreachable!() };
/// assert_eq!(row[0], ("d".to_string(), Data::Number(5.0)));
/// ```
pub fn read_csv(bytes: &[u8]) -> Result<Data, ReadError> {
    let text = CSV.text(bytes)?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let names: Vec<String> = match reader.headers() {
        Ok(names) => names.iter().map(String::from).collect(),
        Err(error) => return Err(broken(&error)),
    };
    let mut seen = BTreeSet::new();
    if let Some(bad) = names.iter().find(|n| n.is_empty() || !seen.insert(n.as_str())) {
        let found = format!("the column name \"{}\"", shortened(bad));
        return Err(CSV.error(Place::Line(1), found, "the first line names each column once"));
    }
    if names.is_empty() {
        return Err(CSV.error(Place::File, "no lines", "the first line names the columns"));
    }
    let rows = reader.records().map(|row| {
        let row = row.map_err(|error| broken(&error))?;
        let fields = names.iter().cloned().zip(row.iter().map(cell));
        Ok(Data::Record(fields.collect()))
    });
    Ok(Data::List(rows.collect::<Result<_, _>>()?))
}

fn cell(word: &str) -> Data {
    let number = word.parse::<f64>().ok().filter(|v| v.is_finite());
    number.map_or_else(|| Data::Text(word.to_string()), Data::Number)
}

fn broken(error: &csv::Error) -> ReadError {
    let place = error.position().map_or(Place::File, |p| Place::Line(p.line() as usize));
    if let csv::ErrorKind::UnequalLengths { expected_len, len, .. } = error.kind() {
        let needed = format!("the first line names {expected_len} columns");
        return CSV.error(place, format!("a row of {len} cells"), needed);
    }
    CSV.error(place, error.to_string(), "comma-separated rows are needed")
}
