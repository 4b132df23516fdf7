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
    fn non_finite_camera_is_an_error() {
        let error = Views::new(vec![[0.0; 3], [f64::NAN; 3]], vec![]).unwrap_err();
        assert_eq!(error, ViewsError::NonFinite { viewpoint: 1 });
    }
}
