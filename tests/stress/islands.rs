//! Facets turn away in islands where the line of sight nearly touches a round ridge, and nothing hides behind them.

use hachure::door::stress::accuracy::Accuracy;
use hachure::door::stress::drawing::{Drawer, plan};
use hachure::door::stress::named;
use hachure::plan::Method;
use hachure::surface::Surface;
use hachure::truth::Terrain;
use std::sync::Arc;

use crate::scenes::{gpu, level};

#[test]
fn islands_of_away_facets_are_no_lines() {
    let case = named("tangent").expect("tangent");
    let surface = Arc::new(Surface::new(case.dem.clone()));
    let terrain = Terrain::new(&surface);
    let mut drawer = Drawer::new(gpu(), &surface).expect("a renderer");
    for view in &case.views {
        let truth = terrain.truth(&view.camera, level(16));
        let drawn = drawer.draw(&plan(case.detail, Method::Walk), &view.camera).expect("a drawing");
        let accuracy = Accuracy::of(&drawn.mask, &truth);
        // By facets alone F is .975 on the flank, and 23 pixels are astray.
        assert!(accuracy.f() > Some(0.995), "{}: {:?}", view.name, accuracy.f());
        assert!(accuracy.astray.len() <= 3, "{}: {:?}", view.name, accuracy.astray);
    }
}
