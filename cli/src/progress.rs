//! The progress of a run that takes longer than two seconds: a bar on standard error when that is a
//! terminal, otherwise a line now and then.

use cognate::diagnostic::counted;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::cell::Cell;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Parts of a whole bar.
const LENGTH: u64 = 1000;
/// Time that a run goes on before its progress is shown.
const PATIENCE: Duration = Duration::from_secs(2);
/// The longest time between two lines.
const LONGEST_SILENCE: Duration = Duration::from_secs(60);

/// The progress from one time to another.
pub struct Progress {
    /// where it is shown
    shown: Shown,
    begun: Instant,
    /// when it is shown next, counted from the beginning
    next: Cell<Duration>,
    start: f64,
    end: f64,
}

enum Shown {
    Nowhere,
    /// as a bar
    Bar(ProgressBar),
    /// as lines
    Lines,
}

impl Progress {
    /// Creates the progress of a run from `start` to `end`, in s; nothing is shown when `quiet`.
    pub fn new(quiet: bool, start: f64, end: f64) -> Self {
        let shown = if quiet {
            Shown::Nowhere
        } else if std::io::stderr().is_terminal() {
            let target = ProgressDrawTarget::stderr_with_hz(10);
            let bar = ProgressBar::with_draw_target(Some(LENGTH), target);
            let template = "{bar:40} {percent:>3} %  {msg}  {elapsed}";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            Shown::Bar(bar)
        } else {
            Shown::Lines
        };
        Self {
            shown,
            begun: Instant::now(),
            next: Cell::new(PATIENCE),
            start,
            end,
        }
    }
    /// Shows that `time` has been reached, in s, after so many steps.
    pub fn at(&self, time: f64, steps: usize) {
        self.show(
            time,
            || format!("time {time:.4}, {}", counted(steps, "step")),
            || {
                let end = self.end;
                format!("time {time:.6} of {end}, {}", counted(steps, "step"))
            },
        );
    }
    /// Shows that the integration which measures the error has reached `time`, in s.
    pub fn measures(&self, time: f64, steps: usize) {
        let text = || {
            format!(
                "measuring the error: time {time:.4}, {}",
                counted(steps, "step")
            )
        };
        self.show(time, text, text);
    }
    /// Shows that so many of all pictures are drawn.
    #[cfg(feature = "gif")]
    pub fn pictures(&self, done: usize, all: usize) {
        let text = || format!("{done} of {all} pictures");
        self.show(done as f64, text, text);
    }
    /// Shows that so many of all runs are done.
    pub fn runs(&self, done: usize, all: usize) {
        let text = || format!("{done} of {all} runs");
        self.show(done as f64, text, text);
    }
    /// Shows that so much processor time has been used, in s, and by what.
    pub fn work(&self, used: impl Fn() -> f64, by: &str) {
        if !self.is_due() {
            return;
        }
        let used = used();
        let text = || {
            format!(
                "{by}, {used:.1} s of at most {:.0} s of processor time",
                self.end
            )
        };
        self.show(used, text, text);
    }
    /// Returns whether it is time to show something.
    fn is_due(&self) -> bool {
        !matches!(self.shown, Shown::Nowhere) && self.begun.elapsed() >= self.next.get()
    }
    /// Shows a part of the whole, where it is time for that.
    fn show(&self, at: f64, in_bar: impl Fn() -> String, in_line: impl Fn() -> String) {
        if !self.is_due() {
            return;
        }
        let elapsed = self.begun.elapsed();
        let part = ((at - self.start) / (self.end - self.start)).clamp(0.0, 1.0);
        match &self.shown {
            Shown::Nowhere => {}
            Shown::Bar(bar) => {
                bar.set_position((part * LENGTH as f64) as u64);
                bar.set_message(in_bar());
            }
            Shown::Lines => {
                super::remark(format!(
                    "{:.1} % done: {}, {:.0} s",
                    100.0 * part,
                    in_line(),
                    elapsed.as_secs_f64()
                ));
                // twice as long each time
                self.next.set(elapsed + elapsed.min(LONGEST_SILENCE));
            }
        }
    }
    /// Removes the bar.
    pub fn done(&self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}
