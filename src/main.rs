//! The command line: flags in, exit code out.

use std::process::ExitCode;

use clap::Parser;

/// Exit code for "try again": here, ended by a signal.
const TRY_AGAIN: i32 = 75;

fn main() -> ExitCode {
    let handled = ctrlc::set_handler(|| {
        hachure::ink::discard_all();
        std::process::exit(TRY_AGAIN);
    });
    if let Err(error) = handled {
        eprintln!("warning: a signal may leave temporary files behind ({error})");
    }
    match hachure::cli::Arguments::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
