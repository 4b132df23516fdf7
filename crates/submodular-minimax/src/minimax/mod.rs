//! min over X of max over Y of a submodular f(X ∪ Y), and the other way round.
//!
//! | function | needs | guarantee |
//! | --- | --- | --- |
//! | [`iterative_x_growing`] | joint submodularity, f ≥ 0 | (2 + T/β + β) / α of min-max, T iterations |
//! | [`min_by_singletons`] | disjoint submodularity, f ≥ 0 | \|N₂\| + 1 of min-max |
//! | [`min_as_oracle`] | joint submodularity | the greedy factor of max-min, if monotone in Y |
//! | [`best_response`] | nothing | none: a baseline |
//! | [`max_then_min`] | nothing | none: a baseline |
//!
//! Every result carries a [`Certificate`] that bounds its distance from the optimum after the fact.
//!
//! Reference: arXiv 2305.16903 (minimax submodular optimisation), Algorithm 1 and
//! Theorem 3.3 as the exploration paper cites them; the guarantees are derived again in each algorithm's file.

mod baselines;
mod certificate;
mod config;
mod iterative_x_growing;
mod min_as_oracle;
mod min_by_singletons;
mod solution;

pub use baselines::{best_response, max_then_min};
pub use certificate::Certificate;
pub use config::{Beta, MinimaxConfig, StopReason};
pub use iterative_x_growing::iterative_x_growing;
pub use min_as_oracle::min_as_oracle;
pub use min_by_singletons::min_by_singletons;
pub use solution::{MinimaxError, MinimaxSolution};
