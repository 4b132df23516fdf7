//! Which camera positions saw which point: what a SLAM map knows beyond its points.

use thiserror::Error;

/// Camera positions and, for each point, which of them observe it.
///
/// Units and frame are those of the points. Observers of point i may come in any order; duplicates
/// count once. A point without observers is allowed: its range is filled in from its neighbours.
///
/// ```
/// use submodular_minimax::Views;
/// let views = Views::new(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], vec![vec![0, 1], vec![1]])?;
/// assert_eq!(views.observers(0).collect::<Vec<_>>(), [0, 1]);
/// # Ok::<(), submodular_minimax::ViewsError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Views {
    viewpoints: Vec<[f64; 3]>,
    offsets: Vec<usize>,
    observers: Vec<u32>,
    /// 0 where unknown; empty where nothing is known.
    max_distances: Vec<f64>,
}

/// Why a [`Views`] cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewsError {
    /// A camera position is NaN or infinite.
    #[error("camera position {viewpoint} is not finite: drop that keyframe and its observations")]
    NonFinite {
        /// Index of the camera position.
        viewpoint: usize,
    },
    /// A point names a camera that does not exist.
    #[error(
        "point {point} names camera {observer}, but there are {viewpoints} cameras (0-based): \
         pass indices into the list of camera positions, not keyframe ids"
    )]
    OutOfRange {
        /// Index of the point.
        point: usize,
        /// The index that was given.
        observer: usize,
        /// How many camera positions there are.
        viewpoints: usize,
    },
    /// There are more or fewer distances than points.
    #[error("{distances} distances for {points} points: pass one a point, None where unknown")]
    Mismatch {
        /// How many distances were given.
        distances: usize,
        /// How many points the observations speak of.
        points: usize,
    },
    /// A distance is NaN, infinite or not above 0.
    #[error(
        "distance {distance} of point {point} is not finite and above 0: pass None where unknown"
    )]
    MaxDistance {
        /// Index of the point.
        point: usize,
        /// The distance that was given.
        distance: f64,
    },
}

impl Views {
    /// Checks and stores the observations: `observers[i]` = indices of `viewpoints` that see point i.
    ///
    /// # Errors
    /// A camera position that is not finite, an index out of range.
    pub fn new(viewpoints: Vec<[f64; 3]>, observers: Vec<Vec<usize>>) -> Result<Self, ViewsError> {
        let bad = viewpoints
            .iter()
            .position(|c| c.iter().any(|x| !x.is_finite()));
        if let Some(viewpoint) = bad {
            return Err(ViewsError::NonFinite { viewpoint });
        }
        let mut views = Self {
            viewpoints,
            offsets: vec![0],
            observers: Vec::new(),
            max_distances: Vec::new(),
        };
        for (point, mut row) in observers.into_iter().enumerate() {
            row.sort_unstable();
            row.dedup();
            if let Some(&observer) = row.last().filter(|&&last| last >= views.viewpoints.len()) {
                let viewpoints = views.viewpoints.len();
                return Err(ViewsError::OutOfRange {
                    point,
                    observer,
                    viewpoints,
                });
            }
            views.observers.extend(row.into_iter().map(|c| c as u32));
            views.offsets.push(views.observers.len());
        }
        Ok(views)
    }

    /// Views in which one camera sees everything: all that a bare cloud and an agent's position tell.
    ///
    /// # Errors
    /// A position that is not finite.
    pub fn from_position(position: [f64; 3], points: usize) -> Result<Self, ViewsError> {
        Self::new(vec![position], vec![vec![0]; points])
    }

    /// Adds the largest distance from which the feature of each point can be recognised, where known: `max_distance` of
    /// ORB-SLAM, in the unit of the points. Over a point's range it tells how coarse its feature is, hence how
    /// loosely it is placed.
    ///
    /// # Errors
    /// Another number of points, a distance that is not finite and above 0.
    pub fn with_max_distances(mut self, distances: Vec<Option<f64>>) -> Result<Self, ViewsError> {
        if distances.len() != self.points() {
            return Err(ViewsError::Mismatch {
                distances: distances.len(),
                points: self.points(),
            });
        }
        let good = |distance: &f64| distance.is_finite() && *distance > 0.0;
        for (point, distance) in distances.iter().enumerate() {
            if let Some(distance) = distance.filter(|distance| !good(distance)) {
                return Err(ViewsError::MaxDistance { point, distance });
            }
        }
        let known = distances.iter().any(Option::is_some);
        let distances = distances
            .into_iter()
            .map(|distance| distance.unwrap_or(0.0));
        self.max_distances = if known {
            distances.collect()
        } else {
            Vec::new()
        };
        Ok(self)
    }

    /// How many points the observations speak of.
    #[must_use]
    pub fn points(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The camera positions.
    #[must_use]
    pub fn viewpoints(&self) -> &[[f64; 3]] {
        &self.viewpoints
    }

    /// The cameras that see point `point`, ascending; none for an index out of range.
    pub fn observers(&self, point: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.row(point).iter().map(|&c| c as usize)
    }

    /// The largest distance from which the feature of point `point` can be recognised, where known.
    #[must_use]
    pub fn max_distance(&self, point: usize) -> Option<f64> {
        self.max_distances.get(point).copied().filter(|&d| d > 0.0)
    }

    pub(crate) fn row(&self, point: usize) -> &[u32] {
        let start = self.offsets.get(point).copied().unwrap_or(0);
        let end = self.offsets.get(point + 1).copied().unwrap_or(start);
        &self.observers[start..end]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn out_of_range_names_point_and_camera() {
        let error = Views::new(vec![[0.0; 3]], vec![vec![0], vec![0, 3]]).unwrap_err();
        assert_eq!(
            error,
            ViewsError::OutOfRange {
                point: 1,
                observer: 3,
                viewpoints: 1
            }
        );
    }

    #[test]
    fn duplicates_count_once_and_rows_ascend() {
        let views = Views::new(vec![[0.0; 3]; 4], vec![vec![3, 1, 3], vec![]]).unwrap();
        assert_eq!(views.observers(0).collect::<Vec<_>>(), [1, 3]);
        assert_eq!(views.observers(1).len(), 0);
        assert_eq!(views.observers(9).len(), 0);
        assert_eq!(views.points(), 2);
    }

    #[test]
    fn distances_are_checked_and_told_where_known() {
        let views = || Views::from_position([0.0; 3], 3).unwrap();
        assert_eq!(views().max_distance(0), None);
        let known = views().with_max_distances(vec![Some(2.0), None, Some(0.5)]);
        let known = known.unwrap();
        let told: Vec<_> = (0..4).map(|v| known.max_distance(v)).collect();
        assert_eq!(told, [Some(2.0), None, Some(0.5), None]);
        assert_eq!(views().with_max_distances(vec![None; 3]), Ok(views()));
        let error = views().with_max_distances(vec![None; 2]).unwrap_err();
        assert_eq!(
            error,
            ViewsError::Mismatch {
                distances: 2,
                points: 3
            }
        );
        for distance in [0.0, -1.0, f64::INFINITY] {
            let error = views().with_max_distances(vec![None, Some(distance), None]);
            assert_eq!(error, Err(ViewsError::MaxDistance { point: 1, distance }));
        }
        assert!(views().with_max_distances(vec![Some(f64::NAN); 3]).is_err());
    }

    #[test]
    fn non_finite_camera_is_an_error() {
        let error = Views::new(vec![[0.0; 3], [f64::NAN; 3]], vec![]).unwrap_err();
        assert_eq!(error, ViewsError::NonFinite { viewpoint: 1 });
    }
}
