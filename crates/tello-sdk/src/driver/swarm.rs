//! The same for several drones at once: everyone begins together, and the slowest is waited for.

use super::blocking::Drone;
use alloc::vec::Vec;
use std::sync::Barrier;
use std::thread::ScopedJoinHandle;

/// Lets `fly` run for each drone, one thread each, begun together; returns when the last has ended, with the results in
/// the order of the drones. A drone whose `fly` panicked has `None`: the others are not disturbed.
///
/// ```no_run
/// # let (red, blue): (tello_sdk::Drone, tello_sdk::Drone) = todo!();
/// use tello_sdk::together;
/// let drones = [&red, &blue];
/// let up = together(&drones, |drone| drone.take_off());
/// assert!(up.iter().all(|result| matches!(result, Some(Ok(())))));
/// ```
pub fn together<T: Send>(drones: &[&Drone], fly: impl Fn(&Drone) -> T + Sync) -> Vec<Option<T>> {
    let start = Barrier::new(drones.len());
    std::thread::scope(|scope| {
        let threads: Vec<ScopedJoinHandle<'_, T>> = drones
            .iter()
            .map(|drone| {
                scope.spawn(|| {
                    start.wait();
                    fly(drone)
                })
            })
            .collect();
        threads
            .into_iter()
            .map(|thread| thread.join().ok())
            .collect()
    })
}
