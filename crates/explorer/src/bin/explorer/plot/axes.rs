//! The map seen from above: a plane with named axes.

use exit_finder::{AffinePlane, PlaneError};

/// A projection along `up`, and what its axes are called.
#[derive(Debug, Clone)]
pub(crate) struct TopView {
    plane: AffinePlane,
    names: [String; 2],
}

impl TopView {
    /// Seen from the tip of `up`; `unit` is "m" or "map units".
    pub(crate) fn new(up: [f64; 3], unit: &str) -> Result<Self, PlaneError> {
        Ok(Self::of_plane(AffinePlane::from_up(up, [0.0; 3])?, unit))
    }

    pub(crate) fn of_plane(plane: AffinePlane, unit: &str) -> Self {
        let [first, second] = plane.axes();
        let names = [name(first, "u"), name(second, "v")].map(|name| format!("{name} [{unit}]"));
        Self { plane, names }
    }

    pub(crate) fn names(&self) -> [String; 2] {
        self.names.clone()
    }

    /// Where a point of the map lies in the picture.
    pub(crate) fn project(&self, point: [f64; 3]) -> [f64; 2] {
        self.plane.project(point)
    }

    pub(crate) fn project_all<'a>(
        &self,
        points: impl IntoIterator<Item = &'a [f64; 3]>,
    ) -> Vec<[f64; 2]> {
        points
            .into_iter()
            .map(|point| self.project(*point))
            .collect()
    }

    /// A direction of the map in the picture.
    pub(crate) fn direction(&self, direction: [f64; 3]) -> [f64; 2] {
        let [to, from] = [self.project(direction), self.project([0.0; 3])];
        [to[0] - from[0], to[1] - from[1]]
    }
}

/// The map's axis that a unit vector follows, else another name.
fn name(axis: [f64; 3], otherwise: &str) -> String {
    let along = |sign: f64| axis.iter().position(|value| value * sign > 0.9999);
    match (along(1.0), along(-1.0)) {
        (Some(index), _) => ["x", "y", "z"]
            .get(index)
            .copied()
            .unwrap_or(otherwise)
            .to_owned(),
        (_, Some(index)) => format!(
            "-{}",
            ["x", "y", "z"].get(index).copied().unwrap_or(otherwise)
        ),
        _ => otherwise.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_named_after_the_maps() {
        let names = |up| TopView::new(up, "m").expect("a direction").names();
        assert_eq!(names([0.0, 0.0, 1.0]), ["x [m]", "y [m]"]);
        assert_eq!(names([0.0, -1.0, 0.0]), ["x [m]", "z [m]"]);
        assert_eq!(names([0.0, 1.0, 1.0]), ["x [m]", "v [m]"]);
    }
}
