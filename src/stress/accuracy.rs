//! How far ink is from truth, by truth's own [metrics](crate::truth::metrics), and where it is worst.

use glam::DVec2;

use crate::truth::metrics::{Judge, Scores};
use crate::truth::{Mask, Truth};

/// What was measured of a mask.
#[derive(Debug, Clone)]
pub struct Accuracy {
    /// Every figure; `None` where truth has no line on the page.
    pub scores: Option<Scores>,
    /// Pixels of ink farther than 1.5 px from truth.
    pub astray: Vec<[u32; 2]>,
    /// Pixels of truth without ink within 1 px.
    pub missed: Vec<[u32; 2]>,
}

impl Accuracy {
    /// Of a mask of a page of truth.
    pub fn of(mask: &Mask, truth: &Truth) -> Self {
        let place = |p: &crate::truth::Inked| [p.column, p.row];
        let Some(judge) = Judge::new(truth) else {
            return Self { scores: None, astray: mask.inked.iter().map(place).collect(), missed: Vec::new() };
        };
        let measured = judge.measure(mask);
        let astray = mask.inked.iter().zip(measured.agrees()).filter(|(_, agrees)| !agrees);
        let astray = astray.map(|(p, _)| place(p)).collect();
        let missed = measured.missed().inked.iter().map(place).collect();
        Self { scores: Some(measured.scores()), astray, missed }
    }

    /// F within 1 px; `None` where truth has no line.
    pub fn f(&self) -> Option<f64> {
        self.scores.as_ref().map(|scores| scores.agreement().f())
    }
}

/// Of places those that stand for most others: the middles of squares of `side` px, the fullest first.
pub fn worst(places: &[[u32; 2]], side: u32, most: usize) -> Vec<(DVec2, usize)> {
    let mut squares = std::collections::BTreeMap::<[u32; 2], Vec<DVec2>>::new();
    for [column, row] in places {
        let place = DVec2::new(f64::from(*column), f64::from(*row)) + 0.5;
        squares.entry([column / side, row / side]).or_default().push(place);
    }
    let mean = |places: Vec<DVec2>| (places.iter().sum::<DVec2>() / places.len() as f64, places.len());
    let mut squares: Vec<_> = squares.into_values().map(mean).collect();
    squares.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    squares.truncate(most);
    squares
}
