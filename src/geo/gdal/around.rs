//! The grid of one layer run on over all others: as far as they lie in what is drawn, and as its map can show them.
//!
//! With a crop only what lies in it counts, with a few samples around it, for the outline of a whole globe says nothing of
//! where its land lies on a map of a part of it. What is left of a layer must lie inside its own outline on that map; else
//! the map cannot show it, which is an error. Cost: some thousand places a layer. A grid round the globe was laid
//! beside itself before, where the crop crosses its outer edges.

use glam::{DAffine2, DVec2};

use super::crs::CrsPath;
use super::grid::{GeoGrid, span};
use super::layer::FileLayer;
use super::layers::Layers;
use super::lie::Lie;
use crate::error::{Error, Result, Setting, shown};
use crate::message;

/// Samples beyond the crop that are kept: cubic convolution reaches two.
const MARGIN: f64 = 4.0;
/// Places along each side of a lattice over a layer.
const PLACES: usize = 24;
/// How far, as a share of its size, a lattice may be beyond the outline: a side bends between two places.
const BEND: f64 = 0.01;

/// First column and row, and those beyond the last.
type Bounds = ([i64; 2], [i64; 2]);

/// The grid of `base` run on over all `layers`, as far as it has places between their outermost samples and inside `crop`,
/// which is in the units of the first file. Fails where its map cannot show them.
pub(super) fn around(layers: &Layers, base: &FileLayer, crop: Option<[f64; 4]>) -> Result<GeoGrid> {
    let whole = ([0; 2], [base.grid.columns as i64, base.grid.rows as i64]);
    let own = layers.crop_on(&base.grid, crop)?;
    let kept = own.map(|crop| kept(&base.grid, crop));
    let mut bounds = whole;
    for layer in layers.all().iter().filter(|layer| !std::ptr::eq(*layer, base)) {
        // Of parts on both sides of where degrees begin anew together: the land between them is whole.
        let mut own: Option<Bounds> = None;
        for part in parts(layers, layer, crop) {
            let bounds = on(&part, &base.grid).ok_or_else(|| cannot_show(base, layer))?;
            own = Some(own.map_or(bounds, |own| around_both(own, bounds)));
        }
        let clipped = own.map(|own| kept.map_or(own, |kept| shared(own, kept)));
        if let Some(own) = clipped.filter(|(low, end)| (0..2).all(|i| low[i] < end[i])) {
            bounds = around_both(bounds, own);
        }
    }
    let (low, end) = bounds;
    let to_crs = base.grid.to_crs * DAffine2::from_translation(DVec2::new(low[0] as f64, low[1] as f64));
    let [columns, rows] = [0, 1].map(|i| end[i].saturating_sub(low[i]) as usize);
    Ok(GeoGrid { to_crs, columns, rows, crs: base.grid.crs.clone() })
}

fn around_both(one: Bounds, other: Bounds) -> Bounds {
    ([0, 1].map(|i| one.0[i].min(other.0[i])), [0, 1].map(|i| one.1[i].max(other.1[i])))
}

fn shared(one: Bounds, other: Bounds) -> Bounds {
    ([0, 1].map(|i| one.0[i].max(other.0[i])), [0, 1].map(|i| one.1[i].min(other.1[i])))
}

/// The columns and rows of `grid` run on that `crop` and a margin hold.
fn kept(grid: &GeoGrid, [west, south, east, north]: [f64; 4]) -> Bounds {
    let middle = (west + east) / 2.0;
    let round = grid.crs.near(middle, grid.centre(grid.whole()).x) - middle;
    let corners = [(west, south), (east, south), (east, north), (west, north)];
    let back = grid.to_crs.inverse();
    let [low, high] = span(&corners.map(|(x, y)| back.transform_point2(DVec2::new(x + round, y))));
    let whole = |place: DVec2| [place.x as i64, place.y as i64];
    (whole((low - MARGIN).floor()), whole((high + MARGIN).ceil()))
}

/// What of `layer` lies in `crop` and a few of its samples around it: two parts where they are at both its outer edges. All
/// of it where the crop has no place on its map.
fn parts(layers: &Layers, layer: &FileLayer, crop: Option<[f64; 4]>) -> Vec<GeoGrid> {
    let grid = &layer.grid;
    let Ok(Some([west, south, east, north])) = layers.crop_on(grid, crop) else { return vec![grid.clone()] };
    let margin = grid.cell() * MARGIN;
    let (west, east) = (west - margin.x, east + margin.x);
    // Where the grid ends and, a turn farther, begins.
    let edge = grid.crs.turn().map(|turn| {
        let edge = grid.extent()[0] - grid.cell().x / 2.0;
        edge + turn * ((west - edge) / turn).ceil()
    });
    let sides = match edge.filter(|edge| west < *edge && *edge < east) {
        Some(edge) => vec![[west, edge], [edge, east]],
        None => vec![[west, east]],
    };
    let windows =
        sides.into_iter().filter_map(|[west, east]| grid.window([west, south - margin.y, east, north + margin.y]));
    windows.map(|window| grid.part(window)).collect()
}

/// Where `part` of a layer lies on `base`; `None` where the map of that cannot show it.
fn on(part: &GeoGrid, base: &GeoGrid) -> Option<Bounds> {
    let lie = Lie::of(part, base)?;
    if let Lie::Aligned { .. } = lie {
        return Some(lie.bounds(part));
    }
    let way = CrsPath::between(&part.crs, &base.crs)?;
    let carried = |mut places: Vec<DVec2>| {
        way.carry(&mut places);
        base.pixels(&mut places);
        places
    };
    let [low, high] = span(&carried(part.outline(part.whole())));
    let bend = (high - low) * BEND + 1.0;
    let within = |place: DVec2| place.cmpge(low - bend).all() && place.cmple(high + bend).all();
    carried(lattice(part)).into_iter().all(within).then(|| lie.bounds(part))
}

/// Places all over a grid.
fn lattice(grid: &GeoGrid) -> Vec<DVec2> {
    let far = DVec2::new((grid.columns - 1) as f64, (grid.rows - 1) as f64) / PLACES as f64;
    let across =
        (0..(PLACES + 1).pow(2)).map(|i| DVec2::new((i % (PLACES + 1)) as f64, (i / (PLACES + 1)) as f64) * far);
    across.map(|at| grid.sample(at.x, at.y)).collect()
}

/// The error for a layer that is too much for the map of another.
fn cannot_show(base: &FileLayer, layer: &FileLayer) -> Error {
    Error::input(
        layer.path(),
        format!("reaches too far for the map of {} ({})", shown(base.path()), base.grid.crs.label()),
        message!["use ", Setting::Crop, " to take a part"],
    )
}
