//! Flags of lines on the land: creases, and lines of the user's own.

use std::mem::take;
use std::sync::Arc;

use super::lines::LinesArguments;
use super::talk::Talk;
use super::values::number;
use super::words::told;
use crate::cache::{Cache, CacheObserver};
use crate::error::{Error, Message, Result, Setting};
use crate::ink::Style;
use crate::line::Land;
use crate::relief::{ChannelArea, Crease, FlatWater, FlowLines, LandWanted, Slopes, SurfaceLine, append};
use crate::surface::Surface;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Style")]
pub(crate) struct LandArguments {
    #[arg(
        long, value_name = "NAME,…|none", value_parser = creases,
        help = format!(
            "Lines of the land, each kind in a layer of its own: {}; or none. Contours and plans only [default: as the style has it, {}]",
            Crease::ALL.map(Crease::name).join(", "), creases_word(&Style::default().creases)
        )
    )]
    creases: Option<Creases>,
    /// From how much land on water runs in a channel: square metres, hectares or square kilometres, as 40000m2, 4ha, .04km2; auto:
    /// as the land says by the falls of its streams. What of them is drawn is a matter of the page
    #[arg(long, value_name = "AREA|auto", value_parser = channel_area, default_value = "auto")]
    channel_area: ChannelArea,
    /// Lines of the user's own.
    #[command(flatten)]
    pub lines: LinesArguments,
}

/// Several kinds, each once, in one order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Creases(pub Vec<Crease>);

/// What users call them.
fn creases_word(creases: &[Crease]) -> String {
    match creases {
        [] => "none".to_owned(),
        creases => creases.iter().map(|crease| crease.name()).collect::<Vec<_>>().join(","),
    }
}

impl LandArguments {
    /// What is asked for, beside what the style says; files on a network are read only where these are allowed.
    ///
    /// # Errors
    /// As [`LinesArguments::open`]; [`Error::Setting`] for an area of channels that nobody draws.
    pub(crate) fn wanted(&self, style: &Style, allow_remote: bool) -> Result<LandWanted> {
        let creases = self.creases.as_ref().map_or(&style.creases, |creases| &creases.0).clone();
        let channel_area = self.channel_area;
        if channel_area != ChannelArea::Auto && !creases.contains(&Crease::Drainage) {
            let what = "goes with drainage only";
            return Err(Error::setting(Setting::ChannelArea, what, "add --creases drainage, or leave it out"));
        }
        let own = self.lines.open(allow_remote)?;
        Ok(LandWanted {
            creases,
            channel_area,
            own: own.asked(),
            own_layers: own.layers(),
            slopes: style.hachures.rules(),
        })
    }

    /// Whether it is said which creases are drawn, or none, whatever the style has.
    pub(crate) fn says_creases(&self) -> bool {
        self.creases.is_some()
    }

    /// Refuses what only contours can be drawn with.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn refuse_for_traced(&self) -> Result<()> {
        let asks = self.creases.as_ref().is_some_and(|creases| !creases.0.is_empty());
        let has_area = self.channel_area != ChannelArea::Auto;
        let given =
            [(Setting::Creases, asks), (Setting::ChannelArea, has_area), (Setting::Lines, !self.lines.is_empty())];
        let refuse = |setting| Error::setting(setting, "goes with contours only", "leave out --method");
        given.into_iter().find(|(_, given)| *given).map_or(Ok(()), |(setting, _)| Err(refuse(setting)))
    }

    /// The lines that are wanted of a surface whose heights are exaggerated by this factor.
    ///
    /// # Errors
    /// As [`Cache::creases`], [`Cache::shores`], [`Slopes::new`] and [`LinesArguments::read`].
    pub(crate) fn land(
        &self,
        wanted: &LandWanted,
        surface: &Arc<Surface>,
        exaggeration: f64,
        allow_remote: bool,
        cache: &Cache,
        talk: &Talk,
    ) -> Result<Land> {
        let dem = surface.dem();
        let mut lines = self.lines.read(dem, allow_remote, talk)?;
        let found = |crease: &Crease| match crease {
            Crease::Drainage => Some(FlowLines::Drainage(wanted.channel_area)),
            Crease::Ridges => Some(FlowLines::Ridges),
            Crease::Shores => None,
        };
        // Slope lines end on both, drawn or not.
        let known = Crease::ALL.into_iter().filter(|crease| wanted.slopes.is_some() || wanted.creases.contains(crease));
        let (known, asked): (Vec<Crease>, Vec<FlowLines>) = known.filter_map(|c| Some((c, found(&c)?))).unzip();
        let warn = |message: &Message| talk.warn(&told(message));
        let hearing =
            CacheObserver { warn: &warn, progress: &|done| talk.progress("looking for creases", 0.2 + 0.1 * done) };
        let mut found = match asked[..] {
            // Nothing is looked at for lines of the user's own.
            [] => Vec::new(),
            _ => cache.creases(dem, exaggeration, &asked, hearing)?,
        };
        let draws_shores = wanted.creases.contains(&Crease::Shores);
        let ends_at_shores = wanted.slopes.is_some();
        let finds_shores = draws_shores || (ends_at_shores && dem.is_filed());
        let shores = finds_shores.then(|| cache.shores(dem, exaggeration, hearing)).transpose()?;
        // Shores that nobody draws are not followed, but where they are kept beside the water.
        let water = (ends_at_shores && shores.is_none()).then(|| FlatWater::of(dem, exaggeration)).transpose()?;
        let slopes = wanted.slopes.map(|rules| {
            let water = shores.as_ref().map(|shores| &shores.water).or(water.as_ref());
            let slopes = Slopes::new(surface.clone(), exaggeration, rules, &found.concat(), water)?;
            slopes.kept_in(cache, dem).map(Arc::new)
        });
        let slopes = slopes.transpose()?;
        let mut drawn: Vec<Vec<SurfaceLine>> = known
            .iter()
            .zip(&mut found)
            .filter(|(crease, _)| wanted.creases.contains(crease))
            .map(|(_, lines)| take(lines))
            .collect();
        if let Some(shores) = shores.filter(|_| draws_shores) {
            drawn.iter_mut().flatten().for_each(|line| shores.water.blank(line));
            drawn.push(shores.lines);
        }
        drawn.into_iter().for_each(|more| append(&mut lines, more));
        let land = Land::new(dem, exaggeration, lines)?;
        Ok(match slopes {
            Some(slopes) => land.with_slopes(slopes),
            None => land,
        })
    }
}

/// Kinds of lines of the land, with commas between, or `none`.
fn creases(text: &str) -> std::result::Result<Creases, String> {
    let names = Crease::ALL.map(Crease::name).join(", ");
    let known = |word: &str| Crease::ALL.into_iter().find(|crease| crease.name() == word);
    let listed = match text {
        // An empty list of a batch.
        "none" | "" => Some(Vec::new()),
        text => text.split(',').map(|word| known(word.trim())).collect::<Option<Vec<_>>>(),
    };
    let mut creases = listed.ok_or_else(|| format!("want some of {names}, with commas between, or none"))?;
    creases.sort_unstable();
    creases.dedup();
    Ok(Creases(creases))
}

/// An area with its unit, or `auto`.
fn channel_area(text: &str) -> std::result::Result<ChannelArea, String> {
    if text == "auto" {
        return Ok(ChannelArea::Auto);
    }
    let units = [("km2", 1e6), ("ha", 1e4), ("m2", 1.0)];
    let in_unit = |(unit, metres): (&str, f64)| Some(number(text.strip_suffix(unit)?).ok()? * metres);
    let area = units.into_iter().find_map(in_unit).filter(|area| *area > 0.0);
    area.map(ChannelArea::SquareMetres).ok_or_else(|| "want an area, as 40000m2, 4ha or .04km2, or auto".to_owned())
}
