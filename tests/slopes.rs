//! Slope lines: where they run and end, how evenly they lie at every spacing, the same however they are asked for.

mod costs;
mod filed;
mod kept;
mod same;
mod spaced;
mod traced;

use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::relief::slope::{Need, SlopeBlock, SlopeLine, SlopeRules, Slopes};
use hachure::geo::{ReadOptions, read};
use hachure::relief::{ChannelArea, FlatWater, Relief, SurfaceLine};
use hachure::surface::Surface;

use crate::common::shared_dems;

/// Metres of a cell of made land.
const CELL: f64 = 10.0;
/// When lines end here.
const RULES: SlopeRules = SlopeRules { min_slope: 3.0, max_turn: 60.0 };

/// Land with all that ends lines.
struct Scene {
    name: &'static str,
    surface: Arc<Surface>,
    stops: Vec<SurfaceLine>,
    water: FlatWater,
}

impl Scene {
    /// Of heights alone.
    fn bare(name: &'static str, dem: Dem) -> Self {
        let water = FlatWater::of(&dem, 1.0).expect("water");
        Self { name, surface: Arc::new(Surface::new(dem)), stops: Vec::new(), water }
    }

    /// With the crests and channels of the land.
    fn of(name: &'static str, dem: Dem) -> Self {
        let relief = Relief::of(&dem, 1.0).expect("a relief");
        let stops = [relief.drainage(ChannelArea::Auto), relief.ridges().expect("ridges")].concat();
        Self { stops, ..Self::bare(name, dem) }
    }

    fn slopes(&self) -> Slopes {
        Slopes::new(self.surface.clone(), 1.0, RULES, &self.stops, Some(&self.water)).expect("slopes")
    }

    /// The smaller side of a cell, metres.
    fn unit(&self) -> f64 {
        self.surface.dem().cell().min_element()
    }

    /// All blocks whose lines may have so much room, cells.
    fn blocks(&self, room: f64) -> Vec<Arc<SlopeBlock>> {
        blocks(&self.slopes(), &|_| room * self.unit())
    }
}

/// The blocks that somebody needs.
fn blocks(slopes: &Slopes, need: &dyn Need) -> Vec<Arc<SlopeBlock>> {
    slopes.blocks(need).expect("blocks").into_iter().map(|needed| needed.block).collect()
}

/// All lines of blocks.
fn lines(blocks: &[Arc<SlopeBlock>]) -> impl Iterator<Item = &SlopeLine> {
    blocks.iter().flat_map(|block| &block.lines)
}

/// A DEM of a height, metres, at every place, metres east and south.
fn land([columns, rows]: [usize; 2], height: impl Fn(DVec2) -> f64) -> Dem {
    let at = |i: usize| DVec2::new((i % columns) as f64, (i / columns) as f64) * CELL;
    let heights = (0..columns * rows).map(|i| height(at(i)) as f32).collect();
    Dem::from_heights(columns, DVec2::splat(CELL), DVec2::ZERO, heights)
}

/// A slope of 20 %, not along the grid.
fn plane(size: [usize; 2]) -> Dem {
    land(size, |at| 0.2 * at.dot(DVec2::new(0.8, 0.6)))
}

/// Samples of a DEM from a column and row on.
fn part(dem: &Dem, first: [usize; 2], size: [usize; 2]) -> Dem {
    let samples = dem.window(first, size).expect("samples");
    let heights = (0..size[1]).flat_map(|r| samples.row_from(first[0], first[1] + r).collect::<Vec<_>>());
    let heights: Vec<f32> = heights.map(|height| height.unwrap_or(f32::NAN)).collect();
    let origin = dem.position(first[0], first[1]).truncate();
    Dem::from_heights(samples.size()[0], dem.cell(), origin, heights)
}

/// The sample of this repository, a part of it with water.
fn sample() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("dem/golden-gate.tif");
    Scene::of("golden-gate", read(&path, &ReadOptions::default()).expect("the sample"))
}

/// The sample and, where it is there, parts of the shared terrain.
fn real() -> Vec<Scene> {
    let shared = [
        ("west-temple", "west_temple_50m.tif", [0, 0]),
        ("yosemite", "yosemite_utm11n_30m.tif", [250, 200]),
        ("st-helens", "sthelens_utm10n_10m.tif", [500, 600]),
    ];
    let of_file = |folder: &Path, (name, file, first): (&'static str, &str, [usize; 2])| {
        let dem = read(folder.join(file), &ReadOptions::default()).expect("a DEM");
        let size = [0, 1].map(|i| 200.min([dem.columns(), dem.rows()][i] - first[i]));
        Scene::of(name, part(&dem, first, size))
    };
    let shared = shared_dems().map(|folder| shared.map(|scene| of_file(&folder, scene))).into_iter().flatten();
    std::iter::once(sample()).chain(shared).collect()
}

/// A world position on the surface at any place, linear between the lattice's vertices about it.
fn position(surface: &Surface, at: DVec2) -> Option<DVec3> {
    let vertex = |at: DVec2| {
        let [x, y] = at.to_array().map(|at| at as u32);
        surface.position(hachure::door::surface::LatticePoint { x, y })
    };
    let (floor, share) = ((at * 64.0).floor(), (at * 64.0).fract());
    let mix = |from: Option<DVec3>, to: Option<DVec3>, share: f64| match share {
        0.0 => from,
        share => Some(from?.lerp(to?, share)),
    };
    let row = |y: f64| mix(vertex(floor + DVec2::new(0.0, y)), vertex(floor + DVec2::new(1.0, y)), share.x);
    mix(row(0.0), row(1.0), share.y)
}

/// The part of a whole that values make up, 0 of none.
fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}
