//! A DEM on its way to a device: read, looked at, and the device opened meanwhile.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread;

use super::cells;
use super::device::DeviceArguments;
use super::drawing::DrawingArguments;
use super::talk::Talk;
use super::terrain::{TerrainArguments, warn_of_survey};
use super::values::Size;
use super::viewpoint::{View, ViewArguments};
use super::words::told;
use crate::cache::Cache;
use crate::error::Result;
use crate::geo::Reading;
use crate::gpu::Gpu;
use crate::line::Land;
use crate::relief::LandWanted;
use crate::surface::Surface;

/// Reads the DEM and finds its normals.
///
/// # Errors
/// As [`TerrainArguments::read`] and [`TerrainArguments::surface`]; where there is nothing to draw.
pub(crate) fn surface(terrain: &TerrainArguments, reading: Reading, cache: &Cache, talk: &Talk) -> Result<Surface> {
    let dem = terrain.read(reading, talk)?;
    // The renderer holds all samples on the device.
    talk.progress("computing normals", 0.1);
    if !dem.is_filed() {
        dem.check_patches()?;
    }
    terrain.surface(dem, cache, talk)
}

/// Looks at the samples of a DEM that stays in its file.
///
/// # Errors
/// As [`Cache::prepare`]; where there is nothing to draw.
pub(crate) fn prepare(surface: &Surface, cache: &Cache, talk: &Talk) -> Result<()> {
    cache.prepare(surface, &|message| talk.warn(&told(message)), &|done| {
        talk.progress("looking at every sample, once for this file", 0.1 + 0.1 * done);
    })?;
    surface.dem().check_patches()
}

/// The view of a frame of so many pixels, told as flags that repeat it, and what is to be said of it and of the DEM.
///
/// # Errors
/// As [`ViewArguments::view`].
pub(crate) fn look(
    view: &ViewArguments,
    drawing: &DrawingArguments,
    surface: &Surface,
    [width, height]: [u32; 2],
    talk: &Talk,
) -> Result<View> {
    cells::warn(surface.dem(), drawing.exaggeration, talk);
    warn_of_survey(surface.dem(), talk)?;
    let near = drawing.level.near();
    let view = view.sized(Size { width, height }).view(surface, near)?;
    view.warn_below_ground(surface, near, talk);
    let page = drawing.page.flags();
    talk.say(&format!("view: {}{page}", view.flags()))?;
    view.lonlat_flags().map_or(Ok(()), |flags| talk.say(&format!("or with: {flags}{page}")))?;
    view.norths.words().map_or(Ok(()), |words| talk.say(&words))?;
    Ok(view)
}

/// The lines of the land that are wanted; `None` where none are.
///
/// # Errors
/// As [`LandArguments::land`](super::land::LandArguments::land).
pub(crate) fn land(
    drawing: &DrawingArguments,
    wanted: &LandWanted,
    terrain: &TerrainArguments,
    surface: &Arc<Surface>,
    cache: &Cache,
    talk: &Talk,
) -> Result<Option<Arc<Land>>> {
    if wanted.is_nothing() {
        return Ok(None);
    }
    talk.progress("looking for lines of the land", 0.2);
    let land = drawing.land.land(wanted, surface, drawing.exaggeration, terrain.allows_remote(), cache, talk)?;
    Ok(Some(Arc::new(land)))
}

/// [`prepare`] while the device opens: drivers take their time to start. What opening comes to is told after all that is said
/// of the DEM and its view.
///
/// # Errors
/// As [`prepare`].
pub(crate) fn prepare_and_open(
    surface: &Surface,
    cache: &Cache,
    device: &DeviceArguments,
    talk: &Talk,
) -> Result<Result<Gpu>> {
    // Samples stay on this thread, where HDF5 keeps silent.
    let (prepared, gpu) = thread::scope(|scope| {
        let open = || device.open_silently(wgpu::Features::empty());
        match thread::Builder::new().spawn_scoped(scope, open) {
            Ok(gpu) => (prepare(surface, cache, talk), gpu.join().unwrap_or_else(|panic| resume_unwind(panic))),
            // The system has no thread left.
            Err(_) => (prepare(surface, cache, talk), open()),
        }
    });
    prepared.map(|()| gpu)
}
