//! Border lines: the rim of the DEM and of its voids where it is seen, the same for every method.
//!
//! The truth is the rim as a polyline of the map lifted onto the form, drawn where its surface faces the eye and the
//! straight line to the eye stays above the form. Where four samples surround a void's corner, cells split along NW-SE
//! lose both patches at its north-west and south-east and keep one at its north-east and south-west: a hole is a
//! hexagon.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::line::Kind;
use hachure::plan::{Border, Method, Plan};
use hachure::surface::Surface;
use hachure::truth::{Inked, Mask, Truth, TruthPiece};
use hachure::view::Camera;

use crate::closed_forms::GAUSSIAN;
use crate::forms::{Form, about_middle, from_middle};
use crate::frames::{METHODS, Planned, count_ink, draw, draw_mask};
use crate::judged::{centres, moved, piece, score, truth};
use crate::scenes::{gpu, level, look};
use crate::tolerances::{HIDDEN_SHARE, REACH_PX, RECALL, TRUTH_PIECE_PX};

const PAGE: [u32; 2] = [384, 288];
/// Bit of a pixel's ink that a border line sets, also where a silhouette runs over it.
pub const BORDER: u32 = 2;

/// A plane that rises to the north-east.
const PLANE: Form = Form {
    name: "plane",
    height: |p| 0.12 * p.x + 0.2 * p.y,
    gradient: |_| DVec2::new(0.12, 0.2),
    residual: |_, _| 0.0,
    samples: 65,
    cell: 20.0,
};

/// Which samples exist, and the rims this makes: closed polylines in columns and rows.
struct Shape {
    name: &'static str,
    exists: fn(usize, usize) -> bool,
    rims: &'static [&'static [[f64; 2]]],
    /// Whether a place, in columns and rows, lies on the land.
    land: fn(DVec2) -> bool,
}

/// All samples of a 65 x 65 grid.
const WHOLE: Shape = Shape {
    name: "whole",
    exists: |_, _| true,
    rims: &[&[[0.0, 0.0], [64.0, 0.0], [64.0, 64.0], [0.0, 64.0]]],
    land: |p| p.x >= 0.0 && p.y >= 0.0 && p.x <= 64.0 && p.y <= 64.0,
};

/// Samples 11 to 49 east and 9 to 54 south, voids around them.
const ISLAND: Shape = Shape {
    name: "island",
    exists: |c, r| (11..=49).contains(&c) && (9..=54).contains(&r),
    rims: &[&[[11.0, 9.0], [49.0, 9.0], [49.0, 54.0], [11.0, 54.0]]],
    land: |p| p.x >= 11.0 && p.y >= 9.0 && p.x <= 49.0 && p.y <= 54.0,
};

/// Samples 25 to 37 east and 28 to 41 south are void.
const HOLE: Shape = Shape {
    name: "hole",
    exists: |c, r| !((25..=37).contains(&c) && (28..=41).contains(&r)),
    rims: &[WHOLE.rims[0], &[[24.0, 27.0], [37.0, 27.0], [38.0, 28.0], [38.0, 42.0], [25.0, 42.0], [24.0, 41.0]]],
    land: |p| {
        let corners = p.x - p.y < 10.0 && p.x - p.y > -17.0;
        let inside = p.x > 24.0 && p.x < 38.0 && p.y > 27.0 && p.y < 42.0 && corners;
        (WHOLE.land)(p) && !inside
    },
};

/// Which parts of a rim.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// What the eye sees.
    Seen,
    /// All of it, as if nothing hid anything.
    Whole,
}

/// The rim on the page.
fn rim(form: &Form, shape: &Shape, camera: &Camera, part: Part) -> Truth {
    let eye = about_middle(camera.eye);
    let place = |g: DVec2| DVec2::new(g.x, -g.y) * form.cell + DVec2::new(-form.half(), form.half());
    let grid = |p: DVec2| (p - DVec2::new(-form.half(), form.half())) * DVec2::new(1.0, -1.0) / form.cell;
    let mut seen: Vec<TruthPiece> = Vec::new();
    for corners in shape.rims {
        for (i, &a) in corners.iter().enumerate() {
            let (a, b) = (DVec2::from(a), DVec2::from(corners[(i + 1) % corners.len()]));
            let page = DVec2::new(f64::from(PAGE[0]), f64::from(PAGE[1])) / 2.0;
            let on_page = |(p, w): (DVec2, f64)| w > 0.0 && (p - page).abs().cmple(page + 5.0).all();
            // Pieces on the page: place on the map of the middle, ends on the page.
            let pieces = |steps: u32| {
                let at = move |k: u32| place(a.lerp(b, f64::from(k) / f64::from(steps)));
                let ends = move |k: u32| [at(k), at(k + 1)].map(|p| camera.project(from_middle(form.point(p))));
                let all = (0..steps).map(move |k| (at(k).midpoint(at(k + 1)), ends(k)));
                let seen = all.filter(|(_, ends)| ends.iter().all(|end| on_page(*end)));
                seen.map(|(middle, ends)| (middle, ends.map(|(p, _)| p))).collect::<Vec<_>>()
            };
            let short = |p: &Vec<(DVec2, [DVec2; 2])>| p.iter().all(|(_, [a, b])| a.distance(*b) <= TRUTH_PIECE_PX);
            let found = (8..14).map(|k| pieces(1 << k)).find(short).expect("short pieces");
            for (middle, ends) in found {
                let lit = form.facing(middle, eye) > 0.0;
                if part == Part::Whole || lit && form.sees(eye, form.point(middle), &|p| (shape.land)(grid(p))) {
                    seen.push(piece(ends, 0.0));
                }
            }
        }
    }
    truth(PAGE, seen)
}

/// Which pixels a border line touches.
fn border_bits(renderer: &mut Planned, camera: &Camera) -> Vec<bool> {
    renderer.frame(camera).expect("a frame");
    let words: Vec<u32> = renderer.values("ink", camera.width as usize * camera.height as usize);
    words.into_iter().map(|word| word & BORDER != 0).collect()
}

/// The mask of pixels of [`PAGE`]; no depth is asked of it.
fn mask_of(bits: &[bool]) -> Mask {
    let inked = (0..).zip(bits).filter(|(_, bit)| **bit);
    let inked = inked.map(|(i, _): (u32, _)| Inked { column: i % PAGE[0], row: i / PAGE[0], distance: 0.0 });
    Mask { size: PAGE, inked: inked.collect() }
}

/// A gentle Gaussian hill on the same grid.
const HILL: Form = Form { name: "hill", samples: 65, cell: 20.0, ..GAUSSIAN };

/// Eyes about the middle: above a corner, outside the DEM, inside it and low.
const EYES: [DVec3; 3] =
    [DVec3::new(-900.0, -1100.0, 700.0), DVec3::new(300.0, -1700.0, 260.0), DVec3::new(-250.0, -420.0, 300.0)];

#[test]
fn the_rim_is_drawn_where_it_is_seen_by_every_method() {
    for (form, shape) in [(&PLANE, &WHOLE), (&PLANE, &ISLAND), (&PLANE, &HOLE), (&HILL, &ISLAND), (&HILL, &HOLE)] {
        let surface = Arc::new(Surface::new(form.dem(shape.exists)));
        let camera = |eye| look(from_middle(eye), from_middle(DVec3::new(0.0, 0.0, 20.0)), 60.0, PAGE);
        let make = |method| Planned::new(gpu(), &surface, Plan::new(level(4), method, Border::On));
        let mut renderers = METHODS.map(|(_, method)| make(method));
        for eye in EYES {
            let camera = camera(eye);
            let truth = rim(form, shape, &camera, Part::Seen);
            let whole = rim(form, shape, &camera, Part::Whole);
            let mut first: Option<Vec<bool>> = None;
            for ((name, _), renderer) in METHODS.iter().zip(&mut renderers) {
                let bits = border_bits(renderer, &camera);
                let ink = mask_of(&bits);
                let s = score(&ink, &truth);
                let off = score(&ink, &whole).farthest;
                if first.is_none() {
                    println!(
                        "{} {}: P {:.4} R {:.4}, {} px of ink, {:.0} px of rim, farthest {:.2} px",
                        form.name, shape.name, s.precision, s.recall, s.ink, s.length, s.farthest
                    );
                }
                let what = format!("{} {} {name} from {eye}", form.name, shape.name);
                assert!(off <= REACH_PX, "{what}: ink {off:.2} px off the rim");
                // Where a hill hides the rim its line may run on a little behind it.
                let hides = form.name == HILL.name;
                let least = if hides { 1.0 - HIDDEN_SHARE } else { 1.0 };
                assert!(s.precision >= least, "{what}: precision {:.4}", s.precision);
                assert!(s.recall >= RECALL, "{what}: recall {:.4}", s.recall);
                let same = first.get_or_insert_with(|| bits.clone());
                let differ = same.iter().zip(&bits).filter(|(a, b)| a != b).count();
                assert_eq!(differ, 0, "{what}: pixels unlike the walk's");
                // Negative control: one pixel flipped is noticed.
                let mut flipped = bits.clone();
                flipped[1000] ^= true;
                assert_ne!(*same, flipped);
            }
        }
    }
}

#[test]
fn a_tilted_plane_draws_only_its_border() {
    // The same plane in facets many pixels wide, as adjacency by corners needs. Adjacency by edges marks every vertex
    // even there, since facets across a vertex share no edge.
    let coarse = Form { samples: 9, cell: 160.0, ..PLANE };
    for (form, methods) in [(&PLANE, &METHODS[..3]), (&coarse, &METHODS[4..])] {
        let surface = Arc::new(Surface::new(form.dem(|_, _| true)));
        for eye in EYES {
            let camera = look(from_middle(eye), from_middle(DVec3::ZERO), 60.0, PAGE);
            let truth = rim(&PLANE, &WHOLE, &camera, Part::Seen);
            for &(name, method) in methods {
                let raster = draw(&surface, &camera, level(1), method, Border::On).raster;
                assert_eq!(centres(&raster, Kind::Silhouette).len(), 0, "{name} finds a silhouette on a plane");
                let s = score(&draw_mask(&surface, &camera, level(1), method, Border::On), &truth);
                assert!(s.precision == 1.0 && s.recall >= RECALL, "{name}: P {} R {}", s.precision, s.recall);
                let bare = draw(&surface, &camera, level(1), method, Border::Off).raster;
                assert_eq!(count_ink(&bare), 0, "{name}: ink without border lines");
            }
        }
    }
}

#[test]
fn another_rim_is_noticed() {
    let surface = Arc::new(Surface::new(PLANE.dem(HOLE.exists)));
    let camera = look(from_middle(EYES[0]), from_middle(DVec3::ZERO), 60.0, PAGE);
    let mut renderer = Planned::new(gpu(), &surface, Plan::new(level(4), Method::Walk, Border::On));
    let ink = mask_of(&border_bits(&mut renderer, &camera));
    let without_hole = score(&ink, &rim(&PLANE, &WHOLE, &camera, Part::Seen));
    assert!(without_hole.precision < 0.9 && without_hole.recall >= RECALL);
    let island = score(&ink, &rim(&PLANE, &ISLAND, &camera, Part::Seen));
    assert!(island.recall < 0.9);
    let moved = score(&moved(&ink, [2, 3]), &rim(&PLANE, &HOLE, &camera, Part::Seen));
    assert!(moved.precision < 0.9 && moved.recall < 0.9);
}
