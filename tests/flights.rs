//! Flights: cameras by closed forms, and heights over real land.

use std::f64::consts::TAU;
use std::fs;
use std::sync::OnceLock;

use clap::Parser;
use glam::{DVec2, DVec3};
use hachure::dem::Dem;
use hachure::door::cli::flight::{FlightArguments, FlightPlan};
use hachure::door::cli::words::line;
use hachure::error::Result;
use hachure::geo::{ReadOptions, read};
use hachure::surface::{Level, Surface};
use hachure::view::flight::{Course, Height, Look, Stop, Way};
use hachure::view::{Camera, Flight};
use tempfile::TempDir;

/// Frames of most flights here.
const COUNT: u32 = 500;

/// The flags, as a subcommand has them.
#[derive(Parser)]
pub struct Typed {
    #[command(flatten)]
    pub flight: FlightArguments,
}

pub fn typed(flags: &[&str]) -> FlightArguments {
    Typed::try_parse_from([&["fly"], flags].concat()).unwrap_or_else(|e| panic!("{e}")).flight
}

pub fn plan(flags: &[&str]) -> Result<FlightPlan> {
    typed(flags).plan(false)
}

/// The sample, from the repository: UTM zone 10, cells of 30 m, a bay between hills.
pub fn sample() -> &'static Surface {
    static SAMPLE: OnceLock<Surface> = OnceLock::new();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/dem/golden-gate.tif");
    SAMPLE.get_or_init(|| Surface::new(read(path, &ReadOptions::default()).expect("the sample")))
}

/// A plane that rises east and falls north, cells of 10 m, its samples from 0 to 4000 m.
fn plane(east: f64, north: f64) -> Surface {
    let heights = (0..401 * 401).map(|i| (east * f64::from(i % 401) * 10.0 - north * f64::from(i / 401) * 10.0) as f32);
    let origin = DVec2::new(0.0, 4000.0);
    Surface::new(Dem::from_heights(401, DVec2::splat(10.0), origin, heights.collect()))
}

pub fn flight(flags: &[&str]) -> Flight {
    let flight = plan(flags).and_then(|plan| plan.flight(sample(), Level::EIGHT, 1.0));
    flight.unwrap_or_else(|e| panic!("{flags:?}: {}", line(&e)))
}

pub fn cameras(flight: &Flight) -> Vec<Camera> {
    (0..flight.count()).map(|frame| flight.camera(frame)).collect()
}

/// Through places at heights, looking ahead.
fn course(stops: &[[f64; 3]]) -> Course {
    let stop = |[x, y, z]: &[f64; 3]| Stop { place: DVec2::new(*x, *y), height: Height::Absolute(*z), time: None };
    Course {
        way: Way::Through(stops.iter().map(stop).collect()),
        look: Look::Ahead,
        altitudes: None,
        fovs: vec![60.0],
        size: [160, 90],
        count: COUNT,
        clearance: 0.0,
        ahead: None,
    }
}

fn timed(stops: &[[f64; 4]]) -> Course {
    let mut course = course(&stops.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect::<Vec<_>>());
    if let Way::Through(given) = &mut course.way {
        given.iter_mut().zip(stops).for_each(|(stop, [.., time])| stop.time = Some(*time));
    }
    course
}

fn flown(course: &Course, surface: &Surface) -> Flight {
    Flight::new(course, surface, Level::EIGHT).unwrap_or_else(|e| panic!("{}", line(&e)))
}

/// Steps over ground from frame to frame.
fn steps(cameras: &[Camera]) -> Vec<f64> {
    cameras.windows(2).map(|pair| pair[0].eye.truncate().distance(pair[1].eye.truncate())).collect()
}

/// A difference of azimuths, degrees.
pub fn turn(a: f64, b: f64) -> f64 {
    (b - a + 180.0).rem_euclid(360.0) - 180.0
}

pub fn write(folder: &TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).expect(name);
    path.to_str().expect("a name").to_owned()
}

pub fn folder() -> TempDir {
    TempDir::new().expect("a folder")
}

#[test]
fn an_orbit_is_a_circle_that_looks_at_its_middle() {
    let flags = "--orbit 545000,4188000 --radius 3000 --height 2000 --count 8";
    let flight = flight(&flags.split(' ').collect::<Vec<_>>());
    assert!((flight.length() - TAU * 3000.0).abs() < 1e-9 && flight.lifted() == 0.0);
    for (i, camera) in cameras(&flight).into_iter().enumerate() {
        let angle = TAU * (i as f64 / 8.0 + 0.5);
        let wanted = DVec3::new(545_000.0 + 3000.0 * angle.sin(), 4_188_000.0 + 3000.0 * angle.cos(), 2000.0);
        assert!(camera.eye.distance(wanted) < 2e-6, "{i}: {camera:?}");
        assert!(turn(camera.azimuth, 45.0 * i as f64).abs() < 1e-8, "{camera:?}");
        let ground = sample().height_below(DVec2::new(545_000.0, 4_188_000.0), Level::EIGHT).expect("ground");
        let down = ((2000.0 - ground) / 3000.0).atan().to_degrees();
        assert!((camera.altitude + down).abs() < 1e-5, "{camera:?}, {down}");
    }
    assert_eq!(flight.camera_at(TAU * 750.0), flight.camera(2), "a quarter round");
}

#[test]
fn a_straight_way_is_flown_at_one_speed_and_level() {
    let surface = plane(0.0, 0.0);
    // Points apart as they come.
    let flight = flown(&course(&[[500.0, 500.0, 90.0], [600.0, 600.0, 90.0], [3500.0, 3500.0, 90.0]]), &surface);
    let cameras = cameras(&flight);
    let length = 3000.0 * 2f64.sqrt();
    assert!((flight.length() - length).abs() < 1e-6 * length);
    let step = length / f64::from(COUNT - 1);
    assert!(steps(&cameras).iter().all(|s| (s - step).abs() < 1e-5), "{step}");
    let half_page = 30f64.to_radians().tan() * 90.0 / 160.0;
    let down = (half_page * 0.4).atan().to_degrees();
    for camera in &cameras {
        assert!((camera.azimuth - 45.0).abs() < 1e-6 && camera.eye.z == 90.0 && (camera.altitude + down).abs() < 1e-8);
    }
    assert_eq!((cameras[0].eye.x, cameras[499].eye), (500.0, DVec3::new(3500.0, 3500.0, 90.0)));
}

/// A centripetal Catmull-Rom curve by the pyramid of Barry and Goldman, at a share of its middle piece.
fn barry_goldman(p: [DVec2; 4], share: f64) -> DVec2 {
    let mut t = [0.0; 4];
    (1..4).for_each(|i| t[i] = t[i - 1] + p[i].distance(p[i - 1]).sqrt());
    let at = t[1] + share * (t[2] - t[1]);
    let mix = |a: DVec2, b: DVec2, from: f64, to: f64| a * ((to - at) / (to - from)) + b * ((at - from) / (to - from));
    let a: Vec<DVec2> = (0..3).map(|i| mix(p[i], p[i + 1], t[i], t[i + 1])).collect();
    let b: Vec<DVec2> = (0..2).map(|i| mix(a[i], a[i + 1], t[i], t[i + 2])).collect();
    mix(b[0], b[1], t[1], t[2])
}

#[test]
fn the_way_is_the_centripetal_curve_by_its_length() {
    let surface = plane(0.0, 0.0);
    let points = [[400.0, 400.0], [700.0, 3000.0], [900.0, 3050.0], [3000.0, 600.0], [3600.0, 3600.0]];
    let flight = flown(&course(&points.map(|[x, y]| [x, y, 50.0])), &surface);
    let p = points.map(DVec2::from);
    let ends = [2.0 * p[0] - p[1], 2.0 * p[4] - p[3]];
    let padded = [ends[0], p[0], p[1], p[2], p[3], p[4], ends[1]];
    // Lengths by many chords, which cut corners by the square of their number.
    let mut metres = 0.0;
    let chords = 200_000;
    for piece in 0..4 {
        let four = [0, 1, 2, 3].map(|i| padded[piece + i]);
        let mut before = four[1];
        for i in 1..=chords {
            let place = barry_goldman(four, f64::from(i) / f64::from(chords));
            metres += before.distance(place);
            before = place;
            if i % 20_000 == 0 {
                let own = flight.camera_at(metres).eye.truncate();
                assert!(own.distance(place) < 1e-6 * metres.max(100.0), "{piece}, {i}: {own} is not {place}");
            }
        }
    }
    assert!((flight.length() / metres - 1.0).abs() < 1e-8, "{} is not {metres}", flight.length());
    let cameras = cameras(&flight);
    // A chord of a bend of 100 m is shorter by a share of 1e-3 where frames are 16 m apart.
    let dense = steps(&(0..20_000).map(|i| flight.camera_at(metres * f64::from(i) / 20_000.0)).collect::<Vec<_>>());
    let mean = metres / 20_000.0;
    assert!(dense.iter().all(|step| (step / mean - 1.0).abs() < 1e-3), "constant ground speed");
    assert_eq!(cameras.len(), COUNT as usize);
}

#[test]
fn a_closed_way_goes_on_smoothly() {
    let surface = plane(0.0, 0.0);
    let corners = [[1000.0, 1000.0, 50.0], [1000.0, 3000.0, 80.0], [3000.0, 3000.0, 90.0], [3000.0, 1000.0, 60.0]];
    let mut points = corners.to_vec();
    points.push(corners[0]);
    let flight = flown(&course(&points), &surface);
    let mut cameras = cameras(&flight);
    assert!(flight.is_closed());
    cameras.extend_from_within(..3);
    let step = flight.length() / f64::from(COUNT);
    assert!(steps(&cameras).iter().all(|s| (s / step - 1.0).abs() < 1e-3));
    let turns: Vec<f64> = cameras.windows(2).map(|pair| turn(pair[0].azimuth, pair[1].azimuth)).collect();
    assert!(turns.iter().all(|turn| *turn > 0.1 && *turn < 2.5), "clockwise: {turns:?}");
    assert!((turns[..COUNT as usize].iter().sum::<f64>() - 360.0).abs() < 1e-6, "once round");
    let rises: Vec<f64> = cameras.windows(2).map(|pair| pair[1].eye.z - pair[0].eye.z).collect();
    assert!(rises.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.02), "the seam bends no more than the rest");
    // Turned about, it is another way.
    points.reverse();
    let back = flown(&course(&points), &surface);
    assert!(turn(back.camera(10).azimuth, back.camera(11).azimuth) < 0.0);
}

#[test]
fn a_hairpin_and_a_stop_turn_the_camera_no_faster_than_promised() {
    let surface = plane(0.0, 0.0);
    let ahead = Some(400.0);
    let there_and_back = [[500.0, 2000.0, 50.0], [3500.0, 2000.0, 50.0], [1000.0, 2000.0, 50.0]];
    let flight = flown(&Course { ahead, ..course(&there_and_back) }, &surface);
    let turns: Vec<f64> = cameras(&flight).windows(2).map(|pair| turn(pair[0].azimuth, pair[1].azimuth)).collect();
    // Half a turn under a triangle of 400 m: at most 360 degrees for each 400 m.
    let most = 360.0 / 400.0 * flight.length() / f64::from(COUNT - 1);
    assert!(turns.iter().all(|turn| (-1e-6..=most * 1.001).contains(turn)), "{most}: {turns:?}");
    assert!((turns.iter().sum::<f64>() - 180.0).abs() < 1e-6, "right back, clockwise");
    // A stop of 2 s.
    let stops = [
        [500.0, 500.0, 50.0, 0.0],
        [2000.0, 900.0, 50.0, 4.0],
        [2000.0, 900.0, 70.0, 6.0],
        [3000.0, 3000.0, 50.0, 10.0],
    ];
    let flight = flown(&timed(&stops), &surface);
    let cameras = cameras(&flight);
    assert!(cameras.windows(2).all(|pair| turn(pair[0].azimuth, pair[1].azimuth).abs() < 1.5));
    let during = &cameras[202..298];
    assert!(during.iter().all(|camera| camera.eye.truncate() == DVec2::new(2000.0, 900.0)), "it stands");
    assert!(during.windows(2).all(|pair| pair[1].eye.z > pair[0].eye.z), "and rises");
}

#[test]
fn a_timed_way_is_where_it_should_be_and_never_backs_up() {
    let surface = plane(0.0, 0.0);
    let stops = [
        [500.0, 500.0, 50.0, 2.0],
        [600.0, 600.0, 50.0, 4.0],
        [3000.0, 700.0, 50.0, 5.0],
        [3100.0, 3000.0, 50.0, 12.0],
    ];
    let flight = flown(&Course { count: 1001, ..timed(&stops) }, &surface);
    let cameras = cameras(&flight);
    for [x, y, _, time] in stops {
        let eye = cameras[((time - 2.0) * 100.0) as usize].eye.truncate();
        assert!(eye.distance(DVec2::new(x, y)) < 1e-5, "{eye} at {time} s");
    }
    let metres: Vec<f64> = steps(&cameras)
        .iter()
        .scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        })
        .collect();
    assert!(metres.is_sorted() && (metres[999] / flight.length() - 1.0).abs() < 1e-4, "{}", metres[999]);
    let speeds = steps(&cameras);
    let jump = speeds.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 3.0, "from 1 m a frame to 24 it changes smoothly, by at most {jump}");
}

#[test]
fn heights_above_a_slope_are_above_it_and_do_not_bob() {
    let surface = plane(0.3, 0.1);
    let mut course = course(&[[500.0, 800.0, 0.0], [3500.0, 2000.0, 0.0]]);
    if let Way::Through(stops) = &mut course.way {
        stops.iter_mut().for_each(|stop| stop.height = Height::AboveGround(100.0));
    }
    for camera in cameras(&flown(&course, &surface)) {
        let ground = surface.height_below(camera.eye.truncate(), Level::EIGHT).expect("ground");
        assert!((camera.eye.z - ground - 100.0).abs() < 0.01, "{camera:?}, {ground}");
    }
    // Over land: smoother than the land by far.
    let folder = folder();
    let path = write(
        &folder,
        "hills.toml",
        "key = [{place = [539000, 4186000, \"+300\"]}, {place = [549000, 4193000, \"+300\"]}]",
    );
    let cameras = cameras(&flight(&["--path", &path, "--count", "2000"]));
    let ground = |camera: &Camera| sample().height_below(camera.eye.truncate(), Level::EIGHT).expect("ground");
    let bends = |z: &dyn Fn(&Camera) -> f64| {
        cameras.windows(3).map(|c| (z(&c[0]) - 2.0 * z(&c[1]) + z(&c[2])).abs()).fold(0.0, f64::max)
    };
    let (eye, land) = (bends(&|camera| camera.eye.z), bends(&ground));
    println!("bends of the eye {eye:.4} m, of the land {land:.4} m a frame");
    assert!(eye < land / 20.0, "{eye} against {land}");
}

#[test]
fn the_clearance_holds_everywhere_and_is_reached_smoothly() {
    let folder = folder();
    // Right through the hills, at sea level.
    let text =
        "key = [{place = [538000, 4186000, 0]}, {place = [541000, 4190000, 40]}, {place = [549000, 4193000, 0]}]";
    let path = write(&folder, "low.toml", text);
    for (clearance, level) in [("60", 1), ("20", 8), ("0", 2)] {
        let level = Level::new(level).expect("a level");
        let plan = plan(&["--path", &path, "--count", "3000", "--clearance", clearance]).expect("a plan");
        let flight = plan.flight(sample(), level, 1.0).expect("a flight");
        let cameras = cameras(&flight);
        let metres: f64 = clearance.parse().expect("metres");
        let over =
            |camera: &Camera| camera.eye.z - sample().height_below(camera.eye.truncate(), level).expect("ground");
        let least = cameras.iter().map(over).fold(f64::INFINITY, f64::min);
        let between = (0..4000)
            .map(|i| over(&flight.camera_at(f64::from(i) * flight.length() / 3999.5)))
            .fold(f64::INFINITY, f64::min);
        assert!(least >= metres && between >= metres, "{least}, {between} of {metres}");
        assert!(least < metres + 40.0, "no higher than it must be: {least}");
        // At most four times the lift over the square of the half window, a twenty-fourth of the way, and what the keys bend.
        let step = flight.length() / 2999.0;
        let most = 4.0 * flight.lifted() / (flight.length() / 24.0).powi(2) * step * step + 1e-3;
        let bends = cameras.windows(3).map(|c| (c[0].eye.z - 2.0 * c[1].eye.z + c[2].eye.z).abs()).fold(0.0, f64::max);
        println!(
            "clearance {clearance}: least {least:.3}, between {between:.3}, lifted {:.1}, bends {bends:.5} of {most:.5} m",
            flight.lifted()
        );
        assert!(bends <= most, "{bends} of {most}");
    }
    // The check sees a flight that is not lifted: high enough it is left alone, to the bit.
    let high = write(&folder, "high.toml", &text.replace(", 0]", ", 2000]").replace(", 40]", ", 2000]"));
    let flight = flight(&["--path", &high, "--count", "50", "--clearance", "60"]);
    assert!(flight.lifted() == 0.0 && cameras(&flight).iter().all(|camera| camera.eye.z == 2000.0));
}

#[test]
fn a_camera_does_not_depend_on_those_asked_before() {
    let flags = ["--orbit", "545000,4188000", "--radius", "4000", "--count", "40", "--altitude", "-3"];
    let (one, other) = (flight(&flags), flight(&flags));
    let forward = cameras(&one);
    let mut backward: Vec<Camera> = (0..40).rev().map(|frame| other.camera(frame)).collect();
    backward.reverse();
    assert_eq!(forward, backward);
    let bytes = |flags: &[&str]| plan(flags).expect("a plan").hashed();
    assert_eq!(bytes(&flags), bytes(&flags));
    for (at, other) in [(1, "545000,4188001"), (3, "4001"), (5, "41"), (7, "-4")] {
        let mut changed = flags;
        changed[at] = other;
        assert_ne!(bytes(&flags), bytes(&changed), "{other}");
    }
}
