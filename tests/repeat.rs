//! What benchmarks repeat, and what they make of it.

use hachure::view::Camera;

/// The camera `k` metres on along its view direction.
pub fn moved(camera: &Camera, k: usize) -> Camera {
    Camera { eye: camera.eye + camera.axes()[2] * k as f64, ..*camera }
}

/// The value in the middle.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
