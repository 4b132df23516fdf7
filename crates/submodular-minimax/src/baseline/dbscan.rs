//! DBSCAN as a cleaner: noise and small clusters go.
//!
//! Reference: Ester, Kriegel, Sander, Xu, "A density-based algorithm for discovering clusters in
//! large spatial databases with noise", KDD 1996.

use super::error::{BaselineError, at_least};
use super::radius::Reach;
use super::removal::BaselineRemoval;
use crate::disjoint_sets::DisjointSets;
use crate::neighbours::RangeTree;
use crate::points::{Cloud, PointLike};

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
    let tree = RangeTree::new(&cloud.points, &[]);
    let reach = config.reach.resolve(&cloud, &tree);
    let sizes = cluster_sizes(&cloud, &tree, reach * reach, config.min_points);
    let scores = sizes.iter().map(|&size| 1.0 / size.max(1) as f64).collect();
    Ok(BaselineRemoval::new(scores, |v| {
        sizes[v] < config.min_cluster.max(1)
    }))
}

/// The size of each point's cluster, 0 for noise.
fn cluster_sizes(cloud: &Cloud, tree: &RangeTree, limit: f64, min_points: usize) -> Vec<usize> {
    let n = cloud.len();
    let is_core: Vec<bool> = (0..n)
        .map(|v| {
            let mut count = 0;
            tree.within(cloud.points[v], limit, &mut |_, _| count += 1);
            count >= min_points
        })
        .collect();
    let mut clusters = DisjointSets::new(n);
    let mut home: Vec<Option<usize>> = vec![None; n];
    for v in 0..n {
        let mut nearest = (f64::INFINITY, u32::MAX);
        tree.within(cloud.points[v], limit, &mut |u, d| {
            if is_core[u as usize] {
                if is_core[v] {
                    clusters.join(v, u as usize);
                }
                if d < nearest.0 || (d == nearest.0 && u < nearest.1) {
                    nearest = (d, u);
                }
            }
        });
        home[v] = (nearest.1 != u32::MAX).then_some(nearest.1 as usize);
    }
    let roots: Vec<Option<usize>> = home.iter().map(|h| h.map(|u| clusters.root(u))).collect();
    let mut size = vec![0; n];
    for root in roots.iter().flatten() {
        size[*root] += 1;
    }
    roots
        .iter()
        .map(|root| root.map_or(0, |r| size[r]))
        .collect()
}
