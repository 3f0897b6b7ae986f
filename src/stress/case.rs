//! A case: land, views of it, and what it promises.

use glam::{DVec2, DVec3};

use super::promise::Promise;
use crate::dem::Dem;
use crate::error::Result;
use crate::plan::Detail;
use crate::surface::{Level, Surface};
use crate::view::Camera;

/// What makes a case hard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Nothing: land as it is, beside which the others stand.
    Ordinary,
    /// Land whose heights change more from sample to sample than a surface between them likes.
    Stiff,
    /// Eyes and directions in which a rounding decides what is seen.
    Views,
    /// Lengths and coordinates at the ends of numbers.
    Scales,
    /// Few samples, few pixels, facets as coarse and as fine as there are.
    Sizes,
    /// Voids, steps, and heights that files should not have.
    Data,
}

impl Group {
    /// All of them, in the order of the registry.
    pub const ALL: [Self; 6] = [Self::Ordinary, Self::Stiff, Self::Views, Self::Scales, Self::Sizes, Self::Data];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::Stiff => "stiff",
            Self::Views => "views",
            Self::Scales => "scales",
            Self::Sizes => "sizes",
            Self::Data => "data",
        }
    }
}

/// Land that is seen from somewhere, and what is promised of it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Unique, of small letters, digits and dashes: files are named after it.
    pub name: &'static str,
    /// What makes it hard.
    pub group: Group,
    /// The same in a line.
    pub about: &'static str,
    /// The land.
    pub dem: Dem,
    /// Whether tangents of its surface are limited, so that nothing folds.
    pub limited: bool,
    /// At least one.
    pub views: Vec<View>,
    /// How fine its facets are.
    pub detail: Detail,
    /// Most subdivisions of a cell's edge for truth, which otherwise has no visible edge longer than a pixel.
    pub truth: Level,
    /// What it promises.
    pub promises: Vec<Promise>,
    /// Whether it is on the short list.
    pub short: bool,
}

/// What it is seen by.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// Unique in its case, as that is in the registry.
    pub name: &'static str,
    /// From where, on which page.
    pub camera: Camera,
}

impl Case {
    /// Land without a view yet, that promises what every case does.
    pub fn new(group: Group, name: &'static str, about: &'static str, dem: Dem) -> Self {
        let promises = Promise::OF_ALL.to_vec();
        let (detail, truth) = (Detail::default(), TRUTH);
        Self { name, group, about, dem, limited: false, views: Vec::new(), detail, truth, promises, short: false }
    }

    /// Seen by a camera too.
    pub fn view(mut self, name: &'static str, camera: Camera) -> Self {
        self.views.push(View { name, camera });
        self
    }

    /// Seen from `from` to `to`, each a column, a row and metres above the ground there, 60 degrees across.
    pub fn seen(self, name: &'static str, from: [f64; 3], to: [f64; 3]) -> Self {
        let camera = look(above(&self.dem, from), above(&self.dem, to), 60.0, PAGE);
        self.view(name, camera)
    }

    /// Drawn in facets as fine as this.
    pub fn drawn(self, detail: impl Into<Detail>) -> Self {
        Self { detail: detail.into(), ..self }
    }

    /// With tangents limited.
    pub fn limited(self) -> Self {
        Self { limited: true, ..self }
    }

    /// The surface of its land, or of the same land elsewhere.
    ///
    /// # Errors
    /// As [`Surface::limited`].
    pub fn surface(&self, dem: &Dem) -> Result<Surface> {
        let surface = Surface::new(dem.clone());
        if self.limited { surface.limited() } else { Ok(surface) }
    }

    /// Its truth no finer than this.
    pub fn truth_to(self, truth: Level) -> Self {
        Self { truth, ..self }
    }

    /// With heights, cells and eyes of few binary digits: what is moved by as few has the same bits.
    pub fn exact(mut self) -> Self {
        self.promises.extend([Promise::SameBits, Promise::Turned, Promise::TurnedFar]);
        self
    }

    /// A short flight begins at its first view, too.
    pub fn flown(mut self) -> Self {
        self.promises.extend([Promise::Alone, Promise::Steady]);
        self
    }

    /// Without a promise that makes no sense of it.
    pub fn without(mut self, promise: Promise) -> Self {
        self.promises.retain(|other| *other != promise);
        self
    }

    /// On the short list too.
    pub fn in_short(self) -> Self {
        Self { short: true, ..self }
    }

    /// What makes it hard, its promises, and what it is, in a line.
    pub fn line(&self) -> String {
        let promises: Vec<_> = self.promises.iter().map(|promise| promise.name()).collect();
        let short = if self.short { "short" } else { "" };
        format!("{:<18} {:<9} {short:<6} {}: {}", self.name, self.group.name(), self.about, promises.join(", "))
    }
}

/// Most subdivisions of a cell's edge for truth, unless a case says otherwise.
const TRUTH: Level = Level::THIRTY_TWO;
/// Pixels of most pages.
pub(crate) const PAGE: [u32; 2] = [320, 240];

/// The place so many metres above the sample nearest to a column and a row, which may lie outside.
pub(crate) fn above(dem: &Dem, [column, row, metres]: [f64; 3]) -> DVec3 {
    let nearest = |at: f64, samples: usize| at.round().clamp(0.0, (samples - 1) as f64) as usize;
    let ground = dem.position(nearest(column, dem.columns()), nearest(row, dem.rows())).z;
    let place = dem.position(0, 0).truncate() + DVec2::new(column, -row) * dem.cell();
    place.extend(ground + metres)
}

/// A camera at an eye that looks at a place.
pub(crate) fn look(eye: DVec3, target: DVec3, fov: f64, [width, height]: [u32; 2]) -> Camera {
    let d = target - eye;
    let azimuth = d.x.atan2(d.y).to_degrees();
    let altitude = d.z.atan2(d.truncate().length()).to_degrees();
    Camera { eye, azimuth, altitude, fov, width, height }
}
