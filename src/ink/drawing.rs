//! The drawing as data: a page with layers, a layer with a pen and strokes.
//!
//! [`draw`] gives chains the width of ink drawings: lines thin with distance, and where little lies between them and what is
//! behind. So that far hills do not clot, traced lines thin where many crowd together, and contours by the weight that
//! [economy](crate::line::economy) leaves them.

use glam::DVec2;

use crate::line::{Chain, ChainPoint, Line, Lines, Recession};

/// Ink about a point, in px, up to which nothing is thinned: two lines side by side.
const ROOM: f64 = 18.0;

/// Width of a line with nothing but the same slope behind it, as a share of one against the sky.
const FLAT: f64 = 0.6;

/// Names of layers.
const BORDER: &str = "border";
const SILHOUETTE: &str = "silhouette";
const CREASE: &str = "crease";

/// A pen: one width, one colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Width of the nearest lines, px.
    pub width: f64,
    /// Red, green, blue, opacity.
    pub colour: [u8; 4],
}

/// How lines become strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// How far smoothing may move a line, px.
    pub tolerance: f64,
    /// For silhouettes.
    pub silhouette: Pen,
    /// For border lines.
    pub border: Pen,
    /// For creases and other lines of the world.
    pub crease: Pen,
    /// Colour of the page: red, green, blue, opacity.
    pub paper: [u8; 4],
    /// Width of the farthest lines as a share of the nearest, above 0 to 1.
    pub far_width: f64,
    /// Whether lone pixels are drawn, as dots; else they are left out as specks that say nothing.
    pub dots: bool,
}

impl Style {
    /// The style for a page this many pixels wide: warm black on warm paper, tolerance 0.6 px, far lines 0.35 as wide.
    ///
    /// The pen is 1.6 px at 1280 px and grows with the page: 1.6 * width / 1280; borders 0.8, creases 0.6 of it.
    pub fn for_page(width: u32) -> Self {
        let pen = |share: f64| Pen { width: share * 1.6 * f64::from(width) / 1280.0, colour: [38, 30, 24, 255] };
        Self {
            tolerance: 0.6,
            silhouette: pen(1.0),
            border: pen(0.8),
            crease: pen(0.6),
            paper: [251, 248, 240, 255],
            far_width: 0.35,
            dots: false,
        }
    }

    /// The layers from bottom to top, each with its pen.
    fn layers(&self) -> [(&'static str, Pen); 3] {
        [(BORDER, self.border), (SILHOUETTE, self.silhouette), (CREASE, self.crease)]
    }
}

/// A page of line work.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Page width, px.
    pub width: u32,
    /// Page height, px.
    pub height: u32,
    /// Colour of the page: red, green, blue, opacity.
    pub paper: [u8; 4],
    /// From bottom to top.
    pub layers: Vec<Layer>,
}

/// What one pen draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// One word, for editors and plotters.
    pub name: String,
    /// The pen.
    pub pen: Pen,
    /// In no particular order on the page, but the same in every run.
    pub strokes: Vec<Stroke>,
}

/// One line without lifting the pen; one point is a dot.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// At least one.
    pub points: Vec<StrokePoint>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

/// A point of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokePoint {
    /// Pixels from the page's top left corner, x right, y down.
    pub place: DVec2,
    /// Width here as a share of the pen's, 0 to 1; 0 at an end that runs out.
    pub width: f64,
}

/// The drawing of a page's lines.
///
/// Layers from bottom to top: `border`, `silhouette`, `crease`; one without a line is left out.
pub fn draw(lines: &Lines, style: &Style) -> Drawing {
    let of = |name: &str| {
        let chains = lines.chains.iter().filter(|chain| layer(chain.line()) == name);
        let drawn = chains.filter(|chain| style.dots || chain.points.len() > 1);
        drawn.flat_map(|chain| strokes(chain, style, &lines.recession)).collect()
    };
    let layers = style.layers().map(|(name, pen)| Layer { name: name.to_owned(), pen, strokes: of(name) });
    Drawing {
        width: lines.width,
        height: lines.height,
        paper: style.paper,
        layers: layers.into_iter().filter(|layer| !layer.strokes.is_empty()).collect(),
    }
}

/// The layer that a kind of line stands in.
fn layer(line: Line) -> &'static str {
    match line {
        Line::Occluding | Line::Skyline => SILHOUETTE,
        Line::Border => BORDER,
        Line::Shore | Line::Drainage | Line::Ridge | Line::Hachure | Line::Own => CREASE,
    }
}

/// The strokes of a chain: cut where it has no weight. Widths recede with depth, where the page is crowded with ink, and
/// where little lies behind.
fn strokes(chain: &Chain, style: &Style, recession: &Recession) -> Vec<Stroke> {
    let width = |point: &ChainPoint| {
        let receding = 1.0 - (1.0 - style.far_width) * recession.share(point);
        let roomy = (receding * (ROOM / f64::from(point.crowd.max(1))).sqrt().min(1.0)).max(style.far_width);
        roomy * f64::from(point.weight) * (FLAT + (1.0 - FLAT) * point.relief().sqrt())
    };
    let point = |point: &ChainPoint| StrokePoint { place: point.place, width: width(point) };
    let mut points: Vec<StrokePoint> = chain.points.iter().map(point).collect();
    let Some(first) = points.iter().position(|point| point.width == 0.0) else {
        return vec![Stroke { points, closed: chain.closed }];
    };
    if chain.closed {
        points.rotate_left(first);
        points.push(points[0]);
    }
    // Strokes run out to points without width; between two of those there is nothing.
    let pieces = points.chunk_by(|a, b| a.width > 0.0 || b.width > 0.0);
    let drawn = pieces.filter(|piece| piece.len() > 1);
    drawn.map(|piece| Stroke { points: piece.to_vec(), closed: false }).collect()
}
