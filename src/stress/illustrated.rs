//! A page with creases and hachures as the default style draws it, and every bit of it.

use std::sync::Arc;

use super::drawing::{plan, words};
use crate::error::Result;
use crate::ink::{self, Drawing, Sheet, Style};
use crate::line::Land;
use crate::measure::curves::mask_of;
use crate::plan::{Curves, Detail, LandLines, Method, Plan};
use crate::relief::{ChannelArea, Relief, Slopes, append};
use crate::render::{Page, Renderer};
use crate::surface::Surface;
use crate::view::Camera;

/// Drainage, ridges and slope lines, as the default style's hachures have them.
///
/// # Errors
/// As [`Relief::of`], [`Relief::ridges`], [`Slopes::new`] and [`Land::new`].
pub fn land_of(surface: &Arc<Surface>) -> Result<Land> {
    let relief = Relief::of(surface.dem(), 1.0)?;
    let mut lines = relief.drainage(ChannelArea::Auto);
    append(&mut lines, relief.ridges()?);
    let slopes = Style::default().hachures.rules().map(|rules| Slopes::new(surface.clone(), 1.0, rules, &lines, None));
    let land = Land::new(surface.dem(), 1.0, lines)?;
    Ok(match slopes.transpose()? {
        Some(slopes) => land.with_slopes(Arc::new(slopes)),
        None => land,
    })
}

/// A page with creases and hachures, as the default style draws it.
///
/// # Errors
/// As [`Renderer::page`] and [`ink::draw`].
pub fn illustrated(
    renderer: &mut Renderer,
    land: &Arc<Land>,
    detail: Detail,
    camera: &Camera,
) -> Result<(Page, Drawing)> {
    let (style, sheet) = (Style::default(), Sheet::for_frame([camera.width, camera.height]));
    let px_per_mm = sheet.placement([camera.width, camera.height]).px_per_mm;
    let hachures = style.hachures(px_per_mm);
    let plan = Plan { curves: Curves::On, land: LandLines::On, hachures, ..plan(detail, Method::Walk) };
    renderer.set_land(Some(land.clone()));
    let page = renderer.page(&plan, camera, |_| ());
    renderer.set_land(None);
    let page = page?;
    let lines = page.lines(&style.economy(px_per_mm), style.tolerance * px_per_mm);
    let drawing = ink::draw(&lines, &sheet, &style, &[])?;
    Ok((page, drawing))
}

/// The nearest facet of each pixel of such a page and its depth, as the device holds them.
///
/// # Errors
/// As [`Gpu::read`](crate::gpu::Gpu::read).
pub fn pixels(renderer: &Renderer, camera: &Camera) -> Result<Vec<[u32; 2]>> {
    let pixels = camera.width as usize * camera.height as usize;
    renderer.gpu().read(renderer.on_device().buffer("pixels")?, pixels)
}

/// All that is known of such a page, bit for bit.
///
/// # Errors
/// As [`illustrated`] and [`pixels`].
pub fn bits(renderer: &mut Renderer, land: &Arc<Land>, detail: Detail, camera: &Camera) -> Result<Vec<u64>> {
    let (page, drawing) = illustrated(renderer, land, detail, camera)?;
    let pixels = pixels(renderer, camera)?.into_iter();
    let mut bits: Vec<u64> = pixels.map(|[facet, depth]| u64::from(facet) << 32 | u64::from(depth)).collect();
    let ink = mask_of(&page.marks, renderer.near()).inked.into_iter();
    bits.extend(ink.flat_map(|p| [u64::from(p.column) << 32 | u64::from(p.row), p.distance.to_bits()]));
    bits.extend(words(&page.chains));
    bits.extend(words(&page.land));
    for layer in &drawing.layers {
        bits.push(layer.strokes.len() as u64);
        for stroke in &layer.strokes {
            bits.push(stroke.points.len() as u64);
            bits.extend(stroke.points.iter().flat_map(|p| [p.place.x, p.place.y, p.width]).map(f64::to_bits));
        }
    }
    Ok(bits)
}
