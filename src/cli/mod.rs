//! The command line, one file a subcommand: flags as typed become options checked.

pub mod draw;
pub mod info;
pub mod terrain;
pub mod values;
pub mod viewpoint;

use std::io::{ErrorKind, Write, stdout};
use std::path::Path;

use clap::{Parser, Subcommand};

use crate::error::{Error, Result};

/// Pen-and-ink landscapes from digital elevation models.
#[derive(Debug, Parser)]
#[command(name = "hachure", version, about, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw a DEM as seen from an eye
    Draw(Box<draw::DrawArguments>),
    /// Say what a DEM holds
    Info(info::InfoArguments),
}

impl Arguments {
    /// Does what was asked.
    ///
    /// # Errors
    /// Whatever went wrong, with the exit code it stands for.
    pub fn run(self) -> Result<()> {
        match self.command {
            Command::Draw(arguments) => draw::run(&arguments),
            Command::Info(arguments) => info::run(&arguments),
        }
    }
}

/// Prints to standard output. A reader that has gone away is no error.
fn say(text: &str) -> Result<()> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Error::Output { path: Path::new("standard output").to_owned(), what: e.to_string() })
        }
        _ => Ok(()),
    }
}
