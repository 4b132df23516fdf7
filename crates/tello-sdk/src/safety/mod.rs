//! What makes a session land by itself, and what must hold before it takes off.

mod alarm;
mod preflight;

pub use alarm::{Alarm, Fence, SafetyConfig};
pub(crate) use alarm::{Guard, outside};
pub use preflight::{Finding, PreflightConfig, preflight};
