//! `katachi measure`: numbers about parts.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::{Exit, args::Measure, desk::Desk, fail};
use crate::{
    app::render::Style,
    session::{Lines, Measures},
};

/// Prints the measures of every part that can be made, and reports.
pub fn run(arguments: &Measure, style: Style) -> io::Result<Exit> {
    let desk = match Desk::open(&arguments.model, Some(&arguments.making), style) {
        Ok(desk) => desk,
        Err(words) => return fail(style, Exit::Usage, words),
    };
    let session = desk.session();
    let (mut model, mut diagnostics) = match desk.compile_asked(&session, &arguments.part) {
        Ok(compiled) => compiled,
        Err(diagnostics) => return desk.report(&session, &diagnostics),
    };
    let measured = model.measure(&arguments.part);
    diagnostics.extend(measured.diagnostics);
    desk.watch().end_bar();
    let mut out = io::stdout().lock();
    if arguments.json {
        let parts = measured.found.iter().map(|(name, m)| (name.clone(), object(m)));
        let parts: Map<String, Value> = parts.collect();
        let views = measured.views.iter().map(|(name, lines)| (name.clone(), lines_object(lines)));
        let views: Map<String, Value> = views.collect();
        writeln!(out, "{:#}", json!({ "parts": parts, "views": views }))?;
    } else {
        for (name, measures) in &measured.found {
            write!(out, "{}", table(name, measures))?;
        }
        for (name, lines) in &measured.views {
            write!(out, "{}", lines_table(name, lines))?;
        }
    }
    desk.report(&session, &diagnostics)
}

/// Measures as the language's command line describes them. An empty part has no `bbox`.
fn object(m: &Measures) -> Value {
    json!({
        "volume": m.volume,
        "area": m.area,
        "bbox": m.bounds.map(|corners| corners.map(|c| c.to_array())),
        "centroid": m.centroid.to_array(),
        "triangles": m.triangles,
        "euler": m.euler,
        "genus": m.genus(),
        "shells": m.shells,
        "closed": m.closed,
    })
}

/// Measures of a view as the language's command line describes them.
fn lines_object(lines: &Lines) -> Value {
    json!({ "visible": lines.visible, "hidden": lines.hidden, "segments": lines.segments })
}

/// Measures of a view for people.
fn lines_table(name: &str, lines: &Lines) -> String {
    let (visible, hidden) = (short(lines.visible), short(lines.hidden));
    let segments = lines.segments;
    format!(
        "{name}\n  visible    {visible} mm\n  hidden     {hidden} mm\n  segments   {segments}\n"
    )
}

/// Measures for people.
fn table(name: &str, m: &Measures) -> String {
    let [x, y, z] = m.centroid.to_array().map(short);
    let mut lines = vec![
        format!("{name}"),
        format!("  volume     {} mm^3", short(m.volume)),
        format!("  area       {} mm^2", short(m.area)),
    ];
    if let Some([low, high]) = m.bounds {
        let size = (high - low).to_array().map(short).join(" x ");
        let corner = |c: glam::DVec3| format!("[{}]", c.to_array().map(short).join(", "));
        lines.push(format!("  size       {size} mm, from {} to {}", corner(low), corner(high)));
    }
    lines.push(format!("  centroid   [{x}, {y}, {z}] mm"));
    lines.push(format!("  triangles  {}", m.triangles));
    let closed = if m.closed { "closed" } else { "open" };
    let (shells, genus) = (m.shells, m.genus());
    lines.push(format!("  boundary   {closed}, shells {shells}, genus {genus}, euler {}", m.euler));
    lines.join("\n") + "\n"
}

/// At most four decimals, none that say nothing.
fn short(x: f64) -> String {
    format!("{}", (x * 1e4).round() / 1e4 + 0.0)
}
