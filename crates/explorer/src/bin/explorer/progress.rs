//! Progress on stderr: a spinner with the step's name, hidden where stderr is no terminal.

use core::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A line that says what is being done.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Begins with a first step; shows nothing where stderr is no terminal.
    pub(crate) fn begin(step: &str) -> Self {
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(120));
        bar.set_message(step.to_owned());
        Self { bar }
    }

    /// A line that also counts to `length`.
    pub(crate) fn counting(step: &str, length: u64) -> Self {
        let bar = ProgressBar::new(length);
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} ({elapsed})") {
            bar.set_style(style);
        }
        bar.set_message(step.to_owned());
        Self { bar }
    }

    pub(crate) fn step(&self, step: impl Into<String>) {
        self.bar.set_message(step.into());
    }

    pub(crate) fn reach(&self, position: u64) {
        self.bar.set_position(position);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
