//! Pinhole camera with directions as surveyors give them.
//!
//! Azimuth a clockwise from the y axis of the world, altitude e upwards: forward f = (sin a cos e, cos a cos e, sin e), right
//! r = (cos a, -sin a, 0), up u = r x f, so that altitude +-90 is defined. Pixels are square, pixel (0, 0) is top
//! left with its centre at (0.5, 0.5).

use glam::{DVec2, DVec3};

/// Where the drawing is seen from. World: metres, x east, y north, z up (exaggerated).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Eye in metres: easting, northing, exaggerated height.
    pub eye: DVec3,
    /// Degrees clockwise from the y axis of the world; [`bearings`](crate::dem::Georeference::bearings) says how north lies.
    pub azimuth: f64,
    /// Degrees above the horizon, -90 to 90.
    pub altitude: f64,
    /// Horizontal field of view in degrees, above 0 and below 180.
    pub fov: f64,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// Azimuth and altitude of a direction, degrees to four decimals; `None` for no direction.
pub fn direction(towards: DVec3) -> Option<(f64, f64)> {
    let round = |degrees: f64| (degrees * 1e4).round() / 1e4;
    let level = towards.truncate().length();
    // Rounded last, so that it prints short.
    let azimuth = round(towards.x.atan2(towards.y).to_degrees().rem_euclid(360.0)).rem_euclid(360.0);
    (towards.length() > 0.0).then(|| (azimuth, round(towards.z.atan2(level).to_degrees())))
}

impl Camera {
    /// Right, up and forward, unit vectors.
    pub fn axes(&self) -> [DVec3; 3] {
        let (sin_a, cos_a) = self.azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = self.altitude.to_radians().sin_cos();
        let forward = DVec3::new(sin_a * cos_e, cos_a * cos_e, sin_e);
        let right = DVec3::new(cos_a, -sin_a, 0.0);
        [right, right.cross(forward), forward]
    }

    /// Pixels per unit of tangent: half the width over tan(fov / 2).
    pub fn focal(&self) -> f64 {
        f64::from(self.width) / 2.0 / (self.fov.to_radians() / 2.0).tan()
    }

    /// Image place in pixels and distance along the view axis in metres of a world point; the place is meaningless
    /// where the distance is not positive.
    pub fn project(&self, point: DVec3) -> (DVec2, f64) {
        let [right, up, forward] = self.axes();
        let p = point - self.eye;
        let w = p.dot(forward);
        let centre = DVec2::new(f64::from(self.width), f64::from(self.height)) / 2.0;
        (centre + DVec2::new(p.dot(right), -p.dot(up)) * (self.focal() / w), w)
    }

    /// Direction of the ray through an image place in pixels, scaled to advance 1 m along the view axis.
    pub fn ray(&self, place: DVec2) -> DVec3 {
        let [right, up, forward] = self.axes();
        let centre = DVec2::new(f64::from(self.width), f64::from(self.height)) / 2.0;
        let d = (place - centre) / self.focal();
        forward + right * d.x - up * d.y
    }

    /// The map projection of a rectangle of the page, given in pixels, as two inward normals in the map (x east, y
    /// north): a direction v is in it only where both n . v >= 0. `None` where the projection is no frustum of less than
    /// half the horizon. A pixel of margin.
    pub(crate) fn frustum_of(&self, low: DVec2, high: DVec2) -> Option<[DVec2; 2]> {
        let (low, high) = (low - 1.0, high + 1.0);
        let sees = |d: DVec3| {
            let (place, w) = self.project(self.eye + d);
            w > 0.0 && place.cmpge(low).all() && place.cmple(high).all()
        };
        if sees(DVec3::Z) || sees(DVec3::NEG_Z) {
            return None;
        }
        let middle = self.ray((low + high) / 2.0);
        let ahead = middle.x.atan2(middle.y);
        let corners = [low, DVec2::new(low.x, high.y), DVec2::new(high.x, low.y), high];
        let angles = corners.map(|place| {
            let d = self.ray(place);
            let angle = d.x.atan2(d.y) - ahead;
            angle.sin().atan2(angle.cos())
        });
        let low = angles.into_iter().fold(f64::INFINITY, f64::min);
        let high = angles.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if high - low > 3.1 {
            return None;
        }
        let normal = |angle: f64| DVec2::new((ahead + angle).cos(), -(ahead + angle).sin());
        Some([normal(low), -normal(high)])
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Camera {
    /// The page's map projection as two inward normals: see [`Self::frustum_of`].
    pub fn frustum(&self) -> Option<[DVec2; 2]> {
        self.frustum_of(DVec2::ZERO, DVec2::new(f64::from(self.width), f64::from(self.height)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_print_short() {
        for degrees in (0..3600).map(|tenth| f64::from(tenth) / 10.0 + 0.020_91) {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (azimuth, altitude) = direction(DVec3::new(sin, cos, 0.0)).expect("a direction");
            assert!(azimuth.to_string().len() <= 8 && altitude == 0.0, "{azimuth}");
            assert!((azimuth - degrees).abs() <= 0.5001e-4, "{azimuth} for {degrees}");
        }
        assert_eq!(direction(DVec3::new(-1e-9, 1.0, 0.0)), Some((0.0, 0.0)), "a full turn is none");
    }
}
