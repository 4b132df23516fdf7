//! From a plan to commands: refine for clearance, round the corners, look at the clearance, cut into legs.
//!
//! Input: a ball of radius 0.2 m among three pillars, given by the distance to the nearest one. Output: the legs.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

use rand_pcg::Pcg64;
use rrt_refine::refine::{self, ClearanceCost, RoundingConfig};
use rrt_refine::{Bounds, Leg, Query, RrtStarConfig, rrt_star};

/// Axes of the pillars (x, y), radius 0.5 m, floor to ceiling.
const PILLARS: [[f64; 2]; 3] = [[2.0, 1.0], [3.0, 3.0], [4.5, 1.5]];
const RADIUS: f64 = 0.2;
/// Every motion keeps this much air around the ball.
const MARGIN: f64 = 0.1;

/// Distance from the surface of the ball to the nearest pillar.
fn clearance(p: &[f64; 3]) -> f64 {
    let gaps =
        PILLARS.map(|[x, y]| ((p[0] - x).powi(2) + (p[1] - y).powi(2)).sqrt() - 0.5 - RADIUS);
    gaps.into_iter().fold(f64::INFINITY, f64::min)
}

/// The swept ball, exactly: the distance from each axis to the motion seen from above.
fn is_free(a: &[f64; 3], b: &[f64; 3]) -> bool {
    PILLARS.iter().all(|[x, y]| {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx * dx + dy * dy;
        let along = (x - a[0]) * dx + (y - a[1]) * dy;
        let t = if length > 0.0 {
            (along / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (gap_x, gap_y) = (a[0] + t * dx - x, a[1] + t * dy - y);
        gap_x.hypot(gap_y) > 0.5 + RADIUS + MARGIN
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bounds = Bounds::new([0.0; 3], [6.0, 4.0, 2.5])?;
    let mut config = RrtStarConfig::informed();
    config.rrt.max_iterations = 1000;
    let query = Query::new([0.5, 0.5, 1.0], [5.5, 3.5, 1.5], bounds);
    let plan = rrt_star(&query, &is_free, &config, &mut Pcg64::new(1, 1))?;
    let path = plan.path.ok_or("no path within the budget")?;

    let cost = ClearanceCost {
        comfort: 0.5,
        ..ClearanceCost::default()
    };
    let calm = refine::dag_by_cost(&path, &is_free, &|a, b| cost.of(a, b, &clearance)).path;
    let rounding = RoundingConfig {
        max_turn: 0.2,
        min_clearance: MARGIN,
        ..RoundingConfig::default()
    };
    let round = refine::round_corners(&calm, &is_free, &clearance, &rounding)?.path;
    let profile = round.clearance_profile(0.05, clearance)?;
    println!(
        "{:.2} m, at least {:.2} m from the pillars",
        round.length(),
        profile.at_least
    );

    for leg in round.legs(1.0, 15_f64.to_radians())? {
        match leg {
            Leg::Turn { angle, .. } => println!("turn {:5.1} degrees", angle.to_degrees()),
            Leg::Straight { to, length, .. } => println!("fly {length:.2} m to {to:.2?}"),
        }
    }
    Ok(())
}
