//! What the user reads when a command cannot be done: one line with the reason, and what to do.

use core::fmt;
use std::io;
use std::path::Path;

/// A reason and a piece of advice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    reason: String,
    advice: String,
}

impl Failure {
    pub(crate) fn new(reason: impl fmt::Display, advice: impl Into<String>) -> Self {
        Self {
            reason: reason.to_string(),
            advice: advice.into(),
        }
    }

    /// For what no input should bring about.
    pub(crate) fn internal(reason: impl fmt::Display) -> Self {
        Self::new(reason, "please report this with the command that you gave")
    }

    /// A file that could not be written.
    pub(crate) fn write(path: &Path, error: &io::Error) -> Self {
        let reason = format!("cannot write {}: {error}", path.display());
        Self::new(reason, "check that the folder exists and can be written to")
    }
}

impl fmt::Display for Failure {
    /// One line, whatever the parts hold.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{}; {}", self.reason, self.advice);
        f.write_str(&text.replace(['\n', '\r'], " "))
    }
}
