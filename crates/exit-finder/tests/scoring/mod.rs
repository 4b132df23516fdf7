//! Precision and recall of the exits of generated rooms.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "shared by tests and examples, each uses its part"
)]

use std::f64::consts::TAU;
use std::fmt;
use std::ops::RangeInclusive;

use exit_finder::{AffinePlane, Exit, ExitConfig, ExitView, find_exits};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::generator::{Kind, Opening, Scan, cleaned, corrupted, scan};

/// What the rooms of one evaluation are like.
#[derive(Debug, Clone)]
pub struct Suite {
    pub kind: Kind,
    pub doors: RangeInclusive<usize>,
    pub dark: bool,
    pub rooms: u64,
    pub first_seed: u64,
    pub outliers: f64,
    pub clean: bool,
    /// Whether the map tells which keyframe observes which point.
    pub observed: bool,
}

impl Suite {
    /// The scans, with outliers added and cleaned as the suite says.
    pub fn scans(&self) -> Vec<Scan> {
        (0..self.rooms)
            .map(|room| {
                let mut rng = Pcg64::seed_from_u64(self.first_seed + room);
                let doors = rng.random_range(self.doors.clone());
                let mut scan = scan(self.kind, doors, self.dark, &mut rng);
                scan.points = corrupted(&scan.points, scan.agent, self.outliers, &mut rng);
                if self.observed {
                    scan.observe(&mut rng);
                }
                if self.clean {
                    scan.keep(&cleaned(&scan.points, scan.agent));
                }
                scan
            })
            .collect()
    }
}

/// Counts over many rooms.
#[derive(Debug, Default, Clone, Copy)]
pub struct Score {
    pub rooms: usize,
    pub silent: usize,
    pub right: usize,
    pub wrong: usize,
    pub best_right: usize,
    pub best_wrong: usize,
    pub found: usize,
    pub missed: usize,
    /// Of the fair openings those with [`ENOUGH_POINTS`] at least [`ENOUGH_DEPTH`] behind.
    pub seen_found: usize,
    pub seen_missed: usize,
    /// Of the fair openings those behind which the map, as it is after cleaning, has [`EVIDENT`] genuine points.
    pub evident_found: usize,
    pub evident_missed: usize,
    /// Sum over the right exits of the common part of sector and opening over their union.
    pub common: f64,
}

/// Genuine points half a metre behind the wall by which somebody who knows the walls would tell an opening.
const EVIDENT: usize = 5;
/// Map points behind an opening that make it evident from the map.
const ENOUGH_POINTS: usize = 20;
/// Their mean distance behind the wall, metres: more than furniture is deep.
const ENOUGH_DEPTH: f64 = 1.0;

impl Score {
    pub fn precision(&self) -> f64 {
        share(self.right, self.wrong)
    }

    pub fn recall(&self) -> f64 {
        share(self.found, self.missed)
    }

    /// Recall of the openings through which the map shows something.
    pub fn recall_seen_through(&self) -> f64 {
        share(self.seen_found, self.seen_missed)
    }

    /// Recall of the openings that somebody who knows the true walls and points could tell.
    pub fn recall_evident(&self) -> f64 {
        share(self.evident_found, self.evident_missed)
    }

    /// How well the sectors of the right exits agree with the openings: common part over union, mean.
    pub fn agreement(&self) -> f64 {
        self.common / self.right.max(1) as f64
    }

    /// The best recall: the share of the fair openings that such an oracle finds.
    pub fn oracle(&self) -> f64 {
        let evident = self.evident_found + self.evident_missed;
        share(evident, self.found + self.missed - evident)
    }

    /// Share of rooms with any exit whose best one is right.
    pub fn best(&self) -> f64 {
        share(self.best_right, self.best_wrong)
    }

    /// Share of rooms without any exit.
    pub fn silence(&self) -> f64 {
        share(self.silent, self.rooms - self.silent)
    }

    fn add(&mut self, scan: &Scan, exits: &[Exit]) {
        self.rooms += 1;
        self.silent += usize::from(exits.is_empty());
        for (rank, exit) in exits.iter().enumerate() {
            let hit = scan.openings.iter().find(|opening| hits(exit, opening));
            self.common += hit.map_or(0.0, |opening| common(exit, opening));
            let right = hit.is_some();
            self.right += usize::from(right);
            self.wrong += usize::from(!right);
            if rank == 0 {
                self.best_right += usize::from(right);
                self.best_wrong += usize::from(!right);
            }
        }
        for opening in scan.openings.iter().filter(|opening| opening.fair) {
            let found = exits.iter().any(|exit| hits(exit, opening));
            self.found += usize::from(found);
            self.missed += usize::from(!found);
            if opening.behind >= ENOUGH_POINTS && opening.depth >= ENOUGH_DEPTH {
                self.seen_found += usize::from(found);
                self.seen_missed += usize::from(!found);
            }
            if scan.evidence(opening) >= EVIDENT {
                self.evident_found += usize::from(found);
                self.evident_missed += usize::from(!found);
            }
        }
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [p, r, b] = [self.precision(), self.recall(), self.best()].map(|x| 100.0 * x);
        write!(f, "precision {p:5.1}  recall {r:5.1}  best {b:5.1}")
    }
}

fn share(part: usize, rest: usize) -> f64 {
    part as f64 / (part + rest).max(1) as f64
}

/// The middle of the exit lies in the opening, three degrees to spare.
fn hits(exit: &Exit, opening: &Opening) -> bool {
    let spare = 3f64.to_radians();
    (exit.bearing_rad - opening.start + spare).rem_euclid(TAU) < opening.width + 2.0 * spare
}

/// Common part of an exit's sector and an opening over their union.
fn common(exit: &Exit, opening: &Opening) -> f64 {
    let off = (exit.sector.start_rad - opening.start + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    let (end, far) = (off + exit.width_rad, opening.width);
    let both = (end.min(far) - off.max(0.0)).max(0.0);
    both / (end.max(far) - off.min(0.0))
}

/// Compares the exits of all scans with the truth. A known scale gives the width a drone needs, 0.6 m.
pub fn evaluate(scans: &[Scan], known_scale: bool, config: &ExitConfig) -> Score {
    let mut score = Score::default();
    for scan in scans {
        let min_width = known_scale.then_some(0.6 * scan.scale);
        let config = ExitConfig {
            min_width,
            ..*config
        };
        let plane = AffinePlane::from_up([0.0, 0.0, 1.0], scan.agent).unwrap();
        let rays = scan.rays();
        let view = ExitView {
            doubtful: &scan.doubtful,
            rays: &rays,
            ..ExitView::default()
        };
        let report = find_exits(&scan.points, scan.agent, &plane, &view, &config).unwrap();
        score.add(scan, &report.exits);
    }
    score
}
