//! How much water gathers at a place, beside how much makes a channel; or that the sea lies there.
//!
//! Cost: that of finding all channels of the DEM. Of a DEM that stays in its file the land is taken in the blocks that its channels
//! are found on.

use glam::DVec2;

use super::coarse::{lowest_and_highest, spacing};
use super::frame::AROUND;
use super::whole::{ChannelArea, Relief};
use crate::dem::Dem;
use crate::error::Result;

/// What water comes to a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Gathered {
    /// All that comes: the place is of the sea.
    Sea,
    /// That of so much land, square metres: to the place, or one of the samples about it, the most; and to where channels begin.
    Land { here: f64, channels: f64 },
}

impl Gathered {
    /// At a place of a DEM whose heights are exaggerated by a factor, given in columns and rows; `None` outside.
    ///
    /// # Errors
    /// Those of [`Relief`] and of reading the samples.
    pub(crate) fn at(dem: &Dem, exaggeration: f64, channels: ChannelArea, place: DVec2) -> Result<Option<Self>> {
        let spacing = spacing(dem);
        let relief = match dem.is_filed() {
            true => {
                let [lowest, _] = lowest_and_highest(dem, exaggeration, spacing, &|_| ())?;
                Relief::on(lowest)?
            }
            false => Relief::of(dem, exaggeration)?,
        };
        let frame = relief.grid().frame;
        let nearest = ((place + 0.5) / spacing as f64 - 0.5).round();
        if nearest.cmplt(DVec2::ZERO).any() || nearest != frame.within(nearest) {
            return Ok(None);
        }
        let sample = frame.index(nearest.to_array().map(|at| at as usize));
        if relief.sea().has(sample) {
            return Ok(Some(Self::Sea));
        }
        let steps = AROUND.map(|[c, r]| r * frame.stride() as isize + c);
        let about = steps.into_iter().chain([0]).map(|step| relief.area().cells[sample.wrapping_add_signed(step)]);
        let cells = [about.max().unwrap_or(0), relief.channel_cells(channels)];
        let [here, channels] = cells.map(|cells| f64::from(cells) * frame.area());
        Ok(Some(Self::Land { here, channels }))
    }
}
