//! Clients in blocks of neighbours that are skipped where no facility of a box can serve them better.

use super::gain_bound::{BLOCK, Block, FacilityBox, GainBound, Kernel32, on_grid};
use super::similarity::{Kernel, Points};
use crate::points::squared_distance;

/// All clients, in blocks and groups of blocks.
pub(super) struct ClientBlocks {
    kernel: Kernel32,
    /// Squared distance beyond which the kernel is 0.
    reach: f64,
    order: Vec<u32>,
    blocks: Vec<Block>,
    regions: Vec<Region>,
    groups: Vec<Region>,
    largest_weight: f64,
    /// Scratch: the blocks that are not skipped.
    busy: Vec<usize>,
    arch: pulp::Arch,
}

/// A box of clients and the facility nearest to its centre.
struct Region {
    low: [f64; 3],
    high: [f64; 3],
    facility: Option<[f64; 3]>,
}

impl ClientBlocks {
    /// `order` lists all clients, neighbours near each other; none is served.
    pub(super) fn new(points: &Points, weight: impl Fn(usize) -> f64, order: &[u32]) -> Self {
        let largest = order
            .iter()
            .map(|&v| weight(v as usize))
            .fold(0.0, f64::max);
        let share = |v: u32| match weight(v as usize) {
            w if w > 0.0 => ((w / largest) as f32).max(LIGHTEST) * (1.0 + 2.0 * f32::EPSILON),
            _ => 0.0,
        };
        let block = |clients: &[u32]| {
            let mut block = Block {
                place: [[0.0; BLOCK]; 3],
                weight: [0.0; BLOCK],
                served: [2.0; BLOCK],
            };
            for (i, &v) in clients.iter().enumerate() {
                let place = points.point(v as usize);
                for (lanes, x) in block.place.iter_mut().zip(place) {
                    lanes[i] = on_grid(x);
                }
                block.weight[i] = share(v);
                block.served[i] = 0.0;
            }
            block
        };
        let region =
            |clients: &[u32]| Region::around(clients.iter().map(|&v| points.point(v as usize)));
        Self {
            kernel: Kernel32::new(points.kernel),
            reach: match points.kernel {
                Kernel::Linear { reach } => reach * reach,
                Kernel::Reciprocal { .. } | Kernel::Rational { .. } => f64::INFINITY,
            },
            blocks: order.chunks(BLOCK).map(block).collect(),
            regions: order.chunks(BLOCK).map(region).collect(),
            groups: order.chunks(BLOCK * GROUP).map(region).collect(),
            order: order.to_vec(),
            largest_weight: largest,
            busy: Vec::new(),
            arch: pulp::Arch::new(),
        }
    }

    /// Renews the service after a facility opened at `facility`; `served[v]` of client v.
    pub(super) fn serve(&mut self, facility: [f64; 3], served: &[f64]) {
        for (block, clients) in self.blocks.iter_mut().zip(self.order.chunks(BLOCK)) {
            for (own, &v) in block.served.iter_mut().zip(clients) {
                *own = served[v as usize] as f32;
            }
        }
        for region in self.regions.iter_mut().chain(&mut self.groups) {
            region.offer(facility);
        }
    }

    /// No facility in the box gains more than the bound.
    pub(super) fn gain_bound(&mut self, low: [f64; 3], high: [f64; 3]) -> GainBound {
        let bounds = FacilityBox::new(low, high);
        self.busy.clear();
        for (at, group) in self.groups.iter().enumerate() {
            if !group.certainly_idle(low, high, self.reach) {
                let first = at * GROUP;
                for block in first..self.blocks.len().min(first + GROUP) {
                    if !self.regions[block].certainly_idle(low, high, self.reach) {
                        self.busy.push(block);
                    }
                }
            }
        }
        let gains = BlockGains {
            kernel: self.kernel,
            bounds,
            blocks: &self.blocks,
            busy: &self.busy,
        };
        self.arch.dispatch(gains).scaled(self.largest_weight)
    }
}

/// The sum over the blocks that are not skipped, compiled for the widest vectors; nothing is fused, so
/// the bits do not depend on their width.
struct BlockGains<'a> {
    kernel: Kernel32,
    bounds: FacilityBox,
    blocks: &'a [Block],
    busy: &'a [usize],
}

impl pulp::WithSimd for BlockGains<'_> {
    type Output = GainBound;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _simd: S) -> GainBound {
        self.kernel.bound(self.bounds, self.blocks, self.busy)
    }
}

impl Region {
    fn around(places: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut region = Self {
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            facility: None,
        };
        for place in places {
            for (axis, x) in place.into_iter().enumerate() {
                region.low[axis] = region.low[axis].min(x);
                region.high[axis] = region.high[axis].max(x);
            }
        }
        region
    }

    fn offer(&mut self, facility: [f64; 3]) {
        let center = [0, 1, 2].map(|axis| 0.5 * (self.low[axis] + self.high[axis]));
        let nearer =
            |old: [f64; 3]| squared_distance(center, facility) < squared_distance(center, old);
        if self.facility.is_none_or(nearer) {
            self.facility = Some(facility);
        }
    }

    /// Whether every client in here is beyond reach of the box or nearer to the facility than to it.
    ///
    /// ‖u − v‖² − ‖f − v‖² falls into a sum over the axes, so its least value over both boxes is the
    /// sum of the least values; for fixed u it is affine in v, so each lies at an end of the region.
    #[inline(always)]
    fn certainly_idle(&self, low: [f64; 3], high: [f64; 3], reach: f64) -> bool {
        let (mut gap, mut lead) = (0.0, 0.0);
        let facility = self.facility.unwrap_or_default();
        for axis in 0..3 {
            let apart = (low[axis] - self.high[axis])
                .max(self.low[axis] - high[axis])
                .max(0.0);
            gap += apart * apart;
            let at = |v: f64| {
                let outside = (low[axis] - v).max(v - high[axis]).max(0.0);
                outside * outside - (facility[axis] - v) * (facility[axis] - v)
            };
            lead += at(self.low[axis]).min(at(self.high[axis]));
        }
        gap > reach * (1.0 + MARGIN) || (self.facility.is_some() && lead > MARGIN)
    }
}

/// Blocks in a group.
const GROUP: usize = 8;
/// More than rounding takes from squared distances of points in [-2, 2].
const MARGIN: f64 = 1e-12;
/// Weights below this share of the largest count as this much in bounds, so that none vanishes.
const LIGHTEST: f32 = 1e-30;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::{FacilityLocation, Similarity};
    use crate::neighbours::RangeTree;
    use crate::set_function::Growth;
    use crate::subset::Subset;
    use proptest::prelude::*;

    fn kernels() -> impl Strategy<Value = Kernel> {
        let length = (-7.0..4.0_f64).prop_map(f64::exp2);
        (0..3u8, length).prop_map(|(kind, length)| match kind {
            0 => Kernel::Linear { reach: length },
            1 => Kernel::Reciprocal { scale: length },
            _ => Kernel::Rational { scale: length },
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn no_gain_in_a_box_exceeds_its_bound(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..700),
            flat in any::<bool>(),
            kernel in kernels(),
            facilities in prop::collection::vec(any::<prop::sample::Index>(), 0..9),
            weighted in any::<bool>(),
        ) {
            let places: Vec<[f64; 3]> =
                points.iter().map(|p| [p[0], p[1], if flat { 0.3 } else { p[2] }]).collect();
            let n = places.len();
            let mut function = FacilityLocation::new(Points::new(&places, kernel).unwrap());
            if weighted {
                function = function.weighted((0..n).map(|v| (v % 4) as f64 * 1e-3).collect()).unwrap();
            }
            let points = function.similarity();
            let tree = RangeTree::new(&(0..n).map(|v| points.point(v)).collect::<Vec<_>>(), &[]);
            let mut clients = ClientBlocks::new(points, |v| function.weight(v), tree.order());
            let mut serving = function.serving(&Subset::empty(n));
            for facility in facilities {
                serving.insert(facility.index(n));
                clients.serve(points.point(facility.index(n)), &serving.served);
            }
            for (low, high, span, _) in tree.boxes() {
                let bound = clients.gain_bound(low, high);
                for &u in &tree.order()[span] {
                    let (gain, most) = (serving.gain(u as usize), bound.at(points.point(u as usize)));
                    prop_assert!(gain <= most, "{gain} > {most} in {low:?} to {high:?}");
                }
            }
        }
    }

    #[test]
    fn the_bound_errs_by_the_second_order_of_the_side() {
        let places: Vec<[f64; 3]> = (0..4096)
            .map(|i| [f64::from(i % 64) / 64.0, f64::from(i / 64) / 64.0, 0.25])
            .collect();
        for kernel in [
            Kernel::Linear { reach: 0.7 },
            Kernel::Reciprocal { scale: 0.2 },
            Kernel::Rational { scale: 0.2 },
        ] {
            let points = Points::new(&places, kernel).unwrap();
            let order: Vec<u32> = (0..4096).collect();
            let mut clients = ClientBlocks::new(&points, |_| 1.0, &order);
            let served: Vec<f64> = (0..4096).map(|v| points.at(0, v)).collect();
            clients.serve(points.point(0), &served);
            let center = points.point(32 * 64 + 32);
            let gain = points.gain(32 * 64 + 32, &served, None, None);
            let error = |half: f64| {
                let bound = clients.gain_bound(center.map(|x| x - half), center.map(|x| x + half));
                bound.at(center) / gain - 1.0
            };
            let [coarse, fine] = [0.04, 0.01].map(error);
            assert!(
                coarse < 0.2 && fine < coarse / 8.0,
                "{kernel:?}: {coarse}, {fine}"
            );
        }
    }
}
