//! Hamming matching of all pairs: the exact answer that the other searches are held against.

use super::{Match, MatchConfig, Nearest};
use crate::feature::Descriptor;
use crate::simd::{Kernel, widest};

/// For each descriptor of `first` its nearest in `second`, where that is a match; ascending by `first`.
///
/// Ties in distance go to the lower index (and fail any ratio below 1). Empty slices give no match.
/// Cost: O(n m), about 1 ns per pair.
///
/// ```
/// use edge_slam::feature::{Descriptor, MatchConfig, match_descriptors};
/// let found = match_descriptors(
///     &[Descriptor([7; 4])],
///     &[Descriptor([!7; 4]), Descriptor([5; 4])],
///     &MatchConfig::default(),
/// );
/// assert_eq!((found[0].second, found[0].distance), (1, 4));
/// ```
#[must_use]
pub fn match_descriptors(
    first: &[Descriptor],
    second: &[Descriptor],
    config: &MatchConfig,
) -> Vec<Match> {
    let mut reverse = vec![Nearest::default(); second.len()];
    let mut forward = vec![Nearest::default(); first.len()];
    widest(Compare {
        first,
        second,
        forward: &mut forward,
        reverse: &mut reverse,
    });
    let accepted = forward.iter().enumerate().filter_map(|(index, nearest)| {
        let found = nearest.accept(index, config)?;
        (!config.mutual || reverse[found.second].index == index).then_some(found)
    });
    accepted.collect()
}

/// Offers every pair to both of its descriptors.
struct Compare<'a> {
    first: &'a [Descriptor],
    second: &'a [Descriptor],
    forward: &'a mut [Nearest],
    reverse: &'a mut [Nearest],
}

impl Kernel for Compare<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            first,
            second,
            forward,
            reverse,
        } = self;

        for (index, (query, best)) in first.iter().zip(forward).enumerate() {
            for (other, (candidate, back)) in second.iter().zip(&mut *reverse).enumerate() {
                let distance = query.distance(candidate);
                best.offer(other, distance);
                back.offer(index, distance);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::matching::descriptors;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_brute_force(a in descriptors(12), b in descriptors(12)) {
            let config = MatchConfig { max_distance: 128, ratio: 0.99, mutual: true };
            let mut expected = Vec::new();
            for (i, x) in a.iter().enumerate() {
                let mut order: Vec<usize> = (0..b.len()).collect();
                order.sort_by_key(|&j| (x.distance(&b[j]), j));
                let Some(&j) = order.first() else { continue };
                let distance = x.distance(&b[j]);
                let clear = order.get(1).is_none_or(|&k| {
                    f64::from(distance) < 0.99 * f64::from(x.distance(&b[k]))
                });
                let back = (0..a.len()).min_by_key(|&k| (a[k].distance(&b[j]), k));
                if clear && distance <= 128 && back == Some(i) {
                    expected.push(Match { first: i, second: j, distance });
                }
            }
            prop_assert_eq!(match_descriptors(&a, &b, &config), expected);
        }
    }
}
