//! Points at even spacing along a path, with and without its vertices.

use super::{Path, PathError};
use crate::euclid::{between, distance};

/// Most points that one request gives.
const LIMIT: usize = 10_000_000;

impl<const D: usize> Path<D> {
    /// The same path with extra vertices, so that no segment is longer than `max_step`; the old vertices stay.
    ///
    /// Each segment is cut into the fewest equal parts.
    ///
    /// # Errors
    /// A step that is not positive and finite, or one so small that more than ten million vertices were needed.
    pub fn densified(&self, max_step: f64) -> Result<Self, PathError> {
        positive("max_step", max_step)?;
        let needed = self.length() / max_step + self.points().len() as f64;
        bounded(needed)?;
        let mut points = vec![self.start()];
        for (a, b) in self.segments() {
            // Bounded above by `needed`, so the conversion is exact.
            let parts = (distance(a, b) / max_step).ceil().max(1.0) as usize;
            points.extend((1..=parts).map(|part| between(a, b, part as f64 / parts as f64)));
        }
        Ok(Self::from_vertices(points))
    }

    /// `count` points at equal distances along the path, both ends among them; corners are cut.
    ///
    /// One point is the start. Meant for drawing and comparing: the chords between the points were never checked.
    ///
    /// # Errors
    /// `count` of 0, or above ten million.
    pub fn resampled(&self, count: usize) -> Result<Self, PathError> {
        positive("count", count as f64)?;
        bounded(count as f64)?;
        let length = self.length();
        let mut points = Vec::with_capacity(count);
        let mut walked = 0.0;
        let mut segments = self.segments().peekable();
        for place in 0..count - 1 {
            let along = length * place as f64 / (count - 1) as f64;
            while let Some((a, b)) = segments.peek().copied() {
                let step = distance(a, b);
                if along < walked + step {
                    break;
                }
                walked += step;
                segments.next();
            }
            points.push(segments.peek().map_or(self.end(), |(a, b)| {
                between(a, b, (along - walked) / distance(a, b))
            }));
        }
        points.push(if count == 1 { self.start() } else { self.end() });
        Ok(Self::from_vertices(points))
    }
}

pub(super) fn positive(name: &'static str, value: f64) -> Result<(), PathError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(PathError::NotPositive { name, value })
    }
}

pub(super) fn bounded(needed: f64) -> Result<(), PathError> {
    if needed <= LIMIT as f64 {
        Ok(())
    } else {
        Err(PathError::TooMany {
            needed,
            limit: LIMIT,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densifying_keeps_vertices_and_length() -> Result<(), PathError> {
        let path = Path::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.25]])?;
        let dense = path.densified(0.3)?;
        assert_eq!(dense.points().len(), 6);
        assert!((dense.length() - path.length()).abs() < 1e-12);
        assert!(dense.segments().all(|(a, b)| distance(a, b) <= 0.3 + 1e-12));
        for vertex in path.points() {
            assert!(dense.points().contains(vertex));
        }
        Ok(())
    }

    #[test]
    fn resampling_spaces_evenly() -> Result<(), PathError> {
        let path = Path::new(&[[0.0], [1.0], [1.0], [4.0]])?;
        let even = path.resampled(5)?;
        assert_eq!(even.points(), [[0.0], [1.0], [2.0], [3.0], [4.0]]);
        assert_eq!(path.resampled(1)?.points(), [[0.0]]);
        assert_eq!(Path::new(&[[2.0]])?.resampled(3)?.points(), [[2.0]; 3]);
        Ok(())
    }

    #[test]
    fn unreasonable_requests_are_refused() -> Result<(), PathError> {
        let path = Path::new(&[[0.0], [1.0]])?;
        assert!(matches!(
            path.densified(0.0),
            Err(PathError::NotPositive { .. })
        ));
        assert!(matches!(
            path.densified(f64::NAN),
            Err(PathError::NotPositive { .. })
        ));
        assert!(matches!(
            path.densified(1e-300),
            Err(PathError::TooMany { .. })
        ));
        assert!(matches!(
            path.resampled(0),
            Err(PathError::NotPositive { .. })
        ));
        assert!(matches!(
            path.resampled(usize::MAX),
            Err(PathError::TooMany { .. })
        ));
        Ok(())
    }
}
