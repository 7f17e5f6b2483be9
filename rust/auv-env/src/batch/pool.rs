//! Threads that one batch owns.
//!
//! A process that forks takes a pool's memory along but not its threads: work given to it would wait for
//! ever. So a pool knows whose it is, and another process makes its own.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Work is watched over at this interval.
const BETWEEN_QUESTIONS: Duration = Duration::from_millis(50);

/// A number of threads, started when they are first needed.
#[derive(Debug)]
pub struct Pool {
    threads: usize,
    running: Option<(u32, ThreadPool)>,
}

impl Pool {
    /// A pool of so many threads, at least one; none runs yet.
    pub fn new(threads: usize) -> Self {
        Self { threads: threads.max(1), running: None }
    }

    /// How many threads it has.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// The threads of this process; none if the caller's own is enough, or if the system gives no more.
    pub fn running(&mut self) -> Option<&ThreadPool> {
        if self.threads == 1 {
            return None;
        }
        let process = std::process::id();
        if self.running.as_ref().is_none_or(|(owner, _)| *owner != process) {
            self.leave();
            let name = |i| format!("auvgym-{i}");
            self.running = ThreadPoolBuilder::new()
                .num_threads(self.threads)
                .thread_name(name)
                .build()
                .ok()
                .map(|pool| (process, pool));
        }
        self.running.as_ref().map(|(_, pool)| pool)
    }

    /// Parts with the pool. Another process's is left alone: it has no threads here that could be told.
    fn leave(&mut self) {
        if let Some((owner, pool)) = self.running.take()
            && owner != std::process::id()
        {
            std::mem::forget(pool);
        }
    }
}

/// Work on the pool's threads, while this one asks now and then whether to `stop` and says so by the flag.
pub fn watched(threads: &ThreadPool, stopped: &AtomicBool, stop: &mut dyn FnMut() -> bool, work: impl FnOnce() + Send) {
    let (done, finished) = channel();
    threads.in_place_scope(|scope| {
        scope.spawn(move |_| {
            work();
            // Nobody waits any more after a panic, which the scope passes on.
            let _sent = done.send(());
        });
        while finished.recv_timeout(BETWEEN_QUESTIONS) == Err(RecvTimeoutError::Timeout) {
            if stop() {
                stopped.store(true, Ordering::Relaxed);
            }
        }
    });
}

impl Drop for Pool {
    fn drop(&mut self) {
        self.leave();
    }
}
