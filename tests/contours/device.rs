//! Contours of the device against the twin: the same pieces on the same facets, but where g is as small as rounding, at the
//! same places; what is missing lies beside the page, behind nearer surface or behind itself.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use hachure::door::gpu::uniforms::{Segment, Tally, code, seen};
use hachure::door::line::link;
use hachure::door::surface::lattice::CHUNK_FACETS;
use hachure::door::surface::{Lattice, LatticePoint};
use hachure::gpu::Gpu;
use hachure::line::{Bound, Curve};
use hachure::plan::{Border, Culling, Curves, Detail, Method, Plan};
use hachure::surface::Surface;
use hachure::view::{Camera, Perspective};

use super::twin::{Corners, Name, Piece, Twin};
use crate::frames::Planned;
use crate::quadtrees::moor;
use crate::scenes::{Random, gpu, level, rough};
use crate::tolerances::{CROSSING_PX, TURNING_SHARE, TURNING_SINE};

/// What is drawn: with curves, whatever the mask.
pub fn plan(detail: impl Into<Detail>, culling: Culling) -> Plan {
    Plan { curves: Curves::On, culling, ..Plan::new(detail, Method::Walk, Border::On) }
}

/// A piece as the device has found it, in parts of about a pixel.
#[derive(Debug, Clone)]
pub struct Found {
    /// Slot of its chunk.
    pub slot: u32,
    /// Its parts by their number.
    pub parts: BTreeMap<u32, Segment>,
}

impl Found {
    /// Metres from the eye to where the piece starts and ends, where these parts were found.
    fn ends(&self) -> [Option<DVec3>; 2] {
        let place = |at: [f32; 3]| Vec3::from(at).as_dvec3();
        let start = self.parts.values().find(|part| part.code & code::STARTS != 0).map(|part| place(part.start));
        let end = self.parts.values().find(|part| part.code & code::ENDS != 0).map(|part| place(part.end));
        [start, end]
    }
}

/// What a piece of the device is called.
pub fn name(segment: &Segment, lattice: &Lattice) -> Name {
    let corners = lattice.facet(segment.facet);
    let first = (segment.code & code::CORNER) as usize;
    let side = [0, 1].map(|k| corners[(first + k) % 3]);
    if segment.code & code::OF_RIM != 0 { Name::Along(side) } else { Name::Across(corners) }
}

/// The list as the device left it.
pub fn segments(renderer: &Planned) -> Vec<Segment> {
    let gpu = renderer.gpu();
    let tally: Vec<Tally> = gpu.read(&renderer.buffer("tally"), 1).expect("a tally");
    gpu.read(&renderer.buffer("segments"), tally[0].segments as usize).expect("a list")
}

/// Pieces by their names.
///
/// # Panics
/// Where one part is there twice.
pub fn pieces(segments: &[Segment], lattice: &Lattice) -> HashMap<Name, Found> {
    let mut found: HashMap<Name, Found> = HashMap::new();
    for segment in segments {
        let slot = segment.facet / CHUNK_FACETS;
        let piece = found.entry(name(segment, lattice));
        let parts = &mut piece.or_insert(Found { slot, parts: BTreeMap::new() }).parts;
        let other = parts.insert(segment.code >> code::PART_SHIFT, *segment);
        assert!(other.is_none(), "two parts have one number: {segment:?}");
    }
    found
}

/// What a comparison met.
#[derive(Debug, Default, Clone, Copy)]
pub struct Met {
    /// Pieces of both.
    pub both: usize,
    /// Of these, pieces of the rim.
    pub rim: usize,
    /// Pieces of the twin that need not be found: beside the page or hidden.
    pub left_out: usize,
    /// Pieces of one alone, on facets with a vertex that is seen edge-on.
    pub doubtful: usize,
    /// Largest distance between ends of pieces of both, px.
    pub px: f64,
}

impl Met {
    pub fn with(self, other: Self) -> Self {
        Self {
            both: self.both + other.both,
            rim: self.rim + other.rim,
            left_out: self.left_out + other.left_out,
            doubtful: self.doubtful + other.doubtful,
            px: self.px.max(other.px),
        }
    }
}

/// A frame with the device's pieces.
pub struct Scene {
    pub surface: Arc<Surface>,
    pub camera: Camera,
    pub lattice: Arc<Lattice>,
    pub found: HashMap<Name, Found>,
    /// As the renderer links them.
    pub curves: Vec<Curve>,
    /// The same where every part is looked at, and so is a stretch of its own.
    pub in_parts: Vec<Curve>,
    /// Of each pixel, depth of what it shows.
    depths: Vec<f32>,
    near: f64,
}

impl Scene {
    /// One frame.
    pub fn draw(gpu: &Arc<Gpu>, surface: &Arc<Surface>, plan: Plan, camera: &Camera) -> Self {
        let mut renderer = Planned::new(gpu, surface, plan);
        renderer.draw(camera).expect("a frame");
        let curves = renderer.curves().expect("curves");
        let lattice = renderer.lattice();
        let segments = segments(&renderer);
        let asked = segments.iter().map(|segment| Segment { sight: seen::FREE, ..*segment }).collect();
        let near = renderer.near();
        let pixels: Vec<[u32; 2]> = renderer.values("pixels", (camera.width * camera.height) as usize);
        Self {
            surface: surface.clone(),
            camera: *camera,
            found: pieces(&segments, &lattice),
            depths: pixels.iter().map(|pixel| f32::from_bits(pixel[1])).collect(),
            near,
            in_parts: link(asked, &lattice, &Perspective::new(camera, near)),
            curves,
            lattice,
        }
    }

    /// Compares with a twin; what is wrong, or what was met.
    pub fn compare(&self, twin: &Twin) -> Result<Met, String> {
        self.compare_in(twin, |_| true)
    }

    /// The same in these slots.
    pub fn compare_in(&self, twin: &Twin, counts: impl Fn(u32) -> bool) -> Result<Met, String> {
        let mut met = Met::default();
        let slots = self.slots();
        let slot_of = |facet: Corners| slot_of(&slots, facet).expect("a facet of a chunk");
        let mut twins: HashSet<Name> = HashSet::new();
        for piece in twin.pieces() {
            let slot = slot_of(piece.facet);
            if !counts(slot) {
                continue;
            }
            twins.insert(piece.name());
            match self.found.get(&piece.name()) {
                Some(found) => {
                    met.both += 1;
                    met.rim += usize::from(piece.bound() == Bound::Rim);
                    met.px = met.px.max(self.off(twin, &piece, found));
                }
                None if !self.must_show(twin, &piece, slot) => met.left_out += 1,
                None if edge_on(twin, &piece.facet) => met.doubtful += 1,
                None => return Err(self.told(twin, &piece, slot)),
            }
        }
        for name in self.found.keys().filter(|name| !twins.contains(name) && counts(self.found[name].slot)) {
            let doubtful = match name {
                Name::Across(facet) => edge_on(twin, facet),
                Name::Along(side) => edge_on(twin, side),
            };
            if !doubtful {
                return Err(format!("{:?} is no piece of the twin", self.found[name]));
            }
            met.doubtful += 1;
        }
        Ok(met)
    }

    /// Slots by the squares of their chunks.
    fn slots(&self) -> BTreeMap<(u32, [u32; 2]), u32> {
        let chunks = self.lattice.chunks().iter();
        (0..).zip(chunks).map(|(slot, chunk)| ((chunk.size(), chunk.origin), slot)).collect()
    }

    /// How far the ends of a piece lie from those of the twin on the page, px.
    fn off(&self, twin: &Twin, piece: &Piece, found: &Found) -> f64 {
        let ends = found.ends();
        let offs = [0, 1].map(|k| {
            let Some(place) = ends[k] else { return 0.0 };
            let there = twin.place(piece.ends[k]) - self.camera.eye;
            place.distance(there) * self.camera.focal() / there.length()
        });
        offs[0].max(offs[1])
    }

    /// Whether some part of a piece is on the page, not clearly concave, and not behind all pixels about its middle.
    fn must_show(&self, twin: &Twin, piece: &Piece, slot: u32) -> bool {
        let [a, b] = piece.ends.map(|node| twin.place(node) - self.camera.eye);
        let [p, q, r] = piece.facet.map(|at| twin.vertex(at).p);
        let left = (q - p).cross(r - p).cross(b - a);
        let concave = piece.side.is_none() && left.dot(a) > 0.45 * left.length() * a.length();
        let [(from, near), (to, far)] = [a, b].map(|p| self.camera.project(self.camera.eye + p));
        let size = DVec2::new(f64::from(self.camera.width), f64::from(self.camera.height));
        let inside = [from, to].iter().all(|at| at.cmpge(DVec2::ZERO).all() && at.cmple(size).all());
        if slot >= self.lattice.seen() || concave || near.min(far) < self.near || !inside {
            return false;
        }
        let parts = from.distance(to).ceil().max(1.0);
        // Rounding may decide in which pixel a middle lies.
        let clear = |at: DVec2| (at - at.round()).abs().min_element() > 0.02;
        let shows = |k: u32| {
            let share = (f64::from(k) + 0.5) / parts;
            let (at, depth) = (from.lerp(to, share), self.near * (1.0 / near + (1.0 / far - 1.0 / near) * share));
            clear(at) && self.farthest_about(at) <= 1.01 * depth
        };
        (from.distance(to) - parts).abs() > 0.001 && (0..parts as u32).any(shows)
    }

    /// What is known of a piece that was not found.
    fn told(&self, twin: &Twin, piece: &Piece, slot: u32) -> String {
        let ends = piece.ends.map(|node| self.camera.project(twin.place(node)));
        let chunk = self.lattice.chunks()[slot as usize];
        let others = self.found.values().filter(|found| found.slot == slot).count();
        let sines = piece.facet.map(|at| twin.vertex(at).sine());
        format!(
            "{piece:?} was not found: on the page {ends:?}, depth {:?} of {:?}, sines {sines:?}, {chunk:?} in slot {slot} of \
             {} with {others} others",
            self.near / ends[0].1,
            self.farthest_about(ends[0].0),
            self.lattice.chunks().len(),
        )
    }

    /// Least depth of the 3 x 3 pixels about a place.
    fn farthest_about(&self, place: DVec2) -> f64 {
        let [column, row] = place.floor().as_uvec2().to_array();
        let size = [self.camera.width, self.camera.height];
        let near = (0..9).map(|k| [column + k % 3, row + k / 3]).filter(|at| at.iter().all(|v| *v > 0));
        let near = near.map(|at| at.map(|v| v - 1)).filter(|at| at[0] < size[0] && at[1] < size[1]);
        near.map(|[x, y]| f64::from(self.depths[(y * size[0] + x) as usize])).fold(f64::INFINITY, f64::min)
    }
}

/// The slot of the chunk in which the middle of a facet lies.
fn slot_of(slots: &BTreeMap<(u32, [u32; 2]), u32>, facet: Corners) -> Option<u32> {
    let middle = [facet.map(|at| at.x), facet.map(|at| at.y)].map(|of| of.iter().sum::<u32>() / 3);
    let sizes = (0..u32::BITS).map(|shift| 1 << shift);
    sizes.into_iter().find_map(|size| slots.get(&(size, middle.map(|at| at & !(size - 1)))).copied())
}

/// Whether g at one of these vertices is as small as rounding.
fn edge_on(twin: &Twin, corners: &[LatticePoint]) -> bool {
    corners.iter().any(|at| twin.vertex(*at).sine().abs() <= TURNING_SINE)
}

/// What is drawn in these tests: land, how fine its facets are, what may be left out.
pub fn scenes() -> Vec<(Arc<Surface>, Detail, Culling)> {
    let scenes = [
        (rough(60, 50, 2.0, 4.0, false), Detail::from(level(4)), Culling::On),
        (rough(60, 50, 2.0, 4.0, true), Detail::from(level(2)), Culling::On),
        (rough(60, 50, 2.0, 4.0, true), Detail::from(level(1)), Culling::Off),
        (rough(90, 75, 1.0, 0.5, false), Detail::Adaptive { error_px: 4.0 }, Culling::Off),
        (rough(90, 75, 1.0, 0.5, true), Detail::Adaptive { error_px: 0.5 }, Culling::On),
        (moor(), Detail::Adaptive { error_px: 1.0 }, Culling::On),
    ];
    scenes.map(|(dem, detail, culling)| (Arc::new(Surface::new(dem)), detail, culling)).into()
}

/// A camera a little above the land, that looks along it: there contours are.
pub fn low(surface: &Surface, random: &mut Random) -> Camera {
    let [columns, rows] = [surface.dem().columns(), surface.dem().rows()].map(|n| n as u32);
    let mut place = || LatticePoint { x: random.below((columns - 1) * 64), y: random.below((rows - 1) * 64) };
    let land = std::iter::repeat_with(|| surface.position(place())).flatten().next().expect("land");
    let eye = land + DVec3::Z * random.between(5.0, 60.0);
    Camera {
        eye,
        azimuth: random.between(0.0, 360.0),
        altitude: random.between(-12.0, 3.0),
        fov: random.between(40.0, 90.0),
        width: 256,
        height: 256,
    }
}

/// Calls `check` with frames of each scene and their twins.
pub fn each_frame(seed: u64, frames: u32, mut check: impl FnMut(&Scene, &Twin, &str)) {
    let mut random = Random::new(seed);
    for (i, (surface, detail, culling)) in scenes().into_iter().enumerate() {
        for _ in 0..frames {
            let camera = low(&surface, &mut random);
            let scene = Scene::draw(gpu(), &surface, plan(detail, culling), &camera);
            let twin = Twin::new(&surface, &scene.lattice, camera.eye);
            check(&scene, &twin, &format!("scene {i}, {camera:?}"));
        }
    }
}

#[test]
fn the_device_finds_the_pieces_of_the_twin() {
    let mut met = Met::default();
    each_frame(5, 3, |scene, twin, what| {
        let found = scene.compare(twin).unwrap_or_else(|wrong| panic!("{what}: {wrong}"));
        println!("{what}: {found:?}");
        assert!(found.px <= CROSSING_PX, "{what}: {} px off", found.px);
        met = met.with(found);
    });
    println!("{met:?}");
    assert!(met.both > 2000 && met.rim > 300 && met.left_out > 1000, "{met:?}");
    assert!(met.doubtful as f64 <= TURNING_SHARE * met.both as f64, "{met:?}");
}

#[test]
fn a_wrong_piece_is_noticed() {
    let (surface, detail, culling) = scenes().swap_remove(4);
    let mut random = Random::new(29);
    let frames = std::iter::repeat_with(|| {
        let camera = low(&surface, &mut random);
        let scene = Scene::draw(gpu(), &surface, plan(detail, culling), &camera);
        let twin = Twin::new(&surface, &scene.lattice, camera.eye);
        let met = scene.compare(&twin).expect("nothing wrong");
        (camera, scene, twin, met)
    });
    let frame = frames.take(20).find(|(.., met)| met.both - met.rim > 200 && met.rim > 50);
    let (camera, mut scene, twin, met) = frame.expect("a frame with contours");
    assert!(scene.compare(&twin.reversed()).map_or(true, |met| met.px > CROSSING_PX), "g's sign is not noticed");
    let aside = Twin::new(&surface, &scene.lattice, camera.eye + DVec3::X);
    assert!(scene.compare(&aside).is_err(), "an eye 1 m to the side is not noticed");
    let smoothed = Twin::of_whole_facets(&surface, &scene.lattice, camera.eye);
    assert!(scene.compare(&smoothed).is_err(), "the mean of whole facets is not noticed");
    // One lattice edge crossed elsewhere, then one piece lost that shows.
    let names: Vec<Name> = scene.found.keys().copied().collect();
    let lost = names.into_iter().filter(|name| {
        let kept = scene.found.remove(name).expect("a piece");
        let wrong = scene.compare(&twin).is_err();
        scene.found.insert(*name, kept);
        wrong
    });
    assert!(lost.take(20).count() == 20, "lost pieces are not noticed, {met:?}");
    let name = *scene.found.keys().next().expect("a piece");
    let parts = &mut scene.found.get_mut(&name).expect("a piece").parts;
    parts.values_mut().for_each(|part| part.start[2] += 1.0);
    parts.values_mut().for_each(|part| part.code |= code::STARTS);
    assert!(scene.compare(&twin).expect("pieces are where they were").px > CROSSING_PX, "a moved end is not noticed");
}
