//! What passes cost: beside what they bind; some bytes counted by hand, where lists or neighbours decide; and that more work
//! never costs less.

mod bindings;

use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::measure::cost::{PassCost, Quantities};
use hachure::door::plan::batches::BATCH_CHUNKS;
use hachure::door::plan::frame::KeptLattice;
use hachure::door::plan::passes::passes;
use hachure::door::plan::{Frame, batches};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::scenes::{level, look};

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

/// A frame of [`flat`] by walks at level `n`, with 64-bit atomics or in two rounds.
fn frame(n: u32, int64: bool) -> Frame {
    let surface = flat();
    let plan = Plan::new(level(n), Method::Walk, Border::On);
    Frame::new(&plan, &surface, &from_south(&surface), int64, &mut KeptLattice::default()).expect("a frame")
}

/// The same with more chunks than one batch holds.
fn in_two_batches(mut frame: Frame) -> Frame {
    frame.batches = batches(2 * BATCH_CHUNKS);
    frame
}

fn quantities(n: u32) -> Quantities {
    let frame = frame(n, true);
    let slots: Vec<u32> = (0..frame.lattice.chunks().len() as u32).collect();
    Quantities::of(&frame, &flat(), &slots).expect("quantities")
}

/// Of level 2, with a page.
fn on_page() -> Quantities {
    Quantities { pixels: 1000, land: 600, queued: 3, listed: [50, 20, 7], rim: 64, ..quantities(2) }
}

fn bytes(costs: &[PassCost], name: &str) -> u64 {
    costs.iter().find(|cost| cost.name == name).unwrap_or_else(|| panic!("no {name}")).bytes()
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
    let page = on_page();
    let walk = page.passes(&frame(2, true));
    for (name, expected) in [
        // 17 x 17 samples of a height and two gradients; four slots, chunks of 40 bytes and times 289 vertices of 16 bytes.
        ("tessellate", 289 * 12 + 4 * (4 + 40 + 289 * 16)),
        ("rasterize_large", 3 * (4 + 48)),
        ("pairs", 50 * 24 + 20 * 4),
        // An item, two pixels on three vertices each, a word of ink both ways; items left to the next pass.
        ("walk", 20 * (4 + 2 * (8 + 48) + 8) + 7 * 4),
        ("walk_rest", 7 * (4 + 2 * (8 + 48) + 8)),
        ("border", 64 * (16 + 2 * 36)),
    ] {
        assert_eq!(bytes(&walk, name), expected, "{name}");
    }
    assert!(!walk.iter().any(|cost| cost.name == "seam"), "all chunks have one level");
    let mut with_seams = frame(2, true);
    with_seams.passes = passes(&Plan::new(Detail::default(), Method::Walk, Border::On));
    let seams = Quantities { shared: 8, ..page }.passes(&with_seams);
    assert_eq!(bytes(&seams, "seam"), 4 * (4 + 40) + 8 * 32, "a vertex is read, one written");
    let rounds = page.passes(&frame(2, false));
    assert_eq!(bytes(&rounds, "tessellate"), bytes(&walk, "tessellate"), "one batch keeps its vertices");
    let batches = page.passes(&in_two_batches(frame(2, false)));
    assert_eq!(bytes(&batches, "tessellate"), 2 * bytes(&walk, "tessellate"));
    // Two points on patches of three samples, each a height and two gradients, take the place of six vertices.
    assert_eq!(bytes(&batches, "walk"), 20 * (4 + 2 * (8 + 36) + 8) + 7 * 4);
    assert_eq!(bytes(&batches, "walk_rest"), 7 * (4 + 2 * (8 + 36) + 8));
    let none_made = Quantities { made: 0, ..page }.passes(&frame(2, true));
    assert!(!none_made.iter().any(|cost| cost.name == "tessellate"), "vertices stay");
}

/// Adds to one quantity.
type Grow = fn(&mut Quantities);

#[test]
fn more_work_never_costs_less() {
    let (base, frame) = (on_page(), frame(2, true));
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
        let costs = q.passes(&frame);
        costs.iter().map(|cost| [cost.bytes(), cost.operations]).collect::<Vec<_>>()
    };
    for (what, grow) in grows {
        let mut more = base;
        grow(&mut more);
        let pairs: Vec<_> = of(&base).into_iter().zip(of(&more)).collect();
        assert!(pairs.iter().all(|(a, b)| a[0] <= b[0] && a[1] <= b[1]), "{what}: {pairs:?}");
        assert!(pairs.iter().any(|(a, b)| a != b), "{what} costs nothing");
    }
}
