//! What tells an opening in a wall from a niche, from a passage in the same room and from strays: one number each.
//!
//! Votes are those of [`super::wall`], lengths are in median ranges, so no cue needs a scale. Logarithms where a cue is
//! a size. "Beside" is the wall within 0.35 median ranges of a jamb, three degrees at least.

mod points;

use super::openings::Stretch;
use super::sight::Sight;
use super::wall::Wall;

/// Number of cues.
pub const CUES: usize = 28;

/// Names of the cues in the order of [`super::Opening::cues`].
pub const CUE_NAMES: [&str; CUES] = [
    "votes",
    "share",
    "before",
    "depth",
    "width",
    "beside_less",
    "own_less",
    "own_more",
    "elsewhere",
    "explained",
    "spread",
    "contrast",
    "missing",
    "edge_depth",
    "angle",
    "slenderness",
    "range",
    "continued",
    "background",
    "roughness",
    "doubted",
    "dirt",
    "points",
    "level",
    "shallow",
    "lintel",
    "sill",
    "over",
];

/// The cues of one candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cues {
    /// Log of the votes through the wall.
    votes: f64,
    /// Their share among those and the votes on the wall.
    share: f64,
    /// Share of the votes before the wall among all.
    before: f64,
    /// How far behind the wall the points lie.
    depth: f64,
    /// Log of the distance between the jambs.
    width: f64,
    /// Log of one more than the votes on the wall beside the jamb that has fewer.
    beside_less: f64,
    /// The same for votes that lie on no stronger wall, beside the jamb with fewer and the one with more.
    own_less: f64,
    own_more: f64,
    /// Log of one more than the votes on the rest of the wall.
    elsewhere: f64,
    /// Share of the points through the wall that lie on another wall which is seen outside the sector too: a room's
    /// back wall seen past a cabinet.
    explained: f64,
    /// Whether the votes fill the sector evenly: their deviation, 1 for an even spread.
    spread: f64,
    /// Log of the range seen in the sector over that of its surroundings, ±50 degrees.
    contrast: f64,
    /// Log of the votes on the wall here over what the wall beside the jambs leads one to expect.
    missing: f64,
    /// The depth in the outer thirds of the sector, the lesser one. A door's edge is a jump.
    edge_depth: f64,
    /// Log of the sector's width, degrees.
    angle: f64,
    /// Depth over width.
    slenderness: f64,
    /// Log of the distance.
    range: f64,
    /// Share of the votes on walls that pass by a jamb and go on behind it: the side walls of a long room.
    continued: f64,
    /// Log of the points through the wall here over those through its textured parts: strays are everywhere.
    background: f64,
    /// Log of one more than the scatter of neighbouring points behind, in standard deviations of their depth.
    roughness: f64,
    /// Log of the points behind that a cleaning took out over those that its usual share would be.
    doubted: f64,
    /// Share of the map that a cleaning took out.
    dirt: f64,
    /// Log of the points behind, not capped by bin.
    points: f64,
    /// Share of them in the band.
    level: f64,
    /// Share of the votes behind that lie less than 0.3 median ranges deep.
    shallow: f64,
    /// Log of one more than the points above the band that lie on the wall.
    lintel: f64,
    /// The same below the band.
    sill: f64,
    /// Share of the points behind that lie above the band.
    over: f64,
}

/// Beside a jamb: median ranges, and degrees at least and at most.
const BESIDE: (f64, usize, usize) = (0.35, 3, 60);
/// Half the surroundings, degrees.
const SURROUNDINGS: usize = 50;
/// Votes that a wall needs outside a sector to explain what is seen in it.
const SUPPORT: f64 = 8.0;
/// A wall passes by a jamb within so many median ranges.
const NEAR: f64 = 0.2;

impl Cues {
    pub(super) fn to_array(self) -> [f64; CUES] {
        [
            self.votes,
            self.share,
            self.before,
            self.depth,
            self.width,
            self.beside_less,
            self.own_less,
            self.own_more,
            self.elsewhere,
            self.explained,
            self.spread,
            self.contrast,
            self.missing,
            self.edge_depth,
            self.angle,
            self.slenderness,
            self.range,
            self.continued,
            self.background,
            self.roughness,
            self.doubted,
            self.dirt,
            self.points,
            self.level,
            self.shallow,
            self.lintel,
            self.sill,
            self.over,
        ]
    }

    /// The cues of the candidate from place `inner.0` to `inner.1` of a stretch, with its jambs.
    pub(super) fn of(
        sight: &Sight,
        walls: &[Wall],
        index: usize,
        stretch: &Stretch<'_>,
        inner: (usize, usize),
        jambs: (usize, usize),
    ) -> Self {
        let scene = Scene {
            sight,
            walls,
            index,
            stretch,
            inner,
            jambs,
        };
        scene.cues()
    }
}

struct Scene<'a> {
    sight: &'a Sight,
    walls: &'a [Wall],
    index: usize,
    stretch: &'a Stretch<'a>,
    inner: (usize, usize),
    jambs: (usize, usize),
}

/// Sums over the sector.
struct Sums {
    through: f64,
    on: f64,
    before: f64,
    /// Log-free depth, weighted by votes.
    depth: f64,
}

impl Scene<'_> {
    fn cues(&self) -> Cues {
        let sums = self.sums();
        let bins = (self.inner.1 - self.inner.0) as f64;
        let [a, b] = [self.jambs.0, self.jambs.1].map(|place| self.stretch.at(place as f64));
        let width = distance(a, b).clamp(0.02, 3.0);
        let range = 0.5_f64.sqrt() * (norm(a).powi(2) + norm(b).powi(2)).sqrt();
        let sides = [self.beside(false), self.beside(true)];
        let [on, own] = [0, 1].map(|k| sides.map(|side| (1.0_f64 + side.votes[k]).ln()));
        let expected = bins * (sides[0].votes[0] + sides[1].votes[0])
            / ((sides[0].bins + sides[1].bins).max(1) as f64);
        let (explained, continued) = self.other_walls(sums.through);
        let points = self.points_behind(Sight::any_height);
        Cues {
            votes: sums.through.max(f64::MIN_POSITIVE).ln(),
            share: sums.through / (sums.through + sums.on).max(f64::MIN_POSITIVE),
            before: sums.before / (sums.through + sums.on + sums.before).max(f64::MIN_POSITIVE),
            depth: sums.depth.min(1.5),
            width: width.ln(),
            beside_less: on[0].min(on[1]),
            own_less: own[0].min(own[1]),
            own_more: own[0].max(own[1]),
            elsewhere: (1.0 + self.elsewhere()).ln(),
            explained,
            spread: self.spread(sums.through),
            contrast: self.contrast(),
            missing: ((sums.on + 1.0) / (expected + 1.0)).ln(),
            edge_depth: self.edge_depth(),
            angle: (bins * 360.0 / self.sight.n() as f64).ln(),
            slenderness: (sums.depth / width).min(3.0),
            range: range.ln(),
            continued,
            background: self.background(),
            roughness: self.roughness(),
            doubted: self.doubted(),
            dirt: self.sight.dirt(),
            points: points.ln_1p(),
            level: (1.0 + self.points_behind(Sight::seen)) / (1.0 + points),
            shallow: self.shallow(),
            lintel: self.points_on(Sight::above).ln_1p(),
            sill: self.sill().ln_1p(),
            over: self.points_behind(Sight::above) / (1.0 + points),
        }
    }

    fn sums(&self) -> Sums {
        let mut sums = Sums {
            through: 0.0,
            on: 0.0,
            before: 0.0,
            depth: 0.0,
        };
        for place in self.inner.0..self.inner.1 {
            let votes = self.stretch.votes(place);
            sums.through += votes.through;
            sums.on += votes.on;
            sums.before += votes.before;
            sums.depth += votes.through * votes.depth.min(3.0);
        }
        sums.depth /= sums.through.max(f64::MIN_POSITIVE);
        sums
    }

    fn beside(&self, after: bool) -> Beside {
        let degrees = |d: usize| d * self.sight.n() / 360;
        let jamb = if after { self.jambs.1 } else { self.jambs.0 };
        let from = self.stretch.at(jamb as f64);
        let mut beside = Beside {
            votes: [0.0; 2],
            bins: 0,
        };
        let most = if after { self.stretch.len - jamb } else { jamb };
        for k in 0..most.min(degrees(BESIDE.2) + 1) {
            let place = if after { jamb + k } else { jamb - k - 1 };
            let far = distance(self.stretch.at(place as f64 + 0.5), from) > BESIDE.0;
            if k >= degrees(BESIDE.1) && far {
                break;
            }
            let votes = self.stretch.votes(place);
            beside.votes[0] += votes.on;
            beside.votes[1] += votes.own;
            beside.bins += 1;
        }
        beside
    }

    fn elsewhere(&self) -> f64 {
        let (wall, stretch) = (self.stretch.wall, self.stretch);
        let inside = wall.on(stretch.bin(self.inner.0), self.inner.1 - self.inner.0);
        (wall.on(stretch.first, stretch.len) - inside).max(0.0)
    }

    /// Which share of the points lies on walls seen outside too, and which on walls that go on behind a jamb.
    fn other_walls(&self, through: f64) -> (f64, f64) {
        let (sight, stretch) = (self.sight, self.stretch);
        let others = self.others();
        let line = &stretch.wall.line;
        let (mut explained, mut continued) = (0.0, 0.0);
        for place in self.inner.0..self.inner.1 {
            let bin = stretch.bin(place);
            let direction = sight.direction(bin);
            let at = line.inverse_range(direction);
            let least = at - sight.tolerance(at);
            let (entries, _) = sight.any_height(bin);
            let (mut all, mut on) = (0, 0);
            for entry in entries.iter().filter(|&&entry| entry < least) {
                all += 1;
                let lies_on = |wall: &&(&Wall, bool)| {
                    let other = wall.0.line.inverse_range(direction);
                    (entry - other).abs() <= sight.tolerance(other)
                };
                on += usize::from(others.iter().any(|wall| lies_on(&wall)));
            }
            let votes = stretch.votes(place).through;
            explained += votes * on as f64 / all.max(1) as f64;
            for (wall, _) in others.iter().filter(|(_, passes)| *passes) {
                let other = wall.line.inverse_range(direction);
                if other > 0.0 && other < least {
                    continued += wall.votes[bin].on.min(votes);
                }
            }
        }
        let through = through.max(f64::MIN_POSITIVE);
        (explained / through, (continued / through).min(1.0))
    }

    /// Walls with support outside the sector, and whether they pass by one of its jambs.
    fn others(&self) -> Vec<(&Wall, bool)> {
        let (n, stretch) = (self.sight.n(), self.stretch);
        let pad = 3 * n / 360;
        let len = (self.inner.1 - self.inner.0 + 2 * pad).min(n);
        let after = (stretch.bin(self.inner.0) + n - pad + len) % n;
        let jambs = [self.jambs.0, self.jambs.1].map(|place| stretch.at(place as f64));
        let passes = |wall: &Wall| {
            jambs.iter().any(|jamb| {
                let range = norm(*jamb);
                let other = wall.line.inverse_range(jamb.map(|x| x / range));
                other > 0.0 && (range - 1.0 / other).abs() < NEAR
            })
        };
        let supported = |wall: &Wall| wall.on(after, n - len) >= SUPPORT;
        let others = self.walls.iter().enumerate();
        others
            .filter(|(index, wall)| *index != self.index && supported(wall))
            .map(|(_, wall)| (wall, passes(wall)))
            .collect()
    }

    fn spread(&self, through: f64) -> f64 {
        let (mut sum, mut square) = (0.0, 0.0);
        for place in self.inner.0..self.inner.1 {
            let x = (place - self.inner.0) as f64 + 0.5;
            sum += self.stretch.votes(place).through * x;
            square += self.stretch.votes(place).through * x * x;
        }
        let through = through.max(f64::MIN_POSITIVE);
        let variance = square / through - (sum / through).powi(2);
        let even = (self.inner.1 - self.inner.0) as f64 / 12f64.sqrt();
        (variance.max(0.0).sqrt() / even).min(1.2)
    }

    fn contrast(&self) -> f64 {
        let n = self.sight.n();
        let median = |first: usize, len: usize| {
            let middles = (first..first + len).filter_map(|bin| {
                let (entries, _) = self.sight.seen(bin % n);
                entries.get(entries.len() / 2).copied()
            });
            crate::profile::median(&mut middles.collect::<Vec<f64>>())
        };
        let (start, len) = (self.stretch.bin(self.inner.0), self.inner.1 - self.inner.0);
        let half = (SURROUNDINGS * n / 360).min((n - 1) / 2);
        let around = median(start + len / 2 + n - half, 2 * half + 1);
        let inside = median(start, len);
        let ratio = around.zip(inside).map_or(1.0, |(a, b)| a / b);
        ratio.ln().clamp(-0.7, 1.5)
    }

    fn edge_depth(&self) -> f64 {
        let (start, end) = self.inner;
        let third = ((end - start) / 3).max(1);
        let depth = |places: std::ops::Range<usize>| {
            let (mut sum, mut all) = (0.0, 0.0);
            for place in places {
                let votes = self.stretch.votes(place);
                sum += votes.through * votes.depth.min(2.0);
                all += votes.through;
            }
            if all > 0.0 { sum / all } else { 0.0 }
        };
        depth(start..start + third)
            .min(depth(end - third..end))
            .min(1.0)
    }
}

/// The wall beside one jamb.
#[derive(Debug, Clone, Copy)]
struct Beside {
    /// Votes on it, and those on no stronger wall.
    votes: [f64; 2],
    bins: usize,
}

fn norm(p: [f64; 2]) -> f64 {
    p[0].hypot(p[1])
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    norm([p[0] - q[0], p[1] - q[1]])
}
