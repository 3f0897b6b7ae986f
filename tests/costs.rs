//! What passes cost: bytes of small frames counted by hand, and that more work never costs less.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::plan::cost::{PassCost, Quantities};
use hachure::plan::{Border, Detail, Method, Plan, Share, Visibility};
use hachure::surface::{Lattice, Surface};
use hachure::view::Camera;

use crate::frames::{METHODS, Planned};
use crate::scenes::{gpu, gpu_without_int64, level, look, rough};

/// 17 x 17 samples, flat: one chunk at level 1, four at level 2.
fn flat() -> Surface {
    Surface::new(Dem::from_heights(17, DVec2::splat(10.0), DVec2::ZERO, vec![0.0; 17 * 17]))
}

/// From the south, all of [`flat`] in view.
fn from_south(surface: &Surface) -> Camera {
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new((west + east) / 2.0, (south + north) / 2.0, 0.0);
    look(middle + DVec3::new(0.0, -500.0, 200.0), middle, 60.0, [64, 48])
}

fn quantities(n: u32) -> Quantities {
    let surface = flat();
    let lattice = Lattice::uniform(surface.dem(), level(n)).expect("a lattice");
    let plan = Plan::new(level(n), Method::Walk, Border::On);
    let slots: Vec<u32> = (0..lattice.chunks().len() as u32).collect();
    Quantities::of(&plan, &surface, &lattice, lattice.seen(), &slots, &from_south(&surface)).expect("quantities")
}

fn bytes(costs: &[PassCost], name: &str) -> u64 {
    costs.iter().find(|cost| cost.name == name).unwrap_or_else(|| panic!("no {name}")).bytes
}

#[test]
fn chunks_patches_and_samples_are_counted() {
    let none = Quantities::default();
    // All facets are planar between samples: no patches, no gradients.
    let one = Quantities { chunks: 1, across: 1, made: 1, drawn: 1, samples: [289, 0], ..none };
    assert_eq!(quantities(1), one);
    // Four chunks over the same samples, each over 8 x 8 cells of two patches.
    let samples = [289, 289];
    let two = Quantities { chunks: 4, across: 4, made: 4, drawn: 4, fine: 4, patches: 4 * 128, samples, ..none };
    assert_eq!(quantities(2), two);
    // 32 x 32 chunks of a quarter of a cell each.
    let sixty_four = quantities(64);
    assert_eq!([sixty_four.chunks, sixty_four.patches, sixty_four.samples[1]], [64 * 64, 64 * 64 * 2, 289]);
}

#[test]
fn bytes_are_those_counted_by_hand() {
    let page =
        Quantities { pixels: 1000, land: 600, batches: 1, queued: 3, listed: [50, 20, 7], rim: 64, ..quantities(2) };
    let walk = page.passes(Method::Walk, Visibility::Key64);
    for (name, expected) in [
        // Pixels and ink are cleared, and four summaries.
        ("clear", 1000 * 12 + 4 * 4),
        // 17 x 17 samples of a height and two gradients; four slots, chunks of 40 bytes and times 289 vertices of 16 bytes.
        ("tessellate", 289 * 12 + 4 * (4 + 40 + 289 * 16)),
        // Of each chunk itself, its vertices, 512 bits, a summary.
        ("facing", 4 * (40 + 289 * 16 + 64 + 4)),
        // Each vertex is read and written.
        ("project", 4 * (40 + 289 * 32)),
        // Of each chunk itself and its vertices; pixels of land both ways; three queued facets.
        ("rasterize", 4 * (40 + 289 * 16) + 600 * 16 + 3 * 4),
        ("rasterize_large", 3 * (4 + 48)),
        // Every pixel, four summaries, the list.
        ("candidates", 1000 * 8 + 4 * 4 + 50 * 4),
        ("pairs", 50 * 24 + 20 * 4),
        // An item, two pixels on three vertices each, a word of ink both ways; items left to the next pass.
        ("walk", 20 * (4 + 2 * (8 + 48) + 8) + 7 * 4),
        ("walk_rest", 7 * (4 + 2 * (8 + 48) + 8)),
        ("border", 64 * (16 + 2 * 36)),
    ] {
        assert_eq!(bytes(&walk, name), expected, "{name}");
    }
    assert!(!walk.iter().any(|cost| cost.name == "seam"), "all chunks have one level");
    let seams = Quantities { shared: 8, seams: true, ..page }.passes(Method::Walk, Visibility::Key64);
    assert_eq!(bytes(&seams, "seam"), 4 * (4 + 40) + 8 * 32, "a vertex is read, one written");
    // Two rounds: the depth both ways, then it is read and the ID goes both ways.
    let rounds = page.passes(Method::Walk, Visibility::Key32);
    assert_eq!(bytes(&rounds, "rasterize"), 2 * 4 * (40 + 289 * 16) + 600 * 20 + 3 * 4);
    assert_eq!(bytes(&rounds, "tessellate"), bytes(&walk, "tessellate"), "one batch keeps its vertices");
    let batches = Quantities { batches: 2, ..page }.passes(Method::Walk, Visibility::Key32);
    assert_eq!(bytes(&batches, "tessellate"), 2 * bytes(&walk, "tessellate"));
    let plain = page.passes(Method::TowardAway { wide: false }, Visibility::TwoDepths);
    assert_eq!(bytes(&plain, "rasterize"), 4 * (40 + 289 * 16 + 64) + 600 * 8 + 3 * 4);
    assert_eq!(bytes(&plain, "toward_away"), 1000 * 12);
    let none_made = Quantities { made: 0, ..page }.passes(Method::Walk, Visibility::Key64);
    assert!(!none_made.iter().any(|cost| cost.name == "tessellate"), "vertices stay");
    let wide = page.passes(Method::TowardAway { wide: true }, Visibility::TwoDepths);
    assert_eq!(bytes(&wide, "toward_away"), 1000 * 16);
    assert_eq!(bytes(&wide, "clear"), 1000 * 16 + 4 * 4);
    let adjacency = page.passes(Method::Adjacency { share: Share::Edge }, Visibility::Key64);
    assert_eq!(bytes(&adjacency, "adjacency"), 1000 * 12 + 4 * (40 + 64));
}

/// Adds to one quantity.
type Grow = fn(&mut Quantities);

#[test]
fn more_work_never_costs_less() {
    let base =
        Quantities { pixels: 1000, land: 600, batches: 1, queued: 3, listed: [50, 20, 7], rim: 64, ..quantities(2) };
    let grows: [(&str, Grow); 15] = [
        ("pixels", |q| q.pixels += 9),
        ("land", |q| q.land += 9),
        ("chunks", |q| q.chunks += 9),
        ("across", |q| q.across += 9),
        ("made", |q| q.made += 9),
        ("fine", |q| q.fine += 9),
        ("patches", |q| q.patches += 9),
        ("drawn", |q| q.drawn += 9),
        ("heights", |q| q.samples[0] += 9),
        ("gradients", |q| q.samples[1] += 9),
        ("queued", |q| q.queued += 9),
        ("candidates", |q| q.listed[0] += 9),
        ("pairs", |q| q.listed[1] += 9),
        ("rest", |q| q.listed[2] += 9),
        ("rim", |q| q.rim += 9),
    ];
    let of = |q: &Quantities| {
        let costs = q.passes(Method::Walk, Visibility::Key64);
        costs.iter().map(|cost| [cost.bytes, cost.operations]).collect::<Vec<_>>()
    };
    for (what, grow) in grows {
        let mut more = base;
        grow(&mut more);
        let pairs: Vec<_> = of(&base).into_iter().zip(of(&more)).collect();
        assert!(pairs.iter().all(|(a, b)| a[0] <= b[0] && a[1] <= b[1]), "{what}: {pairs:?}");
        assert!(pairs.iter().any(|(a, b)| a != b), "{what} costs nothing");
    }
}

#[test]
fn every_pass_that_is_timed_has_a_cost() {
    let surface = Arc::new(Surface::new(rough(70, 60, 1.0, 6.0, true)));
    let camera = from_south(&surface);
    let details: [Detail; 2] = [level(4).into(), Detail::default()];
    for (name, method) in METHODS {
        for gpu in [gpu(), gpu_without_int64()] {
            for detail in details {
                let plan = Plan::new(detail, method, Border::On);
                let mut renderer = Planned::new(gpu, &surface, plan);
                let timed = renderer.timed_frame(&camera).expect("a timed frame");
                let frame = renderer.read().expect("its ink");
                let costs = renderer.costs(&frame).expect("costs");
                let names: Vec<_> = costs.iter().map(|cost| cost.name).collect();
                assert_eq!(names, timed.passes.iter().map(|pass| pass.name).collect::<Vec<_>>(), "{name}, {detail:?}");
                for cost in &costs {
                    let idle = ["rasterize_large", "walk_rest"].contains(&cost.name);
                    assert!(cost.bytes > 0 || idle, "{name}, {detail:?}: {cost:?}");
                }
                if method == Method::Walk {
                    let inked = frame.inked() as u64;
                    assert!(
                        bytes(&costs, "pairs") > 4 * inked / 8 && inked > 0,
                        "{detail:?}: lists were not read back"
                    );
                }
            }
        }
    }
}
