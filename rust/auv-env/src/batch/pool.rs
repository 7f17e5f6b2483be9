//! Threads that one batch owns.
//!
//! A process that forks takes a pool's memory along but not its threads: work given to it would wait for
//! ever. So a pool knows whose it is, and another process makes its own.

use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, TryRecvError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use auv_planners::Control;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Others' work is watched over at this interval.
const BETWEEN_QUESTIONS: Duration = Duration::from_millis(50);
/// A thread stays awake for so long when others are about to finish.
const AWAKE: Duration = Duration::from_micros(200);

/// A number of threads, the caller's among them; the others start when they are first needed.
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

    /// The other threads of this process; none if the caller's own is enough, or if the system gives no more.
    pub fn running(&mut self) -> Option<&ThreadPool> {
        if self.threads == 1 {
            return None;
        }
        let process = std::process::id();
        if self.running.as_ref().is_none_or(|(owner, _)| *owner != process) {
            self.leave();
            let name = |i| format!("auvgym-{i}");
            self.running = ThreadPoolBuilder::new()
                .num_threads(self.threads - 1)
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

/// Works through `items` on the pool's threads and on this one, which asks now and then whether to `stop` and tells
/// the others.
pub fn share<T: Send>(
    others: &ThreadPool,
    items: impl Iterator<Item = T> + Send,
    stop: &mut dyn FnMut() -> bool,
    work: impl Fn(T, &Control<'_>) + Sync,
) {
    let (stopped, queue) = (AtomicBool::new(false), Mutex::new(items));
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let (working, finished) = channel::<()>();
    others.in_place_scope(|scope| {
        for _ in 0..others.current_num_threads() {
            let (working, next, work, stopped) = (working.clone(), &next, &work, &stopped);
            scope.spawn(move |_| {
                while let Some(item) = next() {
                    work(item, &Control::flag(stopped));
                }
                drop(working);
            });
        }
        drop(working);
        let stop = RefCell::new(stop);
        let ask = || {
            let now = (stop.borrow_mut())();
            stopped.fetch_or(now, Ordering::Relaxed);
            now
        };
        while let Some(item) = next() {
            work(item, &Control::ask(&ask));
            ask();
        }
        // The others are at their last items: mostly sooner done than this thread would be awake again.
        let begun = Instant::now();
        while begun.elapsed() < AWAKE && finished.try_recv() == Err(TryRecvError::Empty) {
            std::hint::spin_loop();
        }
        while finished.recv_timeout(BETWEEN_QUESTIONS) == Err(RecvTimeoutError::Timeout) {
            ask();
        }
    });
}

impl Drop for Pool {
    fn drop(&mut self) {
        self.leave();
    }
}
