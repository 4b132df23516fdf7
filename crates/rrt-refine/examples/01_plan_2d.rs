//! Finds a short path through a maze of walls and draws it with the path as planned.
//!
//! Input: walls as segments with openings, a point-shaped vehicle. Output: a map of characters, `.` the raw path, `o` the
//! refined one, and the figures of the search.

#![allow(clippy::print_stdout, reason = "an example prints its result")]

use rand_pcg::Pcg64;
use rrt_refine::{Bounds, FindPathConfig, Path, Query, find_path};

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
    let query = Query::new([1.0, 1.0], [11.0, 2.0], bounds);
    let mut rng = Pcg64::new(7, 1);
    let found = find_path(&query, &is_free, &FindPathConfig::default(), &mut rng)?;
    let plan = &found.plan;
    println!(
        "best of {}: {:?} after {} samples, {} nodes, {} checks",
        found.attempts, plan.stop, plan.iterations, plan.nodes, plan.checks
    );
    let raw = plan.path.as_ref().ok_or("no path within the budget")?;
    let path = found.path.ok_or("no path within the budget")?;
    draw(raw, &path)?;
    println!(
        "{:.2} long, refined to {:.2}; {} checks in all",
        raw.length(),
        path.length(),
        found.checks
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
