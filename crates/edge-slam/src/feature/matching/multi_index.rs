//! Exact nearest descriptors by multi-index hashing (Norouzi, Punjani & Fleet 2012): what a KD-tree is for distances of
//! real vectors, for distances of bits.
//!
//! Input:   descriptors to look among; descriptors to look for.
//! Output:  the nearest and how far the second nearest is, the same as by comparing all.
//! Method:  the 256 bits are cut into `pieces` pieces of about log2 n bits, with a table from a piece's value to the
//!          descriptors that have it. Round s visits, table by table, the values that differ from the query's by s bits.
//!          After tables 0..=j of round s every descriptor within `pieces * s + j` bits has been met: one that is farther in
//!          each of those pieces than s, and farther than s - 1 in each of the others, is farther than that altogether.
//!          The search ends as soon as what has been met decides the question.
//! Cost:    few probes where the nearest is within some bits a piece; the number of values grows as s-combinations of a
//!          piece's bits. When the next probes cost more than comparing all, all are compared: never much worse than that.
//!          Memory O(pieces (n + 2^bits)), 4 bytes each.
//! Degenerate: no descriptor gives no match; equal descriptors share their buckets, and ties go to the lower index.

use super::{Match, MatchConfig, Nearest};
use crate::feature::Descriptor;
use crate::simd::{Kernel, widest};

/// Descriptors with tables to find near ones without comparing all.
#[derive(Debug, Clone)]
pub struct MultiIndex {
    descriptors: Vec<Descriptor>,
    /// Bits of a piece.
    width: u32,
    tables: Vec<Table>,
}

/// For each descriptor of `first` its nearest in `second`, where that is a match; ascending by `first`. The same matches as
/// [`super::match_descriptors`].
///
/// Pays where near copies are sought among tens of thousands; two frames of a thousand are matched faster by comparing all
/// (figures in `docs/measurements.md`). The first side is searched for the mutual test only.
///
/// ```
/// use edge_slam::feature::{Descriptor, MatchConfig, MultiIndex, match_indexed};
/// let first = MultiIndex::new(&[Descriptor([7; 4])]);
/// let second = MultiIndex::new(&[Descriptor([!7; 4]), Descriptor([5; 4])]);
/// let found = match_indexed(&first, &second, &MatchConfig::default());
/// assert_eq!((found[0].second, found[0].distance), (1, 4));
/// ```
#[must_use]
pub fn match_indexed(first: &MultiIndex, second: &MultiIndex, config: &MatchConfig) -> Vec<Match> {
    let mut met = Met::new(second.descriptors.len());
    let mut met_back = Met::new(first.descriptors.len());
    let mut matches = Vec::new();
    for (index, query) in first.descriptors.iter().enumerate() {
        let mut nearest = Nearest::default();
        second.search(query, &mut met, &mut nearest, |best, within| {
            is_decided(best, within, config)
        });
        let Some(found) = nearest.accept(index, config) else {
            continue;
        };
        if config.mutual {
            let mut back = Nearest::default();
            back.offer_unordered(index, found.distance);
            let target = &second.descriptors[found.second];
            first.search(target, &mut met_back, &mut back, |best, within| {
                best.index != index || within >= best.distance
            });
            if back.index != index {
                continue;
            }
        }
        matches.push(found);
    }
    matches
}

/// Whether [`Nearest::accept`] cannot change any more, when all within `within` bits have been offered.
fn is_decided(best: &Nearest, within: u32, config: &MatchConfig) -> bool {
    if best.distance > within {
        return within >= config.max_distance;
    }
    let clear_of = |second: u32| f64::from(best.distance) < config.ratio * f64::from(second);
    let is_second_known = best.second <= within;
    is_second_known || clear_of(within + 1) || (best.second != u32::MAX && !clear_of(best.second))
}

impl MultiIndex {
    /// Tables over these descriptors. Cost: O(pieces · n), for 1,000 descriptors as much as matching 100 of them by comparing all.
    ///
    /// Holds at most 2^32 - 1 descriptors; any more are not found.
    #[must_use]
    pub fn new(descriptors: &[Descriptor]) -> Self {
        let count = descriptors.len().min(u32::MAX as usize);
        let descriptors = descriptors[..count].to_vec();
        let width = count
            .checked_ilog2()
            .unwrap_or(0)
            .clamp(LEAST_WIDTH, MOST_WIDTH);
        let tables =
            (0..BITS.div_ceil(width)).map(|piece| Table::new(&descriptors, piece * width, width));
        Self {
            width,
            tables: tables.collect(),
            descriptors,
        }
    }

    /// The descriptors, in the order of their indices.
    #[must_use]
    pub fn descriptors(&self) -> &[Descriptor] {
        &self.descriptors
    }

    /// The nearest descriptor's index and distance; the lower index on a tie. `None` when there is none within `max_distance` bits.
    #[must_use]
    pub fn nearest(&self, query: &Descriptor, max_distance: u32) -> Option<(usize, u32)> {
        let mut nearest = Nearest::default();
        let mut met = Met::new(self.descriptors.len());
        self.search(query, &mut met, &mut nearest, |best, within| {
            within >= best.distance.min(max_distance)
        });
        (nearest.distance <= max_distance).then_some((nearest.index, nearest.distance))
    }

    /// Offers descriptors to `nearest`, near ones first, until `is_decided(nearest, within)` with all within `within` bits offered.
    /// What `nearest` held before must be one of them.
    #[expect(clippy::cast_precision_loss, reason = "only weighs costs")]
    fn search(
        &self,
        query: &Descriptor,
        met: &mut Met,
        nearest: &mut Nearest,
        is_decided: impl Fn(&Nearest, u32) -> bool,
    ) {
        met.forget();
        let pieces = BITS.div_ceil(self.width);
        let mut left = PATIENCE * self.descriptors.len() as f64 / SCATTERED;
        for flips in 0..=self.width {
            let probes = combinations(self.width, flips);
            for (piece, table) in (0..).zip(&self.tables) {
                left -= probes;
                if left < 0.0 {
                    *nearest = Nearest::default();
                    return self.offer(0..self.descriptors.len(), query, nearest);
                }
                let value = piece_of(query, table.start, table.width);
                met.fresh.clear();
                for_each_mask(table.width, flips, |mask| {
                    met.meet(table.with(value ^ mask));
                });
                left -= met.fresh.len() as f64;
                self.offer(
                    met.fresh.iter().map(|&index| index as usize),
                    query,
                    nearest,
                );
                if is_decided(nearest, pieces * flips + piece) {
                    return;
                }
            }
        }
    }

    fn offer(
        &self,
        indices: impl Iterator<Item = usize>,
        query: &Descriptor,
        nearest: &mut Nearest,
    ) {
        widest(Offer {
            descriptors: &self.descriptors,
            indices,
            query,
            nearest,
        });
    }
}

/// Offers some of the descriptors.
struct Offer<'a, I> {
    descriptors: &'a [Descriptor],
    indices: I,
    query: &'a Descriptor,
    nearest: &'a mut Nearest,
}

impl<I: Iterator<Item = usize>> Kernel for Offer<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for index in self.indices {
            let distance = self.query.distance(&self.descriptors[index]);
            self.nearest.offer_unordered(index, distance);
        }
    }
}

/// Descriptors by the value of `width` bits from `start` on: those with value v are `members[starts[v]..starts[v + 1]]`.
#[derive(Debug, Clone)]
struct Table {
    start: u32,
    width: u32,
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Table {
    #[expect(clippy::cast_possible_truncation, reason = "counted in 32 bits before")]
    fn new(descriptors: &[Descriptor], start: u32, width: u32) -> Self {
        let width = width.min(BITS - start);
        let mut starts = vec![0_u32; (1 << width) + 1];
        for descriptor in descriptors {
            starts[piece_of(descriptor, start, width) + 1] += 1;
        }
        for value in 1..starts.len() {
            starts[value] += starts[value - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; descriptors.len()];
        for (index, descriptor) in descriptors.iter().enumerate() {
            let slot = &mut next[piece_of(descriptor, start, width)];
            members[*slot as usize] = index as u32;
            *slot += 1;
        }
        Self {
            start,
            width,
            starts,
            members,
        }
    }

    fn with(&self, value: usize) -> &[u32] {
        &self.members[self.starts[value] as usize..self.starts[value + 1] as usize]
    }
}

/// Which descriptors the present search has met; forgetting costs nothing.
struct Met {
    search: u32,
    last: Vec<u32>,
    /// Those met last, to be compared.
    fresh: Vec<u32>,
}

impl Met {
    fn new(count: usize) -> Self {
        Self {
            search: 0,
            last: vec![0; count],
            fresh: Vec::new(),
        }
    }

    fn forget(&mut self) {
        if self.search == u32::MAX {
            self.last.fill(0);
            self.search = 0;
        }
        self.search += 1;
    }

    fn meet(&mut self, members: &[u32]) {
        for &index in members {
            if core::mem::replace(&mut self.last[index as usize], self.search) != self.search {
                self.fresh.push(index);
            }
        }
    }
}

/// `width` bits from bit `start` on.
#[expect(clippy::cast_possible_truncation, reason = "at most 16 bits")]
fn piece_of(descriptor: &Descriptor, start: u32, width: u32) -> usize {
    let (word, shift) = ((start / 64) as usize, start % 64);
    let mut bits = descriptor.0[word] >> shift;
    if shift + width > 64 {
        bits |= descriptor.0[word + 1] << (64 - shift);
    }
    (bits & ((1 << width) - 1)) as usize
}

/// All numbers below 2^width with `ones` bits, ascending (Gosper's successor).
fn for_each_mask(width: u32, ones: u32, mut visit: impl FnMut(usize)) {
    if ones > width {
        return;
    }
    let mut mask = (1_usize << ones) - 1;
    while mask < 1 << width {
        visit(mask);
        if mask == 0 {
            return;
        }
        let low = mask & mask.wrapping_neg();
        let carried = mask + low;
        mask = carried | (((mask ^ carried) >> 2) / low);
    }
}

fn combinations(n: u32, k: u32) -> f64 {
    (0..k).fold(1.0, |product, i| {
        product * f64::from(n - i) / f64::from(i + 1)
    })
}

const BITS: u32 = 256;
/// Bits of a piece: fewer leave too many in a bucket, more make tables larger than caches.
const LEAST_WIDTH: u32 = 8;
const MOST_WIDTH: u32 = 16;
/// What looking into a bucket, or at a descriptor that lies anywhere, costs in comparisons of descriptors that lie in a row: about 9 ns
/// against 1.6 where 100,000 were measured.
const SCATTERED: f64 = 6.0;
/// What a search may spend before it compares all, as a share of that.
const PATIENCE: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::match_descriptors;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};

    /// `count` descriptors of which many are near to each other: `centres` with some bits turned.
    fn crowded(count: usize, centres: usize, turned: u32, seed: u64) -> Vec<Descriptor> {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(seed);
        let centres: Vec<[u64; 4]> = (0..centres).map(|_| rng.random()).collect();
        let mut draw = |_| {
            let mut bits = centres[rng.random_range(0..centres.len())];
            for _ in 0..rng.random_range(0..=turned) {
                bits[rng.random_range(0..4)] ^= 1 << rng.random_range(0..64);
            }
            Descriptor(bits)
        };
        (0..count).map(&mut draw).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn finds_what_comparing_all_finds(
            counts in [0_usize..400, 0_usize..400], centres in 1_usize..60, turned in 0_u32..60, seed in any::<u64>(),
            max_distance in 0_u32..=256, ratio in 0.3..=1.0, mutual in any::<bool>(),
        ) {
            let all = crowded(counts[0] + counts[1], centres, turned, seed);
            let (first, second) = all.split_at(counts[0]);
            let config = MatchConfig { max_distance, ratio, mutual };
            let found = match_indexed(&MultiIndex::new(first), &MultiIndex::new(second), &config);
            prop_assert_eq!(found, match_descriptors(first, second, &config));
        }

        #[test]
        fn every_radius_agrees_with_comparing_all(count in 0_usize..300, turned in 0_u32..90, seed in any::<u64>(), radius in 0_u32..256) {
            let all = crowded(count + 1, 9, turned, seed);
            let (query, rest) = all.split_first().unwrap();
            let expected = (0..count).map(|k| (query.distance(&rest[k]), k)).min().filter(|found| found.0 <= radius);
            prop_assert_eq!(MultiIndex::new(rest).nearest(query, radius), expected.map(|(distance, k)| (k, distance)));
        }

        #[test]
        fn masks_are_all_values_with_so_many_bits(width in 1_u32..=12, ones in 0_u32..=13) {
            let mut found = Vec::new();
            for_each_mask(width, ones, |mask| found.push(mask));
            let expected: Vec<usize> = (0..1 << width).filter(|mask: &usize| mask.count_ones() == ones).collect();
            prop_assert_eq!(&found, &expected);
            if ones <= width {
                prop_assert_eq!(combinations(width, ones).round() as usize, found.len());
            }
        }

        #[test]
        fn pieces_are_the_bits(bits in any::<[u64; 4]>(), start in 0_u32..250, width in 1_u32..=16) {
            let width = width.min(BITS - start);
            let bit = |k: u32| bits[(k / 64) as usize] >> (k % 64) & 1;
            let expected = (0..width).map(|k| (bit(start + k) as usize) << k).sum::<usize>();
            prop_assert_eq!(piece_of(&Descriptor(bits), start, width), expected);
        }
    }

    /// Large enough that rounds of probes decide, and not comparing all.
    #[test]
    fn many_descriptors_agree_with_comparing_all() {
        let all = crowded(20_000, 4_000, 12, 5);
        let (first, second) = all.split_at(200);
        let found = match_indexed(
            &MultiIndex::new(first),
            &MultiIndex::new(second),
            &MatchConfig::default(),
        );
        assert_eq!(
            found,
            match_descriptors(first, second, &MatchConfig::default())
        );
        assert!(found.len() > 10, "{}", found.len());
    }
}
