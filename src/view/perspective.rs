//! Between the world and a page with depth: a camera, its near plane, and what projecting takes worked out.
//!
//! Depth is near / distance along the view axis (infinite reversed Z): larger is nearer, 0 is endlessly far. It is linear
//! on the page along a straight line of the world.

use glam::{DVec2, DVec3};

use super::Camera;

/// How a camera sees, in both directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perspective {
    eye: DVec3,
    /// Right, up and forward.
    axes: [DVec3; 3],
    /// Pixels across and down.
    size: DVec2,
    /// Pixels per unit of tangent.
    focal: f64,
    /// Metres along the view axis to the near plane.
    near: f64,
}

impl Perspective {
    /// What a camera sees, whose depths are those of a near plane `near` metres before it.
    pub fn new(camera: &Camera, near: f64) -> Self {
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        Self { eye: camera.eye, axes: camera.axes(), size, focal: camera.focal(), near }
    }

    /// Where it sees from, metres of the exaggerated world.
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// Pixels across and down.
    pub fn size(&self) -> DVec2 {
        self.size
    }

    /// Pixels for each unit of tangent.
    pub fn focal(&self) -> f64 {
        self.focal
    }

    /// Metres along the view axis to the near plane.
    pub fn near(&self) -> f64 {
        self.near
    }

    /// Metres along the view axis to a point of the world.
    pub fn distance(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.axes[2])
    }

    /// Place on the page in px and depth of a point of the world; meaningless where its distance is not positive.
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let [right, up, _] = self.axes;
        let (p, distance) = (point - self.eye, self.distance(point));
        (self.size / 2.0 + DVec2::new(p.dot(right), -p.dot(up)) * (self.focal / distance), self.near / distance)
    }

    /// The point of the world at a place on the page in px at a depth above 0.
    pub fn unproject(&self, place: DVec2, depth: f64) -> DVec3 {
        let [right, up, forward] = self.axes;
        let d = (place - self.size / 2.0) / self.focal;
        self.eye + (forward + right * d.x - up * d.y) * (self.near / depth)
    }

    /// Most pixels that a metre across takes on the page in a box of the world, by its low and high corner; 0 where that lies
    /// beside the page.
    pub(crate) fn most_px_per_metre(&self, [low, high]: [DVec3; 2]) -> f64 {
        let corner = |k: usize| DVec3::new([low, high][k & 1].x, [low, high][k >> 1 & 1].y, [low, high][k >> 2].z);
        let [right, up, forward] = self.axes;
        // What the page shows, in tangents.
        let half = self.size / 2.0 / self.focal;
        let in_view = |corner: DVec3| {
            let p = corner - self.eye;
            let (x, y, z) = (p.dot(right), p.dot(up), p.dot(forward));
            [half.x * z - x, half.x * z + x, half.y * z - y, half.y * z + y, z - self.near]
        };
        let sides: [[f64; 5]; 8] = std::array::from_fn(|k| in_view(corner(k)));
        if (0..5).any(|side| sides.iter().all(|corner| corner[side] < 0.0)) {
            return 0.0;
        }
        // A page is stretched towards its corners, by the square of how much farther they are.
        let stretch = 1.0 + half.length_squared();
        let nearest = self.eye.clamp(low, high).distance(self.eye);
        self.focal * stretch / nearest.max(self.near)
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Perspective {
    /// How the place on the page of a point of the world moves where this moves so, px; meaningless where its distance is not
    /// positive.
    pub fn moves(&self, point: DVec3, by: DVec3) -> DVec2 {
        let [right, up, forward] = self.axes;
        let (p, distance) = (point - self.eye, self.distance(point));
        let (at, ahead) = (DVec2::new(p.dot(right), -p.dot(up)) / distance, by.dot(forward));
        (DVec2::new(by.dot(right), -by.dot(up)) - at * ahead) * (self.focal / distance)
    }
}
