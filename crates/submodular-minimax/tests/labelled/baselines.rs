//! The grid of settings the baselines may choose from, one setting for all clouds.
#![allow(unreachable_pub, reason = "shared by two examples")]

use super::labelled::{Labelled, average_precision, f1};
use submodular_minimax::baseline::{
    BaselineError, BaselineRemoval, DbscanConfig, LofConfig, RadiusConfig, Reach,
    StatisticalConfig, dbscan, lof, radius, statistical,
};

/// A baseline with one setting.
pub type Candidate = (
    String,
    Box<dyn Fn(&[[f64; 3]]) -> Result<BaselineRemoval, BaselineError>>,
);

/// The settings of each baseline.
pub fn families() -> Vec<Vec<Candidate>> {
    let mut sor: Vec<Candidate> = Vec::new();
    for neighbours in [8, 20, 30] {
        for ratio in [0.5, 1.0, 2.0, 4.0] {
            let config = StatisticalConfig { neighbours, ratio };
            let name = format!("SOR k={neighbours} ratio={ratio}");
            sor.push((name, Box::new(move |p| statistical(p, &config))));
        }
    }
    let mut ror: Vec<Candidate> = Vec::new();
    for min_neighbours in [2, 4, 10, 16] {
        for factor in [4.0, 8.0, 12.0, 20.0, 40.0] {
            let config = RadiusConfig {
                radius: Reach::Spacing {
                    neighbour: 1,
                    factor,
                },
                min_neighbours,
            };
            let name = format!("ROR {factor} x spacing, {min_neighbours} neighbours");
            ror.push((name, Box::new(move |p| radius(p, &config))));
        }
    }
    let mut outlier_factor: Vec<Candidate> = Vec::new();
    for neighbours in [10, 20, 40] {
        for threshold in [1.2, 1.3, 1.5, 2.0, 3.0] {
            let config = LofConfig {
                neighbours,
                threshold,
            };
            let name = format!("LOF k={neighbours} threshold={threshold}");
            outlier_factor.push((name, Box::new(move |p| lof(p, &config))));
        }
    }
    let mut clusters: Vec<Candidate> = Vec::new();
    for factor in [1.8, 2.5, 3.5, 5.0, 10.0] {
        for (min_points, min_cluster) in [(3, 1), (5, 1), (5, 15), (3, 30)] {
            let reach = Reach::Spacing {
                neighbour: 4,
                factor,
            };
            let config = DbscanConfig {
                reach,
                min_points,
                min_cluster,
            };
            let name = format!("DBSCAN {factor} x, {min_points}, clusters >= {min_cluster}");
            clusters.push((name, Box::new(move |p| dbscan(p, &config))));
        }
    }
    vec![sor, ror, outlier_factor, clusters]
}

/// The setting with the best mean F1 over the clouds, and its (F1, AP) on each.
pub fn best_fixed(
    family: &[Candidate],
    clouds: &[Labelled],
) -> Result<(String, Vec<(f64, f64)>), BaselineError> {
    let mut best = (f64::NEG_INFINITY, String::new(), Vec::new());
    for (name, run) in family {
        let mut row = Vec::new();
        for cloud in clouds {
            let found = run(&cloud.points)?;
            let ap = average_precision(&found.scores, &cloud.outlier);
            row.push((f1(&found.removed, &cloud.outlier), ap));
        }
        let mean = row.iter().map(|r| r.0).sum::<f64>() / row.len().max(1) as f64;
        if mean > best.0 {
            best = (mean, name.clone(), row);
        }
    }
    Ok((best.1, best.2))
}
