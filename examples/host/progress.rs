//! Progress on a terminal; silent where standard error is a file or a pipe.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    pub fn new() -> Self {
        let bar = ProgressBar::new_spinner();
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar }
    }

    /// Names what is being done now.
    pub fn step(&self, message: &'static str) {
        self.bar.set_message(message);
    }

    /// Starts to count frames.
    pub fn count(&self, frames: u32) {
        self.bar.set_length(u64::from(frames));
        let template = "{spinner} {msg} {wide_bar} {pos}/{len}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(style);
        }
    }

    pub fn advance(&self) {
        self.bar.inc(1);
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
