//! Path refiners: the same two ends, never longer, every new motion checked.
//!
//! | refiner | vertices of the result | idempotent |
//! | --- | --- | --- |
//! | [`dag()`] | some of the input's, chosen optimally | yes |
//! | [`dag_by_cost`] | some of the input's, chosen optimally for a cost such as [`ClearanceCost`] | yes |
//! | [`greedy()`] | some of the input's, farthest first | yes |
//! | [`taut()`] (default: `dag`, then corners cut) | anywhere on the path as it tightens | yes, unless the rounds ran out |
//! | [`rope()`] | anywhere on the path as it tightens | yes, unless the budget ran out |
//! | [`shortcut()`] | anywhere on the path, at random | no |
//! | [`round_corners`] | arcs in place of corners, under a clearance | yes |

mod clearance_cost;
mod dag;
mod error;
mod greedy;
mod refined;
mod rope;
mod rounding;
mod shortcut;
mod taut;
mod visibility_graph;

pub use clearance_cost::ClearanceCost;
pub use dag::{dag, dag_by_cost};
pub use error::RefineError;
pub use greedy::greedy;
pub use refined::{RefineStop, Refined};
pub use rope::{RopeConfig, rope};
pub use rounding::{RoundingConfig, round_corners};
pub use shortcut::{Places, ShortcutConfig, shortcut};
pub use taut::{TautConfig, taut};
