//! The lines of a whole DEM, from its heights.

use super::SurfaceLine;
use super::area::Area;
use super::bits::Bits;
use super::branches::{branches, lasting};
use super::channels::Channels;
use super::flow::{Ends, Flow};
use super::grid::Grid;
use super::lines::{NetNode, lines};
use super::parting::{Beds, Parting};
use super::threshold::{AreaTrial, FIRST, found, trials};
use super::tops::tops;
use super::trace::Follows;
use super::water::sea;
use crate::dem::Dem;
use crate::error::Result;

/// Samples that make a channel where the land does not tell, or tells less.
const CELLS: u32 = 25;
/// Most samples that the land may tell: where it tells more it is not of one kind, and its valleys would go undrawn.
const MOST_CELLS: u32 = 100;
/// Samples of a branch that comes to be a line of its own, if none joins it.
const LEAST: usize = 5;

/// How much land makes a channel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ChannelArea {
    /// As the falls of the streams tell, between 25 and 100 cells: [`auto_cells`].
    #[default]
    Auto,
    /// So many square metres.
    SquareMetres(f64),
}

/// Samples that make a channel where the falls of the streams tell this: at least 25, which are taken where they tell nothing, at
/// most 100.
pub fn auto_cells(found: Option<AreaTrial>) -> u32 {
    found.map_or(CELLS, |trial| trial.cells.clamp(CELLS, MOST_CELLS))
}

/// A DEM's heights, and where water goes on them.
#[derive(Debug, Clone)]
pub struct Relief {
    grid: Grid,
    sea: Bits,
    flow: Flow,
    area: Area,
}

impl Relief {
    /// Of a held DEM whose heights are exaggerated by a factor.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::error::Error::Limit) for a filed one, [`Error::Mistake`](crate::error::Error::Mistake) where water
    /// has no end.
    pub fn of(dem: &Dem, exaggeration: f64) -> Result<Self> {
        Self::on(Grid::of(dem, exaggeration)?)
    }

    /// Of these heights.
    ///
    /// # Errors
    /// [`Error::Mistake`](crate::error::Error::Mistake) where the flow goes round in a circle.
    pub fn on(grid: Grid) -> Result<Self> {
        let sea = sea(grid.frame, &grid.heights);
        let flow = Flow::of(grid.frame, &grid.smoothed, Ends::Rim(&sea));
        let area = Area::of(&flow, &sea)?;
        Ok(Self { grid, sea, flow, area })
    }

    /// Its heights.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The lines along which water runs, the largest first, each after the one it joins.
    pub fn drainage(&self, area: ChannelArea) -> Vec<SurfaceLine> {
        let least = self.channel_cells(area);
        let channels = Channels::of(&self.flow, &self.area, least);
        let orders = channels.orders(&self.area, least).strahler;
        let sample = |node: u32| channels.samples[node as usize] as usize;
        let branches = lasting(branches(&channels, |node| self.area.cells[sample(node as u32)]), &channels, LEAST);
        let source = |node: u32| self.grid.smoothed[self.source(sample(node))];
        let tops: Vec<f32> =
            branches.iter().map(|branch| branch.nodes.first().map_or(f32::NAN, |node| source(*node))).collect();
        let node = |branch: usize, node: u32| {
            let i = sample(node);
            let drop = tops[branch] - self.grid.smoothed[i];
            NetNode { at: self.grid.frame.at(i), length: self.area.length[i], drop, order: orders[node as usize] }
        };
        lines(&self.grid, &branches, Follows::Valley, node)
    }

    /// The lines along which water parts, the largest first, each after the one it joins.
    ///
    /// They are where water would gather on the land turned upside down, from which it leaves at the highest sample.
    ///
    /// # Errors
    /// [`Error::Mistake`](crate::error::Error::Mistake) where the flow goes round in a circle.
    pub fn ridges(&self) -> Result<Vec<SurfaceLine>> {
        let frame = self.grid.frame;
        let mut negated: Vec<f32> = self.grid.smoothed.iter().map(|height| -height).collect();
        self.sea.iter().for_each(|i| negated[i] = f32::NAN);
        let flow = Flow::of(frame, &negated, Ends::At { tops: &tops(frame, &negated), sea: &self.sea });
        let area = Area::of(&flow, &self.sea)?;
        let beds = self.beds();
        // No ridge goes through a bed to the next.
        let belongs = |i: usize| area.cells[i] >= CELLS && !beds.is_bed(i);
        let goes_on = |i: usize| flow.direction(i).is_some_and(|k| !beds.crosses(i, k));
        let crests = Channels::among(&flow, belongs, goes_on);
        let sample = |node: u32| crests.samples[node as usize] as usize;
        let branches = lasting(branches(&crests, |node| area.cells[sample(node as u32)]), &crests, LEAST);
        let steps = frame.steps();
        let node = |_: usize, node: u32| {
            let i = sample(node);
            let k = flow.direction(i).unwrap_or(0);
            let sides = [2, 6].map(|turn| i.wrapping_add(steps[(k + turn) % 8]));
            let is_land = sides.iter().all(|side| self.flow.is_land(*side));
            let Parting { length, drop } = if is_land { beds.parting(sides) } else { Parting::default() };
            NetNode { at: frame.at(i), length, drop, order: 1 }
        };
        Ok(lines(&self.grid, &branches, Follows::Crest, node))
    }

    /// Where water runs in beds, as ridges are told by.
    fn beds(&self) -> Beds<'_> {
        let channels = Channels::of(&self.flow, &self.area, CELLS);
        let branches = branches(&channels, |node| self.area.cells[channels.samples[node] as usize]);
        Beds::new(&self.flow, &self.area, &self.grid.smoothed, channels, &branches)
    }

    /// Where the longest way to a sample begins.
    fn source(&self, mut i: usize) -> usize {
        let metres = self.grid.frame.distances();
        let length = |(k, from): (usize, usize)| f64::from(self.area.length[from]) + metres[k];
        while let Some((_, from)) = self.flow.donors(i).max_by(|a, b| length(*a).total_cmp(&length(*b))) {
            i = from;
        }
        i
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Relief {
    /// Its sea, in the grid's frame.
    pub fn sea(&self) -> &Bits {
        &self.sea
    }

    /// Where water goes.
    pub fn flow(&self) -> &Flow {
        &self.flow
    }

    /// How much of it gathers.
    pub fn area(&self) -> &Area {
        &self.area
    }

    /// Areas from which water may run in beds, and how streams then fall.
    pub fn trials(&self) -> Vec<AreaTrial> {
        trials(&self.grid, &Channels::of(&self.flow, &self.area, FIRST), &self.area)
    }

    /// Samples that make a channel.
    pub fn channel_cells(&self, area: ChannelArea) -> u32 {
        match area {
            ChannelArea::Auto => auto_cells(found(&self.trials())),
            ChannelArea::SquareMetres(area) => (area / self.grid.frame.area()).ceil().max(1.0) as u32,
        }
    }
}
