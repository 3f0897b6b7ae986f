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

use super::grid::CellGrid;
use super::{Kind, Marks};

/// Holes of at most this many pixels are no gap between two lines but a flaw of one.
const HOLE: usize = 2;

/// Lines one pixel wide that keep the shape of the ink, and their cells in reading order.
pub(super) fn thin(marks: &Marks) -> (CellGrid, Vec<usize>) {
    let mut lines = CellGrid::new(marks.width, marks.height);
    let mut ink: Vec<usize> = marks.ink().map(|mark| lines.cell(mark.column, mark.row)).collect();
    let mut scratch = lines.clone();
    let mut solid = ink.clone();
    solid.extend(small_holes(marks, &ink, &mut scratch));
    let mut cells = Vec::new();
    while !solid.is_empty() {
        thin_once(&solid, &mut scratch);
        for &cell in &solid {
            if scratch.has(cell) {
                scratch.clear(cell);
                lines.set(cell);
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
fn small_holes(marks: &Marks, ink: &[usize], grid: &mut CellGrid) -> Vec<usize> {
    for &cell in ink {
        grid.set(cell);
    }
    let is_cover = |grid: &CellGrid, cell: usize| {
        let [column, row] = grid.pixel(cell);
        marks.at(column, row).is_some_and(|mark| mark.pixel.kind() == Kind::Cover)
    };
    let mut holes = Vec::new();
    for &cell in ink {
        // Every hole has ink on its west side.
        let mut hole = vec![cell + 1];
        let mut seen = 0;
        while seen < hole.len() && hole.len() <= HOLE && is_cover(grid, hole[seen]) {
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
    ink.iter().for_each(|&cell| grid.clear(cell));
    holes
}

/// Leaves in `grid`, empty so far, the thinned `ink`.
fn thin_once(ink: &[usize], grid: &mut CellGrid) {
    for &cell in ink {
        grid.set(cell);
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
                    grid.clear(cell);
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
fn take_burrs(ink: &[usize], grid: &mut CellGrid) {
    let mut is_ink = grid.clone();
    for &cell in ink {
        is_ink.set(cell);
    }
    let count = |grid: &CellGrid, cell: usize| grid.neighbours(cell).into_iter().filter(|&set| set).count();
    for &cell in ink.iter().filter(|&&cell| is_ink.has(cell)) {
        if !grid.has(cell) || count(grid, cell) != 1 {
            continue;
        }
        let beside_line = grid.around(cell).into_iter().any(|n| grid.has(n) && count(grid, n) > 2);
        grid.clear(cell);
        let covered = |c: usize| grid.has(c) || grid.neighbours(c).contains(&true);
        let needed = grid.around(cell).into_iter().chain([cell]).any(|c| is_ink.has(c) && !covered(c));
        if !beside_line || needed {
            grid.set(cell);
        }
    }
}
