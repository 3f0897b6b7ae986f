//! Lines found on blocks of samples lie where those of the samples do.

use glam::DVec2;
use hachure::dem::Dem;
use hachure::door::relief::{lowest_and_highest, on_samples};
use hachure::relief::{ChannelArea, Relief, SurfaceLine};

const SIDE: usize = 4;
const SIZE: [usize; 2] = [322, 401];
const CELL: f64 = 10.0;

/// Where the bed of the valley lies in a row; narrower than a block.
fn bed(row: f64) -> f64 {
    160.0 + 40.0 * (row / 60.0).sin()
}

/// A slope down to the south with a winding valley 60 m deep; a spur on its east side.
fn valley() -> Dem {
    let height = |i: usize| {
        let [c, r] = [i % SIZE[0], i / SIZE[0]].map(|at| at as f64);
        let off = (c - bed(r)).abs();
        (500.0 - 0.6 * r + 60.0 * (1.0 - (-off / 12.0).exp()) + 0.3 * off) as f32
    };
    Dem::from_heights(SIZE[0], DVec2::splat(CELL), DVec2::ZERO, (0..SIZE[0] * SIZE[1]).map(height).collect())
}

/// The share of rows in which a line of these lies within so many samples of the bed.
fn share(lines: &[SurfaceLine], within: f64) -> f64 {
    let points = || lines.iter().flat_map(|line| &line.points);
    let rows = 40..SIZE[1] - 20;
    let has = |row: usize| {
        let bed = DVec2::new(bed(row as f64), row as f64);
        points()
            .any(|point| point.at.distance(bed) <= within + 2.0 && (point.at.x - self::bed(point.at.y)).abs() <= within)
    };
    rows.clone().filter(|row| has(*row)).count() as f64 / rows.len() as f64
}

#[test]
fn a_winding_valley_is_found_on_blocks() {
    let dem = valley();
    let [lowest, highest] = lowest_and_highest(&dem, 1.0, SIDE, &|_| ()).expect("blocks");
    assert_eq!(lowest.frame.size, SIZE.map(|samples| samples.div_ceil(SIDE)));
    let of = |c: usize, r: usize| {
        let samples = (0..SIDE * SIDE).filter_map(|k| dem.height(c * SIDE + k % SIDE, r * SIDE + k / SIDE));
        samples.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
    };
    for [c, r] in [[0, 0], [40, 50], [80, 100], [79, 99]] {
        let i = lowest.frame.index([c, r]);
        assert_eq!([lowest.heights[i], highest.heights[i]], of(c, r), "block {c},{r}");
    }
    let mut lines = Relief::on(lowest).expect("flow").drainage(ChannelArea::Auto);
    on_samples(&mut lines, &dem, SIDE);
    let found = share(&lines, 0.5 * SIDE as f64);
    println!("relief: {:.1} % of the bed within half a block", found * 100.0);
    assert!(found >= 0.95, "{found}");
    // Negative control: a block aside.
    lines.iter_mut().flat_map(|line| &mut line.points).for_each(|point| point.at.x += SIDE as f64);
    assert!(share(&lines, 0.5 * SIDE as f64) < 0.5);
}
