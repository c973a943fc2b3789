//! Processor time of this process, to the nanosecond: what other work on the machine hardly changes.

use std::{
    collections::HashMap,
    fs,
    path::{Path, PathBuf},
};

/// Time that each thread has run so far. Linux only; nothing elsewhere.
pub struct ProcessorTime {
    nanoseconds: HashMap<PathBuf, u64>,
}

impl ProcessorTime {
    pub fn now() -> Self {
        let threads = fs::read_dir("/proc/self/task").into_iter().flatten();
        let of_thread = |path: PathBuf| Some((path.clone(), nanoseconds(&path)?));
        Self {
            nanoseconds: threads
                .filter_map(|thread| of_thread(thread.ok()?.path()))
                .collect(),
        }
    }

    /// Milliseconds since then, of all threads that live still; `None` where the system does not tell.
    pub fn elapsed_ms(&self) -> Option<f64> {
        let now = Self::now();
        let spent = now.nanoseconds.iter().map(|(thread, now)| {
            let before = self.nanoseconds.get(thread).copied().unwrap_or(0);
            now.saturating_sub(before) as f64
        });
        (!now.nanoseconds.is_empty()).then(|| spent.sum::<f64>() / 1e6)
    }
}

/// The first of three numbers in `schedstat`.
fn nanoseconds(thread: &Path) -> Option<u64> {
    let text = fs::read_to_string(thread.join("schedstat")).ok()?;
    text.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sleeping takes none of it, and what runs in another thread counts.
    #[test]
    #[cfg(target_os = "linux")]
    fn only_running_counts() {
        let start = ProcessorTime::now();
        std::thread::sleep(std::time::Duration::from_millis(200));
        let slept_ms = start.elapsed_ms().unwrap();
        assert!(slept_ms < 150.0, "{slept_ms}");
        let (done, wait) = std::sync::mpsc::channel();
        let (end, ended) = std::sync::mpsc::channel::<()>();
        let worker = std::thread::spawn(move || {
            let own = ProcessorTime::now();
            let mut sum = 0_u64;
            while own.elapsed_ms().unwrap() < 50.0 {
                sum = std::hint::black_box(sum + 1);
            }
            done.send(()).unwrap();
            ended.recv().unwrap();
        });
        wait.recv().unwrap();
        let busy_ms = start.elapsed_ms().unwrap();
        end.send(()).unwrap();
        worker.join().unwrap();
        assert!(busy_ms >= 40.0, "{busy_ms}");
    }
}
