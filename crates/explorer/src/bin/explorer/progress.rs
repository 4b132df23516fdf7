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

    /// Turns into a bar that fills as [`Progress::advance`] is called `total` times.
    pub(crate) fn count(&self, step: &str, total: usize) {
        let style =
            ProgressStyle::with_template("{spinner} {msg} {bar:40} {pos}/{len}, {eta} left");
        if let Ok(style) = style {
            self.bar.set_style(style);
        }
        self.bar.set_length(total as u64);
        self.bar.set_message(step.to_owned());
    }

    /// One more of what is counted is done.
    pub(crate) fn advance(&self) {
        self.bar.inc(1);
    }

    pub(crate) fn step(&self, step: impl Into<String>) {
        self.bar.set_message(step.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
