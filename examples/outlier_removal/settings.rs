//! The settings that the baselines may choose from, and the best of them for one cloud or for all.

use explorer::baseline::{
    BaselineError, BaselineRemoval, DbscanConfig, LofConfig, RadiusConfig, Reach,
    StatisticalConfig, dbscan, lof, radius, statistical,
};

use crate::score::{Labelled, f1};

/// A baseline with one setting.
pub(crate) struct Candidate {
    pub(crate) name: String,
    run: Run,
}

type Run = Box<dyn Fn(&[[f64; 3]]) -> Result<BaselineRemoval, BaselineError>>;

/// One baseline: the setting that it is customarily given, and the grid.
pub(crate) struct Family {
    pub(crate) customary: Candidate,
    /// The one setting that is best on average over the two labelled maps of a kitchen and an office that the README of
    /// `submodular-minimax` tells of: for maps without labels, and for single ones.
    pub(crate) shared: Candidate,
    pub(crate) grid: Vec<Candidate>,
}

impl Candidate {
    fn new(
        name: String,
        run: impl Fn(&[[f64; 3]]) -> Result<BaselineRemoval, BaselineError> + 'static,
    ) -> Self {
        let run = Box::new(run);
        Self { name, run }
    }

    /// What it removes.
    pub(crate) fn remove(&self, points: &[[f64; 3]]) -> Result<BaselineRemoval, BaselineError> {
        (self.run)(points)
    }
}

/// The four baselines.
pub(crate) fn families() -> [Family; 4] {
    let mut factor = Vec::new();
    for neighbours in [10, 20, 40] {
        factor
            .extend([1.2, 1.3, 1.5, 2.0, 3.0].map(|threshold| local_factor(neighbours, threshold)));
    }
    let mut sor = Vec::new();
    for neighbours in [8, 20, 30] {
        sor.extend([0.5, 1.0, 2.0, 4.0].map(|ratio| statistics(neighbours, ratio)));
    }
    let mut ror = Vec::new();
    for needed in [2, 4, 10, 16] {
        ror.extend([4.0, 8.0, 12.0, 20.0, 40.0].map(|factor| within(factor, needed)));
    }
    let mut density = Vec::new();
    for factor in [1.8, 2.5, 3.5, 5.0, 10.0] {
        let sizes = [(3, 1), (5, 1), (5, 15), (3, 30)];
        density.extend(sizes.map(|(points, cluster)| clusters(factor, points, cluster)));
    }
    let family = |customary, shared, grid| Family {
        customary,
        shared,
        grid,
    };
    [
        family(statistics(20, 2.0), statistics(30, 0.5), sor),
        family(within(4.0, 2), within(12.0, 10), ror),
        family(local_factor(20, 1.5), local_factor(10, 2.0), factor),
        family(clusters(1.8, 3, 1), clusters(2.5, 5, 15), density),
    ]
}

fn statistics(neighbours: usize, ratio: f64) -> Candidate {
    let config = StatisticalConfig { neighbours, ratio };
    let name = format!("SOR k = {neighbours}, ratio {ratio}");
    Candidate::new(name, move |points| statistical(points, &config))
}

fn within(factor: f64, min_neighbours: usize) -> Candidate {
    let neighbour = 1;
    let config = RadiusConfig {
        radius: Reach::Spacing { neighbour, factor },
        min_neighbours,
    };
    let name = format!("ROR {factor} x, {min_neighbours} neighbours");
    Candidate::new(name, move |points| radius(points, &config))
}

fn local_factor(neighbours: usize, threshold: f64) -> Candidate {
    let config = LofConfig {
        neighbours,
        threshold,
    };
    let name = format!("LOF k = {neighbours}, threshold {threshold}");
    Candidate::new(name, move |points| lof(points, &config))
}

fn clusters(factor: f64, min_points: usize, min_cluster: usize) -> Candidate {
    let neighbour = 4;
    let config = DbscanConfig {
        reach: Reach::Spacing { neighbour, factor },
        min_points,
        min_cluster,
    };
    let name = format!("DBSCAN {factor} x, {min_points}, clusters >= {min_cluster}");
    Candidate::new(name, move |points| dbscan(points, &config))
}

/// What every setting of the grid removes from a cloud, and the F1 of that.
pub(crate) type Tried = Vec<(BaselineRemoval, f64)>;

/// Tries every setting on a cloud.
pub(crate) fn tried(family: &Family, cloud: &Labelled) -> Result<Tried, BaselineError> {
    let each = family.grid.iter().map(|candidate| {
        let found = candidate.remove(&cloud.points)?;
        let f1 = f1(&found.removed, &cloud.outlier);
        Ok((found, f1))
    });
    each.collect()
}

/// Place in the grid of the setting with the largest mean F1 over these clouds, the first of equals.
pub(crate) fn best(tried: &[&Tried]) -> usize {
    let settings = tried.first().map_or(0, |tried| tried.len());
    let sum = |at: usize| tried.iter().map(|cloud| cloud[at].1).sum::<f64>();
    (1..settings).fold(0, |best, at| if sum(at) > sum(best) { at } else { best })
}
