//! Path refiners: the same two ends, never longer, every new motion checked.

mod dag;
mod refined;

pub use dag::dag;
pub use refined::Refined;
