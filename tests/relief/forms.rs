//! Lines of valleys and ridges that are known: a meander, grooves of a cone, a saddle, basins in a row; and of a rough plane, that has
//! none.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use hachure::dem::Dem;
use hachure::relief::{ChannelArea, Relief, SurfaceLine};

use super::{CELL, dem, distance, length, rough};
use crate::scenes::Random;
use crate::tolerances::{BOTTOM_CELLS, BOTTOM_MEAN_CELLS, BOTTOM_SHARE, ELSEWHERE_CELLS, ELSEWHERE_SHARE, PLANE_SHARE};

/// Channels here.
const AREA: ChannelArea = ChannelArea::SquareMetres(25.0 * CELL * CELL);

fn relief(dem: &Dem) -> Relief {
    Relief::of(dem, 1.0).expect("a relief")
}

/// How lines lie to the places of true ones.
#[derive(Debug)]
struct Fit {
    /// Share of the places near a line.
    share: f64,
    /// Mean distance from the places that are, cells.
    mean: f64,
    /// Length of lines far from all places, as a share of that of the true lines.
    elsewhere: f64,
}

impl Fit {
    /// `truth`: places a quarter of a cell apart.
    fn of(lines: &[SurfaceLine], truth: &[DVec2]) -> Self {
        let nearest = |place: &DVec2| lines.iter().map(|line| distance(line, *place)).fold(f64::INFINITY, f64::min);
        let distances: Vec<f64> = truth.iter().map(nearest).collect();
        let near: Vec<f64> = distances.into_iter().filter(|distance| *distance <= BOTTOM_CELLS).collect();
        let pieces = lines.iter().flat_map(|line| line.points.windows(2));
        let far = |place: DVec2| truth.iter().all(|true_place| true_place.distance(place) > ELSEWHERE_CELLS);
        let elsewhere = pieces.filter(|pair| far(pair[0].at)).map(|pair| pair[0].at.distance(pair[1].at));
        Self {
            share: near.len() as f64 / truth.len() as f64,
            mean: near.iter().sum::<f64>() / near.len() as f64,
            elsewhere: elsewhere.sum::<f64>() / (truth.len() as f64 / 4.0),
        }
    }

    fn is_good(&self) -> bool {
        self.share >= BOTTOM_SHARE && self.mean <= BOTTOM_MEAN_CELLS && self.elsewhere <= ELSEWHERE_SHARE
    }
}

/// Places a quarter of a cell apart, about, on a curve.
fn places(curve: impl Fn(f64) -> DVec2, cells: f64) -> Vec<DVec2> {
    (0..=(4.0 * cells) as usize).map(|k| curve(k as f64 / (4.0 * cells))).collect()
}

/// A meander, and its land: a trough of 20 m in a plane that falls by 3 % to the east.
fn meander() -> (Dem, Vec<DVec2>) {
    let curve = |x: f64| DVec2::new(x, 45.0 + 14.0 * (x * TAU / 60.0).sin());
    let bed = places(|share| curve(share * 220.0 - 10.0), 330.0);
    let land = dem([200, 90], |at| {
        let away = bed.iter().map(|place| place.distance_squared(at)).fold(f64::INFINITY, f64::min);
        CELL * (2.0 * (1.0 - (-away / 18.0).exp()) - 0.03 * at.x)
    });
    (land, bed.into_iter().filter(|place| (8.0..199.0).contains(&place.x)).collect())
}

/// A round cone of 30 % with eight grooves and eight ribs, its top in the middle.
fn cone() -> (Dem, [Vec<DVec2>; 2]) {
    let middle = DVec2::splat(80.3);
    let land = dem([161, 161], |at| {
        let off = at - middle;
        let angle = off.y.atan2(off.x);
        if off.length() > 79.0 {
            return f64::NAN;
        }
        CELL * (-0.3 * off.length() + 0.12 * off.length() * (8.0 * angle + 0.7).cos())
    });
    let ray = |angle: f64, from: f64| {
        places(move |share| middle + DVec2::from_angle(angle) * (from + (76.0 - from) * share), 76.0 - from)
    };
    let rays =
        |phase: f64, from: f64| (0..8).flat_map(|k| ray((phase + TAU * f64::from(k) - 0.7) / 8.0, from)).collect();
    (land, [rays(PI, 10.0), rays(0.0, 0.0)])
}

/// A saddle: a valley with sides of 20 % falls to both sides of it, a broad ridge rises across. `sign` -1 turns it upside down.
fn saddle(sign: f64) -> (Dem, Vec<DVec2>) {
    let middle = DVec2::new(60.2, 59.7);
    let turn = DVec2::from_angle(0.4);
    let land = dem([121, 121], |at| {
        let off = turn.rotate(at - middle);
        sign * CELL * (0.2 * off.x.hypot(2.0) - 0.001 * off.y * off.y)
    });
    let along = DVec2::from_angle(-0.4).rotate(DVec2::Y);
    let half = |sign: f64| places(move |share| middle + along * sign * (5.0 + 58.0 * share), 58.0);
    (land, [half(1.0), half(-1.0)].concat())
}

/// A valley across the grid whose bed goes up and down: eight basins, small ones in large ones.
fn basins() -> (Dem, Vec<DVec2>) {
    let along = DVec2::new(5.0, 2.0).normalize();
    let from = DVec2::new(0.0, 20.0);
    let land = dem([200, 120], |at| {
        let off = at - from;
        let [s, across] = [off.dot(along), off.perp_dot(along)];
        let waves = 0.5 * (s * TAU / 90.0).sin() + 0.2 * (s * TAU / 25.0).sin();
        CELL * (0.15 * across.abs() - 0.01 * s + waves * (-across * across / 32.0).exp())
    });
    (land, places(|share| from + along * (5.0 + 195.0 * share), 195.0))
}

#[test]
fn valleys_are_found_where_they_are() {
    let (meander, bed) = meander();
    let (cone, [grooves, _]) = cone();
    let (saddle, valleys) = saddle(1.0);
    let (basins, row) = basins();
    for (name, dem, truth) in
        [("meander", meander, bed), ("cone", cone, grooves), ("saddle", saddle, valleys), ("basins", basins, row)]
    {
        let fit = Fit::of(&relief(&dem).drainage(AREA), &truth);
        println!("{name}: {fit:?}");
        assert!(fit.is_good(), "{name}: {fit:?}");
    }
}

#[test]
fn ridges_are_found_where_they_are() {
    let (cone, [_, ribs]) = cone();
    let (saddle, ridges) = saddle(-1.0);
    let (meander, bed) = meander();
    // Upside down its bed is a crest.
    let turned: Vec<f32> = meander.held().expect("samples").heights().iter().map(|height| -height).collect();
    let levee = Dem::from_heights(200, DVec2::splat(CELL), DVec2::ZERO, turned);
    for (name, dem, truth) in [("cone", cone, ribs), ("saddle", saddle, ridges), ("levee", levee, bed)] {
        let fit = Fit::of(&relief(&dem).ridges().expect("ridges"), &truth);
        println!("{name}: {fit:?}");
        assert!(fit.is_good(), "{name}: {fit:?}");
    }
}

#[test]
fn lines_beside_the_bottom_are_noticed() {
    let (dem, truth) = meander();
    let lines = relief(&dem).drainage(AREA);
    let beside: Vec<DVec2> = truth.iter().map(|place| *place + DVec2::new(0.0, 0.6)).collect();
    assert!(!Fit::of(&lines, &beside).is_good());
    assert!(!Fit::of(&lines[..0], &truth).is_good());
    let double: Vec<SurfaceLine> = lines
        .iter()
        .chain(&lines)
        .cloned()
        .map(|mut line| {
            line.points.iter_mut().for_each(|point| point.at.y += 9.0);
            line
        })
        .chain(lines.iter().cloned())
        .collect();
    assert!(!Fit::of(&double, &truth).is_good());
}

#[test]
fn a_rough_plane_has_few_lines() {
    let mut random = Random::new(11);
    let noise: Vec<f64> = (0..150 * 150).map(|_| random.below(1 << 16) as f64 / 65536.0 - 0.5).collect();
    let land =
        dem([150, 150], |at| CELL * (0.2 * at.x + 0.11 * at.y) + 0.3 * noise[at.y as usize * 150 + at.x as usize]);
    let relief = relief(&land);
    for lines in [relief.drainage(AREA), relief.ridges().expect("ridges")] {
        let drawn: f64 = lines.iter().map(length).sum();
        println!("{} lines, {drawn} cells", lines.len());
        assert!(drawn <= PLANE_SHARE * 150.0 * 150.0, "{drawn} cells of lines");
    }
    // Land has more.
    let relief = Relief::of(&rough(1, [150, 150]), 1.0).expect("a relief");
    for lines in [relief.drainage(AREA), relief.ridges().expect("ridges")] {
        assert!(lines.iter().map(length).sum::<f64>() > PLANE_SHARE * 150.0 * 150.0);
    }
}
