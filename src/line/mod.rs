//! The lines of a page as data: curves with a kind, places on the page and in the world.
//!
//! What a frame of a mask method leaves behind is an [`InkRaster`]: ink, kind, sub-pixel place and depth a pixel. Its ink
//! as a list, [`Marks`], from one raster or the pieces of a large page, is traced to [`Chain`]s, these are smoothed
//! within a stated tolerance, and the ink about their points is counted: the [`Lines`] of the page, all that stroking
//! needs. Chains may come from elsewhere too: [`visible::chains`] are what the eye sees of [`Curve`]s on the surface, among them
//! lines on the [`Land`] that were [`Laid`] on its facets.

mod along;
mod cells;
pub(crate) mod chain;
pub(crate) mod clearance;
pub(crate) mod cover;
mod crossing;
pub(crate) mod crowd;
pub(crate) mod curve;
pub(crate) mod detail;
mod doubt;
pub(crate) mod economy;
pub(crate) mod ends;
mod folds;
mod graph;
mod grid;
pub(crate) mod hachures;
pub(crate) mod identity;
mod join;
mod labels;
pub(crate) mod lack;
pub(crate) mod laid;
pub(crate) mod link;
pub(crate) mod mapped;
pub(crate) mod marks;
pub(crate) mod merit;
pub(crate) mod near;
pub(crate) mod one_pixel;
pub(crate) mod overhead;
pub(crate) mod raster;
pub(crate) mod recession;
mod rest;
mod shown;
mod simplify;
pub(crate) mod smooth;
pub(crate) mod strays;
mod thin;
mod tone;
pub(crate) mod trace;
pub(crate) mod visible;
pub(crate) mod way;

pub use chain::{Chain, ChainPoint, Id, Line};
pub(crate) use crowd::crowded;
pub use curve::{Bound, Curve, CurvePoint, Sight, Stretch};
pub use detail::Land;
pub use economy::Economy;
pub(crate) use economy::economised;
pub(crate) use lack::{Lack, Little};
pub(crate) use laid::Laid;
pub(crate) use link::link;
pub use mapped::{MappedLine, mapped};
pub use marks::{Mark, Marks};
pub(crate) use merit::{Merit, merits};
pub(crate) use near::{Near, near};
pub(crate) use one_pixel::one_pixel_wide;
pub(crate) use overhead::Overhead;
pub use raster::{InkRaster, Kind, Pixel};
pub use recession::Recession;
pub(crate) use rest::rest;
pub(crate) use smooth::smooth;
pub use strays::Strays;
pub(crate) use tone::toned;
pub(crate) use trace::trace;

use glam::DVec3;

use crate::view::Perspective;

/// The lines of a page, ready to be stroked.
#[derive(Debug, Clone, PartialEq)]
pub struct Lines {
    /// Page width, px.
    pub width: u32,
    /// Page height, px.
    pub height: u32,
    /// Where from they are seen, metres of the exaggerated world.
    pub eye: DVec3,
    /// In no particular order on the page, but the same in every run.
    pub chains: Vec<Chain>,
    /// What nearer land hides.
    pub hidden: Vec<Chain>,
    /// From near to far.
    pub recession: Recession,
    /// What the layers of the user's own lines are called, by their numbers.
    pub own: Vec<String>,
}

impl Lines {
    /// Traces the ink of a page, smooths within `tolerance` px, counts crowds.
    pub fn of(marks: &Marks, perspective: &Perspective, tolerance: f64) -> Self {
        let chains = smooth(&trace(marks, perspective), perspective, tolerance);
        Self {
            width: marks.width,
            height: marks.height,
            eye: perspective.eye(),
            hidden: Vec::new(),
            chains: crowded(&chains, marks, perspective),
            recession: Recession::of(marks.depths().map(|depth| (depth, 1.0))),
            own: Vec::new(),
        }
    }

    /// The lines of a page from chains of curves that are seen so, drawn as sparingly as `economy` says; hidden ones, behind
    /// which nothing is known, by their gaps alone.
    pub fn sparing(chains: &[Chain], hidden: &[Chain], perspective: &Perspective, economy: &Economy) -> Self {
        let chains = economised(chains, economy);
        let hidden = economised(hidden, &Economy { min_jump: 0.0, ..*economy });
        // A line that fades in or out takes its share along.
        let inked = |[a, b]: [&ChainPoint; 2]| (a.depth, a.place.distance(b.place) * f64::from(a.weight + b.weight));
        // Lines on the land do not move the widths of others.
        let of_surface = chains.iter().filter(|chain| !chain.line().is_of_land());
        let inked = of_surface.flat_map(Chain::pairs).map(inked);
        let [width, height] = perspective.size().to_array().map(|px| px as u32);
        let recession = Recession::of(inked);
        Self { width, height, eye: perspective.eye(), chains, hidden, recession, own: Vec::new() }
    }
}
