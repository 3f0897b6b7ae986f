//! The page with other lines of the land than it has: drawn, so that no flag is told untried.
//!
//! Cost: a page without hachures for each trial, and a search for creases of the DEM where the cache has none.

use std::sync::Arc;

use glam::DVec2;

use super::PickArguments;
use super::cause::Rule;
use super::found::{self, Found, PickedPage};
use super::remedy::{SAME, down};
use super::station::Station;
use crate::cache::Cache;
use crate::cli::talk::Talk;
use crate::cli::words::short;
use crate::error::Result;
use crate::line::Line;
use crate::plan::{Curves, LandLines, Plan};
use crate::relief::{ChannelArea, Crease, LandWanted};
use crate::render::{Illustration, Renderer};
use crate::surface::Surface;

/// Shares of the land above a place with which channels are tried to begin: one that begins just there may be too short.
const HEADS: [f64; 2] = [1.0, 0.25];
/// By so much finer than they are channels are tried: the finer, the more of them are looked for on the whole DEM.
const FINEST: f64 = 16.0;

/// A page whose lines of the land are to be others.
pub(super) struct Trials<'a> {
    pub arguments: &'a PickArguments,
    pub illustration: &'a Illustration,
    pub renderer: Renderer,
    pub station: &'a Station<'a>,
    pub surface: &'a Arc<Surface>,
    pub cache: &'a Cache,
    pub talk: &'a Talk,
    /// The middle of the pixel that is asked about.
    pub middle: DVec2,
}

impl Trials<'_> {
    /// Flags that together draw a line which lies so far off and was left out since nobody asked for its kind, if any do.
    ///
    /// # Errors
    /// As [`Renderer::page`] and [`found::lines`].
    pub(super) fn with_crease(&mut self, crease: Crease, line: Line, px: f64) -> Result<Option<String>> {
        let mut creases = [&self.illustration.land.creases[..], &[crease]].concat();
        creases.sort_unstable();
        let names: Vec<&str> = creases.iter().map(|crease| crease.name()).collect();
        let flag = format!("--creases {}", names.join(","));
        let found = self.found(LandWanted { creases, ..self.illustration.land.clone() })?;
        let same = found.iter().filter(|found| found.line == line && (found.px - px).abs() <= SAME);
        Ok(beside(flag, same))
    }

    /// Flags that together draw a stream about the pixel, where water gathers from `here` and channels begin with `channels` square
    /// metres, if any do.
    ///
    /// # Errors
    /// As [`Self::with_crease`].
    pub(super) fn with_channels(&mut self, here: f64, channels: f64) -> Result<Option<String>> {
        for area in HEADS.map(|share| down(here * share)).into_iter().filter(|area| area * FINEST >= channels) {
            let channel_area = ChannelArea::SquareMetres(area);
            let found = self.found(LandWanted { channel_area, ..self.illustration.land.clone() })?;
            let streams = found.iter().filter(|found| found.line == Line::Drainage);
            if let Some(flags) = beside(format!("--channel-area {}m2", short(area)), streams) {
                return Ok(Some(flags));
            }
        }
        Ok(None)
    }

    /// The lines about the pixel, were these lines of the land drawn.
    fn found(&mut self, wanted: LandWanted) -> Result<Vec<Found>> {
        let (drawing, terrain) = (&self.arguments.drawing, &self.arguments.terrain);
        let wanted = LandWanted { slopes: None, ..wanted };
        let (exaggeration, remote) = (drawing.exaggeration, terrain.allows_remote());
        let land = drawing.land.land(&wanted, self.surface, exaggeration, remote, self.cache, &self.talk.hushed())?;
        self.renderer.set_land(Some(Arc::new(land)));
        let plan = Plan { curves: Curves::On, land: LandLines::On, hachures: None, ..self.illustration.plan };
        let page = self.renderer.page(&plan, &self.station.view.camera, |_| ())?;
        let illustration = Illustration { plan, land: wanted, ..self.illustration.clone() };
        let (lines, drawn) = illustration.drawing(&page)?;
        let (illustration, page, lines, drawn) = (&illustration, &page, &lines, &drawn);
        found::lines(&PickedPage { illustration, page, lines, hidden: &[], drawn, middle: self.middle }, self.station)
    }
}

/// A flag with those that it takes beside it to draw one of these lines; `None` where none is known to.
fn beside<'a>(flag: String, lines: impl Iterator<Item = &'a Found> + Clone) -> Option<String> {
    if lines.clone().any(|found| found.rule.is_drawn()) {
        return Some(flag);
    }
    let is_of_economy = |rule: &Rule| matches!(rule, Rule::MinJump { .. } | Rule::Length { .. } | Rule::MinGap { .. });
    let mut more = lines.filter(|found| is_of_economy(&found.rule)).filter_map(|found| found.flags.as_ref());
    more.next().map(|more| format!("{flag} {more}"))
}
