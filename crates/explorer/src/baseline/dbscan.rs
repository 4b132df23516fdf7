//! DBSCAN as a cleaner: noise and small clusters go.
//!
//! Reference: Ester, Kriegel, Sander, Xu, "A density-based algorithm for discovering clusters in
//! large spatial databases with noise", KDD 1996.

use submodular_minimax::PointLike;

use super::cloud::Cloud;
use super::error::{BaselineError, at_least};
use super::radius::Reach;
use super::removal::BaselineRemoval;

/// Settings of [`dbscan`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DbscanConfig {
    /// ε; default 1.8 times the median distance to the fourth neighbour.
    pub reach: Reach,
    /// Points within ε that make a core point, itself included, at least 1; default 3.
    pub min_points: usize,
    /// Clusters with fewer points are removed with the noise, at least 1; default 1 (plain DBSCAN).
    pub min_cluster: usize,
}

impl Default for DbscanConfig {
    fn default() -> Self {
        let reach = Reach::Spacing {
            neighbour: 4,
            factor: 1.8,
        };
        Self {
            reach,
            min_points: 3,
            min_cluster: 1,
        }
    }
}

impl DbscanConfig {
    /// Checks every field's range.
    ///
    /// # Errors
    /// The first field that is out of range.
    pub fn validate(&self) -> Result<(), BaselineError> {
        self.reach.validate()?;
        at_least("min_points", self.min_points as f64, 1.0)?;
        at_least("min_cluster", self.min_cluster as f64, 1.0)
    }
}

/// Removes points that no core point reaches, and clusters below the least size.
///
/// Scores are 1 / (size of the point's cluster), 1 for noise. A border point joins the cluster of
/// its nearest core point, ties by index, so that the input's order does not matter.
///
/// # Errors
/// Points that are not finite, settings out of range.
pub fn dbscan<P: PointLike>(
    points: &[P],
    config: &DbscanConfig,
) -> Result<BaselineRemoval, BaselineError> {
    config.validate()?;
    let cloud = Cloud::new(points)?;
    let reach = config.reach.resolve(&cloud);
    let sizes = cluster_sizes(&cloud, reach * reach, config.min_points);
    let scores = sizes.iter().map(|&size| 1.0 / size.max(1) as f64).collect();
    Ok(BaselineRemoval::new(scores, |v| {
        sizes[v] < config.min_cluster
    }))
}

/// The size of each point's cluster, 0 for noise.
fn cluster_sizes(cloud: &Cloud, limit: f64, min_points: usize) -> Vec<usize> {
    let stacks = cloud.stacks();
    let homes = homes(cloud, limit, min_points);
    let mut size = vec![0; stacks.len()];
    for (stack, home) in stacks.iter().zip(&homes) {
        if let Some(home) = *home {
            size[home] += stack.len();
        }
    }
    let mut sizes = vec![0; cloud.len()];
    for (stack, home) in stacks.iter().zip(&homes) {
        for &v in stack {
            sizes[v] = home.map_or(0, |home| size[home]);
        }
    }
    sizes
}

/// The cluster of each place, `None` for noise. Points at one place have the same neighbourhood, so they belong together.
fn homes(cloud: &Cloud, limit: f64, min_points: usize) -> Vec<Option<usize>> {
    let stacks = cloud.stacks();
    let around = |place: usize| cloud.places_within(place, limit);
    let is_core: Vec<bool> = (0..stacks.len())
        .map(|place| around(place).map(|n| stacks[n.1].len()).sum::<usize>() >= min_points)
        .collect();
    let mut cluster: Vec<Option<usize>> = vec![None; stacks.len()];
    for seed in (0..stacks.len()).filter(|&place| is_core[place]) {
        if cluster[seed].is_some() {
            continue;
        }
        cluster[seed] = Some(seed);
        let mut open = vec![seed];
        while let Some(place) = open.pop() {
            for (_, other) in around(place) {
                if is_core[other] && cluster[other].is_none() {
                    cluster[other] = Some(seed);
                    open.push(other);
                }
            }
        }
    }
    let nearest_core = |place: usize| {
        (around(place).filter(|n| is_core[n.1]))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .and_then(|n| cluster[n.1])
    };
    (0..stacks.len())
        .map(|place| cluster[place].or_else(|| nearest_core(place)))
        .collect()
}
