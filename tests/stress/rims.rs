//! Rims of undersides, which no method has for lines: seen from below the rim of the land there are none.

use std::sync::Arc;

use hachure::door::stress::drawing::{Drawer, plan};
use hachure::door::stress::named;
use hachure::plan::Method;
use hachure::surface::Surface;

use crate::scenes::gpu;

#[test]
fn rims_behind_an_underside_are_not_inked() {
    let case = named("outside").expect("a case");
    let view = case.views.iter().find(|view| view.name == "below-the-rim").expect("a view");
    let mut drawer = Drawer::new(gpu(), &Arc::new(Surface::new(case.dem.clone()))).expect("a drawer");
    for method in [Method::Walk, Method::Contour, Method::TowardAway { wide: false }] {
        let drawing = drawer.draw(&plan(case.detail, method), &view.camera).expect("a drawing");
        assert_eq!(drawing.mask.inked.len(), 0, "{method:?}: truth has no line there");
    }
    // From beside the land the same rim is one.
    let beside = case.views.iter().find(|view| view.name == "beside").expect("a view");
    let drawing = drawer.draw(&plan(case.detail, Method::Walk), &beside.camera).expect("a drawing");
    assert!(drawing.mask.inked.len() > 200, "{} px", drawing.mask.inked.len());
}
