//! Chains: ordered lines on the page that know what they draw and where they lie in the world.

use glam::{DVec2, DVec3};

use crate::view::Perspective;

/// What a chain draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Line {
    /// Where land hides farther land: the silhouette between toward and away surface.
    Occluding,
    /// Where land ends against the sky.
    Skyline,
    /// The border of the DEM and of its voids.
    Border,
    /// Where land and water meet.
    Shore,
    /// Where water gathers and runs.
    Drainage,
    /// Where water parts.
    Ridge,
    /// A line that the user gives, of the layer of this number.
    Own(u16),
    /// A line down the slope that is drawn for its tone.
    Hachure,
}

impl Line {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Occluding => "silhouette",
            Self::Skyline => "skyline",
            Self::Border => "border",
            Self::Shore => "shore",
            Self::Drainage => "drainage",
            Self::Ridge => "ridge",
            Self::Own(_) => "own",
            Self::Hachure => "hachure",
        }
    }

    /// Whether it lies on the land whatever the eye, and bounds nothing of what that sees.
    pub fn is_of_land(self) -> bool {
        !matches!(self, Self::Occluding | Self::Skyline | Self::Border)
    }
}

/// A point of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChainPoint {
    /// Pixels from the page's top left corner, x right, y down; pixel centres are at halves.
    pub place: DVec2,
    /// What the chain draws from here on.
    pub line: Line,
    /// Near / distance along the view axis; larger is nearer.
    pub depth: f32,
    /// The same of what lies behind, on the far side of the line; 0 is sky, and where nobody has looked.
    pub behind: f32,
    /// Metres of the exaggerated world: east, north, up.
    pub world: DVec3,
    /// Pixels of ink in the square of 9 x 9 about it; 0 where none were [counted](super::crowded).
    pub crowd: u32,
    /// How strongly it is drawn, 0 to 1, from here halfway to the points before and after: until [economy](super::economy) lowers
    /// it 1, and of lines on the land what the page [shows](super::detail) of them.
    pub weight: f32,
    /// Of a hachure the share of the paper about it that is to be ink; 1 of all else.
    pub black: f32,
}

impl ChainPoint {
    /// The point at a place on the page, by its depth.
    pub(super) fn seen(place: DVec2, line: Line, depth: f32, perspective: &Perspective) -> Self {
        Self {
            place,
            line,
            depth,
            behind: 0.0,
            world: perspective.unproject(place, depth.into()),
            crowd: 0,
            weight: 1.0,
            black: 1.0,
        }
    }

    /// The share of the way to what is behind that lies beyond the point, 0 to 1: about the jump where that is small, 1 for
    /// sky.
    pub fn relief(&self) -> f64 {
        (1.0 - f64::from(self.behind) / f64::from(self.depth)).max(0.0)
    }

    /// ln depth, in which equal steps are equal ratios of distance; finite for sky too.
    pub(super) fn log_depth(&self) -> f64 {
        f64::from(self.depth.max(f32::MIN_POSITIVE)).ln()
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl ChainPoint {
    /// How much farther lies what is behind, as a share of the distance; infinite for sky.
    pub fn jump(&self) -> f64 {
        f64::from(self.depth) / f64::from(self.behind) - 1.0
    }
}

/// What a chain is called: by a place on the lattice that it passes, so that the next frame's chain there is called the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub u64);

impl Id {
    /// What the names of hidden chains have before those of seen ones.
    const HIDDEN: u64 = 1 << 63;

    /// The name of a chain that is hidden, by one that seen ones may have too.
    pub(super) fn hidden(self) -> Self {
        Self(self.0 | Self::HIDDEN)
    }

    /// The name of a line on the land in a plan, where rims are named by samples.
    pub(super) fn of_land(self) -> Self {
        Self(self.0 | Self::HIDDEN >> 1)
    }

    /// As it is written, everywhere.
    pub fn written(self) -> String {
        format!("c{:x}", self.0)
    }

    /// Whether its chain is hidden by nearer land.
    pub fn is_hidden(self) -> bool {
        self.0 & Self::HIDDEN != 0
    }
}

/// An ordered polyline on the page; one point is a dot. Chains of [curves](super::curve) run as those do: what they draw the end
/// of lies on their left, what is behind on their right.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Unique in a frame; `None` of chains traced from pixels, which do not know where they were in the last one.
    pub id: Option<Id>,
    /// At least one point, about a pixel apart while unsmoothed.
    pub points: Vec<ChainPoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

impl Chain {
    /// Length of line, px.
    pub fn length(&self) -> f64 {
        self.pairs().map(|[a, b]| a.place.distance(b.place)).sum()
    }

    /// What most of its points draw; of equals the first in the order of [`Line`].
    pub fn line(&self) -> Line {
        let mut lines: Vec<Line> = self.points.iter().map(|point| point.line).collect();
        lines.sort_unstable();
        let runs = lines.chunk_by(|a, b| a == b);
        runs.rev().max_by_key(|run| run.len()).map_or(Line::Own(0), |run| run[0])
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Chain {
    /// Every point with the next one, the last of a closed chain with the first; a lone point with itself.
    pub fn pairs(&self) -> impl Iterator<Item = [&ChainPoint; 2]> {
        let lone = self.points.first().filter(|_| self.points.len() == 1).map(|point| [point; 2]);
        let closing = self.points.last().zip(self.points.first()).map(|(last, first)| [last, first]);
        let steps = self.points.windows(2).map(|pair| [&pair[0], &pair[1]]);
        steps.chain(closing.filter(|_| self.closed && lone.is_none())).chain(lone)
    }
}
