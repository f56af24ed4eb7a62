//! Lines that go on into each other become one path.

use glam::DVec2;

use super::{
    drawing::{Path, Segment},
    merge::Mark,
};

/// A path that can be joined, and how it is drawn.
pub type Drawn = (Path, Mark);

/// An end of a path: twice its number, and one more for its last end.
type End = usize;

/// Joins paths of one mark whose ends meet where no other line ends. Ends meet when they are the same on a grid of
/// `tolerance` mm.
pub fn joined(paths: Vec<Drawn>, tolerance: f64) -> Vec<Drawn> {
    let partners = partners(&paths, tolerance);
    let mut paths: Vec<Option<Drawn>> = paths.into_iter().map(Some).collect();
    let mut out = Vec::with_capacity(paths.len());
    for number in 0..paths.len() {
        if paths[number].is_some() {
            let first = first_of_run(&partners, 2 * number);
            out.extend(taken(&mut paths, &partners, first));
        }
    }
    out
}

/// The end that each end goes on into; itself if it does not.
fn partners(paths: &[Drawn], tolerance: f64) -> Vec<End> {
    let cell = |v: f64| (v / tolerance).round() as i64 as u32;
    let place = |p: DVec2| u64::from(cell(p.x)) << 32 | u64::from(cell(p.y));
    let ends = |(path, _): &Drawn| [path.start, path.end()].map(place);
    let mut places: Vec<(u64, End)> = vec![];
    for (number, path) in paths.iter().enumerate() {
        let [start, end] = ends(path);
        places.extend([(start, 2 * number), (end, 2 * number + 1)]);
    }
    places.sort_unstable();
    let mut partners: Vec<End> = (0..places.len()).collect();
    for group in places.chunk_by(|a, b| a.0 == b.0) {
        if let &[(_, a), (_, b)] = group
            && paths[a / 2].1 == paths[b / 2].1
        {
            (partners[a], partners[b]) = (b, a);
        }
    }
    partners
}

/// The end at which the run through a path begins.
fn first_of_run(partners: &[End], start: End) -> End {
    let mut end = start;
    loop {
        let before = partners[end];
        // The other end of the path before.
        let next = before ^ 1;
        if before == end || next == start {
            return end;
        }
        end = next;
    }
}

/// Takes the run that begins at an end.
fn taken(paths: &mut [Option<Drawn>], partners: &[End], first: End) -> Option<Drawn> {
    let (mut run, mark) = paths[first / 2].take()?;
    if first % 2 == 1 {
        run = reversed(&run);
    }
    let mut end = first ^ 1;
    while let Some((path, _)) = paths[partners[end] / 2].take() {
        let next = partners[end];
        let path = if next % 2 == 1 { reversed(&path) } else { path };
        run.segments.extend(path.segments);
        end = next ^ 1;
    }
    Some((run, mark))
}

/// The path the other way around.
fn reversed(path: &Path) -> Path {
    let segments = path.pieces().map(|(start, segment)| match *segment {
        Segment::Line { .. } => Segment::Line { to: start },
        Segment::Arc { center, major, minor, from, to } => {
            Segment::Arc { center, major, minor, from: to, to: from }
        }
        Segment::Cubic { first, second, .. } => {
            Segment::Cubic { first: second, second: first, to: start }
        }
    });
    let mut segments: Vec<Segment> = segments.collect();
    segments.reverse();
    Path { start: path.end(), segments }
}

#[cfg(test)]
mod tests {
    use glam::dvec2;

    use super::*;
    use crate::output::drawing::{Class, Kind};

    fn line(from: [f64; 2], to: [f64; 2], id: u32) -> Drawn {
        let mark = Mark { class: Class::Visible, order: 0, kind: Kind::Sharp, id, loose: false };
        (Path::of(from.into(), Segment::Line { to: to.into() }), mark)
    }

    #[test]
    fn corners_become_one_path() {
        let square = vec![
            line([0., 0.], [1., 0.], 0),
            line([1., 1.], [1., 0.], 0),
            line([1., 1.], [0., 1.], 0),
            line([0., 0.], [0., 1.], 0),
        ];
        let out = joined(square.clone(), 1e-9);
        assert_eq!(out.len(), 1);
        assert_eq!((out[0].0.length(), out[0].0.end()), (4.0, out[0].0.start));
        let mut open = square[1..].to_vec();
        open.push(line([5., 5.], [0., 0.], 1));
        let out = joined(open, 1e-9);
        let lengths: Vec<f64> = out.iter().map(|(p, _)| p.length()).collect();
        assert_eq!(lengths, [3.0, 50f64.sqrt()]);
    }

    #[test]
    fn where_three_lines_meet_none_goes_on() {
        let star = (0..3).map(|i| line([0., 0.], [1., f64::from(i)], 0)).collect();
        assert_eq!(joined(star, 1e-9).len(), 3);
    }

    #[test]
    fn curves_are_turned_around() {
        let (a, b) = (dvec2(1.0, 0.0), dvec2(0.0, 1.0));
        let quarter = Segment::Arc {
            center: DVec2::ZERO,
            major: DVec2::X,
            minor: DVec2::Y,
            from: 0.0,
            to: std::f64::consts::FRAC_PI_2,
        };
        let turned = reversed(&Path::of(a, quarter));
        assert!(turned.start.distance(b) < 1e-15 && turned.end().distance(a) < 1e-15);
        assert_eq!(turned.length(), std::f64::consts::FRAC_PI_2);
    }
}
