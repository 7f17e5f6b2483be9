//! Ctrl-C in the middle of long work that runs without the GIL.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use auv_planners::Control;
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

/// Works without the GIL; Ctrl-C stops it within a fraction of a second.
pub fn run<T: Send, E: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Control<'_>) -> Result<T, E> + Send,
    error: impl FnOnce(E) -> PyErr,
) -> PyResult<T> {
    let (result, signals) = py.detach(|| {
        let signals = RefCell::new(Signals::new());
        let ask = || signals.borrow_mut().stop();
        let result = work(&Control::ask(&ask));
        (result, signals.into_inner())
    });
    signals.finish()?;
    result.map_err(error)
}
