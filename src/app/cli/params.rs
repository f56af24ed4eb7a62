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
    let (mut model, mut diagnostics) = session.compile(&desk.entry, &desk.given);
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

/// All parameters for people, under their groups' titles.
fn list(params: &[ParamInfo]) -> String {
    let mut text = String::new();
    let mut group = None;
    for param in params {
        if param.group != group {
            group = param.group.clone();
            text += &format!("{}\n", group.as_deref().unwrap_or(""));
        }
        text += &line(param);
    }
    text
}

fn line(param: &ParamInfo) -> String {
    let value = param.value.as_ref().map_or_else(|| "?".to_string(), ToString::to_string);
    let domain = match &param.domain {
        Domain::Any => String::new(),
        Domain::Range { min, max, step: None } => format!(" in {min}..{max}"),
        Domain::Range { min, max, step: Some(step) } => format!(" in {min}..{max} step {step}"),
        Domain::Choices(choices) => {
            let choices: Vec<String> = choices.iter().map(ToString::to_string).collect();
            format!(" in [{}]", choices.join(", "))
        }
    };
    let active = if param.active { "" } else { " (not used now)" };
    let doc =
        param.doc.as_deref().map_or(String::new(), |doc| format!("  {}", doc.replace('\n', " ")));
    format!("  {} = {value}{domain}{active}{doc}\n", param.name)
}
