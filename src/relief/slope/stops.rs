//! Lines at which slope lines end: crests and channels.
//!
//! Cost: the pieces of lines in the cells of a step, mostly none. Memory: 4 bytes a cell, some 40 a piece.

use glam::DVec2;
use xxhash_rust::xxh3::Xxh3;

use crate::relief::SurfaceLine;

/// How far beyond its ends a piece still stops, as a share of it, so that nothing slips through between two.
const SLACK: f64 = 1e-9;

/// Pieces of lines by the cells that they touch. Places are columns and rows.
#[derive(Debug)]
pub(super) struct Stops {
    cells: [usize; 2],
    /// Where in `pieces` those of each cell begin, row by row, and where the last end.
    first: Vec<u32>,
    pieces: Vec<[DVec2; 2]>,
}

impl Stops {
    /// Of lines on a grid of cells, each a share of the cells that the lines are told in.
    pub(super) fn new(lines: &[SurfaceLine], cells: [usize; 2], scale: f64) -> Self {
        let of_line = |line: &SurfaceLine| {
            let last = line.points.last().filter(|_| line.closed).into_iter().chain(&line.points);
            let ends: Vec<DVec2> = last.map(|point| point.at / scale).collect();
            ends.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>()
        };
        let touched = |piece: [DVec2; 2]| overlapped(cells, piece).map(move |cell| (cell, piece));
        let mut all: Vec<_> = lines.iter().flat_map(of_line).flat_map(touched).collect();
        all.sort_by_key(|(cell, _)| *cell);
        let mut first = vec![0; cells[0] * cells[1] + 1];
        all.iter().for_each(|(cell, _)| first[cell + 1] += 1);
        first.iter_mut().fold(0, |before, count| {
            *count += before;
            *count
        });
        Self { cells, first, pieces: all.into_iter().map(|(_, piece)| piece).collect() }
    }

    /// Adds to a hash where they are.
    pub(super) fn identify(&self, hash: &mut Xxh3) {
        self.pieces.iter().for_each(|[from, to]| hash.update(bytemuck::bytes_of(&[from.to_array(), to.to_array()])));
    }

    /// The share of the way from one place to another at which the first piece is met.
    pub(super) fn met(&self, [from, to]: [DVec2; 2]) -> Option<f64> {
        let of_cell = |cell: usize| &self.pieces[self.first[cell] as usize..self.first[cell + 1] as usize];
        let pieces = overlapped(self.cells, [from, to]).flat_map(of_cell);
        pieces.filter_map(|piece| crossing([from, to], *piece)).reduce(f64::min)
    }
}

/// Cells that the bounds of a piece overlap.
fn overlapped([columns, rows]: [usize; 2], [a, b]: [DVec2; 2]) -> impl Iterator<Item = usize> {
    let last = DVec2::new(columns as f64, rows as f64) - 1.0;
    let cell = |at: DVec2| at.clamp(DVec2::ZERO, last).as_usizevec2();
    let (low, high) = (cell(a.min(b)), cell(a.max(b)));
    (low.y..=high.y).flat_map(move |row| (low.x..=high.x).map(move |column| row * columns + column))
}

/// The share of the way `from`, `to` at which it meets a piece.
fn crossing([from, to]: [DVec2; 2], [a, b]: [DVec2; 2]) -> Option<f64> {
    let (way, piece, off) = (to - from, b - a, a - from);
    let area = way.perp_dot(piece);
    let shares = [off.perp_dot(piece), off.perp_dot(way)].map(|part| part / area);
    let within = -SLACK..=1.0 + SLACK;
    shares.iter().all(|share| within.contains(share)).then_some(shares[0])
}
