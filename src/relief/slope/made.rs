//! All slope lines of a DEM, made where they are asked for.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::block::made;
use super::kept::Store;
use super::land::{LONG_CELLS, Land, Walker, long_stops};
use super::level::{BlockAt, Blocks, LEVELS};
use super::{SlopeBlock, SlopePoint, SlopeRules};
use crate::cache::Cache;
use crate::dem::Dem;
use crate::error::Result;
use crate::relief::{FlatWater, SurfaceLine};
use crate::surface::lattice::{CELL_STEPS, CHUNK_QUADS};
use crate::surface::{Pyramid, Surface};

/// Points that are held; where there are more, blocks go that the last request did not need. 192 MB.
const MOST_POINTS: usize = 6_000_000;

/// Along the side of a block its land is looked at in about so many places.
const LOOKS: f64 = 7.0;
/// How far beyond its sides, spacings: where its lines mostly are.
const BEYOND: f64 = 1.5;
/// Most room of a block, in parts of what a place needs, up to which the place asks for none of it, and from which for all.
const ASKED: [f64; 2] = [1.0, 1.4];
/// Shares of the places that ask for a block up to which it is left out, and from which it is whole.
const SHARES: [f64; 2] = [0.04, 0.16];

/// Which lines somebody needs: with how much room they are drawn, metres on the map.
pub trait Need: Sync {
    /// The least anywhere in a box of the exaggerated world, by its low and high corner, metres; infinite where none is drawn. No
    /// less in a box inside another.
    fn in_box(&self, corners: [DVec3; 2]) -> f64;

    /// At a place of the exaggerated world, on land of this gradient, metres for a metre east and north, whatever hides it;
    /// infinite where none is drawn.
    fn at(&self, place: DVec3, gradient: DVec2) -> f64;

    /// Whether somebody may see a place of the exaggerated world.
    fn sees(&self, place: DVec3) -> bool;
}

/// The same on all land.
impl<F: Fn([DVec3; 2]) -> f64 + Sync> Need for F {
    fn in_box(&self, corners: [DVec3; 2]) -> f64 {
        self(corners)
    }

    fn at(&self, place: DVec3, _: DVec2) -> f64 {
        self([place; 2])
    }

    fn sees(&self, place: DVec3) -> bool {
        self([place; 2]).is_finite()
    }
}

/// What is asked of a block.
#[derive(Debug, Clone, Copy, Default)]
struct Asked {
    /// How many of its places ask for its lines: 1 for enough.
    share: f64,
    /// Whether somebody sees one of them.
    seen: bool,
}

/// What part of the way from one value to another a third has come, 0 to 1.
fn part([from, to]: [f64; 2], value: f64) -> f64 {
    ((value - from) / (to - from)).clamp(0.0, 1.0)
}

/// All slope lines of a DEM: those of each block are made when they are first needed, and are the same whatever was asked
/// before. Of a DEM that stays in its file lines run on the surface of every so-manieth sample, see
/// [`spacing`](crate::relief::spacing), and spacings are told in cells of that.
#[derive(Debug)]
pub struct Slopes {
    land: Land,
    exaggeration: f64,
    blocks: Blocks,
    made: Mutex<Made>,
    store: Option<Store>,
    /// At which lines end at smaller scales.
    stops: Arc<[SurfaceLine]>,
    /// Those at half the scale, once somebody asked; none of land that is small.
    wider: OnceLock<Option<Box<Self>>>,
}

type Made = FxHashMap<BlockAt, Arc<SlopeBlock>>;

/// Lines that somebody needs.
#[derive(Debug, Clone)]
pub struct Needed {
    /// The block that they begin in.
    pub block: Arc<SlopeBlock>,
    /// How many of its places ask for them: 1 for enough, less for few.
    pub share: f64,
}

impl Slopes {
    /// Of a surface whose heights are multiplied by `exaggeration`; lines end at `stops`, drainage and ridges, and at the shores of
    /// `water`, which is that of the DEM's samples. Makes no line yet.
    ///
    /// # Errors
    /// As [`Surface::pyramid`] and, of a filed DEM, [`Dem::spaced`](crate::dem::Dem::spaced).
    pub fn new(
        surface: Arc<Surface>,
        exaggeration: f64,
        rules: SlopeRules,
        stops: &[SurfaceLine],
        water: Option<&FlatWater>,
    ) -> Result<Self> {
        let land = Land::new(surface, exaggeration, rules, stops, water)?;
        // At the next scale no more are needed.
        let long = long_stops(stops, 2.0 * LONG_CELLS * land.cell.min_element());
        Self::on(land, exaggeration, long.into(), None)
    }

    fn on(land: Land, exaggeration: f64, stops: Arc<[SurfaceLine]>, store: Option<Store>) -> Result<Self> {
        land.surface.pyramid()?;
        let dem = land.surface.dem();
        let extent = DVec2::new(dem.columns() as f64, dem.rows() as f64) - 1.0;
        let blocks = Blocks { unit: land.cell.min_element(), extent: extent * land.cell };
        Ok(Self { land, exaggeration, blocks, made: Mutex::default(), store, stops, wider: OnceLock::new() })
    }

    /// Lines of the same land at half the scale; none where it is small.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub(crate) fn wider(&self) -> Result<Option<&Self>> {
        if self.wider.get().is_none() {
            let on = |land| Self::on(land, self.exaggeration, self.stops.clone(), self.store.clone()).map(Box::new);
            let made = self.land.halved(&self.stops)?.map(on).transpose()?;
            let _ = self.wider.set(made);
        }
        Ok(self.wider.get().and_then(Option::as_deref))
    }

    /// Whether that is so of the box of the exaggerated world about some of the land, by its low and high corner.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub(crate) fn has_land(&self, is_so: impl Fn([DVec3; 2]) -> bool) -> Result<bool> {
        let pyramid = self.land.surface.pyramid()?;
        Ok(self.blocks.of(0).filter_map(|at| self.bounds(pyramid, at)).any(is_so))
    }

    /// Blocks whose lines may be drawn, by level, row and column: those whose lines may have as much room as is needed in the box
    /// that they are in and in more than a few places on the land of it, some of which are seen. Those that are not known yet are
    /// made, on every core.
    ///
    /// # Errors
    /// As [`Surface::pyramid`].
    pub fn blocks(&self, need: &dyn Need) -> Result<Vec<Needed>> {
        let shares = self.wanted(self.land.surface.pyramid()?, need);
        let wanted: Vec<BlockAt> = shares.iter().map(|(at, _)| *at).collect();
        // No lock is held while threads are at work: they might be asked for blocks themselves.
        let mut known = self.lock().clone();
        let missing = self.with_needed(&wanted, |at| !known.contains_key(&at));
        let new = match &self.store {
            Some(store) if known.is_empty() => store.blocks(&self.land, &missing, || self.make(&missing, &known))?,
            _ => self.make(&missing, &known),
        };
        known.extend(missing.iter().copied().zip(new));
        let needed = |(at, share): &(BlockAt, f64)| Some(Needed { block: known.get(at)?.clone(), share: *share });
        let blocks = shares.iter().filter_map(needed).collect();
        if !missing.is_empty() {
            self.keep(known, &wanted);
        }
        Ok(blocks)
    }

    /// Blocks in the order in which they are made, after those that are known.
    fn make(&self, missing: &[BlockAt], known: &Made) -> Vec<Arc<SlopeBlock>> {
        let mut new = Made::default();
        let is_one_go = |a: &BlockAt, b: &BlockAt| (a.level, a.phase()) == (b.level, b.phase());
        for go in missing.chunk_by(is_one_go) {
            let make = |at: &BlockAt| {
                let needed = self.blocks.needs(*at);
                let needed: Vec<_> = needed.filter_map(|other| new.get(&other).or_else(|| known.get(&other))).collect();
                (*at, Arc::new(made(&self.land, &self.blocks, *at, needed.into_iter())))
            };
            let of_go: Vec<_> = go.par_iter().map(make).collect();
            new.extend(of_go);
        }
        missing.iter().filter_map(|at| new.get(at).cloned()).collect()
    }

    /// Exaggerated metres for one of the land.
    pub fn exaggeration(&self) -> f64 {
        self.exaggeration
    }

    /// A place of the map by its metres from the north-west sample.
    fn on_map(&self, metres: DVec2) -> DVec2 {
        self.land.surface.dem().position(0, 0).truncate() + metres * DVec2::new(1.0, -1.0)
    }

    /// How many points of lines are held.
    pub fn points(&self) -> usize {
        self.lock().values().map(|block| block.points()).sum()
    }

    /// Keeps what is known, or of too much what was wanted and that which it depends on.
    fn keep(&self, known: Made, wanted: &[BlockAt]) {
        let mut held = self.lock();
        held.extend(known);
        if held.values().map(|block| block.points()).sum::<usize>() > MOST_POINTS {
            let needed: FxHashSet<BlockAt> = self.with_needed(wanted, |_| true).into_iter().collect();
            held.retain(|at, _| needed.contains(at));
        }
    }

    /// Blocks and all that they depend on, as far as they are sought, in the order in which they are made.
    fn with_needed(&self, blocks: &[BlockAt], is_sought: impl Fn(BlockAt) -> bool) -> Vec<BlockAt> {
        let by_order = |at: BlockAt| (at.level, at.phase(), at);
        let mut known: FxHashSet<BlockAt> = blocks.iter().copied().filter(|at| is_sought(*at)).collect();
        let mut open: Vec<BlockAt> = known.iter().copied().collect();
        while let Some(next) = open.pop() {
            open.extend(self.blocks.needs(next).filter(|at| is_sought(*at) && known.insert(*at)));
        }
        let mut found: Vec<BlockAt> = known.into_iter().collect();
        // What a block needs is made before it.
        found.par_sort_unstable_by_key(|at| by_order(*at));
        found
    }

    /// Blocks whose lines may have the room that is needed, each with its share: that of its own places, or of the blocks of
    /// narrower levels on them, whose lines keep away from its own. A block needs no less than the one around it two levels above.
    fn wanted(&self, pyramid: &Pyramid, need: &dyn Need) -> Vec<(BlockAt, f64)> {
        let in_box = |at: &BlockAt| self.bounds(pyramid, *at).map(|bounds| (*at, need.in_box(bounds)));
        let has = |level: u32| move |(_, need): &(BlockAt, f64)| *need <= self.blocks.most_room(level);
        let mut open = [0, 1].map(|level| self.blocks.of(level).collect::<Vec<_>>());
        let of_level = |level: u32| {
            let here = &mut open[level as usize % 2];
            let known: Vec<_> = here.par_iter().filter_map(in_box).collect();
            let split = known.iter().copied().filter(has(level + 2));
            *here = split.flat_map(|(at, _)| at.quarters()).filter(|at| self.is_on_land(*at)).collect();
            let here = known.into_par_iter().filter(has(level)).map(|(at, _)| (at, self.asked(at, need)));
            here.filter(|(_, asked)| asked.share > 0.0).collect::<Vec<_>>()
        };
        let mut levels: Vec<Vec<(BlockAt, Asked)>> = (0..LEVELS).map(of_level).collect();
        for level in (1..LEVELS).rev() {
            let mut wider: FxHashMap<BlockAt, Asked> = levels[level as usize - 1].drain(..).collect();
            for (at, asked) in &levels[level as usize] {
                for around in self.blocks.within(level - 1, self.blocks.square(*at)) {
                    let known = wider.entry(around).or_default();
                    *known = Asked { share: known.share.max(asked.share), seen: known.seen || asked.seen };
                }
            }
            levels[level as usize - 1] = wider.into_iter().collect();
        }
        let is_wanted = |(at, asked): (BlockAt, Asked)| (asked.seen && asked.share > 0.0).then_some((at, asked.share));
        let mut wanted: Vec<(BlockAt, f64)> = levels.into_iter().flatten().filter_map(is_wanted).collect();
        wanted.sort_unstable_by_key(|(at, _)| *at);
        wanted
    }

    /// How many of the places of a block and a little beyond on which lines may be ask for those of its level. What is hidden
    /// counts as well, so that nothing changes when it comes into sight.
    fn asked(&self, at: BlockAt, need: &dyn Need) -> Asked {
        let dem = self.land.surface.dem();
        let last = DVec2::new(dem.columns() as f64, dem.rows() as f64) - 1.0;
        let [low, high] = self.blocks.square(at).map(|corner| corner / self.land.cell);
        let beyond = (BEYOND * self.blocks.spacing(at.level) / self.land.cell).max(DVec2::ONE);
        let [low, high] =
            [(low - beyond).floor(), (high + beyond).ceil()].map(|corner| corner.clamp(DVec2::ZERO, last));
        let step = (high - low).max_element() / LOOKS;
        // Of wide blocks samples are good enough.
        let step = if step > 1.0 { step.ceil() } else { step.max(f64::MIN_POSITIVE) };
        let counts = ((high - low) / step).ceil().as_uvec2();
        let places = (0..=counts.y).flat_map(|y| (0..=counts.x).map(move |x| DVec2::new(x.into(), y.into())));
        let mut walker = Walker::new(&self.land);
        let (mut asks, mut all, mut seen) = (0.0, 0.0, false);
        for place in places {
            let place = (low + place * step).min(high);
            let Some((world, gradient)) = self.looked(&mut walker, place, step >= 1.0) else { continue };
            if !self.land.is_steep(gradient) {
                continue;
            }
            asks += part(ASKED, self.blocks.most_room(at.level) / need.at(world, gradient));
            all += 1.0;
            seen |= need.sees(world);
        }
        Asked { share: part(SHARES, asks / f64::max(all, 1.0)), seen }
    }

    /// A column and row in the world, and the gradient there; none where there is no land. A sample needs no surface.
    fn looked(&self, walker: &mut Walker, place: DVec2, is_sample: bool) -> Option<(DVec3, DVec2)> {
        let (surface, dem) = (&self.land.surface, self.land.surface.dem());
        if is_sample {
            let [c, r] = place.to_array().map(|at| at as usize);
            dem.height(c, r)?;
            return Some((dem.position(c, r), surface.gradient(c, r)));
        }
        let found = walker.place(place * self.land.cell)?;
        Some((self.on_map(found.at).extend(found.height), found.gradient))
    }

    /// Whether a block begins on the DEM.
    fn is_on_land(&self, at: BlockAt) -> bool {
        self.blocks.square(at)[0].cmplt(self.blocks.extent).all()
    }

    /// The box of the exaggerated world in which a block's lines are, metres; none where there is no land.
    fn bounds(&self, pyramid: &Pyramid, at: BlockAt) -> Option<[DVec3; 2]> {
        let extent = self.blocks.extent;
        let [low, high] = self.blocks.reached(at).map(|corner| corner.clamp(DVec2::ZERO, extent));
        // Squares of the pyramid that are about a quarter as large.
        let cells = ((high - low) / self.land.cell).max_element();
        let finest = pyramid.finest_step();
        let fits = |step: &u32| f64::from(step * CHUNK_QUADS) <= cells * f64::from(CELL_STEPS) / 4.0;
        let steps =
            std::iter::successors(Some(finest), |step| Some(step * 2).filter(|step| *step <= pyramid.coarsest_step()));
        let step = steps.take_while(fits).last().unwrap_or(finest);
        let side = step * CHUNK_QUADS;
        let [first, last] =
            [low, high].map(|at| (at / self.land.cell * f64::from(CELL_STEPS) / f64::from(side)).as_uvec2());
        let whole = (extent / self.land.cell * f64::from(CELL_STEPS)).as_uvec2();
        let squares = (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| [x * side, y * side]));
        let inside = squares.filter(|[x, y]| *x < whole.x && *y < whole.y);
        let reliefs = inside.map(|origin| pyramid.relief(origin, step)).filter(|relief| relief.low <= relief.high);
        let all = reliefs.map(|relief| [relief.low, relief.high, relief.beyond]);
        let [bottom, top, beyond] = all.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1]), a[2].max(b[2])])?.map(f64::from);
        let north_west = self.land.surface.dem().position(0, 0).truncate();
        let [west, east] = [low.x - beyond, high.x + beyond].map(|x| north_west.x + x);
        let [south, north] = [high.y + beyond, low.y - beyond].map(|y| north_west.y - y);
        Some([DVec3::new(west, south, bottom), DVec3::new(east, north, top)])
    }

    fn lock(&self) -> MutexGuard<'_, Made> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Slopes {
    /// The same, whose lines are kept in a cache from one process to the next; `dem` is that of the surface.
    ///
    /// # Errors
    /// Those of reading the samples.
    pub fn kept_in(self, cache: &Cache, dem: &Dem) -> Result<Self> {
        Ok(Self { store: Store::new(cache, dem, self.exaggeration)?, ..self })
    }

    /// How far apart the closest lines are, metres on the map.
    pub fn least_spacing(&self) -> f64 {
        self.blocks.spacing(LEVELS - 1)
    }

    /// Where a point of a line lies, metres of the exaggerated world.
    pub fn world(&self, point: &SlopePoint) -> DVec3 {
        self.on_map(self.land.metres(point.at)).extend(point.height.into())
    }
}
