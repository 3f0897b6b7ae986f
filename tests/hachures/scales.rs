//! Hachures of far land: strokes follow it as far as the page shows it, lie on it, stay out of voids, and are as many where one scale
//! gives way to the next.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::line::hachures::{Viewer, hatched};
use hachure::door::line::{LandWay, Overhead};
use hachure::ink::{Sheet, Style};
use hachure::plan::{Hachures, Tone};
use hachure::relief::Slopes;
use hachure::surface::Surface;
use hachure::view::{Camera, Perspective};

use super::{CELL, SIDE, land};
use crate::scenes::{Random, look};

/// Metres down for one south, of the plane under the noise.
const FALL: f64 = 0.36;
/// Most height of the noise of single samples, metres.
const NOISE: f64 = 12.0;
const SIZE: [u32; 2] = [640, 360];
/// A stroke runs down the plane within this, degrees.
const ALONG: f64 = 15.0;
/// Weights from which strokes count.
const SEEN: f32 = 0.3;
/// Voids in columns and rows from and to.
const HOLE: [usize; 2] = [61, 92];

/// A plane that falls to the south, with noise that no far page shows and a hole.
fn rough() -> Dem {
    let mut random = Random::new(7);
    let noise: Vec<f64> = (0..SIDE * SIDE).map(|_| random.between(0.0, NOISE)).collect();
    let is_hole = |c: usize, r: usize| [c, r].iter().all(|at| (HOLE[0]..=HOLE[1]).contains(at));
    land(|at| {
        let [c, r] = (at / CELL + 80.0).round().as_usizevec2().to_array();
        if is_hole(c, r) { f64::NAN } else { 2000.0 - FALL * at.y + noise[r * SIDE + c] }
    })
}

struct Far {
    surface: Arc<Surface>,
    slopes: Slopes,
    look: Hachures,
}

impl Far {
    fn new(dem: Dem) -> Self {
        let surface = Arc::new(Surface::new(dem));
        let style = Style::default();
        let rules = style.hachures.rules().expect("hachures");
        let slopes = Slopes::new(surface.clone(), 1.0, rules, &[], None).expect("slopes");
        let look = style.hachures(Sheet::for_frame(SIZE).placement(SIZE).px_per_mm).expect("hachures");
        Self { surface, slopes, look }
    }

    /// From so many metres south of the middle, a little above it, with a field of view in degrees.
    fn seen(&self, metres: f64, fov: f64) -> (Vec<LandWay>, Perspective) {
        let dem = self.surface.dem();
        let middle = dem.position(dem.columns() / 2, dem.rows() / 2).truncate().extend(2000.0);
        let camera: Camera = look(middle + DVec3::new(0.0, -metres, 0.2 * metres), middle, fov, SIZE);
        let perspective = Perspective::new(&camera, 1.0);
        let seen = Viewer::By(&perspective, camera.azimuth, None);
        (hatched(&self.slopes, &self.look, seen).expect("strokes").ways, perspective)
    }
}

/// Share of the length on the map of what is seen that runs down the plane.
fn along(ways: &[LandWay]) -> f64 {
    let mut sums = [0.0; 2];
    for pair in ways.iter().flat_map(|way| way.points.windows(2)).filter(|pair| pair[0].weight > SEEN) {
        let way = pair[1].at - pair[0].at;
        let off = way.x.abs().atan2(way.y.abs()).to_degrees();
        sums[0] += if off <= ALONG { way.length() } else { 0.0 };
        sums[1] += way.length();
    }
    assert!(sums[1] > 1000.0, "{} cells of strokes", sums[1]);
    sums[0] / sums[1]
}

#[test]
fn far_strokes_follow_the_land_and_not_its_noise() {
    let far = Far::new(rough());
    let (ways, perspective) = far.seen(12_000.0, 40.0);
    let dem = far.surface.dem();
    let px_per_metre = perspective.focal() / 12_000.0;
    let on_map = Overhead { area: dem.extent(), size: [(4800.0 * px_per_metre) as u32; 2], px_per_metre };
    let near = hatched(&far.slopes, &far.look, Viewer::Above(&on_map)).expect("strokes").ways;
    let [far_share, near_share] = [along(&ways), along(&near)];
    println!("{far_share:.3} of the far strokes run down the plane, {near_share:.3} on a map of the same scale");
    assert!(far_share > 0.95 && near_share < 0.8, "{far_share} {near_share}");
}

#[test]
fn far_strokes_lie_on_the_land_and_not_in_its_voids() {
    let far = Far::new(rough());
    let dem = far.surface.dem();
    let (ways, _) = far.seen(12_000.0, 40.0);
    let [mut counted, mut exact] = [0; 2];
    for point in ways.iter().flat_map(|way| &way.points) {
        let corner = point.at.floor().min(DVec2::splat((SIDE - 2) as f64)).as_usizevec2();
        let DVec2 { x: u, y: v } = point.at - corner.as_dvec2();
        let height = |c: usize, r: usize| f64::from(dem.height(corner.x + c, corner.y + r).expect("no void"));
        let along = |r: usize| height(0, r) * (1.0 - u) + height(1, r) * u;
        let on_land = along(0) * (1.0 - v) + along(1) * v;
        // Where a line is cut its points lie between others.
        let off = (point.world.z - on_land).abs();
        assert!(off < NOISE, "{point:?} is {off} m off");
        exact += u32::from(off < 0.01);
        counted += 1;
    }
    assert!(counted > 1000 && exact * 10 > counted * 8, "{exact} of {counted} points lie on the land");
}

#[test]
fn far_strokes_reach_the_rim_of_land_of_any_size() {
    const COLUMNS: usize = 500;
    let fall = |i: usize| (3000.0 - FALL * 10.0 * (i / COLUMNS) as f64) as f32;
    let heights = (0..COLUMNS * COLUMNS).map(fall).collect();
    let far = Far::new(Dem::from_heights(COLUMNS, DVec2::splat(10.0), DVec2::new(500_000.0, 4_000_000.0), heights));
    let (ways, _) = far.seen(9_000.0, 60.0);
    let ends = ways.iter().flat_map(|way| &way.points).map(|point| point.at);
    let [low, high] = ends.fold([DVec2::MAX, DVec2::MIN], |[low, high], at| [low.min(at), high.max(at)]);
    println!("strokes from {low} to {high}");
    assert!(low.max_element() < 6.0 && high.min_element() > COLUMNS as f64 - 7.0, "{low} {high}");
}

#[test]
fn scales_give_way_to_each_other_without_a_gap_or_a_crowd() {
    let usual = Far::new(rough());
    // Fine pens: strokes stand closer, to be as dark.
    let fine = Hachures { broadest: usual.look.broadest / 3.0, tone: Tone::Shadow, ..usual.look };
    let least = |look: &Hachures| look.apart(look.most_black);
    assert!(least(&fine) < 0.4 * fine.spacing && least(&usual.look) > least(&fine));
    let fine = Far { look: fine, ..Far::new(rough()) };
    for (far, fov, from) in [(&usual, 40.0, 9_000.0), (&usual, 100.0, 9_000.0), (&fine, 40.0, 9_000.0)] {
        // What there is on the page, as if it were as large from everywhere.
        let length = |metres: f64| {
            let (ways, perspective) = far.seen(metres, fov);
            let pairs = ways.iter().flat_map(|way| way.points.windows(2));
            let seen = pairs.map(|pair| {
                let [a, b] = [0, 1].map(|k| perspective.project(pair[k].world).0);
                a.distance(b) * f64::from(pair[0].weight)
            });
            seen.sum::<f64>() * metres * metres
        };
        let lengths: Vec<f64> = (0..9).map(|k| length(from * 2.0_f64.powf(f64::from(k) / 8.0))).collect();
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        println!("fov {fov}: {:.2?} of the mean", lengths.iter().map(|length| length / mean).collect::<Vec<_>>());
        assert!(lengths.iter().all(|length| (0.8..1.25).contains(&(length / mean))));
    }
}
