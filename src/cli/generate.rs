//! `hachure generate`: completions and man pages, made from the flags, and large terrain, made of noise. For those who
//! package hachure or test it, so hidden.

use std::path::PathBuf;

use clap::{CommandFactory, Subcommand};
use clap_complete::{Generator, Shell};
use clap_mangen::Man;

use super::talk::Talk;
use super::{Arguments, values};
use crate::dem::fractal;
use crate::error::Result;
use crate::files::Output;
use crate::geo;

/// Flags of `hachure generate`.
#[derive(Debug, clap::Args)]
pub(crate) struct GenerateArguments {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Completions, to standard output
    Completions {
        /// The shell they are for
        shell: Shell,
    },
    /// Man pages, one a subcommand
    Man {
        /// A folder for one file a page [default: all pages to standard output]
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// A DEM of fractal relief, the same on every machine, cells of 30 m: a tiled GeoTIFF
    Dem {
        /// The file
        #[arg(short, long, value_name = "OUT.tif")]
        output: PathBuf,
        /// Samples across and down
        #[arg(long, value_name = "WxH", value_parser = values::samples, default_value = "20000x20000")]
        size: [usize; 2],
    },
}

/// Makes them.
///
/// # Errors
/// [`crate::error::Error::Output`] where they cannot be written.
pub(crate) fn run(arguments: &GenerateArguments, talk: &Talk) -> Result<()> {
    match &arguments.what {
        What::Completions { shell } => {
            let mut command = Arguments::command().bin_name("hachure");
            command.build();
            let mut out = Output::stdout();
            out.write(|bytes| shell.try_generate(&command, bytes))?;
            out.publish()
        }
        What::Man { output: None } => {
            let mut out = Output::stdout();
            pages().iter().try_for_each(|page| out.write(|bytes| page.render(bytes)))?;
            out.publish()
        }
        What::Man { output: Some(folder) } => pages().iter().try_for_each(|page| {
            let mut out = Output::create(&folder.join(page.get_filename()))?;
            out.write(|file| page.render(file))?;
            out.publish()
        }),
        What::Dem { output, size } => {
            geo::available()?;
            let mut out = Output::create(output)?;
            let progress = |share| talk.progress("writing", share);
            let row = |r| fractal::row(size[0], r);
            out.write_by_name(|path| geo::write(path, *size, fractal::CELL, row, &progress))?;
            out.publish()
        }
    }
}

/// The page of the command, then those of its subcommands.
fn pages() -> Vec<Man> {
    let mut command = Arguments::command().disable_help_subcommand(true);
    command.build();
    let subcommands = command.get_subcommands().filter(|c| !c.is_hide_set()).cloned();
    let page = |c| Man::new(c).source(concat!("hachure ", env!("CARGO_PKG_VERSION")));
    std::iter::once(command.clone()).chain(subcommands).map(page).collect()
}
