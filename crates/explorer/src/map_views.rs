//! From a SLAM map to the observations that the outlier removal looks at.

use slam_bridge::Map;
use submodular_minimax::{Views, ViewsError};

/// Which keyframe of a map saw which point, and from how far each point can be recognised, in map units; `None` for a
/// map without observations. Observers that the map does not hold are left out.
///
/// Cost: O(o log k) for o observations and k keyframes.
///
/// # Errors
/// A keyframe's place or a recognition distance that is not a number a map can hold ([`ViewsError`]); maps from files
/// have none.
///
/// ```
/// use explorer::map_views;
/// use submodular_minimax::{OutlierConfig, remove_outliers};
/// # let map = slam_bridge::Map::from_positions([[0.0; 3]; 5]);
/// let views = map_views(&map)?;
/// let cleaned = remove_outliers(&map.positions(), views.as_ref(), &OutlierConfig::default())?;
/// # assert_eq!(cleaned.kept.len(), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn map_views(map: &Map) -> Result<Option<Views>, ViewsError> {
    if !map.has_observations() {
        return Ok(None);
    }
    let (keyframes, points) = (map.keyframes.iter(), map.points.iter());
    let centers = keyframes.map(|keyframe| keyframe.center().into());
    let place = |&id| map.keyframe_index(id);
    let observers = points
        .clone()
        .map(|point| point.observers.iter().filter_map(place).collect());
    Views::new(centers.collect(), observers.collect())?
        .with_max_distances(points.map(|point| point.max_distance).collect())
        .map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use slam_bridge::{KeyFrame, KeyFrameId, nalgebra::Isometry3};

    #[test]
    fn ids_become_places_and_unknown_keyframes_are_left_out() {
        let mut map = Map::from_positions([[0.0; 3], [1.0; 3]]);
        assert_eq!(map_views(&map), Ok(None));
        map.keyframes = [4, 9].map(keyframe).to_vec();
        map.points[1].observers = [4, 7, 9].map(KeyFrameId).to_vec();
        map.points[1].max_distance = Some(2.0);
        let views = map_views(&map).unwrap().unwrap();
        assert_eq!(views.viewpoints(), [[4.0, 0.0, 0.0], [9.0, 0.0, 0.0]]);
        assert_eq!(views.observers(0).len(), 0);
        assert_eq!(views.observers(1).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(
            (0..2).map(|v| views.max_distance(v)).collect::<Vec<_>>(),
            [None, Some(2.0)]
        );
    }

    fn keyframe(id: u64) -> KeyFrame {
        KeyFrame {
            id: KeyFrameId(id),
            time: None,
            world_from_camera: Isometry3::translation(id as f64, 0.0, 0.0),
        }
    }
}
