//! The command line: flags in, exit code out.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match hachure::cli::Arguments::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
