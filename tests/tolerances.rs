//! Every tolerance of the integration tests, each with its unit and a worked example.

/// What the rasterizer may differ by.
pub mod raster {
    /// Distance on the page between a vertex of the GPU and its f64 evaluation, px.
    ///
    /// Reason: places are rounded to 1/256 px, which alone is up to sqrt(2) / 512 = 0.0028 px; the rest is f32.
    /// Example: with 1109 px per unit of tangent, f32 coordinates of a vertex 20 km away have steps of 0.002 m, which
    /// are 0.0001 px; the unit vectors of the camera in f32 add up to 1109 * 2^-24 * 2 = 0.0001 px.
    pub const VERTEX_PX: f64 = 1.0 / 64.0;

    /// Relative difference of a vertex's depth from its f64 evaluation.
    ///
    /// Reason: a few f32 roundings of 2^-24 each, on top of those of the eye-relative position.
    /// Example: 10 km along the view axis, 2^-20 are 1 cm.
    pub const VERTEX_DEPTH: f64 = 1.0 / (1 << 20) as f64;

    /// Half the width of the cross of five rays that must all hit before an uncovered pixel is a pinhole, px: what a
    /// vertex may be off by, see [`VERTEX_PX`].
    ///
    /// Example: the rim of the DEM passes 0.01 px from a pixel's centre: one of the five rays misses, no pinhole.
    pub const RAY_PX: f64 = 1.0 / 64.0;

    /// Share of covered pixels whose facet may differ from the hardware's.
    ///
    /// Reason: two facets at one depth, which the two rasterizers interpolate with different roundings.
    /// Example: of 262 144 covered pixels, 131 may show the other facet.
    pub const HARDWARE_IDS: f64 = 0.0005;

    /// Relative difference of the two depths where the facet differs.
    ///
    /// Example: two facets that meet 10 km along the view axis: 2^-20 are 1 cm.
    pub const HARDWARE_DEPTH: f64 = 1.0 / (1 << 20) as f64;
}
