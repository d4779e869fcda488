//! The progress of a run: a bar on standard error when that is a terminal, otherwise nothing.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// Parts of a whole bar.
const LENGTH: u64 = 1000;

/// A bar from one time to another.
pub struct Progress {
    bar: ProgressBar,
    start: f64,
    end: f64,
}

impl Progress {
    /// Creates a bar for a run from `start` to `end`, in s; hidden when `quiet`, or when standard
    /// error is no terminal.
    pub fn new(quiet: bool, start: f64, end: f64) -> Self {
        let hidden = quiet || !std::io::stderr().is_terminal();
        let target = if hidden {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(10)
        };
        let bar = ProgressBar::with_draw_target(Some(LENGTH), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {elapsed}")
        {
            bar.set_style(style);
        }
        Self { bar, start, end }
    }
    /// Moves the bar to `time`, in s.
    pub fn at(&self, time: f64) {
        if self.bar.is_hidden() {
            return;
        }
        let part = ((time - self.start) / (self.end - self.start)).clamp(0.0, 1.0);
        self.bar.set_position((part * LENGTH as f64) as u64);
        self.bar.set_message(format!("time {time:.4}"));
    }
    /// Removes the bar.
    pub fn done(&self) {
        self.bar.finish_and_clear();
    }
}
