//! Threads for the work that all cores share, or none where the system has none left (`ulimit -u`, `ulimit -v`).

use std::sync::mpsc::channel;
use std::thread::{Builder, JoinHandle, available_parallelism};

use rayon::ThreadPoolBuilder;

/// Tries whether there are as many threads as cores; where not, the first thread does all the work. To be called before
/// any is shared out: a pool that cannot be made then ends the process.
pub fn prepare() {
    let wanted = available_parallelism().map_or(1, usize::from);
    let (open, closed) = channel::<()>();
    let closed = std::sync::Arc::new(std::sync::Mutex::new(closed));
    // They all wait for the same end: so many must live at once.
    let wait = |_| {
        let closed = closed.clone();
        Builder::new().spawn(move || drop(closed.lock().map(|closed| closed.recv())))
    };
    let threads: Vec<JoinHandle<()>> = (0..wanted).map_while(|i| wait(i).ok()).collect();
    let enough = threads.len() == wanted;
    drop(open);
    threads.into_iter().for_each(|thread| drop(thread.join()));
    // At once, before others take their places. One that is there already shares out work as it likes.
    let _ = match enough {
        true => ThreadPoolBuilder::new().build_global(),
        false => ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global(),
    };
}
