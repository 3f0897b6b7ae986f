//! How crowded the page is along chains.
//!
//! Cost: a look at nine rows of pixels for each point.

use glam::DVec2;

use super::{Chain, ChainPoint, Marks};
use crate::view::Perspective;

/// Half the side of the square in which ink counts as crowding, px.
const CROWD: i64 = 4;
/// Longest piece of a chain between two counts, px.
const STEP: f64 = 6.0;

/// The chains with the ink of the page about each of their points counted, and with more points between those that lie
/// more than 6 px apart.
pub fn crowded(chains: &[Chain], marks: &Marks, perspective: &Perspective) -> Vec<Chain> {
    let counted = |point: ChainPoint| ChainPoint { crowd: crowd(marks, point.place), ..point };
    let crowded = |chain: &Chain| Chain { points: stepped(chain, perspective).map(counted).collect(), ..*chain };
    chains.iter().map(crowded).collect()
}

/// The chain's points with others between them, at most [`STEP`] px apart.
fn stepped(chain: &Chain, perspective: &Perspective) -> impl Iterator<Item = ChainPoint> {
    let next = |i: usize| chain.points.get(i + 1).or(chain.points.first().filter(|_| chain.closed));
    chain.points.iter().enumerate().flat_map(move |(i, a)| {
        let b = next(i).unwrap_or(a);
        let steps = (a.place.distance(b.place) / STEP).ceil().max(1.0) as u32;
        (0..steps).map(move |s| {
            let t = f64::from(s) / f64::from(steps);
            let log = a.log_depth() + (b.log_depth() - a.log_depth()) * t;
            ChainPoint::seen(a.place.lerp(b.place, t), a.line, log.exp() as f32, perspective)
        })
    })
}

/// Inked pixels in the square about a place.
fn crowd(marks: &Marks, place: DVec2) -> u32 {
    let (column, row) = (place.x.floor() as i64, place.y.floor() as i64);
    let in_row = |row: i64| {
        let first = marks.row(row).partition_point(|mark| i64::from(mark.column) < column - CROWD);
        let near = marks.row(row)[first..].iter().take_while(|mark| i64::from(mark.column) <= column + CROWD);
        near.filter(|mark| mark.pixel.is_ink()).count() as u32
    };
    (row - CROWD..=row + CROWD).map(in_row).sum()
}
