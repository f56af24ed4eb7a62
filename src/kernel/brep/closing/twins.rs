//! Which triangle lies across each edge.

use super::{Soup, following, preceding};
use crate::{geom::trig::atan2_deg, kernel::brep::Defect};

const NONE: u32 = u32::MAX;

/// The half-edges in groups of one edge, whichever way they run.
struct Groups {
    /// Half-edges by the smaller of their points, then by the larger.
    order: Vec<u32>,
    /// Where each group begins, and the end.
    starts: Vec<u32>,
}

impl Groups {
    fn new(soup: &Soup) -> Groups {
        let ends = |h: u32| {
            let (a, b) = (soup.start(h), soup.end(h));
            (a.min(b), a.max(b))
        };
        let count = 3 * soup.triangles.len() as u32;
        let mut place = vec![0u32; soup.points.len() + 2];
        (0..count).for_each(|h| place[ends(h).0 as usize + 2] += 1);
        (1..place.len()).for_each(|i| place[i] += place[i - 1]);
        let mut keyed = vec![(0u32, 0u32); count as usize];
        for h in 0..count {
            let (low, high) = ends(h);
            let at = &mut place[low as usize + 1];
            keyed[*at as usize] = (high, h);
            *at += 1;
        }
        let mut starts = vec![];
        for range in place.windows(2) {
            let bucket = &mut keyed[range[0] as usize..range[1] as usize];
            bucket.sort_unstable();
            let first = |i: &usize| *i == 0 || bucket[*i - 1].0 != bucket[*i].0;
            starts.extend((0..bucket.len()).filter(first).map(|i| range[0] + i as u32));
        }
        starts.push(count);
        Groups { order: keyed.into_iter().map(|(_, h)| h).collect(), starts }
    }

    fn iter(&self) -> impl Iterator<Item = &[u32]> + '_ {
        self.starts.windows(2).map(|w| &self.order[w[0] as usize..w[1] as usize])
    }
}

/// For each half-edge the one that runs back along it in the neighbouring triangle. Triangles that face
/// the other way than their neighbours are turned over; where four or more meet at an edge, those with
/// material between them are neighbours, and a half-edge of each such pair is given too. Fails when an edge has
/// an odd number of triangles, or the surface has one side only.
pub(super) fn pair(soup: &mut Soup) -> Result<(Vec<u32>, Vec<u32>), Defect> {
    let mut groups = Groups::new(soup);
    refuse(soup, &groups, |group| group.len() % 2 == 1)?;
    let opposite = |g: &[u32]| soup.start(g[0]) != soup.start(g[1]);
    if !groups.iter().all(|g| g.len() > 2 || opposite(g)) {
        make_consistent(soup, &groups)?;
        groups = Groups::new(soup);
    }
    let forward = |h: u32| soup.start(h) < soup.end(h);
    refuse(soup, &groups, |g| 2 * g.iter().filter(|&&h| forward(h)).count() != g.len())?;
    let mut twin = vec![NONE; 3 * soup.triangles.len()];
    let mut join = |a: u32, b: u32| (twin[a as usize], twin[b as usize]) = (b, a);
    let mut crowded = vec![];
    for group in groups.iter() {
        if let [a, b] = *group {
            join(a, b);
            continue;
        }
        for (a, b) in radial_pairs(soup, group) {
            join(a, b);
            crowded.push(a);
        }
    }
    Ok((twin, crowded))
}

/// An error if any group of half-edges is bad.
fn refuse(soup: &Soup, groups: &Groups, bad: impl Fn(&[u32]) -> bool) -> Result<(), Defect> {
    let mut found = groups.iter().filter(|g| bad(g));
    let Some(group) = found.next() else { return Ok(()) };
    Err(Defect::OpenEdge {
        a: soup.start(group[0]),
        b: soup.end(group[0]),
        faces: group.len(),
        at: soup.middle(group[0]),
        edges: found.count() + 1,
    })
}

/// Turns triangles over until neighbours at ordinary edges run oppositely along them. In each connected
/// piece the first triangle stays.
fn make_consistent(soup: &mut Soup, groups: &Groups) -> Result<(), Defect> {
    let mut twin = vec![NONE; 3 * soup.triangles.len()];
    for group in groups.iter().filter(|g| g.len() == 2) {
        (twin[group[0] as usize], twin[group[1] as usize]) = (group[1], group[0]);
    }
    let mut turned: Vec<Option<bool>> = vec![None; soup.triangles.len()];
    let mut open = vec![];
    for first in 0..turned.len() {
        if turned[first].is_none() {
            turned[first] = Some(false);
            open.push(first);
        }
        while let Some(t) = open.pop() {
            for h in 3 * t as u32..3 * t as u32 + 3 {
                let across = twin[h as usize];
                if across == NONE {
                    continue;
                }
                let same_way = soup.start(h) == soup.start(across);
                let wanted = turned[t].map(|turn| turn ^ same_way);
                let neighbour = &mut turned[across as usize / 3];
                if neighbour.is_none() {
                    *neighbour = wanted;
                    open.push(across as usize / 3);
                } else if *neighbour != wanted {
                    return Err(Defect::OneSided { at: soup.middle(h) });
                }
            }
        }
    }
    soup.turn_over(|t| turned[t] == Some(true));
    Ok(())
}

/// Pairs the triangles around an edge that has more than two: going round it counter-clockwise, seen with
/// the edge coming at one, material lies from a triangle that runs backward to the next that runs forward.
fn radial_pairs(soup: &Soup, group: &[u32]) -> Vec<(u32, u32)> {
    let (a, b) = (soup.start(group[0]), soup.end(group[0]));
    let (low, high) = (a.min(b), a.max(b));
    let base = soup.points[low as usize];
    let axis = (soup.points[high as usize] - base).normalize_or_zero();
    let (u, v) = axis.any_orthonormal_pair();
    let angle = |h: u32| {
        let apex = soup.points[soup.start(preceding(h)) as usize] - base;
        atan2_deg(apex.dot(v), apex.dot(u))
    };
    let mut around: Vec<(f64, bool, u32)> =
        group.iter().map(|&h| (angle(h), soup.start(h) == low, h)).collect();
    around.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let alternate = (0..around.len()).all(|i| around[i].1 != around[(i + 1) % around.len()].1);
    if alternate {
        let first = usize::from(around[0].1);
        around.rotate_left(first);
        return around.chunks(2).map(|pair| (pair[0].2, pair[1].2)).collect();
    }
    // Sheets that cross each other: any pairing closes the surface.
    let running = |forward: bool| around.iter().filter(move |a| a.1 == forward).map(|a| a.2);
    running(false).zip(running(true)).collect()
}

/// Follows the turning over of the chosen triangles in the table of neighbours.
pub(super) fn turn_over(twin: &mut [u32], chosen: impl Fn(usize) -> bool) {
    let turned = |h: u32| if chosen(h as usize / 3) { h - h % 3 + 2 - h % 3 } else { h };
    twin.iter_mut().for_each(|h| *h = turned(*h));
    for t in (0..twin.len() / 3).filter(|&t| chosen(t)) {
        twin.swap(3 * t, 3 * t + 2);
    }
}

/// Gives each fan of triangles around a point a point of its own.
pub(super) fn split_fans(soup: &mut Soup, twin: &[u32]) {
    let mut seen = vec![false; twin.len()];
    let mut taken = vec![false; soup.points.len()];
    for first in 0..twin.len() as u32 {
        if seen[first as usize] {
            continue;
        }
        let mut point = soup.start(first);
        if std::mem::replace(&mut taken[point as usize], true) {
            soup.points.push(soup.points[point as usize]);
            point = soup.points.len() as u32 - 1;
        }
        let mut spoke = first;
        while !seen[spoke as usize] {
            seen[spoke as usize] = true;
            soup.triangles[spoke as usize / 3][spoke as usize % 3] = point;
            spoke = following(twin[spoke as usize]);
        }
    }
}
