//! A place where the drone is cannot lie in an obstacle, whatever the hulls say.

use super::ObstacleSet;
use super::error::ObstacleError;
use crate::hull::{self, Hull};
use crate::point::is_finite;

impl ObstacleSet {
    /// Opens a ball because the drone itself is, or was, there: the start bubble of a mission.
    ///
    /// Hulls that the ball touches fall apart into their points, and the points inside the ball are
    /// dropped. Afterwards the ball is free, and as much of the obstacles stays as the points tell.
    /// See [`FreeSpace::add_ball`](crate::FreeSpace::add_ball).
    ///
    /// # Errors
    /// A centre or radius that is not finite, or a negative radius.
    pub fn clear_ball(&mut self, centre: [f64; 3], radius: f64) -> Result<(), ObstacleError> {
        if !(is_finite(centre) && radius >= 0.0 && radius.is_finite()) {
            return Err(ObstacleError::Ball { radius });
        }
        if self.motion_is_free(centre, centre, radius) {
            return Ok(());
        }
        let touches =
            |hull: &Hull| hull::separation(&hull.vertices, centre, centre, radius).lower <= radius;
        let (touched, mut hulls): (Vec<Hull>, Vec<Hull>) = std::mem::take(&mut self.hulls)
            .into_iter()
            .partition(touches);
        let points = std::mem::take(&mut self.points);
        let members = touched.into_iter().flat_map(|hull| hull.point_indices);
        let alone = members.map(|index| hull::build(&points, vec![index]));
        // By the same measure as the queries, to the last digit.
        hulls.extend(alone.filter(|hull| !touches(hull)));
        self.replace(hulls, points);
        Ok(())
    }
}
