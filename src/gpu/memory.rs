//! How much memory the system lets this process take, for drivers that say little where it ends.

use crate::error::{Error, Setting};
use crate::message;

/// Addresses that a software driver takes before it draws anything, bytes: with less, none of its adapters opens.
const DRIVER: u64 = 384 << 20;
/// Bytes of a page of memory, in which Linux counts.
const PAGE: u64 = 4096;

/// Bytes of addresses and of data that the process may take, where it lives under such limits.
fn limits() -> [Option<u64>; 2] {
    #[cfg(unix)]
    return [libc::RLIMIT_AS, libc::RLIMIT_DATA].map(|resource| {
        let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
        // SAFETY: it writes the two numbers of a limit that exists.
        let told = unsafe { libc::getrlimit(resource, &mut limit) } == 0;
        (told && limit.rlim_cur != libc::RLIM_INFINITY).then_some(limit.rlim_cur)
    });
    #[cfg(not(unix))]
    [None; 2]
}

/// The least of these limits, bytes.
pub(crate) fn limit() -> Option<u64> {
    limits().into_iter().flatten().min()
}

/// Bytes of the limits that are left; `None` without a limit, or where the system does not tell (not Linux).
fn left() -> Option<u64> {
    limit()?;
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: Vec<u64> = text.split_whitespace().filter_map(|pages| pages.parse().ok()).collect();
    let taken = [pages.first()?, pages.get(5)?].map(|pages| pages * PAGE);
    limits().into_iter().zip(taken).filter_map(|(limit, taken)| Some(limit?.saturating_sub(taken))).min()
}

/// The error of a driver that cannot start for lack of memory; `None` where there is enough.
pub(super) fn too_little() -> Option<Error> {
    let left = left().filter(|left| *left < DRIVER)?;
    let (left, needed) = (left >> 20, DRIVER >> 20);
    let what = format!("{left} MiB of memory are left, a GPU driver needs {needed} MiB to start");
    Some(Error::limit(what, unlimited()?))
}

/// The driver's failure in its `words`: for lack of memory, where it says so or little is left under a limit.
pub(super) fn failure(words: String) -> Error {
    let said = words.to_lowercase();
    if said.contains("not enough memory")
        || said.contains("out of memory")
        || left().is_some_and(|left| left < DRIVER / 4)
    {
        return short(format!("not enough memory for the GPU driver ({words})"));
    }
    Error::Gpu { what: words }
}

fn short(what: String) -> Error {
    let room = unlimited().map_or_else(String::new, |unlimited| format!(", or {unlimited}"));
    let remedy = message!["use a smaller ", Setting::Size, ", a lower ", Setting::Level, " or a ", Setting::Crop, room];
    Error::limit(what, remedy)
}

/// How to get rid of the limit.
fn unlimited() -> Option<String> {
    let [addresses, data] = limits();
    let flag = if addresses.is_some() { "-v" } else { "-d" };
    let least = addresses.into_iter().chain(data).min()? >> 20;
    Some(format!("run it without the limit of {least} MiB (`ulimit {flag} unlimited`)"))
}
