//! What a line of the land lacks where a page does not show it: of all that its [detail](super::detail) asks the least fulfilled.
//!
//! Cost: a look at each point of the line. Does not handle: what a line gains from branches that reach it, and averages along it.

use super::Land;
use super::along::fade;
use super::detail::{ACROSS, ACROSS_M, DROP, From, LENGTH, PLAIN_LENGTH, SLOPE, is_branch, river};
use crate::relief::{LineKind, SurfaceLine, SurfacePoint};

/// Of what there is too little.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Little {
    /// Of the line on the page, px.
    Length,
    /// Of its fall on the page, px.
    Drop,
    /// Of the height of the land beside it on the page, px.
    ReliefOnPage,
    /// Of that height, metres of the land.
    Relief,
    /// Of the slope beside it, metres a metre.
    Slope,
}

/// What a line of the land lacks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lack {
    /// What that is.
    pub what: Little,
    /// How much of it there is.
    pub is: f64,
    /// Up to how much the line is left out, and from which on it is whole.
    pub asked: [f64; 2],
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Land {
    /// What a line lacks most at one of its points; `None` under flat water, where none is drawn.
    pub fn lack(&self, line: usize, point: usize, from: From) -> Option<Lack> {
        let (line, world) = self.iter().nth(line)?;
        let at = line.points.get(point)?;
        let (places, scales): (Vec<_>, Vec<f64>) = world.iter().map(|point| from.sees(*point)).unzip();
        let length = places.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let lack = |what, is, asked| Lack { what, is, asked };
        if at.across[0].is_nan() {
            return None;
        }
        if !is_branch(line) {
            return Some(lack(Little::Length, length, PLAIN_LENGTH));
        }
        let exaggerated = |point: &SurfacePoint, scale: f64| f64::from(point.drop) * self.exaggeration() * scale;
        let drop = line.points.iter().zip(&scales).map(|(point, scale)| exaggerated(point, *scale)).fold(0.0, f64::max);
        let (across, aside) = self.across(at, scales[point]);
        let mut asks = vec![lack(Little::Length, length, LENGTH)];
        if !is_river(line, line.points.last()) {
            asks.push(lack(Little::Drop, drop, DROP));
        }
        if !is_river(line, Some(at)) {
            let on_page = across * self.exaggeration() * scales[point];
            asks.push(lack(Little::ReliefOnPage, on_page, ACROSS));
            asks.push(lack(Little::Relief, across, ACROSS_M));
            asks.push(lack(Little::Slope, across / aside, SLOPE));
        }
        // Where several are wanting wholly, the one that is farthest from enough.
        let share = |lack: &Lack| (fade(lack.asked, lack.is), lack.is / lack.asked[0]);
        asks.into_iter().min_by(|a, b| {
            let (a, b) = (share(a), share(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }
}

/// Whether a stream is a river there, which is drawn whatever the relief.
fn is_river(line: &SurfaceLine, at: Option<&SurfacePoint>) -> bool {
    line.kind == LineKind::Drainage && at.is_some_and(|at| river(line.kind, at) >= 1.0)
}
