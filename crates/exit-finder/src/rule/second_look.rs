//! The second look at a map that was cleaned by its observations: among all its points, and among those that were kept.
//!
//! A cleaning errs both ways. With what it took out, walls are hidden among strays; without, far points behind doors are missing. So
//! candidates are looked for twice and judged together: by their own cues, by how likely each is alone, and by what both looks found in
//! the same direction and elsewhere. A forest fitted on generated rooms by
//! `cargo run --release -p examples --example fit_exit_forest -- 50000 1200 second` makes a probability of it. O(candidates²), some thousand pairs.

use super::cues::CUES;
use super::openings::Opening;
use super::score::bias;
use crate::angle::turn;
use crate::profile::RangeProfile;

/// Number of cues of the second look: those of the opening, and these, in this order.
///
/// The log odds by the first look; whether it was among the kept points; the share of the map that the cleaning took out. Then log odds
/// of other candidates: the largest and the mean in the same direction by the other look; the largest, and how many, by the same look;
/// the mean of those by the same look that are nearly the same sector; the largest elsewhere; the largest of narrower ones inside that
/// leave the middle out; the mean of the two largest about.
pub const SECOND_CUES: usize = CUES + 11;

/// A candidate of a map that was cleaned by its observations, with what two looks say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondLook {
    /// The candidate, as one of the looks found it.
    pub opening: Opening,
    /// What its probability is computed from, see [`SECOND_CUES`]; in single precision, as the thresholds are, since many are logarithms of
    /// small numbers and lie on one.
    pub cues: [f64; SECOND_CUES],
}

/// A candidate as the others see it.
struct Seen {
    middle: f64,
    width: f64,
    odds: f64,
    among_kept: bool,
}

/// Log odds of no candidate, and the largest that count.
const NONE: f64 = -8.0;
const SUREST: f64 = 13.8;
/// Common part over union from which two sectors are nearly the same.
const ALIKE: f64 = 0.3;
/// Candidates whose middles are nearer than this are about the same place, radians.
const ABOUT: f64 = 0.35;

/// Share of the points that the cleaning took out.
pub(super) fn taken_out(all: &RangeProfile, kept: &RangeProfile) -> f64 {
    1.0 - kept.counts.given as f64 / all.counts.given.max(1) as f64
}

/// The candidates found among all points and among the kept ones, with their cues.
pub(super) fn looked_at_twice(
    among_all: Vec<Opening>,
    among_kept: Vec<Opening>,
    taken_out: f64,
) -> Vec<SecondLook> {
    let bias = bias();
    let looks = [(&among_all, false), (&among_kept, true)];
    let seen: Vec<Seen> = looks
        .into_iter()
        .flat_map(|(found, among_kept)| found.iter().map(move |opening| (opening, among_kept)))
        .map(|(opening, among_kept)| Seen {
            middle: opening.sector.middle_rad(),
            width: opening.sector.width_rad,
            odds: opening.odds(bias).clamp(-SUREST, SUREST),
            among_kept,
        })
        .collect();
    let found = among_all.into_iter().chain(among_kept).enumerate();
    found
        .map(|(index, opening)| {
            let [odds, among_kept] = [
                seen[index].odds,
                f64::from(u8::from(seen[index].among_kept)),
            ];
            let company = Company::of(index, &seen).to_array();
            let mut cues = [0.0; SECOND_CUES];
            let all = opening
                .cues
                .into_iter()
                .chain([odds, among_kept, taken_out]);
            for (slot, cue) in cues.iter_mut().zip(all.chain(company)) {
                *slot = f64::from(cue as f32);
            }
            SecondLook { opening, cues }
        })
        .collect()
}

/// The other candidates, as one of them sees them.
struct Company {
    other_look: Largest,
    same_look: Largest,
    alike: Largest,
    elsewhere: Largest,
    inside: Largest,
    about: Largest,
}

impl Company {
    fn of(index: usize, seen: &[Seen]) -> Self {
        let mut company = Self {
            other_look: Largest::default(),
            same_look: Largest::default(),
            alike: Largest::default(),
            elsewhere: Largest::default(),
            inside: Largest::default(),
            about: Largest::default(),
        };
        let own = &seen[index];
        let others = seen.iter().enumerate();
        for (_, other) in others.filter(|&(other, _)| other != index) {
            company.add(own, other);
        }
        company
    }

    fn add(&mut self, own: &Seen, other: &Seen) {
        let apart = turn(own.middle, other.middle).abs();
        let holds = apart < 0.5 * other.width;
        let is_held = apart < 0.5 * own.width;
        let same_look = own.among_kept == other.among_kept;
        match (holds || is_held, same_look) {
            (true, true) => self.same_look.add(other.odds),
            (true, false) => self.other_look.add(other.odds),
            (false, _) => self.elsewhere.add(other.odds),
        }
        if !same_look {
            return;
        }
        let narrower = own.width.min(other.width);
        let common = (0.5 * (own.width + other.width) - apart).clamp(0.0, narrower);
        if common > ALIKE * (own.width + other.width - common) {
            self.alike.add(other.odds);
        }
        if is_held && !holds && other.width < own.width {
            self.inside.add(other.odds);
        }
        if apart < ABOUT {
            self.about.add(other.odds);
        }
    }

    fn to_array(&self) -> [f64; 8] {
        let about = if self.about.count > 1.0 {
            0.5 * (self.about.first + self.about.second)
        } else {
            NONE
        };
        [
            self.other_look.first,
            self.other_look.mean(),
            self.same_look.first,
            self.same_look.count,
            self.alike.mean(),
            self.elsewhere.first,
            self.inside.first,
            about,
        ]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sector::Run;

    /// A candidate from one degree on over some degrees.
    fn opening(start: usize, len: usize) -> Opening {
        let run = Run { start, len };
        Opening {
            sector: run.sector(360),
            width: 1.0,
            cues: [0.0; CUES],
            run,
            jamb_ranges: [2.0; 2],
        }
    }

    #[test]
    fn a_candidate_is_told_what_both_looks_found_there_and_elsewhere() {
        let among_all = vec![opening(350, 20), opening(352, 4), opening(100, 20)];
        let among_kept = vec![opening(345, 30)];
        let odds = opening(0, 1).odds(bias());
        let found = looked_at_twice(among_all, among_kept, 0.2);
        let company = |index: usize| found[index].cues[CUES + 3..].to_vec();
        let single = |x: f64| f64::from(x as f32);
        let (odds, share) = (single(odds), single(0.2));
        assert_eq!(found[0].cues[CUES..CUES + 3], [odds, 0.0, share]);
        assert_eq!(found[3].cues[CUES..CUES + 3], [odds, 1.0, share]);
        // The first is seen by the other look, holds the narrower second one but not in its middle, and the third is elsewhere.
        let expected = [odds, odds, odds, 1.0, NONE, odds, odds, NONE];
        assert_eq!(company(0), expected);
        // The third is alone: all others are elsewhere, and none is of the same direction.
        let expected = [NONE, NONE, NONE, 0.0, NONE, odds, NONE, NONE];
        assert_eq!(company(2), expected);
        // Turned by any angle it is the same.
        let turned = looked_at_twice(
            vec![opening(50, 20), opening(52, 4), opening(160, 20)],
            vec![opening(45, 30)],
            0.2,
        );
        for (a, b) in found.iter().zip(&turned) {
            assert_eq!(a.cues, b.cues);
        }
    }
}
