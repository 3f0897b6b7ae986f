//! What a case may promise, and whether a promise was kept.

use serde::{Serialize, Serializer};

use super::limits;

/// A promise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Promise {
    /// Every frame comes about.
    Drawn,
    /// No number of a frame is endless or none.
    Finite,
    /// No pixel of the land is missed.
    Watertight,
    /// With tangents limited nothing folds.
    Unfolded,
    /// Ink lies on truth, and truth has ink.
    Accurate,
    /// Ink does not spread where truth has none.
    NoFlood,
    /// An eye that hardly moves hardly changes the ink.
    Conditioned,
    /// Land and eye shifted by whole cells, scaled by a power of two or raised by whole metres give the same bits.
    SameBits,
    /// Land and eye turned round or mirrored give the same ink.
    Turned,
    /// What differs then lies beside ink.
    TurnedFar,
    /// A frame of a flight is what it would be alone.
    Alone,
    /// Little pops from one frame of a flight to the next.
    Steady,
}

impl Promise {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Drawn,
        Self::Finite,
        Self::Watertight,
        Self::Unfolded,
        Self::Accurate,
        Self::NoFlood,
        Self::Conditioned,
        Self::SameBits,
        Self::Turned,
        Self::TurnedFar,
        Self::Alone,
        Self::Steady,
    ];
    /// Those of every case, unless it says otherwise.
    pub const OF_ALL: [Self; 7] =
        [Self::Drawn, Self::Finite, Self::Watertight, Self::Unfolded, Self::Accurate, Self::NoFlood, Self::Conditioned];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drawn => "drawn",
            Self::Finite => "finite",
            Self::Watertight => "watertight",
            Self::Unfolded => "unfolded",
            Self::Accurate => "accurate",
            Self::NoFlood => "no-flood",
            Self::Conditioned => "conditioned",
            Self::SameBits => "same-bits",
            Self::Turned => "turned",
            Self::TurnedFar => "turned-far",
            Self::Alone => "alone",
            Self::Steady => "steady",
        }
    }

    /// What is promised, in a sentence.
    pub fn says(self) -> &'static str {
        match self {
            Self::Drawn => "every frame comes about: nothing fails, hangs or is cut short",
            Self::Finite => {
                "no NaN and no infinity in any buffer of numbers, chain or stroke of a frame with creases and hachures"
            }
            Self::Watertight => "no pixel without a facet though five rays about its centre all meet the land",
            Self::Unfolded => "with tangents limited no patch folds over, and no facet of the frame",
            Self::Accurate => "F of walk and of contour at least 0.98 within 1 px, where truth has 200 px and more",
            Self::NoFlood => "ink of walk and of contour farther than 1 px from truth on at most 0.1 % of the page",
            Self::Conditioned => {
                "the eye moved by a millionth of its distance: at most 0.1 % of ink, in whole pixels, farther than 1 px from \
                 ink, less the same of truth"
            }
            Self::SameBits => {
                "shifted by whole cells, 8 times as large, or raised by whole metres: every bit of the frame is the same"
            }
            Self::Turned => {
                "turned by 180 degrees, or transposed and mirrored back: at most 0.05 % of the walk's ink, in whole pixels, \
                 differs"
            }
            Self::TurnedFar => "and none of it lies over 1 px from ink",
            Self::Alone => {
                "the second and the third frame of a flight have every bit of the frame drawn alone: depths, facets, ink, chains, \
                 creases and hachures"
            }
            Self::Steady => {
                "of three frames of a flight, a four-thousandth of the distance apart: at most 0.5 % of ink farther than 1 px from ink of the next, less \
                 the same of truth"
            }
        }
    }
}

impl Promise {
    /// The limit of all cases, and whether figures are to be no less in the place of no more.
    pub fn limit(self) -> (f64, bool) {
        match self {
            Self::Drawn
            | Self::Finite
            | Self::Watertight
            | Self::Unfolded
            | Self::SameBits
            | Self::TurnedFar
            | Self::Alone => (0.0, false),
            Self::Accurate => (limits::F, true),
            Self::NoFlood => (limits::ASTRAY, false),
            Self::Conditioned => (limits::POPPED, false),
            Self::Turned => (limits::TURNED, false),
            Self::Steady => (limits::UNSTEADY, false),
        }
    }

    /// Whether a method of this name is held to it. Adjacency inks by which of two facets smaller than a pixel a centre meets, and
    /// toward-away-wide by which of two nearly equal depths is nearer: a rounding turns that round. Curves move by hundredths of
    /// a pixel on land that is mirrored, which changes 1 to 4 % of their pixels for the next. These figures are told and
    /// promise nothing.
    pub fn is_of(self, method: &str) -> bool {
        match self {
            Self::Turned | Self::TurnedFar => method == "walk",
            Self::Steady => matches!(method, "walk" | "contour"),
            Self::Conditioned => !method.starts_with("adjacency") && method != "toward-away-wide",
            _ => true,
        }
    }
}

impl Serialize for Promise {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.name())
    }
}

/// What was measured of a promise, beside its limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Name of the case.
    pub case: &'static str,
    /// Name of its view.
    pub view: &'static str,
    /// Name of the method; `all` where it is none's own.
    pub method: &'static str,
    /// What was promised.
    pub promise: Promise,
    /// The figure.
    pub measured: f64,
    /// What it must not pass.
    pub limit: f64,
    /// Whether the figure is to be no less than the limit, in the place of no more.
    pub at_least: bool,
    /// Whether it was kept.
    pub kept: bool,
    /// What was counted, in words.
    pub of: String,
    /// Why its limit is another than that of all; empty of most.
    pub exception: &'static str,
}

impl Check {
    /// Whether the figure is a number on the right side of the limit.
    pub fn holds(measured: f64, limit: f64, at_least: bool) -> bool {
        if at_least { measured >= limit } else { measured <= limit }
    }

    /// Which case, view, method and promise, and the figure beside its limit.
    pub fn line(&self) -> String {
        let Self { case, view, method, promise, measured, limit, of, .. } = self;
        let (side, digits) = if self.at_least { ("at least", 4) } else { ("at most", 6) };
        let shown = |figure: f64| format!("{:.digits$}", figure).trim_end_matches('0').trim_end_matches('.').to_owned();
        let (measured, limit) = (shown(*measured), shown(*limit));
        format!("{case}, view {view}, {method}: {} is {measured}, promised {side} {limit} ({of})", promise.name())
    }
}

/// A method without ink keeps no promise, unless truth has none.
pub fn without_ink(checks: &mut [Check], inked: usize, truth_px: f64) {
    if inked == 0 && truth_px > 0.0 {
        for check in checks {
            check.kept = false;
            check.of = format!("no ink at all, {truth_px:.0} px of truth; {}", check.of);
        }
    }
}
