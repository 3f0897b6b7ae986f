//! The ink of a page of any size, as a list.
//!
//! A page of a thousand million pixels has some hundred thousand inked ones: they alone are kept, 20 bytes each, in
//! reading order. So are pixels of the cover that ink all but encloses, since tracing fills holes of the cover and none
//! of the sky. A page drawn in pieces gives the same list as in one. Cost: one look at each pixel, on every core.

use rayon::prelude::*;

use super::{InkRaster, Kind, Pixel};
use crate::plan::PagePiece;
use crate::plan::pieces::Rectangle;

/// Of 8 neighbours of a pixel of the cover, inked ones that all but enclose it: holes have two pixels at most.
const ENCLOSED: usize = 7;

/// A pixel and its place on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// From the left.
    pub column: u32,
    /// From the top.
    pub row: u32,
    /// What it shows.
    pub pixel: Pixel,
    /// Whether it is ink with sky among its 8 neighbours.
    pub beside_sky: bool,
}

/// The inked pixels of a page, and those that ink encloses.
#[derive(Debug, Clone, PartialEq)]
pub struct Marks {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    list: Vec<Mark>,
    /// Where each row begins in the list, and where the last ends.
    rows: Vec<usize>,
}

impl Marks {
    /// The marks of a page of so many pixels across and down, in any order; none may be given twice or lie outside.
    pub fn new([width, height]: [u32; 2], mut list: Vec<Mark>) -> Self {
        list.sort_unstable_by_key(|mark| (mark.row, mark.column));
        let rows = (0..=height).map(|row| list.partition_point(|mark| mark.row < row)).collect();
        Self { width, height, list, rows }
    }

    /// In reading order.
    pub fn iter(&self) -> impl Iterator<Item = &Mark> {
        self.list.iter()
    }

    /// The inked ones, in reading order.
    pub fn ink(&self) -> impl Iterator<Item = &Mark> {
        self.iter().filter(|mark| mark.pixel.is_ink())
    }

    /// Column and row of the inked ones, in reading order.
    pub fn places(&self) -> impl Iterator<Item = [u32; 2]> {
        self.ink().map(|mark| [mark.column, mark.row])
    }

    /// How many pixels are ink.
    pub fn inked(&self) -> usize {
        self.ink().count()
    }

    /// The mark in this column and row, if there is one.
    pub fn at(&self, column: i64, row: i64) -> Option<&Mark> {
        let row = self.row(row);
        let found = row.binary_search_by_key(&column, |mark| i64::from(mark.column));
        found.ok().map(|i| &row[i])
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Marks {
    /// Depths of the inked ones, in reading order; 0 where there is none.
    pub fn depths(&self) -> impl Iterator<Item = f32> {
        self.ink().map(|mark| mark.pixel.depth())
    }

    /// The marks of a row from left to right; none outside the page.
    pub fn row(&self, row: i64) -> &[Mark] {
        let inside = usize::try_from(row).ok().filter(|row| row + 1 < self.rows.len());
        inside.map_or(&[], |row| &self.list[self.rows[row]..self.rows[row + 1]])
    }
}

/// The marks of a page that was drawn in one.
impl From<&InkRaster> for Marks {
    fn from(raster: &InkRaster) -> Self {
        let size = [raster.width, raster.height];
        let whole = Rectangle { origin: [0, 0], size };
        Self::new(size, of_piece(raster, PagePiece { kept: whole, drawn: whole }))
    }
}

/// The marks of a piece, which was drawn as `raster`, halo and all.
pub(crate) fn of_piece(raster: &InkRaster, piece: PagePiece) -> Vec<Mark> {
    let [left, top] = [0, 1].map(|axis| piece.kept.origin[axis] - piece.drawn.origin[axis]);
    let [width, height] = piece.kept.size;
    let [x, y] = piece.drawn.origin;
    let of_row = |row: u32| {
        let start = row as usize * raster.width as usize;
        let pixels = &raster.pixels[start + left as usize..][..width as usize];
        let marks = (left..).zip(pixels).filter(move |&(column, pixel)| is_mark(raster, column, row, *pixel));
        marks.map(move |(column, &pixel)| Mark {
            column: x + column,
            row: y + row,
            pixel,
            beside_sky: pixel.is_ink() && around(raster, column, row).any(|pixel| pixel.kind() == Kind::Sky),
        })
    };
    (top..top + height).into_par_iter().flat_map_iter(of_row).collect()
}

/// How many pixels of a piece, which was drawn as `raster`, show land.
pub(crate) fn covered(raster: &InkRaster, piece: PagePiece) -> u64 {
    let [left, top] = [0, 1].map(|axis| (piece.kept.origin[axis] - piece.drawn.origin[axis]) as usize);
    let [width, height] = piece.kept.size.map(|side| side as usize);
    let of_row = |row: usize| {
        let pixels = &raster.pixels[row * raster.width as usize + left..][..width];
        pixels.iter().filter(|pixel| pixel.kind() != Kind::Sky).count() as u64
    };
    (top..top + height).into_par_iter().map(of_row).sum()
}

/// The pixels of the 3 x 3 block about one.
fn around(raster: &InkRaster, column: u32, row: u32) -> impl Iterator<Item = Pixel> {
    let beside = |at: u32| i64::from(at) - 1..=i64::from(at) + 1;
    beside(row).flat_map(move |row| beside(column).filter_map(move |column| raster.at(column, row)))
}

fn is_mark(raster: &InkRaster, column: u32, row: u32, pixel: Pixel) -> bool {
    let is_ink = |column: i64| raster.at(column, i64::from(row)).is_some_and(Pixel::is_ink);
    let has_ink_beside = || is_ink(i64::from(column) - 1) || is_ink(i64::from(column) + 1);
    let inked = || around(raster, column, row).filter(|pixel| pixel.is_ink()).count();
    // Most pixels have no ink beside them.
    pixel.is_ink() || (pixel.kind() == Kind::Cover && has_ink_beside() && inked() >= ENCLOSED)
}
