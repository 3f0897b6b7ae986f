//! Every figure of the metrics on lines and ink of which it is known by formula, and by a judge as slow as its words.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, SQRT_2};
use std::ops::Range;

use glam::DVec2;
use hachure::truth::metrics::{Agreement, BandScore, DISTANCES, FRAGMENT, Judge, Offsets, Scores};
use hachure::truth::{Inked, Mask, Truth, TruthPiece};

use crate::judged::{piece, truth};
use crate::scenes::Random;
use crate::tolerances::{CIRCLE_PX, CIRCLE_SHARE, PIXEL_PX, SUM};

pub const PAGE: [u32; 2] = [128, 96];

/// A straight line in pieces of a quarter pixel, `distance` metres away.
pub fn straight(from: [f64; 2], to: [f64; 2], distance: f64) -> Vec<TruthPiece> {
    let (from, to) = (DVec2::from(from), DVec2::from(to));
    let count = (from.distance(to) * 4.0).ceil() as u32;
    let at = |k: u32| from.lerp(to, f64::from(k) / f64::from(count));
    (0..count).map(|k| piece([at(k), at(k + 1)], distance)).collect()
}

/// Ink in a row, 1 m away.
pub fn row(row: u32, columns: Range<u32>) -> Vec<Inked> {
    columns.map(|column| Inked { column, row, distance: 1.0 }).collect()
}

pub fn ink(parts: &[Vec<Inked>]) -> Mask {
    Mask { size: PAGE, inked: parts.concat() }
}

/// How far lines lie above the centres of their row, px: no distance is decided by rounding.
const ABOVE: f64 = 0.1;

/// 100 px along row 20, columns 10 to 109.
fn level_line() -> Truth {
    truth(PAGE, straight([10.0, 20.5 - ABOVE], [110.0, 20.5 - ABOVE], 1.0))
}

fn scores(truth: &Truth, mask: &Mask) -> Scores {
    Judge::new(truth).expect("a line on the page").measure(mask).scores()
}

#[track_caller]
fn near(what: &str, found: f64, known: f64, tolerance: f64) {
    assert!((found - known).abs() <= tolerance, "{what}: {found}, by formula {known}");
}

/// A circle of 200 px about (256.3, 255.7) moved right.
fn circle(moved: f64) -> Truth {
    let at =
        |k: u32| DVec2::from_angle(f64::from(k) * 4.0 * FRAC_PI_2 / 5200.0) * 200.0 + DVec2::new(256.3 + moved, 255.7);
    truth([512; 2], (0..5200).map(|k| piece([at(k), at(k + 1)], 1.0)).collect())
}

/// A circle moved by d lies d |cos| of the angle from where it was, but for d d / 2 R: as often above as below.
#[test]
fn a_moved_circle_is_as_far_off_as_geometry_says() {
    let here = circle(0.0);
    for moved in [1.0, 2.0, 3.0, 4.0] {
        let there = circle(moved);
        let places: Vec<DVec2> = there.pieces.iter().map(TruthPiece::middle).collect();
        let (judge, back) = (Judge::new(&here).expect("a circle"), Judge::new(&there).expect("a circle"));
        for offsets in [judge.offsets(&places), judge.offsets_of(&there), back.offsets_of(&here)] {
            let Offsets { mean, median, p95 } = offsets.expect("places");
            near("mean", mean, moved / FRAC_PI_2, CIRCLE_PX);
            near("median", median, moved / SQRT_2, CIRCLE_PX);
            near("95 %", p95, moved * (0.95 * FRAC_PI_2).sin(), CIRCLE_PX);
        }
        assert_eq!(judge.offsets(&[]), None, "no places, no offsets");
    }
}

#[test]
fn offsets_of_lines_count_by_length() {
    // Of 100 px of line 40 lie 2 px off in four pieces, 60 lie 5 px off in one.
    let near = (0..4).map(|k| piece([10.0, 20.0].map(|x| DVec2::new(x + 10.0 * f64::from(k), 22.4)), 1.0));
    let far = piece([DVec2::new(50.0, 25.4), DVec2::new(110.0, 25.4)], 1.0);
    let lines = truth(PAGE, near.chain([far]).collect());
    let known = Offsets { mean: 0.4 * 2.0 + 0.6 * 5.0, median: 5.0, p95: 5.0 };
    let found = Judge::new(&level_line()).and_then(|judge| judge.offsets_of(&lines)).expect("lines");
    for (found, known) in [(found.mean, known.mean), (found.median, known.median), (found.p95, known.p95)] {
        assert!((found - known).abs() <= SUM, "{found}, by formula {known}");
    }
}

/// In pixels: a line at angle a crosses |sin| + |cos| of them for each pixel of its length.
#[test]
fn a_moved_circle_of_pixels_agrees_as_geometry_says() {
    let moved = 4.0;
    let (here, there) = (circle(0.0), circle(moved));
    let found = scores(&here, &Mask::of_truth(&there));
    for (k, at) in DISTANCES.iter().zip(found.at) {
        let angle = |within: f64| (within / moved).min(1.0).asin();
        let by_pixels = (1.0 + angle(k + 0.5).sin() - angle(k + 0.5).cos()) / 2.0;
        let [least, most] = [k + 0.5, k + 1.0].map(|within| angle(within) / FRAC_PI_2);
        let Agreement { precision, recall } = at;
        println!("within {k} px: P {precision:.4} of {by_pixels:.4}, R {recall:.4} of {least:.4} to {most:.4}");
        near("precision", precision, by_pixels, CIRCLE_SHARE);
        // Centres lie beside the line, and the nearest of them counts.
        assert!(recall >= least && recall <= most, "within {k} px: recall {recall}, by formula {least} to {most}");
    }
    let (chamfer, h95) = (found.chamfer.unwrap(), found.h95.unwrap());
    let by_pixels = moved * (FRAC_PI_2 + 1.0) / 4.0;
    println!("chamfer {chamfer:.3} px, 95 % within {h95:.3} px");
    near("chamfer", chamfer, (by_pixels + moved / FRAC_PI_2) / 2.0, PIXEL_PX);
    near("95 %", h95, moved * (0.95 * FRAC_PI_2).sin(), PIXEL_PX);
}

#[test]
fn parallel_lines_are_as_far_off_as_they_are_moved() {
    for rows in 0..5 {
        let found = scores(&level_line(), &ink(&[row(20 + rows, 10..110)]));
        let apart = f64::from(rows) + ABOVE;
        for (k, at) in DISTANCES.iter().zip(found.at) {
            let agrees = if apart <= k + 0.5 { 1.0 } else { 0.0 };
            assert_eq!(at.precision, agrees, "{rows} px off, within {k}: precision");
            near("recall", at.recall, agrees, SUM);
            near("F", at.f(), agrees, SUM);
        }
        assert_eq!(found.gaps, usize::from(rows > 1), "{rows} px off");
        assert_eq!(found.spurious, usize::from(rows > 2), "{rows} px off");
        // A piece at x from the nearest centre is hypot(x, apart) away; x is 1/8 or 3/8 px.
        let to_ink = [0.125, 0.375].map(|x: f64| x.hypot(apart));
        near("chamfer", found.chamfer.unwrap(), (apart + (to_ink[0] + to_ink[1]) / 2.0) / 2.0, SUM);
        near("95 %", found.h95.unwrap(), to_ink[1], SUM);
    }
}

#[test]
fn half_the_length_may_be_recalled_and_f_is_the_harmonic_mean() {
    let found = scores(&level_line(), &ink(&[row(20, 10..60), row(70, 0..25)])).agreement();
    // Ink ends at a centre of 59.5: it reaches to 61.0.
    near("recall", found.recall, 0.51, SUM);
    near("precision", found.precision, 50.0 / 75.0, SUM);
    near("F", found.f(), 2.0 / (1.0 / 0.51 + 75.0 / 50.0), SUM);
}

#[test]
fn holes_are_missed_by_length_and_are_gaps_from_three_pixels_on() {
    for wide in 0_u32..12 {
        // Ink on either side reaches a pixel into the hole.
        let missed = wide.saturating_sub(2);
        let one = ink(&[row(20, 10..40), row(20, 40 + wide..110)]);
        let truth = level_line();
        let judge = Judge::new(&truth).unwrap();
        let measured = judge.measure(&one);
        let found = measured.scores();
        near("recall", found.agreement().recall, 1.0 - f64::from(missed) / 100.0, SUM);
        assert_eq!(found.agreement().precision, 1.0, "a hole of {wide} px");
        assert_eq!(found.gaps, usize::from(missed >= 3), "a hole of {wide} px");
        let columns: Vec<u32> = measured.missed().inked.iter().map(|p| p.column).collect();
        assert_eq!(columns, (41..41 + missed).collect::<Vec<_>>(), "a hole of {wide} px");
    }
    let two = ink(&[row(20, 10..40), row(20, 48..60), row(20, 70..110)]);
    assert_eq!(scores(&level_line(), &two).gaps, 2, "two holes");
}

#[test]
fn a_doubled_line_halves_precision() {
    for (rows, within, spurious) in
        [(1, [0.5, 1.0, 1.0, 1.0], 0), (2, [0.5, 0.5, 1.0, 1.0], 0), (3, [0.5, 0.5, 0.5, 1.0], 1), (9, [0.5; 4], 1)]
    {
        let found = scores(&level_line(), &ink(&[row(20, 10..110), row(20 + rows, 10..110)]));
        assert_eq!(found.at.map(|at| at.precision), within, "a line {rows} px beside it");
        assert!(found.at.iter().all(|at| at.recall == 1.0), "a line {rows} px beside it: {:?}", found.at);
        assert_eq!((found.spurious, found.gaps), (spurious, 0), "a line {rows} px beside it");
    }
}

#[test]
fn stray_dots_are_fragments_and_spurious_only_if_wholly_far() {
    // Dots of 1, 5 and 6 px; the last one begins 2 px from the line.
    let dots = [row(60, 5..6), row(70, 5..10), row(80, 5..11)];
    let spur = (22..26).flat_map(|r| row(r, 50..51)).collect();
    let mask = ink(&[&[row(20, 10..110), spur], &dots[..]].concat());
    let found = scores(&level_line(), &mask);
    assert_eq!(mask.components().len(), 5);
    assert_eq!(FRAGMENT, 6);
    near("fragments", found.fragments, 3.0 / 5.0, SUM);
    assert_eq!(found.spurious, 3, "the dots but not what touches 2.5 px");
    near("precision", found.agreement().precision, 100.0 / 116.0, SUM);
    let truth = level_line();
    let judge = Judge::new(&truth).unwrap();
    let agrees: Vec<bool> = judge.measure(&mask).agrees().collect();
    assert_eq!(agrees, [vec![true; 100], vec![false; 16]].concat(), "pixel by pixel");
}

#[test]
fn bands_of_depth_hold_a_third_of_the_line_each() {
    let lines = [20.0, 40.0, 60.0].map(|y| straight([10.0, y + 0.5], [110.0, y + 0.5], 100.0 * y));
    let at =
        |r: u32, columns: Range<u32>, distance| row(r, columns).into_iter().map(|p| Inked { distance, ..p }).collect();
    // The near line is drawn, half of the middle one, of the far one nothing; strays at the far one's depth.
    let mask = ink(&[at(20, 10..110, 1990.0), at(40, 10..60, 4000.0), at(90, 10..20, 9000.0), at(60, 0..5, 6000.0)]);
    let bands = scores(&truth(PAGE, lines.concat()), &mask).bands;
    assert_eq!(bands.map(|band| band.to), [2000.0, 4000.0, f64::INFINITY]);
    assert_eq!(bands.map(|band| band.inked), [100, 50, 15]);
    for (band, recall) in bands.iter().zip([1.0, 0.51, 0.0]) {
        near("length", band.length, 100.0, SUM);
        near("recall", band.agreement.recall, recall, SUM);
    }
    assert_eq!(bands.map(|band| band.agreement.precision), [1.0, 1.0, 0.0]);
    // Along a line that recedes evenly, bands end at a third and two thirds of the way, whatever its pieces.
    let [short, long] = [10.0, 30.0].map(|x| straight([x, 20.5], [x + 20.0, 20.5], 0.0));
    let short = short.iter().flat_map(|piece| {
        let [a, b] = piece.ends;
        [[a, a.midpoint(b)], [a.midpoint(b), b]].map(|ends| TruthPiece { ends, ..*piece })
    });
    let mut receding: Vec<TruthPiece> = short.chain(long).chain(straight([50.0, 20.5], [110.0, 20.5], 0.0)).collect();
    receding.iter_mut().for_each(|piece| piece.distance = piece.middle().x);
    let bands = scores(&truth(PAGE, receding), &ink(&[])).bands;
    near("first end", bands[0].to, 10.0 + 100.0 / 3.0, 0.25);
    near("second end", bands[1].to, 10.0 + 200.0 / 3.0, 0.25);
    assert!(bands.iter().all(|band| band.agreement == Agreement { precision: 1.0, recall: 0.0 }), "{bands:?}");
}

#[test]
fn an_empty_mask_is_precise_and_recalls_nothing() {
    let found = scores(&level_line(), &ink(&[]));
    for at in found.at {
        assert_eq!((at.precision, at.recall, at.f()), (1.0, 0.0, 0.0));
    }
    assert_eq!((found.chamfer, found.h95), (None, None));
    assert_eq!((found.gaps, found.spurious, found.fragments), (1, 0, 0.0));
    assert!(Judge::new(&truth(PAGE, vec![])).is_none(), "without a line there is nothing to judge by");
    assert!(Judge::new(&truth(PAGE, straight([-2.0, 5.0], [-2.0, 50.0], 1.0))).is_none(), "all beyond the page");
}

#[test]
fn lines_beyond_the_page_excuse_ink_and_are_not_asked_for() {
    let outside = straight([-0.9, 10.0], [-0.9, 60.0], 1.0);
    let lines = truth(PAGE, [straight([10.0, 80.5], [110.0, 80.5], 1.0), outside].concat());
    let edge = (10..60).flat_map(|r| row(r, 0..1)).collect();
    let found = scores(&lines, &ink(&[row(80, 10..110), edge]));
    near("length", lines.length(), 100.0, SUM);
    assert_eq!(found.at.map(|at| at.recall), [1.0; 4], "the line beyond the page is asked for");
    assert_eq!(found.at.map(|at| at.precision), [100.0 / 150.0, 1.0, 1.0, 1.0], "1.4 px off: precision");
    assert_eq!((found.gaps, found.spurious), (0, 0));
}

#[test]
fn a_slow_judge_agrees() {
    let mut random = Random::new(3);
    for _ in 0..40 {
        let (truth, mask) = scatter(&mut random);
        let judge = Judge::new(&truth).expect("lines");
        let measured = judge.measure(&mask);
        let found = measured.scores();
        let to_truth: Vec<_> = mask.inked.iter().map(|p| (to_lines(p.centre(), &truth.pieces), 1.0)).collect();
        let inside = |p: DVec2| (0.0..128.0).contains(&p.x) && (0.0..96.0).contains(&p.y);
        let nearest = |p: DVec2| mask.inked.iter().map(|q| q.centre().distance(p)).fold(f64::INFINITY, f64::min);
        let pieces = truth.pieces.iter().filter(|p| inside(p.middle()));
        let to_ink: Vec<_> = pieces.map(|p| (nearest(p.middle()), p.ends[0].distance(p.ends[1]))).collect();
        for (k, at) in DISTANCES.iter().zip(found.at) {
            near("precision", at.precision, share(&to_truth, k + 0.5), SUM);
            near("recall", at.recall, share(&to_ink, k + 0.5), SUM);
        }
        near("chamfer", found.chamfer.unwrap(), (mean(&to_truth) + mean(&to_ink)) / 2.0, SUM);
        let h95 = found.h95.unwrap();
        let least = share(&to_truth, h95 + SUM).min(share(&to_ink, h95 + SUM));
        let less = share(&to_truth, h95 - SUM).min(share(&to_ink, h95 - SUM));
        assert!(least >= 0.95 - SUM && less < 0.95, "95 % lie within {h95}: {least}, {less}");
        // All bands together are the whole, pixel by pixel it is the same, and so are the sets wholly farther than 2.5 px.
        let of_bands = |weight: fn(&BandScore) -> f64, share: fn(&BandScore) -> f64| {
            found.bands.iter().map(|band| weight(band) * share(band)).sum::<f64>()
                / found.bands.iter().map(weight).sum::<f64>()
        };
        near("precision of bands", of_bands(|b| b.inked as f64, |b| b.agreement.precision), share(&to_truth, 1.5), SUM);
        near("recall of bands", of_bands(|b| b.length, |b| b.agreement.recall), share(&to_ink, 1.5), SUM);
        assert!(measured.agrees().eq(to_truth.iter().map(|(d, _)| *d <= 1.5)), "pixels within 1.5 px");
        let far = |set: &&Vec<usize>| set.iter().all(|&i| to_truth[i].0 > 2.5);
        assert_eq!(found.spurious, mask.components().iter().filter(far).count(), "sets farther than 2.5 px");
    }
}

/// Four lines at all depths, some beyond the page, and 300 pixels anywhere.
fn scatter(random: &mut Random) -> (Truth, Mask) {
    let mut pieces = Vec::new();
    for _ in 0..4 {
        let [from, to] = [0, 1].map(|_| [random.between(-4.0, 132.0), random.between(-4.0, 100.0)]);
        pieces.extend(straight(from, to, 1.0));
    }
    pieces.iter_mut().for_each(|piece| piece.distance = random.between(1.0, 9.0));
    let places: BTreeSet<[u32; 2]> = (0..300).map(|_| [random.below(PAGE[1]), random.below(PAGE[0])]).collect();
    let inked = places.into_iter().map(|[row, column]| Inked { column, row, distance: random.between(0.0, 10.0) });
    (truth(PAGE, pieces), ink(&[inked.collect()]))
}

fn to_lines(p: DVec2, pieces: &[TruthPiece]) -> f64 {
    let to =
        |[a, b]: [DVec2; 2]| p.distance(a.lerp(b, ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0)));
    pieces.iter().map(|piece| to(piece.ends)).fold(f64::INFINITY, f64::min)
}

/// Share of the weights at distances up to `within`.
fn share(weighted: &[(f64, f64)], within: f64) -> f64 {
    let sum = |most: f64| weighted.iter().filter(|(d, _)| *d <= most).map(|(_, w)| w).sum::<f64>();
    sum(within) / sum(f64::INFINITY)
}

fn mean(weighted: &[(f64, f64)]) -> f64 {
    weighted.iter().map(|(d, w)| d * w).sum::<f64>() / weighted.iter().map(|(_, w)| w).sum::<f64>()
}
