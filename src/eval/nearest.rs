//! Names close to a mistyped one.

/// The candidates nearest to `name` by edit distance, best first, at most three. A candidate counts
/// when a third of its letters or fewer differ, or when one of the two words begins the other.
///
/// ```
/// use katachi::eval::nearest;
/// assert_eq!(nearest("cylnder", ["cylinder", "cone"].into_iter()), ["cylinder"]);
/// assert_eq!(nearest("radius", ["h", "r"].into_iter()), ["r"]);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found: Vec<(usize, &str)> = candidates
        .filter(|candidate| *candidate != name)
        .filter_map(|candidate| Some((closeness(name, candidate)?, candidate)))
        .collect();
    found.sort();
    found.dedup();
    let best = found.first().map_or(0, |(distance, _)| *distance);
    let close = found.into_iter().take_while(|(distance, _)| *distance <= best + 1);
    close.take(3).map(|(_, candidate)| candidate).collect()
}

/// What other modelling languages call it, and its name here.
const ELSEWHERE: &[(&str, &str)] = &[
    ("append", "++"),
    ("concat", "++"),
    ("cube", "box"),
    ("cuboid", "box"),
    ("linear_extrude", "extrude"),
    ("multmatrix", "transform"),
    ("null", "NONE"),
    ("pi", "PI"),
    ("pow", "^"),
    ("rands", "rand"),
    ("reduce", "fold"),
    ("rotate_extrude", "revolve"),
    ("square", "rect"),
    ("str", "string"),
    ("subtract", "difference"),
    ("translate", "move"),
    ("undef", "NONE"),
];

/// The name here of what is known by another name elsewhere.
///
/// ```
/// assert_eq!(katachi::eval::here_called("translate"), Some("move"));
/// ```
pub fn here_called(name: &str) -> Option<&'static str> {
    ELSEWHERE.iter().find(|(elsewhere, _)| *elsewhere == name).map(|(_, here)| *here)
}

/// `did you mean ...?` when something is near.
pub fn did_you_mean<'a>(
    name: &str,
    candidates: impl Iterator<Item = &'a str>,
) -> Option<(String, &'a str)> {
    let found = nearest(name, candidates);
    let first = *found.first()?;
    let quoted: Vec<String> = found.iter().map(|word| format!("`{word}`")).collect();
    Some((format!("did you mean {}?", quoted.join(" or ")), first))
}

fn closeness(name: &str, candidate: &str) -> Option<usize> {
    let longest = name.len().max(candidate.len());
    if longest > 64 {
        return None;
    }
    let (a, b) = (name.to_lowercase(), candidate.to_lowercase());
    let longer = a.chars().count().max(b.chars().count());
    let distance = edit_distance(&a, &b);
    if distance <= (longer / 3).clamp(1, 3) && distance < longer {
        return Some(distance);
    }
    let begins = a.starts_with(&b) || (b.starts_with(&a) && a.len() > 1);
    begins.then_some(10 + distance)
}

/// Insertions, deletions, changes and swaps of neighbours that turn `a` into `b`
/// (Damerau's optimal string alignment). Words above 64 letters are taken as far apart.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    if a.len().abs_diff(b.len()) > 3 {
        return usize::MAX / 2;
    }
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    for (j, cell) in rows[0].iter_mut().enumerate() {
        *cell = j;
    }
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let change = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = change.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}
