//! The command line: flags in, exit code out.

use std::process::ExitCode;

use clap::Parser;
use hachure::door::cli::{Arguments, memory, threads, words};
use hachure::door::files::signals;

/// Says in a line that memory has ended.
#[global_allocator]
static ALLOCATOR: memory::Allocator = memory::Allocator;

fn main() -> ExitCode {
    memory::prepare();
    threads::prepare();
    let arguments = Arguments::parse();
    let talk = arguments.talk();
    if let Err(error) = signals::end_when_asked(words::TRY_AGAIN.into()) {
        talk.warn(&format!("a signal may leave temporary files behind ({error})"));
    }
    arguments.run_to_end(&talk)
}
