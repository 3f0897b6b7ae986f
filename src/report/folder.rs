//! The folder of a report: four files opened before the work starts, pictures beside them at its end.
//!
//! Files get their names when all are written, the page last: a folder with a page holds a whole report. A folder that
//! was made for a report that failed goes again.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::pictures::Picture;
use crate::error::{Error, Result, Setting};
use crate::files::{Output, Taken, output};

/// The page, the results as JSON and as CSV, the plot.
const FILES: [&str; 4] = ["report.html", "results.json", "results.csv", "error-time.svg"];

/// A folder for a report.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// Folders that were made for it, the outermost first.
    made: Vec<PathBuf>,
    files: Option<Files>,
}

#[derive(Debug)]
struct Files {
    page: Output,
    json: Output,
    csv: Output,
    plot: Output,
}

/// What goes into the four files.
#[derive(Debug)]
pub(crate) struct Contents {
    /// `report.html`.
    pub page: String,
    /// `results.json`.
    pub json: Vec<u8>,
    /// `results.csv`.
    pub csv: Vec<u8>,
    /// `error-time.svg`.
    pub plot: String,
}

impl Folder {
    /// Makes the folder where there is none, opens the files in it, and looks whether `pictures` can be written there. None
    /// of them may be a file that is `taken`.
    ///
    /// # Errors
    /// [`Error::Setting`] where one is taken;
    /// [`Error::Output`] where it is a file or something cannot be written.
    pub(crate) fn open(path: &Path, pictures: impl Iterator<Item = String>, mut taken: Taken) -> Result<Self> {
        let failed = |why: io::Error| Error::output(path, &why);
        if path.exists() && !path.is_dir() {
            return Err(failed(io::Error::other("it is a file, and a report is a folder")));
        }
        let pictures: Vec<String> = pictures.collect();
        let mut names = FILES.into_iter().chain(pictures.iter().map(String::as_str));
        names.try_for_each(|name| taken.take(Setting::Output, &path.join(name)))?;
        let missing = path.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let mut missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        missing.reverse();
        let mut folder = Self { path: path.to_owned(), made: Vec::new(), files: None };
        for missing in missing {
            output::make_folder(&missing).map_err(failed)?;
            // From here on a failure takes it along.
            folder.made.push(missing);
        }
        let open = |name: &str| Output::create(&path.join(name));
        folder.files =
            Some(Files { page: open(FILES[0])?, json: open(FILES[1])?, csv: open(FILES[2])?, plot: open(FILES[3])? });
        pictures.iter().try_for_each(|name| open(name).map(drop))?;
        Ok(folder)
    }

    /// Where the page will be.
    pub(crate) fn page(&self) -> PathBuf {
        self.path.join(FILES[0])
    }

    /// Writes everything, then gives it its names.
    ///
    /// # Errors
    /// [`Error::Output`] where something cannot be written.
    pub(crate) fn publish(mut self, contents: &Contents, pictures: &[Picture]) -> Result<()> {
        let Some(mut files) = self.files.take() else { return Ok(()) };
        files.page.write(|file| file.write_all(contents.page.as_bytes()))?;
        files.json.write(|file| file.write_all(&contents.json))?;
        files.csv.write(|file| file.write_all(&contents.csv))?;
        files.plot.write(|file| file.write_all(contents.plot.as_bytes()))?;
        let mut outputs = Vec::new();
        for picture in pictures {
            let mut output = Output::create(&self.path.join(&picture.name))?;
            output.write(|file| file.write_all(&picture.png))?;
            output.close();
            outputs.push(output);
        }
        outputs.extend([files.plot, files.csv, files.json, files.page]);
        outputs.into_iter().try_for_each(Output::publish)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        self.files = None;
        for made in self.made.iter().rev() {
            output::forget(made);
            // Refused where something is in it: it stays then.
            let _ = fs::remove_dir(made);
        }
    }
}
