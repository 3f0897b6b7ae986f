//! Places for so many at work at once, for work that takes much memory.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// Tiles that each core works on before they are put together.
const TILES_A_CORE: usize = 2;

/// So many places.
#[derive(Debug)]
pub(super) struct Places {
    all: usize,
    free: Mutex<usize>,
    freed: Condvar,
}

/// One that is taken, until it is dropped. Whoever has it must wait for nobody who may wait for one.
pub(super) struct Permit<'a>(&'a Places);

impl Places {
    /// So many, one at least.
    pub(super) fn new(places: usize) -> Self {
        let all = places.max(1);
        Self { all, free: Mutex::new(all), freed: Condvar::new() }
    }

    /// One of them; waits until there is one.
    pub(super) fn take(&self) -> Permit<'_> {
        let none = |free: &mut usize| *free == 0;
        *self.freed.wait_while(self.free(), none).unwrap_or_else(PoisonError::into_inner) -= 1;
        Permit(self)
    }

    /// How much work is best given to all cores together: some for each, unless they lack places.
    pub(super) fn together(&self) -> usize {
        if self.are_short() { self.all } else { TILES_A_CORE * rayon::current_num_threads() }
    }

    /// Whether there are fewer than cores.
    pub(super) fn are_short(&self) -> bool {
        self.all < rayon::current_num_threads()
    }

    fn free(&self) -> MutexGuard<'_, usize> {
        self.free.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Permit<'_> {
    fn drop(&mut self) {
        *self.0.free() += 1;
        self.0.freed.notify_one();
    }
}
