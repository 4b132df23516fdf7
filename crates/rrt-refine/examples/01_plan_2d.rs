//! Plans through a maze of walls with RRT-Connect, refines the path and draws both.
//!
//! Input: walls as segments with openings, a point-shaped vehicle. Output: a map of characters, `.` the raw path, `o` the
//! refined one, and the figures of the search.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

use rand_pcg::Pcg64;
use rrt_refine::{Bounds, Path, RrtConfig, refine, rrt_connect};

/// Walls at these x, each with an opening between two values of y.
const WALLS: [(f64, [f64; 2]); 3] = [(3.0, [7.0, 9.0]), (6.0, [1.0, 2.5]), (9.0, [6.0, 7.0])];

fn is_free(a: &[f64; 2], b: &[f64; 2]) -> bool {
    WALLS.iter().all(|(x, [low, high])| {
        let crossing = (x - a[0]) / (b[0] - a[0]);
        let y = a[1] + crossing * (b[1] - a[1]);
        !(0.0..=1.0).contains(&crossing) || (*low < y && y < *high)
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bounds = Bounds::new([0.0, 0.0], [12.0, 10.0])?;
    let (start, goal) = ([1.0, 1.0], [11.0, 2.0]);
    let config = RrtConfig::default();
    let plan = rrt_connect(
        start,
        goal,
        &bounds,
        &is_free,
        &config,
        &mut Pcg64::new(7, 1),
    )?;
    println!(
        "{:?} after {} samples, {} nodes, {} checks",
        plan.stop, plan.iterations, plan.nodes, plan.checks
    );
    let raw = plan.path.ok_or("no path within the budget")?;
    let refined = refine::taut(&raw, &is_free, &refine::TautConfig::default())?;
    draw(&raw, &refined.path)?;
    println!(
        "{:.2} long, refined to {:.2} with {} checks",
        raw.length(),
        refined.path.length(),
        refined.checks
    );
    Ok(())
}

fn draw(raw: &Path<2>, refined: &Path<2>) -> Result<(), rrt_refine::PathError> {
    let mut map = vec![vec![' '; 61]; 21];
    let mut mark = |[x, y]: [f64; 2], sign| {
        map[20 - (y * 2.0).round() as usize][(x * 5.0).round() as usize] = sign;
    };
    for (x, [low, high]) in WALLS {
        for step in 0..=20 {
            let y = f64::from(step) / 2.0;
            if y <= low || y >= high {
                mark([x, y], '#');
            }
        }
    }
    for (path, sign) in [(raw, '.'), (refined, 'o')] {
        for point in path.resampled(400)?.points() {
            mark(*point, sign);
        }
    }
    for row in map {
        println!("{}", row.into_iter().collect::<String>());
    }
    Ok(())
}
