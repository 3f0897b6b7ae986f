//! The drawing as data: a page with layers, a layer with a pen and strokes.
//!
//! [`stroke`] gives chains the width of ink drawings: lines thin with distance, and where many crowd together, so that
//! far hills do not clot. Cost: a look at nine rows of pixels for each point.

use glam::DVec2;

use super::{Chain, ChainPoint, Line, Marks};

/// Half the side of the square in which ink counts as crowding, px.
const CROWD: i64 = 4;
/// Ink in that square, in px, up to which nothing is thinned: two lines side by side.
const ROOM: f64 = 18.0;
/// Least ratio of the farthest to the nearest ink that uses the whole range of widths.
const LEAST_RANGE: f64 = 2.0;
/// Longest piece of a stroke between two widths, px.
const STEP: f64 = 6.0;

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

    /// The pen and the layer name for a line.
    fn layer(&self, line: Line) -> (Pen, &'static str) {
        match line {
            Line::Silhouette => (self.silhouette, "silhouette"),
            Line::Border => (self.border, "border"),
            Line::Crease => (self.crease, "crease"),
        }
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
    /// Width here as a share of the pen's, above 0 to 1.
    pub width: f64,
}

/// How line width recedes from the near to the far ink of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recession {
    /// ln depth of the near ink.
    near: f64,
    /// ln depth of the far ink.
    far: f64,
}

impl Recession {
    /// From the nearest to the farthest ink, 5 % left out at either end; at least from one distance to twice that.
    pub fn of(marks: &Marks) -> Self {
        let mut depths: Vec<f32> = marks.ink().map(|mark| mark.pixel.depth()).collect();
        depths.retain(|&d| d > 0.0);
        depths.sort_unstable_by(f32::total_cmp);
        let quantile = |percent: usize| {
            let depth = depths.get(depths.len() * percent / 100).or(depths.last());
            f64::from(depth.copied().unwrap_or(1.0)).ln()
        };
        let near = quantile(95);
        Self { near, far: quantile(5).min(near - LEAST_RANGE.ln()) }
    }

    /// 0 for near ink, 1 for far ink, even in ln distance.
    fn of_point(&self, point: &ChainPoint) -> f64 {
        ((self.near - point.log_depth()) / (self.near - self.far)).clamp(0.0, 1.0)
    }
}

/// The layer of all chains of this line. Widths recede with depth and where the page is crowded with ink.
pub fn stroke(chains: &[Chain], line: Line, style: &Style, marks: &Marks, recession: Recession) -> Layer {
    let (pen, name) = style.layer(line);
    let width = |point: &ChainPoint| {
        let receding = 1.0 - (1.0 - style.far_width) * recession.of_point(point);
        (receding * (ROOM / crowd(marks, point.place)).sqrt().min(1.0)).max(style.far_width)
    };
    let strokes = chains
        .iter()
        .filter(|chain| chain.line == line && (style.dots || chain.points.len() > 1))
        .map(|chain| Stroke {
            points: stepped(chain).map(|p| StrokePoint { place: p.place, width: width(&p) }).collect(),
            closed: chain.closed,
        })
        .collect();
    Layer { name: name.to_owned(), pen, strokes }
}

/// The chain's points with others between them, so that widths can change at least every [`STEP`] px.
fn stepped(chain: &Chain) -> impl Iterator<Item = ChainPoint> {
    let next = |i: usize| chain.points.get(i + 1).or(chain.points.first().filter(|_| chain.closed));
    chain.points.iter().enumerate().flat_map(move |(i, a)| {
        let b = next(i).unwrap_or(a);
        let steps = (a.place.distance(b.place) / STEP).ceil().max(1.0) as u32;
        (0..steps).map(move |s| {
            let t = f64::from(s) / f64::from(steps);
            let log = a.log_depth() + (b.log_depth() - a.log_depth()) * t;
            ChainPoint { place: a.place.lerp(b.place, t), depth: log.exp() as f32 }
        })
    })
}

/// Inked pixels in the square about a place.
fn crowd(marks: &Marks, place: DVec2) -> f64 {
    let (column, row) = (place.x.floor() as i64, place.y.floor() as i64);
    let in_row = |row: i64| {
        let first = marks.row(row).partition_point(|mark| i64::from(mark.column) < column - CROWD);
        let near = marks.row(row)[first..].iter().take_while(|mark| i64::from(mark.column) <= column + CROWD);
        near.filter(|mark| mark.pixel.is_ink()).count()
    };
    (row - CROWD..=row + CROWD).map(in_row).sum::<usize>().max(1) as f64
}
