//! Two curved grids with a border in common as one.

use glam::DVec3;
use thiserror::Error;

use super::{CurvedGrid, GridError};

/// Why two grids are not one.
#[derive(Clone, PartialEq, Debug, Error)]
pub enum JoinError {
    /// A grid that is closed one way has no four borders.
    #[error("the {0} surface is closed; only open ones are joined")]
    Closed(&'static str),
    /// No border in common.
    #[error(
        "no border of one surface is a border of the other; the nearest two are {gap} mm apart"
    )]
    Apart {
        /// The distance, mm.
        gap: f64,
    },
    /// The joined grid is none.
    #[error(transparent)]
    Grid(#[from] GridError),
}

type Rows = Vec<Vec<DVec3>>;

/// Borders no farther apart than this part of their length are one: they are chords of one curve.
const ONE: f64 = 2e-3;

/// Parts of a border nearer than this are one.
const SAME: f64 = 1e-9;

impl CurvedGrid {
    /// This grid and another one that has a border with it in common, as one grid whose rows run along that border. With
    /// `smooth` both are bent so that they leave the border in one direction, the mean of both, which moves points by less
    /// and less up to the borders opposite. The borders beside the common one stay where they are: where these meet at
    /// an angle, so do the surfaces there, less and less up to an eighth of the common border away.
    ///
    /// # Departures
    /// METHODS 4.3 leaves open how patches are joined.
    ///
    /// ```
    /// use glam::dvec3;
    /// use katachi::geom::CurvedGrid;
    /// let row = |x: f64, z: f64| vec![dvec3(x, 0., z), dvec3(x, 5., z)];
    /// let flat = CurvedGrid::new(&[row(0., 0.), row(4., 0.)], false, false).unwrap();
    /// let steep = CurvedGrid::new(&[row(4., 0.), row(4., 3.)], false, false).unwrap();
    /// assert_eq!(flat.joined(&steep, false).unwrap().size(), [3, 2]);
    /// ```
    pub fn joined(&self, other: &CurvedGrid, smooth: bool) -> Result<CurvedGrid, JoinError> {
        for (grid, name) in [(self, "first"), (other, "second")] {
            if grid.closed() != [false; 2] {
                return Err(JoinError::Closed(name));
            }
        }
        let mut nearest = f64::INFINITY;
        for ours in turned(self) {
            for theirs in turned(other).into_iter().flat_map(|rows| [mirrored(&rows), rows]) {
                let (a, b) = (&ours[0], &theirs[0]);
                let gap = gap(a, b);
                if gap <= ONE * length(a) {
                    return Ok(CurvedGrid::new(&together(&ours, &theirs, smooth), false, false)?);
                }
                nearest = nearest.min(gap);
            }
        }
        Err(JoinError::Apart { gap: nearest })
    }
}

/// The rows of a grid from each of its borders.
fn turned(grid: &CurvedGrid) -> [Rows; 4] {
    let [nu, nv] = grid.size();
    let rows: Rows = (0..nu).map(|u| (0..nv).map(|v| grid.point(u, v)).collect()).collect();
    let columns: Rows = (0..nv).map(|v| (0..nu).map(|u| grid.point(u, v)).collect()).collect();
    let back = |rows: &Rows| rows.iter().rev().cloned().collect();
    [back(&rows), rows, back(&columns), columns]
}

fn mirrored(rows: &Rows) -> Rows {
    rows.iter().map(|row| row.iter().rev().copied().collect()).collect()
}

/// The part of a row's length up to each of its points.
fn parts(row: &[DVec3]) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = row.windows(2).map(|pair| {
        sum += pair[0].distance(pair[1]);
        sum
    });
    let ends: Vec<f64> = std::iter::once(0.0).chain(steps).collect();
    let whole = ends[ends.len() - 1].max(f64::MIN_POSITIVE);
    ends.into_iter().map(|end| end / whole).collect()
}

fn length(row: &[DVec3]) -> f64 {
    row.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// The largest distance between two rows at equal parts of their lengths.
fn gap(a: &[DVec3], b: &[DVec3]) -> f64 {
    let one_way = |a: &[DVec3], b: &[DVec3]| {
        let own = parts(b);
        let at = parts(a).into_iter().map(|part| along(b, &own, part));
        at.zip(a).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
    };
    one_way(a, b).max(one_way(b, a))
}

/// The point of a row at a part of what `parts` measure.
fn along(row: &[DVec3], parts: &[f64], part: f64) -> DVec3 {
    let j = parts.partition_point(|p| *p <= part).clamp(1, parts.len() - 1) - 1;
    let step = parts[j + 1] - parts[j];
    if step <= 0.0 { row[j] } else { row[j].lerp(row[j + 1], ((part - parts[j]) / step).min(1.0)) }
}

/// The rows of both, those of the first one backwards to the common border, which is the first row of both.
fn together(ours: &Rows, theirs: &Rows, smooth: bool) -> Rows {
    let own = [parts(&ours[0]), parts(&theirs[0])];
    let mut places: Vec<f64> = own.iter().flatten().copied().collect();
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| *a - *b <= SAME);
    let spread = |rows: &Rows, parts: &[f64]| -> Rows {
        let row = |row: &Vec<DVec3>| places.iter().map(|p| along(row, parts, *p)).collect();
        rows.iter().map(row).collect()
    };
    let (mut ours, mut theirs) = (spread(ours, &own[0]), spread(theirs, &own[1]));
    // Corners of either border are on the curve that both stand for.
    for (j, place) in places.iter().enumerate() {
        let is_theirs = own[1].iter().any(|part| (part - place).abs() <= SAME);
        let kept = if is_theirs { theirs[0][j] } else { ours[0][j] };
        (ours[0][j], theirs[0][j]) = (kept, kept);
    }
    if smooth {
        let turns: Vec<[DVec3; 2]> = (0..places.len()).map(|j| turn(&ours, &theirs, j)).collect();
        let sides = [turns[0], turns[turns.len() - 1]];
        for (j, place) in places.iter().enumerate() {
            let [first, last] = [*place, 1.0 - place].map(fading);
            let kept = |k: usize| turns[j][k] - sides[0][k] * first - sides[1][k] * last;
            bend(&mut ours, j, kept(0));
            bend(&mut theirs, j, kept(1));
        }
    }
    ours.into_iter().rev().chain(theirs.into_iter().skip(1)).collect()
}

/// The changes of direction with which a column of both leaves the border along the mean of both.
fn turn(ours: &Rows, theirs: &Rows, j: usize) -> [DVec3; 2] {
    let leave = |rows: &Rows| (rows[1][j] - rows[0][j]).normalize_or_zero();
    let [a, b] = [leave(ours), leave(theirs)];
    match (b - a).try_normalize() {
        Some(middle) => [-middle - a, middle - b],
        None => [DVec3::ZERO; 2],
    }
}

/// The part of the common border over which what the sides keep fades out.
const SIDE: f64 = 0.125;

/// 1 at a side, 0 from [`SIDE`] on.
fn fading(away: f64) -> f64 {
    let rest = (1.0 - away / SIDE).max(0.0);
    rest * rest
}

/// Adds a change of direction to a column at its start, less and less up to its end.
fn bend(rows: &mut Rows, j: usize, change: DVec3) {
    let column: Vec<DVec3> = rows.iter().map(|row| row[j]).collect();
    let whole = length(&column);
    if whole <= 0.0 {
        return;
    }
    let mut s = 0.0;
    for i in 1..rows.len() {
        s += column[i].distance(column[i - 1]);
        let rest = 1.0 - s / whole;
        rows[i][j] += change * (s * rest * rest);
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    /// A strip of a surface over the xy plane.
    fn strip(x: [f64; 2], n: usize, height: impl Fn(f64) -> f64) -> CurvedGrid {
        let row = |i: usize| {
            let x = x[0] + (x[1] - x[0]) * i as f64 / n as f64;
            (0..=4 + n / 10)
                .map(|j| dvec3(x, 8.0 * j as f64 / (4 + n / 10) as f64, height(x)))
                .collect()
        };
        CurvedGrid::new(&(0..=n).map(row).collect::<Vec<_>>(), false, false).expect("a strip")
    }

    #[test]
    fn a_roof_becomes_smooth_at_its_ridge() {
        let (up, down) = (strip([0.0, 10.0], 40, |x| x), strip([10.0, 20.0], 60, |x| 20.0 - x));
        let sharp = up.joined(&down, false).expect("they meet");
        let smooth = up.joined(&down, true).expect("they meet");
        assert_eq!(sharp.size()[0], 101);
        let middle = smooth.size()[1] / 2;
        let turn = |grid: &CurvedGrid| {
            let at = |u: usize| grid.point(u, middle);
            let ridge = (0..101).find(|&u| (at(u).x - 10.0).abs() < 1e-9).expect("the ridge");
            let step = |from: usize| (at(from + 1) - at(from)).normalize();
            step(ridge - 1).angle_between(step(ridge)).to_degrees()
        };
        assert!((turn(&sharp) - 90.0).abs() < 1e-6);
        assert!(turn(&smooth) < 6.0, "{}", turn(&smooth));
        // The four borders stay; points inside do not.
        let [nu, nv] = smooth.size();
        let moved = |u: usize, v: usize| smooth.point(u, v).distance(sharp.point(u, v));
        assert!((0..nu).all(|u| moved(u, 0) == 0.0 && moved(u, nv - 1) == 0.0));
        assert!((0..nv).all(|v| moved(0, v) == 0.0 && moved(nu - 1, v) == 0.0));
        assert!(moved(nu / 4, middle) > 0.1);
    }

    #[test]
    fn what_does_not_meet_is_told() {
        let (a, b) = (strip([0.0, 10.0], 5, |_| 0.0), strip([11.0, 20.0], 5, |_| 0.0));
        assert!(
            matches!(a.joined(&b, false), Err(JoinError::Apart { gap }) if (gap - 1.0).abs() < 1e-9)
        );
    }
}
