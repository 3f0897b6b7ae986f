//! The reference that every picture is measured against: right by mathematics, by a slow program, and by known figures.

mod chains;
mod level;
mod mask;
mod mathematics;
pub mod metrics;
mod noticed;
mod pieces;
mod slow;
mod west_temple;

use glam::DVec3;
use hachure::surface::Surface;
use hachure::truth::{Terrain, Truth, TruthLine};
use rayon::ThreadPoolBuilder;

pub use self::metrics::straight;
use crate::closed_forms::GAUSSIAN;
use crate::forms::from_middle;
use crate::scenes::{level, look, rough};

#[test]
fn any_number_of_threads_finds_the_same_truth() {
    let surface = Surface::new(rough(40, 30, 2.0, 5.0, true));
    let [west, south, east, _] = surface.dem().extent();
    let eye = DVec3::new((west + east) / 2.0, south - 100.0, 200.0);
    let camera = look(eye, eye + DVec3::new(0.0, 300.0, -150.0), 60.0, [192, 144]);
    let on = |threads| -> (Truth, _) {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let terrain = Terrain::new(&surface);
            (terrain.truth(&camera, level(4)), terrain.level_for(&camera))
        })
    };
    let alone = on(1);
    assert!(alone.0.pieces.len() > 1000, "only {} pieces", alone.0.pieces.len());
    for threads in [2, 3] {
        assert!(on(threads) == alone, "{threads} threads find another truth than one");
    }
}

#[test]
fn cells_without_a_line_are_passed_over() {
    let surface = Surface::new(GAUSSIAN.dem(|_, _| true));
    let camera = look(from_middle(DVec3::new(0.0, -1000.0, 140.0)), from_middle(DVec3::Z * 150.0), 60.0, [384, 288]);
    for n in [2, 8] {
        let truth = Terrain::new(&surface).truth(&camera, level(n));
        let border = truth.pieces.iter().filter(|piece| piece.line == TruthLine::Border).count();
        let bare = truth.clone().without_border().pieces;
        assert!(border > 0 && bare.len() == truth.pieces.len() - border, "level {n}: {border} pieces of border lines");
        assert!(
            bare.iter().all(|piece| piece.line == TruthLine::Contour),
            "level {n}: border lines without the border"
        );
        let share = truth.facets as f64 / (surface.patches() * u64::from(n * n)) as f64;
        println!("level {n}: facets looked at: {:.1} %, {} rays", 100.0 * share, truth.rays);
        assert!(share < 0.05, "level {n}: {:.1} % of the facets were looked at one by one", 100.0 * share);
    }
}
