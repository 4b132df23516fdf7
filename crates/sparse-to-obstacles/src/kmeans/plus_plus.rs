//! k-means++ seeding, greedy, with clusters that a candidate cannot improve skipped.
//!
//! Method: 1. the first seed is drawn by weight; 2. candidates are drawn with probability proportional to
//! weight times squared distance to the nearest seed; 3. the candidate that lowers the sum of these
//! most becomes the next seed, ties to the first drawn.
//! A candidate at least twice a cluster's radius away from its seed cannot attract any of its points
//! (triangle inequality), so most clusters are skipped and K seeds cost about O(K² + n log K).
//!
//! References: Arthur and Vassilvitskii, "k-means++: the advantages of careful seeding", SODA 2007.

use crate::vector::{Vec3, distance_squared};
use rand::{Rng, RngExt};

/// Where the iteration begins.
#[derive(Clone, Debug)]
pub(super) struct Seeds {
    pub(super) centroids: Vec<Vec3>,
    /// For each point a centroid that is near: where the search for the nearest one begins.
    pub(super) labels: Vec<usize>,
}

/// Draws seeds among `points` until there are `count` with the `known` ones, or until every point
/// coincides with a seed.
pub(super) fn seed(
    points: &[Vec3],
    known: &[Vec3],
    count: usize,
    trials: Option<usize>,
    rng: &mut impl Rng,
) -> Seeds {
    seed_weighted(points, None, known, count, trials, rng)
}

/// As [`seed`] for points that count as often as their weight says.
pub(super) fn seed_weighted(
    points: &[Vec3],
    weights: Option<&[f64]>,
    known: &[Vec3],
    count: usize,
    trials: Option<usize>,
    rng: &mut impl Rng,
) -> Seeds {
    let trials = trials.unwrap_or(2 + (count as f64).ln() as usize);
    let mut seeding = Seeding::new(points, weights, known, rng);
    while seeding.seeds.len() < count {
        let Some(best) = seeding.best_candidate(trials, rng) else {
            break;
        };
        seeding.add(points[best]);
    }
    let mut labels = vec![0; points.len()];
    for (seed, members) in seeding.members.iter().enumerate() {
        for &point in members {
            labels[point as usize] = seed;
        }
    }
    Seeds {
        centroids: seeding.seeds,
        labels,
    }
}

struct Seeding<'a> {
    points: &'a [Vec3],
    weights: Option<&'a [f64]>,
    seeds: Vec<Vec3>,
    /// Per seed: the points nearest to it, the sum of their costs, and the largest squared distance.
    members: Vec<Vec<u32>>,
    cost: Vec<f64>,
    radius_squared: Vec<f64>,
    /// Per point: squared distance to its seed.
    squared: Vec<f64>,
}

impl<'a> Seeding<'a> {
    fn new(
        points: &'a [Vec3],
        weights: Option<&'a [f64]>,
        known: &[Vec3],
        rng: &mut impl Rng,
    ) -> Self {
        let first = match known.first() {
            Some(&centroid) => centroid,
            None => points[draw_first(points.len(), weights, rng)],
        };
        let squared: Vec<f64> = points
            .iter()
            .map(|&point| distance_squared(point, first))
            .collect();
        let mut seeding = Seeding {
            points,
            weights,
            seeds: vec![first],
            members: vec![(0..points.len() as u32).collect()],
            cost: vec![0.0],
            radius_squared: vec![0.0],
            squared,
        };
        seeding.refresh(0);
        for &centroid in known.iter().skip(1) {
            seeding.add(centroid);
        }
        seeding
    }

    #[inline]
    fn weight(&self, point: u32) -> f64 {
        self.weights.map_or(1.0, |weights| weights[point as usize])
    }

    /// Recomputes cost and radius of a seed from its members, in order.
    fn refresh(&mut self, seed: usize) {
        let (mut cost, mut radius) = (0.0, 0.0_f64);
        for &point in &self.members[seed] {
            let squared = self.squared[point as usize];
            cost += squared * self.weight(point);
            radius = radius.max(squared);
        }
        self.cost[seed] = cost;
        self.radius_squared[seed] = radius;
    }

    fn best_candidate(&self, trials: usize, rng: &mut impl Rng) -> Option<usize> {
        let total: f64 = self.cost.iter().sum();
        if total <= 0.0 {
            return None;
        }
        let mut best: Option<(f64, usize)> = None;
        for _ in 0..trials {
            let candidate = self.draw(total, rng)?;
            let gain = self.gain(self.points[candidate]);
            if best.is_none_or(|(most, _)| gain > most) {
                best = Some((gain, candidate));
            }
        }
        best.map(|(_, candidate)| candidate)
    }

    /// Draws a point with probability proportional to its cost.
    fn draw(&self, total: f64, rng: &mut impl Rng) -> Option<usize> {
        let mut left = rng.random::<f64>() * total;
        let mut last = None;
        for (seed, &cost) in self.cost.iter().enumerate() {
            if cost <= 0.0 {
                continue;
            }
            last = Some(seed);
            if left < cost {
                break;
            }
            left -= cost;
        }
        let mut chosen = None;
        for &point in &self.members[last?] {
            let cost = self.squared[point as usize] * self.weight(point);
            if cost <= 0.0 {
                continue;
            }
            chosen = Some(point as usize);
            if left < cost {
                break;
            }
            left -= cost;
        }
        chosen
    }

    /// Can a new seed attract members of this one?
    #[inline]
    fn attracts(&self, seed: usize, squared_to_seed: f64) -> bool {
        squared_to_seed < 4.0 * self.radius_squared[seed] * (1.0 + 1e-12)
    }

    fn gain(&self, candidate: Vec3) -> f64 {
        let mut gain = 0.0;
        for (seed, &centre) in self.seeds.iter().enumerate() {
            if self.attracts(seed, distance_squared(candidate, centre)) {
                for &point in &self.members[seed] {
                    let saved = self.squared[point as usize]
                        - distance_squared(self.points[point as usize], candidate);
                    if saved > 0.0 {
                        gain += saved * self.weight(point);
                    }
                }
            }
        }
        gain
    }

    fn add(&mut self, centre: Vec3) {
        let mut attracted = Vec::new();
        for seed in 0..self.seeds.len() {
            if !self.attracts(seed, distance_squared(centre, self.seeds[seed])) {
                continue;
            }
            let before = attracted.len();
            let (points, squared) = (self.points, &mut self.squared);
            self.members[seed].retain(|&point| {
                let to_centre = distance_squared(points[point as usize], centre);
                let stays = to_centre >= squared[point as usize];
                if !stays {
                    squared[point as usize] = to_centre;
                    attracted.push(point);
                }
                stays
            });
            if attracted.len() > before {
                self.refresh(seed);
            }
        }
        self.seeds.push(centre);
        self.members.push(attracted);
        self.cost.push(0.0);
        self.radius_squared.push(0.0);
        self.refresh(self.seeds.len() - 1);
    }
}

fn draw_first(count: usize, weights: Option<&[f64]>, rng: &mut impl Rng) -> usize {
    let Some(weights) = weights else {
        return rng.random_range(0..count);
    };
    let mut left = rng.random::<f64>() * weights.iter().sum::<f64>();
    for (index, &weight) in weights.iter().enumerate() {
        if left < weight {
            return index;
        }
        left -= weight;
    }
    count - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    #[test]
    fn skipped_clusters_hide_nothing() {
        let mut rng = Pcg64::seed_from_u64(1);
        let points: Vec<Vec3> = (0..600)
            .map(|_| [0, 1, 2].map(|_| rng.random::<f64>()))
            .collect();
        let mut seeding = Seeding::new(&points, None, &[], &mut rng);
        for _ in 0..40 {
            let candidate = points[seeding.best_candidate(3, &mut rng).unwrap()];
            let saved =
                |point: usize| seeding.squared[point] - distance_squared(points[point], candidate);
            let gain: f64 = (0..points.len()).map(|point| saved(point).max(0.0)).sum();
            assert!((seeding.gain(candidate) - gain).abs() < 1e-9 * gain);
            seeding.add(candidate);
            for (point, &squared) in points.iter().zip(&seeding.squared) {
                let to_seeds = seeding
                    .seeds
                    .iter()
                    .map(|seed| distance_squared(*point, *seed));
                assert_eq!(squared, to_seeds.fold(f64::INFINITY, f64::min));
            }
        }
        let mut members: Vec<u32> = seeding.members.concat();
        members.sort_unstable();
        assert_eq!(members, (0..600).collect::<Vec<u32>>());
    }
}
