//! What a frame needs: which method over which facets, in which batches and passes, in how many pieces of the page.

pub(crate) mod batches;
pub(crate) mod detail;
pub(crate) mod frame;
mod hachures;
mod horizon;
pub(crate) mod left_out;
pub(crate) mod method;
pub(crate) mod passes;
pub(crate) mod pieces;
pub(crate) mod registry;

pub(crate) use batches::{Batch, batches};
pub use detail::Detail;
pub(crate) use frame::Frame;
pub use hachures::{Hachures, Light, LightAzimuth, Shade, Tone};
pub use method::{Border, Culling, Curves, LandLines, Method, SharedVertices, Visibility};
pub(crate) use passes::PassName;
pub(crate) use pieces::{PagePiece, Pieces};
pub use registry::MethodEntry;
pub(crate) use registry::Yields;

/// What is drawn, whatever the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// How fine facets are.
    pub detail: Detail,
    /// How silhouettes are found.
    pub method: Method,
    /// Whether the rim is drawn.
    pub border: Border,
    /// Whether curves are found too; those of a method that yields nothing else always are.
    pub curves: Curves,
    /// Whether lines on the land are laid over a frame that has curves.
    pub land: LandLines,
    /// How hachures look, where they are drawn.
    pub hachures: Option<Hachures>,
    /// Whether what cannot change the picture is left out.
    pub culling: Culling,
}

impl Plan {
    /// Silhouettes and border by `method`, leaving out what cannot change the picture.
    pub fn new(detail: impl Into<Detail>, method: Method, border: Border) -> Self {
        Self {
            detail: detail.into(),
            method,
            border,
            curves: Curves::Off,
            land: LandLines::Off,
            hachures: None,
            culling: Culling::On,
        }
    }

    /// The same with light that stays where it is for an eye that looks to this azimuth of the world, degrees.
    pub(crate) fn lit_for(self, azimuth: f64) -> Self {
        let lit = |hachures: Hachures| Hachures { light: hachures.light.seen_from(azimuth), ..hachures };
        Self { hachures: self.hachures.map(lit), ..self }
    }

    /// Whether its frames hold curves.
    pub(crate) fn has_curves(&self) -> bool {
        self.curves != Curves::Off || self.method.entry().yields == Yields::Curves
    }
}

/// The default method over facets as fine as the page asks, with border lines.
impl Default for Plan {
    fn default() -> Self {
        Self::new(Detail::default(), Method::default(), Border::default())
    }
}
