//! What a map does to the ground: its derivative with respect to true east and north.
//!
//! Method: central differences of the way from the map to longitude and latitude on the map's own ellipsoid, turned into
//! metres on the ground by that ellipsoid's radii of curvature (Snyder 1987, Map Projections: A Working Manual, section 4:
//! Tissot's indicatrix), at the middle and the four corners of a window. The 2 x 2 matrix tells handedness (sign of the
//! determinant), the least and the greatest scale (singular values), shear (how far the images of east and north are from
//! square). Cost: one way of PROJ and twenty places. Not handled: corners that have no place on the globe are left out;
//! a map that is worse between its corners than there; systems of no globe.

use std::f64::consts::TAU;

use glam::{DAffine2, DMat2, DVec2};

use super::crs::CrsPath;
use super::grid::GeoGrid;
use crate::dem::{Crs, History, Window};

/// A map whose metres differ from those on the ground by more than this share is off it.
const TRUE_SCALE: f64 = 0.01;
/// Steps of the differences as a share of the body's radius: 638 m on Earth.
const STEP: f64 = 1e-4;

/// Metres on the map a metre on the ground, at the places of a window that are on the globe.
pub(super) struct Ground(Vec<DMat2>);

impl Ground {
    /// Of the middle, first, and the corners of a window; `None` for degrees, and where no place is on the globe.
    pub(super) fn of(grid: &GeoGrid, window: Window) -> Option<Self> {
        Self::at(&grid.crs, &places(grid, window))
    }

    /// Of places in `crs`.
    pub(super) fn at(crs: &Crs, places: &[DVec2]) -> Option<Self> {
        let unit = crs.metres_per_unit()?;
        let globe = crs.geographic()?;
        let (way, radii) = (CrsPath::between(crs, &globe)?, globe.radii()?);
        let step = STEP * radii[0] / unit;
        let steps = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|side| side * step);
        let around = places.iter().flat_map(|place| steps.map(|step| *place + step));
        let mut around: Vec<_> = around.collect();
        way.carry(&mut around);
        let radians = TAU / globe.turn()?;
        let of = |places: &[DVec2]| derivative(places, radians, radii, 2.0 * step * unit);
        let derivatives: Vec<_> = around.chunks_exact(steps.len()).filter_map(of).collect();
        (!derivatives.is_empty()).then_some(Self(derivatives))
    }

    /// Least and greatest scale: metres on the map a metre on the ground.
    pub(super) fn scale(&self) -> [f64; 2] {
        let scales = self.0.iter().map(scales);
        scales.fold([f64::INFINITY, 0.0], |[least, greatest], [low, high]| [least.min(low), greatest.max(high)])
    }

    /// How far east and north are from square on the map, at most: the cosine of the angle between them.
    pub(super) fn shear(&self) -> f64 {
        let cosine = |m: &DMat2| m.x_axis.dot(m.y_axis).abs() / (m.x_axis.length() * m.y_axis.length());
        self.0.iter().map(cosine).fold(0.0, f64::max)
    }

    /// By which share metres are off at most, along any direction.
    pub(super) fn off(&self) -> f64 {
        let [least, greatest] = self.scale();
        (1.0 - least).max(greatest - 1.0).max(self.shear())
    }

    /// Whether that is more than a drawing should have.
    pub(super) fn is_off(&self) -> bool {
        self.off() > TRUE_SCALE
    }

    /// What becomes of slopes that are drawn in metres of the map, in words.
    pub(super) fn slopes(&self) -> &'static str {
        let [least, greatest] = self.scale();
        match (least > 1.0 - TRUE_SCALE, greatest < 1.0 + TRUE_SCALE) {
            (true, false) => "too flat",
            (false, true) => "too steep",
            _ => "wrong",
        }
    }

    /// Scale and shear, in words.
    pub(super) fn words(&self) -> String {
        let [least, greatest] = self.scale().map(|scale| format!("{scale:.3}"));
        let scale = if least == greatest { least } else { format!("{least} to {greatest}") };
        format!("scale {scale}, shear {:.1} degrees", self.shear().min(1.0).asin().to_degrees())
    }
}

/// The middle and the corners of the outermost samples.
pub(super) fn places(grid: &GeoGrid, window: Window) -> [DVec2; 5] {
    let grid = grid.part(window);
    let (c, r) = ((grid.columns - 1) as f64, (grid.rows - 1) as f64);
    [[c / 2.0, r / 2.0], [0.0, 0.0], [c, 0.0], [0.0, r], [c, r]].map(|[c, r]| grid.sample(c, r))
}

/// Of the longitudes and latitudes, in units of so many radians, a little east, west, north and south on the map, `step`
/// metres apart.
fn derivative(places: &[DVec2], radians: f64, [equator, pole]: [f64; 2], step: f64) -> Option<DMat2> {
    let &[east, west, north, south] = places else { return None };
    let latitude = (east.y + west.y) / 2.0 * radians;
    // Radii of curvature along the meridian and across it.
    let squared = 1.0 - (pole / equator).powi(2);
    let flat = 1.0 - squared * latitude.sin().powi(2);
    let along = equator * (1.0 - squared) / flat.powf(1.5);
    let across = equator / flat.sqrt() * latitude.cos();
    let ground = |from: DVec2, to: DVec2| {
        let turn = ((to.x - from.x) * radians + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        DVec2::new(turn * across, (to.y - from.y) * radians * along) / step
    };
    let derivative = DMat2::from_cols(ground(west, east), ground(south, north)).inverse();
    derivative.is_finite().then_some(derivative)
}

/// Singular values, the lower first.
fn scales(m: &DMat2) -> [f64; 2] {
    let [a, b, c, d] = [m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y];
    let (turned, mirrored) = ((a + d).hypot(c - b) / 2.0, (a - d).hypot(b + c) / 2.0);
    [(turned - mirrored).abs(), turned + mirrored]
}

/// `grid` in coordinates that run east and north where those of its map do not: left-handed ones, and such as its
/// definition says run west or south. `like` is a system that has been through this.
pub(super) fn upright(grid: GeoGrid, like: Option<&Crs>, history: &mut History) -> GeoGrid {
    let axes = match like {
        Some(like) if like.as_defined() == grid.crs => like.axes(),
        _ => axes(&grid),
    };
    if axes == DMat2::IDENTITY {
        return grid;
    }
    history.convert(words(axes, &grid.crs));
    GeoGrid { to_crs: DAffine2::from_mat2(axes) * grid.to_crs, crs: grid.crs.with_axes(axes), ..grid }
}

/// What turns and flips the map of `grid` to east and north, as nearly as can be; one where nothing is to be done.
fn axes(grid: &GeoGrid) -> DMat2 {
    let none = DMat2::IDENTITY;
    let ground = Ground::of(grid, grid.whole()).map(|ground| ground.0);
    // Where a map folds over beyond its area, it is left-handed in a part.
    let left_handed = |places: &[DMat2]| places.iter().all(|derivative| derivative.determinant() < 0.0);
    let derivative = match (ground, grid.crs.west_or_south()) {
        (Some(places), said) if said.is_some() || left_handed(&places) => places[0],
        (None, Some(said)) => said,
        _ => return none,
    };
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[x, y]| [x * DVec2::X, y * DVec2::Y]);
    let turns = signs.into_iter().flat_map(|[x, y]| [DMat2::from_cols(x, y), DMat2::from_cols(y, x)]);
    let righted = turns.filter(|turn| (*turn * derivative).determinant() > 0.0);
    let north_up = |turn: &DMat2| (*turn * derivative).x_axis.x + (*turn * derivative).y_axis.y;
    righted.max_by(|one, other| north_up(one).total_cmp(&north_up(other))).unwrap_or(none)
}

fn words(axes: DMat2, crs: &Crs) -> String {
    let of = |row: DVec2| {
        let sign = if row.x + row.y < 0.0 { "-" } else { "" };
        format!("{sign}{}", if row.x == 0.0 { "y" } else { "x" })
    };
    let [east, north] = [of(axes.row(0)), of(axes.row(1))];
    format!("axes of {} turned to run east and north: east is {east}, north is {north}, nothing resampled", crs.label())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(epsg: u32, longitude: f64, latitude: f64) -> GeoGrid {
        let crs = Crs::from_epsg(epsg).expect("a system");
        let way = CrsPath::between(&Crs::lonlat().expect("degrees"), &crs).expect("a way");
        let place = way.place(DVec2::new(longitude, latitude)).expect("a place");
        let matrix = DMat2::from_diagonal(DVec2::new(30.0, -30.0));
        GeoGrid {
            crs,
            to_crs: DAffine2::from_mat2_translation(matrix, place - matrix * DVec2::splat(100.0)),
            columns: 200,
            rows: 200,
        }
    }

    fn ground(grid: &GeoGrid) -> Ground {
        Ground::of(grid, grid.whole()).expect("a place")
    }

    #[test]
    fn scales_are_those_of_the_formulas() {
        // Web Mercator on the ellipsoid (Snyder): along the parallel a sqrt(1 - e2 sin2) / (a cos), along the meridian more.
        let (squared, latitude) = (0.006_694_379_990_141_f64, 45f64.to_radians());
        let flat = 1.0 - squared * latitude.sin().powi(2);
        let across = flat.sqrt() / latitude.cos();
        let along = flat.powf(1.5) / (1.0 - squared) / latitude.cos();
        let grid = about(3857, 10.0, 45.0);
        let middle = grid.part(Window { first: [99, 99], size: [2, 2] });
        let [least, greatest] = ground(&middle).scale();
        assert!((least / across.min(along) - 1.0).abs() < 1e-5, "{least} {across} {along}");
        assert!((greatest / across.max(along) - 1.0).abs() < 1e-5, "{greatest} {across} {along}");
        // UTM is .9996 at its meridian, and true within a percent anywhere in its zone.
        let [least, greatest] = ground(&about(32632, 9.0, 50.0)).scale();
        assert!((least - 0.9996).abs() < 1e-6 && (greatest - 0.9996).abs() < 1e-6, "{least} {greatest}");
        assert!(!ground(&about(32632, 12.0, 0.0)).is_off());
        // Plate carree is true from north to south, Albers by area alone, a polar map within its circle is too small.
        let slopes = |epsg, longitude, latitude| ground(&about(epsg, longitude, latitude)).slopes();
        assert_eq!(
            [slopes(32662, 10.0, 60.0), slopes(5070, -81.0, 25.0), slopes(3413, 10.0, 89.0)],
            ["too flat", "wrong", "too steep"]
        );
    }

    #[test]
    fn singular_values() {
        let turn = DMat2::from_angle(0.7);
        let [low, high] = scales(&(turn * DMat2::from_diagonal(DVec2::new(2.0, -0.5)) * turn.transpose()));
        assert!((low - 0.5).abs() < 1e-12 && (high - 2.0).abs() < 1e-12, "{low} {high}");
    }

    #[test]
    fn axes_that_run_elsewhere_are_turned_and_others_left() {
        let columns = |x: [f64; 2], y: [f64; 2]| DMat2::from_cols(x.into(), y.into());
        let swapped = columns([0.0, -1.0], [-1.0, 0.0]);
        assert_eq!(axes(&about(5513, 15.0, 50.0)), swapped, "south, west");
        assert_eq!(axes(&about(2065, 15.0, 50.0)), swapped);
        assert_eq!(axes(&about(2048, 19.5, -30.0)), columns([-1.0, 0.0], [0.0, -1.0]), "west, south");
        // PROJ knows no way from there to the globe.
        let to_crs = DAffine2::from_translation(DVec2::splat(5e5));
        let west_north = GeoGrid { crs: Crs::from_epsg(3052).expect("a system"), to_crs, ..about(2048, 19.5, -30.0) };
        assert_eq!(axes(&west_north), columns([-1.0, 0.0], [0.0, 1.0]), "west, north");
        // North, east; east, north; and maps of a pole, whose axes both run north or south.
        for (epsg, longitude, latitude) in
            [(2193, 173.0, -41.0), (31467, 9.0, 50.0), (5514, 15.0, 50.0), (3413, 100.0, 72.0), (3031, 100.0, -72.0)]
        {
            assert_eq!(axes(&about(epsg, longitude, latitude)), DMat2::IDENTITY, "EPSG:{epsg}");
        }
    }
}
