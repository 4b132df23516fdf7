//! Which places the drone can reach through motions known to be free, and the roomiest short way to each: Dijkstra on a lattice.
//!
//! Input:  a start pose, the lattice step, a height band, the clearance at a place, and whether a straight motion is free.
//! Output: the reached places with their parents, nearest first, so that a path can be read off.
//! Method: a step costs its length, and up to [`NARROW`] times as much more where the clearance is less than comfortable: the way
//!         through a door leads through its middle. A start that is nearer to an obstacle than allowed may be left by steps that
//!         do not come nearer.
//! Cost:   at most six motion checks and one clearance a place, `max_places` places.
//! Degenerate input: a start whose neighbours are all blocked reaches itself alone.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use nalgebra::{Point3, Vector3};

use crate::heading::LevelPose;

/// How much more a metre costs with the least clearance than with a comfortable one.
const NARROW: f64 = 5.0;

/// Bounds of the flood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachLimits {
    /// Lattice step, map units, positive.
    pub step: f64,
    /// How far below the start the flood may go, map units.
    pub below: f64,
    /// How far above the start the flood may go, map units.
    pub above: f64,
    /// Radius that every motion needs, map units.
    pub least: f64,
    /// Radius beyond which more room is of no use, map units, at least `least`.
    pub comfortable: f64,
    /// Places at most; the flood stops there.
    pub max_places: usize,
}

/// Where the drone may fly, as the flood asks it.
pub trait Room {
    /// Radius of the largest free ball around `place`, up to `most`.
    fn clearance(&self, place: &Point3<f64>, most: f64) -> f64;
    /// Whether a ball of `radius` may fly straight from `a` to `b`.
    fn motion_is_free(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool;
}

/// Everything that was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    places: Vec<Place>,
}

/// One reached place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Where, map units.
    pub position: Point3<f64>,
    /// Radius of the largest free ball around it, up to the comfortable one, map units.
    pub clearance: f64,
    /// Length of the way from the start, map units.
    pub way: f64,
    parent: usize,
}

/// A place that may be reached next. Ordered by cost, then by the order of discovery, so that the flood is the same on every machine.
#[derive(Debug, PartialEq)]
struct Open {
    cost: f64,
    number: usize,
    cell: [i32; 3],
    place: Place,
}

impl Eq for Open {}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.cost
            .total_cmp(&other.cost)
            .then(self.number.cmp(&other.number))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Reach {
    /// Floods from `start`.
    pub fn flood(start: &LevelPose, limits: &ReachLimits, room: &impl Room) -> Self {
        let clearance = room.clearance(&start.position, limits.comfortable);
        let mut flood = Flood {
            start,
            limits,
            room,
            tight: clearance.min(limits.least),
            clearances: BTreeMap::from([([0; 3], clearance)]),
            reached: BTreeMap::new(),
            open: BinaryHeap::new(),
            discovered: 0,
            places: Vec::new(),
        };
        let place = Place {
            position: start.position,
            clearance,
            way: 0.0,
            parent: 0,
        };
        flood.discover(0.0, [0; 3], place);
        flood.run();
        Self {
            places: flood.places,
        }
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

    /// All reached places, the cheapest to reach first.
    #[must_use]
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// All reached positions, the cheapest to reach first.
    pub fn positions(&self) -> impl Iterator<Item = Point3<f64>> + '_ {
        self.places.iter().map(|place| place.position)
    }

    /// Place `index`.
    #[must_use]
    pub fn place(&self, index: usize) -> Option<&Place> {
        self.places.get(index)
    }

    /// The position of place `index`.
    #[must_use]
    pub fn position(&self, index: usize) -> Option<Point3<f64>> {
        self.places.get(index).map(|place| place.position)
    }

    /// The place with the least `cost`, the first reached among equals, and that cost.
    #[must_use]
    pub fn best(&self, mut cost: impl FnMut(&Place) -> f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        for (index, place) in self.places.iter().enumerate() {
            let value = cost(place);
            if value.is_finite() && best.is_none_or(|(_, least)| value < least) {
                best = Some((index, value));
            }
        }
        best
    }

    /// The way from the start to place `index`, both ends included; empty for an index that does not exist.
    #[must_use]
    pub fn path_to(&self, index: usize) -> Vec<Place> {
        let mut path = Vec::new();
        let mut current = index;
        while let Some(&place) = self.places.get(current) {
            path.push(place);
            if current == 0 {
                break;
            }
            current = place.parent;
        }
        path.reverse();
        path
    }
}

/// The flood under way.
struct Flood<'a, R> {
    start: &'a LevelPose,
    limits: &'a ReachLimits,
    room: &'a R,
    /// Radius with which the start may be left.
    tight: f64,
    clearances: BTreeMap<[i32; 3], f64>,
    reached: BTreeMap<[i32; 3], usize>,
    open: BinaryHeap<Reverse<Open>>,
    discovered: usize,
    places: Vec<Place>,
}

impl<R: Room> Flood<'_, R> {
    fn discover(&mut self, cost: f64, cell: [i32; 3], place: Place) {
        let number = self.discovered;
        self.discovered += 1;
        self.open.push(Reverse(Open {
            cost,
            number,
            cell,
            place,
        }));
    }

    fn run(&mut self) {
        while let Some(Reverse(open)) = self.open.pop() {
            if self.reached.contains_key(&open.cell) || self.places.len() >= self.limits.max_places
            {
                continue;
            }
            let index = self.places.len();
            self.reached.insert(open.cell, index);
            self.places.push(open.place);
            for cell in neighbours(open.cell) {
                self.step(&open, index, cell);
            }
        }
    }

    /// From a reached place to a neighbour, if that is free.
    fn step(&mut self, from: &Open, index: usize, cell: [i32; 3]) {
        let limits = self.limits;
        let lowest = -(limits.below / limits.step).floor() as i32;
        let highest = (limits.above / limits.step).floor() as i32;
        if !(lowest..=highest).contains(&cell[2]) || self.reached.contains_key(&cell) {
            return;
        }
        let position = self.start.position + self.offset(cell);
        let clearance = self.clearance(cell, &position);
        // A tight start may be left towards more room.
        let leaves = from.place.clearance < limits.least && clearance >= from.place.clearance;
        let radius = if leaves { self.tight } else { limits.least };
        if clearance < radius
            || clearance <= 0.0
            || !self
                .room
                .motion_is_free(&from.place.position, &position, radius)
        {
            return;
        }
        let length = limits.step;
        let spare = (limits.comfortable - limits.least).max(f64::EPSILON);
        let lack = ((limits.comfortable - clearance) / spare).clamp(0.0, 1.0);
        let place = Place {
            position,
            clearance,
            way: from.place.way + length,
            parent: index,
        };
        self.discover(
            from.cost + length * (1.0 + NARROW * lack * lack),
            cell,
            place,
        );
    }

    fn clearance(&mut self, cell: [i32; 3], position: &Point3<f64>) -> f64 {
        let (room, most) = (self.room, self.limits.comfortable);
        *self
            .clearances
            .entry(cell)
            .or_insert_with(|| room.clearance(position, most))
    }

    fn offset(&self, cell: [i32; 3]) -> Vector3<f64> {
        let [along, aside, up] = cell.map(|number| f64::from(number) * self.limits.step);
        self.start.forward * along + self.start.left() * aside + self.start.up * up
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
        least: 0.1,
        comfortable: 0.1,
        max_places: 1000,
    };

    /// Free is where the clearance says so.
    struct Plan<F>(F);

    impl<F: Fn(&Point3<f64>) -> f64> Room for Plan<F> {
        fn clearance(&self, place: &Point3<f64>, most: f64) -> f64 {
            (self.0)(place).clamp(0.0, most)
        }

        fn motion_is_free(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> bool {
            (0..=20).all(|i| (self.0)(&(a + (b - a) * (f64::from(i) / 20.0))) >= radius)
        }
    }

    /// A room of 4 m by 6 m with a wall at z = 1 that leaves a door from x = 1 to x = 2.
    fn behind_a_wall(p: &Point3<f64>) -> f64 {
        let border = (2.0 - p.x.abs()).min(3.0 - p.z.abs());
        let wall = (p.z - 1.0).hypot((p.x - 1.0).max(0.0));
        border.min(wall)
    }

    #[test]
    fn goes_round_a_wall_and_stays_in_its_height_band() {
        let reach = Reach::flood(&start(), &LIMITS, &Plan(behind_a_wall));
        let (index, distance) = reach
            .best(|place| (place.position - Point3::new(0.0, 0.0, 2.0)).norm())
            .unwrap();
        assert!(distance < 1e-9);
        let path = reach.path_to(index);
        assert!(path.iter().any(|place| place.position.x >= 1.0));
        assert!(reach.positions().all(|p| p.y.abs() < 1e-12));
        assert!((path.last().unwrap().way - 0.5 * (path.len() - 1) as f64).abs() < 1e-9);
    }

    #[test]
    fn passes_a_door_in_its_middle() {
        let limits = ReachLimits {
            step: 0.1,
            comfortable: 0.5,
            max_places: 10_000,
            ..LIMITS
        };
        let reach = Reach::flood(&start(), &limits, &Plan(behind_a_wall));
        let (index, _) = reach
            .best(|place| (place.position - Point3::new(0.0, 0.0, 2.0)).norm())
            .unwrap();
        let path = reach.path_to(index);
        let at_door = path
            .iter()
            .filter(|place| (place.position.z - 1.0).abs() < 0.05);
        assert!(at_door.clone().count() > 0);
        assert!(
            at_door
                .into_iter()
                .all(|place| (place.position.x - 1.5).abs() < 0.15)
        );
    }

    #[test]
    fn a_tight_start_is_left_for_more_room() {
        // 0.03 from a wall at z = -0.03, everything before it is free.
        let plan = Plan(|p: &Point3<f64>| p.z + 0.03);
        let limits = ReachLimits {
            step: 0.05,
            max_places: 100,
            ..LIMITS
        };
        let reach = Reach::flood(&start(), &limits, &plan);
        assert!(reach.places().iter().any(|place| place.position.z > 0.2));
        let tight = reach.places().iter().filter(|place| place.clearance < 0.1);
        assert!(
            tight
                .into_iter()
                .all(|place| place.clearance >= 0.03 - 1e-9)
        );
    }

    #[test]
    fn an_enclosed_start_reaches_itself_alone() {
        let reach = Reach::flood(&start(), &LIMITS, &Plan(|_: &Point3<f64>| 0.0));
        assert!(reach.is_empty());
        assert_eq!(reach.path_to(0).len(), 1);
        assert!(reach.path_to(7).is_empty());
    }

    #[test]
    fn the_number_of_places_is_bounded() {
        let limits = ReachLimits {
            max_places: 50,
            ..LIMITS
        };
        let reach = Reach::flood(&start(), &limits, &Plan(|_: &Point3<f64>| 9.0));
        assert_eq!(reach.len(), 50);
    }
}
