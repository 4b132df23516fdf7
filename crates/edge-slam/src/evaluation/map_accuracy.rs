//! How well a map's points lie on a reference surface, and how much of that surface they cover.

use std::collections::BTreeMap;

use super::EvaluationError;

/// Shares of points with a counterpart nearby.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapAccuracy {
    /// Share of map points with a reference point within the threshold, 0..=1.
    pub accuracy: f64,
    /// Share of reference points with a map point within the threshold, 0..=1.
    pub completeness: f64,
}

/// Accuracy and completeness of `map` against `reference` (for example depth pixels lifted to space).
///
/// `threshold` is in the points' unit, > 0; 0.05 m is customary. Cost: O((n + m) log) with a grid of cells
/// of that size, as long as few points share a cell.
///
/// # Errors
/// [`EvaluationError::Parameter`] for a bad threshold, [`EvaluationError::TooFewPairs`] when one set is
/// empty, [`EvaluationError::NonFinite`] (the index counts map points first).
///
/// ```
/// use edge_slam::evaluation::map_accuracy;
/// let wall = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// let result = map_accuracy(&[[0.01, 0.0, 0.0]], &wall, 0.05)?;
/// assert_eq!((result.accuracy, result.completeness), (1.0, 0.5));
/// # Ok::<(), edge_slam::evaluation::EvaluationError>(())
/// ```
pub fn map_accuracy<P: Copy + Into<[f64; 3]>, Q: Copy + Into<[f64; 3]>>(
    map: &[P],
    reference: &[Q],
    threshold: f64,
) -> Result<MapAccuracy, EvaluationError> {
    if !(threshold > 0.0 && threshold.is_finite()) {
        let value = threshold;
        return Err(EvaluationError::Parameter {
            name: "threshold",
            value,
            range: "positive",
        });
    }
    let fewest = map.len().min(reference.len());
    if fewest == 0 {
        return Err(EvaluationError::TooFewPairs {
            pairs: 0,
            needed: 1,
        });
    }
    let map: Vec<[f64; 3]> = map.iter().map(|&p| p.into()).collect();
    let reference: Vec<[f64; 3]> = reference.iter().map(|&p| p.into()).collect();
    let usable = |p: &[f64; 3]| p.iter().all(|v| (v / threshold).abs() < 1e15);
    if let Some(index) = map.iter().chain(&reference).position(|p| !usable(p)) {
        return Err(EvaluationError::NonFinite { index });
    }
    Ok(MapAccuracy {
        accuracy: share_near(&map, &reference, threshold),
        completeness: share_near(&reference, &map, threshold),
    })
}

type Cell = [i64; 3];

#[expect(
    clippy::cast_possible_truncation,
    reason = "coordinates are below 1e15 cells"
)]
fn cell_of(point: &[f64; 3], size: f64) -> Cell {
    point.map(|value| (value / size).floor() as i64)
}

#[expect(
    clippy::cast_precision_loss,
    reason = "counts of points stay far below 2^53"
)]
fn share_near(points: &[[f64; 3]], others: &[[f64; 3]], threshold: f64) -> f64 {
    let mut grid: BTreeMap<Cell, Vec<usize>> = BTreeMap::new();
    for (index, other) in others.iter().enumerate() {
        grid.entry(cell_of(other, threshold))
            .or_default()
            .push(index);
    }
    let near = points
        .iter()
        .filter(|point| has_neighbour(point, others, &grid, threshold))
        .count();
    near as f64 / points.len() as f64
}

fn has_neighbour(
    point: &[f64; 3],
    others: &[[f64; 3]],
    grid: &BTreeMap<Cell, Vec<usize>>,
    threshold: f64,
) -> bool {
    let home = cell_of(point, threshold);
    (0..27).any(|neighbour| {
        let cell = [
            home[0] + neighbour % 3 - 1,
            home[1] + neighbour / 3 % 3 - 1,
            home[2] + neighbour / 9 - 1,
        ];
        grid.get(&cell).is_some_and(|members| {
            members.iter().any(|&index| {
                let other = &others[index];
                let square: f64 = (0..3).map(|k| (point[k] - other[k]).powi(2)).sum();
                square <= threshold * threshold
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_brute_force(
            map in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 1..40),
            reference in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 1..40),
            threshold in 0.05..0.8f64,
        ) {
            let near = |p: &[f64; 3], others: &[[f64; 3]]| others.iter().any(|o| {
                (0..3).map(|k| (p[k] - o[k]).powi(2)).sum::<f64>() <= threshold * threshold
            });
            let found = map_accuracy(&map, &reference, threshold)?;
            let hits = map.iter().filter(|p| near(p, &reference)).count();
            prop_assert!((found.accuracy - hits as f64 / map.len() as f64).abs() < 1e-12);
            let hits = reference.iter().filter(|p| near(p, &map)).count();
            prop_assert!((found.completeness - hits as f64 / reference.len() as f64).abs() < 1e-12);
        }
    }

    #[test]
    fn degenerate_input_is_refused() {
        let none: [[f64; 3]; 0] = [];
        assert!(map_accuracy(&none, &[[0.0; 3]], 0.1).is_err());
        assert!(map_accuracy(&[[f64::NAN; 3]], &[[0.0; 3]], 0.1).is_err());
        assert!(map_accuracy(&[[0.0; 3]], &[[0.0; 3]], 0.0).is_err());
    }
}
