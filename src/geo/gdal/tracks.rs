//! Reads a way from a vector file: its one line, else its points in order.
//!
//! Of GPX the tracks are taken, else routes, else waypoints; of other formats all layers. Parts of one line are joined in
//! order. Where there are several lines, or points in several layers, nobody can say which is meant: it is refused, with the
//! ways to name one. Cost: all features are read. Not handled: arcs
//! (`ogr2ogr -nlt CONVERT_TO_LINEAR`), heights in other units than metres or above other zeros than the DEM's, times, and
//! single heights that are missing, which GDAL reads as 0.

use std::path::Path;

use gdal::config;
use gdal::vector::{
    Feature, Geometry, Layer, LayerAccess, OGRwkbGeometryType, geometry_type_flatten, geometry_type_has_z,
};
use glam::DVec3;

use super::vectors::{Purpose, Vectors, system_of};
use crate::dem::Crs;
use crate::error::{Error, Message, Result, Setting};
use crate::geo::Track;
use crate::message;

/// Lines that are named where there are too many.
const NAMED: usize = 5;

/// Lines and points of a layer.
#[derive(Default)]
struct Found {
    layer: String,
    crs: Option<Crs>,
    lines: Vec<TrackLine>,
    points: TrackLine,
    /// Whether there is something else.
    other: bool,
}

/// A line, or points in order.
#[derive(Default)]
struct TrackLine {
    fid: Option<u64>,
    name: Option<String>,
    mode: Option<String>,
    points: Vec<DVec3>,
    has_heights: bool,
}

/// The way in a file, or in one layer of it, `FILE:LAYER`. Files on a network only where these are allowed.
///
/// # Errors
/// [`Error::Input`] where the file cannot be read, or there is no way in it, or several are.
pub(crate) fn track(path: &Path, allow_remote: bool) -> Result<Track> {
    // Of GPX heights stand in attributes otherwise. Every GDAL that the bindings know has the option.
    let _ = config::set_thread_local_config_option("GPX_ELE_AS_25D", "YES");
    let wrong = |what: Message, remedy: Message| Error::input(path, what, remedy);
    let vectors = Vectors::open(path, Purpose::Way, allow_remote)?;
    let found = vectors.read(Found::of)?;
    let (line, found) = chosen(&found, vectors.is_gpx(), path)?;
    let count = line.points.len();
    if count < 2 {
        return Err(wrong(
            "holds one point".into(),
            message!["give a path of two points at least, or ", Setting::Orbit],
        ));
    }
    if !line.points.iter().all(|point| point.truncate().is_finite()) {
        return Err(wrong("holds a point that is nowhere".into(), "mend it, or take it out".into()));
    }
    let heights: Vec<f64> = line.points.iter().map(|point| point.z).collect();
    let known = line.has_heights && heights.iter().all(|z| z.is_finite()) && heights.iter().any(|z| *z != 0.0);
    let clamped = line.mode.as_deref() == Some("clampToGround");
    Ok(Track {
        crs: found.crs.clone(),
        places: line.points.iter().map(|point| point.truncate()).collect(),
        heights: (known && !clamped).then_some(heights),
        above_ground: line.mode.as_deref() == Some("relativeToGround"),
        taken: format!("{} of layer {}", line.words(count), found.layer),
    })
}

/// The line, or the points, that can be meant alone.
fn chosen<'a>(found: &'a [Found], is_gpx: bool, path: &Path) -> Result<(&'a TrackLine, &'a Found)> {
    let wrong = |what: String, remedy: String| Err(Error::input(path, what, remedy));
    let mut with_lines: Vec<&Found> = found.iter().filter(|found| !found.lines.is_empty()).collect();
    let mut with_points: Vec<&Found> = found.iter().filter(|found| !found.points.points.is_empty()).collect();
    if is_gpx {
        // In the order in which they are listed.
        with_lines.truncate(1);
        with_points.truncate(1);
    }
    let several = |found: &[&Found], what: &str| {
        let layers: Vec<_> = found.iter().map(|found| found.layer.as_str()).collect();
        let file = path.file_name().map_or(path, Path::new);
        let remedy = format!("name the one to fly along: {}:{}", crate::error::shown(file), layers[0]);
        wrong(format!("holds {what} in {} layers ({})", layers.len(), layers.join(", ")), remedy)
    };
    match (&with_lines[..], &with_points[..]) {
        ([found], _) => match &found.lines[..] {
            [line] => Ok((line, found)),
            lines => {
                let named: Vec<_> = lines.iter().take(NAMED).map(TrackLine::named).collect();
                let more = if lines.len() > NAMED { ", …" } else { "" };
                let what = format!("holds {} lines in layer {} ({}{more})", lines.len(), found.layer, named.join(", "));
                let fid = lines[0].fid.unwrap_or_default();
                wrong(what, format!("keep one: `ogr2ogr -fid {fid} OUT.gpkg IN {:?}`", found.layer))
            }
        },
        ([], [found]) => Ok((&found.points, found)),
        ([], []) if found.iter().any(|found| found.other) => wrong(
            "holds areas or curves, no line and no points".into(),
            "make lines of them: `ogr2ogr -nlt LINESTRING OUT.gpkg IN`".into(),
        ),
        ([], []) => wrong("holds no line and no points".into(), "give a file with a line, or points in order".into()),
        ([], several_points) => several(several_points, "points"),
        (several_lines, _) => several(several_lines, "lines"),
    }
}

impl Found {
    fn of(layer: &mut Layer) -> Self {
        let crs = system_of(layer);
        let mut found = Self { layer: layer.name(), crs, ..Self::default() };
        for feature in layer.features() {
            let text =
                |name: &str| feature.field_index(name).ok().and_then(|i| feature.field_as_string(i).ok().flatten());
            let Some(geometry) = feature.geometry().filter(|geometry| !geometry.is_empty()) else { continue };
            let line = TrackLine {
                fid: feature.fid(),
                name: name(&feature),
                mode: text("altitudeMode"),
                ..TrackLine::default()
            };
            found.take(geometry, line);
        }
        found
    }

    fn take(&mut self, geometry: &Geometry, mut line: TrackLine) {
        match parts(geometry) {
            Some(parts) if parts.lines => {
                line.add(parts);
                self.lines.push(line);
            }
            Some(parts) => {
                self.points.mode = line.mode;
                self.points.add(parts);
            }
            None => self.other = true,
        }
    }
}

/// What a geometry is made of.
struct Parts {
    lines: bool,
    points: Vec<DVec3>,
    has_heights: bool,
}

/// The points of lines or points and of several of them; `None` of all else.
fn parts(geometry: &Geometry) -> Option<Parts> {
    let kind = geometry.geometry_type();
    let has_heights = geometry_type_has_z(kind);
    let kind = geometry_type_flatten(kind);
    let lines = kind == OGRwkbGeometryType::wkbLineString;
    if lines || kind == OGRwkbGeometryType::wkbPoint {
        let count = geometry.point_count() as i32;
        let points = (0..count).map(|i| DVec3::from(geometry.get_point(i))).collect();
        return Some(Parts { lines, points, has_heights });
    }
    let several = [
        OGRwkbGeometryType::wkbMultiLineString,
        OGRwkbGeometryType::wkbMultiPoint,
        OGRwkbGeometryType::wkbGeometryCollection,
    ];
    if !several.contains(&kind) {
        return None;
    }
    let parts = (0..geometry.geometry_count()).map(|i| parts(&geometry.get_geometry(i)));
    let parts: Vec<Parts> = parts.collect::<Option<_>>()?;
    let lines = parts.iter().any(|part| part.lines);
    // Several parts may be flat as a whole and high by themselves.
    let has_heights = has_heights || parts.iter().any(|part| part.has_heights);
    let kept = parts.iter().filter(|part| part.lines == lines);
    let points = kept.flat_map(|part| part.points.iter().copied()).collect();
    Some(Parts { lines, points, has_heights })
}

impl TrackLine {
    fn add(&mut self, parts: Parts) {
        self.has_heights |= parts.has_heights;
        self.points.extend(parts.points);
    }

    /// Its name, else its number.
    fn named(&self) -> String {
        match (&self.name, self.fid) {
            (Some(name), _) => format!("\"{name}\""),
            (None, Some(fid)) => format!("feature {fid}"),
            (None, None) => "one without a name".into(),
        }
    }

    fn words(&self, count: usize) -> String {
        match self.fid {
            Some(_) => format!("the line {} with {count} points", self.named()),
            None => format!("{count} points in order"),
        }
    }
}

fn name(feature: &Feature) -> Option<String> {
    let field = ["name", "Name"].iter().find_map(|name| feature.field_index(name).ok())?;
    feature.field_as_string(field).ok().flatten().filter(|name| !name.is_empty())
}
