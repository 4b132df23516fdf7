//! The second look at a map that was cleaned by its observations: among all its points, and among those that were kept.
//!
//! A cleaning errs both ways. With what it took out, walls are hidden among strays; without, far points behind doors are missing. So
//! candidates are looked for twice and judged together: by their own cues, by how likely each is alone, and by what both looks found in
//! the same direction and elsewhere. A forest fitted on generated rooms by
//! `cargo run --release -p examples --example fit_exit_forest -- 30000 6500 second` makes a probability of it. O(candidates²), some thousand pairs.

use super::company::{COMPANY, Company, Seen};
use super::cues::CUES;
use super::openings::Opening;
use super::score::bias;
use crate::profile::RangeProfile;

/// Number of cues of the second look: those of the opening, and these, in this order.
///
/// The log odds by the first look; whether it was among the kept points; the share of the map that the cleaning took out. Then log odds
/// of other candidates: the largest and the mean in the same direction by the other look; the largest, and how many, by the same look;
/// the mean of those by the same look that are nearly the same sector; the largest elsewhere; the largest of narrower ones inside that
/// leave the middle out; the mean of the two largest about. Then, of the candidate of the other look that has most of its sector in common: the common
/// part over the union, and its log odds. How many openings one expects elsewhere by the same look, and here by the same and by the
/// other look, weighted by common part over union; by how much the others here are wider, as a logarithm. Last all cues of the
/// candidate of the other look.
pub const SECOND_CUES: usize = CUES + 3 + COMPANY;

/// A candidate of a map that was cleaned by its observations, with what two looks say of it.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondLook {
    /// The candidate, as one of the looks found it.
    pub opening: Opening,
    /// What its probability is computed from, see [`SECOND_CUES`]; in single precision, as the thresholds are, since many are logarithms of
    /// small numbers and lie on one.
    pub cues: [f64; SECOND_CUES],
}

/// Share of the points that the cleaning took out.
pub(super) fn taken_out(all: &RangeProfile, kept: &RangeProfile) -> f64 {
    1.0 - kept.counts.given as f64 / all.counts.given.max(1) as f64
}

/// The candidates found among all points and among the kept ones, with their cues.
pub(super) fn looked_at_twice(
    among_all: Vec<Opening>,
    among_kept: Vec<Opening>,
    taken_out: f64,
    needed: f64,
) -> Vec<SecondLook> {
    let bias = bias();
    let looks = [(&among_all, false), (&among_kept, true)];
    let seen: Vec<Seen<'_>> = looks
        .into_iter()
        .flat_map(|(found, among_kept)| found.iter().map(move |opening| (opening, among_kept)))
        .map(|(opening, among_kept)| Seen::new(opening, opening.odds(bias), among_kept, needed))
        .collect();
    let company: Vec<[f64; COMPANY]> = (0..seen.len())
        .map(|index| Company::of(index, &seen).to_array())
        .collect();
    let own: Vec<[f64; 3]> = seen
        .iter()
        .map(|one| [one.odds(), f64::from(u8::from(one.among_kept)), taken_out])
        .collect();
    let found = among_all.into_iter().chain(among_kept);
    found
        .zip(own.into_iter().zip(company))
        .map(|(opening, (own, company))| {
            let mut cues = [0.0; SECOND_CUES];
            let all = opening.cues.into_iter().chain(own).chain(company);
            for (slot, cue) in cues.iter_mut().zip(all) {
                *slot = f64::from(cue as f32);
            }
            SecondLook { opening, cues }
        })
        .collect()
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
        let mut nearest = opening(345, 30);
        nearest.cues[3] = 0.5;
        let odds = opening(0, 1).odds(bias());
        let other = nearest.odds(bias());
        let found = looked_at_twice(among_all, vec![nearest.clone()], 0.2, 0.6);
        let company = |index: usize| found[index].cues[CUES + 3..].to_vec();
        let single = |x: f64| f64::from(x as f32);
        assert_eq!(
            found[0].cues[CUES..CUES + 3],
            [single(odds), 0.0, single(0.2)]
        );
        assert_eq!(
            found[3].cues[CUES..CUES + 3],
            [single(other), 1.0, single(0.2)]
        );
        let expected = |odds: f64| odds.exp().ln_1p();
        let [e, f] = [odds, other].map(expected);
        // The first is seen by the other look, holds the narrower second one but not in its middle, and the third is elsewhere.
        let mut first = vec![other, other, odds, 1.0, -8.0, odds, odds, -8.0];
        first.extend([2.0 / 3.0, other, e, 0.2 * e, 2.0 / 3.0 * f, 0.2f64.ln()]);
        first.extend(nearest.cues);
        assert_near(&company(0), &first);
        // The third is alone: all others are elsewhere, and none is of the same direction.
        let largest = odds.max(other);
        let width = 20f64.to_radians();
        let mut third = vec![-8.0, -8.0, -8.0, 0.0, -8.0, largest, -8.0, -8.0];
        third.extend([0.0, -8.0, 2.0 * e, 0.0, 0.0, -width.ln()]);
        third.extend([-8.0; CUES]);
        assert_near(&company(2), &third);
        // Turned by any angle it is the same.
        let mut nearest = opening(45, 30);
        nearest.cues[3] = 0.5;
        let turned = vec![opening(50, 20), opening(52, 4), opening(160, 20)];
        let turned = looked_at_twice(turned, vec![nearest], 0.2, 0.6);
        for (a, b) in found.iter().zip(&turned) {
            assert_near(&a.cues, &b.cues);
        }
    }

    #[test]
    fn a_narrow_candidate_is_no_company() {
        let narrow = Opening {
            width: 0.5,
            ..opening(352, 4)
        };
        let found = looked_at_twice(vec![opening(350, 20), narrow], Vec::new(), 0.2, 0.6);
        let same_look = |index: usize| found[index].cues[CUES + 6];
        assert_eq!([same_look(0), same_look(1)], [0.0, 1.0]);
    }

    fn assert_near(given: &[f64], expected: &[f64]) {
        assert_eq!(given.len(), expected.len());
        for (index, (a, b)) in given.iter().zip(expected).enumerate() {
            assert!((a - b).abs() < 1e-5, "{index}: {a} {b}");
        }
    }
}
