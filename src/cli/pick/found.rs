//! The lines that were found about a pixel: which are drawn, and which rule left the others out.

use glam::{DVec2, DVec3};

use super::cause::{FINEST, LineAnswer, Rule};
use super::remedy::{self, DRAWN};
use super::station::Station;
use crate::cli::words::short;
use crate::error::Result;
use crate::ink::{Drawing, InkedNear};
use crate::line::{Chain, ChainPoint, Economy, Id, Line, Lines, Merit, Near, merits, near};
use crate::render::{self, Illustration};
use crate::surface::Met;

/// How far about a pixel lines are told of, px.
pub(super) const REACH: f64 = 8.0;
/// A stroke may lie so far off its chain, px, beside what a hand strays.
const OFF_CHAIN: f64 = 1.5;
/// From this share of its weight on a line counts as whole.
const WHOLE: f64 = 0.99;
/// A pen's least width that is inside the margins, px from the edge of the frame.
const EDGE: f64 = 2.0;

/// A page with its lines and its drawing, and the middle of the pixel that is asked about.
pub(super) struct PickedPage<'a> {
    pub illustration: &'a Illustration,
    pub page: &'a render::Page,
    pub lines: &'a Lines,
    /// Hidden chains, drawn or not.
    pub hidden: &'a [Chain],
    pub drawn: &'a Drawing,
    pub middle: DVec2,
}

/// A line about the pixel.
pub(super) struct Found {
    pub line: Line,
    pub id: Option<Id>,
    /// From the middle of the pixel to it.
    pub px: f64,
    /// Whether its ink lies on the pixel.
    pub covers: bool,
    pub world: DVec3,
    pub rule: Rule,
    pub flags: Option<String>,
}

/// The lines that were found, drawn and left out.
///
/// # Errors
/// As [`Station::hides`] and [`Illustration::drawing`].
pub(super) fn lines(page: &PickedPage, station: &Station) -> Result<Vec<Found>> {
    let PickedPage { illustration, lines, hidden, middle, .. } = page;
    let stray = page.stray();
    let inks = page.drawn.inked_near(illustration.frame, *middle, REACH + stray);
    let near_lines = near(&lines.chains, *middle, REACH);
    let competing = match page.page.frame.plan.has_curves() {
        true => page.page.competing(&illustration.economy, illustration.tolerance()),
        false => Vec::new(),
    };
    let lowered = near_lines.iter().filter(|near| near.chain < competing.len() && f64::from(near.point.weight) < WHOLE);
    let places: Vec<(usize, DVec2)> = lowered.map(|near| (near.chain, near.point.place)).collect();
    let merits = merits(&competing, &illustration.economy, &places);
    let merit = |near: &Near| places.iter().position(|(chain, _)| *chain == near.chain).map(|number| &merits[number]);
    let mut found = Vec::new();
    for near in &near_lines {
        let chain = &lines.chains[near.chain];
        let lowered = merit(near).and_then(|merit| page.lowered(near, merit));
        let ink = stroke_of(&inks, chain.id, near.px + stray);
        // Hachures are many, and those without width are told by none.
        let ink = ink.filter(|ink| ink.width > 0.0 || near.point.line != Line::Hachure);
        let rule = match (ink, lowered) {
            // What is faded so far that nobody sees it is left out; where ends taper, it is drawn all the same.
            (Some(ink), Some(rule)) if ink.width < FINEST && near.point.weight < DRAWN => Some((rule, false)),
            (Some(ink), faded) => Some((drawn(ink, faded, near.point.weight), covers(ink))),
            (None, Some(rule)) => Some((rule, false)),
            (None, None) => page.unstroked(near).map(|rule| (rule, false)),
        };
        let Some((rule, covers)) = rule else { continue };
        let flags = remedy::flags(&rule, page, &competing, near)?;
        found.push(Found::of(near, chain.id, covers, rule, flags));
    }
    for near in near(hidden, *middle, REACH) {
        let id = hidden[near.chain].id;
        let (rule, covers) = match stroke_of(&inks, id, near.px + stray) {
            Some(ink) => (drawn(ink, None, near.point.weight), covers(ink)),
            None => {
                let by = station.hides(near.point.world)?;
                let by = by.map(|met| station.hidden_by(&met, near.point.world)).transpose()?;
                (Rule::Hidden(by), false)
            }
        };
        let flags = rule.flags();
        found.push(Found::of(&near, id, covers, rule, flags));
    }
    Ok(found)
}

/// The nearest stroke of a chain that far off.
fn stroke_of<'a, 'd>(inks: &'a [InkedNear<'d>], chain: Option<Id>, px: f64) -> Option<&'a InkedNear<'d>> {
    let of_chain = inks.iter().filter(|ink| ink.chain == chain && ink.px <= px);
    of_chain.min_by(|a, b| a.px.total_cmp(&b.px))
}

/// Whether the ink of a stroke lies on the pixel.
fn covers(ink: &InkedNear) -> bool {
    ink.px <= ink.half_px.max(0.5) + 0.5
}

fn drawn(ink: &InkedNear, faded: Option<Rule>, weight: f32) -> Rule {
    Rule::Drawn { layer: ink.layer.to_owned(), width_mm: ink.width, faded: faded.map(Box::new), weight: weight.into() }
}

impl PickedPage<'_> {
    /// How far off its chain a stroke may lie, px.
    fn stray(&self) -> f64 {
        let Illustration { style, frame, .. } = self.illustration;
        let px_per_mm = self.drawn.sheet.placement(*frame).px_per_mm;
        OFF_CHAIN + (style.wobble.reach + style.tolerance) * px_per_mm
    }

    /// Whether a stroke draws a chain at a place of the page, were economy another.
    ///
    /// # Errors
    /// As [`Illustration::drawing`].
    pub(super) fn draws(&self, economy: Economy, chain: Option<Id>, place: DVec2) -> Result<bool> {
        let illustration = Illustration { economy, ..self.illustration.clone() };
        let (_, drawn) = illustration.drawing(self.page)?;
        let inks = drawn.inked_near(illustration.frame, place, self.stray());
        Ok(stroke_of(&inks, chain, self.stray()).is_some())
    }

    /// Which rule lowers the weight of a line most, if one does.
    fn lowered(&self, near: &Near, merit: &Merit) -> Option<Rule> {
        let economy = &self.illustration.economy;
        let min_gap = economy.min_gap;
        let ChainPoint { line, .. } = near.point;
        // What lies on the land has no jump.
        let jump = (!line.is_of_land() && merit.by_jump < WHOLE)
            .then(|| (merit.by_jump, Rule::MinJump { jump: near.point.jump().max(0.0), min_jump: economy.min_jump }));
        let length = (merit.by_length < WHOLE)
            .then_some((merit.by_length, Rule::Length { length: merit.length, asked: merit.lengths, min_gap }));
        let gap = merit.yields.filter(|yields| yields.left < WHOLE).map(|yields| {
            let other = &self.lines.chains[yields.to];
            (
                yields.left,
                Rule::MinGap { to: called(other.line(), other.id, &self.lines.own), apart: yields.apart, min_gap },
            )
        });
        let lowest = [jump, length, gap].into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
        lowest.map(|(_, rule)| rule)
    }

    /// Why no stroke draws a line that has weight.
    fn unstroked(&self, near: &Near) -> Option<Rule> {
        let ChainPoint { place, weight, line, .. } = near.point;
        if weight <= 0.0 || line == Line::Hachure {
            return None;
        }
        let size = DVec2::new(self.lines.width.into(), self.lines.height.into());
        let at_edge = place.cmplt(DVec2::splat(EDGE)).any() || place.cmpgt(size - EDGE).any();
        Some(if at_edge { Rule::Margin } else { Rule::Pens { weight: weight.into() } })
    }
}

impl Found {
    fn of(near: &Near, id: Option<Id>, covers: bool, rule: Rule, flags: Option<String>) -> Self {
        let ChainPoint { line, world, .. } = near.point;
        let flags = flags.or_else(|| rule.flags());
        Self { line, id, px: near.px, covers, world, rule, flags }
    }

    /// In which order lines are told: what is drawn on the pixel, what the eye would see, what it would not.
    fn rank(&self) -> (u8, f64) {
        match &self.rule {
            _ if self.covers => (0, self.px),
            Rule::Hidden(_) => (2, self.px),
            rule if !rule.has_line() => (4, 0.0),
            _ => (1, self.px),
        }
    }
}

/// The lines in the order of telling, of each kind and rule the nearest, and why no silhouette is there where none is.
///
/// # Errors
/// As [`Station::located`].
pub(super) fn told(
    mut found: Vec<Found>,
    page: &PickedPage,
    station: &Station,
    land: Option<&Met>,
) -> Result<Vec<LineAnswer>> {
    found.sort_by(|a, b| {
        let (a, b) = (a.rank(), b.rank());
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let is_first = |i: usize| {
        let same = |other: &Found| other.line == found[i].line && other.rule.name() == found[i].rule.name();
        !found[..i].iter().any(same)
    };
    let firsts: Vec<bool> = (0..found.len()).map(is_first).collect();
    let mut answers = Vec::new();
    let mut says_facing = !found.iter().any(|found| found.rank().0 < 2 && !found.line.is_of_land());
    for (found, _) in found.iter().zip(firsts).filter(|(_, is_first)| *is_first) {
        if says_facing && found.rank().0 >= 2 {
            answers.push(facing(page, station, land));
            says_facing = false;
        }
        answers.push(answer(found, page, station)?);
    }
    answers.extend(says_facing.then(|| facing(page, station, land)));
    Ok(answers)
}

fn answer(found: &Found, page: &PickedPage, station: &Station) -> Result<LineAnswer> {
    let Found { line, id, px, world, rule, flags, .. } = found;
    let has_place = rule.has_line();
    let kind = kind(*line, &page.lines.own);
    let called = called(*line, *id, &page.lines.own);
    let remedy = match (rule.is_drawn(), flags) {
        (false, Some(flags)) => format!("; {flags} draws it"),
        (true, Some(flags)) => format!("; {flags} draws it whole"),
        (_, None) => String::new(),
    };
    let words = match has_place {
        true => format!("{called}, {} px off: {}{remedy}", short((px * 100.0).round() / 100.0), rule.words()),
        false => format!("{kind}: {}{}", rule.words(), remedy.replace("draws it", "draws one here")),
    };
    Ok(LineAnswer {
        kind: Some(kind),
        id: id.map(Id::written),
        drawn: rule.is_drawn(),
        rule: rule.name(),
        off_px: has_place.then_some(*px),
        distance_m: has_place.then(|| station.sighting(*world).distance_m),
        located: has_place.then(|| station.located(*world)).transpose()?,
        numbers: numbers(rule),
        flags: flags.clone(),
        words,
    })
}

/// That no silhouette is there, and why.
fn facing(page: &PickedPage, station: &Station, land: Option<&Met>) -> LineAnswer {
    let degrees = land.map(|met| station.off_sight(met));
    let bounds = near(&page.lines.chains, page.middle, f64::INFINITY);
    let bounds = bounds.into_iter().filter(|near| !near.point.line.is_of_land() && near.point.weight > 0.0);
    let nearest = bounds.min_by(|a, b| a.px.total_cmp(&b.px));
    let nearest = nearest.map(|near| {
        let id = page.lines.chains[near.chain].id;
        (called(near.point.line, id, &page.lines.own), near.px)
    });
    let rule = Rule::Facing { degrees, nearest };
    LineAnswer {
        kind: None,
        id: None,
        drawn: false,
        rule: rule.name(),
        off_px: None,
        distance_m: None,
        located: None,
        numbers: numbers(&rule),
        flags: None,
        words: rule.words(),
    }
}

fn numbers(rule: &Rule) -> serde_json::Map<String, serde_json::Value> {
    rule.numbers().into_iter().map(|(name, number)| (name.to_owned(), number.into())).collect()
}

/// What a kind of line is called, lines of the user's own by their layers.
fn kind(line: Line, own: &[String]) -> String {
    match line {
        Line::Own(layer) => own.get(usize::from(layer)).map_or_else(|| line.name().to_owned(), Clone::clone),
        named => named.name().to_owned(),
    }
}

/// A line by its kind and the name of its chain.
fn called(line: Line, id: Option<Id>, own: &[String]) -> String {
    let kind = kind(line, own);
    id.map_or_else(|| kind.clone(), |id| format!("{kind} {}", id.written()))
}
