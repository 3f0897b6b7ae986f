//! Lines that were never found for a drawing, since a rule left them out before: creases that the page does not show or nobody asked
//! for, the border, streams of too little land.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::PickArguments;
use super::cause::Rule;
use super::found::{Found, PickedPage, REACH};
use super::place::HiddenBy;
use super::station::Station;
use crate::cache::Cache;
use crate::cli::talk::Talk;
use crate::error::Result;
use crate::line::detail::From;
use crate::line::near::share_nearest;
use crate::line::{Land, Line};
use crate::plan::Border;
use crate::relief::{Crease, Gathered, LandWanted, LineKind};
use crate::surface::rim::rim;
use crate::surface::{Met, Surface};
use crate::view::Perspective;

/// The lines of an answer, beside those that were found.
///
/// # Errors
/// As [`LandArguments::land`](crate::cli::land::LandArguments::land), [`rim`] and [`Gathered::at`].
pub(super) fn lines(
    arguments: &PickArguments,
    page: &PickedPage,
    station: &Station,
    met: Option<&Met>,
    surface: &Arc<Surface>,
    cache: &Cache,
    talk: &Talk,
) -> Result<Vec<Found>> {
    let plan = &page.page.frame.plan;
    let mut found = border(page, station).unwrap_or_else(|| Ok(Vec::new()))?;
    if !plan.has_curves() {
        return Ok(found);
    }
    let asked = &page.illustration.land;
    let exaggeration = arguments.drawing.exaggeration;
    // Shores are looked for among samples in memory.
    let known = Crease::ALL.into_iter().filter(|crease| *crease != Crease::Shores || !surface.dem().is_filed());
    let all = LandWanted { creases: known.collect(), slopes: None, ..asked.clone() };
    let remote = arguments.terrain.allows_remote();
    let land = arguments.drawing.land.land(&all, surface, exaggeration, remote, cache, &talk.hushed())?;
    found.extend(creases(&land, page, station)?);
    let is_asked = asked.creases.contains(&Crease::Drainage);
    if let Some(met) = met.filter(|_| is_asked && !found.iter().any(|found| found.line == Line::Drainage)) {
        let at = surface.dem().grid_place(met.place.truncate());
        let gathered = Gathered::at(surface.dem(), exaggeration, asked.channel_area, at)?;
        if let Some(Gathered { here, channels }) = gathered.filter(|gathered| gathered.here < gathered.channels) {
            found.push(of(Line::Drainage, 0.0, met.place, Rule::ChannelArea { here, channels }));
        }
    }
    Ok(found)
}

/// A line that has no chain.
fn of(line: Line, px: f64, world: DVec3, rule: Rule) -> Found {
    let flags = rule.flags();
    Found { line, id: None, px, covers: false, world, rule, flags }
}

/// The visible rim about the pixel, where the border is not drawn.
fn border(page: &PickedPage, station: &Station) -> Option<Result<Vec<Found>>> {
    (page.page.frame.plan.border == Border::Off).then(|| {
        let dem = station.surface.dem();
        let ends = |sample: [u32; 2], direction: u32| {
            let step = [[1, 0], [0, 1], [1, 1]][direction as usize];
            let [a, b] = [sample, [sample[0] + step[0], sample[1] + step[1]]];
            [a, b].map(|[c, r]| dem.position(c as usize, r as usize))
        };
        let mut nearest: Vec<(f64, DVec3)> = rim(dem)?
            .iter()
            .filter_map(|edge| nearest(&page.page.perspective, page.middle, ends(edge.sample, edge.direction)))
            .collect();
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (px, place) in nearest {
            if is_seen(station, place)? {
                return Ok(vec![of(Line::Border, px, place, Rule::Border)]);
            }
        }
        Ok(Vec::new())
    })
}

/// Lines of the land about the pixel that were left out before anybody looked whether the eye sees them, and those that it does not.
fn creases(land: &Land, page: &PickedPage, station: &Station) -> Result<Vec<Found>> {
    let perspective = &page.page.perspective;
    let from = From::Eye(perspective.eye(), perspective.focal());
    let shown = land.shown(from);
    let mut found = Vec::new();
    for (number, (line, world)) in land.iter().enumerate() {
        let closing = (line.closed).then(|| [world.len() - 1, 0]);
        let pairs = (1..world.len()).map(|i| [i - 1, i]).chain(closing);
        let near = |pair: [usize; 2]| Some((nearest(perspective, page.middle, pair.map(|i| world[i]))?, pair));
        let nearest = pairs.filter_map(near).min_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let Some(((px, place), pair)) = nearest else { continue };
        let (kind, asked_for) = named(line.kind);
        let is_asked = asked_for.is_none_or(|crease| page.illustration.land.creases.contains(&crease));
        let is_shown = pair.iter().any(|i| shown[number].get(*i).is_some_and(|weight| *weight > 0.0));
        let is_seen = is_seen(station, place)?;
        let lack = || land.lack(number, pair[0], from);
        let rule = match (is_asked, is_shown, is_seen) {
            (true, true, false) => Rule::Hidden(hidden_by(station, place)?),
            (true, false, true) => lack().map_or(Rule::FlatWater, Rule::Detail),
            (false, true, true) => Rule::Creases(asked_for.map_or("", Crease::name)),
            // What is shown and seen was found; what no page shows is not worth a word.
            (true, true, true) | (true, false, false) | (false, ..) => continue,
        };
        let flags = match rule {
            // Of what lies on the land nothing is drawn that is hidden.
            Rule::Hidden(_) => None,
            Rule::Creases(name) => {
                let drawn = page.illustration.land.creases.iter().map(|crease| crease.name());
                Some(format!("--creases {}", drawn.chain([name]).collect::<Vec<_>>().join(",")))
            }
            _ => rule.flags(),
        };
        found.push(Found { flags, ..of(kind, px, place, rule) });
    }
    Ok(found)
}

/// What draws a kind of line, and what has to be asked for it.
fn named(kind: LineKind) -> (Line, Option<Crease>) {
    match kind {
        LineKind::Shore => (Line::Shore, Some(Crease::Shores)),
        LineKind::Drainage => (Line::Drainage, Some(Crease::Drainage)),
        LineKind::Ridge => (Line::Ridge, Some(Crease::Ridges)),
        LineKind::Own(layer) => (Line::Own(layer), None),
    }
}

/// How far off the middle of a pixel a piece of a line passes, px, and where; `None` beyond reach and behind the eye.
fn nearest(perspective: &Perspective, middle: DVec2, [a, b]: [DVec3; 2]) -> Option<(f64, DVec3)> {
    let is_before = |end: DVec3| perspective.distance(end) > perspective.near();
    if !is_before(a) || !is_before(b) {
        return None;
    }
    let [(start, near), (end, far)] = [a, b].map(|end| perspective.project(end));
    let share = share_nearest(start, end, middle);
    let px = start.lerp(end, share).distance(middle);
    // Depth is linear on the page, the way through the world is not.
    (px <= REACH).then(|| (px, a.lerp(b, share * far / (near + (far - near) * share))))
}

/// Whether the eye sees the land at a place of the map, were it on its surface.
fn is_seen(station: &Station, place: DVec3) -> Result<bool> {
    Ok(station.hides(on_land(station, place)?)?.is_none())
}

fn hidden_by(station: &Station, place: DVec3) -> Result<Option<HiddenBy>> {
    let place = on_land(station, place)?;
    station.hides(place)?.map(|met| station.hidden_by(&met, place)).transpose()
}

/// The land at a place of the map; the place itself at the rim, which patches may leave.
fn on_land(station: &Station, place: DVec3) -> Result<DVec3> {
    Ok(station.below(place.truncate())?.map_or(place, |met| met.place))
}
