//! Vector files of points, lines and areas, open for reading: those of a flight's way and of lines on the land.
//!
//! Formats are those that are plain files and call nothing. Names are taken apart as those of rasters are, in `name`. Cost: all
//! features of the layers are read.

use std::path::{Path, PathBuf};

use gdal::vector::{Layer, LayerAccess};
use gdal::{Dataset, GdalOpenFlags};

use super::formats::{self, FORMATS, VECTORS};
use super::name::{Local, Name};
use super::source::{check_file, heard, one_line, unreadable_file};
use super::{lossless, vsi};
use crate::dem::Crs;
use crate::error::{Error, Result, Setting};
use crate::geo::track::with_layer;
use crate::message;

/// Layers of GPX that hold what its other layers repeat, the best first.
const GPX: [&str; 3] = ["tracks", "routes", "waypoints"];

/// What a file is opened for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// A way that a flight takes.
    Way,
    /// Lines on the land.
    Lines,
}

/// A vector file, and the layers of it that are meant.
pub(super) struct Vectors {
    path: PathBuf,
    /// Without the layer.
    file: PathBuf,
    dataset: Dataset,
    layers: Vec<String>,
}

/// The system of a layer's places; none where it names none, for which GeoPackage has names of its own (OGC 12-128r19, 1.1.2.1.2).
pub(super) fn system_of(layer: &Layer) -> Option<Crs> {
    let is_undefined = |name: String| name.to_ascii_lowercase().starts_with("undefined ");
    let named = layer.spatial_ref().filter(|reference| !reference.name().is_some_and(is_undefined));
    named.and_then(Crs::of)
}

impl Purpose {
    /// What is looked for.
    fn noun(self) -> &'static str {
        match self {
            Self::Way => "a path",
            Self::Lines => "lines",
        }
    }

    /// What to do with a file in which it is not found.
    fn remedy(self) -> &'static str {
        match self {
            Self::Way => {
                "give a line as GeoJSON, KML, GPX or GeoPackage, perhaps made by `ogr2ogr OUT.gpkg IN`, or keys in a .toml"
            }
            Self::Lines => {
                "give lines as GeoPackage, GeoJSON, KML, GPX or Shapefile, perhaps made by `ogr2ogr OUT.gpkg IN`"
            }
        }
    }
}

impl Vectors {
    /// A file with all its layers that hold something of their own, or `FILE:LAYER`. Files on a network only where these are
    /// allowed.
    ///
    /// # Errors
    /// [`Error::Input`] where the file cannot be read, and for a layer that it lacks.
    pub(super) fn open(path: &Path, purpose: Purpose, allow_remote: bool) -> Result<Self> {
        formats::restrict(allow_remote);
        let (file, layer) = with_layer(path);
        let dataset = open(&file, purpose, allow_remote)?;
        let is_gpx = is_gpx(&dataset);
        let mut layers: Vec<String> = dataset.layers().map(|layer| layer.name()).collect();
        match layer {
            Some(layer) if layers.contains(&layer) => layers = vec![layer],
            Some(layer) => {
                let remedy = format!("name one of its layers: {}", layers.join(", "));
                return Err(Error::input(path, format!("has no layer {layer}"), remedy));
            }
            None if is_gpx => {
                layers = GPX
                    .into_iter()
                    .filter(|known| layers.iter().any(|name| name == known))
                    .map(str::to_owned)
                    .collect();
            }
            None => {}
        }
        Ok(Self { path: path.to_owned(), file, dataset, layers })
    }

    /// Whether it is GPX, the layers of which are in order of worth.
    pub(super) fn is_gpx(&self) -> bool {
        is_gpx(&self.dataset)
    }

    /// What `of` makes of each layer.
    ///
    /// # Errors
    /// [`Error::Input`] where a layer cannot be read to its end.
    pub(super) fn read<T>(&self, of: impl Fn(&mut Layer) -> T) -> Result<Vec<T>> {
        let (read, complaint) = heard(|| {
            let layers = self.layers.iter().filter_map(|name| self.dataset.layer_by_name(name).ok());
            layers.map(|mut layer| of(&mut layer)).collect()
        });
        match complaint {
            Some(words) => {
                let what = format!("is damaged or cut short ({})", one_line(&words, &self.file));
                let remedy = "copy or download it again, or see what `ogrinfo IN` says of it";
                Err(Error::input(&self.path, what, remedy))
            }
            None => Ok(read),
        }
    }
}

fn is_gpx(dataset: &Dataset) -> bool {
    dataset.driver().short_name() == "GPX"
}

fn open(path: &Path, purpose: Purpose, allow_remote: bool) -> Result<Dataset> {
    let name = match path.exists() {
        true => Name::Local(Local::by_ending(path)),
        false => Name::of(&lossless::text(path.as_os_str())),
    };
    let name = match name {
        Name::Local(mut local) => {
            check_file(path, &local.file)?;
            local.file = std::path::absolute(&local.file).map_err(|e| unreadable_file(path, &e))?;
            local.connection()
        }
        Name::Remote(name) if allow_remote => name,
        Name::Remote(_) => {
            let remedy =
                message!["download it first, or add `", Setting::AllowRemote, "` if you trust where it comes from"];
            return Err(Error::input(path, "lies on a network", remedy));
        }
        Name::Other => {
            let what = "is no file, but a connection to something else";
            return Err(Error::input(path, what, "save it to a file and name that"));
        }
    };
    let flags = GdalOpenFlags::GDAL_OF_VECTOR | GdalOpenFlags::GDAL_OF_READONLY | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR;
    let (opened, complaint) = vsi::open(&name, flags, &VECTORS);
    opened.ok_or_else(|| {
        let (noun, remedy) = (purpose.noun(), purpose.remedy());
        if vsi::open(&name, GdalOpenFlags::GDAL_OF_RASTER, &FORMATS).0.is_some() {
            return Error::input(path, format!("holds a raster, not {noun}"), remedy);
        }
        match complaint.filter(|words| !words.contains("not recognized as a supported file format")) {
            Some(words) => {
                let what = format!("cannot be opened as {noun} ({})", one_line(&words, path));
                Error::input(path, what, "mend it, or download it again, or see what `ogrinfo IN` says of it")
            }
            None => Error::input(path, "is in no format of lines that hachure reads", remedy),
        }
    })
}
