//! Flags that name the numbered files of a sequence, and the writing of these.

use std::path::PathBuf;

use super::outputs::Format;
use super::work;
use crate::error::{Error, Result, Setting, shown};
use crate::files::{Output, Taken};
use crate::ink::{self, Seal};
use crate::job::{Job, JobFile, Pattern};
use crate::message;
use crate::render::{Illustration, Page};

use super::drawing::Wanted;

/// The flags, as typed.
#[derive(Debug, clap::Args)]
pub(crate) struct FrameArguments {
    /// The drawings: .png, .svg or .pdf with the number of the frame in the name, each as often as wanted
    #[arg(short, long, value_name = "DIR/%05d.png")]
    output: Vec<String>,
    /// Also the masks, or they alone: 1 bit a pixel, 0 ink, 255 paper, as large as the frame (--size)
    #[arg(long, value_name = "DIR/%05d.png", required_unless_present_any = ["output", "preview"])]
    mask: Option<String>,
}

/// Where the files of frames stand.
pub(crate) struct FrameFiles {
    drawings: Vec<(Format, Pattern)>,
    mask: Option<Pattern>,
}

impl FrameArguments {
    /// Where the files stand, if all names can be meant.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn files(&self) -> Result<FrameFiles> {
        let pattern = |setting: Setting, text: &String| {
            let named = |what: String| Error::setting(setting, format!("{text}: {what}"), "name each frame's file so");
            Pattern::parse(text).map_err(named)
        };
        let drawing = |text: &String| {
            let pattern = pattern(Setting::Output, text)?;
            let wrong = || {
                let what = format!("{text} does not end in .png, .svg or .pdf");
                Error::setting(Setting::Output, what, "name it so")
            };
            Ok((Format::of(&pattern.path(0)).ok_or_else(wrong)?, pattern))
        };
        let mask = self.mask.as_ref().map(|text| pattern(Setting::Mask, text)).transpose()?;
        if let Some(mask) = mask.as_ref().filter(|mask| Format::of(&mask.path(0)) != Some(Format::Png)) {
            let what = format!("{} does not end in .png", shown(&mask.path(0)));
            return Err(Error::setting(Setting::Mask, what, "name it .png"));
        }
        let files = FrameFiles { drawings: self.output.iter().map(drawing).collect::<Result<_>>()?, mask };
        files.each_once()?;
        Ok(files)
    }
}

impl FrameFiles {
    /// What is asked for of each view.
    pub(crate) fn wanted(&self) -> Wanted {
        if self.drawings.is_empty() { Wanted::Mask } else { Wanted::Drawing }
    }

    /// Whether some of the files are pictures of the drawing.
    pub(crate) fn want_picture(&self) -> bool {
        self.drawings.iter().any(|(format, _)| *format == Format::Png)
    }

    /// The pictures of the drawing, which a motion picture is made of.
    pub(crate) fn pictures(&self) -> Option<&Pattern> {
        self.drawings.iter().find(|(format, _)| *format == Format::Png).map(|(_, pattern)| pattern)
    }

    /// Where the manifest stands: beside the first files.
    pub(crate) fn folder(&self) -> PathBuf {
        self.patterns().next().map(Pattern::folder).unwrap_or_default()
    }

    /// The job of a frame whose drawing and whose mask are made of what have these names.
    pub(crate) fn job(&self, number: u32, [drawing, mask]: [u128; 2]) -> Job {
        let drawings = self.drawings.iter().map(|(_, pattern)| JobFile { path: pattern.path(number), name: drawing });
        let mask = self.mask.iter().map(|pattern| JobFile { path: pattern.path(number), name: mask });
        Job { number, called: format!("frame {number}"), files: drawings.chain(mask).collect() }
    }

    /// Writes those files of a frame that are not there; none has its name before all are whole.
    ///
    /// # Errors
    /// [`Error::Output`]; as [`Illustration::drawing`].
    pub(crate) fn write(&self, job: &Job, page: &Page, illustration: &Illustration, adapter: &str) -> Result<()> {
        let seal = |made: &JobFile| Seal { job: made.name, adapter: adapter.to_owned() };
        let formats = self.drawings.iter().map(|(format, _)| Some(*format)).chain([None]);
        // Another process may have made them meanwhile.
        let missing: Vec<(Option<Format>, &JobFile)> =
            formats.zip(&job.files).filter(|(_, made)| !made.is_there()).collect();
        let mut outputs = missing.iter().map(|(_, made)| work::create(&made.path)).collect::<Result<Vec<_>>>()?;
        let of_drawing = missing.iter().find(|(format, _)| format.is_some());
        let drawing = of_drawing.map(|(_, made)| {
            let (_, mut drawing) = illustration.drawing(page)?;
            drawing.seal = Some(seal(made));
            Ok(drawing)
        });
        let drawing = drawing.transpose()?;
        for ((format, made), output) in missing.iter().zip(&mut outputs) {
            match (format, &drawing) {
                (Some(format), Some(drawing)) => {
                    output.write(|out| format.write(drawing, illustration.px_per_mm, out))?;
                }
                _ => {
                    let (marks, seal) = (&page.marks, seal(made));
                    let size = [marks.width, marks.height];
                    output.write(|out| ink::write_mask(size, marks.places(), Some(&seal), out))?;
                }
            }
        }
        outputs.into_iter().try_for_each(Output::publish)
    }

    /// Refuses frames that would replace a file that is read.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn spare(&self, mut inputs: Taken, jobs: &[Job]) -> Result<()> {
        jobs.iter().flat_map(|job| &job.files).try_for_each(|made| inputs.take(Setting::Output, &made.path))
    }

    fn patterns(&self) -> impl Iterator<Item = &Pattern> {
        self.drawings.iter().map(|(_, pattern)| pattern).chain(&self.mask)
    }

    fn each_once(&self) -> Result<()> {
        let patterns: Vec<&Pattern> = self.patterns().collect();
        let twice = (1..patterns.len()).find(|i| patterns[..*i].iter().any(|other| other.meets(patterns[*i])));
        twice.map_or(Ok(()), |i| {
            let what = format!("{} is another output already", shown(&patterns[i].path(0)));
            Err(Error::setting(Setting::Output, what, message!["give each a name of its own"]))
        })
    }
}
