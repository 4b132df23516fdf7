//! Free-space violations: how many rays pass through a point and end well behind it?
//!
//! A ray from camera c to a point q that c sees proves the space before q free. A point v that c does
//! not see, within `angle` of the ray and with |cq| > margin |cv|, stands in that space.
//! Cost: O(cameras · n log n) at most, with the cameras capped.

use super::config::RayConfig;
use super::sight::Sight;
use crate::neighbours::RangeTree;
use crate::points::Cloud;

/// The number of violating rays of every point.
pub(super) fn violations(cloud: &Cloud, sight: &Sight<'_>, config: &RayConfig) -> Vec<u32> {
    let mut count = vec![0; cloud.len()];
    let cameras = sight.cameras.len();
    let used = cameras.min(config.max_cameras);
    for camera in (0..used).map(|i| i * cameras / used) {
        count_for_camera(cloud, sight, camera, config, &mut count);
    }
    count
}

fn count_for_camera(
    cloud: &Cloud,
    sight: &Sight<'_>,
    camera: usize,
    config: &RayConfig,
    count: &mut [u32],
) {
    let seen = &sight.seen[camera];
    let (directions, lengths): (Vec<[f64; 3]>, Vec<f64>) = seen
        .iter()
        .map(|&q| sight.bearing(cloud, camera, q as usize))
        .unzip();
    let tree = RangeTree::new(&directions, &[]);
    let chord = 2.0 * (config.angle / 2.0).sin();
    let mut sees = seen.iter().peekable();
    for (v, count) in count.iter_mut().enumerate() {
        if sees.next_if(|&&q| q as usize == v).is_some() {
            continue;
        }
        let (direction, range) = sight.bearing(cloud, camera, v);
        tree.within(direction, chord * chord, &mut |q, _| {
            *count += u32::from(lengths[q as usize] > config.margin * range);
        });
    }
}
