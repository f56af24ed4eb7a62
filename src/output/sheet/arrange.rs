//! Views on a page: where each stands, and whether all find room.

use glam::{DVec2, dvec2};
use thiserror::Error;

use super::{
    Figure, Print, Title, frame,
    lettering::Lettering,
    page::{Group, Ink, Page, bounds, moved},
    pen::Style,
};
use crate::output::drawing::View;

/// Where a view is wanted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Spot {
    /// Its middle there, mm from the lower left corner of the paper.
    At(DVec2),
    /// Beside an earlier view, in line with it.
    Beside {
        /// Number of the other view.
        other: usize,
        /// Free paper between them, mm.
        gap: f64,
    },
}

/// What is put on a page.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'a> {
    /// A drawing.
    Figure(&'a Figure),
    /// A half-tone, made for the scale that it is placed at.
    Print(&'a Print),
}

/// A view to be put on a page.
#[derive(Clone, Debug)]
pub struct Placing<'a> {
    /// The view or picture.
    pub subject: Subject<'a>,
    /// What it is called; may be empty.
    pub name: String,
    /// From which side it is taken, if it is one of the usual views.
    pub direction: Option<View>,
    /// Where.
    pub spot: Spot,
    /// Paper over model; a view beside another takes that one's.
    pub scale: f64,
}

/// A page to be filled.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Width and height, mm.
    pub size: DVec2,
    /// What the file is called.
    pub name: String,
    /// Whether the view from above stands below.
    pub first_angle: bool,
    /// Whether there is a frame.
    pub frame: bool,
    /// The title block.
    pub title: Option<Title>,
}

/// Why views do not fit a page.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum Misfit {
    /// The paper is smaller than its borders.
    #[error("a page of {} x {} mm is smaller than its borders", .0.x, .0.y)]
    NoRoom(DVec2),
    /// A view does not stay on the page.
    #[error("the view leaves the {area} by {by:.1} mm at the {side}")]
    Overflow {
        /// Number of the view.
        view: usize,
        /// What it leaves: page or frame.
        area: &'static str,
        /// Where it leaves most.
        side: &'static str,
        /// By how much, mm.
        by: f64,
    },
    /// A view covers the title block.
    #[error("the view covers the title block by {width:.1} x {height:.1} mm")]
    OnTitle {
        /// Number of the view.
        view: usize,
        /// Of the part in common, mm.
        width: f64,
        /// Of the part in common, mm.
        height: f64,
    },
    /// Views that have no place beside one another.
    #[error("a view has a place beside another only when both are seen along neighbouring axes")]
    NotBeside {
        /// Number of the view.
        view: usize,
    },
}

/// A view that has its place.
struct Standing {
    inks: Vec<Ink>,
    /// Where the origin of the drawing is.
    origin: DVec2,
    scale: f64,
    min: DVec2,
    max: DVec2,
}

/// Puts views on a page. What does not fit is told, and the page made all the same.
pub fn arrange(
    sheet: &Sheet,
    placings: &[Placing],
    lettering: &dyn Lettering,
) -> (Page, Vec<Misfit>) {
    let mut misfits = vec![];
    let mut groups = vec![];
    let area =
        if sheet.frame { frame::drawing_area(sheet.size) } else { Some((DVec2::ZERO, sheet.size)) };
    let Some(area) = area else {
        let page = Page { size: sheet.size, title: sheet.name.clone(), groups };
        return (page, vec![Misfit::NoRoom(sheet.size)]);
    };
    let block = sheet.title.as_ref().map(|title| {
        let size = frame::block_size(area.1.x - area.0.x, title.fields.len());
        (dvec2(area.1.x - size.x, area.0.y), dvec2(area.1.x, area.0.y + size.y))
    });
    let mut standing: Vec<Option<Standing>> = vec![];
    for (number, placing) in placings.iter().enumerate() {
        let Some(found) = stand(placing, placings, &standing, sheet.first_angle, lettering) else {
            misfits.push(Misfit::NotBeside { view: number });
            standing.push(None);
            continue;
        };
        let name = if sheet.frame { "frame" } else { "page" };
        misfits.extend(overflow(number, &found, area, name));
        misfits.extend(block.and_then(|block| on_title(number, &found, block)));
        standing.push(Some(found));
    }
    for (placing, found) in placings.iter().zip(standing) {
        let Some(Standing { inks, scale, min, max, .. }) = found else { continue };
        let data = vec![("scale", scale_text(scale))];
        let (style, clip) = match placing.subject {
            Subject::Figure(figure) => (figure.style.clone(), None),
            Subject::Print(print) => (print.style.clone(), Some((min, max))),
        };
        groups.push(Group { name: placing.name.clone(), data, style, clip, inks });
    }
    let border = border(sheet, area, lettering);
    if !border.is_empty() {
        let style = Style::default();
        groups.push(Group { name: "frame".into(), data: vec![], style, clip: None, inks: border });
    }
    (Page { size: sheet.size, title: sheet.name.clone(), groups }, misfits)
}

fn border(sheet: &Sheet, area: (DVec2, DVec2), lettering: &dyn Lettering) -> Vec<Ink> {
    let mut inks = if sheet.frame { frame::frame(area, sheet.size) } else { vec![] };
    if let Some(title) = &sheet.title {
        let corner = dvec2(area.1.x, area.0.y);
        let width = area.1.x - area.0.x;
        inks.extend(frame::title_block(title, corner, width, sheet.first_angle, lettering));
    }
    inks
}

/// A scale as it is written: `1:2`.
///
/// ```
/// use katachi::output::sheet::scale_text;
/// assert_eq!([1.0, 0.5, 0.2, 2.0, 0.75].map(scale_text), ["1:1", "1:2", "1:5", "2:1", "0.75:1"]);
/// ```
pub fn scale_text(scale: f64) -> String {
    let whole = |x: f64| (x - x.round()).abs() < 1e-9 * x && x.round() >= 1.0;
    if !whole(scale) && whole(1.0 / scale) {
        format!("1:{}", (1.0 / scale).round())
    } else {
        let digits = (scale * 1e4).round() / 1e4;
        format!("{digits}:1")
    }
}

/// Finds the place of a view; `None` when it has none beside the other.
fn stand(
    placing: &Placing,
    placings: &[Placing],
    standing: &[Option<Standing>],
    first_angle: bool,
    lettering: &dyn Lettering,
) -> Option<Standing> {
    let other = match placing.spot {
        Spot::At(_) => None,
        Spot::Beside { other, .. } => Some(standing.get(other)?.as_ref()?),
    };
    let scale = other.map_or(placing.scale, |other| other.scale);
    let (inks, (low, high)) = match placing.subject {
        Subject::Figure(figure) => {
            let inks = figure.inks(scale, lettering);
            let reach = bounds(&inks).unwrap_or_default();
            (inks, reach)
        }
        Subject::Print(print) => (print.inks.clone(), (print.min, print.max)),
    };
    let origin = match placing.spot {
        Spot::At(at) => at - (low + high) / 2.0,
        Spot::Beside { other: number, gap } => {
            let toward = neighbour(placings[number].direction?, placing.direction?)?;
            let toward = if first_angle { -toward } else { toward };
            let other = other?;
            let x = match toward.x {
                x if x > 0.0 => other.max.x + gap - low.x,
                x if x < 0.0 => other.min.x - gap - high.x,
                _ => other.origin.x,
            };
            let y = match toward.y {
                y if y > 0.0 => other.max.y + gap - low.y,
                y if y < 0.0 => other.min.y - gap - high.y,
                _ => other.origin.y,
            };
            dvec2(x, y)
        }
    };
    let inks = inks.iter().map(|ink| moved(ink, origin)).collect();
    Some(Standing { inks, origin, scale, min: low + origin, max: high + origin })
}

/// On which side of a view another one stands in third-angle projection, when both unfold in line.
fn neighbour(of: View, view: View) -> Option<DVec2> {
    use View::{Back, Bottom, Front, Left, Right, Top};
    const LEFT: DVec2 = DVec2::NEG_X;
    const RIGHT: DVec2 = DVec2::X;
    Some(match (of, view) {
        (Front, Top) | (Bottom, Front) => DVec2::Y,
        (Front, Bottom) | (Top, Front) => DVec2::NEG_Y,
        (Front, Right) | (Right, Back) | (Back, Left) | (Left, Front) => RIGHT,
        (Front, Left) | (Left, Back) | (Back, Right) | (Right, Front) => LEFT,
        _ => return None,
    })
}

/// How far a view leaves an area, at the side where it does most.
fn overflow(
    view: usize,
    found: &Standing,
    (min, max): (DVec2, DVec2),
    area: &'static str,
) -> Option<Misfit> {
    let sides = [
        ("left", min.x - found.min.x),
        ("right", found.max.x - max.x),
        ("bottom", min.y - found.min.y),
        ("top", found.max.y - max.y),
    ];
    let (side, by) = sides.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (by > ROUNDING).then_some(Misfit::Overflow { view, area, side, by })
}

/// Less than this is rounding, mm: far below the width of a line.
const ROUNDING: f64 = 1e-6;

fn on_title(view: usize, found: &Standing, block: (DVec2, DVec2)) -> Option<Misfit> {
    let common = found.max.min(block.1) - found.min.max(block.0);
    (common.min_element() > ROUNDING).then_some(Misfit::OnTitle {
        view,
        width: common.x,
        height: common.y,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{
        drawing::{Class, Drawing, Kind, Line, Path, Segment},
        sheet::Unlettered,
    };

    fn figure(w: f64, h: f64) -> Figure {
        let corners = [dvec2(w, 0.0), dvec2(w, h), DVec2::ZERO];
        let segments = corners.map(|to| Segment::Line { to }).to_vec();
        let path = Path { start: DVec2::ZERO, segments };
        let line = Line { class: Class::Visible, kind: Kind::Sharp, id: 0, order: 0, path };
        Figure { drawing: Drawing { lines: vec![line], ..Drawing::default() }, ..Figure::default() }
    }

    fn sheet(first_angle: bool) -> Sheet {
        let size = dvec2(210.0, 297.0);
        Sheet { size, name: "s".into(), first_angle, frame: true, title: None }
    }

    fn placing(figure: &Figure, direction: View, spot: Spot) -> Placing<'_> {
        let subject = Subject::Figure(figure);
        Placing { subject, name: String::new(), direction: Some(direction), spot, scale: 1.0 }
    }

    #[test]
    fn the_view_from_above_stands_below_in_first_angle() {
        let (front, top) = (figure(40.0, 20.0), figure(40.0, 30.0));
        let views = [
            placing(&front, View::Front, Spot::At(dvec2(100.0, 150.0))),
            placing(&top, View::Top, Spot::Beside { other: 0, gap: 10.0 }),
        ];
        let lowest = |first_angle| {
            let (page, misfits) = arrange(&sheet(first_angle), &views, &Unlettered);
            assert_eq!(misfits, []);
            bounds(&page.groups[1].inks).expect("ink").0
        };
        assert_eq!(lowest(true), dvec2(80.0, 100.0));
        assert_eq!(lowest(false), dvec2(80.0, 170.0));
    }

    #[test]
    fn what_leaves_the_frame_is_told() {
        let wide = figure(200.0, 20.0);
        let views = [placing(&wide, View::Front, Spot::At(dvec2(110.0, 100.0)))];
        let (_, misfits) = arrange(&sheet(true), &views, &Unlettered);
        let told = Misfit::Overflow { view: 0, area: "frame", side: "right", by: 10.0 };
        assert_eq!(misfits, [told]);
        let iso = Placing {
            direction: None,
            spot: Spot::Beside { other: 0, gap: 5.0 },
            ..views[0].clone()
        };
        let (_, misfits) = arrange(&sheet(true), &[views[0].clone(), iso], &Unlettered);
        assert_eq!(misfits[1], Misfit::NotBeside { view: 1 });
    }
}
