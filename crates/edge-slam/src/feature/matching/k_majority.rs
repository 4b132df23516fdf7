//! Clusters of binary descriptors by k-majority (Grana et al. 2013): k-means where distance is Hamming's and a centre is what
//! most members say, bit by bit.
//!
//! Input:   descriptors, which of them to cluster, the number of clusters, a generator.
//! Output:  at most that many clusters, each with at least one member; fewer when fewer descriptors differ.
//! Method:  seeds as k-means++ draws them (Arthur & Vassilvitskii 2007); then members go to the nearest centre (the earlier one on
//!          a tie) and centres become majorities, until nothing changes or the rounds are over. Neither step raises the sum of
//!          distances: the majority minimises it bit by bit.
//! Cost:    O(members · clusters · rounds).

use rand::{Rng, RngExt};

use crate::feature::Descriptor;
use crate::simd::{Kernel, widest};

/// What a cluster's members have in common.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cluster {
    pub(super) centre: Descriptor,
    /// Indices into all descriptors, in the order given.
    pub(super) members: Vec<usize>,
}

pub(super) fn k_majority(
    descriptors: &[Descriptor],
    members: &[usize],
    clusters: usize,
    rounds: usize,
    rng: &mut impl Rng,
) -> Vec<Cluster> {
    let chosen: Vec<Descriptor> = members.iter().map(|&index| descriptors[index]).collect();
    let mut centres = seeds(&chosen, clusters, rng);
    let mut owners = nearest_centres(&chosen, &centres);
    for _ in 0..rounds {
        centres = majorities(&chosen, &owners, &centres);
        let moved = nearest_centres(&chosen, &centres);
        if moved == owners {
            break;
        }
        owners = moved;
    }
    let cluster = |centre| Cluster {
        centre,
        members: Vec::new(),
    };
    let mut found: Vec<Cluster> = centres.into_iter().map(cluster).collect();
    for (&index, &owner) in members.iter().zip(&owners) {
        found[owner].members.push(index);
    }
    found.retain(|cluster| !cluster.members.is_empty());
    found
}

/// Distinct descriptors, each drawn with a chance that grows with the squared distance to the nearest before.
fn seeds(chosen: &[Descriptor], clusters: usize, rng: &mut impl Rng) -> Vec<Descriptor> {
    if chosen.is_empty() {
        return Vec::new();
    }
    let mut seeds = vec![chosen[rng.random_range(0..chosen.len())]];
    let mut squares = vec![u64::MAX; chosen.len()];
    while seeds.len() < clusters {
        let last = seeds[seeds.len() - 1];
        for (square, descriptor) in squares.iter_mut().zip(chosen) {
            *square = u64::from(descriptor.distance(&last)).pow(2).min(*square);
        }
        let total: u64 = squares.iter().sum();
        if total == 0 {
            break;
        }
        let mut ticket = rng.random_range(0..total);
        let drawn = squares.iter().position(|&square| {
            let is_drawn = ticket < square;
            ticket = ticket.saturating_sub(square);
            is_drawn
        });
        seeds.push(chosen[drawn.unwrap_or(0)]);
    }
    seeds
}

/// What more than half of each centre's members say; half of them leaves the bit as it was.
fn majorities(chosen: &[Descriptor], owners: &[usize], centres: &[Descriptor]) -> Vec<Descriptor> {
    let mut votes = vec![[0_i32; 256]; centres.len()];
    for (descriptor, &owner) in chosen.iter().zip(owners) {
        for (word, votes) in descriptor.0.iter().zip(votes[owner].chunks_exact_mut(64)) {
            for (bit, vote) in votes.iter_mut().enumerate() {
                *vote += if word >> bit & 1 == 1 { 1 } else { -1 };
            }
        }
    }
    let elect = |(votes, before): (&[i32; 256], &Descriptor)| {
        let mut centre = *before;
        for (bit, vote) in votes.iter().enumerate().filter(|(_, vote)| **vote != 0) {
            let (word, mask) = (&mut centre.0[bit / 64], 1 << (bit % 64));
            *word = if *vote > 0 {
                *word | mask
            } else {
                *word & !mask
            };
        }
        centre
    };
    votes.iter().zip(centres).map(elect).collect()
}

fn nearest_centres(chosen: &[Descriptor], centres: &[Descriptor]) -> Vec<usize> {
    let mut owners = vec![0; chosen.len()];
    widest(Assign {
        chosen,
        centres,
        owners: &mut owners,
    });
    owners
}

/// The centre that a descriptor is nearest to; the earlier one on a tie.
#[inline(always)]
pub(super) fn nearest_centre<'a>(
    descriptor: &Descriptor,
    centres: impl Iterator<Item = &'a Descriptor>,
) -> usize {
    let mut best = (u32::MAX, 0);
    for (index, centre) in centres.enumerate() {
        let distance = descriptor.distance(centre);
        if distance < best.0 {
            best = (distance, index);
        }
    }
    best.1
}

struct Assign<'a> {
    chosen: &'a [Descriptor],
    centres: &'a [Descriptor],
    owners: &'a mut [usize],
}

impl Kernel for Assign<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (descriptor, owner) in self.chosen.iter().zip(self.owners) {
            *owner = nearest_centre(descriptor, self.centres.iter());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::SeedableRng;

    fn cost(chosen: &[Descriptor], owners: &[usize], centres: &[Descriptor]) -> u32 {
        chosen
            .iter()
            .zip(owners)
            .map(|(d, &owner)| d.distance(&centres[owner]))
            .sum()
    }

    proptest! {
        #[test]
        fn no_step_raises_the_sum_of_distances(words in prop::collection::vec(any::<[u64; 4]>(), 1..60), clusters in 1_usize..8, seed in any::<u64>()) {
            let chosen: Vec<Descriptor> = words.into_iter().map(Descriptor).collect();
            let mut centres = seeds(&chosen, clusters, &mut rand_pcg::Pcg64::seed_from_u64(seed));
            let mut owners = nearest_centres(&chosen, &centres);
            let mut before = cost(&chosen, &owners, &centres);
            for _ in 0..4 {
                centres = majorities(&chosen, &owners, &centres);
                let elected = cost(&chosen, &owners, &centres);
                owners = nearest_centres(&chosen, &centres);
                let moved = cost(&chosen, &owners, &centres);
                prop_assert!(elected <= before && moved <= elected);
                before = moved;
            }
        }

        #[test]
        fn every_member_is_in_one_cluster(words in prop::collection::vec(any::<[u64; 1]>(), 0..40), clusters in 1_usize..12, seed in any::<u64>()) {
            // Few bits, so that descriptors repeat.
            let all: Vec<Descriptor> = words.into_iter().map(|[w]| Descriptor([w & 3, 0, 0, w & 4])).collect();
            let members: Vec<usize> = (0..all.len()).step_by(2).collect();
            let found = k_majority(&all, &members, clusters, 5, &mut rand_pcg::Pcg64::seed_from_u64(seed));
            prop_assert!(found.len() <= clusters && found.iter().all(|c| !c.members.is_empty()));
            let mut held: Vec<usize> = found.iter().flat_map(|c| c.members.clone()).collect();
            held.sort_unstable();
            prop_assert_eq!(held, members);
        }

        #[test]
        fn copies_of_few_descriptors_are_told_apart(words in prop::collection::hash_set(any::<[u64; 4]>(), 1..9), seed in any::<u64>()) {
            let all: Vec<Descriptor> = words.iter().chain(&words).map(|w| Descriptor(*w)).collect();
            let members: Vec<usize> = (0..all.len()).collect();
            let found = k_majority(&all, &members, 10, 5, &mut rand_pcg::Pcg64::seed_from_u64(seed));
            prop_assert_eq!(found.len(), words.len());
            prop_assert!(found.iter().all(|c| c.members.iter().all(|&k| all[k] == c.centre)));
        }
    }
}
