//! The passes compiled on a device: each once, whoever asks, however often.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::device::Gpu;
use super::pass::{Pass, Reflection, reflect, select};
use crate::error::Result;

/// What a pass is compiled of: its name, its source, and the bits of the constants on which it depends.
type Key = (Shader, Vec<(String, u64)>);
/// The entry point and its composed source.
pub(super) type Shader = (&'static str, Cow<'static, str>);
/// A pass, once it is there. Who compiles it holds the lock, so that others wait for it.
type Slot = Arc<Mutex<Option<Arc<Pass>>>>;

/// Compiled passes.
#[derive(Default)]
pub(super) struct Compiled {
    shaders: Mutex<HashMap<Shader, Arc<Reflection>>>,
    passes: Mutex<HashMap<Key, Slot>>,
    count: AtomicUsize,
}

impl Compiled {
    /// The pass of this shader and these constants, compiled if nobody has asked for it yet.
    pub(super) fn pass(
        &self,
        gpu: &Gpu,
        name: &'static str,
        source: Cow<'static, str>,
        constants: &[(&str, f64)],
    ) -> Result<Arc<Pass>> {
        let shader = (name, source);
        let reflection = self.reflection(&shader)?;
        let constants = select(name, &reflection.overrides, constants)?;
        let bits = constants.iter().map(|(name, value)| ((*name).to_owned(), value.to_bits())).collect();
        let slot = lock(&self.passes).entry((shader.clone(), bits)).or_default().clone();
        let mut slot = lock(&slot);
        if let Some(pass) = &*slot {
            return Ok(pass.clone());
        }
        self.count.fetch_add(1, Ordering::Relaxed);
        let pass = Arc::new(Pass::compile(gpu, shader, &reflection, &constants)?);
        *slot = Some(pass.clone());
        Ok(pass)
    }

    /// How many passes were compiled so far.
    pub(super) fn count(&self) -> usize {
        self.count.load(Ordering::Relaxed)
    }

    /// Drops all passes, and what is known of their shaders.
    pub(super) fn forget(&self) {
        lock(&self.shaders).clear();
        lock(&self.passes).clear();
    }

    /// What a shader says, read once.
    fn reflection(&self, shader: &Shader) -> Result<Arc<Reflection>> {
        if let Some(reflection) = lock(&self.shaders).get(shader) {
            return Ok(reflection.clone());
        }
        let reflection = Arc::new(reflect(shader.0, &shader.1)?);
        lock(&self.shaders).insert(shader.clone(), reflection.clone());
        Ok(reflection)
    }
}

/// What a mutex guards. No holder leaves it half done.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
