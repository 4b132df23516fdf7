//! One row an algorithm: what it chose, the value against the worst response found, the bounds.
#![allow(
    clippy::print_stdout,
    unreachable_pub,
    reason = "examples print their results"
)]

use std::error::Error;
use submodular_minimax::maximize::{LazyGreedy, Maximizer};
use submodular_minimax::minimax::{
    MinimaxSolution, best_response, iterative_x_growing, max_then_min, min_as_oracle,
    min_by_singletons,
};
use submodular_minimax::minimize::ModularMinimizer;
use submodular_minimax::{Beta, JointFunction, MinimaxConfig, Subset};

/// Runs every minimax algorithm with lazy greedy responses of at most `k` elements.
pub fn compare<F: JointFunction>(function: &F, k: usize) -> Result<(), Box<dyn Error>> {
    let (mut oracle, exact) = (LazyGreedy::cardinality(k), ModularMinimizer);
    let sqrt = MinimaxConfig::default();
    let paper = MinimaxConfig::paper();
    let small = MinimaxConfig {
        beta: Beta::Fixed(0.1),
        ..sqrt
    };
    let rows = [
        (
            "Iterative-X-Growing, β = √n",
            iterative_x_growing(function, &mut oracle, &exact, &sqrt)?,
        ),
        (
            "Iterative-X-Growing, β = 1",
            iterative_x_growing(function, &mut oracle, &exact, &paper)?,
        ),
        (
            "Iterative-X-Growing, β = 0.1",
            iterative_x_growing(function, &mut oracle, &exact, &small)?,
        ),
        (
            "Min-by-Singletons",
            min_by_singletons(function, &mut oracle, &exact)?,
        ),
        (
            "Best-Response",
            best_response(function, &mut oracle, &exact, &sqrt)?,
        ),
        (
            "Max-and-then-Min",
            max_then_min(function, &mut oracle, &exact)?,
        ),
        (
            "Min-as-Oracle (max-min)",
            min_as_oracle(function, &mut oracle, &exact)?,
        ),
    ];
    // Every algorithm's responses bound the same optimum: the best lower bound serves all rows.
    let lower = rows
        .iter()
        .map(|r| r.1.certificate.lower_bound)
        .fold(0.0, f64::max);
    println!(
        "{:30} {:>4} {:>8} {:>8} {:>7} {:>7}",
        "", "|X|", "value", "upper", "/lower", "rounds"
    );
    for (name, solution) in &rows {
        print_row(name, solution, lower);
    }
    let nothing = oracle.maximize(function.given_x(&Subset::empty(function.x_size())).as_ref())?;
    println!("{:30} {:4} {:8.3}", "nothing chosen", 0, nothing.value);
    println!(
        "lower bound on the optimum: {lower:.3}; \"/lower\": the upper bound in its multiples"
    );
    println!(
        "the max-min row has the value and the bound of max-min, which is never above minimax"
    );
    Ok(())
}

fn print_row(name: &str, solution: &MinimaxSolution, lower: f64) {
    let (size, upper) = (solution.x.len(), solution.certificate.upper_bound);
    let ratio = upper / lower;
    let (value, rounds) = (solution.value, solution.iterations);
    println!("{name:30} {size:4} {value:8.3} {upper:8.3} {ratio:7.2} {rounds:7}");
}
