//! The command line: flags in, exit code out.

use std::process::ExitCode;

use clap::Parser;
use hachure::cli::{Arguments, memory, threads, words};

/// Says in a line that memory has ended.
#[global_allocator]
static ALLOCATOR: memory::Allocator = memory::Allocator;

fn main() -> ExitCode {
    memory::prepare();
    threads::prepare();
    let arguments = Arguments::parse();
    let talk = arguments.talk();
    let handled = ctrlc::set_handler(|| {
        hachure::files::discard_all();
        // SAFETY: it ends the process and touches nothing. Destructors of drivers would run while their threads draw.
        unsafe { libc::_exit(words::TRY_AGAIN.into()) }
    });
    if let Err(error) = handled {
        talk.warn(&format!("a signal may leave temporary files behind ({error})"));
    }
    match arguments.run(&talk) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            talk.error(&error);
            ExitCode::from(words::exit_code(&error))
        }
    }
}
