//! A view for those who give none: one that shows the relief.
//!
//! Eyes on rings around the middle of the DEM look inwards. For each, rays fan out over a thinned grid and follow the
//! terrain: where a visible slope ends and something farther shows above it, there is a crest, an occluding line on
//! the page. The eye with the most crests, spread over most columns, wins. Cost: a few million samples. It knows
//! nothing of taste.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::Camera;
use crate::dem::Dem;
use crate::error::Result;

/// Directions of the rings.
const DIRECTIONS: usize = 24;
/// Distances of eyes from the middle, in half the shorter side of the DEM.
const RINGS: [f64; 4] = [0.6, 0.8, 0.95, 1.3];
/// Heights of eyes above the ground, in shares of the relief.
const HEIGHTS: [f64; 3] = [0.12, 0.3, 0.6];
/// Rays across the page.
const RAYS: usize = 48;
/// Samples along a ray.
const STEPS: usize = 160;
/// Where the mean skyline lies on the page, from its top.
const SKYLINE: f64 = 0.3;
/// A mean skyline this high above the eye makes a view worthless: tangent.
const STEEPEST_SKYLINE: f64 = 0.15;
/// Crests count where the angle of sight rises by at least this much after a hidden stretch: tangent.
const RISE: f64 = 0.002;

/// What the user fixed of the view; the rest is chosen.
#[derive(Debug, Clone, Copy, Default)]
pub struct Fixed {
    /// Eye in metres: easting, northing, exaggerated height.
    pub eye: Option<DVec3>,
    /// Degrees clockwise from the y axis of the world.
    pub azimuth: Option<f64>,
    /// Degrees above the horizon.
    pub altitude: Option<f64>,
}

/// Completes a view. A given eye looks at the middle of the DEM, level, unless told otherwise. The result is rounded to a
/// power of ten below a tenth of a cell, 1 m at most, and tenths of degrees, so that what is printed of it repeats it.
///
/// `dem` must hold a valid sample. Of a filed DEM a thinned one is looked at.
///
/// # Errors
/// As [`Dem::survey`].
pub fn choose(dem: &Dem, fixed: Fixed, fov: f64, width: u32, height: u32) -> Result<Camera> {
    let [west, south, east, north] = dem.extent();
    let middle = DVec2::new(west + east, south + north) / 2.0;
    let camera = |eye, azimuth, altitude| Camera { eye, azimuth, altitude, fov, width, height };
    if let Some(eye) = fixed.eye {
        let azimuth = fixed.azimuth.unwrap_or_else(|| tenth(heading(middle - eye.truncate())).rem_euclid(360.0));
        return Ok(camera(eye, azimuth, fixed.altitude.unwrap_or(0.0)));
    }
    let grain = 10_f64.powf((dem.cell().min_element() / 10.0).log10().floor()).min(1.0);
    // Through its decimals, so that it prints short.
    let round = |x: f64| (x / grain).round() / (1.0 / grain).round();
    let [low, high] = dem.survey(&|_| ())?.range.unwrap_or_default().map(f64::from);
    let thinned = dem.thinned()?;
    let radius = DVec2::new(east - west, north - south).min_element() / 2.0;
    let eyes = (0..DIRECTIONS * RINGS.len() * HEIGHTS.len()).into_par_iter().filter_map(|i| {
        let azimuth = fixed.azimuth.unwrap_or((i % DIRECTIONS) as f64 * 360.0 / DIRECTIONS as f64);
        let back = DVec2::new(azimuth.to_radians().sin(), azimuth.to_radians().cos());
        let place = middle - back * radius * RINGS[i / DIRECTIONS % RINGS.len()];
        let place = DVec2::new(round(place.x), round(place.y));
        let ground = height_at(&thinned, place).unwrap_or(low);
        let clearance = (high - low).max(radius / 20.0) * HEIGHTS[i / DIRECTIONS / RINGS.len()];
        let eye = place.extend(round(ground + clearance));
        let (score, skyline) = look(&thinned, eye, azimuth, fov, radius)?;
        Some((score, std::cmp::Reverse(i), eye, azimuth, skyline))
    });
    let best = eyes.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let Some((_, _, eye, azimuth, skyline)) = best else {
        let eye = DVec3::new(round(middle.x), round(middle.y - radius * 1.3), round(high + radius / 2.0));
        return Ok(camera(eye, fixed.azimuth.unwrap_or(0.0), fixed.altitude.unwrap_or(-20.0)));
    };
    let half_height = (fov.to_radians() / 2.0).tan() * f64::from(height) / f64::from(width);
    let altitude = (skyline.atan() - (half_height * (1.0 - 2.0 * SKYLINE)).atan()).to_degrees();
    Ok(camera(eye, azimuth, fixed.altitude.unwrap_or_else(|| tenth(altitude.clamp(-60.0, 20.0)))))
}

/// Azimuth in degrees of a direction in the map; 0 for none.
fn heading(d: DVec2) -> f64 {
    d.x.atan2(d.y).to_degrees().rem_euclid(360.0)
}

fn tenth(degrees: f64) -> f64 {
    (degrees * 10.0).round() / 10.0
}

/// Height at a place in metres, bilinear between four samples: steps between samples would pass for crests.
fn height_at(dem: &Dem, place: DVec2) -> Option<f64> {
    let at = dem.grid_place(place);
    let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < (dem.columns() - 1) as f64 && at.y < (dem.rows() - 1) as f64;
    if !inside {
        return None;
    }
    let (c, r) = (at.x as usize, at.y as usize);
    let (u, v) = (at.x.fract(), at.y.fract());
    let height = |dc, dr| dem.height(c + dc, r + dr).map(f64::from);
    let north = height(0, 0)? * (1.0 - u) + height(1, 0)? * u;
    let south = height(0, 1)? * (1.0 - u) + height(1, 1)? * u;
    Some(north * (1.0 - v) + south * v)
}

/// How well an eye shows the relief, and the mean tangent of the skyline's altitude; `None` when it sees no land.
fn look(dem: &Dem, eye: DVec3, azimuth: f64, fov: f64, radius: f64) -> Option<(f64, f64)> {
    let (mut crests, mut lively, mut skyline, mut seen) = (0.0, 0, 0.0, 0);
    for ray in 0..RAYS {
        let angle = (azimuth + fov * ((ray as f64 + 0.5) / RAYS as f64 - 0.5)).to_radians();
        let direction = DVec2::new(angle.sin(), angle.cos());
        let (mut horizon, mut hidden, mut found) = (f64::NEG_INFINITY, false, 0);
        for step in 1..=STEPS {
            // Steps grow with distance, as the page's do.
            let share = step as f64 / STEPS as f64;
            let distance = 3.0 * radius * share * share;
            let Some(height) = height_at(dem, eye.truncate() + direction * distance) else { continue };
            let tangent = (height - eye.z) / distance;
            if tangent < horizon {
                hidden = true;
            } else {
                found += i32::from(hidden && tangent > horizon + RISE);
                hidden = false;
                horizon = tangent;
            }
        }
        if horizon.is_finite() {
            seen += 1;
            skyline += horizon;
            crests += f64::from(found).sqrt();
            lively += i32::from(found > 0);
        }
    }
    let spread = f64::from(lively) / RAYS as f64;
    let filled = f64::from(seen) / RAYS as f64;
    let skyline = skyline / f64::from(seen);
    // Looking up from a valley, one slope fills the page.
    let level = 1.0 - (skyline.max(0.0) / STEEPEST_SKYLINE).min(1.0);
    (seen > 0).then_some((crests * spread * filled * level, skyline))
}
