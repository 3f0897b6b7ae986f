//! Flags of every subcommand that draws what an eye sees: how fine the surface is, by which method lines are found, on which
//! page they stand, in which style.

use super::choices;
use super::furniture::FurnitureArguments;
use super::land::LandArguments;
use super::page::{Layout, PageArguments};
use super::style::StyleArguments;
use super::values::{self, LevelChoice, Size};
use super::viewpoint::SIZE;
use crate::error::{Error, Result, Setting};
use crate::ink::Style;
use crate::plan::detail::ERROR_PX;
use crate::plan::{Border, Curves, Detail, LandLines, Method, Plan, SharedVertices};
use crate::relief::LandWanted;
use crate::render::Illustration;

/// The flags, as typed.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct DrawingArguments {
    /// Factor on every elevation
    #[arg(long, value_name = "X", value_parser = values::exaggeration, allow_hyphen_values = true, default_value = "1", help_heading = "Surface")]
    pub exaggeration: f64,
    /// Subdivisions of a cell's edge: 1, 2, 4, 8, 16, 32 or 64; auto: each part of the DEM as fine as the page shows
    #[arg(long, value_name = "N|auto", value_parser = values::level_choice, default_value = "auto", help_heading = "Surface")]
    pub level: LevelChoice,
    #[arg(
        long, value_name = "PX", value_parser = values::error_px, help_heading = "Surface",
        help = format!("--level auto only: how far facets may deviate from the surface on the page where a line may run, in pixels; elsewhere four times as far [default: {ERROR_PX}]")
    )]
    error_px: Option<f64>,

    /// How silhouettes are found
    #[arg(long, value_parser = choices::family(), default_value = Method::default().entry().family, help_heading = "Method")]
    method: Method,
    /// toward-away only: away surface counts wherever it touches the pixel or the neighbour it is compared with
    #[arg(long, help_heading = "Method")]
    wide: bool,
    #[arg(
        long, value_parser = choices::share(), help_heading = "Method",
        help = format!("adjacency only: what neighbouring facets share [default: {}]", choices::default_share())
    )]
    share: Option<SharedVertices>,
    /// Whether to draw the visible border of the DEM and of its voids
    #[arg(long, value_parser = choices::border(), default_value = choices::default_border(), help_heading = "Method")]
    border: Border,

    /// The sheet.
    #[command(flatten)]
    pub page: PageArguments,
    /// The look.
    #[command(flatten)]
    pub style: StyleArguments,
    /// Lines of the land.
    #[command(flatten)]
    pub land: LandArguments,
    /// What stands around the picture.
    #[command(flatten)]
    pub furniture: FurnitureArguments,
}

/// What is asked for of a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// Lines, or lines and the mask.
    Drawing,
    /// The mask alone: whatever serves strokes is left out.
    Mask,
}

impl DrawingArguments {
    /// What is to be found, if the flags go together.
    ///
    /// # Errors
    /// [`Error::Setting`].
    pub(crate) fn plan(&self, wanted: Wanted) -> Result<Plan> {
        let (method, detail) = (self.method()?, self.detail()?);
        // Strokes of the walk's mask are contours.
        let curves = match (self.style.draws_hidden(), method) {
            (true, Method::Walk | Method::Contour) => Curves::All,
            (_, Method::Walk) => Curves::On,
            _ => Curves::Off,
        };
        let plan = Plan { curves, ..Plan::new(detail, method, self.border) };
        if !plan.has_curves() {
            self.style.refuse_for_traced()?;
            self.land.refuse_for_traced()?;
        }
        Ok(if wanted == Wanted::Mask { Plan { curves: Curves::Off, ..plan } } else { plan })
    }

    /// The drawing of a view in a frame of this size, if the flags go together; `pictures` says whether some of its files are;
    /// files on a network are read only where these are allowed.
    ///
    /// # Errors
    /// [`Error::Setting`]; as [`StyleArguments::style`] and [`LandArguments::wanted`].
    pub(crate) fn illustration(
        &self,
        size: Option<Size>,
        wanted: Wanted,
        pictures: bool,
        allow_remote: bool,
    ) -> Result<Illustration> {
        let (plan, mut style) = (self.plan(wanted)?, self.style.style()?);
        // The corners of the rules do as well.
        style.plot.registration &= !self.furniture.is_framed();
        let land = self.wanted(&style, &plan, allow_remote)?;
        let layout = self.layout(size, &style, pictures)?;
        let frame = [layout.frame.width, layout.frame.height];
        let px_per_mm = layout.sheet.placement(frame).px_per_mm;
        let economy = self.style.economy(&style, px_per_mm);
        let plan = Plan {
            land: if land.is_nothing() { LandLines::Off } else { LandLines::On },
            hachures: style.hachures(px_per_mm).filter(|_| land.slopes.is_some()),
            ..plan
        };
        let split = self.style.split().to_vec();
        Ok(Illustration { plan, style, land, economy, split, sheet: layout.sheet, frame, px_per_mm: layout.px_per_mm })
    }

    /// What is to be told where the style has lines of the land or hachures and the method draws none.
    ///
    /// # Errors
    /// As [`Self::plan`] and [`StyleArguments::style`].
    pub(crate) fn left_out_of_style(&self) -> Result<Option<String>> {
        if self.plan(Wanted::Drawing)?.has_curves() {
            return Ok(None);
        }
        let Style { creases, hachures, .. } = self.style.style()?;
        let creases = if self.land.says_creases() { Vec::new() } else { creases };
        let of_creases = creases.iter().map(|crease| (crease.name(), " --creases none"));
        let of_hachures = hachures.rules().map(|_| ("hachures", " --hachures none"));
        let (lines, mut flags): (Vec<&str>, Vec<&str>) = of_creases.chain(of_hachures).unzip();
        flags.dedup();
        Ok(lines.split_last().map(|(last, others)| {
            let lines =
                if others.is_empty() { (*last).to_owned() } else { format!("{} and {last}", others.join(", ")) };
            let words = "they go with contours only; leave out --method, or add";
            format!("the style's {lines} are left out: {words}{}", flags.concat())
        }))
    }

    /// Which lines of the land are to be drawn; none where no curves are.
    fn wanted(&self, style: &Style, plan: &Plan, allow_remote: bool) -> Result<LandWanted> {
        if plan.has_curves() { self.land.wanted(style, allow_remote) } else { Ok(LandWanted::default()) }
    }

    /// How the page is laid out.
    fn layout(&self, size: Option<Size>, style: &Style, pictures: bool) -> Result<Layout> {
        let layout = self.page.layout(size, SIZE, &self.furniture.furniture(), style)?;
        if pictures {
            layout.check_picture()?;
        }
        Ok(layout)
    }

    /// How fine facets are.
    ///
    /// # Errors
    /// [`Error::Setting`] for a deviation beside one level.
    pub(crate) fn detail(&self) -> Result<Detail> {
        if self.error_px.is_some() && self.level != LevelChoice::Auto {
            return Err(Error::setting(Setting::ErrorPx, "goes with --level auto only", "leave one of them out"));
        }
        Ok(self.level.detail(self.error_px.unwrap_or(ERROR_PX)))
    }

    /// The variant of the method that further flags ask for.
    fn method(&self) -> Result<Method> {
        if self.wide && !matches!(self.method, Method::TowardAway { .. }) {
            return Err(Error::setting(Setting::Wide, "goes with toward-away only", "add --method toward-away"));
        }
        if self.share.is_some() && !matches!(self.method, Method::Adjacency { .. }) {
            return Err(Error::setting(Setting::Share, "goes with adjacency only", "add --method adjacency"));
        }
        Ok(match self.method {
            Method::TowardAway { .. } => Method::TowardAway { wide: self.wide },
            Method::Adjacency { .. } => Method::Adjacency { share: self.share.unwrap_or_default() },
            plain => plain,
        })
    }
}
