//! Flights: cameras along a way over the land, as many as frames are asked for.
//!
//! | what | method |
//! |---|---|
//! | the way | a centripetal Catmull-Rom spline through the stops, by its length (`curve`); or a circle |
//! | the pace | constant ground speed, or a monotone cubic through times (`pace`) |
//! | heights | given, or above the smoothed ground; lifted smoothly over a floor that holds everywhere (`heights`) |
//! | directions | the way's own headings, unwrapped, their mean over the way ahead (`mean`): at a hairpin the camera turns by at most 360 degrees for each such length; or at a target; or as given |
//!
//! A way that ends where it begins goes on smoothly there, and its last frame is the one before the first. A camera depends on
//! the flight and its frame alone, never on those asked before; it is rounded to micrometres and billionths of a degree, so
//! that what systems round differently shows as seldom as can be. Cost: the ground below the way, once; about a microsecond a
//! camera. Not handled: the noise of recorded places, through which the way leads, and targets right below the way, at which
//! a camera turns as fast as it must.

mod curve;
mod ground;
mod heights;
mod mean;
mod monotone;
mod pace;

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Camera;
use crate::error::{Error, Result, Setting};
use crate::message;
use crate::surface::{Level, Surface};
use curve::{Curve, Spline};
use ground::Ground;
use heights::{Base, Heights, Smooth};
use mean::{Beyond, Pieces, beyond};
use monotone::Monotone;
use pace::Pace;

/// Places no farther apart are one: metres.
const SAME: f64 = 0.01;
/// How much of the way ahead the camera heads for, unless told otherwise.
const AHEAD: f64 = 1.0 / 12.0;
/// Cells over which the ground is smoothed at least, and the eye lifted, to both sides.
const LEAST_CELLS: f64 = 8.0;
/// Over how many heights above it the ground is smoothed to both sides.
const SMOOTHED_HEIGHTS: f64 = 4.0;
/// Where the horizon lies on the page, from its top, unless told otherwise.
const HORIZON: f64 = 0.3;
/// Cameras are rounded to one over this: metres and degrees.
const METRE: f64 = 1e6;
const DEGREE: f64 = 1e9;

/// A height in exaggerated metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Height {
    /// Above the zero of the DEM.
    Absolute(f64),
    /// Above the ground: of stops its mean around, of a circle that in its middle.
    AboveGround(f64),
}

/// A place on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Metres of the world.
    pub place: DVec2,
    /// How high the eye is there.
    pub height: Height,
    /// Seconds, rising from stop to stop; of all stops or of none.
    pub time: Option<f64>,
}

/// Where a flight leads.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// Through stops, in order.
    Through(Vec<Stop>),
    /// Clockwise around a centre, from its south.
    Around {
        /// Metres of the world.
        centre: DVec2,
        /// Metres, above 0.
        radius: f64,
        /// How high the eye is all the way.
        height: Height,
    },
}

/// Where the camera looks. Lists hold one entry for the whole flight or one for each stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Look {
    /// Where the way leads.
    Ahead,
    /// At places of the world.
    At(Vec<DVec3>),
    /// In directions, degrees clockwise from the world's y axis.
    Towards(Vec<f64>),
}

/// A flight as it is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Where it leads.
    pub way: Way,
    /// Where the camera looks.
    pub look: Look,
    /// Degrees above the horizon, one or one for each stop; by default those of the target, else the horizon stands three
    /// tenths of the page below its top.
    pub altitudes: Option<Vec<f64>>,
    /// Horizontal fields of view in degrees, one or one for each stop.
    pub fovs: Vec<f64>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Frames in all.
    pub count: u32,
    /// Exaggerated metres that the eye keeps above the ground.
    pub clearance: f64,
    /// Metres of the way ahead that the camera heads for; by default a twelfth of it.
    pub ahead: Option<f64>,
}

/// Cameras along a way.
#[derive(Debug, Clone)]
pub struct Flight {
    curve: Curve,
    pace: Pace,
    heights: Heights,
    direction: Direction,
    altitudes: Option<Monotone>,
    fovs: Monotone,
    size: [u32; 2],
    count: u32,
}

/// Where the camera looks, by the moment or by the metres.
#[derive(Debug, Clone)]
enum Direction {
    /// Radians by metres, and half the metres ahead that count.
    Ahead(Pieces, f64),
    At([Monotone; 3]),
    Towards(Monotone),
}

/// The stops of a flight that come one after another.
#[derive(Debug, Default)]
struct Stops {
    /// Which of those given.
    kept: Vec<usize>,
    /// Seconds where timed, else metres.
    moments: Vec<f64>,
    metres: Vec<f64>,
    heights: Vec<Height>,
    closed: bool,
    timed: bool,
}

impl Stops {
    /// Of numbers for all stops given, or of the one for all of them; `turn`: that after which they are the same again.
    fn smooth(&self, given: &[f64], turn: Option<f64>) -> Monotone {
        if given.len() < 2 {
            return Monotone::constant(given.first().copied().unwrap_or_default());
        }
        let mut numbers: Vec<f64> = self.kept.iter().filter_map(|i| given.get(*i).copied()).collect();
        if let Some(turn) = turn {
            for i in 1..numbers.len() {
                numbers[i] -= turn * ((numbers[i] - numbers[i - 1]) / turn).round();
            }
        }
        self.smooth_kept(numbers)
    }

    /// Of numbers for the stops that are kept.
    fn smooth_kept(&self, numbers: Vec<f64>) -> Monotone {
        match (self.closed, numbers.first(), numbers.last()) {
            (true, Some(first), Some(last)) => Monotone::closed(&self.moments, &numbers, last - first),
            _ => Monotone::new(&self.moments, &numbers),
        }
    }

    /// When the eye is where.
    fn pace(&self, length: f64) -> Pace {
        match (self.timed, self.moments.first(), self.moments.last()) {
            (true, Some(first), Some(last)) => Pace::Timed(self.smooth_kept(self.metres.clone()), [*first, *last]),
            _ => Pace::Constant(length),
        }
    }
}

impl Flight {
    /// The flight of a course over a surface, of which that level is drawn.
    ///
    /// # Errors
    /// [`Error::Setting`] where the stops are one place, or heights above ground are asked for where there is none; those of
    /// a surface whose samples cannot be read.
    pub fn new(course: &Course, surface: &Surface, level: Level) -> Result<Self> {
        let (curve, stops) = match &course.way {
            Way::Through(stops) => through(stops)?,
            Way::Around { centre, radius, .. } => {
                (Curve::Circle { centre: *centre, radius: *radius }, Stops::default())
            }
        };
        let length = curve.length();
        let pace = stops.pace(length);
        let least = LEAST_CELLS * surface.dem().cell().max_element();
        let half = (course.ahead.unwrap_or(AHEAD * length) / 2.0).min(length / 2.0);
        let ground = Ground::below(&curve, surface, level)?;
        let base = match &course.way {
            Way::Through(_) => base(&curve, &stops, &ground, least)?,
            Way::Around { centre, height, .. } => Base::Given(Monotone::constant(match height {
                Height::Absolute(z) => *z,
                Height::AboveGround(h) => h + surface.height_below(*centre, level).ok_or_else(no_ground)?,
            })),
        };
        let lifts = half.max(least).min(length / 2.0);
        let moments = |metres| pace.moments(metres);
        let heights = Heights::new(base, &ground, &curve, course.clearance, lifts, moments, &stops.moments);
        let direction = match &course.look {
            Look::Ahead => ahead(&curve, half),
            Look::At(targets) => Direction::At([0, 1, 2].map(|i| {
                let numbers: Vec<f64> = targets.iter().map(|target| target[i]).collect();
                stops.smooth(&numbers, None)
            })),
            Look::Towards(azimuths) => Direction::Towards(stops.smooth(azimuths, Some(360.0))),
        };
        let altitudes = course.altitudes.as_ref().map(|altitudes| stops.smooth(altitudes, None));
        let fovs = stops.smooth(&course.fovs, None);
        Ok(Self { curve, pace, heights, direction, altitudes, fovs, size: course.size, count: course.count })
    }

    /// Frames in all.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Metres over ground; of a way that closes, once round.
    pub fn length(&self) -> f64 {
        self.curve.length()
    }

    /// Whether the way ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.curve.is_closed()
    }

    /// Whether some of it is over land of the DEM.
    pub(crate) fn is_over_land(&self) -> bool {
        self.heights.over_land
    }

    /// By how many exaggerated metres the eye is lifted, where it is most, to keep clear of the ground; 0 where nowhere.
    pub fn lifted(&self) -> f64 {
        self.heights.missing
    }

    /// The camera of a frame, from 0. Frames are apart by equal times from the first stop to the last one; of a way that
    /// closes, to the one before the first.
    pub fn camera(&self, frame: u32) -> Camera {
        let [first, last] = self.pace.span();
        let steps = if self.is_closed() { self.count } else { self.count.saturating_sub(1) }.max(1);
        let frame = if self.is_closed() { frame % steps } else { frame.min(steps) };
        let moment = match frame == steps {
            true => last,
            false => first + (last - first) * f64::from(frame) / f64::from(steps),
        };
        self.camera_of(moment, self.pace.metres(moment))
    }

    /// The camera so many metres over ground from the start: no farther than the end; of a way that closes, round and round.
    pub fn camera_at(&self, metres: f64) -> Camera {
        let metres = match self.is_closed() {
            true => metres.rem_euclid(self.length()),
            false => metres.clamp(0.0, self.length()),
        };
        self.camera_of(self.pace.moments(metres)[0], metres)
    }

    fn camera_of(&self, moment: f64, metres: f64) -> Camera {
        let [width, height] = self.size;
        let eye = self.curve.place(metres).extend(self.heights.at(moment, metres));
        let fov = self.fovs.at(moment);
        let (azimuth, altitude) = match &self.direction {
            Direction::Ahead(headings, half) => (headings.mean(metres + half, *half).to_degrees(), None),
            Direction::Towards(azimuths) => (azimuths.at(moment), None),
            Direction::At(target) => {
                let way = DVec3::from([0, 1, 2].map(|i| target[i].at(moment))) - eye;
                let altitude = way.z.atan2(way.truncate().length());
                (way.x.atan2(way.y).to_degrees(), Some(altitude.to_degrees()))
            }
        };
        let asked = self.altitudes.as_ref().map(|altitudes| altitudes.at(moment));
        let altitude = asked.or(altitude).unwrap_or_else(|| {
            let half_height = (fov.to_radians() / 2.0).tan() * f64::from(height) / f64::from(width);
            -(half_height * (1.0 - 2.0 * HORIZON)).atan().to_degrees()
        });
        let degrees = |degrees: f64| (degrees * DEGREE).round() / DEGREE;
        let azimuth = degrees(azimuth.rem_euclid(360.0)).rem_euclid(360.0);
        let eye = (eye * METRE).round() / METRE;
        Camera { eye, azimuth, altitude: degrees(altitude), fov: degrees(fov), width, height }
    }
}

fn same(a: Height, b: Height) -> bool {
    match (a, b) {
        (Height::Absolute(a), Height::Absolute(b)) | (Height::AboveGround(a), Height::AboveGround(b)) => {
            (a - b).abs() <= SAME
        }
        _ => false,
    }
}

/// The curve through stops, and these one after another.
fn through(given: &[Stop]) -> Result<(Curve, Stops)> {
    let mut places: Vec<DVec2> = Vec::new();
    let mut knots = Vec::new();
    for stop in given {
        if places.last().is_none_or(|last| last.distance(stop.place) > SAME) {
            places.push(stop.place);
        }
        knots.push(places.len() - 1);
    }
    let closed = given.first().zip(given.last()).is_some_and(|(first, last)| {
        places.len() > 2 && first.place.distance(last.place) <= SAME && same(first.height, last.height)
    });
    if closed {
        places.pop();
    }
    if places.len() < 2 {
        let remedy = message!["give one of two places, or ", Setting::Orbit];
        return Err(Error::setting(Setting::Path, "all its points are one place", remedy));
    }
    let spline = Spline::new(&places, closed);
    let timed = given.iter().all(|stop| stop.time.is_some());
    let mut stops = Stops { closed, timed, ..Stops::default() };
    for (i, (stop, knot)) in given.iter().zip(knots).enumerate() {
        let metres = spline.knots[knot];
        let moment = stop.time.unwrap_or(metres);
        let moment = if timed { moment } else { metres };
        if stops.moments.last().is_none_or(|last| moment > *last) {
            stops.kept.push(i);
            stops.moments.push(moment);
            stops.metres.push(metres);
            stops.heights.push(stop.height);
        }
    }
    Ok((Curve::Spline(spline), stops))
}

/// The heights of stops as they are given: all above the smoothed ground, else all above zero.
fn base(curve: &Curve, stops: &Stops, ground: &Ground, least: f64) -> Result<Base> {
    let above = |height: &Height| if let Height::AboveGround(h) = height { Some(*h) } else { None };
    let highest = stops.heights.iter().filter_map(above).reduce(f64::max);
    let smooth = match highest {
        Some(h) => Some(Smooth::of(ground, curve, (SMOOTHED_HEIGHTS * h).max(least)).ok_or_else(no_ground)?),
        None => None,
    };
    if let Some(smooth) = &smooth
        && let Some(heights) = stops.heights.iter().map(above).collect::<Option<Vec<f64>>>()
    {
        return Ok(Base::AboveGround(smooth.clone(), stops.smooth_kept(heights)));
    }
    let height = |(height, metres): (&Height, &f64)| match height {
        Height::Absolute(z) => *z,
        Height::AboveGround(h) => h + smooth.as_ref().map_or(0.0, |smooth| smooth.at(*metres)),
    };
    Ok(Base::Given(stops.smooth_kept(stops.heights.iter().zip(&stops.metres).map(height).collect())))
}

/// The means of the headings of a curve over the metres ahead.
fn ahead(curve: &Curve, half: f64) -> Direction {
    let (headings, round) = match curve {
        Curve::Spline(spline) => spline.headings(),
        // From its south a circle leads west.
        Curve::Circle { radius, .. } => (vec![(0.0, -TAU / 4.0), (TAU * radius, 0.75 * TAU)], TAU),
    };
    match curve.is_closed() {
        true => Direction::Ahead(Pieces::new(beyond(&headings, curve.length(), Beyond::Again(round))), half),
        false => Direction::Ahead(Pieces::new(headings), half),
    }
}

fn no_ground() -> Error {
    let what = "there is no ground of the DEM below it to be above";
    Error::setting(Setting::Height, what, "give a height without +, or places where the DEM has data")
}
