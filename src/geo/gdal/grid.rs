//! A raster's grid as its file lays it: which place each sample has, however the rows run.

use std::ops::RangeInclusive;

use gdal::Metadata;
use glam::{DAffine2, DMat2, DVec2};

use super::source::{Source, heard};
use super::{crs, labels};
use crate::dem::{Crs, FileSamples, History, Window};
use crate::error::{Error, Result, Setting, shown};
use crate::message;

/// How far, in cells, a row may leave its line before the grid counts as turned: rounding of file formats.
const STRAIGHT_CELLS: f64 = 1e-3;
/// How far, in cells, a crop edge may miss a sample centre and still hold it: rounding of decimal coordinates.
const CROP_CELLS: f64 = 1e-6;
/// Cells below this size, inside the range of degrees and without a CRS, are taken for degrees: 0.1 degree is 11 km.
const DEGREE_CELL: f64 = 0.1;
/// Sound cell sizes in any unit: from a centimetre in degrees to a thousand kilometres in metres.
const CELLS: RangeInclusive<f64> = 1e-7..=1e6;
/// No coordinate of a map is beyond this, in any unit.
const FARTHEST: f64 = 1e9;
/// Points along each side of an outline: between them a side bends by less than a cell.
const SIDE_POINTS: usize = 64;

/// Samples in rows and columns, with the place of each in a coordinate system. The middle of pixel (c, r) is sample
/// (c, r): pixel coordinates (c + 0.5, r + 0.5).
#[derive(Debug, Clone)]
pub(super) struct GeoGrid {
    /// The system of its places.
    pub crs: Crs,
    /// From pixel coordinates to places.
    pub to_crs: DAffine2,
    /// Samples in a row.
    pub columns: usize,
    /// Samples in a column.
    pub rows: usize,
}

impl GeoGrid {
    /// Of `source`, placed by `cell` (metres) where the file does not say where it lies and is read `alone`. Clauses on
    /// what had to be assumed go to `history`.
    pub(super) fn of(source: &Source, cell: Option<f64>, alone: bool, history: &mut History) -> Result<Self> {
        let Source { columns, rows, .. } = *source;
        let (reference, _) = heard(|| source.dataset.spatial_ref());
        let (to_crs, placed) = match (geotransform(source), cell) {
            (Some(_), Some(_)) => return Err(has_place(source)),
            (Some(to_crs), None) => (to_crs, true),
            (None, _) if is_curved(source) => return Err(curved(source)),
            (None, _) if !alone => return Err(has_no_place_beside(source)),
            (None, Some(cell)) => (from_cell(rows, cell), false),
            (None, None) => return Err(has_no_place(source)),
        };
        if placed {
            crs::check_register()?;
        }
        let crs = match reference {
            Ok(reference) if placed => {
                let name = reference.name().unwrap_or_default();
                Crs::of(reference).ok_or_else(|| no_map(source, &name))?
            }
            _ if placed => {
                let grid = Self { crs: Crs::unknown(), to_crs, columns, rows };
                let degrees = looks_like_degrees(&grid, DEGREE_CELL);
                history.assume(assumed_crs(degrees));
                if degrees { Crs::lonlat()? } else { Crs::unknown() }
            }
            _ => Crs::unknown(),
        };
        let grid = Self { crs, to_crs, columns, rows };
        grid.check_size(source)?;
        if placed {
            labels::check(&grid, source, history)?;
        }
        Ok(grid)
    }

    /// The same samples with rows from west to east and columns from north to south, where that takes no more than
    /// reading them backwards; else the grid as it is.
    pub(super) fn north_up(&self) -> Self {
        let DMat2 { x_axis: along, y_axis: down } = self.to_crs.matrix2;
        let drift = [along.y * self.columns as f64 / down.y, down.x * self.rows as f64 / along.x];
        if !drift.iter().all(|cells| cells.abs() <= STRAIGHT_CELLS) {
            return self.clone();
        }
        let corner = self.to_crs.translation;
        let far = corner + DVec2::new(along.x * self.columns as f64, down.y * self.rows as f64);
        let west_north = DVec2::new(corner.x.min(far.x), corner.y.max(far.y));
        let matrix = DMat2::from_diagonal(DVec2::new(along.x.abs(), -down.y.abs()));
        Self { to_crs: DAffine2::from_mat2_translation(matrix, west_north), ..self.clone() }
    }

    /// The same samples with rows for columns, where rows run along columns and columns along rows; `None` elsewhere.
    pub(super) fn transposed(&self) -> Option<Self> {
        let DMat2 { x_axis: along, y_axis: down } = self.to_crs.matrix2;
        let drift = [along.x * self.columns as f64 / down.x, down.y * self.rows as f64 / along.y];
        let to_crs = self.to_crs * DAffine2::from_mat2(DMat2::from_cols(DVec2::Y, DVec2::X));
        let swapped = Self { crs: self.crs.clone(), to_crs, columns: self.rows, rows: self.columns };
        drift.iter().all(|cells| cells.abs() <= STRAIGHT_CELLS).then_some(swapped)
    }

    /// Whether rows run from west to east and columns from north to south.
    pub(super) fn is_north_up(&self) -> bool {
        let m = self.to_crs.matrix2;
        m.x_axis.y == 0.0 && m.y_axis.x == 0.0 && m.x_axis.x > 0.0 && m.y_axis.y < 0.0
    }

    /// What the file has.
    pub(super) fn samples(&self) -> FileSamples {
        FileSamples { size: Some([self.columns, self.rows]), cell: Some(self.cell()), crs: Some(self.crs.clone()) }
    }

    /// Lengths of the steps along a row and down a column, in units of the CRS.
    pub(super) fn cell(&self) -> DVec2 {
        DVec2::new(self.to_crs.matrix2.x_axis.length(), self.to_crs.matrix2.y_axis.length())
    }

    /// The same in metres, of 1 where the unit is unknown.
    pub(super) fn step(&self) -> [f64; 2] {
        (self.cell() * self.crs.metres_per_unit().unwrap_or(1.0)).to_array()
    }

    /// Place of sample (c, r).
    pub(super) fn sample(&self, c: f64, r: f64) -> DVec2 {
        self.to_crs.transform_point2(DVec2::new(c + 0.5, r + 0.5))
    }

    /// Place of the middle of a window.
    pub(super) fn centre(&self, window: Window) -> DVec2 {
        let [c, r] = [0, 1].map(|i| window.first[i] as f64 + window.size[i] as f64 / 2.0);
        self.to_crs.transform_point2(DVec2::new(c, r))
    }

    /// Pixel coordinates of places. Longitudes are taken round the globe to where the grid is.
    pub(super) fn pixels(&self, places: &mut [DVec2]) {
        let back = self.to_crs.inverse();
        let middle = self.centre(self.whole()).x;
        for place in places {
            place.x = self.crs.near(place.x, middle);
            *place = back.transform_point2(*place);
        }
    }

    /// All samples.
    pub(super) fn whole(&self) -> Window {
        Window { first: [0, 0], size: [self.columns, self.rows] }
    }

    /// The grid of a window's samples alone.
    pub(super) fn part(&self, window: Window) -> Self {
        let corner = DVec2::new(window.first[0] as f64, window.first[1] as f64);
        let to_crs = self.to_crs * DAffine2::from_translation(corner);
        Self { to_crs, columns: window.size[0], rows: window.size[1], crs: self.crs.clone() }
    }

    /// Places of a window's outline.
    pub(super) fn outline(&self, window: Window) -> Vec<DVec2> {
        window.outline().into_iter().map(|pixel| self.to_crs.transform_point2(pixel)).collect()
    }

    /// Least and largest places of the outermost samples: west, south, east, north in units of the CRS.
    pub(super) fn extent(&self) -> [f64; 4] {
        let (c, r) = ((self.columns - 1) as f64, (self.rows - 1) as f64);
        let corners = [[0.0, 0.0], [c, 0.0], [0.0, r], [c, r]].map(|[c, r]| self.sample(c, r));
        let [low, high] = span(&corners);
        [low.x, low.y, high.x, high.y]
    }

    /// The same in the coordinates of the file, whatever way they run there.
    pub(super) fn extent_in_file(&self) -> [f64; 4] {
        let [west, south, east, north] = self.extent();
        let corners =
            [DVec2::new(west, south), DVec2::new(east, north)].map(|corner| self.crs.axes().transpose() * corner);
        let [low, high] = span(&corners);
        [low.x, low.y, high.x, high.y]
    }

    /// The samples that `crop` (west, south, east, north) holds, `None` when it holds none. In a turned grid, all
    /// samples of the smallest window around it.
    pub(super) fn window(&self, [west, south, east, north]: [f64; 4]) -> Option<Window> {
        let middle = (west + east) / 2.0;
        let round = self.crs.near(middle, self.centre(self.whole()).x) - middle;
        let (west, east) = (west + round, east + round);
        let back = self.to_crs.inverse();
        let corners = [(west, south), (east, south), (east, north), (west, north)];
        let corners = corners.map(|(x, y)| back.transform_point2(DVec2::new(x, y)));
        let [low, high] = span(&corners);
        let (c, width) = centres_within([low.x, high.x], self.columns)?;
        let (r, height) = centres_within([low.y, high.y], self.rows)?;
        Some(Window { first: [c, r], size: [width, height] })
    }

    /// Cells and coordinates that f64 tells apart and a planet holds, in whatever unit.
    fn check_size(&self, source: &Source) -> Result<()> {
        let cell = self.cell();
        let [corner, middle] = [self.to_crs.translation, self.centre(self.whole())];
        let near = [corner.x, corner.y, middle.x, middle.y].iter().all(|v| v.abs() <= FARTHEST);
        let square = self.to_crs.matrix2.determinant().abs() / (cell.x * cell.y);
        if near && [cell.x, cell.y].iter().all(|cell| CELLS.contains(cell)) && square > STRAIGHT_CELLS {
            return Ok(());
        }
        let what = format!(
            "its place makes no sense: cells of {} x {}, the north-west corner at {},{}",
            cell.x, cell.y, corner.x, corner.y
        );
        Err(source.error(what, "correct its edges: `gdal_translate -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`"))
    }
}

impl Window {
    /// Pixel coordinates of points along the outermost samples, once round.
    pub(super) fn outline(self) -> Vec<DVec2> {
        let low = DVec2::new(self.first[0] as f64, self.first[1] as f64) + 0.5;
        let far = DVec2::new((self.size[0] - 1) as f64, (self.size[1] - 1) as f64);
        let along = (0..=SIDE_POINTS).map(|i| i as f64 / SIDE_POINTS as f64);
        along
            .flat_map(|s| [(s, 0.0), (s, 1.0), (0.0, s), (1.0, s)].map(|(x, y)| low + far * DVec2::new(x, y)))
            .collect()
    }

    /// The same in blocks of at most `size` columns and rows, row by row of blocks.
    pub(super) fn blocks(self, size: [usize; 2]) -> impl Iterator<Item = Self> {
        let starts = move |i: usize| (0..self.size[i]).step_by(size[i]);
        starts(1).flat_map(move |r| starts(0).map(move |c| [c, r])).map(move |at| Self {
            first: [0, 1].map(|i| self.first[i] + at[i]),
            size: [0, 1].map(|i| size[i].min(self.size[i] - at[i])),
        })
    }
}

/// Least and largest coordinates.
pub(super) fn span(places: &[DVec2]) -> [DVec2; 2] {
    let of = |start, pick: fn(DVec2, DVec2) -> DVec2| places.iter().copied().fold(start, pick);
    [of(DVec2::INFINITY, DVec2::min), of(DVec2::NEG_INFINITY, DVec2::max)]
}

/// First and number of the pixel centres 0.5, 1.5 … below `count` inside `from..=to`.
fn centres_within([from, to]: [f64; 2], count: usize) -> Option<(usize, usize)> {
    let first = (from - 0.5 - CROP_CELLS).ceil().max(0.0);
    let last = (to - 0.5 + CROP_CELLS).floor().min(count as f64 - 1.0);
    (first <= last).then(|| (first as usize, (last - first) as usize + 1))
}

/// From pixel coordinates to places, where the file says so.
fn geotransform(source: &Source) -> Option<DAffine2> {
    const NOWHERE: [f64; 6] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let (transform, _) = heard(|| source.dataset.geo_transform());
    let [x, along_x, down_x, y, along_y, down_y] = transform.ok().filter(|t| *t != NOWHERE)?;
    let matrix = DMat2::from_cols(DVec2::new(along_x, along_y), DVec2::new(down_x, down_y));
    let affine = DAffine2::from_mat2_translation(matrix, DVec2::new(x, y));
    affine.is_finite().then_some(affine)
}

/// Square pixels of `cell` metres, the south-west corner at 0, 0.
fn from_cell(rows: usize, cell: f64) -> DAffine2 {
    let matrix = DMat2::from_diagonal(DVec2::new(cell, -cell));
    DAffine2::from_mat2_translation(matrix, DVec2::new(0.0, rows as f64 * cell))
}

/// Whether coordinates look like longitude and latitude, with cells below `largest`.
pub(super) fn looks_like_degrees(grid: &GeoGrid, largest: f64) -> bool {
    let far = grid.to_crs.transform_point2(DVec2::new(grid.columns as f64, grid.rows as f64));
    let on_globe = [grid.to_crs.translation, far].iter().all(|p| p.x.abs() <= 360.0 && p.y.abs() <= 90.0);
    on_globe && grid.cell().max_element() < largest
}

fn assumed_crs(degrees: bool) -> String {
    let (what, how) = match degrees {
        true => ("longitude and latitude in degrees, WGS 84", "cells so small look like it"),
        false => ("metres", "no longitude and latitude can be given"),
    };
    format!(
        "coordinates are {what} (no coordinate system is named, {how}; \
         name it with `gdal_translate -a_srs EPSG:CODE IN OUT.tif`)"
    )
}

fn has_place(source: &Source) -> Error {
    let what = format!("{} says itself where it lies and how large its cells are", shown(&source.path));
    Error::setting(
        Setting::Cell,
        what,
        message!["leave it out, or use ", Setting::Resample, " for cells of another size"],
    )
}

/// Whether the place of each sample stands in arrays beside it.
fn is_curved(source: &Source) -> bool {
    source.dataset.metadata_domain("GEOLOCATION").is_some_and(|lines| !lines.is_empty())
}

fn curved(source: &Source) -> Error {
    source.error(
        "its samples lie on no straight grid: the place of each stands in arrays of its own",
        "warp it first, then give OUT.tif: `gdalwarp -geoloc -t_srs EPSG:4326 -ot Float32 -dstnodata nan IN OUT.tif`",
    )
}

fn has_no_place(source: &Source) -> Error {
    if !source.dataset.gcps().is_empty() {
        return source.error(
            "has control points but no geotransform",
            "rectify it first: `gdalwarp -t_srs EPSG:CODE -r cubic IN OUT.tif` with the code of a CRS in metres",
        );
    }
    source.error(
        "does not say where it lies (no geotransform)",
        message!["give the size of its cells in metres with ", Setting::Cell.with_value()],
    )
}

fn has_no_place_beside(source: &Source) -> Error {
    source.error(
        "does not say where it lies (no geotransform), so it cannot be laid beside others",
        message![
            "draw it alone with ",
            Setting::Cell.with_value(),
            ", or place it: `gdal_translate -a_srs EPSG:CODE -a_ullr WEST NORTH EAST SOUTH IN OUT.tif`"
        ],
    )
}

fn no_map(source: &Source, name: &str) -> Error {
    source.error(
        format!("its coordinate system \"{name}\" is no map projection"),
        "name the map that its coordinates are of: `gdal_translate -a_srs EPSG:CODE IN OUT.tif`",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_centre_on_the_edge_is_inside() {
        assert_eq!(centres_within([0.5, 2.5], 9), Some((0, 3)));
        assert_eq!(centres_within([0.51, 2.49], 9), Some((1, 1)));
        assert_eq!(centres_within([-7.0, 99.0], 9), Some((0, 9)));
        assert_eq!(centres_within([9.0, 12.0], 9), None);
        assert_eq!(centres_within([0.6, 1.4], 9), None);
    }
}
