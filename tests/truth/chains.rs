//! Figures of chains on lines of which they are known by formula, and by a judge as slow as its words.

use glam::DVec2;
use hachure::truth::Truth;
use hachure::truth::metrics::{Agreement, ChainScores, Judge};

use super::metrics::{PAGE, ink, row, straight};
use crate::judged::{piece, truth};
use crate::scenes::Random;
use crate::tolerances::SUM;

/// 100 px at y = 20.4, from x = 10 to 110.
fn level_line() -> Truth {
    truth(PAGE, straight([10.0, 20.4], [110.0, 20.4], 1.0))
}

fn scores(truth: &Truth, chains: &[Vec<DVec2>]) -> ChainScores {
    Judge::new(truth).expect("a line on the page").measure_chains(chains)
}

/// A chain through these corners.
fn chain<const N: usize>(corners: [[f64; 2]; N]) -> Vec<DVec2> {
    corners.map(DVec2::from).to_vec()
}

#[track_caller]
fn near(what: &str, found: f64, known: f64) {
    assert!((found - known).abs() <= SUM, "{what}: {found}, by formula {known}");
}

#[test]
fn a_chain_beside_truth_is_as_far_off_as_it_was_moved() {
    for off in [0.0, 0.3, 0.999, 1.001, 2.5] {
        let found = scores(&level_line(), &[chain([[10.0, 20.4 + off], [110.0, 20.4 + off]])]);
        let offsets = found.offsets.expect("a chain");
        near("mean", offsets.mean, off);
        near("95 %", offsets.p95, off);
        near("length", found.length, 100.0);
        let agrees = if off <= 1.0 { 1.0 } else { 0.0 };
        assert_eq!(found.agreement, Agreement { precision: agrees, recall: agrees }, "{off} px off");
        assert_eq!((found.count, found.short), (1, 0.0));
    }
    // Aslant from 0 to 2 px: half of it within 1 px, 95 % within 1.9 px, 1 px on average.
    let found = scores(&level_line(), &[chain([[10.0, 20.4], [110.0, 22.4]])]);
    let offsets = found.offsets.expect("a chain");
    near("mean", offsets.mean, 1.0);
    assert!((offsets.p95 - 1.9).abs() < 0.01 && (found.agreement.precision - 0.5).abs() < 0.01, "{found:?}");
}

#[test]
fn half_the_line_and_as_much_beside_it() {
    // A chain reaches 1 px beyond its end.
    let half = chain([[10.0, 20.4], [59.0, 20.4]]);
    let found = scores(&level_line(), std::slice::from_ref(&half));
    near("recall", found.agreement.recall, 0.5);
    near("precision", found.agreement.precision, 1.0);
    let stray = chain([[10.0, 70.0], [59.0, 70.0]]);
    let found = scores(&level_line(), &[half, stray]);
    near("recall", found.agreement.recall, 0.5);
    near("precision", found.agreement.precision, 0.5);
    assert_eq!(found.count, 2);
    let none = scores(&level_line(), &[]);
    assert_eq!((none.count, none.length, none.short, none.offsets), (0, 0.0, 0.0, None));
    assert_eq!(none.agreement, Agreement { precision: 1.0, recall: 0.0 });
}

#[test]
fn chains_are_short_by_their_length_on_the_page() {
    let lengths = [0.0, 5.9, 6.1, 40.0];
    let mut chains: Vec<_> = lengths.map(|length| chain([[10.0, 20.4], [10.0 + length, 20.4]])).to_vec();
    // By a corner, and over the page's edge: 3 px of 50 are on it.
    chains.push(chain([[10.0, 20.4], [13.0, 20.4], [13.0, 24.4]]));
    chains.push(chain([[-47.0, 20.4], [3.0, 20.4]]));
    // Beside the page: no chain of it.
    chains.push(chain([[-47.0, 20.4], [-1.0, 20.4]]));
    // A dot has no length, and what lies near it is found.
    chains.push(chain([[80.0, 20.4]]));
    let found = scores(&level_line(), &chains);
    assert_eq!((found.count, found.short), (7, 4.0 / 7.0));
    near("length", found.length, lengths.iter().sum::<f64>() + 7.0 + 3.0);
    near("recall", found.agreement.recall, (40.0 + 1.0 + 2.0) / 100.0);
    // A closed chain has its first corner at its end, too.
    let square = chain([[30.0, 30.0], [34.0, 30.0], [34.0, 34.0], [30.0, 34.0], [30.0, 30.0]]);
    near("length", scores(&level_line(), &[square]).length, 16.0);
}

#[test]
fn a_slow_judge_agrees() {
    let mut random = Random::new(16);
    for _ in 0..10 {
        let mut place = || DVec2::new(random.between(-20.0, 150.0), random.between(-20.0, 120.0));
        let lines: Vec<[DVec2; 2]> = (0..3).map(|_| [place(), place()]).collect();
        let chains: Vec<Vec<DVec2>> = (0..4).map(|_| (0..5).map(|_| place()).collect()).collect();
        let pieces = lines.iter().flat_map(|[from, to]| straight(from.to_array(), to.to_array(), 1.0));
        let truth = truth(PAGE, pieces.collect());
        let Some(judge) = Judge::new(&truth) else { continue };
        let found = judge.measure_chains(&chains);
        let to_side = |p: DVec2, [a, b]: [DVec2; 2]| {
            let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            p.distance(a.lerp(b, along))
        };
        let inside = |p: DVec2| (0.0..128.0).contains(&p.x) && (0.0..96.0).contains(&p.y);
        let sides: Vec<[DVec2; 2]> = chains.iter().flat_map(|c| c.windows(2)).map(|s| [s[0], s[1]]).collect();
        let nearest =
            |p: DVec2, sides: &[[DVec2; 2]]| sides.iter().map(|side| to_side(p, *side)).fold(f64::INFINITY, f64::min);
        // In steps of a hundredth of a pixel.
        let looks = sides.iter().flat_map(|&[a, b]| {
            let count = (a.distance(b) * 100.0).ceil() as u32;
            (0..count).map(move |k| a.lerp(b, (f64::from(k) + 0.5) / f64::from(count)))
        });
        let looks: Vec<DVec2> = looks.filter(|p| inside(*p)).collect();
        let away: Vec<f64> = looks.iter().map(|p| nearest(*p, &lines)).collect();
        let mean = away.iter().sum::<f64>() / away.len() as f64;
        let within = |distance: f64| away.iter().filter(|d| **d <= distance).count() as f64 / away.len() as f64;
        let offsets = found.offsets.expect("chains");
        let length = looks.len() as f64 / 100.0;
        assert!((found.length / length - 1.0).abs() < 1e-3, "length {} of {length}", found.length);
        assert!((offsets.mean / mean - 1.0).abs() < 1e-3, "mean {} of {mean}", offsets.mean);
        assert!((within(offsets.p95) - 0.95).abs() < 2e-3, "95 %: {}", within(offsets.p95));
        assert!((found.agreement.precision - within(1.0)).abs() < 2e-3, "{found:?}, precision {}", within(1.0));
        let pieces: Vec<_> = truth.pieces.iter().filter(|p| inside(p.middle())).collect();
        let near = pieces.iter().filter(|p| nearest(p.middle(), &sides) <= 1.0);
        let near = near.fold(0.0, |sum, p| sum + p.length());
        let all = pieces.iter().fold(0.0, |sum, p| sum + p.length());
        assert!(
            (found.agreement.recall - near / all).abs() < SUM,
            "recall {} of {}",
            found.agreement.recall,
            near / all
        );
    }
}

/// Half of a line straight, half to and fro within its row of pixels: twice as long.
#[test]
fn recall_by_pixels_does_not_weigh_up_what_runs_to_and_fro() {
    let half = straight([10.0, 20.4], [60.0, 20.4], 1.0);
    let corner = |k: u32| {
        DVec2::new(60.0 + f64::from(k) / 4.0, if k.is_multiple_of(2) { 20.3 } else { 20.3 + 3.0_f64.sqrt() / 4.0 })
    };
    let fro = (0..200).map(|k| piece([corner(k), corner(k + 1)], 1.0));
    let truth = truth(PAGE, half.into_iter().chain(fro).collect());
    near("length", truth.length(), 150.0);
    let judge = Judge::new(&truth).expect("a line");
    // Ink from 10 to 60 reaches to 61, by pixels to the centre of the one after its last.
    let found = judge.measure(&ink(&[row(20, 10..60)])).scores();
    assert!((found.agreement().recall - 52.0 / 150.0).abs() < 0.01, "{}", found.agreement().recall);
    assert_eq!(found.pixel_recall, 51.0 / 100.0);
    assert_eq!(judge.measure(&ink(&[row(20, 10..110)])).scores().pixel_recall, 1.0);
    assert_eq!(judge.measure(&ink(&[row(22, 10..110)])).scores().pixel_recall, 0.0, "2 px off");
    assert_eq!(judge.measure(&ink(&[])).scores().pixel_recall, 0.0);
}
