//! What only a look at every sample tells of a DEM: made once, in bands.

use std::borrow::Cow;
use std::ops::Range;

use rayon::prelude::*;

use super::filed::exaggerate;
use super::validity::{Validity, ValidityBuilder};
use super::window::Window;
use super::{Band, Dem, Samples, Store, held};
use crate::error::{Error, Message, Result};

/// Most samples that are kept of a filed DEM to stand for all, about: 16 MiB.
const THINNED_SAMPLES: usize = 1 << 22;

/// Figures of all samples of a DEM.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Lowest and highest exaggerated metres, `None` when all samples are void.
    pub range: Option<[f32; 2]>,
    /// Samples without elevation.
    pub voids: usize,
    /// Of these, samples that are void by their impossible value alone; 0 for a held DEM, whose history tells.
    pub marks: usize,
    /// What had to be assumed of the files' numbers, in words as those of a history; empty for a held DEM, whose history
    /// tells.
    pub assumed: Vec<Message>,
    /// Patches, two a cell, whose corners all hold an elevation.
    pub patches: u64,
    /// Exaggerated metres of every k-th sample of every k-th row of a filed DEM, k as [`Dem::thinning`] says, row-major,
    /// NaN at voids. Empty for a held one.
    pub thinned: Vec<f32>,
    /// Which samples hold an elevation.
    pub validity: Validity,
}

/// A survey in the making, from bands of the DEM.
pub(crate) struct SurveyBuilder<'a> {
    dem: &'a Dem,
    figures: Figures,
    thinned: Vec<f32>,
    validity: ValidityBuilder,
}

/// Range, voids and patches of some rows.
#[derive(Clone, Copy)]
struct Figures([f32; 2], usize, u64);

impl Figures {
    const NONE: Self = Self([f32::INFINITY, f32::NEG_INFINITY], 0, 0);

    fn of_row(samples: &Samples, r: usize) -> Self {
        let [first, size] = [samples.first()[0], samples.size()[0]];
        let heights = (first..first + size).filter_map(|c| samples.height(c, r));
        let (range, valid) = heights
            .fold((Self::NONE.0, 0), |([low, high], valid), height| ([low.min(height), high.max(height)], valid + 1));
        Self(range, size - valid, samples.patches(r).map(|[a, b]| u64::from(a) + u64::from(b)).sum())
    }

    fn with(self, other: Self) -> Self {
        Self([self.0[0].min(other.0[0]), self.0[1].max(other.0[1])], self.1 + other.1, self.2 + other.2)
    }
}

impl<'a> SurveyBuilder<'a> {
    /// Of a DEM, no row seen yet.
    pub(crate) fn new(dem: &'a Dem) -> Self {
        Self { dem, figures: Figures::NONE, thinned: Vec::new(), validity: ValidityBuilder::new(dem) }
    }

    /// Takes the next rows, which `samples` holds with the one below them.
    pub(crate) fn take(&mut self, samples: &Samples, rows: Range<usize>) {
        let of_rows = rows.clone().into_par_iter().map(|r| Figures::of_row(samples, r));
        self.figures = self.figures.with(of_rows.reduce(|| Figures::NONE, Figures::with));
        self.validity.take(samples, rows.clone());
        if self.dem.is_filed() {
            let step = self.dem.thinning();
            let row = |r| samples.row_from(0, r).step_by(step).map(|height| height.unwrap_or(f32::NAN));
            self.thinned.extend(rows.filter(|r| r.is_multiple_of(step)).flat_map(row));
        }
    }

    /// The survey, when all rows have been taken.
    ///
    /// # Errors
    /// [`Error::Input`] for a filed DEM that is all void.
    pub(crate) fn finish(self) -> Result<Survey> {
        let Self { figures: Figures(range, voids, patches), thinned, validity, dem } = self;
        let (range, validity) = (Some(range).filter(|[low, high]| low <= high), validity.finish());
        let Store::Filed(filed) = &dem.store else {
            return Ok(Survey { range, voids, marks: 0, assumed: Vec::new(), patches, thinned, validity });
        };
        let tiles = filed.tiles();
        if range.is_none() {
            return Err(tiles.all_void());
        }
        Ok(Survey { range, voids, marks: tiles.marks(), assumed: tiles.assumed(), patches, thinned, validity })
    }
}

impl Dem {
    /// The survey of this DEM, made by the first who asks: all samples of a filed DEM are read then. `progress` hears the
    /// share done.
    ///
    /// # Errors
    /// As [`Dem::window`]; [`Error::Input`] for a filed DEM that is all void.
    pub fn survey(&self, progress: &dyn Fn(f64)) -> Result<&Survey> {
        if let Some(survey) = self.survey.get() {
            return Ok(survey);
        }
        let mut survey = SurveyBuilder::new(self);
        for band in self.bands(1) {
            let Band { rows, samples } = band?;
            let done = rows.end as f64 / self.rows() as f64;
            survey.take(&samples, rows);
            progress(done);
        }
        let survey = survey.finish()?;
        Ok(self.survey.get_or_init(|| survey))
    }

    /// Takes a survey made before of the same samples without exaggeration, as [`Dem::stamp`] tells, in the place of one of
    /// its own.
    pub(crate) fn remember(&self, mut survey: Survey) {
        if let Store::Filed(filed) = &self.store {
            survey.range.iter_mut().for_each(|range| exaggerate(range, filed.exaggeration()));
            exaggerate(&mut survey.thinned, filed.exaggeration());
        }
        // One that is there already says the same.
        let _ = self.survey.set(survey);
    }

    /// Lowest and highest valid height in exaggerated metres, `None` when all is void and where samples cannot be read:
    /// see [`Dem::check`].
    pub fn range(&self) -> Option<[f32; 2]> {
        self.surveyed().and_then(|survey| survey.range)
    }

    /// How many samples are void; 0 where they cannot be read, see [`Dem::check`].
    pub fn voids(&self) -> usize {
        self.surveyed().map_or(0, |survey| survey.voids)
    }

    /// Whether there is anything to draw: one patch at least.
    ///
    /// # Errors
    /// [`Error::Scene`] where no three neighbouring samples hold an elevation; as [`Dem::survey`].
    pub(crate) fn check_patches(&self) -> Result<()> {
        let Survey { voids, patches: 0, .. } = self.survey(&|_| ())? else { return Ok(()) };
        let [west, south, east, north] = self.extent();
        Err(Error::Scene {
            what: format!(
                "the DEM (W {west} S {south} E {east} N {north} m) has no surface: {voids} of its {} samples are void, \
                 and no three neighbours among the others span a facet",
                self.columns() * self.rows()
            )
            .into(),
            remedy: held::to_fill([self.columns(), self.rows()], self.is_filed()),
        })
    }

    /// Which samples hold an elevation; `None` where samples cannot be read, see [`Dem::check`].
    pub(crate) fn known_validity(&self) -> Option<&Validity> {
        self.surveyed().map(|survey| &survey.validity)
    }

    fn surveyed(&self) -> Option<&Survey> {
        self.kept(self.survey(&|_| ()))
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Dem {
    /// How many patches exist, see [`Survey::patches`]; 0 where samples cannot be read, see [`Dem::check`].
    pub fn patches(&self) -> u64 {
        self.surveyed().map_or(0, |survey| survey.patches)
    }

    /// The DEM itself if it is held; else a held one of every k-th sample and row, k being [`Dem::thinning`].
    ///
    /// # Errors
    /// As [`Dem::survey`].
    pub fn thinned(&self) -> Result<Cow<'_, Self>> {
        if !self.is_filed() {
            return Ok(Cow::Borrowed(self));
        }
        let step = self.thinning();
        let size = [self.columns(), self.rows()].map(|n| n.div_ceil(step));
        let samples = Samples::new(Window { first: [0, 0], size }, self.survey(&|_| ())?.thinned.clone());
        Ok(Cow::Owned(Self::new(size, self.cell() * step as f64, self.origin, Store::Held(samples))))
    }

    /// Samples between those that [`Dem::thinned`] takes, along a row and down a column: a power of two, but for the
    /// narrowest strips; 1 for a held DEM.
    pub fn thinning(&self) -> usize {
        let share = (self.columns() as f64 * self.rows() as f64 / THINNED_SAMPLES as f64).sqrt().ceil();
        let share = (share as usize).next_power_of_two();
        // Of a narrow strip two rows or columns at least.
        let most = self.columns().min(self.rows()) - 1;
        if self.is_filed() { share.clamp(1, most) } else { 1 }
    }
}
