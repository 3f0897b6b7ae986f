//! Values of flags: numbers with commas, sizes, levels, adapters. Each parser says what it wants.

use std::fmt::Display;
use std::num::NonZeroU32;
use std::ops::RangeInclusive;

use glam::DVec2;

use super::style::Split;
use crate::dem::LARGEST_SIDE as MOST_SAMPLES;
use crate::geo::{ElevationUnit, Encoding, Nodata, Order};
use crate::gpu::AdapterChoice;
use crate::ink::sheet::PAPERS;
use crate::measure::compare::LEAST_TRUTH_LEVEL;
use crate::plan::pieces::LARGEST_PAGE;
use crate::plan::{Detail, Method};
use crate::surface::Level;

/// No place on Earth has coordinates beyond this, in any unit.
const FARTHEST: f64 = 1e9;

/// Where the eye is: a map place and a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standpoint {
    /// East and north, in the units of the CRS it is given in.
    pub place: DVec2,
    /// Above what, metres.
    pub height: GivenHeight,
}

/// A height in exaggerated metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GivenHeight {
    /// Above the zero of the DEM.
    Absolute(f64),
    /// Above the drawn surface at that place.
    AboveGround(f64),
}

/// Where the eye looks: a map place and, maybe, a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookAt {
    /// East and north, in the units of the CRS it is given in.
    pub place: DVec2,
    /// Exaggerated metres above the zero of the DEM; the ground where not given.
    pub height: Option<f64>,
}

/// Pixels across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Across.
    pub width: u32,
    /// Down.
    pub height: u32,
}

/// Deviations that make sense: below, facets fill the memory; above, nothing is left of the land.
const ERRORS_PX: RangeInclusive<f64> = 0.01..=100.0;

/// A gap this wide leaves little but the skyline.
const MOST_GAP_PX: f64 = 1000.0;
const MOST_GAP_MM: f64 = 100.0;

/// Frames of a flight that somebody draws.
pub const MOST_FRAMES: u32 = 1_000_000;

/// Most peaks that are listed.
const MOST_PEAKS: usize = 1_000_000;

/// Frames a second that somebody shows.
const FPS: [f64; 2] = [0.1, 240.0];

/// Most distances that part layers.
const MOST_DISTANCES: usize = 64;

/// Sides of pages that somebody prints or plots, mm.
pub const PAGES_MM: [f64; 2] = [10.0, 5000.0];

/// Metres of land for a metre of a plan.
const SCALES: [f64; 2] = [1.0, 1e9];

/// Pixels an inch that somebody prints.
const DPI: [f64; 2] = [10.0, 4800.0];

/// Bytes in units of 1024, as `1GiB`.
pub fn bytes(text: &str) -> Result<u64, String> {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let power = UNITS.iter().position(|known| known.eq_ignore_ascii_case(unit.trim()));
    let bytes = power.zip(number.parse::<f64>().ok()).map(|(power, number)| number * 1024_f64.powi(power as i32));
    let bytes = bytes.filter(|bytes| (1.0..=u64::MAX as f64 / 2.0).contains(bytes));
    bytes.map(|bytes| bytes as u64).ok_or_else(|| "want a number and B, KiB, MiB, GiB or TiB, as 512MiB".to_owned())
}

/// A number that a coordinate may be.
pub fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text.trim().parse().map_err(|_| format!("`{text}` is no number"))?;
    if value.is_finite() && value.abs() <= FARTHEST { Ok(value) } else { Err(format!("{text} is out of range")) }
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let values = text.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
    values.try_into().map_err(|_| format!("want {form}"))
}

/// `E,N,Z` or `E,N,+H`.
pub fn eye(text: &str) -> Result<Standpoint, String> {
    standpoint(text, "E,N,Z or E,N,+H: east and north in the CRS of the DEM, metres of height")
}

/// `LON,LAT,Z` or `LON,LAT,+H`.
pub fn lonlat(text: &str) -> Result<Standpoint, String> {
    let eye = standpoint(text, "LON,LAT,Z or LON,LAT,+H in degrees and metres")?;
    if eye.place.x.abs() > 360.0 || eye.place.y.abs() > 90.0 {
        return Err("want longitude (-360 to 360) before latitude (-90 to 90), in degrees".into());
    }
    Ok(eye)
}

fn standpoint(text: &str, form: &str) -> Result<Standpoint, String> {
    let [x, y, z] = numbers(text, form)?;
    let above = text.rsplit(',').next().is_some_and(|z| z.trim().starts_with('+'));
    let height = if above { GivenHeight::AboveGround(z) } else { GivenHeight::Absolute(z) };
    Ok(Standpoint { place: DVec2::new(x, y), height })
}

/// `E,N` or `E,N,Z`.
pub fn look_at(text: &str) -> Result<LookAt, String> {
    let form = "E,N or E,N,Z: east and north in the CRS of the DEM, metres of height";
    if text.split(',').count() == 2 {
        let place = numbers(text, form).map(DVec2::from_array)?;
        return Ok(LookAt { place, height: None });
    }
    let [x, y, z] = numbers(text, form)?;
    Ok(LookAt { place: DVec2::new(x, y), height: Some(z) })
}

/// `E,N`.
pub fn place(text: &str) -> Result<DVec2, String> {
    numbers(text, "E,N: east and north in the CRS of the DEM").map(DVec2::from_array)
}

/// `X,Y` of a pixel.
pub fn pixel(text: &str) -> Result<[u32; 2], String> {
    let whole =
        |text: &str| text.trim().parse::<u32>().map_err(|_| format!("`{}` is no number of a pixel", text.trim()));
    let values = text.split(',').map(whole).collect::<Result<Vec<_>, _>>()?;
    values.try_into().map_err(|_| "want X,Y: the pixel's column and row, whole numbers from 0,0 at the top left".into())
}

/// `Z` or `+H`.
pub fn height(text: &str) -> Result<GivenHeight, String> {
    let metres = number(text)?;
    Ok(if text.trim().starts_with('+') { GivenHeight::AboveGround(metres) } else { GivenHeight::Absolute(metres) })
}

/// Metres that are kept free.
pub fn clearance(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|metres| *metres >= 0.0).ok_or_else(|| "want metres, 0 or more".into())
}

/// Frames of a flight.
pub fn frames(text: &str) -> Result<u32, String> {
    let frames = text.parse().ok().filter(|frames| (1..=MOST_FRAMES).contains(frames));
    frames.ok_or_else(|| format!("want frames in all, 1 to {MOST_FRAMES}"))
}

/// Seconds of a flight.
pub fn seconds(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|seconds| *seconds > 0.0).ok_or_else(|| "want seconds above 0".into())
}

/// Frames a second.
pub fn fps(text: &str) -> Result<f64, String> {
    let [least, most] = FPS;
    let fps = number(text).ok().filter(|fps| (least..=most).contains(fps));
    fps.ok_or_else(|| format!("want frames a second, from {least} to {most}"))
}

/// `EPSG:N`.
pub fn epsg(text: &str) -> Result<u32, String> {
    let code = text.split_once(':').filter(|(register, _)| register.eq_ignore_ascii_case("EPSG"));
    code.and_then(|(_, code)| code.parse().ok()).ok_or_else(|| "want EPSG:N, for instance EPSG:32611".into())
}

/// Metres of a cell.
pub fn metres(text: &str) -> Result<f64, String> {
    number(text).and_then(|m| if m > 0.0 { Ok(m) } else { Err("want metres above 0".into()) })
}

/// The symbol of a unit.
pub fn elevation_unit(text: &str) -> Result<ElevationUnit, String> {
    let named = ElevationUnit::ALL.into_iter().find(|unit| unit.name() == text);
    named.ok_or_else(|| format!("want {}", ElevationUnit::any()))
}

/// `V`, `A..B`, or several of them with commas between.
pub fn nodata(text: &str) -> Result<Nodata, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    if text.split(',').flat_map(|part| part.split("..")).filter_map(number).any(|number| !number.is_finite()) {
        return Err(
            "what is not finite (nan, inf) is no data already; leave it out, and end ranges with a number".into()
        );
    }
    let range = |part: &str| match part.split_once("..") {
        Some((low, high)) => Some([number(low)?, number(high)?]).filter(|[low, high]| low <= high),
        None => number(part).map(|number| [number; 2]),
    };
    let ranges = text.split(',').map(range).collect::<Option<_>>();
    ranges.map(Nodata::new).ok_or_else(|| "want numbers as the file has them, or ranges A..B with A below B".into())
}

/// `terrain-rgb`, `terrarium`, `signed`, `elevations` or `depths`.
pub fn encoding(text: &str) -> Result<Encoding, String> {
    let known = Encoding::ALL;
    let found = known.into_iter().find(|encoding| encoding.name() == text);
    found.ok_or_else(|| format!("want {}", known.map(Encoding::name).join(", ")))
}

/// `finest` or `given`.
pub fn order(text: &str) -> Result<Order, String> {
    let found = Order::ALL.into_iter().find(|order| order.to_string() == text);
    found.ok_or_else(|| format!("want {}", Order::ALL.map(|order| order.to_string()).join(" or ")))
}

/// `E0,N0,E1,N1`, west before east and south before north.
pub fn crop(text: &str) -> Result<[f64; 4], String> {
    let window: [f64; 4] = numbers(text, "E0,N0,E1,N1 in the CRS of the DEM")?;
    let [west, south, east, north] = window;
    if west != east && south < north { Ok(window) } else { Err("want west,south,east,north in this order".into()) }
}

/// The help of a flag for the pixels of a page.
pub fn size_help(Size { width, height }: Size) -> String {
    format!("Pixels across and down, each from 1 to {LARGEST_PAGE} [default: {width}x{height}]")
}

/// `WxH` in pixels.
pub fn size(text: &str) -> Result<Size, String> {
    let form = || format!("want WxH in pixels, each from 1 to {LARGEST_PAGE}");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(form)?;
    let side = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST_PAGE).contains(n)).ok_or_else(form);
    Ok(Size { width: side(width)?, height: side(height)? })
}

/// `WxH` in samples of a DEM.
pub fn samples(text: &str) -> Result<[usize; 2], String> {
    let form = || format!("want WxH in samples, each from 2 to {MOST_SAMPLES}");
    let (columns, rows) = text.split_once(['x', 'X']).ok_or_else(form)?;
    let side = |text: &str| text.parse().ok().filter(|n| (2..=MOST_SAMPLES).contains(n)).ok_or_else(form);
    Ok([side(columns)?, side(rows)?])
}

/// A level: subdivisions of a cell's edge.
pub fn level(text: &str) -> Result<Level, String> {
    text.parse().ok().and_then(Level::new).ok_or_else(|| "want 1, 2, 4, 8, 16, 32 or 64".into())
}

/// `--level`: one level everywhere, or each chunk at its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelChoice {
    /// Subdivisions of a cell's edge.
    Of(Level),
    /// As fine as the page shows.
    Auto,
}

impl LevelChoice {
    /// How fine facets are where they may deviate by `error_px` on the page.
    pub fn detail(self, error_px: f64) -> Detail {
        match self {
            Self::Of(level) => Detail::Uniform(level),
            Self::Auto => Detail::Adaptive { error_px },
        }
    }

    /// The level of the ground under the eye: chunks that near are fine.
    pub fn near(self) -> Level {
        match self {
            Self::Of(level) => level,
            Self::Auto => Level::EIGHT,
        }
    }

    /// The facets on which places are told: those that are drawn, or the finest, which are the surface itself.
    pub fn told(self) -> Level {
        match self {
            Self::Of(level) => level,
            Self::Auto => Level::FINEST,
        }
    }
}

impl Display for LevelChoice {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Of(level) => level.subdivisions().fmt(to),
            Self::Auto => to.write_str("auto"),
        }
    }
}

/// A level, or `auto`.
pub fn level_choice(text: &str) -> Result<LevelChoice, String> {
    if text == "auto" {
        return Ok(LevelChoice::Auto);
    }
    level(text).map(LevelChoice::Of).map_err(|want| format!("{want}, or auto"))
}

/// How many peaks.
pub fn peaks(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MOST_PEAKS).contains(count));
    count.ok_or_else(|| format!("want how many peaks, from 1 to {MOST_PEAKS}, after the DEM"))
}

/// Largest deviation of facets on the page.
pub fn error_px(text: &str) -> Result<f64, String> {
    number(text).ok().filter(|px| ERRORS_PX.contains(px)).ok_or_else(|| "want pixels, from 0.01 to 100".into())
}

/// Least step in depth, as a share of the distance.
pub fn min_jump(text: &str) -> Result<f64, String> {
    let jump = number(text).ok().filter(|jump| *jump >= 0.0);
    jump.ok_or_else(|| "want a share of the distance, 0 or more, as 0.02 for 2 %".into())
}

/// Room between lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gap {
    /// Pixels of the mask.
    Px(f64),
    /// Millimetres of the page.
    Mm(f64),
}

/// Room between lines, as `.4mm`, `3px` or `3`, which are pixels.
pub fn min_gap(text: &str) -> Result<Gap, String> {
    let within = |text: &str, most: f64| number(text).ok().filter(|gap| (0.0..=most).contains(gap));
    let gap = match text.strip_suffix("mm") {
        Some(text) => within(text, MOST_GAP_MM).map(Gap::Mm),
        None => within(text.strip_suffix("px").unwrap_or(text), MOST_GAP_PX).map(Gap::Px),
    };
    gap.ok_or_else(|| {
        format!("want millimetres, from 0 to {MOST_GAP_MM}, as .4mm, or pixels, from 0 to {MOST_GAP_PX}, as 3px")
    })
}

/// A length on the ground: a number with `m` or `km`.
pub fn distance(text: &str) -> Result<f64, String> {
    let (number_of, unit) = match text.strip_suffix("km") {
        Some(text) => (text, 1000.0),
        None => (text.strip_suffix('m').unwrap_or(text), 1.0),
    };
    let metres = number(number_of).ok().map(|number| number * unit).filter(|metres| *metres >= 0.0);
    metres.ok_or_else(|| "want metres or kilometres, as 10km".into())
}

/// `distance:D,D…`, each a number with `m` or `km`, rising.
pub fn split(text: &str) -> Result<Split, String> {
    let form = "want distance: and distances that rise, as distance:5km,10km";
    let metres = |text: &str| {
        let (text, unit) = match text.strip_suffix("km") {
            Some(text) => (text, 1000.0),
            None => (text.strip_suffix('m')?, 1.0),
        };
        number(text).ok().map(|number| number * unit).filter(|metres| *metres > 0.0)
    };
    let listed = text.strip_prefix("distance:").ok_or(form)?;
    let distances: Vec<f64> = listed.split(',').map(metres).collect::<Option<_>>().ok_or(form)?;
    if !distances.is_sorted_by(|a, b| a < b) {
        return Err(form.into());
    }
    if distances.len() > MOST_DISTANCES {
        return Err(format!("want at most {MOST_DISTANCES} distances"));
    }
    Ok(Split(distances))
}

/// Names of papers, with commas between.
pub fn paper_names() -> String {
    PAPERS.map(|(name, _)| name).join(", ")
}

/// The name of a paper, or `WxH` in millimetres.
pub fn page(text: &str) -> Result<DVec2, String> {
    if let Some((_, size)) = PAPERS.into_iter().find(|(name, _)| name.eq_ignore_ascii_case(text)) {
        return Ok(DVec2::from(size));
    }
    let [least, most] = PAGES_MM;
    let form = || format!("want one of {}, or WxH in millimetres, each from {least} to {most}", paper_names());
    let bare = text.strip_suffix("mm").unwrap_or(text);
    let (width, height) = bare.split_once(['x', 'X']).ok_or_else(form)?;
    let side = |text: &str| number(text).ok().filter(|mm| (least..=most).contains(mm)).ok_or_else(form);
    Ok(DVec2::new(side(width)?, side(height)?))
}

/// Millimetres of a margin.
pub fn margin(text: &str) -> Result<f64, String> {
    let margin = number(text.strip_suffix("mm").unwrap_or(text)).ok().filter(|mm| (0.0..=PAGES_MM[1]).contains(mm));
    margin.ok_or_else(|| format!("want millimetres, from 0 to {}", PAGES_MM[1]))
}

/// `1:N`.
pub fn scale(text: &str) -> Result<f64, String> {
    let [least, most] = SCALES;
    let scale = text.strip_prefix("1:").and_then(|n| number(n).ok()).filter(|n| (least..=most).contains(n));
    scale.ok_or_else(|| format!("want 1:N, N from {least} to {most}, as 1:25000"))
}

/// Pixels an inch.
pub fn dpi(text: &str) -> Result<f64, String> {
    let [least, most] = DPI;
    let dpi = number(text).ok().filter(|dpi| (least..=most).contains(dpi));
    dpi.ok_or_else(|| format!("want pixels an inch, from {least} to {most}"))
}

/// A level of truth.
pub fn truth_level(text: &str) -> Result<Level, String> {
    level(text).ok().filter(|level| *level >= LEAST_TRUTH_LEVEL).ok_or_else(|| "want 8, 16, 32 or 64".into())
}

/// Frames behind a median.
pub fn repeat(text: &str) -> Result<NonZeroU32, String> {
    text.parse().ok().filter(|n: &NonZeroU32| (9..=100).contains(&n.get())).ok_or_else(|| "want 9 to 100 frames".into())
}

/// A method with all it takes, by the name that reports have for it.
pub fn method(text: &str) -> Result<Method, String> {
    let names = Method::ALL.map(|method| method.entry().name).join(", ");
    Method::named(text).ok_or_else(|| format!("want some of {names}"))
}

/// `cpu`, `gpu`, an adapter's number, or words of its name or its bus.
pub fn adapter(text: &str) -> Result<AdapterChoice, String> {
    match text {
        "" => Err("want cpu, gpu, an adapter's number, or words of its name or its bus".into()),
        "cpu" => Ok(AdapterChoice::Cpu),
        "gpu" => Ok(AdapterChoice::Gpu),
        words => Ok(words.parse().map_or_else(|_| AdapterChoice::Named(words.to_owned()), AdapterChoice::Number)),
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
