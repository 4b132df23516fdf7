//! What really happened, for evaluation only.

use core::time::Duration;

use nalgebra::Isometry3;

/// A moment of the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// When.
    pub time: Duration,
    /// Where: body to world, x forward, y left, z up, metres.
    pub world_from_body: Isometry3<f64>,
}

/// The body touched something solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collision {
    /// When.
    pub time: Duration,
    /// Centre of the body, metres.
    pub position: [f64; 3],
    /// Number of the solid in [`World::solids`](crate::World::solids).
    pub solid: usize,
}

/// What really happened so far.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// One moment per picture, in order.
    pub trajectory: Vec<TrackPoint>,
    /// Every collision, in order.
    pub collisions: Vec<Collision>,
    /// Least distance from the body's centre to anything but the floor while flying, metres; infinite before the first
    /// take-off. The body touches at its radius.
    pub min_clearance: f64,
    /// Length of the way flown, metres.
    pub path_length: f64,
    /// Number of take-offs.
    pub takeoffs: u32,
}

impl Default for Truth {
    fn default() -> Self {
        Self {
            trajectory: Vec::new(),
            collisions: Vec::new(),
            min_clearance: f64::INFINITY,
            path_length: 0.0,
            takeoffs: 0,
        }
    }
}

impl Truth {
    /// Positions of the trajectory, metres, leaving out those within `spacing` metres of the one before.
    #[must_use]
    pub fn positions(&self, spacing: f64) -> Vec<[f64; 3]> {
        let mut kept: Vec<[f64; 3]> = Vec::new();
        for point in &self.trajectory {
            let position: [f64; 3] = point.world_from_body.translation.vector.into();
            let far = kept.last().is_none_or(|last: &[f64; 3]| {
                (0..3)
                    .map(|axis| (last[axis] - position[axis]).powi(2))
                    .sum::<f64>()
                    >= spacing * spacing
            });
            if far {
                kept.push(position);
            }
        }
        kept
    }
}
