//! The smoothest surface inside a band: no height leaves it, a window has the bits of the whole, planes come back from steps.

use hachure::dem::Window;
use hachure::door::dem::smoothest::{HALO, smoothest};
use rayon::ThreadPoolBuilder;

use crate::scenes::Random;
use crate::tolerances::PLANE_OF_STEPS;

/// Heights and halves of a grid that begins at its DEM's first sample.
#[derive(Clone)]
struct Scene {
    size: [usize; 2],
    heights: Vec<f32>,
    half: Vec<f32>,
}

impl Scene {
    fn of(size: [usize; 2], step: f64, height: impl Fn(usize, usize) -> f64) -> Self {
        let places = (0..size[0] * size[1]).map(|i| (i % size[0], i / size[0]));
        let heights = places.map(|(c, r)| ((height(c, r) / step).round() * step) as f32).collect();
        Self { size, heights, half: vec![(step / 2.0) as f32; size[0] * size[1]] }
    }

    /// Wide terraces, narrow ones and noise, with voids, exact samples alone and in patches, and two steps.
    fn mixed(size: [usize; 2], step: f64, seed: u64) -> Self {
        let wave = |c: f64, r: f64| 9.0 * (c / 70.0).sin() * (r / 55.0).cos() + c / 60.0 + (r / 200.0).powi(4);
        let mut scene = Self::of(size, step, |c, r| 1000.0 + step * wave(c as f64, r as f64));
        let mut random = Random::new(seed);
        for i in 0..scene.heights.len() {
            let (c, r) = (i % size[0], i / size[0]);
            if c > size[0] / 2 && r < size[1] / 3 {
                scene.heights[i] += (step * f64::from(random.below(9))) as f32;
            }
            if random.below(200) == 0 || (c / 40 + r / 50).is_multiple_of(17) {
                scene.heights[i] = f32::NAN;
            } else if random.below(150) == 0 || (c / 90 + 2 * (r / 70)) % 9 == 4 {
                scene.half[i] = 0.0;
            } else if (c / 30 + r / 80) % 7 == 3 {
                scene.half[i] = (step / 20.0) as f32;
            }
        }
        scene
    }

    fn whole(&self) -> Window {
        Window { first: [0, 0], size: self.size }
    }

    fn smooth(&self, parallel: bool) -> Vec<f32> {
        let mut heights = self.heights.clone();
        smoothest(&mut heights, &self.half, self.whole(), parallel);
        heights
    }

    /// A window of the smooth heights, from samples up to `halo` around it.
    fn smooth_in(&self, window: Window, halo: usize) -> Vec<f32> {
        let first = window.first.map(|first| first.saturating_sub(halo));
        let end = [0, 1].map(|i| (window.first[i] + window.size[i] + halo).min(self.size[i]));
        let around = Window { first, size: [0, 1].map(|i| end[i] - first[i]) };
        let (mut heights, half) = (cut(&self.heights, self.size[0], around), cut(&self.half, self.size[0], around));
        smoothest(&mut heights, &half, around, false);
        let inside = Window { first: [0, 1].map(|i| window.first[i] - first[i]), ..window };
        cut(&heights, around.size[0], inside)
    }

    /// Samples of a surface that are not within their bands, moved without one, or are not there.
    fn wrong(&self, surface: &[f32]) -> usize {
        let samples = self.heights.iter().zip(&self.half).zip(surface);
        let wrong = samples.filter(|((height, half), smooth)| {
            let off = (f64::from(**height) - f64::from(**smooth)).abs();
            let same = height.to_bits() == smooth.to_bits();
            if height.is_nan() || **half == 0.0 { !same } else { off.is_nan() || off > f64::from(**half) }
        });
        wrong.count()
    }
}

/// The samples of a window of a grid of so many columns.
fn cut(samples: &[f32], columns: usize, window: Window) -> Vec<f32> {
    let rows = window.first[1]..window.first[1] + window.size[1];
    let row = |r: usize| &samples[r * columns + window.first[0]..][..window.size[0]];
    rows.flat_map(row).copied().collect()
}

fn bits(heights: &[f32]) -> Vec<u32> {
    heights.iter().map(|height| height.to_bits()).collect()
}

#[test]
fn no_height_leaves_its_band() {
    for (step, seed) in [(1.0, 3), (0.1, 4), (0.3048, 5), (10.0, 6)] {
        let scene = Scene::mixed([301, 257], step, seed);
        let mut smooth = scene.smooth(true);
        let moved = scene.heights.iter().zip(&smooth).filter(|(rough, smooth)| rough != smooth).count();
        let at_edge = (0..smooth.len()).filter(|i| (smooth[*i] - scene.heights[*i]).abs() >= 0.999 * scene.half[*i]);
        println!("step {step}: {moved} of {} samples moved, {} to the edge", smooth.len(), at_edge.count());
        assert!(moved > smooth.len() / 2);
        assert_eq!(scene.wrong(&smooth), 0, "step {step}");
        // Negative control: one sample a bit beyond its band, one without a band that moves, a void with a height.
        let loose = (0..smooth.len()).find(|i| scene.half[*i] > 0.0 && !smooth[*i].is_nan()).expect("a sample");
        let fixed = (0..smooth.len()).find(|i| scene.half[*i] == 0.0 && !smooth[*i].is_nan()).expect("an exact one");
        let void = smooth.iter().position(|height| height.is_nan()).expect("a void");
        smooth[loose] = (scene.heights[loose] + scene.half[loose]).next_up().next_up();
        (smooth[fixed], smooth[void]) = (smooth[fixed].next_up(), 7.0);
        assert_eq!(scene.wrong(&smooth), 3);
    }
}

#[test]
fn grids_of_any_size_are_smoothed() {
    for size in [[1, 1], [1, 9], [2, 2], [3, 1], [5, 4], [64, 33], [65, 2]] {
        let scene = Scene::of(size, 1.0, |c, r| c as f64 / 3.0 + r as f64 / 5.0);
        assert_eq!(scene.wrong(&scene.smooth(true)), 0, "{size:?}");
        let void = Scene { heights: vec![f32::NAN; size[0] * size[1]], ..scene };
        assert_eq!(void.wrong(&void.smooth(false)), 0, "{size:?} voids");
    }
}

#[test]
fn a_window_with_its_halo_has_the_bits_of_the_whole() {
    let scene = Scene::mixed([623, 579], 1.0, 11);
    let whole = scene.smooth(true);
    let mut random = Random::new(12);
    let mut blind = 0;
    for round in 0..14 {
        let size = [1 + random.below(70) as usize, 1 + random.below(50) as usize];
        let mut first = [0, 1].map(|i| random.below((scene.size[i] - size[i]) as u32) as usize);
        match round {
            0 => first = [0, 0],
            1 => first = [0, 1].map(|i| scene.size[i] - size[i]),
            _ => {}
        }
        let window = Window { first, size };
        let expected = bits(&cut(&whole, scene.size[0], window));
        assert_eq!(bits(&scene.smooth_in(window, HALO)), expected, "{window:?}");
        blind += usize::from(bits(&scene.smooth_in(window, HALO / 8)) == expected);
    }
    assert!(blind < 7, "an eighth of the halo must be too little: {blind} of 14 windows were the same");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let scene = Scene::mixed([400, 333], 1.0, 21);
    let alone = bits(&scene.smooth(false));
    for threads in [1, 3] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        assert_eq!(bits(&pool.install(|| scene.smooth(true))), alone, "{threads} threads");
    }
}

#[test]
fn what_is_not_finite_is_a_void() {
    let mut scene = Scene::mixed([90, 80], 1.0, 41);
    let smooth = scene.smooth(true);
    for (i, height) in scene.heights.iter_mut().enumerate().filter(|(_, height)| height.is_nan()) {
        *height = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN][i % 3];
    }
    assert_eq!(bits(&scene.smooth(true)), bits(&smooth));
}

/// The largest distance of a surface from what was rounded, as a share of the step, `border` samples from the border.
fn off(scene: &Scene, surface: &[f32], step: f64, border: usize, height: impl Fn(usize, usize) -> f64) -> f64 {
    let inside = |at: usize, end: usize| at >= border && at + border < end;
    let places = (0..surface.len()).map(|i| (i, i % scene.size[0], i / scene.size[0]));
    let places =
        places.filter(|(i, c, r)| inside(*c, scene.size[0]) && inside(*r, scene.size[1]) && !surface[*i].is_nan());
    places.map(|(i, c, r)| (f64::from(surface[i]) - height(c, r)).abs() / step).fold(0.0, f64::max)
}

#[test]
fn planes_come_back_from_their_steps() {
    for (width, degrees, step) in [(5.0, 20.0_f64, 1.0), (20.0, 70.0, 10.0), (50.0, 10.0, 1.0), (50.0, 35.0, 0.1)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let height = |c: usize, r: usize| 1500.0 + step * (c as f64 * cos + r as f64 * sin) / width;
        let scene = Scene::of([256, 256], step, height);
        let [rough, smooth] = [scene.heights.clone(), scene.smooth(true)].map(|s| off(&scene, &s, step, 64, height));
        println!("{width} samples a step, {degrees} degrees: {rough:.3} of a step off before, {smooth:.4} after");
        assert!(rough > 0.4 && smooth < PLANE_OF_STEPS, "{width}, {degrees}: {rough}, {smooth}");
    }
}

#[test]
fn voids_are_outside_and_not_at_sea_level() {
    let height = |c: usize, r: usize| 3000.0 + (0.8 * c as f64 + 0.6 * r as f64) / 6.0;
    let mut scene = Scene::of([256, 256], 1.0, height);
    for i in 0..scene.heights.len() {
        let (c, r) = ((i % 256) as f64 - 128.0, (i / 256) as f64 - 128.0);
        if c.hypot(r) < 30.0 || (i % 256 == 90) {
            scene.heights[i] = f32::NAN;
        }
    }
    let smooth = scene.smooth(true);
    let rim = |i: usize| [i - 1, i + 1, i - 256, i + 256].iter().any(|i| smooth[*i].is_nan());
    let rims: Vec<_> = (64 * 256..192 * 256).filter(|i| !smooth[*i].is_nan() && rim(*i)).collect();
    let error = |i: usize| f64::from(smooth[i]) - height(i % 256, i / 256);
    let mean = rims.iter().map(|i| error(*i)).sum::<f64>() / rims.len() as f64;
    let square = rims.iter().map(|i| error(*i).powi(2)).sum::<f64>() / rims.len() as f64;
    println!("{} samples beside voids: {mean:.4} m off on average, {:.4} root mean square", rims.len(), square.sqrt());
    assert!(rims.len() > 400 && mean.abs() < PLANE_OF_STEPS && square.sqrt() < 2.0 * PLANE_OF_STEPS);
}
