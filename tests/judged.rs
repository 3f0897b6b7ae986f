//! What the library's judge is given, and the figures of it that tests ask for.

use glam::DVec2;
use hachure::line::{InkRaster, Kind};
use hachure::truth::metrics::Judge;
use hachure::truth::{Inked, Mask, Truth, TruthLine, TruthPiece};

use crate::scenes::level;

/// What a comparison found, beside how much was compared.
#[derive(Debug, Clone, Copy)]
pub struct Score {
    /// Share of inked pixels within 1 px of the line.
    pub precision: f64,
    /// Share of the line within 1 px of ink.
    pub recall: f64,
    /// Mean distance of inked pixels from the line, px.
    pub mean: f64,
    /// Largest such distance, px.
    pub farthest: f64,
    /// Inked pixels.
    pub ink: usize,
    /// Pixels of true line on the page.
    pub length: f64,
}

/// Judges a mask by lines on a page of its size.
///
/// # Panics
/// Without ink or without a line on the page: nothing compared is no agreement.
pub fn score(mask: &Mask, truth: &Truth) -> Score {
    let judge = Judge::new(truth).unwrap_or_else(|| panic!("no line to compare {} px of ink with", mask.inked.len()));
    let centres: Vec<DVec2> = mask.inked.iter().map(Inked::centre).collect();
    let offsets = judge.offsets(&centres);
    let offsets = offsets.unwrap_or_else(|| panic!("no ink to compare with {:.0} px of line", truth.length()));
    let agreement = judge.measure(mask).scores().agreement();
    Score {
        precision: agreement.precision,
        recall: agreement.recall,
        mean: offsets.mean,
        farthest: centres.iter().map(|p| judge.distance(*p)).fold(0.0, f64::max),
        ink: centres.len(),
        length: truth.length(),
    }
}

/// A truth of these pieces, which no level was looked at for.
pub fn truth(size: [u32; 2], pieces: Vec<TruthPiece>) -> Truth {
    Truth { level: level(1), size, pieces, facets: 0, rays: 0 }
}

/// A piece of contour, `distance` metres along the view axis.
pub fn piece(ends: [DVec2; 2], distance: f64) -> TruthPiece {
    TruthPiece { ends, distance, line: TruthLine::Contour }
}

/// All ink of a picture whose near plane lies `near` metres before the eye.
pub fn mask(raster: &InkRaster, near: f64) -> Mask {
    let pixels = (0..).zip(&raster.pixels).filter(|(_, pixel)| pixel.is_ink());
    let inked = pixels.map(|(i, pixel): (u32, _)| Inked {
        column: i % raster.width,
        row: i / raster.width,
        distance: pixel.distance(near),
    });
    Mask { size: [raster.width, raster.height], inked: inked.collect() }
}

/// A mask moved by whole pixels right and down; what leaves the page is lost.
pub fn moved(mask: &Mask, by: [i32; 2]) -> Mask {
    let place = |at: u32, by: i32, size: u32| at.checked_add_signed(by).filter(|at| *at < size);
    let [width, height] = mask.size;
    let inked = mask.inked.iter().filter_map(|p| {
        let (column, row) = (place(p.column, by[0], width)?, place(p.row, by[1], height)?);
        Some(Inked { column, row, ..*p })
    });
    Mask { size: mask.size, inked: inked.collect() }
}

/// Pixels of a kind: centres, and centres moved by the sub-pixel place.
pub fn inked(raster: &InkRaster, kind: Kind) -> Vec<(DVec2, DVec2)> {
    let centre = |i: usize| DVec2::new((i % raster.width as usize) as f64, (i / raster.width as usize) as f64) + 0.5;
    let pixels = raster.pixels.iter().enumerate().filter(|(_, p)| p.kind() == kind);
    pixels.map(|(i, p)| (centre(i), centre(i) + p.place())).collect()
}

/// The centres alone.
pub fn centres(raster: &InkRaster, kind: Kind) -> Vec<DVec2> {
    inked(raster, kind).into_iter().map(|(centre, _)| centre).collect()
}
