//! What the other candidates of a map say about one of them.

use super::cues::CUES;
use super::openings::Opening;
use crate::angle::turn;

/// A candidate as the others see it.
pub(super) struct Seen<'a> {
    opening: &'a Opening,
    middle: f64,
    width: f64,
    odds: f64,
    pub(super) among_kept: bool,
    is_wide: bool,
}

/// Log odds of no candidate, and the largest that count; also every cue of a candidate that is none.
pub(super) const NONE: f64 = -8.0;
const SUREST: f64 = 13.8;
/// Common part over union from which two sectors are nearly the same, and from which they may be the same opening.
const ALIKE: f64 = 0.3;
const SAME: f64 = 0.2;
/// Candidates whose middles are nearer than this are about the same place, radians.
const ABOUT: f64 = 0.35;

/// Sectors begin and end with bins, so that many are equal but for rounding: by less than this nothing is larger.
const ROUNDING: f64 = 2e-6;

/// Number of cues of the company: fourteen numbers, and the cues of the other look's nearest.
pub(super) const COMPANY: usize = 14 + CUES;

impl<'a> Seen<'a> {
    /// A candidate with its log odds by the first look. Those narrower than needed are no company: they say nothing of wider ones.
    pub(super) fn new(opening: &'a Opening, odds: f64, among_kept: bool, needed: f64) -> Self {
        Self {
            opening,
            middle: opening.sector.middle_rad(),
            width: opening.sector.width_rad,
            odds: odds.clamp(-SUREST, SUREST),
            among_kept,
            is_wide: opening.width >= needed,
        }
    }

    pub(super) fn odds(&self) -> f64 {
        self.odds
    }

    /// How many openings one expects of it.
    fn expected(&self) -> f64 {
        self.odds.max(NONE).exp().ln_1p()
    }

    /// Common part of the sectors over their union, middles so far apart.
    fn overlap(&self, other: &Self, apart: f64) -> f64 {
        let narrower = self.width.min(other.width);
        let both = self.width + other.width;
        let common = (0.5 * both - apart).clamp(0.0, narrower);
        common / (both - common).max(f64::MIN_POSITIVE)
    }
}

/// The other candidates, as one of them sees them.
pub(super) struct Company<'a> {
    own: &'a Seen<'a>,
    other_look: Largest,
    same_look: Largest,
    alike: Largest,
    elsewhere: Largest,
    inside: Largest,
    about: Largest,
    /// The candidate of the other look that has most in common with it, and its overlap.
    nearest: Option<(&'a Seen<'a>, f64)>,
    /// Openings that one expects elsewhere by the same look; and here by the same and by the other look, weighted by the overlap.
    expected_elsewhere: f64,
    expected_by_same: f64,
    expected_by_other: f64,
    /// Overlaps with those of the same look, and logs of their widths so weighted.
    overlaps: f64,
    widths: f64,
}

impl<'a> Company<'a> {
    /// What the one with this index is among.
    pub(super) fn of(index: usize, seen: &'a [Seen<'a>]) -> Self {
        let mut company = Self {
            own: &seen[index],
            other_look: Largest::default(),
            same_look: Largest::default(),
            alike: Largest::default(),
            elsewhere: Largest::default(),
            inside: Largest::default(),
            about: Largest::default(),
            nearest: None,
            expected_elsewhere: 0.0,
            expected_by_same: 0.0,
            expected_by_other: 0.0,
            overlaps: 0.0,
            widths: 0.0,
        };
        for (other, candidate) in seen.iter().enumerate() {
            if other != index && candidate.is_wide {
                company.add(candidate);
            }
        }
        company
    }

    fn add(&mut self, other: &'a Seen<'a>) {
        let own = self.own;
        let apart = turn(own.middle, other.middle).abs();
        let holds = apart + ROUNDING < 0.5 * other.width;
        let is_held = apart + ROUNDING < 0.5 * own.width;
        let same_look = own.among_kept == other.among_kept;
        match (holds || is_held, same_look) {
            (true, true) => self.same_look.add(other.odds),
            (true, false) => self.other_look.add(other.odds),
            (false, _) => self.elsewhere.add(other.odds),
        }
        let overlap = own.overlap(other, apart);
        if same_look {
            self.add_of_same_look(other, apart, overlap);
            if is_held && !holds && other.width + ROUNDING < own.width {
                self.inside.add(other.odds);
            }
        } else {
            self.expected_by_other += overlap * other.expected();
            if overlap > self.nearest.map_or(0.0, |(_, most)| most) + ROUNDING {
                self.nearest = Some((other, overlap));
            }
        }
    }

    fn add_of_same_look(&mut self, other: &Seen<'_>, apart: f64, overlap: f64) {
        if overlap > ALIKE + ROUNDING {
            self.alike.add(other.odds);
        }
        if apart + ROUNDING < ABOUT {
            self.about.add(other.odds);
        }
        if apart > 0.5 * other.width.max(self.own.width) + ROUNDING {
            self.expected_elsewhere += other.expected();
        }
        self.expected_by_same += overlap * other.expected();
        self.overlaps += overlap;
        self.widths += overlap * other.width.ln();
    }

    pub(super) fn to_array(&self) -> [f64; COMPANY] {
        let about = if self.about.count > 1.0 {
            0.5 * (self.about.first + self.about.second)
        } else {
            NONE
        };
        let same = self
            .nearest
            .filter(|(_, overlap)| *overlap > SAME + ROUNDING);
        let numbers = [
            self.other_look.first,
            self.other_look.mean(),
            self.same_look.first,
            self.same_look.count,
            self.alike.mean(),
            self.elsewhere.first,
            self.inside.first,
            about,
            self.nearest.map_or(0.0, |(_, overlap)| overlap),
            same.map_or(NONE, |(other, _)| other.odds.max(NONE)),
            self.expected_elsewhere,
            self.expected_by_same,
            self.expected_by_other,
            self.widths / self.overlaps.max(1e-6) - self.own.width.ln(),
        ];
        let cues = same.map_or([NONE; CUES], |(other, _)| other.opening.cues);
        let mut all = [0.0; COMPANY];
        for (slot, cue) in all.iter_mut().zip(numbers.into_iter().chain(cues)) {
            *slot = cue;
        }
        all
    }
}

/// The two largest of some log odds, their sum and their number.
struct Largest {
    first: f64,
    second: f64,
    sum: f64,
    count: f64,
}

impl Default for Largest {
    fn default() -> Self {
        Self {
            first: NONE,
            second: NONE,
            sum: 0.0,
            count: 0.0,
        }
    }
}

impl Largest {
    fn add(&mut self, odds: f64) {
        let first = if self.count > 0.0 { self.first } else { odds };
        self.second = if self.count > 0.0 {
            self.second.max(first.min(odds))
        } else {
            NONE
        };
        self.first = first.max(odds);
        self.sum += odds;
        self.count += 1.0;
    }

    fn mean(&self) -> f64 {
        if self.count > 0.0 {
            self.sum / self.count
        } else {
            NONE
        }
    }
}
