//! Flags of lines of the user's own that are drawn on the land.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use super::talk::Talk;
use crate::dem::Dem;
use crate::error::{Result, shown};
use crate::geo::{self, OwnLines};
use crate::relief::{self, SurfaceLine};

/// The flags, as typed.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct LinesArguments {
    /// Also draw lines of your own on the land: all lines and rims of areas in a vector file (GeoPackage, GeoJSON, KML, GPX,
    /// Shapefile …), FILE:LAYER of one of its layers; several times for several. Each layer is one of the drawing, with the pen
    /// that the style has in [pens.lines] for its name, or the file's. The whole number in an attribute order, strahler,
    /// stream_order, ord_stra or class says how much a line weighs; 1 where there is none
    #[arg(long = "lines", value_name = "FILE[:LAYER]", help_heading = "Style")]
    lines: Vec<PathBuf>,
    /// They, once they are read: what is named is what is drawn, whatever becomes of the files.
    #[arg(skip)]
    given: OnceLock<GivenLines>,
    /// What the sheet of a map is called that they are drawn on, which they may all miss.
    #[arg(skip)]
    sheet: Option<String>,
}

/// The lines of all files, before their DEM is read.
#[derive(Debug, Clone, Default)]
pub struct GivenLines(Arc<[Given]>);

/// A file.
#[derive(Debug, Clone)]
struct Given {
    path: PathBuf,
    lines: OwnLines,
    /// What its layers are called.
    layers: Vec<String>,
}

impl LinesArguments {
    /// Whether there are any.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// The same on a sheet of a map.
    pub fn on_sheet(&mut self, called: &str) {
        self.sheet = Some(called.to_owned());
    }

    /// The files that are read beside the DEM.
    pub fn files(&self) -> Vec<PathBuf> {
        self.lines.iter().map(|path| geo::with_layer(path).0).collect()
    }

    /// Reads the files, once; those on a network only where these are allowed.
    ///
    /// # Errors
    /// As [`geo::own_lines`].
    pub fn open(&self, allow_remote: bool) -> Result<&GivenLines> {
        if let Some(given) = self.given.get() {
            return Ok(given);
        }
        let read = |path: &PathBuf| {
            let lines = geo::own_lines(path, allow_remote)?;
            Ok(Given { path: path.clone(), layers: lines.names(path), lines })
        };
        let given = self.lines.iter().map(read).collect::<Result<_>>()?;
        Ok(self.given.get_or_init(|| GivenLines(given)))
    }

    /// The lines on a DEM: [`Self::open`] and [`GivenLines::on`] at once.
    ///
    /// # Errors
    /// As those.
    pub fn read(&self, dem: &Dem, allow_remote: bool, talk: &Talk) -> Result<Vec<SurfaceLine>> {
        self.open(allow_remote)?.on(dem, self.sheet.as_deref(), talk)
    }
}

impl GivenLines {
    /// All that they depend on, wherever the files lie: what is equal is drawn equally on one DEM.
    pub fn asked(&self) -> String {
        let name =
            |given: &Given| format!("{:?} {:032x}", given.path.file_name().unwrap_or_default(), given.lines.hash());
        self.0.iter().map(name).collect::<Vec<_>>().join("; ")
    }

    /// What their layers are called, in the order of their numbers.
    pub fn layers(&self) -> Vec<String> {
        self.0.iter().flat_map(|given| given.layers.iter().cloned()).collect()
    }

    /// The lines on a DEM, file by file; what was taken is told. Those that are not there are no error on a sheet of a map; where
    /// there are none at all, it is told.
    ///
    /// # Errors
    /// As [`relief::own_lines`].
    pub fn on(&self, dem: &Dem, sheet: Option<&str>, talk: &Talk) -> Result<Vec<SurfaceLine>> {
        let (mut on_dem, mut first) = (Vec::new(), 0);
        let of_file = if sheet.is_some() { relief::own_lines_if_any } else { relief::own_lines };
        for Given { path, lines, layers } in self.0.iter() {
            on_dem.extend(of_file(path, lines, dem, first)?);
            first += layers.len();
            talk.say(&format!("lines: {}: {}", shown(path), lines.taken()))?;
            if lines.layers.iter().any(|layer| layer.crs.is_none()) {
                talk.warn(&format!("{} names no coordinate system: assumed that it is the DEM's", shown(path)));
            }
        }
        if let Some(sheet) = sheet.filter(|_| on_dem.is_empty() && !self.0.is_empty()) {
            talk.warn(&format!("{sheet}: no line of --lines lies on its land: drawn without"));
        }
        Ok(on_dem)
    }
}
