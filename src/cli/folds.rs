//! What is told of patches that fold over, and of tangents that are limited so that none does.

use serde::Serialize;

use super::peaks;
use crate::dem::Dem;
use crate::error::Result;
use crate::render::Page;
use crate::surface::{Fold, Moved, Surface};

/// Share of the facets of a frame from which on folds are warned of.
const MANY: f64 = 0.001;

/// Facets of a frame that fold, and all that there are.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct FoldsInView {
    facets: u64,
    share: f64,
}

/// Patches of a surface that fold, and what limits did to it.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct FoldsReport {
    in_view: FoldsInView,
    /// None where samples stay in their files, which `info` looks through.
    patches: Option<usize>,
    limited: Option<LimitedReport>,
}

/// What was limited, metres of the land.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct LimitedReport {
    samples: usize,
    patches: usize,
    most_m: f64,
    mean_m: f64,
    aside_m: f64,
}

impl FoldsInView {
    /// Of a page.
    ///
    /// # Errors
    /// As [`Surface::folding_facets`].
    pub(crate) fn of(surface: &Surface, page: &Page) -> Result<Self> {
        let facets = surface.folding_facets(&page.frame.lattice)?;
        Ok(Self { facets, share: facets as f64 / page.frame.facets(surface).max(1) as f64 })
    }

    /// What is warned of where there are many.
    pub(crate) fn warning(&self) -> Option<String> {
        let Self { facets, share } = *self;
        (share > MANY).then(|| {
            format!(
                "{facets} facets ({:.2} %) fold over, for the land is stiff: silhouettes there may be false; add --limit-folds, \
                 or use less --exaggeration",
                100.0 * share
            )
        })
    }
}

impl FoldsReport {
    /// Of a surface whose heights are exaggerated by a factor.
    ///
    /// # Errors
    /// As [`Surface::folds`] and [`Surface::moved`].
    pub(crate) fn of(surface: &Surface, in_view: FoldsInView, exaggeration: f64) -> Result<Self> {
        let patches = if surface.dem().is_filed() { None } else { Some(surface.folds()?.len()) };
        let limited = surface.moved()?.map(|moved| LimitedReport::of(moved, exaggeration));
        Ok(Self { in_view, patches, limited })
    }
}

impl LimitedReport {
    fn of(Moved { samples, patches, most, mean, aside }: Moved, exaggeration: f64) -> Self {
        Self { samples, patches, most_m: most / exaggeration, mean_m: mean / exaggeration, aside_m: aside }
    }

    fn words(&self) -> String {
        let Self { samples, patches, most_m, mean_m, aside_m } = *self;
        format!(
            "tangents at {samples} samples: {patches} patches move up or down by {most_m:.2} m at most, {mean_m:.3} m on average, \
             aside by {aside_m:.2} m at most"
        )
    }
}

/// The lines of `hachure info`: of a surface whose heights are exaggerated by a factor, limited where that is asked for.
///
/// # Errors
/// As [`Surface::folds`], [`Surface::limited`] and [`Surface::moved`].
pub(crate) fn told(surface: Surface, exaggeration: f64, limits: bool) -> Result<String> {
    let (folds, patches) = (surface.folds()?, surface.patches());
    let times = if exaggeration == 1.0 { String::new() } else { format!(" at {exaggeration} times the heights") };
    let worst = folds.iter().min_by(|a, b| a.ground.total_cmp(&b.ground));
    let of = match worst {
        None => "none".to_owned(),
        Some(worst) => {
            let share = 100.0 * folds.len() as f64 / patches as f64;
            format!("{} ({share:.3} %), the worst {}", folds.len(), place(surface.dem(), worst)?)
        }
    };
    let found = format!("folds      of {patches} patches{times}: {of}");
    if !limits {
        return Ok(found);
    }
    let limited = surface.limited()?;
    let (left, moved) = (limited.folds()?.len(), limited.moved()?);
    let words = moved.map_or("nothing".to_owned(), |moved| LimitedReport::of(moved, exaggeration).words());
    Ok(format!("{found}\nlimited    {words}; {left} folds are left"))
}

/// Where a fold is: in the DEM, and on the map.
fn place(dem: &Dem, fold: &Fold) -> Result<String> {
    let [row, column] = fold.at.cell;
    Ok(format!("in the cell at column {column}, row {row}, {}", peaks::place(dem, fold.place)?))
}
