//! Thins ink to lines one pixel wide.
//!
//! Method: sequential thinning, border pixels in the order north, south, west, east, taken off where that neither parts
//! nor joins anything (8-connected ink, 4-connected paper; Yokoi's connectivity number, 1973) nor shortens a line end.
//! Where ink is thicker than three pixels, what lies beyond one pixel of the lines is thinned again by itself, until
//! nothing is left. Holes of one or two pixels in the ink are filled first, else lines that touch would look like
//! braids. **Every ink pixel has a line pixel among itself and its 8 neighbours.**
//!
//! Cost: a few visits of each ink pixel and its neighbours. Does not handle: depth; two lines less than 2 px apart
//! are one.

use super::{InkRaster, Kind};

/// Holes of at most this many pixels are no gap between two lines but a flaw of one.
const HOLE: usize = 2;

/// Pixels with a margin of one on every side, so that each has 8 neighbours.
#[derive(Clone)]
pub struct Grid {
    /// Cells in a row: the picture's width and the margin.
    pub stride: usize,
    cells: Vec<bool>,
}

impl Grid {
    /// An empty grid for a picture of this size.
    pub fn new(width: u32, height: u32) -> Self {
        let stride = width as usize + 2;
        Self { stride, cells: vec![false; stride * (height as usize + 2)] }
    }

    /// The 8 neighbours of a cell of the picture in turn: east, south-east, south … north-east. Even ones share a side.
    pub fn around(&self, cell: usize) -> [usize; 8] {
        let s = self.stride;
        [cell + 1, cell + s + 1, cell + s, cell + s - 1, cell - 1, cell - s - 1, cell - s, cell - s + 1]
    }

    /// Whether the cell is set.
    pub fn has(&self, cell: usize) -> bool {
        self.cells[cell]
    }

    /// Which of the 8 neighbours are set, in the order of [`Grid::around`].
    pub fn neighbours(&self, cell: usize) -> [bool; 8] {
        self.around(cell).map(|n| self.cells[n])
    }
}

/// Lines one pixel wide that keep the shape of the raster's ink, and their cells in reading order.
pub fn thin(raster: &InkRaster) -> (Grid, Vec<usize>) {
    let mut lines = Grid::new(raster.width, raster.height);
    let mut ink: Vec<usize> = Vec::new();
    for (row, pixels) in raster.pixels.chunks(raster.width.max(1) as usize).enumerate() {
        let start = (row + 1) * lines.stride + 1;
        ink.extend(pixels.iter().enumerate().filter(|(_, p)| p.is_ink()).map(|(column, _)| start + column));
    }
    let mut scratch = lines.clone();
    let mut solid = ink.clone();
    solid.extend(small_holes(raster, &ink, &mut scratch));
    let mut cells = Vec::new();
    while !solid.is_empty() {
        thin_once(&solid, &mut scratch);
        for &cell in &solid {
            if std::mem::take(&mut scratch.cells[cell]) {
                lines.cells[cell] = true;
                cells.push(cell);
            }
        }
        ink.retain(|&cell| !lines.has(cell) && !lines.neighbours(cell).contains(&true));
        solid.clone_from(&ink);
    }
    cells.sort_unstable();
    (lines, cells)
}

/// Cells of the cover that ink encloses in groups of at most [`HOLE`]. `grid` is empty before and after.
fn small_holes(raster: &InkRaster, ink: &[usize], grid: &mut Grid) -> Vec<usize> {
    for &cell in ink {
        grid.cells[cell] = true;
    }
    let stride = grid.stride;
    let is_cover = |cell: usize| {
        let (column, row) = ((cell % stride) as i64 - 1, (cell / stride) as i64 - 1);
        raster.at(column, row).is_some_and(|p| p.kind() == Kind::Cover)
    };
    let mut holes = Vec::new();
    for &cell in ink {
        // Every hole has ink on its west side.
        let mut hole = vec![cell + 1];
        let mut seen = 0;
        while seen < hole.len() && hole.len() <= HOLE && is_cover(hole[seen]) {
            let around = grid.around(hole[seen]);
            // Corners too: what parts two slanting lines is a row of paper pixels that touch by corners.
            let new: Vec<usize> = around.into_iter().filter(|&c| !grid.has(c) && !hole.contains(&c)).collect();
            hole.extend(new);
            seen += 1;
        }
        if seen == hole.len() {
            holes.extend(hole);
        }
    }
    holes.sort_unstable();
    holes.dedup();
    ink.iter().for_each(|&cell| grid.cells[cell] = false);
    holes
}

/// Leaves in `grid`, empty so far, the thinned `ink`.
fn thin_once(ink: &[usize], grid: &mut Grid) {
    for &cell in ink {
        grid.cells[cell] = true;
    }
    // Only where something was taken off can more come off.
    let mut edge = ink.to_vec();
    while !edge.is_empty() {
        let mut taken = Vec::new();
        for side in [6, 2, 4, 0] {
            let open: Vec<usize> =
                edge.iter().copied().filter(|&c| grid.has(c) && !grid.has(grid.around(c)[side])).collect();
            for cell in open {
                if removable(grid.neighbours(cell)) {
                    grid.cells[cell] = false;
                    taken.push(cell);
                }
            }
        }
        edge = taken.iter().flat_map(|&cell| grid.around(cell)).filter(|&cell| grid.has(cell)).collect();
        edge.sort_unstable();
        edge.dedup();
    }
    take_burrs(ink, grid);
}

/// Whether a pixel with these neighbours is neither a line end nor a link.
fn removable(n: [bool; 8]) -> bool {
    let connectivity = |k: usize| !n[k] && (n[k + 1] || n[(k + 2) % 8]);
    n.iter().filter(|&&set| set).count() > 1 && [0, 2, 4, 6].into_iter().filter(|&k| connectivity(k)).count() == 1
}

/// Takes off ends of one pixel beside a line: they are a line's thickness, not a line, unless they alone cover ink.
fn take_burrs(ink: &[usize], grid: &mut Grid) {
    let mut is_ink = grid.clone();
    for &cell in ink {
        is_ink.cells[cell] = true;
    }
    let count = |grid: &Grid, cell: usize| grid.neighbours(cell).into_iter().filter(|&set| set).count();
    for &cell in ink.iter().filter(|&&cell| is_ink.has(cell)) {
        if !grid.has(cell) || count(grid, cell) != 1 {
            continue;
        }
        let beside_line = grid.around(cell).into_iter().any(|n| grid.has(n) && count(grid, n) > 2);
        grid.cells[cell] = false;
        let covered = |c: usize| grid.has(c) || grid.neighbours(c).contains(&true);
        let needed = grid.around(cell).into_iter().chain([cell]).any(|c| is_ink.has(c) && !covered(c));
        grid.cells[cell] = !beside_line || needed;
    }
}
