//! One process makes an artefact, others wait.
//!
//! Method: whoever makes it holds a file of its name that ends in `.lock`, and writes to it every second how far it has come.
//! One that has not been written for [`AGE`] belonged to a process that is gone, and is taken over. It goes when the work
//! is done or fails, and with a signal. Cost: a thread that sleeps. Not handled: a process that is stopped for longer and goes
//! on: two make the same then, and each publishes it whole.

use std::fs::{self, File};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant, SystemTime};

use crate::error::shown;
use crate::files::output;

/// Nobody works on what has not been written for so long.
pub(super) const AGE: Duration = Duration::from_secs(10);
/// How often the maker writes.
const BEAT: Duration = Duration::from_secs(1);
/// How often a waiter looks.
const LOOK: Duration = Duration::from_millis(100);
/// What the name of a lock ends in.
pub(super) const ENDING: &str = ".lock";

/// The right to make an artefact.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    /// Thousandths of the work that are done.
    done: Arc<AtomicU32>,
    stop: Option<Sender<()>>,
    beats: Option<JoinHandle<()>>,
}

/// Why there is no lock to be had.
#[derive(Debug)]
pub(super) enum Refused {
    /// Another has it.
    Held(Held),
    /// The folder cannot be written, or something else stands there.
    Impossible(io::Error),
}

/// A lock that another has.
#[derive(Debug)]
pub(super) struct Held {
    path: PathBuf,
    modified: Option<SystemTime>,
}

impl Lock {
    /// The lock of the artefact at `path`, taken over where its holder is gone.
    pub(super) fn take(artefact: &Path) -> Result<Self, Refused> {
        let mut name = artefact.as_os_str().to_owned();
        name.push(ENDING);
        let path = PathBuf::from(name);
        // A folder that cannot be made shows when the lock is.
        let _ = path.parent().map(fs::create_dir_all);
        match output::make_file(&path) {
            Ok(file) => Ok(Self::beating(path, file)),
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => Err(Refused::Impossible(error)),
            Err(_) => match fs::symlink_metadata(&path) {
                Ok(found) if found.is_file() && is_old(found.modified().ok()) => {
                    fs::remove_file(&path).map_err(Refused::Impossible)?;
                    output::make_file(&path).map(|file| Self::beating(path.clone(), file)).map_err(|_| held(path))
                }
                Ok(found) if found.is_file() => Err(Refused::Held(Held { modified: found.modified().ok(), path })),
                Ok(_) => Err(Refused::Impossible(io::Error::other(format!("{} is no file; remove it", shown(&path))))),
                // Gone since.
                Err(_) => Err(held(path)),
            },
        }
    }

    /// Says how far the work has come.
    pub(super) fn tell(&self, share: f64) {
        self.done.store((share * 1000.0) as u32, Ordering::Relaxed);
    }

    fn beating(path: PathBuf, mut file: File) -> Self {
        let done = Arc::new(AtomicU32::new(0));
        let (stop, stopped) = channel();
        let told = done.clone();
        let beats = thread::spawn(move || {
            loop {
                // A disk that is full leaves the lock to age: another may try.
                let _ = file.rewind().and_then(|()| write!(file, "{:4}", told.load(Ordering::Relaxed)));
                let _ = file.set_modified(SystemTime::now());
                if stopped.recv_timeout(BEAT) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
            }
        });
        Self { path, done, stop: Some(stop), beats: Some(beats) }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        self.stop = None;
        let _ = self.beats.take().map(JoinHandle::join);
        // One that was taken over may go too: then two make the same.
        let _ = fs::remove_file(&self.path);
        output::forget(&self.path);
    }
}

impl Held {
    /// Waits until the lock is gone or old; `progress` hears how far its holder has come. Fails where nobody writes to it
    /// and it cannot be removed.
    pub(super) fn wait(mut self, progress: &dyn Fn(f64)) -> io::Result<()> {
        let mut since = Instant::now();
        while let Ok(found) = fs::symlink_metadata(&self.path) {
            let modified = found.modified().ok();
            if modified != self.modified {
                (self.modified, since) = (modified, Instant::now());
            }
            if !found.is_file() || is_old(modified) {
                return Ok(());
            }
            if since.elapsed() > AGE {
                // By the clock of the file it is young, and yet nobody writes to it: clocks differ.
                return match fs::remove_file(&self.path) {
                    Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
                    _ => Ok(()),
                };
            }
            if let Some(share) = fs::read_to_string(&self.path).ok().and_then(|text| text.trim().parse::<u32>().ok()) {
                progress(f64::from(share.min(999)) / 1000.0);
            }
            thread::sleep(LOOK);
        }
        Ok(())
    }
}

fn held(path: PathBuf) -> Refused {
    Refused::Held(Held { path, modified: None })
}

/// Whether a lock last written then belongs to nobody.
fn is_old(modified: Option<SystemTime>) -> bool {
    modified.and_then(|modified| modified.elapsed().ok()).is_some_and(|age| age > AGE)
}
