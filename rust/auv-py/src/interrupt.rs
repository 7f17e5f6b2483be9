//! Ctrl-C in the middle of long work that runs without the GIL.

use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// Asks Python for signals now and then.
pub struct Signals {
    last: Instant,
    error: Option<PyErr>,
}

impl Signals {
    pub fn new() -> Self {
        Self { last: Instant::now(), error: None }
    }

    /// Whether to stop. Time decides only how often Python is asked, never a result.
    pub fn stop(&mut self) -> bool {
        if self.error.is_none() && self.last.elapsed() > Duration::from_millis(50) {
            self.last = Instant::now();
            self.error = Python::attach(|py| py.check_signals()).err();
        }
        self.error.is_some()
    }

    /// The exception that stopped the work, if one did.
    pub fn finish(self) -> PyResult<()> {
        self.error.map_or(Ok(()), Err)
    }
}
