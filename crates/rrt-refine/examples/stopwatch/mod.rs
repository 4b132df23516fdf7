//! Times a planner and a refiner over queries, and prints the medians as a table.

#![allow(clippy::print_stdout, reason = "it prints the table of an example")]

use std::error::Error;
use std::time::Instant;

use rand_pcg::Pcg64;
use rrt_refine::refine::{RefineError, Refined};
use rrt_refine::{Path, Plan, PlanError, Query};

/// Milliseconds to plan, milliseconds to refine, checks, length.
pub(crate) type Row = [f64; 4];

#[expect(clippy::disallowed_methods, reason = "it measures")]
pub(crate) fn now() -> Instant {
    Instant::now()
}

/// One row a query; times are the best of three runs.
pub(crate) fn measure(
    queries: &[Query<3>],
    plan: impl Fn(&Query<3>, &mut Pcg64) -> Result<Plan<3>, PlanError>,
    refine: impl Fn(&Path<3>) -> Result<Refined<3>, RefineError>,
) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for (seed, query) in queries.iter().enumerate() {
        let mut row = [f64::INFINITY; 4];
        for _ in 0..3 {
            let begun = now();
            let plan = plan(query, &mut Pcg64::new(seed as u128, 1))?;
            let planned = now();
            let refined = refine(plan.path.as_ref().ok_or("not solved")?)?;
            row[1] = row[1].min(planned.elapsed().as_secs_f64() * 1e3);
            row[0] = row[0].min((planned - begun).as_secs_f64() * 1e3);
            row[2] = (plan.checks + refined.checks) as f64;
            row[3] = refined.path.length();
        }
        rows.push(row);
    }
    Ok(rows)
}

/// Medians; lengths are over the shorter of the first two results, query by query.
pub(crate) fn print(results: &[(&str, Vec<Row>)]) {
    println!(
        "| planner, refiner | plan, ms | refine, ms | checks | length, m | over the best RRT* |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    for (name, rows) in results {
        let [plan, refine, checks] = [0, 1, 2].map(|k| median(rows.iter().map(|row| row[k])));
        let best = results[0]
            .1
            .iter()
            .zip(&results[1].1)
            .map(|(a, b)| a[3].min(b[3]));
        let ratio = median(rows.iter().zip(best).map(|(row, best)| row[3] / best));
        let length = rows.iter().map(|row| row[3]).sum::<f64>() / rows.len() as f64;
        println!("| {name} | {plan:.3} | {refine:.3} | {checks} | {length:.2} | {ratio:.3} |");
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
