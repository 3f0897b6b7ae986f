//! `hachure draw --plan`: the land from straight above, true to scale.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use serde::Serialize;

use super::bare;
use super::draw::DrawArguments;
use super::draw_report::{DemReport, LayerReport, PageReport};
use super::furniture;
use super::georeferenced;
use super::journey;
use super::page::{Layout, MARGIN};
use super::scene;
use super::talk::Talk;
use super::terrain::warn_of_survey;
use super::values::{PAGES_MM, Size};
use crate::dem::Dem;
use crate::error::{Error, Result, Setting};
use crate::files::Taken;
use crate::ink::strokes::inset;
use crate::ink::{self, Drawing, Sheet, Style, Surround};
use crate::line::hachures::NEAR;
use crate::line::{Land, Lines, Overhead};
use crate::message;
use crate::plan::Hachures;
use crate::relief::{LandWanted, Slopes};

/// Millimetres of a metre.
const MM: f64 = 1000.0;

/// `--json` of a plan.
#[derive(Serialize)]
struct PlanReport {
    version: &'static str,
    dem: DemReport,
    scale: f64,
    page: PageReport,
    layers: Vec<LayerReport>,
    /// West, south, east and north of the page less its margins, metres of the DEM's CRS.
    area_m: [f64; 4],
    lines: usize,
}

/// A plan, drawn.
pub(crate) struct Planned {
    /// Its strokes.
    pub drawing: Drawing,
    /// Pixels of pictures for each millimetre.
    pub px_per_mm: f64,
    style: Style,
    layout: Layout,
    lines: Lines,
}

/// Whether what is asked of a plan goes together.
///
/// # Errors
/// [`Error::Setting`]; as [`styles::find`](crate::ink::styles::find).
pub(crate) fn check(arguments: &DrawArguments) -> Result<(Style, LandWanted)> {
    arguments.outputs.check()?;
    if arguments.outputs.want_mask() {
        let what = "a mask is of what an eye sees, and a plan has none";
        return Err(Error::setting(Setting::Mask, what, message!["leave out ", Setting::Mask, " or ", Setting::Plan]));
    }
    let mut style = arguments.drawing.style.style()?;
    // The corners of the rim do as well.
    style.plot.registration = false;
    let land = arguments.drawing.land.wanted(&style, arguments.terrain.allows_remote())?;
    Ok((style, land))
}

/// Draws the plan of a DEM: no GPU, no view.
///
/// # Errors
/// As [`check`] and [`Overhead::land`]; [`Error::Setting`] for a scale that fits no page.
pub(crate) fn draw(
    arguments: &DrawArguments,
    scale: f64,
    dem: &Dem,
    land: Option<&Land>,
    talk: &Talk,
) -> Result<Planned> {
    let (style, wanted) = check(arguments)?;
    let area = arguments.area.unwrap_or(dem.extent());
    let layout = layout(area, scale, &style, arguments)?;
    let texts = furniture::of_plan(scale, area, &arguments.terrain.dems, dem)?;
    let furniture = arguments.drawing.furniture.furniture().set(&layout.sheet, &style, &texts)?;
    let frame = [layout.frame.width, layout.frame.height];
    let px_per_mm = layout.sheet.placement(frame).px_per_mm;
    let economy = arguments.drawing.style.economy(&style, px_per_mm);
    let overhead = Overhead { area, size: frame, px_per_metre: px_per_mm * MM / scale };
    let mut lines = Lines { own: wanted.own_layers, ..overhead.lines(dem)? };
    let hachures = style.hachures(px_per_mm).map(Hachures::on_map);
    if let Some(land) = land {
        let least = land.slopes().map(Slopes::least_spacing).zip(hachures.as_ref());
        if least.is_some_and(|(least, look)| look.least_apart() / overhead.px_per_metre < NEAR[1] * least) {
            talk.warn(bare::PLAN);
        }
        lines.chains.extend(overhead.land(land, economy.min_gap, hachures.as_ref())?);
    }
    let mut drawing = ink::draw(&lines, &layout.sheet, &style, &[])?;
    furniture.onto(&mut drawing, &style);
    Ok(Planned { drawing, px_per_mm: layout.px_per_mm, style, layout, lines })
}

/// Reads a DEM, draws its plan and writes it.
///
/// # Errors
/// Whatever went wrong; nothing stands under a final name then.
pub(crate) fn run(arguments: &DrawArguments, scale: f64, talk: &Talk) -> Result<()> {
    let (_, wanted) = check(arguments)?;
    let started = Instant::now();
    let cache = arguments.cache.cache();
    let (reading, beside) = (arguments.open(cache.clone())?, arguments.drawing.land.lines.files());
    let inputs = reading.files().chain(beside.iter().map(PathBuf::as_path));
    let mut outputs = arguments.outputs.open(Taken::inputs(inputs))?;
    let surface = Arc::new(scene::surface(&arguments.terrain, reading, &cache, talk)?);
    let dem = surface.dem();
    let map = outputs.map_format().map(|format| georeferenced::crs(format, dem)).transpose()?;
    warn_of_survey(dem, talk)?;
    dem.check_patches()?;
    let land = scene::land(&arguments.drawing, &wanted, &arguments.terrain, &surface, &cache, talk)?;
    let Planned { drawing, px_per_mm, style, layout, lines } = draw(arguments, scale, dem, land.as_deref(), talk)?;
    let report = PlanReport {
        version: env!("CARGO_PKG_VERSION"),
        dem: DemReport::of(&arguments.terrain.dems, dem),
        scale,
        page: PageReport::of(&layout.sheet, [layout.frame.width, layout.frame.height]),
        layers: LayerReport::all(&drawing, &style.plot),
        area_m: dem.extent(),
        lines: lines.chains.len(),
    };
    outputs.write(&drawing, px_per_mm, None, Some(&report))?;
    if let Some(crs) = map {
        let exaggeration = arguments.drawing.exaggeration;
        let lines = georeferenced::lines(&lines, land.as_deref(), &surface, exaggeration, &crs)?;
        outputs.write_map(&crs, &lines)?;
    }
    dem.check()?;
    outputs.publish()?;
    journey::tell(&drawing, &style.plot, talk)?;
    talk.say(&format!(
        "{}: {} lines at 1:{scale}, {:.0} x {:.0} mm, {:.2} s",
        arguments.outputs.drawing(),
        lines.chains.len(),
        layout.sheet.size.x,
        layout.sheet.size.y,
        started.elapsed().as_secs_f64()
    ))
}

/// The page that is this part of the DEM's world at that scale, with margins, in which lies so much that a pen takes to draw the border,
/// and with room for furniture.
fn layout(area: [f64; 4], scale: f64, style: &Style, arguments: &DrawArguments) -> Result<Layout> {
    let pen = inset(style.broadest()) + style.wobble.reach;
    let ([west, south, east, north], margin) = (area, arguments.drawing.page.margin().unwrap_or(MARGIN));
    let area = DVec2::new(east - west, north - south) * (MM / scale);
    let margin = margin.max(pen);
    let sheet = Sheet { size: area + 2.0 * margin, margin: margin - pen, surround: Surround::NONE };
    let [least, most] = PAGES_MM;
    if 2.0 * margin + least > most {
        let what = format!("margins of {margin} mm leave nothing of a page of {most} mm");
        return Err(Error::setting(Setting::Margin, what, message!["use a smaller ", Setting::Margin]));
    }
    let fits = |side: f64| side / (most - 2.0 * margin) * scale;
    if sheet.size.max_element() > most {
        let room = most - 2.0 * margin;
        let what = format!("the DEM is {:.0} x {:.0} mm at 1:{scale}, over {room:.0}", area.x, area.y);
        let least = format!("1:{:.0}", fits(area.max_element()).ceil());
        return Err(Error::setting(
            Setting::Scale,
            what,
            message!["use ", Setting::Scale.at(least), " or a ", Setting::Crop],
        ));
    }
    if area.min_element() < least {
        let what = format!("the DEM is {:.2} x {:.2} mm at 1:{scale}, under {least}", area.x, area.y);
        let most = format!("1:{:.0}", (area.min_element() / least * scale).floor().max(1.0));
        return Err(Error::setting(Setting::Scale, what, message!["use ", Setting::Scale.at(most)]));
    }
    let furniture = arguments.drawing.furniture.furniture();
    let sheet = match furniture.is_none() {
        true => sheet,
        false => sheet.surrounded(margin, furniture.around(sheet.inner(), style)?),
    };
    let frame = sheet.frame(Sheet::FRAME_PX_PER_MM);
    let layout = Layout {
        sheet,
        frame: Size { width: frame[0], height: frame[1] },
        px_per_mm: arguments.drawing.page.px_per_mm(),
    };
    if arguments.outputs.want_picture() {
        layout.check_picture()?;
    }
    Ok(layout)
}
