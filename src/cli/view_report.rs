//! The view in `--json`: enough to set any place of the world on the page.

use serde::Serialize;

use super::viewpoint::View;
use crate::dem::{Georeference, North};

/// A view, its eye on the map and on the globe, and its projection.
#[derive(Serialize)]
pub(crate) struct ViewReport {
    eye: [f64; 3],
    lonlat: Option<[f64; 2]>,
    /// What `azimuth` is counted from.
    north: North,
    /// Degrees clockwise from that north; the axes of the world stand in `page`.
    azimuth: f64,
    altitude: f64,
    /// The two norths at the eye, degrees clockwise from the y axis of the world.
    grid_north: Option<f64>,
    true_north: Option<f64>,
    fov: f64,
    size: [u32; 2],
    projection: &'static str,
    page: PageReport,
    /// Name and number of the CRS whose coordinates, times `axes` and `metres_per_unit`, are the world's.
    crs: String,
    crs_wkt: String,
    /// Rows of the matrix that turns the CRS's own axes to east and north; absent where they run so.
    #[serde(skip_serializing_if = "Option::is_none")]
    axes: Option<[[f64; 2]; 2]>,
    metres_per_unit: Option<f64>,
    file: FileReport,
    exaggeration: f64,
    flags: String,
}

/// The numbers of the projection: unit vectors of the world, and pixels.
#[derive(Serialize)]
struct PageReport {
    right: [f64; 3],
    up: [f64; 3],
    forward: [f64; 3],
    focal_px: f64,
    centre_px: [f64; 2],
}

/// The eye in the coordinates of the file.
#[derive(Serialize)]
struct FileReport {
    eye: [f64; 2],
    crs: String,
    crs_wkt: String,
}

impl ViewReport {
    /// Of a view of a DEM that lies there, with heights times `exaggeration`.
    pub(crate) fn of(view: &View, georeference: &Georeference, exaggeration: f64) -> Self {
        let (camera, norths) = (&view.camera, &view.norths);
        let [right, up, forward] = camera.axes().map(|axis| axis.to_array());
        let (world, file) = (georeference.world(), georeference.file());
        Self {
            eye: camera.eye.to_array(),
            lonlat: view.lonlat.map(|at| at.to_array()),
            north: norths.north,
            azimuth: view.azimuth,
            altitude: camera.altitude,
            grid_north: norths.bearings.grid,
            true_north: norths.bearings.true_north,
            fov: camera.fov,
            size: [camera.width, camera.height],
            projection: "central: with d = world - eye the place on the page, px from its top left corner, \
                         is centre + focal / (d . forward) * (d . right, -(d . up))",
            page: PageReport {
                right,
                up,
                forward,
                focal_px: camera.focal(),
                centre_px: [f64::from(camera.width) / 2.0, f64::from(camera.height) / 2.0],
            },
            crs: world.label(),
            crs_wkt: world.wkt().to_owned(),
            axes: (*world != world.as_defined()).then(|| world.axes().transpose().to_cols_array_2d()),
            metres_per_unit: world.metres_per_unit(),
            file: FileReport { eye: view.file.to_array(), crs: file.label(), crs_wkt: file.wkt().to_owned() },
            exaggeration,
            flags: view.flags(),
        }
    }
}
