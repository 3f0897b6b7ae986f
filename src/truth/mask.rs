//! A mask as metrics see it: its inked pixels, and which of them hang together.

use glam::DVec2;

use super::{Truth, TruthPiece};

/// The inked pixels of a page.
#[derive(Debug, Clone, PartialEq)]
pub struct Mask {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Row by row, each pixel once.
    pub inked: Vec<Inked>,
}

/// An inked pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inked {
    /// From the left.
    pub column: u32,
    /// From the top.
    pub row: u32,
    /// Metres along the view axis to what it shows.
    pub distance: f64,
}

impl Inked {
    /// Its centre, px.
    pub fn centre(&self) -> DVec2 {
        DVec2::new(f64::from(self.column), f64::from(self.row)) + 0.5
    }
}

impl Mask {
    /// Truth drawn one pixel wide.
    pub fn of_truth(truth: &Truth) -> Self {
        Self::of_pieces(truth.size, truth.on_page())
    }

    /// The pixels that hold the middle of a piece; all middles must be on the page.
    pub(super) fn of_pieces<'a>(size: [u32; 2], pieces: impl Iterator<Item = &'a TruthPiece>) -> Self {
        let inked = |piece: &TruthPiece| {
            let place = piece.middle().as_uvec2();
            Inked { column: place.x, row: place.y, distance: piece.distance }
        };
        let mut inked: Vec<_> = pieces.map(inked).collect();
        inked.sort_by_key(|p| (p.row, p.column));
        inked.dedup_by_key(|p| (p.row, p.column));
        Self { size, inked }
    }

    /// Whether each pixel of the page is ink, row by row.
    pub fn pixels(&self) -> Vec<bool> {
        let mut pixels = vec![false; self.size[0] as usize * self.size[1] as usize];
        self.inked.iter().for_each(|p| pixels[self.index(p)] = true);
        pixels
    }

    /// Share of the inked pixels with ink of `other` in the 3 x 3 pixels around them: what does not pop; 1 without ink.
    pub fn beside(&self, other: &Self) -> f64 {
        match self.inked.len() {
            0 => 1.0,
            inked => (inked - self.alone(other)) as f64 / inked as f64,
        }
    }

    /// How many inked pixels have no ink of `other` in the 3 x 3 pixels around them.
    fn alone(&self, other: &Self) -> usize {
        let there = other.pixels();
        self.inked.iter().filter(|p| !self.block(p).any(|i| there[i])).count()
    }

    /// Place of a pixel on the page, row by row.
    fn index(&self, p: &Inked) -> usize {
        p.row as usize * self.size[0] as usize + p.column as usize
    }

    /// Places of the 3 x 3 pixels around a pixel, where they are on the page.
    fn block(&self, p: &Inked) -> impl Iterator<Item = usize> {
        let [width, height] = self.size;
        let span = |at: u32, size: u32| at.saturating_sub(1)..=(at + 1).min(size - 1);
        let (columns, rows) = (span(p.column, width), span(p.row, height));
        rows.flat_map(move |row| columns.clone().map(move |column| row as usize * width as usize + column as usize))
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Mask {
    /// The 8-connected sets of inked pixels, as places in [`Self::inked`], in the order of their first pixels.
    pub fn components(&self) -> Vec<Vec<usize>> {
        const NONE: usize = usize::MAX;
        let mut open = vec![NONE; self.size[0] as usize * self.size[1] as usize];
        self.inked.iter().enumerate().for_each(|(i, p)| open[self.index(p)] = i);
        let mut components = Vec::new();
        for i in 0..self.inked.len() {
            if std::mem::replace(&mut open[self.index(&self.inked[i])], NONE) == NONE {
                continue;
            }
            let mut component = vec![i];
            let mut next = 0;
            while let Some(&i) = component.get(next) {
                for beside in self.block(&self.inked[i]) {
                    let found = std::mem::replace(&mut open[beside], NONE);
                    component.extend((found != NONE).then_some(found));
                }
                next += 1;
            }
            components.push(component);
        }
        components
    }

    /// Share of 8-connected sets with fewer than `pixels` pixels; 0 without ink.
    pub fn fragments(&self, pixels: usize) -> f64 {
        let components = self.components();
        let short = components.iter().filter(|c| c.len() < pixels).count();
        short as f64 / components.len().max(1) as f64
    }

    /// Share of the inked pixels without ink of `next` in the 3 x 3 pixels around them, the pixels within 1 px; 0 without
    /// ink.
    pub fn pop(&self, next: &Self) -> f64 {
        self.alone(next) as f64 / self.inked.len().max(1) as f64
    }
}
