//! A file of views: `{"views": [{"name", "dem", "eye" or "lonlat", "north", "azimuth", "altitude", "fov"}, …]}`.
//!
//! `eye` is [east, north, height] in the CRS of the DEM, `lonlat` [longitude, latitude, height] in degrees; a height is
//! metres, or "+H" above the ground. `azimuth` is counted from `north`, "true" or "grid"; from grid north where it is absent.
//! Other keys beside `views` are remarks.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::values::{self, Size, Standpoint};
use super::viewpoint::ViewArguments;
use crate::dem::North;
use crate::error::{Error, Result};
use crate::files::typed;

/// A view of the file, with the flags that give it.
#[derive(Debug)]
pub(crate) struct NamedView {
    /// In letters, digits, `-` and `_`, so that files can be named after it.
    pub name: String,
    /// Name of its DEM, without folders.
    pub dem: PathBuf,
    /// As if typed.
    pub view: ViewArguments,
}

#[derive(Deserialize)]
struct File {
    views: Vec<ViewEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewEntry {
    name: String,
    dem: PathBuf,
    eye: Option<[Coordinate; 3]>,
    lonlat: Option<[Coordinate; 3]>,
    #[serde(default)]
    north: North,
    azimuth: Option<f64>,
    altitude: Option<f64>,
    fov: Option<f64>,
}

/// A number, or a height above the ground.
#[derive(Deserialize)]
#[serde(untagged)]
enum Coordinate {
    Number(serde_json::Number),
    Text(String),
}

/// The views of a file, drawn on pages of `size` with this field of view where they name none.
///
/// # Errors
/// [`Error::Input`] where the file is missing or no such file, or a view in it is none.
pub(crate) fn read(path: &Path, fov: f64, size: Size) -> Result<Vec<NamedView>> {
    let wrong = |what: String| Error::input(path, what, "see `hachure compare --help` for what a file of views holds");
    let text = typed::text(path, "JSON")?;
    let file: File = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    let views = file.views.into_iter().map(|entry| {
        let name = entry.name.clone();
        entry.view(fov, size).map_err(|what| wrong(format!("view `{name}`: {what}")))
    });
    let views: Vec<NamedView> = views.collect::<Result<_>>()?;
    let mut names = HashSet::new();
    match views.iter().find(|view| !names.insert(&view.name)) {
        Some(twice) => Err(wrong(format!("two views are named `{}`", twice.name))),
        None => Ok(views),
    }
}

impl ViewEntry {
    fn view(self, fov: f64, size: Size) -> std::result::Result<NamedView, String> {
        let place = |of: Option<[Coordinate; 3]>, parse: fn(&str) -> std::result::Result<Standpoint, String>| {
            of.map(|parts| parse(&parts.map(|part| part.text()).join(","))).transpose()
        };
        let (eye, lonlat) = (place(self.eye, values::eye)?, place(self.lonlat, values::lonlat)?);
        if eye.is_some() == lonlat.is_some() {
            return Err("want either `eye` or `lonlat`".into());
        }
        let number = |of: Option<f64>, parse: fn(&str) -> std::result::Result<f64, String>| {
            of.map(|number| parse(&number.to_string())).transpose()
        };
        let azimuth = number(self.azimuth, values::azimuth)?;
        let altitude = number(self.altitude, values::altitude)?;
        let fov = number(self.fov, values::fov)?.unwrap_or(fov);
        let dem = self.dem.file_name().ok_or("`dem` names no file")?.into();
        Ok(NamedView {
            name: file_name(&self.name),
            dem,
            view: ViewArguments::of_file(eye, lonlat, self.north, [azimuth, altitude], fov, size),
        })
    }
}

impl Coordinate {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

/// A name that every file system takes.
pub(crate) fn file_name(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' };
    let name: String = name.chars().map(plain).take(60).collect();
    if name.is_empty() { "view".into() } else { name }
}
