//! How well ink agrees with a true line: precision and recall, as the share of inked pixels near the line and the
//! share of the line near ink. Distances are exact, from points to the line's pieces. Cost: pixels times pieces.

use glam::DVec2;
use hachure::ink::{InkRaster, Kind};

use crate::tolerances::REACH_PX;

/// The visible parts of a line on the page, in pieces of at most a quarter pixel.
#[derive(Debug, Clone, Default)]
pub struct Truth {
    /// Ends of each piece, px.
    pub pieces: Vec<[DVec2; 2]>,
}

/// What a comparison found, beside how much was compared.
#[derive(Debug, Clone, Copy)]
pub struct Score {
    /// Share of inked pixels within [`REACH_PX`] of the line.
    pub precision: f64,
    /// Share of the line within [`REACH_PX`] of an inked pixel's centre.
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

impl Truth {
    /// Distance of a point from the line, px.
    pub fn distance(&self, p: DVec2) -> f64 {
        self.pieces.iter().map(|&[a, b]| to_piece(p, a, b)).fold(f64::INFINITY, f64::min)
    }
}

/// Compares ink, given as points on the page, with the line on a page of this size.
///
/// # Panics
/// Without ink or without a line on the page: nothing compared is no agreement.
pub fn score(ink: &[DVec2], truth: &Truth, page: [u32; 2]) -> Score {
    let page = DVec2::new(f64::from(page[0]), f64::from(page[1]));
    let on_page = |p: DVec2| p.cmpge(DVec2::ZERO).all() && p.cmplt(page).all();
    let distances: Vec<f64> = ink.iter().map(|&p| truth.distance(p)).collect();
    let (mut length, mut found) = (0.0, 0.0);
    for [a, b] in &truth.pieces {
        let middle = a.midpoint(*b);
        if on_page(middle) {
            length += a.distance(*b);
            let near = ink.iter().any(|p| p.distance_squared(middle) <= REACH_PX * REACH_PX);
            found += if near { a.distance(*b) } else { 0.0 };
        }
    }
    assert!(!ink.is_empty(), "no ink to compare with {length:.0} px of line");
    assert!(length > 0.0, "no line to compare {} px of ink with", ink.len());
    let near = distances.iter().filter(|d| **d <= REACH_PX).count();
    Score {
        precision: near as f64 / ink.len() as f64,
        recall: found / length,
        mean: distances.iter().sum::<f64>() / ink.len() as f64,
        farthest: distances.iter().copied().fold(0.0, f64::max),
        ink: ink.len(),
        length,
    }
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

/// Distance of a point from a piece of line, px.
fn to_piece(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let t = (p - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
    p.distance(a.lerp(b, t.clamp(0.0, 1.0)))
}
