//! Lines that were never found for a drawing, since a rule left them out before: creases that the page does not show or nobody asked
//! for, the border, streams of too little land.

use glam::{DVec2, DVec3};

use super::cause::Rule;
use super::found::{Found, PickedPage, REACH};
use super::place::HiddenBy;
use super::station::Station;
use super::trial::Trials;
use crate::error::Result;
use crate::line::detail::From;
use crate::line::near::share_nearest;
use crate::line::{Land, Line};
use crate::plan::Border;
use crate::relief::{Crease, Gathered, LandWanted, LineKind, spacing};
use crate::surface::Met;
use crate::surface::rim::rim;
use crate::view::Perspective;

/// A line of the land that runs within so many samples of a place may be that of the water there.
const BESIDE: f64 = 2.0;

/// The lines of an answer, beside those that were found.
///
/// # Errors
/// As [`LandArguments::land`](crate::cli::land::LandArguments::land), [`rim`],
/// [`Gathered::at`] and [`Trials::with_crease`].
pub(super) fn lines(
    page: &PickedPage,
    station: &Station,
    met: Option<&Met>,
    trials: &mut Trials,
) -> Result<Vec<Found>> {
    let plan = &page.page.frame.plan;
    let mut found = border(page, station).unwrap_or_else(|| Ok(Vec::new()))?;
    if !plan.has_curves() {
        return Ok(found);
    }
    let asked = &page.illustration.land;
    let (drawing, surface) = (&trials.arguments.drawing, trials.surface);
    let all = LandWanted { creases: Crease::ALL.to_vec(), slopes: None, ..asked.clone() };
    let remote = trials.arguments.terrain.allows_remote();
    let land = drawing.land.land(&all, surface, drawing.exaggeration, remote, trials.cache, &trials.talk.hushed())?;
    found.extend(creases(&land, page, station)?);
    for crease in Crease::ALL {
        let of_kind =
            found.iter_mut().filter(|found| matches!(found.rule, Rule::Creases(unasked) if unasked == crease));
        // Of each kind the nearest is told.
        if let Some(nearest) = of_kind.min_by(|a, b| a.px.total_cmp(&b.px)) {
            nearest.flags = trials.with_crease(crease, nearest.line, nearest.px)?;
        }
    }
    let is_asked = asked.creases.contains(&Crease::Drainage);
    if let Some(met) = met.filter(|_| is_asked && !found.iter().any(|found| found.line == Line::Drainage)) {
        found.extend(no_stream(&land, page, trials, met)?);
    }
    Ok(found)
}

/// Why no stream runs where land was met; `None` where one runs beside.
fn no_stream(land: &Land, page: &PickedPage, trials: &mut Trials, met: &Met) -> Result<Option<Found>> {
    let (dem, exaggeration) = (trials.surface.dem(), trials.arguments.drawing.exaggeration);
    let at = dem.grid_place(met.place.truncate());
    let is_beside = || {
        let mut streams = land.iter().filter(|(line, _)| line.kind == LineKind::Drainage);
        streams.any(|(line, _)| line.points.iter().any(|point| point.at.distance(at) < BESIDE * spacing(dem) as f64))
    };
    let gathered = Gathered::at(dem, exaggeration, page.illustration.land.channel_area, at)?;
    let (rule, flags) = match gathered {
        Some(Gathered::Sea) => (Rule::Sea, None),
        Some(Gathered::Land { here, channels }) if here < channels => {
            (Rule::ChannelArea { here, channels }, trials.with_channels(here, channels)?)
        }
        Some(Gathered::Land { here, channels }) if !is_beside() => (Rule::Pruned { here, channels }, None),
        Some(Gathered::Land { .. }) | None => return Ok(None),
    };
    Ok(Some(Found { flags, ..of(Line::Drainage, 0.0, met.place, rule) }))
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

/// Lines of the land about the pixel that were left out before anybody looked whether the eye sees them, and those that it does not;
/// those that nobody asked for without flags.
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
        let unasked = asked_for.filter(|crease| !page.illustration.land.creases.contains(crease));
        let is_shown = pair.iter().any(|i| shown[number].get(*i).is_some_and(|weight| *weight > 0.0));
        let is_seen = is_seen(station, place)?;
        let lack = || land.lack(number, pair[0], from);
        let rule = match (unasked, is_shown, is_seen) {
            (None, true, false) => Rule::Hidden(hidden_by(station, place)?),
            (None, false, true) => lack().map_or(Rule::FlatWater, Rule::Detail),
            (Some(crease), true, true) => Rule::Creases(crease),
            // What is shown and seen was found; what no page shows is not worth a word.
            (None, true, true) | (None, false, false) | (Some(_), ..) => continue,
        };
        // Of what lies on the land nothing is drawn that is hidden.
        let flags = if let Rule::Hidden(_) = rule { None } else { rule.flags() };
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
