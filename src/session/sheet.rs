//! From what a model says of a page to ink on it.

use std::sync::Arc;

use super::drafting::{Drafter, Drawn, Letterer};
use crate::{
    base::{Code, Diagnostic, Phase},
    output::{
        drawing::View,
        sheet::{
            self, Misfit, Page, Placing, Print, Sheet, Spot, Subject as Ink, Title, scale_text,
        },
    },
    shape::{
        PageSpec,
        drawing::{Placed, Position, Projection, Subject, TitleSpec},
    },
};

/// What stands on a page, made.
enum Made {
    View(Arc<Drawn>),
    Shade(Print),
}

/// A page with its views drawn, and warnings. Fails with all reasons why it cannot be made.
pub fn page(
    drafter: &Drafter,
    name: &str,
    spec: &PageSpec,
) -> Result<(Page, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (mut made, mut warnings, mut errors) = (vec![], vec![], vec![]);
    let scales = scales(spec);
    for (placed, scale) in spec.views.iter().zip(&scales) {
        match make(drafter, placed, *scale) {
            Ok((found, said)) => {
                warnings.extend(said);
                made.push(found);
            }
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let placings =
        spec.views.iter().zip(&made).zip(scales).map(|((placed, made), scale)| Placing {
            subject: match made {
                Made::View(drawn) => Ink::Figure(&drawn.figure),
                Made::Shade(print) => Ink::Print(print),
            },
            name: String::new(),
            direction: direction(placed.subject.projection()),
            spot: match placed.position {
                Position::At(at) => Spot::At(at),
                Position::Beside { other, gap } => Spot::Beside { other, gap },
            },
            scale,
        });
    let placings: Vec<Placing> = placings.collect();
    let sheet = Sheet {
        size: spec.size,
        name: name.into(),
        first_angle: spec.first_angle,
        frame: spec.frame,
        title: spec.title.as_ref().map(|title| block(title, spec)),
    };
    let (page, misfits) =
        drafter.timed(Phase::Drawings, || sheet::arrange(&sheet, &placings, &Letterer));
    if misfits.is_empty() {
        return Ok((page, warnings));
    }
    Err(misfits.iter().map(|misfit| told(misfit, spec)).collect())
}

/// The title block: the fields of the model, then those that follow from the page.
fn block(title: &TitleSpec, spec: &PageSpec) -> Title {
    let mut fields: Vec<(String, String)> =
        title.fields.iter().map(|(name, text)| (name.to_string(), text.to_string())).collect();
    fields.push(("scale".into(), scale_text(spec.scale)));
    fields.push((
        "size".into(),
        match &spec.name {
            Some(name) => name.to_string(),
            None => format!("{} x {}", spec.size.x, spec.size.y),
        },
    ));
    Title { title: title.title.to_string(), fields }
}

/// Paper over model of what stands on a page: its own, that of the page, or that of what it stands beside.
fn scales(spec: &PageSpec) -> Vec<f64> {
    let mut scales: Vec<f64> = vec![];
    for placed in &spec.views {
        scales.push(match placed.position {
            Position::At(_) => placed.scale.unwrap_or(spec.scale),
            Position::Beside { other, .. } => scales.get(other).copied().unwrap_or(spec.scale),
        });
    }
    scales
}

/// A view drawn, or a picture made for its scale, and warnings.
fn make(
    drafter: &Drafter,
    placed: &Placed,
    scale: f64,
) -> Result<(Made, Vec<Diagnostic>), Diagnostic> {
    match &placed.subject {
        Subject::View(view) => {
            let drawn = drafter.draw(view)?;
            let warnings = drawn.warnings.clone();
            Ok((Made::View(drawn), warnings))
        }
        Subject::Shade(shade) => {
            let (halftone, warnings) = drafter.shade(shade, scale)?;
            Ok((Made::Shade(halftone.print()), warnings))
        }
    }
}

/// The side that a projection is from.
fn direction(projection: Projection) -> Option<View> {
    match projection {
        Projection::Side(side) => Some(side),
        _ => None,
    }
}

/// The diagnostic for what does not fit.
fn told(misfit: &Misfit, spec: &PageSpec) -> Diagnostic {
    let place = |view: usize| spec.views.get(view).map_or(spec.place.0, |p: &Placed| p.place.0);
    let (span, help) = match misfit {
        Misfit::NoRoom(_) => (spec.place.0, "take larger paper, or `frame = false`"),
        Misfit::Overflow { view, .. } => {
            (place(*view), "take larger paper, a smaller `scale`, or another place")
        }
        Misfit::OnTitle { view, .. } => (place(*view), "move the view up or take larger paper"),
        Misfit::NotBeside { view } => {
            (place(*view), "FRONT has TOP, BOTTOM, LEFT and RIGHT beside it; others take `at =`")
        }
    };
    let words = match misfit {
        Misfit::Overflow { view, .. } | Misfit::OnTitle { view, .. } if is_picture(*view, spec) => {
            misfit.to_string().replacen("the view", "the picture", 1)
        }
        _ => misfit.to_string(),
    };
    Diagnostic::error(Code::OutOfRange, words).label(span, "").help(help)
}

fn is_picture(view: usize, spec: &PageSpec) -> bool {
    spec.views.get(view).is_some_and(|placed| matches!(placed.subject, Subject::Shade(_)))
}
