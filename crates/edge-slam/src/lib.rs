#![doc = include_str!("../README.md")]
#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a negated comparison refuses NaN as well"
)]

pub mod evaluation;

pub use nalgebra;
