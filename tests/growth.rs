//! What the benchmark of scaling relies on: terrain resampled, and growth judged and plotted.

use hachure::door::measure::{Growth, Promise};
use hachure::door::report::growth_svg;

use crate::resample::resampled;

/// Awkward heights of a square grid.
fn rough(side: usize) -> Vec<f32> {
    (0..side * side).map(|i| ((i * i * 2_654_435_761) >> 7 & 1023) as f32).collect()
}

#[test]
fn a_ramp_resampled_is_the_same_ramp() {
    let ramp = |side: usize| {
        let at = move |i: usize| (i % side, i / side);
        let share = move |i: usize| i as f32 / (side - 1) as f32;
        (0..side * side).map(move |i| 300.0 + 70.0 * share(at(i).0) - 40.0 * share(at(i).1)).collect::<Vec<_>>()
    };
    for to in [16, 17, 37, 256] {
        let off = resampled(&ramp(16), 16, to).iter().zip(ramp(to)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-3, "16 samples a side to {to}: {off} m off");
    }
}

#[test]
fn samples_in_the_same_places_keep_their_heights() {
    let rough = rough(17);
    for times in [1, 2, 4, 32] {
        let side = 16 * times + 1;
        let fine = resampled(&rough, 17, side);
        assert_eq!(fine.len(), side * side);
        let kept = (0..17 * 17).map(|i| fine[i / 17 * times * side + i % 17 * times]);
        assert!(kept.eq(rough.iter().copied()), "{times} times as many");
    }
    // Between them no straight lines.
    let fine = resampled(&rough, 17, 33);
    let bend = |c: usize| fine[16 * 33 + 2 * c + 1] - (rough[8 * 17 + c] + rough[8 * 17 + c + 1]) / 2.0;
    assert!((0..16).all(|c| bend(c).abs() > 0.01), "{:?}", (0..16).map(bend).collect::<Vec<_>>());
}

fn growth(promise: Promise, times: [f64; 3]) -> Growth {
    let points = [256.0, 1024.0, 4096.0].into_iter().zip(times).map(|(size, ms)| [size, ms]).collect();
    let [title, caption, note, across] = ["Growth", "a < b", "by a device", "samples"].map(str::to_owned);
    Growth { title, caption, note, across, points, promise }
}

#[test]
fn a_promise_is_broken_by_any_size() {
    let broken = |promise, times| growth(promise, times).growth().iter().map(|(_, broken)| *broken).collect::<Vec<_>>();
    assert_eq!(broken(Promise::Below(1.6), [10.0, 15.9, 15.0]), [false; 3]);
    assert_eq!(broken(Promise::Below(1.6), [10.0, 16.0, 12.0]), [false, true, false]);
    assert_eq!(broken(Promise::Linear, [10.0, 40.0, 160.0]), [false; 3]);
    assert_eq!(broken(Promise::Linear, [10.0, 40.0, 160.1]), [false, false, true]);
    assert!(growth(Promise::Linear, [10.0, 9.0, 8.0]).is_kept());
    assert!(!growth(Promise::Below(1.6), [10.0, 16.0, 12.0]).is_kept());
}

#[test]
fn the_plot_of_growth_shows_every_time_and_the_promise() {
    let kept = growth(Promise::Below(1.6), [20.0, 25.54, 31.0]);
    let svg = growth_svg(&kept).expect("a plot");
    assert_eq!(svg, growth_svg(&kept).expect("a plot"));
    // Sizes, times beside their points, and what is promised, each once, on a page that other programs can read.
    for text in [
        "256",
        "1024",
        "4096",
        "20.0 ms",
        "25.5 ms",
        "31.0 ms",
        "promised: less than 1.6 times the first",
        "by a device",
    ] {
        assert_eq!(svg.matches(&format!(">\n{text}\n<")).count(), 1, "{text}");
    }
    assert!(svg.starts_with("<svg role=\"img\"") && svg.contains("a &lt; b") && !svg.contains("more than promised"));
    let broken = growth_svg(&growth(Promise::Linear, [20.0, 85.0, 100.0])).expect("a plot");
    assert_eq!(broken.matches("more than promised").count(), 1);
    assert!(broken.contains("1024: 85.0 ms, 4.25 times the first, more than promised."));
    assert!(broken.contains("promised: at most linear"));
    let nothing = Growth { points: Vec::new(), ..growth(Promise::Linear, [1.0; 3]) };
    assert!(nothing.is_kept() && growth_svg(&nothing).expect("a plot").contains("</svg>"));
}
