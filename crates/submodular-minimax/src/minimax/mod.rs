//! min over X of max over Y: configuration, certificate and stop reasons.

mod certificate;
mod config;

pub use certificate::Certificate;
pub use config::{Beta, StopReason};
