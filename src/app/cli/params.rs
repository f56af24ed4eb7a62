//! `katachi params`: what may be set from outside.

use std::io::{self, Write};

use serde_json::{Value as Json, json};

use super::{Exit, args::Params, desk::Desk, fail};
use crate::{
    app::render::Style,
    session::{Domain, ParamInfo, to_json},
};

/// Prints the parameters and reports.
pub fn run(arguments: &Params, style: Style) -> io::Result<Exit> {
    let desk = match Desk::open(&arguments.model, None, style) {
        Ok(desk) => desk,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = desk.compile(&session);
    let (params, more) = model.params();
    diagnostics.extend(more);
    let mut out = io::stdout().lock();
    if arguments.json {
        let params: Vec<Json> = params.iter().map(object).collect();
        writeln!(out, "{:#}", json!({ "params": params }))?;
    } else {
        write!(out, "{}", list(&params))?;
    }
    desk.report(&session, &diagnostics)
}

/// One parameter; lengths in millimetres, angles in degrees.
fn object(param: &ParamInfo) -> Json {
    let mut object = json!({
        "name": &*param.name,
        "doc": param.doc.as_deref(),
        "group": param.group.as_deref(),
        "type": param.kind,
        "default": param.default.as_ref().map(to_json),
        "value": param.value.as_ref().map(to_json),
        "active": param.active,
    });
    match &param.domain {
        Domain::Any => {}
        Domain::Range { min, max, step } => {
            object["min"] = to_json(min);
            object["max"] = to_json(max);
            object["step"] = step.as_ref().map_or(Json::Null, to_json);
        }
        Domain::Choices(choices) => object["choices"] = choices.iter().map(to_json).collect(),
    }
    object
}

/// All parameters for people: three columns, under their groups' titles.
fn list(params: &[ParamInfo]) -> String {
    let rows: Vec<[String; 3]> = params.iter().map(row).collect();
    let width = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count());
        widths.filter(|&width| width <= WIDEST).max().unwrap_or(0)
    };
    let widths = [width(0), width(1)];
    let mut text = String::new();
    let mut group = None;
    for (param, row) in params.iter().zip(&rows) {
        if param.group != group {
            group = param.group.clone();
            let gap = if text.is_empty() { "" } else { "\n" };
            text += &format!("{gap}{}\n", group.as_deref().unwrap_or("Others"));
        }
        text += &lines(row, widths);
    }
    text
}

/// A column is no wider than this; a longer cell pushes those after it to the right.
const WIDEST: usize = 36;

/// Name and value, what is allowed, what the model says about it.
fn row(param: &ParamInfo) -> [String; 3] {
    let value = param.value.as_ref().map_or_else(|| "?".to_string(), |v| v.literal().to_string());
    let domain = match &param.domain {
        Domain::Any => String::new(),
        Domain::Range { min, max, step: None } => format!("in {min}..{max}"),
        Domain::Range { min, max, step: Some(step) } => format!("in {min}..{max} step {step}"),
        Domain::Choices(choices) => {
            let choices: Vec<String> = choices.iter().map(|c| c.literal().to_string()).collect();
            format!("in [{}]", choices.join(", "))
        }
    };
    let active = if param.active { "" } else { "(not used now) " };
    let doc = param.doc.as_deref().unwrap_or_default();
    [format!("{} = {value}", param.name), domain, format!("{active}{doc}")]
}

/// The lines of one parameter; further lines of its doc stand under the first.
fn lines([name, domain, doc]: &[String; 3], [first, second]: [usize; 2]) -> String {
    let head = format!("  {name:first$}  {domain:second$}");
    let margin = " ".repeat(2 + first + 2 + second);
    let mut doc = doc.lines();
    let mut text = format!("{head}  {}", doc.next().unwrap_or_default()).trim_end().to_string();
    for line in doc {
        text += &format!("\n{margin}  {}", line.trim());
    }
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        base::{Shelf, watch::Unwatched},
        session::Session,
    };

    #[test]
    fn people_see_columns_under_titles() {
        let model = "group \"Size\"\n/// Overall width\n/// of the lid\nparam width = 60mm in 20mm..120mm step 1mm\n\
                     group \"Looks\"\nparam style = \"lip\" in [\"lip\", \"flat\"]\nparam deep = true\n";
        let shelf = Shelf(&[("a.kata", model)]);
        let session = Session::new(&shelf, &Unwatched, None);
        let (mut model, _) = session.compile("a.kata", &[]);
        let expected = "Size
  width = 60mm   in 20mm..120mm step 1mm  Overall width
                                          of the lid

Looks
  style = \"lip\"  in [\"lip\", \"flat\"]
  deep = true
";
        assert_eq!(list(&model.params().0), expected);
    }
}
