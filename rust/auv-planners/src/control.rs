//! How a caller stops a planner that is at work.

use std::sync::atomic::{AtomicBool, Ordering};

/// Asked every few hundred microseconds to few milliseconds whether the planner shall stop and give its
/// best so far. An interruption never changes what was computed before it.
#[derive(Clone, Copy, Default)]
pub struct Control<'a> {
    source: Source<'a>,
}

#[derive(Clone, Copy, Default)]
enum Source<'a> {
    #[default]
    Never,
    Flag(&'a AtomicBool),
    Ask(&'a (dyn Fn() -> bool + 'a)),
}

impl<'a> Control<'a> {
    /// Never stops.
    pub fn none() -> Self {
        Self::default()
    }

    /// Stops when the flag is set.
    pub fn flag(flag: &'a AtomicBool) -> Self {
        Self { source: Source::Flag(flag) }
    }

    /// Stops when the closure says `true`.
    pub fn ask(question: &'a (dyn Fn() -> bool + 'a)) -> Self {
        Self { source: Source::Ask(question) }
    }

    /// Whether to stop now.
    pub fn interrupted(&self) -> bool {
        match self.source {
            Source::Never => false,
            Source::Flag(flag) => flag.load(Ordering::Relaxed),
            Source::Ask(question) => question(),
        }
    }
}
