//! Progress on stderr: a spinner with the step's name, hidden where stderr is no terminal.

use core::time::Duration;

use indicatif::ProgressBar;

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

    pub(crate) fn step(&self, step: impl Into<String>) {
        self.bar.set_message(step.into());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
