//! Lines as data: where chains lie in the world, and what they draw.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use hachure::door::gpu::uniforms::near_plane;
use hachure::line::{Chain, Line, Lines, Marks};
use hachure::plan::{Border, Method};
use hachure::render::Drawn;
use hachure::surface::Surface;
use hachure::view::{Camera, Perspective};

use crate::closed_forms::GAUSSIAN;
use crate::forms::{about_middle, from_middle};
use crate::frames::draw;
use crate::scenes::{level, look};
use crate::tolerances::{CHAIN_OFF_SURFACE_PX, REPROJECTED_PX};

const PAGE: [u32; 2] = [384, 288];

/// A hill against the sky, and a frame of it.
fn hill() -> &'static (Camera, Drawn, f64) {
    static HILL: OnceLock<(Camera, Drawn, f64)> = OnceLock::new();
    HILL.get_or_init(|| {
        let surface = Arc::new(Surface::new(GAUSSIAN.dem(|_, _| true)));
        let eye = from_middle(DVec3::new(-1000.0, -550.0, 60.0));
        let camera = look(eye, from_middle(DVec3::new(0.0, 0.0, 150.0)), 60.0, PAGE);
        let frame = draw(&surface, &camera, level(4), Method::Walk, Border::On);
        (camera, frame, near_plane(surface.dem()))
    })
}

/// The chains of the hill, as if its near plane were so many times as far.
fn chains(times: f64) -> Vec<Chain> {
    let (camera, frame, near) = hill();
    Lines::of(&Marks::from(&frame.raster), &Perspective::new(camera, near * times), 0.6).chains
}

/// Largest distance from the place of a point to where its place in the world lies on the page, px.
fn reprojected(chains: &[Chain]) -> f64 {
    let off = |chain: &Chain| {
        let points = chain.points.iter();
        points.map(|point| hill().0.project(point.world).0.distance(point.place)).fold(0.0, f64::max)
    };
    chains.iter().map(off).fold(0.0, f64::max)
}

/// Largest distance of a point of silhouettes from the surface, square to it, px at its distance.
fn off_surface(chains: &[Chain]) -> f64 {
    let (camera, ..) = hill();
    let off = |world: DVec3| {
        let p = about_middle(world);
        let slope = (GAUSSIAN.gradient)(p.truncate()).length_squared();
        let metres = (p.z - (GAUSSIAN.height)(p.truncate())).abs() / (1.0 + slope).sqrt();
        metres * camera.focal() / camera.project(world).1
    };
    let silhouettes = chains.iter().filter(|chain| chain.line() != Line::Border);
    silhouettes.flat_map(|chain| &chain.points).map(|point| off(point.world)).fold(0.0, f64::max)
}

#[test]
fn traced_chains_lie_on_the_surface_where_the_page_shows_them() {
    let traced = chains(1.0);
    let points: usize = traced.iter().map(|chain| chain.points.len()).sum();
    let (page, surface) = (reprojected(&traced), off_surface(&traced));
    println!("{} chains of {points} points: {page:.1e} px off on the page, {surface:.2} px off the hill", traced.len());
    assert!(points > 60, "{points} points");
    assert!(page <= REPROJECTED_PX, "{page} px");
    assert!(surface <= CHAIN_OFF_SURFACE_PX, "{surface} px");
    // Negative controls: a near plane that is not the raster's (along the line of sight a silhouette stays near the hill for
    // a while), and points moved by a pixel.
    assert!(off_surface(&chains(1.25)) > CHAIN_OFF_SURFACE_PX, "another near plane is not noticed");
    let mut moved = traced;
    moved.iter_mut().flat_map(|chain| &mut chain.points).for_each(|point| point.place.x += 1.0);
    assert!(reprojected(&moved) > REPROJECTED_PX, "a moved place is not noticed");
}

#[test]
fn land_against_the_sky_is_skyline_and_its_rim_is_border() {
    let found = chains(1.0);
    let length = |line: Line| found.iter().filter(|c| c.line() == line).map(|c| c.points.len()).sum::<usize>();
    let [skyline, border] = [Line::Skyline, Line::Border].map(length);
    println!("{skyline} points of skyline, {border} of border, {} of occluding lines", length(Line::Occluding));
    assert!(skyline > 20 && border > 0, "{skyline} points of skyline, {border} of border");
}
