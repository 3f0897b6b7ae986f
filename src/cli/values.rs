//! Values of flags: numbers with commas, sizes, levels, adapters. Each parser says what it wants.

use glam::DVec2;

use crate::gpu::AdapterChoice;
use crate::gpu::sizes::LARGEST_SIDE;
use crate::surface::Level;

/// No place on Earth has coordinates beyond this, metres.
const FARTHEST: f64 = 1e9;

/// Where the eye is: a place in the CRS of the DEM and a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Easting and northing, metres.
    pub place: DVec2,
    /// Above what, metres.
    pub height: EyeHeight,
}

/// A height of the eye in exaggerated metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EyeHeight {
    /// Above the zero of the DEM.
    Absolute(f64),
    /// Above the drawn surface under the eye.
    AboveGround(f64),
}

/// Pixels across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Across.
    pub width: u32,
    /// Down.
    pub height: u32,
}

fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("`{text}` is no number"))?;
    if value.is_finite() && value.abs() <= FARTHEST { Ok(value) } else { Err(format!("{text} is out of range")) }
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let values = text.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
    values.try_into().map_err(|_| format!("want {form}"))
}

/// `E,N,Z` or `E,N,+H`.
pub fn eye(text: &str) -> Result<Eye, String> {
    let [east, north, z] = numbers(text, "E,N,Z or E,N,+H in metres")?;
    let above = text.rsplit(',').next().is_some_and(|z| z.trim().starts_with('+'));
    let height = if above { EyeHeight::AboveGround(z) } else { EyeHeight::Absolute(z) };
    Ok(Eye { place: DVec2::new(east, north), height })
}

/// `E0,N0,E1,N1`, west before east and south before north.
pub fn crop(text: &str) -> Result<[f64; 4], String> {
    let window: [f64; 4] = numbers(text, "E0,N0,E1,N1 in metres")?;
    let [west, south, east, north] = window;
    if west < east && south < north { Ok(window) } else { Err("want west,south,east,north in this order".into()) }
}

/// `WxH` in pixels.
pub fn size(text: &str) -> Result<Size, String> {
    let form = || format!("want WxH in pixels, each from 1 to {LARGEST_SIDE}");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(form)?;
    let side = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST_SIDE).contains(n)).ok_or_else(form);
    Ok(Size { width: side(width)?, height: side(height)? })
}

/// A level: subdivisions of a cell's edge.
pub fn level(text: &str) -> Result<Level, String> {
    text.parse().ok().and_then(Level::new).ok_or_else(|| "want 1, 2, 4, 8, 16, 32 or 64".into())
}

/// `cpu`, `gpu` or words of an adapter's name.
pub fn adapter(text: &str) -> Result<AdapterChoice, String> {
    match text {
        "" => Err("want cpu, gpu or words of an adapter's name".into()),
        "cpu" => Ok(AdapterChoice::Cpu),
        "gpu" => Ok(AdapterChoice::Gpu),
        name => Ok(AdapterChoice::Named(name.to_owned())),
    }
}

/// Degrees clockwise from north, brought to 0 to 360.
pub fn azimuth(text: &str) -> Result<f64, String> {
    number(text).map(|degrees| degrees.rem_euclid(360.0))
}

/// Degrees above the horizon.
pub fn altitude(text: &str) -> Result<f64, String> {
    number(text).and_then(|e| if e.abs() <= 90.0 { Ok(e) } else { Err("want -90 to 90 degrees".into()) })
}

/// Degrees across the page.
pub fn fov(text: &str) -> Result<f64, String> {
    number(text).and_then(|f| if (0.1..=170.0).contains(&f) { Ok(f) } else { Err("want 0.1 to 170 degrees".into()) })
}

/// Factor on every elevation.
pub fn exaggeration(text: &str) -> Result<f64, String> {
    number(text)
        .and_then(|x| if x > 0.0 && x <= 1000.0 { Ok(x) } else { Err("want a factor above 0, at most 1000".into()) })
}
