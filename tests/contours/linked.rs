//! Curves of the device hang together as the twin's do, and are the same on every run, on every kind of device, and however
//! many batches their chunks take.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::DVec3;
use hachure::door::gpu::uniforms::{Segment, code};
use hachure::door::plan::batches::BATCH_CHUNKS;
use hachure::door::surface::Chunk;
use hachure::line::Curve;
use hachure::plan::{Culling, Detail};
use hachure::surface::Surface;
use hachure::view::Camera;

use super::device::{Scene, each_frame, low, plan, scenes};
use super::twin::{Name, Node, Piece, Strung, Twin, string};
use crate::scenes::{Random, gpu, gpu_without_int64, level, rough};
use crate::tolerances::JOINT_PX;

/// Where two parts of pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Joint {
    /// Where two pieces do.
    Node(Node),
    /// Before a part of a piece.
    Before(Name, u32),
}

/// The parts that the device has found, by facet, and what they make up by the twin's nodes. Parts of pieces that the twin
/// has not are left out: how many.
fn strung(scene: &Scene, twin: &Twin) -> (Vec<Segment>, Vec<Strung<Joint>>, usize) {
    let pieces: HashMap<Name, Piece> = twin.pieces().into_iter().map(|piece| (piece.name(), piece)).collect();
    let mut parts: Vec<(Segment, [Joint; 2])> = Vec::new();
    let mut unknown = 0;
    for (name, found) in &scene.found {
        let Some(piece) = pieces.get(name) else {
            unknown += found.parts.len();
            continue;
        };
        for (number, part) in &found.parts {
            let joint = |flag: u32, end: usize| match part.code & flag != 0 {
                true => Joint::Node(piece.ends[end]),
                false => Joint::Before(*name, number + end as u32),
            };
            parts.push((*part, [joint(code::STARTS, 0), joint(code::ENDS, 1)]));
        }
    }
    parts.sort_by_key(|(part, _)| (part.facet, part.code));
    let (parts, joints): (Vec<Segment>, Vec<[Joint; 2]>) = parts.into_iter().unzip();
    let strung = string(&joints);
    (parts, strung, unknown)
}

/// Largest distance between the end of a part and the start of the next, px.
fn gap(scene: &Scene, parts: &[Segment], curves: &[Strung<Joint>]) -> f64 {
    let px = |a: [f32; 3], b: [f32; 3]| {
        let [a, b] = [a, b].map(|p| glam::Vec3::from(p).as_dvec3());
        a.distance(b) * scene.camera.focal() / a.length()
    };
    let of_curve = |curve: &Strung<Joint>| {
        let pairs = curve.pieces.windows(2).map(|pair| px(parts[pair[0]].end, parts[pair[1]].start));
        pairs.fold(0.0, f64::max)
    };
    curves.iter().map(of_curve).fold(0.0, f64::max)
}

/// How many stretches each curve has, and whether it is closed; sorted.
fn lengths(curves: impl Iterator<Item = (usize, bool)>) -> Vec<(usize, bool)> {
    let mut lengths: Vec<_> = curves.collect();
    lengths.sort_unstable();
    lengths
}

#[test]
fn curves_of_the_device_hang_together() {
    let mut met = [0; 3];
    each_frame(17, 2, |scene, twin, what| {
        // A branch makes it panic.
        let (parts, curves, unknown) = strung(scene, twin);
        let off = gap(scene, &parts, &curves);
        assert!(off <= JOINT_PX, "{what}: {off} px between two parts");
        let linked = lengths(scene.in_parts.iter().map(|curve: &Curve| (curve.stretches.len(), curve.closed)));
        let expected = lengths(curves.iter().map(|curve| (curve.pieces.len(), curve.closed)));
        let stretches = |lengths: &[(usize, bool)]| lengths.iter().map(|(n, _)| n).sum::<usize>();
        assert_eq!(stretches(&linked), stretches(&expected) + unknown, "{what}");
        // Where parts of the land touch in a vertex, and where pieces are doubtful, curves are cut.
        if unknown == 0 && scene.surface.dem().voids() == 0 {
            assert!(linked == expected, "{what}: {} curves linked, {} expected", linked.len(), expected.len());
        }
        met[0] += curves.len();
        met[1] += parts.len();
        met[2] += curves.iter().filter(|curve| curve.closed).count();
    });
    println!("{met:?} curves, parts, closed curves");
    assert!(met[0] > 100 && met[1] > 5000 && met[2] > 5, "{met:?}");
}

#[test]
fn curves_are_the_same_on_every_run_and_without_int64() {
    let mut random = Random::new(23);
    let mut found = 0;
    for (surface, detail, culling) in scenes() {
        let camera = low(&surface, &mut random);
        let draw = |gpu| Scene::draw(gpu, &surface, plan(detail, culling), &camera).curves;
        let first = draw(gpu());
        assert!(first == draw(gpu()), "another run, other curves: {camera:?}");
        assert!(first == draw(gpu_without_int64()), "other curves without 64-bit atomics: {camera:?}");
        found += first.iter().map(|curve| curve.stretches.len()).sum::<usize>();
    }
    assert!(found > 3000, "{found} stretches");
}

/// Over so many chunks vertices are overwritten, batch after batch.
#[test]
fn curves_of_several_batches_are_those_of_the_twin() {
    let surface = Arc::new(Surface::new(rough(34, 33, 2.0, 4.0, false)));
    // From the south, where the last chunks lie.
    let [west, south, east, _] = surface.dem().extent();
    let eye = DVec3::new((west + east) / 2.0, south - 200.0, 100.0);
    let camera = Camera { eye, azimuth: 0.0, altitude: -15.0, fov: 80.0, width: 256, height: 256 };
    let plan = plan(Detail::from(level(64)), Culling::On);
    let mut scene = Scene::draw(gpu(), &surface, plan, &camera);
    let chunks = scene.lattice.chunks();
    assert!(chunks.len() > BATCH_CHUNKS as usize, "{} chunks", chunks.len());
    // The twin of chunks with lines and of those that have a vertex in common with them.
    let mut with_lines: Vec<[u32; 2]> = scene.found.values().map(|found| chunks[found.slot as usize].origin).collect();
    with_lines.sort_unstable();
    with_lines.dedup();
    let near = |chunk: &&Chunk| {
        let beside = |at: u32, by: u32| (at + by * chunk.size()).checked_sub(chunk.size());
        let around = (0..9).filter_map(|k| Some([beside(chunk.origin[0], k % 3)?, beside(chunk.origin[1], k / 3)?]));
        around.into_iter().any(|at| with_lines.binary_search(&at).is_ok())
    };
    let near: Vec<Chunk> = chunks.iter().filter(near).copied().collect();
    let twin = Twin::of(&surface, &near, camera.eye);
    // Others lack neighbours in the twin.
    let slots: HashSet<u32> = scene.found.values().map(|found| found.slot).collect();
    let met = scene.compare_in(&twin, |slot| slots.contains(&slot)).expect("the pieces of the twin");
    println!("{} chunks with lines of {}: {met:?}", slots.len(), chunks.len());
    assert!(met.both > 2000, "{met:?}");
    let last = scene.found.values().filter(|found| found.slot >= BATCH_CHUNKS).count();
    assert!(last > 100, "{last} pieces of the last batch");
    scene.found.retain(|_, found| found.slot < BATCH_CHUNKS);
    assert!(scene.compare_in(&twin, |slot| slots.contains(&slot)).is_err(), "a batch left out is not noticed");
}
