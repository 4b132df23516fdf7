//! The settings of K-means and their ranges.

use super::error::KMeansError;

/// Settings of [`kmeans`](crate::kmeans).
#[derive(Clone, Debug, PartialEq)]
pub struct KMeansConfig {
    /// Number of clusters, K in the paper. From 1 to the number of points. Default 300.
    pub clusters: usize,
    /// How the first centroids are chosen. Default: k-means++ with one candidate
    /// per seed, since the swap rounds repair what greedy candidates would avoid at a lower cost.
    pub seeding: KMeansSeeding,
    /// How the centroids are improved. Default: accelerated, which equals Lloyd.
    pub method: KMeansMethod,
    /// Upper bound on passes over the data, at least 1. Default 300, as scikit-learn.
    pub max_iterations: usize,
    /// Stop when the summed squared movement of the centroids is at most this times the variance of
    /// the points (mean over the axes). At least 0, where 0 asks for convergence. Default 1e-3: ten
    /// times scikit-learn's, because swap rounds lower the inertia more for the same time.
    pub tolerance: f64,
    /// Attempts to leave a local minimum by moving the centroids that are missed least to the clusters
    /// that need a second one. Each runs the iteration again and is kept only if the inertia falls. Not
    /// for mini-batches. Default 3; 0 is plain K-means.
    pub swap_rounds: usize,
}

/// How the first centroids are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum KMeansSeeding {
    /// k-means++ (Arthur and Vassilvitskii 2007): each next seed is drawn with a probability
    /// proportional to the squared distance to the seeds so far.
    PlusPlus {
        /// Candidates drawn per seed, of which the best is kept. `None` is 2 + ln K, the greedy
        /// variant that scikit-learn uses; `Some(1)` is the original. 1 to 1,000.
        trials: Option<usize>,
    },
    /// k-means|| (Bahmani et al. 2012): few rounds that draw many candidates at once, then weighted
    /// k-means++ among them.
    Parallel {
        /// Rounds of drawing, 1 to 1,000. The source finds 5 enough.
        rounds: usize,
        /// Expected candidates per round as a multiple of K, more than 0. The source recommends 0.5
        /// to 2.
        oversampling: f64,
    },
}

/// How the centroids are improved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum KMeansMethod {
    /// Every point against every centroid (Lloyd 1982): the reference.
    Lloyd,
    /// The same result, bit for bit: points whose distance bounds prove that their centroid cannot
    /// change are skipped (Hamerly 2010), the others search the neighbours of their centroid.
    Accelerated,
    /// Random batches with a learning rate per centroid (Sculley 2010), then one exact pass. Cheaper
    /// for very many points, of a larger inertia.
    MiniBatch {
        /// Points per batch, drawn with repetition; at least 1, and lowered to the number of points.
        batch: usize,
    },
}

impl Default for KMeansConfig {
    fn default() -> Self {
        KMeansConfig {
            clusters: 300,
            seeding: KMeansSeeding::PlusPlus { trials: Some(1) },
            method: KMeansMethod::Accelerated,
            max_iterations: 300,
            tolerance: 1e-3,
            swap_rounds: 3,
        }
    }
}

impl KMeansConfig {
    /// K-means as usually meant, without swap rounds: greedy k-means++ and scikit-learn's tolerance.
    #[must_use]
    pub fn plain(clusters: usize) -> Self {
        KMeansConfig {
            clusters,
            seeding: KMeansSeeding::PlusPlus { trials: None },
            tolerance: 1e-4,
            swap_rounds: 0,
            ..KMeansConfig::default()
        }
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// The first field that is out of range, with its value.
    pub fn validate(&self) -> Result<(), KMeansError> {
        if self.clusters == 0 {
            return Err(KMeansError::NoClusters);
        }
        if self.max_iterations == 0 {
            return Err(KMeansError::NoIterations);
        }
        if !(self.tolerance >= 0.0 && self.tolerance.is_finite()) {
            return Err(KMeansError::Tolerance {
                tolerance: self.tolerance,
            });
        }
        self.seeding.validate()?;
        if self.method == (KMeansMethod::MiniBatch { batch: 0 }) {
            return Err(KMeansError::EmptyBatch);
        }
        Ok(())
    }
}

/// More candidates per seed, or rounds, only cost time.
const MOST: usize = 1000;

impl KMeansSeeding {
    fn validate(self) -> Result<(), KMeansError> {
        match self {
            KMeansSeeding::PlusPlus {
                trials: Some(trials),
            } if !(1..=MOST).contains(&trials) => Err(KMeansError::Trials { trials }),
            KMeansSeeding::Parallel {
                rounds,
                oversampling,
            } if !((1..=MOST).contains(&rounds)
                && oversampling > 0.0
                && oversampling.is_finite()) =>
            {
                Err(KMeansError::Oversampling {
                    rounds,
                    oversampling,
                })
            }
            _ => Ok(()),
        }
    }
}
