//! A copy of a space for work that is done beside other work, and the way back from it.

use super::{
    facet::Facets,
    space::{NONE, Space},
};

/// A space grown out of a copy of another one. What both had when it was copied has the same numbers.
pub(super) struct Fork {
    /// The copy.
    pub space: Space,
    /// How many points and planes were copied.
    points: u32,
    planes: u32,
}

impl Fork {
    /// A copy of a space.
    pub fn of(space: &Space) -> Fork {
        let (points, planes) = (space.point_count() as u32, space.plane_count() as u32);
        Fork { space: space.clone(), points, planes }
    }

    /// Gives facets the numbers that their points and planes have in the space the copy was made of,
    /// which may have grown since.
    pub fn bring_back(&self, facets: &mut Facets, home: &mut Space) {
        let mut planes = vec![NONE; self.space.plane_count() - self.planes as usize];
        let mut plane = |number: u32, home: &mut Space| match number.checked_sub(self.planes) {
            Some(new) if number != NONE => {
                let slot = &mut planes[new as usize];
                if *slot == NONE {
                    *slot = home.adopt_plane(number, &self.space);
                }
                *slot
            }
            _ => number,
        };
        facets.renumber_planes(|number| plane(number, home));
        let mut points = vec![NONE; self.space.point_count() - self.points as usize];
        facets.renumber_points(|number| {
            let Some(new) = number.checked_sub(self.points) else { return number };
            let slot = &mut points[new as usize];
            if *slot == NONE {
                let planes = self.space.planes_of(number).map(|number| plane(number, home));
                *slot = home.adopt_point(number, planes, &self.space);
            }
            *slot
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::predicates::Plane;

    /// A triangle of points found in a fork has the numbers of the same points found at home.
    #[test]
    fn points_found_twice_are_one() {
        let mut home = Space::default();
        let plane = |space: &mut Space, normal: [i128; 3], at: [i64; 3]| {
            space.add_plane(Plane::through(normal, at).expect("a direction").0)
        };
        let [x, y] = [[3, 1, 0], [1, -2, 0]].map(|n| plane(&mut home, n, [1, 0, 0]));
        let corner = home.add_lattice_point([7, 8, 9]);
        let mut fork = Fork::of(&home);
        let heights = [[0, 1, 3], [1, 0, 5], [2, 1, 7]];
        let corners = |space: &mut Space, order: [usize; 3]| {
            order.map(|i| {
                let z = plane(space, heights[i], [0, 0, 1]);
                space.meet(x, y, z).expect("one point")
            })
        };
        let away = corners(&mut fork.space, [0, 1, 2]);
        let [c, b, a] = corners(&mut home, [2, 1, 0]);
        let mut facets = Facets::default();
        facets.push_loop([away[0], away[1], away[2], corner].into_iter().map(|p| (p, x)));
        fork.bring_back(&mut facets, &mut home);
        facets.renumber_points(|point| {
            assert!([a, b, c, corner].contains(&point));
            point
        });
        assert_eq!(home.point_count(), 4);
    }
}
