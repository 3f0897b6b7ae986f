//! The command line: flags in, exit code out.

use std::process::ExitCode;

use clap::Parser;
use hachure::cli::{Arguments, TRY_AGAIN, memory, threads};
use hachure::files::signals;

/// Says in a line that memory has ended.
#[global_allocator]
static ALLOCATOR: memory::Allocator = memory::Allocator;

fn main() -> ExitCode {
    memory::prepare();
    threads::prepare();
    let arguments = Arguments::parse();
    let talk = arguments.talk();
    if let Err(error) = signals::end_when_asked(TRY_AGAIN) {
        talk.warn(&format!("a signal may leave temporary files behind ({error})"));
    }
    match arguments.run(&talk) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            talk.error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
