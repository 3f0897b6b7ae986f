//! The registry of methods: all that the rest of the crate knows of one.
//!
//! A new method is a variant of [`Method`](super::Method), an entry here, its passes
//! ([`PassName`]) and what they cost ([`cost`](crate::measure::cost)). Names, help, lists,
//! reports and tests follow from the entry.

use super::PassName;

/// What is known of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodEntry {
    /// Its name in comparisons and reports, unique; file names hold it.
    pub name: &'static str,
    /// Its name where variants are chosen by settings of their own: they share it.
    pub family: &'static str,
    /// In a line: what it does, and what to expect.
    pub brief: &'static str,
    /// What tells it from a method of like name, in a few words; may be empty.
    pub aside: &'static str,
    /// In a sentence: which pixels it inks.
    pub rule: &'static str,
    /// What it yields.
    pub yields: Yields,
    /// What it needs of the raster.
    pub raster: Raster,
    /// Whether it knows where in a pixel the line runs.
    pub sub_pixel: bool,
    /// Its passes in their order.
    pub passes: &'static [PassName],
    /// Constants of its passes alone.
    pub constants: &'static [(&'static str, f64)],
    /// Whether away surface is rasterized wherever it touches a pixel.
    pub conservative: bool,
    /// Buffers of its own of a word a pixel, zero before each frame.
    pub words: &'static [&'static str],
    /// How its curve looks in plots.
    pub look: PlotLook,
}

/// What a method yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Yields {
    /// Pixels of ink.
    Ink,
    /// Curves: its ink is drawn of them.
    Curves,
}

/// What a method needs to know of each pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Raster {
    /// The nearest facet and its depth.
    Facets,
    /// The nearest depths of toward and of away surface.
    TwoDepths,
}

/// How a curve looks, told apart by each of the three alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlotLook {
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// Lengths of dash and gap, px; `None` for a full line.
    pub dash: Option<[i32; 2]>,
    /// What stands at its points.
    pub marker: Marker,
}

/// A mark at a point of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Marker {
    /// A filled circle.
    Disc,
    /// On a side.
    Square,
    /// On a side.
    Triangle,
    /// On a corner.
    Diamond,
    /// Two slanting strokes.
    Cross,
    /// Two strokes, upright and level.
    Plus,
}

pub(super) const WALK: MethodEntry = MethodEntry {
    name: "walk",
    family: "walk",
    brief: "Walk the lattice between neighbouring pixels: complete",
    aside: "",
    rule: "A pixel is ink if the straight way on the lattice from its point on the surface to a farther neighbour's \
           crosses a facet that faces away; where the page shows that elsewhere, the cut of the surface between the two must.",
    yields: Yields::Ink,
    raster: Raster::Facets,
    sub_pixel: true,
    passes: &[PassName::Candidates, PassName::Pairs, PassName::Walk, PassName::WalkRest],
    constants: &[],
    conservative: false,
    words: &[],
    look: PlotLook { colour: [26, 26, 26], dash: None, marker: Marker::Disc },
};

pub(super) const CONTOUR: MethodEntry = MethodEntry {
    name: "contour",
    family: "contour",
    brief: "Follow the silhouette curve, not a line of equal height: smooth and connected, but short lines are missing",
    aside: "",
    rule: "A pixel is ink if a visible part of the curve along which the surface turns away, or of its rim, passes through \
           it (Hertzmann and Zorin 2000).",
    yields: Yields::Curves,
    raster: Raster::Facets,
    sub_pixel: true,
    passes: &[],
    constants: &[],
    conservative: false,
    words: &[],
    look: PlotLook { colour: [196, 20, 60], dash: Some([9, 3]), marker: Marker::Plus },
};

pub(super) const TOWARD_AWAY: MethodEntry = MethodEntry {
    name: "toward-away",
    family: "toward-away",
    brief: "Compare toward and away depths: fast at low levels, with gaps",
    aside: "",
    rule: "A pixel is ink if its nearest toward surface is nearer than its nearest away surface, and that is nearer \
           than a neighbour's toward surface (Mower 2015).",
    yields: Yields::Ink,
    raster: Raster::TwoDepths,
    sub_pixel: false,
    passes: &[PassName::TowardAway],
    constants: &[("wide", 0.0)],
    conservative: false,
    words: &[],
    look: PlotLook { colour: [0, 90, 200], dash: Some([12, 4]), marker: Marker::Square },
};

pub(super) const TOWARD_AWAY_WIDE: MethodEntry = MethodEntry {
    name: "toward-away-wide",
    brief: "Compare toward and away depths, away surface wherever it touches the pixel: fewer gaps",
    rule: "The same as toward-away, with away surface counted wherever it touches the pixel or that neighbour.",
    constants: &[("wide", 1.0)],
    conservative: true,
    words: &["touched"],
    look: PlotLook { colour: [0, 110, 95], dash: Some([6, 4]), marker: Marker::Triangle },
    ..TOWARD_AWAY
};

pub(super) const ADJACENCY: MethodEntry = MethodEntry {
    name: "adjacency",
    family: "adjacency",
    brief: "Compare the facets of neighbouring pixels: floods small facets",
    aside: "facets that share an edge",
    rule: "A pixel is ink if a neighbour at least as far shows a facet that shares no lattice edge with its own \
           (Mower 2015).",
    yields: Yields::Ink,
    raster: Raster::Facets,
    sub_pixel: false,
    passes: &[PassName::Adjacency],
    constants: &[("shared_vertices", 2.0)],
    conservative: false,
    words: &[],
    look: PlotLook { colour: [184, 58, 0], dash: Some([3, 4]), marker: Marker::Diamond },
};

pub(super) const ADJACENCY_CORNER: MethodEntry = MethodEntry {
    name: "adjacency-corner",
    brief: "Compare the facets of neighbouring pixels, corners shared: floods less",
    aside: "",
    rule: "A pixel is ink if a neighbour at least as far shows a facet that shares no lattice vertex with its own \
           (Mower 2015).",
    constants: &[("shared_vertices", 1.0)],
    look: PlotLook { colour: [130, 40, 130], dash: Some([18, 6]), marker: Marker::Cross },
    ..ADJACENCY
};
