//! The files `hachure draw` writes: opened before the work starts, named when all are whole.

use std::io::{IsTerminal, stdout};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::{Error, Result, Setting, shown};
use crate::files::{Output, Taken};
use crate::ink;
use crate::render::Page;

/// Flags that name files; `-` is standard output, for one of them.
#[derive(Debug, clap::Args)]
pub struct OutputArguments {
    /// The drawing, a .png, or - for standard output
    #[arg(short, long, value_name = "OUT.png|-")]
    output: PathBuf,
    /// Also the mask: 1 bit a pixel, 0 ink, 255 paper, exactly --size
    #[arg(long, value_name = "OUT.png|-")]
    mask: Option<PathBuf>,
    /// Also what was done, with times of ten further frames (two of a page in pieces)
    #[arg(long, value_name = "OUT.json|-")]
    json: Option<PathBuf>,
}

/// The files to write.
pub struct Outputs {
    drawing: Output,
    mask: Option<Output>,
    json: Option<Output>,
}

impl OutputArguments {
    /// The drawing as the user named it.
    pub fn drawing(&self) -> &Path {
        &self.output
    }

    /// Whether one of the files is standard output.
    pub fn fill_stdout(&self) -> bool {
        [Some(&self.output), self.mask.as_ref(), self.json.as_ref()].into_iter().flatten().any(|path| is_stdout(path))
    }

    /// Checks what can be known of the names alone.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name that cannot be meant.
    pub fn check(&self) -> Result<()> {
        wants_png(Setting::Output, &self.output)?;
        self.mask.as_ref().map_or(Ok(()), |mask| wants_png(Setting::Mask, mask))
    }

    /// Opens them all. None may be one of the files `taken`, or another output.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name that is taken, [`Error::Output`] where a file cannot be written.
    pub fn open(&self, mut taken: Taken) -> Result<Outputs> {
        let named = [
            (Setting::Output, Some(&self.output)),
            (Setting::Mask, self.mask.as_ref()),
            (Setting::Json, self.json.as_ref()),
        ];
        let mut has_stdout = false;
        // All names are compared before any file is opened.
        for (setting, path) in named.into_iter().filter_map(|(setting, path)| Some((setting, path?))) {
            match is_stdout(path) {
                true if has_stdout => {
                    let what = "standard output is another output already";
                    return Err(Error::setting(setting, what, "give each file a name of its own"));
                }
                true => {
                    has_stdout = true;
                    taken.take_stdout(setting)?;
                }
                false => taken.take(setting, path)?,
            }
        }
        let open = |path: &Path| if is_stdout(path) { Ok(Output::stdout()) } else { Output::create(path) };
        Ok(Outputs {
            drawing: open(&self.output)?,
            mask: self.mask.as_deref().map(open).transpose()?,
            json: self.json.as_deref().map(open).transpose()?,
        })
    }
}

impl Outputs {
    /// Whether the report is asked for.
    pub fn want_report(&self) -> bool {
        self.json.is_some()
    }

    /// Writes the drawing and, where asked, the mask and the report. None has its name yet.
    ///
    /// # Errors
    /// [`Error::Output`] where one cannot be written.
    pub fn write(
        &mut self,
        drawing: &ink::Drawing,
        px_per_mm: f64,
        page: &Page,
        report: Option<&impl Serialize>,
    ) -> Result<()> {
        self.drawing.write(|out| ink::write_png(drawing, px_per_mm, out))?;
        if let Some(mask) = &mut self.mask {
            let marks = &page.marks;
            mask.write(|out| ink::write_mask([marks.width, marks.height], marks.places(), out))?;
        }
        if let (Some(json), Some(report)) = (&mut self.json, report) {
            json.write(|out| {
                serde_json::to_writer_pretty(&mut *out, report)?;
                writeln!(out)
            })?;
        }
        Ok(())
    }

    /// Names them. Standard output comes first: where it takes no more, no file has its name yet.
    ///
    /// # Errors
    /// [`Error::Output`] where one cannot be named.
    pub fn publish(self) -> Result<()> {
        let mut outputs: Vec<_> = [Some(self.drawing), self.mask, self.json].into_iter().flatten().collect();
        outputs.sort_by_key(|output| output.target().is_some());
        outputs.into_iter().try_for_each(Output::publish)
    }
}

/// A file of this name is `./-`.
fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn wants_png(setting: Setting, path: &Path) -> Result<()> {
    if is_stdout(path) {
        let remedy = "send it on with `> picture.png` or `| program`, or name a .png";
        return if stdout().is_terminal() {
            Err(Error::setting(setting, "standard output is a terminal", remedy))
        } else {
            Ok(())
        };
    }
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")) {
        return Ok(());
    }
    Err(Error::setting(setting, format!("{} does not end in .png", shown(path)), "name it .png"))
}
