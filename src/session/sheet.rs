//! From what a model says of a page to ink on it.

use super::drafting::{Drafter, Letterer};
use crate::{
    base::{Code, Diagnostic, Phase},
    output::{
        drawing::View,
        sheet::{self, Misfit, Page, Placing, Sheet, Spot, Title, scale_text},
    },
    shape::{
        PageSpec, ViewSpec,
        drawing::{Placed, Position, Projection, TitleSpec},
    },
};

/// A page with its views drawn, and warnings. Fails with all reasons why it cannot be made.
pub fn page(
    drafter: &Drafter,
    name: &str,
    spec: &PageSpec,
) -> Result<(Page, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (mut drawn, mut warnings, mut errors) = (vec![], vec![], vec![]);
    for placed in &spec.views {
        match drafter.draw(&placed.view) {
            Ok(view) => {
                warnings.extend(view.warnings.clone());
                drawn.push(view);
            }
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let placings = spec.views.iter().zip(&drawn).map(|(placed, view)| Placing {
        figure: &view.figure,
        name: String::new(),
        direction: direction(&placed.view),
        spot: match placed.position {
            Position::At(at) => Spot::At(at),
            Position::Beside { other, gap } => Spot::Beside { other, gap },
        },
        scale: placed.scale.unwrap_or(spec.scale),
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

/// The usual direction of a view.
fn direction(view: &ViewSpec) -> Option<View> {
    match view.projection {
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
    Diagnostic::error(Code::OutOfRange, misfit.to_string()).label(span, "").help(help)
}
