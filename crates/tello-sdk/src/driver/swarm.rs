//! The same for several drones at once: everyone begins together, and the slowest is waited for.

use super::blocking::Drone;
use alloc::vec::Vec;
use std::sync::Barrier;
use std::thread::ScopedJoinHandle;

/// Lets `fly` run for each drone, one thread each, begun together; returns when the last has ended, with the results in
/// the order of the drones. A drone whose `fly` panicked has `None`: the others are not disturbed.
///
/// ```no_run
/// use std::net::SocketAddr;
/// use tello_sdk::{Drone, DroneConfig, StateHub, together};
/// let hub = StateHub::bind(SocketAddr::from(([0, 0, 0, 0], 8890)))?;
/// let at = |last| DroneConfig::at(SocketAddr::from(([192, 168, 1, last], 8889)));
/// let red = Drone::connect_through(&hub, at(21))?;
/// let blue = Drone::connect_through(&hub, at(22))?;
/// let up = together(&[&red, &blue], Drone::take_off);
/// assert!(up.iter().all(|result| matches!(result, Some(Ok(())))));
/// # Ok::<(), Box<dyn std::error::Error>>(())
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
