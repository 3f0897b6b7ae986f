//! Lines end where the land does.

use std::path::Path;

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::cli::words::line;
use hachure::geo::{OwnLine, OwnLines};
use hachure::relief::{self, SurfaceLine};

use super::check;

/// A grid of 21 x 21 samples of cells of 10 m, with voids.
pub fn grid(voids: &[[usize; 2]]) -> Dem {
    let height = |i: usize| if voids.contains(&[i % 21, i / 21]) { f32::NAN } else { 5.0 };
    Dem::from_heights(21, DVec2::splat(10.0), DVec2::new(1000.0, 2000.0), (0..21 * 21).map(height).collect())
}

/// Lines through columns and rows of [`grid`].
pub fn through(lines: &[(&[[f64; 2]], bool)]) -> OwnLines {
    let world = |place: &[f64; 2]| DVec2::new(1000.0 + 10.0 * place[0], 2000.0 - 10.0 * place[1]);
    let of = |(line, closed): &(&[[f64; 2]], bool)| OwnLine {
        places: line.iter().map(world).collect(),
        closed: *closed,
        order: 1,
    };
    super::given(None, lines.iter().map(of).collect())
}

fn on_grid(lines: &[(&[[f64; 2]], bool)], voids: &[[usize; 2]]) -> Vec<SurfaceLine> {
    let dem = grid(voids);
    let lines = relief::own_lines(Path::new("a"), &through(lines), &dem, 0).unwrap_or_else(|e| panic!("{}", line(&e)));
    lines.iter().for_each(|line| check(line, &dem));
    lines
}

/// First and last place.
fn ends(line: &SurfaceLine) -> [[f64; 2]; 2] {
    [0, line.points.len() - 1].map(|i| (line.points[i].at * 1e9).round().to_array().map(|x| x / 1e9))
}

#[test]
fn lines_end_where_the_land_does() {
    let void = [[10, 10]];
    let across = on_grid(&[(&[[-5.0, 3.5], [25.0, 3.5]], false)], &void);
    assert_eq!((across.len(), ends(&across[0])), (1, [[0.0, 3.5], [20.0, 3.5]]), "the edge");
    // Patches have three corners: of cell (9, 10) the one in the south-west is there.
    let through = on_grid(&[(&[[2.0, 10.25], [18.0, 10.25]], false)], &void);
    assert_eq!(
        through.iter().map(ends).collect::<Vec<_>>(),
        [[[2.0, 10.25], [9.25, 10.25]], [[11.0, 10.25], [18.0, 10.25]]]
    );
    let along = on_grid(&[(&[[2.0, 10.0], [18.0, 10.0]], false)], &void);
    assert_eq!(along.iter().map(ends).collect::<Vec<_>>(), [[[2.0, 10.0], [9.0, 10.0]], [[11.0, 10.0], [18.0, 10.0]]]);
    // Along the rim of a void, and of the DEM, there is land on one side.
    let rim =
        on_grid(&[(&[[9.0, 9.0], [9.0, 10.0], [10.0, 11.0]], false), (&[[20.0, 1.0], [20.0, 5.0]], false)], &void);
    assert_eq!(rim.iter().map(ends).collect::<Vec<_>>(), [[[9.0, 9.0], [10.0, 11.0]], [[20.0, 1.0], [20.0, 5.0]]]);
}

#[test]
fn closed_lines_stay_closed_or_are_cut_once_less() {
    let square: &[[f64; 2]] = &[[5.0, 5.0], [15.0, 5.0], [15.0, 15.0], [5.0, 15.0]];
    let whole = on_grid(&[(square, true)], &[]);
    assert!(whole.len() == 1 && whole[0].closed && whole[0].points.len() == 40);
    // Its first place lies amid what is left.
    let cut = on_grid(&[(square, true)], &[[10, 15]]);
    assert_eq!((cut.len(), ends(&cut[0]), cut[0].closed), (1, [[9.0, 15.0], [11.0, 15.0]], false));
    let beyond = on_grid(&[(&[[5.0, 5.0], [25.0, 5.0], [25.0, 15.0], [5.0, 15.0]], true)], &[]);
    assert_eq!((beyond.len(), ends(&beyond[0])), (1, [[20.0, 15.0], [20.0, 5.0]]));
}
