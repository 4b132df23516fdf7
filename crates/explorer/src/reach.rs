//! Which places the drone can reach through motions known to be free: breadth-first flood on a level lattice.
//!
//! Input:  a start pose, the lattice step, a height band, and a closure that says whether a straight motion is free.
//! Output: the reached places with their parents, in the order of their hop count, so that a path can be read off.
//! Cost:   at most six motion checks a place, `max_places` places.
//! Degenerate input: a start whose neighbours are all blocked reaches itself alone.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use crate::heading::LevelPose;

/// Bounds of the flood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachLimits {
    /// Lattice step, map units, positive.
    pub step: f64,
    /// How far below the start the flood may go, map units.
    pub below: f64,
    /// How far above the start the flood may go, map units.
    pub above: f64,
    /// Places at most; the flood stops there.
    pub max_places: usize,
}

/// Everything that was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    places: Vec<Place>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    position: Point3<f64>,
    parent: usize,
}

impl Reach {
    /// Floods from `start`.
    pub fn flood(
        start: &LevelPose,
        limits: &ReachLimits,
        mut motion_is_free: impl FnMut(&Point3<f64>, &Point3<f64>) -> bool,
    ) -> Self {
        let axes = [start.forward, start.left(), start.up];
        let lowest = -(limits.below / limits.step).floor() as i32;
        let highest = (limits.above / limits.step).floor() as i32;
        let mut places = vec![Place {
            position: start.position,
            parent: 0,
        }];
        let mut cells = vec![[0_i32; 3]];
        let mut reached = BTreeMap::from([([0_i32; 3], 0_usize)]);
        let mut next = 0;
        while let (Some(&cell), Some(&place)) = (cells.get(next), places.get(next)) {
            for neighbour in neighbours(cell) {
                if !(lowest..=highest).contains(&neighbour[2]) || reached.contains_key(&neighbour) {
                    continue;
                }
                let position = start.position + lattice_offset(&axes, neighbour, limits.step);
                if places.len() >= limits.max_places || !motion_is_free(&place.position, &position)
                {
                    continue;
                }
                reached.insert(neighbour, places.len());
                cells.push(neighbour);
                places.push(Place {
                    position,
                    parent: next,
                });
            }
            next += 1;
        }
        Self { places }
    }

    /// How many places were reached, the start included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether nothing but the start was reached.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.len() <= 1
    }

    /// All reached positions, nearest in hops first.
    pub fn positions(&self) -> impl Iterator<Item = Point3<f64>> + '_ {
        self.places.iter().map(|place| place.position)
    }

    /// The position of place `index`.
    #[must_use]
    pub fn position(&self, index: usize) -> Option<Point3<f64>> {
        self.places.get(index).map(|place| place.position)
    }

    /// The place with the least `cost`, the first reached among equals, and that cost.
    #[must_use]
    pub fn best(&self, mut cost: impl FnMut(&Point3<f64>) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        for (index, place) in self.places.iter().enumerate() {
            let value = cost(&place.position);
            if value.is_finite() && best.is_none_or(|(_, least)| value < least) {
                best = Some((index, value));
            }
        }
        best
    }

    /// The way from the start to place `index`, both ends included; empty for an index that does not exist.
    #[must_use]
    pub fn path_to(&self, index: usize) -> Vec<Point3<f64>> {
        let mut path = Vec::new();
        let mut current = index;
        while let Some(place) = self.places.get(current) {
            path.push(place.position);
            if current == 0 {
                break;
            }
            current = place.parent;
        }
        path.reverse();
        path
    }
}

fn neighbours([i, j, k]: [i32; 3]) -> [[i32; 3]; 6] {
    [
        [i + 1, j, k],
        [i - 1, j, k],
        [i, j + 1, k],
        [i, j - 1, k],
        [i, j, k + 1],
        [i, j, k - 1],
    ]
}

fn lattice_offset(axes: &[Vector3<f64>; 3], cell: [i32; 3], step: f64) -> Vector3<f64> {
    axes[0] * (f64::from(cell[0]) * step)
        + axes[1] * (f64::from(cell[1]) * step)
        + axes[2] * (f64::from(cell[2]) * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Isometry3;

    fn start() -> LevelPose {
        LevelPose::from_camera(&Isometry3::identity(), Vector3::new(0.0, -1.0, 0.0)).unwrap()
    }

    const LIMITS: ReachLimits = ReachLimits {
        step: 0.5,
        below: 0.0,
        above: 0.0,
        max_places: 1000,
    };

    #[test]
    fn goes_round_a_wall_and_stays_in_its_height_band() {
        // A wall at z = 1 for x < 1, the room ends at |x| = 2 and |z| = 3.
        let free = |a: &Point3<f64>, b: &Point3<f64>| {
            let crosses = (a.z - 1.0) * (b.z - 1.0) <= 0.0 && b.x < 1.0;
            !crosses && b.x.abs() <= 2.0 && b.z.abs() <= 3.0
        };
        let reach = Reach::flood(&start(), &LIMITS, free);
        let (index, distance) = reach
            .best(|p| (p - Point3::new(0.0, 0.0, 2.0)).norm())
            .unwrap();
        assert!(distance < 1e-9);
        let path = reach.path_to(index);
        assert!(path.windows(2).all(|leg| free(&leg[0], &leg[1])));
        assert!(path.iter().any(|p| p.x >= 1.0));
        assert!(reach.positions().all(|p| p.y.abs() < 1e-12));
    }

    #[test]
    fn an_enclosed_start_reaches_itself_alone() {
        let reach = Reach::flood(&start(), &LIMITS, |_, _| false);
        assert!(reach.is_empty());
        assert_eq!(reach.path_to(0), vec![Point3::origin()]);
        assert!(reach.path_to(7).is_empty());
    }

    #[test]
    fn the_number_of_places_is_bounded() {
        let reach = Reach::flood(
            &start(),
            &ReachLimits {
                max_places: 50,
                ..LIMITS
            },
            |_, _| true,
        );
        assert_eq!(reach.len(), 50);
    }
}
