//! Which cells of a page are set, in memory that grows with their number.

/// Cells of a block, side by side.
const BLOCK: usize = 512;

/// The pixels of a page as cells, with a margin of one on every side, so that each has 8 neighbours. Cells are numbered
/// in reading order.
///
/// A block of cells of which none is set takes 4 bytes.
#[derive(Clone)]
pub(super) struct CellGrid {
    /// Cells in a row: the page's width and the margin.
    pub stride: usize,
    /// Index of each block; 0 is the one without a cell.
    directory: Vec<u32>,
    blocks: Vec<[u64; BLOCK / 64]>,
}

impl CellGrid {
    /// An empty grid for a page of this size.
    pub(super) fn new(width: u32, height: u32) -> Self {
        let stride = width as usize + 2;
        let cells = stride * (height as usize + 2);
        Self { stride, directory: vec![0; cells.div_ceil(BLOCK)], blocks: vec![[0; BLOCK / 64]] }
    }

    /// The cell of a pixel.
    pub(super) fn cell(&self, column: u32, row: u32) -> usize {
        (row as usize + 1) * self.stride + column as usize + 1
    }

    /// Column and row of the pixel of a cell; -1 and more than the page has in the margin.
    pub(super) fn pixel(&self, cell: usize) -> [i64; 2] {
        [cell % self.stride, cell / self.stride].map(|v| v as i64 - 1)
    }

    /// The 8 neighbours of a cell of the page in turn: east, south-east, south … north-east. Even ones share a side.
    pub(super) fn around(&self, cell: usize) -> [usize; 8] {
        let s = self.stride;
        [cell + 1, cell + s + 1, cell + s, cell + s - 1, cell - 1, cell - s - 1, cell - s, cell - s + 1]
    }

    /// Whether the cell is set.
    pub(super) fn has(&self, cell: usize) -> bool {
        let block = self.directory[cell / BLOCK] as usize;
        self.blocks[block][cell % BLOCK / 64] >> (cell % 64) & 1 == 1
    }

    /// Which of the 8 neighbours are set, in the order of [`CellGrid::around`].
    pub(super) fn neighbours(&self, cell: usize) -> [bool; 8] {
        self.around(cell).map(|n| self.has(n))
    }

    /// Sets the cell.
    pub(super) fn set(&mut self, cell: usize) {
        let block = &mut self.directory[cell / BLOCK];
        if *block == 0 {
            *block = self.blocks.len() as u32;
            self.blocks.push([0; BLOCK / 64]);
        }
        self.blocks[*block as usize][cell % BLOCK / 64] |= 1 << (cell % 64);
    }

    /// Empties the cell.
    pub(super) fn clear(&mut self, cell: usize) {
        let block = self.directory[cell / BLOCK] as usize;
        // In the block without a cell nothing changes.
        self.blocks[block][cell % BLOCK / 64] &= !(1 << (cell % 64));
    }
}
