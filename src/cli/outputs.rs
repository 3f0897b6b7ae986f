//! The files `hachure draw` writes: opened before the work starts, named when all are whole.

use std::io::{self, IsTerminal, Write, stdout};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::dem::Crs;
use crate::error::{Error, Result, Setting, shown};
use crate::files::{Output, Taken};
use crate::geo::{self, MapFormat, MapLine};
use crate::ink::{self, Seal};
use crate::render::Page;

/// Flags that name files; `-` is standard output, for one of them.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct OutputArguments {
    /// The drawing: a .png, .svg or .pdf, each as often as wanted; - is standard output, a PNG
    #[arg(short, long, value_name = "OUT.png|.svg|.pdf|-", required = true)]
    output: Vec<PathBuf>,
    /// Also the mask: 1 bit a pixel, 0 ink, 255 paper, as large as the frame (--size)
    #[arg(long, value_name = "OUT.png|-")]
    mask: Option<PathBuf>,
    /// Also the lines on the map, each visible run with kind, id, order, depth, length and heights of the land in metres: in the CRS of
    /// the DEM's file (.gpkg), or in degrees of WGS 84 (.geojson, .kml)
    #[arg(long, value_name = "OUT.gpkg|.geojson|.kml")]
    georeferenced: Option<PathBuf>,
    /// Also what was done, with times of ten further frames (two of a page in pieces)
    ///
    /// Facets, inked pixels, layers, parts of the mask that no stroke draws and why, times of passes, pieces, adapter, what was
    /// converted, assumed and left out; and the view with its projection and its system of coordinates, to lay labels and layers of a
    /// GIS over the picture.
    #[arg(long, value_name = "OUT.json|-")]
    json: Option<PathBuf>,
}

/// How a drawing is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    /// As a picture.
    Png,
    /// As vectors, a group a layer.
    Svg,
    /// As vectors, a layer a group of optional content.
    Pdf,
}

/// The files to write.
pub(crate) struct Outputs {
    drawings: Vec<(Format, Output)>,
    mask: Option<Output>,
    /// What made the mask, where it is to tell.
    of_mask: Option<Seal>,
    map: Option<(MapFormat, Output)>,
    json: Option<Output>,
}

impl OutputArguments {
    /// The drawing as the user named it, each of its files.
    pub(crate) fn drawing(&self) -> String {
        self.output.iter().map(|path| shown(path)).collect::<Vec<_>>().join(", ")
    }

    /// Whether one of the drawings is a picture.
    pub(crate) fn want_picture(&self) -> bool {
        self.output.iter().any(|path| Format::of(path) == Some(Format::Png))
    }

    /// The files of the drawing, and that of the mask.
    pub(crate) fn files(&self) -> (&[PathBuf], Option<&Path>) {
        (&self.output, self.mask.as_deref())
    }

    /// The same files under other names.
    ///
    /// # Errors
    /// Those of `renamed`.
    pub(crate) fn renamed(&self, renamed: impl Fn(&Path) -> Result<PathBuf>) -> Result<Self> {
        Ok(Self {
            output: self.output.iter().map(|path| renamed(path)).collect::<Result<_>>()?,
            mask: self.mask.as_deref().map(&renamed).transpose()?,
            georeferenced: self.georeferenced.clone(),
            json: self.json.clone(),
        })
    }

    /// Whether the mask is asked for.
    pub(crate) fn want_mask(&self) -> bool {
        self.mask.is_some()
    }

    /// Whether one of the files is standard output.
    pub(crate) fn fill_stdout(&self) -> bool {
        self.output.iter().chain(&self.mask).chain(&self.json).any(|path| is_stdout(path))
    }

    /// Checks what can be known of the names alone.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name that cannot be meant.
    pub(crate) fn check(&self) -> Result<()> {
        for path in &self.output {
            if Format::of(path).is_none() {
                let what = format!("{} does not end in .png, .svg or .pdf", shown(path));
                return Err(Error::setting(Setting::Output, what, "name it so"));
            }
        }
        if let Some(mask) = self.mask.as_ref().filter(|mask| Format::of(mask) != Some(Format::Png)) {
            return Err(Error::setting(Setting::Mask, format!("{} does not end in .png", shown(mask)), "name it .png"));
        }
        if let Some(map) = self.georeferenced.as_ref().filter(|map| MapFormat::of(map).is_none()) {
            let what = format!("{} does not end in .gpkg, .geojson or .kml", shown(map));
            return Err(Error::setting(Setting::Georeferenced, what, "name it so"));
        }
        let given = [(Setting::Output, &self.output[..]), (Setting::Mask, self.mask.as_slice())];
        let on_stdout = given.into_iter().find(|(_, paths)| paths.iter().any(|path| is_stdout(path)));
        match on_stdout.filter(|_| stdout().is_terminal()) {
            Some((setting, _)) => {
                let remedy = "send it on with `> picture.png` or `| program`, or name a .png";
                Err(Error::setting(setting, "standard output is a terminal", remedy))
            }
            None => Ok(()),
        }
    }

    /// Opens them all. None may be one of the files `taken`, or another output.
    ///
    /// # Errors
    /// [`Error::Setting`] for a name that is taken, [`Error::Output`] where a file cannot be written.
    pub(crate) fn open(&self, mut taken: Taken) -> Result<Outputs> {
        let drawings = self.output.iter().map(|path| (Setting::Output, path));
        let beside = [
            (Setting::Mask, self.mask.as_ref()),
            (Setting::Georeferenced, self.georeferenced.as_ref()),
            (Setting::Json, self.json.as_ref()),
        ];
        let named = drawings.chain(beside.into_iter().filter_map(|(setting, path)| Some((setting, path?))));
        let mut has_stdout = false;
        // All names are compared before any file is opened.
        for (setting, path) in named {
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
            drawings: self
                .output
                .iter()
                .map(|path| Ok((Format::of(path).unwrap_or(Format::Png), open(path)?)))
                .collect::<Result<_>>()?,
            mask: self.mask.as_deref().map(open).transpose()?,
            of_mask: None,
            map: self
                .georeferenced
                .as_deref()
                .and_then(|path| Some((MapFormat::of(path)?, path)))
                .map(|(format, path)| Ok((format, open(path)?)))
                .transpose()?,
            json: self.json.as_deref().map(open).transpose()?,
        })
    }
}

impl Outputs {
    /// The same, the mask of which tells what made it.
    pub(crate) fn with_mask_of(self, seal: Seal) -> Self {
        Self { of_mask: Some(seal), ..self }
    }

    /// Whether the report is asked for.
    pub(crate) fn want_report(&self) -> bool {
        self.json.is_some()
    }

    /// In which format the lines on the map are asked for, if they are.
    pub(crate) fn map_format(&self) -> Option<MapFormat> {
        self.map.as_ref().map(|(format, _)| *format)
    }

    /// Writes the lines on the map, given in a system of coordinates. They have no name yet.
    ///
    /// # Errors
    /// [`Error::Output`] where they cannot be written.
    pub(crate) fn write_map(&mut self, crs: &Crs, lines: &[MapLine]) -> Result<()> {
        self.map
            .as_mut()
            .map_or(Ok(()), |(format, file)| file.write(|out| out.write_all(&geo::write_lines(*format, crs, lines)?)))
    }

    /// Writes the drawing, pictures with so many pixels for each millimetre, and, where asked, the mask of a page and the
    /// report. None has its name yet.
    ///
    /// # Errors
    /// [`Error::Output`] where one cannot be written.
    pub(crate) fn write(
        &mut self,
        drawing: &ink::Drawing,
        px_per_mm: f64,
        page: Option<&Page>,
        report: Option<&impl Serialize>,
    ) -> Result<()> {
        for (format, file) in &mut self.drawings {
            file.write(|out| format.write(drawing, px_per_mm, out))?;
        }
        if let (Some(mask), Some(page)) = (&mut self.mask, page) {
            let marks = &page.marks;
            let seal = self.of_mask.as_ref();
            mask.write(|out| ink::write_mask([marks.width, marks.height], marks.places(), seal, out))?;
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
    pub(crate) fn publish(self) -> Result<()> {
        let drawings = self.drawings.into_iter().map(|(_, file)| file);
        let map = self.map.into_iter().map(|(_, file)| file);
        let mut outputs: Vec<_> = drawings.chain(self.mask).chain(map).chain(self.json).collect();
        outputs.sort_by_key(|output| output.target().is_some());
        outputs.into_iter().try_for_each(Output::publish)
    }
}

/// A file of this name is `./-`.
fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

impl Format {
    /// Writes a drawing, pictures with so many pixels for each millimetre.
    ///
    /// # Errors
    /// Those of the writer.
    pub(crate) fn write(self, drawing: &ink::Drawing, px_per_mm: f64, out: impl Write) -> io::Result<()> {
        match self {
            Self::Png => ink::write_png(drawing, px_per_mm, out),
            Self::Svg => ink::write_svg(drawing, out),
            Self::Pdf => ink::write_pdf(drawing, out),
        }
    }

    /// The format that a name asks for.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let ends_in = |extension: &str| path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension));
        let known = [("png", Self::Png), ("svg", Self::Svg), ("pdf", Self::Pdf)];
        let named = known.into_iter().find(|(extension, _)| ends_in(extension)).map(|(_, format)| format);
        named.or(is_stdout(path).then_some(Self::Png))
    }
}
