//! From inked pixels to pen strokes: the drawing.
//!
//! Lines are data until the last step. What a frame leaves behind is an [`InkRaster`]: ink, kind, sub-pixel place and
//! depth a pixel. Its ink as a list, [`Marks`], from one raster or the pieces of a large page, is traced to [`Chain`]s,
//! these are smoothed within a stated tolerance and stroked: a [`Drawing`] is a page with layers, a layer has a pen and
//! strokes. Only the writers know file formats. Chains may come from elsewhere too: [`project_polyline`] makes them from
//! polylines of the world, hidden by the cover.

pub mod chain;
pub mod drawing;
mod graph;
mod grid;
mod join;
pub mod marks;
pub mod mask;
pub mod overlay;
pub mod png;
pub mod raster;
pub mod smooth;
mod thin;

pub use chain::{Chain, ChainPoint, Line, trace};
pub use drawing::{Drawing, Layer, Pen, Recession, Stroke, StrokePoint, Style, stroke};
pub use marks::{Mark, Marks};
pub use mask::write_mask;
pub use overlay::{Cover, project_polyline};
pub use png::write_png;
pub use raster::{InkRaster, Kind, Pixel};
pub use smooth::smooth;

/// The drawing of a page's ink: trace, smooth, stroke.
///
/// Layers from bottom to top: `border`, `silhouette`; one without a line is left out. Further layers (creases) are
/// made of other chains with [`stroke`] and pushed.
pub fn draw(marks: &Marks, style: &Style) -> Drawing {
    let chains = smooth(&trace(marks), style.tolerance);
    let recession = Recession::of(marks);
    let layers = [Line::Border, Line::Silhouette]
        .into_iter()
        .map(|line| stroke(&chains, line, style, marks, recession))
        .filter(|layer| !layer.strokes.is_empty())
        .collect();
    Drawing { width: marks.width, height: marks.height, paper: style.paper, layers }
}
