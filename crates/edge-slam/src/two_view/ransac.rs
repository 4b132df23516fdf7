//! Random sampling that stops as soon as more samples would hardly help.

use rand::{Rng, RngExt};

/// How long to sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schedule {
    /// Most samples drawn.
    pub(super) most: usize,
    /// Probability wanted of having drawn one sample of inliers only.
    pub(super) confidence: f64,
}

/// The best model found.
#[derive(Debug, Clone)]
pub(super) struct Best<M> {
    pub(super) model: M,
    /// Sum over all data of min(d², t²)/t²: 0 is perfect, the number of data the worst.
    pub(super) cost: f64,
    pub(super) samples: usize,
}

/// Draws samples of `SIZE` distinct indices below `count`; `fit` gives candidates, `distance` a squared distance
/// relative to the squared threshold (1 at the border), `polish` improves a new best one.
pub(super) fn search<M: Clone, const SIZE: usize>(
    count: usize,
    schedule: Schedule,
    rng: &mut impl Rng,
    fit: impl Fn(&[usize; SIZE]) -> Vec<M>,
    distance: impl Fn(&M, usize) -> f64,
    polish: impl Fn(&M) -> Option<M>,
) -> Option<Best<M>> {
    if count < SIZE {
        return None;
    }
    let mut best: Option<Best<M>> = None;
    let mut needed = schedule.most;
    let mut samples = 0;
    while samples < needed {
        samples += 1;
        for model in fit(&draw(count, rng)) {
            let limit = best.as_ref().map_or(f64::MAX, |best| best.cost);
            let Some((cost, inliers)) = score(&model, count, limit, &distance) else {
                continue;
            };
            let polished = polish(&model)
                .and_then(|model| score(&model, count, cost, &distance).map(|s| (model, s)));
            let (model, (cost, inliers)) = polished.unwrap_or((model, (cost, inliers)));
            best = Some(Best {
                model,
                cost,
                samples,
            });
            needed = needed.min(samples_needed(inliers, count, SIZE, schedule));
        }
    }
    best.map(|best| Best { samples, ..best })
}

/// Cost and number of inliers, unless the cost reaches `limit`.
fn score<M>(
    model: &M,
    count: usize,
    limit: f64,
    distance: &impl Fn(&M, usize) -> f64,
) -> Option<(f64, usize)> {
    let (mut cost, mut inliers) = (0.0, 0);
    for index in 0..count {
        let square = distance(model, index);
        if square < 1.0 {
            cost += square;
            inliers += 1;
        } else {
            cost += 1.0;
        }
        if cost >= limit {
            return None;
        }
    }
    Some((cost, inliers))
}

/// log(1 − confidence) / log(1 − wˢ), w the share of inliers.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "small counts; float to integer saturates"
)]
fn samples_needed(inliers: usize, count: usize, size: usize, schedule: Schedule) -> usize {
    let all_good = (inliers as f64 / count as f64).powi(size as i32);
    if !(all_good > 0.0) {
        return schedule.most;
    }
    let samples = (1.0 - schedule.confidence).ln() / (-all_good).ln_1p();
    (samples.max(1.0).ceil() as usize).min(schedule.most)
}

fn draw<const SIZE: usize>(count: usize, rng: &mut impl Rng) -> [usize; SIZE] {
    let mut sample = [usize::MAX; SIZE];
    for k in 0..SIZE {
        loop {
            let index = rng.random_range(0..count);
            if !sample[..k].contains(&index) {
                sample[k] = index;
                break;
            }
        }
    }
    sample
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn a_line_is_found_among_outliers_and_the_seed_decides() {
        let data: Vec<(f64, f64)> = (0..100)
            .map(|k| {
                let x = f64::from(k);
                if k % 2 == 0 {
                    (x, 2.0 * x + 1.0)
                } else {
                    (x, (x * 7.7).sin() * 100.0)
                }
            })
            .collect();
        let run = |seed| {
            search(
                data.len(),
                Schedule {
                    most: 500,
                    confidence: 0.999,
                },
                &mut rand_pcg::Pcg64::seed_from_u64(seed),
                |&[i, j]: &[usize; 2]| {
                    let slope = (data[j].1 - data[i].1) / (data[j].0 - data[i].0);
                    vec![(slope, data[i].1 - slope * data[i].0)]
                },
                |&(slope, offset), k| (data[k].1 - slope * data[k].0 - offset).powi(2),
                |_| None,
            )
            .unwrap()
        };
        let found = run(1);
        assert!((found.model.0 - 2.0).abs() < 1e-9 && found.samples < 100);
        assert_eq!(found.model, run(1).model);
        assert_eq!(found.samples, run(1).samples);
    }

    #[test]
    fn a_first_model_without_inliers_does_not_end_the_search() {
        let schedule = Schedule {
            most: 500,
            confidence: 0.999,
        };
        assert_eq!(samples_needed(0, 100, 5, schedule), 500);
        assert_eq!(samples_needed(1, 10_000, 5, schedule), 500);
        assert_eq!(samples_needed(100, 100, 5, schedule), 1);
    }

    #[test]
    fn too_few_data_have_no_model() {
        let rng = &mut rand_pcg::Pcg64::seed_from_u64(1);
        let schedule = Schedule {
            most: 9,
            confidence: 0.9,
        };
        let none = search(
            4,
            schedule,
            rng,
            |_: &[usize; 5]| vec![0],
            |_, _| 0.0,
            |_| None,
        );
        assert!(none.is_none());
    }
}
