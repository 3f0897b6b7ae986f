//! Tiles of samples and vertices of chunks in their places: they stay while asked for, the oldest go first, and what stays
//! is what was brought.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use glam::DVec3;
use hachure::door::gpu::slot_cache::SlotCache;
use hachure::door::surface::lattice::CHUNK_VERTICES;
use hachure::door::surface::tile::TILE_SAMPLES;
use hachure::door::surface::{Chunk, Tile};
use hachure::plan::{Border, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::Camera;

use crate::common::gpu;
use crate::frames::{METHODS, Planned};
use crate::scenes::{Random, gpu_without_int64, look, rough};

const PAGE: [u32; 2] = [200, 150];

fn tile(number: u32) -> Tile {
    Tile::of(&Chunk { origin: [number * 2048, 0], step: 64, coarser: 0 })
}

#[test]
fn tiles_keep_their_places_and_the_oldest_go_first() {
    let capacity = 12;
    let mut pool = SlotCache::new(capacity);
    let mut random = Random::new(3);
    // Of each tile its place and when it was asked for last.
    let mut held: HashMap<u32, (u32, u32)> = HashMap::new();
    let mut replaced = 0;
    for frame in 1..500 {
        let wanted: Vec<u32> = (0..random.below(13)).map(|_| random.below(30)).collect();
        let different: HashSet<u32> = wanted.iter().copied().collect();
        let tiles: Vec<Tile> = wanted.iter().map(|number| tile(*number)).collect();
        let Some(placed) = pool.place(&tiles) else {
            panic!("{} of {capacity} tiles refused", different.len());
        };
        let brought: HashSet<u32> = different.iter().copied().filter(|n| !held.contains_key(n)).collect();
        let written: HashMap<u32, Tile> = placed.missing.iter().copied().collect();
        assert_eq!(placed.missing.len(), brought.len(), "each missing tile once");
        for (number, place) in wanted.iter().zip(&placed.places) {
            assert!((*place as usize) < capacity);
            match held.get(number) {
                Some((kept, _)) => assert_eq!(kept, place, "a tile moved"),
                None => assert_eq!(written.get(place), Some(&tile(*number)), "a tile is not brought to its place"),
            }
        }
        // What had to go: asked for before this frame, and no later than what stays without being asked for.
        let gone: Vec<u32> = held
            .iter()
            .filter(|(n, (p, _))| !different.contains(n) && written.contains_key(p))
            .map(|(n, _)| *n)
            .collect();
        let latest = gone.iter().map(|n| held[n].1).max().unwrap_or(0);
        held.retain(|n, _| !gone.contains(n));
        let idle = held.iter().filter(|(n, _)| !different.contains(n)).map(|(_, (_, asked))| *asked);
        assert!(idle.min().is_none_or(|oldest| latest <= oldest), "frame {frame}: a newer tile went");
        replaced += gone.len();
        held.extend(wanted.iter().zip(&placed.places).map(|(n, place)| (*n, (*place, frame))));
        let places: HashSet<u32> = held.values().map(|(place, _)| *place).collect();
        assert_eq!(places.len(), held.len(), "two tiles in one place");
    }
    assert!(replaced > 500, "{replaced} tiles replaced");
}

#[test]
fn more_tiles_than_places_are_refused() {
    let all: Vec<Tile> = (0..5).map(tile).collect();
    assert!(SlotCache::new(5).place(&all).is_some());
    assert_eq!(SlotCache::new(4).place(&all), None);
    // Nothing has changed then, and growing moves nothing.
    let mut pool = SlotCache::new(4);
    let before = pool.place(&all[..3]).expect("three of four");
    assert_eq!(pool.place(&all), None);
    let again = pool.place(&all[..3]).expect("three of four");
    assert!(again.places == before.places && again.missing.is_empty(), "{again:?} after {before:?}");
    pool.grow(5);
    let grown = pool.place(&all).expect("five of five");
    assert!(grown.places[..3] == before.places && grown.missing.len() == 2, "{grown:?} after {before:?}");
    assert!(
        SlotCache::new(4).place(&[all[0], all[1], all[0], all[1], all[2], all[3]]).is_some(),
        "four different ones"
    );
}

#[test]
fn a_camera_that_jumps_draws_what_a_new_renderer_draws() {
    let surface = Arc::new(Surface::new(rough(1100, 1000, 1.0, 0.5, false)));
    let plan = Plan::new(Detail::Adaptive { error_px: 0.15 }, Method::Walk, Border::On);
    let make = || Planned::new(gpu(), &surface, plan);
    let mut jumping = make();
    let [west, south, east, north] = surface.dem().extent();
    let mut random = Random::new(21);
    let (mut tiles, mut chunks, mut pages) = (HashSet::new(), HashSet::new(), HashSet::new());
    for frame in 0..7 {
        let eye = DVec3::new(random.between(west, east), random.between(south, north), random.between(100.0, 900.0));
        let azimuth = random.between(0.0, 360.0);
        let camera = Camera { eye, azimuth, altitude: -20.0, fov: 70.0, width: PAGE[0], height: PAGE[1] };
        let drawn = jumping.bytes(&camera);
        assert!(drawn == make().bytes(&camera), "frame {frame} differs");
        tiles.extend(jumping.lattice().chunks().iter().map(Tile::of));
        chunks.extend(jumping.lattice().chunks().iter().copied());
        pages.insert(drawn);
    }
    let room = |name, bytes| jumping.buffer(name).size() / bytes;
    let held = [room("heights", 4 * u64::from(TILE_SAMPLES)), room("places", 16 * u64::from(CHUNK_VERTICES))];
    let asked = [tiles.len() as u64, chunks.len() as u64];
    println!("{asked:?} tiles and chunks in {held:?} places");
    assert!(asked[0] > held[0] && asked[1] > held[1], "{asked:?} in {held:?} places: none was replaced");
    assert_eq!(pages.len(), 7, "frames are alike");
}

#[test]
fn vertices_stay_while_the_camera_flies_on() {
    let surface = Arc::new(Surface::new(rough(400, 300, 1.0, 0.5, true)));
    let [west, south, east, north] = surface.dem().extent();
    let middle = DVec3::new(west + east, south + north, 0.0) / 2.0;
    for (gpu, (_, method)) in METHODS.into_iter().flat_map(|method| [(gpu(), method), (gpu_without_int64(), method)]) {
        let plan = Plan::new(Detail::Adaptive { error_px: 0.3 }, method, Border::On);
        let make = || Planned::new(gpu, &surface, plan);
        let mut flying = make();
        let (mut made, mut chunks, mut pages) = (Vec::new(), Vec::new(), HashSet::new());
        for frame in 0..5 {
            let eye = middle + DVec3::new(-900.0 + 40.0 * f64::from(frame), -1100.0, 300.0);
            let camera = look(eye, middle, 60.0, PAGE);
            let drawn = flying.bytes(&camera);
            assert!(drawn == make().bytes(&camera), "{method:?}, frame {frame} differs");
            made.push(flying.on_device().scene.made().len());
            chunks.push(flying.lattice().chunks().len());
            pages.insert(drawn);
        }
        println!("{method:?}: vertices of {made:?} of {chunks:?} chunks are made");
        assert_eq!(made[0], chunks[0], "the first frame makes all");
        let [few, all] = [made, chunks].map(|counts| counts[2..].iter().sum::<usize>());
        assert!(few > 0 && few < all / 2, "{few} of {all} are made anew");
        assert_eq!(pages.len(), 5, "frames are alike");
    }
}
