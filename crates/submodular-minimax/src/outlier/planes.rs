//! The flat surfaces of a cloud: walls, floors, ceilings, fronts of furniture.
//!
//! Bare walls hold few points, as far from each other as outliers are; but they lie on the plane that the textured
//! parts of the wall lie on. Planes come from RANSAC (Fischler and Bolles, CACM 1981) over at most 4,096 points,
//! the one with the most points first, which then leave, as in Schnabel et al., "Efficient RANSAC for point-cloud shape
//! detection", Computer Graphics Forum 2007: three points of a block along Morton's curve make a hypothesis, as these lie near each other; the
//! points in the slab around it less those in as thick a layer on its two sides are its score, so that clutter scores nothing; then
//! least squares. Triples come from a Kronecker sequence: no chance, and the order of the input changes nothing.
//! Cost: constant beyond 4,096 points, 300 hypotheses times 768 points a plane, at most 24 planes.

use super::outline::Outline;
use crate::points::{extent, median};
use std::cmp::Ordering;

/// Half the thickness of the slab around a hypothesis, in median distances of the points from their middle.
const SLAB: f64 = 0.015;
/// Most deviations of a plane's own points from it that it reaches to either side.
const DEVIATIONS: f64 = 2.5;
/// The standard deviation of normal errors in multiples of the median error.
const DEVIATION_OF_MEDIAN: f64 = 1.4826;
/// Hypotheses a plane.
const HYPOTHESES: usize = 300;
/// Points that each is scored by.
const SCORED: usize = 768;
/// Points that planes are sought among.
const SAMPLES: usize = 4_096;
/// Planes at most.
const MOST: usize = 24;
/// A plane has at least so many points, so large a share of them, and so many times as many as the layers beside it.
const FEWEST: f64 = 30.0;
const LEAST_SHARE: f64 = 0.015;
const CONTRAST: f64 = 3.0;
/// Times the plane is fitted to the points in its slab.
const REFITS: usize = 4;

/// A flat piece of surface, as far as its points reach, in the coordinates of [`Planes`].
struct Plane {
    slab: Slab,
    /// How far from it a point counts as lying on it.
    thickness: f64,
    outline: Outline,
    /// Which of the given points lie on it.
    members: Vec<usize>,
}

/// The planes of a cloud. Coordinates are taken from its middle and divided by its size.
pub(super) struct Planes {
    middle: [f64; 3],
    size: f64,
    found: Vec<Plane>,
}

impl Planes {
    /// The planes among these points, in whatever order.
    pub(super) fn new(points: &[[f64; 3]]) -> Self {
        let (middle, size) = extent(points);
        let mut planes = Self {
            middle,
            size,
            found: Vec::new(),
        };
        if size > 0.0 {
            let mut placed: Vec<(u64, [f64; 3], usize)> = (points.iter().enumerate())
                .map(|(at, &point)| (planes.place(point), at))
                .map(|(place, at)| (interleaved(place), place, at))
                .collect();
            placed.sort_unstable_by(|a, b| a.0.cmp(&b.0).then_with(|| compared(a.1, b.1)));
            let step = placed.len().div_ceil(SAMPLES).max(1);
            let (chosen, members): (Vec<[f64; 3]>, Vec<usize>) =
                placed.iter().step_by(step).map(|p| (p.1, p.2)).unzip();
            planes.find(&chosen);
            for plane in &mut planes.found {
                plane.members.iter_mut().for_each(|at| *at = members[*at]);
            }
        }
        planes
    }

    /// Of each plane the points that lie on it, as indices into those given.
    pub(super) fn members(&self) -> impl Iterator<Item = &[usize]> {
        self.found.iter().map(|plane| &plane.members[..])
    }

    /// How far the point is from the nearest plane on which and within whose outline it lies, and which that is.
    pub(super) fn nearest(&self, point: [f64; 3]) -> Option<(f64, usize)> {
        let place = self.place(point);
        let on = self.found.iter().enumerate().filter_map(|(at, plane)| {
            let away = plane.slab.away(place);
            let on = away <= plane.thickness && plane.outline.contains(place);
            on.then_some((away * self.size, at))
        });
        on.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| (point[axis] - self.middle[axis]) / self.size)
    }

    /// The largest plane first; its points leave.
    fn find(&mut self, points: &[[f64; 3]]) {
        let mut left: Vec<usize> = (0..points.len()).collect();
        let least = (LEAST_SHARE * left.len() as f64).max(FEWEST);
        while self.found.len() < MOST && left.len() as f64 >= least {
            let Some(slab) = largest(points, &left) else {
                break;
            };
            let beside = left.iter().filter(|&&i| slab.beside(points[i])).count();
            let (members, others): (Vec<usize>, Vec<usize>) =
                left.iter().partition(|&&i| slab.away(points[i]) < SLAB);
            if (members.len() as f64) < least.max(CONTRAST * beside as f64) {
                break;
            }
            let mut away: Vec<f64> = members.iter().map(|&i| slab.away(points[i])).collect();
            self.found.push(Plane {
                slab,
                thickness: SLAB.min(DEVIATIONS * DEVIATION_OF_MEDIAN * median(&mut away)),
                outline: Outline::new(slab.axis(), members.iter().map(|&i| points[i])),
                members,
            });
            left = others;
        }
    }
}

/// The bits of the coordinates in turn (Morton's code): points with near codes lie near each other.
fn interleaved(place: [f64; 3]) -> u64 {
    const BITS: u32 = 16;
    const FARTHEST: f64 = 8.0;
    let cells = f64::from(1_u32 << BITS);
    let cell = place.map(|x| ((x / FARTHEST + 1.0) / 2.0 * cells).clamp(0.0, cells - 1.0) as u64);
    let bit = |at: u32| (0..3).map(move |axis| (cell[axis] >> at & 1) << (3 * at + axis as u32));
    (0..BITS).flat_map(bit).sum()
}

fn compared(a: [f64; 3], b: [f64; 3]) -> Ordering {
    (0..3).fold(Ordering::Equal, |order, axis| {
        order.then(a[axis].total_cmp(&b[axis]))
    })
}

/// A plane without borders, and the slab around it.
#[derive(Clone, Copy)]
struct Slab {
    normal: [f64; 3],
    offset: f64,
}

impl Slab {
    fn away(&self, point: [f64; 3]) -> f64 {
        (dot(self.normal, point) - self.offset).abs()
    }

    /// In the layers on both sides, together as thick as the slab.
    fn beside(&self, point: [f64; 3]) -> bool {
        (SLAB..2.0 * SLAB).contains(&self.away(point))
    }

    /// Points in the slab less those beside it.
    fn score(&self, points: &[[f64; 3]]) -> i32 {
        let of = |&point: &[f64; 3]| {
            let away = self.away(point);
            2 * i32::from(away < SLAB) - i32::from(away < 2.0 * SLAB)
        };
        points.iter().map(of).sum()
    }

    /// The axis that the normal is nearest to.
    fn axis(&self) -> usize {
        let n = self.normal.map(f64::abs);
        (0..3).fold(0, |most, axis| if n[axis] > n[most] { axis } else { most })
    }

    /// Through three points; `None` if they lie on a line.
    fn through([a, b, c]: [[f64; 3]; 3]) -> Option<Self> {
        let (b, c) = (
            [0, 1, 2].map(|i| b[i] - a[i]),
            [0, 1, 2].map(|i| c[i] - a[i]),
        );
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            b[j] * c[k] - b[k] * c[j]
        });
        Self::facing(cross, a)
    }

    fn facing(direction: [f64; 3], through: [f64; 3]) -> Option<Self> {
        let length = dot(direction, direction).sqrt();
        let normal = direction.map(|x| x / length);
        let offset = dot(normal, through);
        (length > 0.0 && offset.is_finite()).then_some(Self { normal, offset })
    }

    /// The least-squares plane of the points in the slab, errors measured along the nearest axis.
    fn refitted(&self, points: &[[f64; 3]], chosen: &[usize]) -> Option<Self> {
        let axis = self.axis();
        let [x, y] = [(axis + 1) % 3, (axis + 2) % 3];
        let inside = || (chosen.iter().map(|&i| points[i])).filter(|&p| self.away(p) < SLAB);
        let count = inside().count() as f64;
        let mean = inside().fold([0.0; 3], |sum, p| [0, 1, 2].map(|i| sum[i] + p[i] / count));
        let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
        for p in inside() {
            let [dx, dy, dz] = [p[x] - mean[x], p[y] - mean[y], p[axis] - mean[axis]];
            (xx, xy, yy) = (xx + dx * dx, xy + dx * dy, yy + dy * dy);
            (xz, yz) = (xz + dx * dz, yz + dy * dz);
        }
        let determinant = xx * yy - xy * xy;
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        direction[x] = (xy * yz - yy * xz) / determinant;
        direction[y] = (xy * xz - xx * yz) / determinant;
        Self::facing(direction, mean)
    }
}

/// The best-scored hypothesis, fitted to its points.
fn largest(points: &[[f64; 3]], left: &[usize]) -> Option<Slab> {
    let step = left.len().div_ceil(SCORED);
    let scored: Vec<[f64; 3]> = left.iter().step_by(step).map(|&i| points[i]).collect();
    let mut best: Option<(i32, Slab)> = None;
    for number in 1..=HYPOTHESES {
        let triple = triple(number, left.len()).map(|at| points[left[at]]);
        let Some(slab) = Slab::through(triple) else {
            continue;
        };
        let score = slab.score(&scored);
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, slab));
        }
    }
    let mut slab = best?.1;
    for _ in 0..REFITS {
        slab = slab.refitted(points, left)?;
    }
    Some(slab)
}

/// Three of `count` places, all in one block of an eighth to a 128th of them.
fn triple(number: usize, count: usize) -> [usize; 3] {
    // Fractional parts of multiples of these are spread evenly: the golden ratio and square roots.
    const STEPS: [f64; 4] = [
        0.618_033_988_749_895,
        0.414_213_562_373_095,
        0.732_050_807_568_877,
        0.236_067_977_499_790,
    ];
    let block = (count >> (3 + number % 5)).max(12).min(count);
    let [start, places @ ..] = STEPS.map(|step| (number as f64 * step).fract());
    let start = (start * (count - block + 1) as f64) as usize;
    places.map(|place| start + (place * block as f64) as usize)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::SeedableRng;

    /// A floor of 4 by 4 and a wall of 4 by 2 on its border, uneven by a hundredth, with dust in between.
    fn corner([floor, wall, dust]: [usize; 3]) -> Vec<[f64; 3]> {
        let mut random = Pcg64::seed_from_u64(5);
        let mut at = |size: [f64; 3]| size.map(|side| side * random.random::<f64>());
        let mut points: Vec<[f64; 3]> = (0..floor).map(|_| at([4.0, 4.0, 0.02])).collect();
        points.extend((0..wall).map(|_| at([0.02, 4.0, 2.0])));
        points.extend((0..dust).map(|_| at([4.0, 4.0, 2.0])));
        points
    }

    #[test]
    fn floor_and_wall_are_found_with_what_lies_on_them() {
        for scale in [1.0, 1e-100, 1e60] {
            let points: Vec<[f64; 3]> = corner([1_200, 800, 200]);
            let points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x * scale)).collect();
            let planes = Planes::new(&points);
            let sizes: Vec<usize> = planes.members().map(<[usize]>::len).collect();
            assert!(matches!(sizes[..], [1_100..1_300, 700..900]), "{sizes:?}");
            let nearest = |at: [f64; 3]| planes.nearest(at.map(|x| x * scale));
            let (distance, floor) = nearest([2.0, 2.0, 0.005]).unwrap();
            assert!(floor == 0 && distance < 0.02 * scale);
            assert_eq!(nearest([0.01, 2.0, 1.0]).map(|n| n.1), Some(1));
            assert_eq!(nearest([2.0, 2.0, 0.1]), None);
            // On the plane, but beyond where the floor ends.
            assert_eq!(nearest([2.0, 5.0, 0.0]), None);
        }
    }

    #[test]
    fn the_order_of_the_points_changes_nothing() {
        let points = corner([3_000, 2_000, 4_000]);
        let moved: Vec<[f64; 3]> = (0..9_000).map(|i| points[i * 2_003 % 9_000]).collect();
        let (planes, others) = (Planes::new(&points), Planes::new(&moved));
        assert!(planes.members().count() > 1);
        for &point in &points {
            assert_eq!(planes.nearest(point), others.nearest(point));
        }
    }

    #[test]
    fn dust_lines_and_stacks_hold_no_plane() {
        let line: Vec<[f64; 3]> = (0..500).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        for points in [corner([0, 0, 3_000]), line, vec![[1.0; 3]; 100], vec![]] {
            assert_eq!(Planes::new(&points).members().count(), 0);
        }
    }
}
