//! From the lines of a page to a drawing: which layers there are, and what stands in them.
//!
//! Each kind of line has a layer with a pen; distances may split it, and where lines of varying width are drawn by pens of
//! one width, so do those. From bottom to top, which is the order of plotting: hidden lines, lines on the
//! land, borders, silhouettes, of each the farthest first and the finest.

use std::collections::{BTreeMap, HashSet};

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::strokes::{InkPoint, Inking, PenRun, inset};
use super::wobble::Hand;
use super::{Drawing, Layer, Pen, Sheet, Stroke, StrokeForm, StrokePoint, Style, plot};
use crate::error::{Error, Result, Setting};
use crate::line::{Chain, Id, Line, Lines, ends};
use crate::message;

/// Most strokes of a drawing.
const MOST_STROKES: f64 = 4e6;
/// A part of a line that is shorter is drawn with the pen of what lies beside it, mm.
const SHORT: f64 = 40.0;
/// A part too fine for every pen that is shorter is drawn, mm.
const GAP: f64 = 1.5;
/// Length of an arm of a registration mark, mm.
const MARK: f64 = 4.0;

/// What a layer draws, from bottom to top.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum LayerKind {
    Hidden,
    Hachure,
    Shore,
    Drainage,
    Ridge,
    /// Of the layer of this number.
    Own(u16),
    Border,
    Silhouette,
}

impl LayerKind {
    /// All but the user's own.
    const NAMED: [Self; 7] =
        [Self::Hidden, Self::Hachure, Self::Shore, Self::Drainage, Self::Ridge, Self::Border, Self::Silhouette];

    /// What shows a kind of line.
    fn of(line: Line) -> Self {
        match line {
            Line::Occluding | Line::Skyline => Self::Silhouette,
            Line::Border => Self::Border,
            Line::Shore => Self::Shore,
            Line::Drainage => Self::Drainage,
            Line::Ridge => Self::Ridge,
            Line::Own(layer) => Self::Own(layer),
            Line::Hachure => Self::Hachure,
        }
    }

    /// What its layer is called, given the names of the user's own.
    fn name(self, own: &[String]) -> &str {
        match self {
            Self::Hidden => "hidden",
            Self::Border => "border",
            Self::Silhouette => "silhouette",
            Self::Shore => "shore",
            Self::Drainage => "drainage",
            Self::Ridge => "ridge",
            Self::Own(layer) => own.get(usize::from(layer)).map_or("own", String::as_str),
            Self::Hachure => "hachure",
        }
    }

    fn pen(self, style: &Style, own: &[String]) -> Pen {
        match self {
            Self::Hidden => style.pens.hidden,
            Self::Border => style.pens.border,
            Self::Silhouette => style.pens.silhouette,
            Self::Shore => style.pens.shore,
            Self::Drainage => style.pens.drainage,
            Self::Ridge => style.pens.ridge,
            Self::Own(layer) => own.get(usize::from(layer)).map_or(style.pens.own, |name| style.pens.of_own(name)),
            Self::Hachure => style.pens.hachure,
        }
    }
}

/// A run, and the chain it draws.
type Named = (Option<Id>, PenRun);

/// The drawing of a page's lines on a sheet that its frame fills; layers without a line are left out. `split` gives
/// distances from the eye, metres, which rise: each kind of line has a layer for every zone between them.
///
/// # Errors
/// [`Error::Limit`] where the style asks for more strokes than a drawing holds.
pub fn draw(lines: &Lines, sheet: &Sheet, style: &Style, split: &[f64]) -> Result<Drawing> {
    let inking = Inking {
        placement: sheet.placement([lines.width, lines.height]),
        area: sheet.area(),
        weight: &style.weight,
        far_hachures: style.hachures.far,
        recession: &lines.recession,
        hand: Hand(style.wobble),
        eye: lines.eye,
    };
    check_dashes(lines, &inking, style)?;
    let free = ends::free(&lines.chains, [lines.width, lines.height]);
    let mut layers: Vec<Layer> = Vec::new();
    let mut pieces = FxHashMap::default();
    let mut kinds = BTreeMap::from([(LayerKind::Hidden, Vec::new())]);
    for (chain, free) in lines.chains.iter().zip(&free) {
        kinds.entry(LayerKind::of(chain.line())).or_default().push((chain, *free));
    }
    let own = names(&lines.own);
    for (kind, chains) in kinds {
        let runs = match kind {
            LayerKind::Hidden => of_each(lines.hidden.iter(), |chain| inking.dashed(chain, &style.dashes)),
            _ => {
                let drawn = chains.into_iter().filter(|(chain, _)| style.dots || chain.points.len() > 1);
                drawn.flat_map(|(chain, free)| of_each([chain], |chain| inking.weighed(chain, free))).collect()
            }
        };
        let whole = kind.pen(style, &lines.own);
        for (zone, runs) in by_distance(runs, split) {
            for (width, runs) in by_width(runs, whole, style) {
                let pen = Pen { width: width.unwrap_or(whole.width), ..whole };
                let words = [zone_name(zone, split), width.map(|width| format!("{width} mm"))];
                let number = format!("{} {}", layers.len() + 1, kind.name(&own));
                let name = [number].into_iter().chain(words.into_iter().flatten()).collect::<Vec<_>>().join(" ");
                let finished = |(id, run)| inking.finished(run, pen.width).into_iter().map(move |run| (id, run));
                let finished = runs.into_iter().flat_map(finished);
                let strokes: Vec<Stroke> = finished.map(|(id, run)| stroke(id, &mut pieces, &run)).collect();
                if !strokes.is_empty() {
                    layers.push(layer(name, pen, strokes, sheet, style));
                }
            }
        }
    }
    Ok(Drawing { sheet: *sheet, paper: style.paper, layers, title: None, seal: None })
}

/// Names of layers of the user's own lines, each once: what is taken is counted.
fn names(own: &[String]) -> Vec<String> {
    let mut taken: HashSet<String> = LayerKind::NAMED.map(|kind| kind.name(&[]).to_owned()).into();
    let mut free = |name: &String| {
        let counted = (2..).map(|count| format!("{name} {count}"));
        let name = std::iter::once(name.clone()).chain(counted).find(|name| !taken.contains(name)).unwrap_or_default();
        taken.insert(name.clone());
        name
    };
    own.iter().map(&mut free).collect()
}

/// The runs of each chain, with its name.
fn of_each<'a>(chains: impl IntoIterator<Item = &'a Chain>, runs: impl Fn(&Chain) -> Vec<PenRun>) -> Vec<Named> {
    chains.into_iter().flat_map(|chain| runs(chain).into_iter().map(|run| (chain.id, run))).collect()
}

/// Whether hidden lines fall into more dashes than a drawing holds.
fn check_dashes(lines: &Lines, inking: &Inking, style: &Style) -> Result<()> {
    let length: f64 = lines.hidden.iter().map(|chain| inking.even(chain).length()).sum();
    let dashes = length / (style.dashes.dash + style.dashes.gap);
    if dashes <= MOST_STROKES {
        return Ok(());
    }
    let what = format!("hidden lines fall into {dashes:.0} dashes; a drawing holds {MOST_STROKES} strokes");
    Err(Error::limit(what, message!["lengthen `dashes` of ", Setting::Style, " or leave out ", Setting::Hidden]))
}

/// Runs by zones of distance, the farthest first.
fn by_distance(runs: Vec<Named>, split: &[f64]) -> impl Iterator<Item = (usize, Vec<Named>)> {
    let mut zones: BTreeMap<usize, Vec<Named>> = BTreeMap::new();
    for (id, run) in runs {
        for (zone, run) in run.banded(split, |point| point.distance) {
            zones.entry(zone).or_default().push((id, run));
        }
    }
    zones.into_iter().rev()
}

/// What a zone of distance is called, if there are several.
fn zone_name(zone: usize, split: &[f64]) -> Option<String> {
    let km = |bound: usize| split[bound] / 1000.0;
    match zone {
        _ if split.is_empty() => None,
        0 => Some(format!("to {} km", km(0))),
        last if last == split.len() => Some(format!("beyond {} km", km(last - 1))),
        zone => Some(format!("{} to {} km", km(zone - 1), km(zone))),
    }
}

/// Runs by the width of the pen that draws them, the finest first: as wide as that everywhere. `None` where one pen draws
/// lines of all widths.
fn by_width(runs: Vec<Named>, pen: Pen, style: &Style) -> Vec<(Option<f64>, Vec<Named>)> {
    if !style.plot.centre_lines {
        return vec![(None, runs)];
    }
    let widths = if style.plot.widths.is_empty() { vec![pen.width] } else { style.plot.widths.clone() };
    // What thins to half the finest pen is not drawn from there on.
    let bounds =
        [widths[0].min(pen.width) / 2.0].into_iter().chain(widths.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0));
    let bounds: Vec<f64> = bounds.map(|bound| bound / pen.width).collect();
    let mut layers: Vec<Vec<Named>> = vec![Vec::new(); widths.len()];
    for (id, run) in runs {
        for (band, run) in settled(run.banded(&bounds, |point| point.width)) {
            if let Some(pen) = band.checked_sub(1) {
                layers[pen].push((id, run.evened()));
            }
        }
    }
    widths.into_iter().map(Some).zip(layers).collect()
}

/// Parts of one run by pens, 0 for none, without short ones between longer ones: these are drawn as the longest beside them.
fn settled(parts: Vec<(usize, PenRun)>) -> Vec<(usize, PenRun)> {
    let measured = |(pen, run): (usize, PenRun)| (pen, run.length(), run);
    let mut parts: Vec<(usize, f64, PenRun)> = parts.into_iter().map(measured).collect();
    loop {
        let drawn = |i: usize| parts.get(i).filter(|part| part.0 > 0).map(|part| (part.1, i));
        let beside = |i: usize| [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(drawn);
        let joins = |i: usize| {
            let (gap, length) = (parts[i].0 == 0, parts[i].1);
            let longest = beside(i).max_by(|a, b| a.0.total_cmp(&b.0))?;
            let is_short = if gap { length < GAP && beside(i).count() == 2 } else { length < SHORT.min(longest.0) };
            is_short.then_some((i, parts[longest.1].0))
        };
        let Some((short, pen)) = (0..parts.len()).find_map(joins) else {
            return parts.into_iter().map(|(pen, _, run)| (pen, run)).collect();
        };
        parts[short].0 = pen;
        // Beside it at most two are of the same pen now.
        let first = short.saturating_sub(1);
        for next in (first + 1..parts.len().min(short + 2)).rev() {
            if parts[next - 1].0 == parts[next].0 {
                let (_, length, run) = parts.remove(next);
                parts[next - 1].1 += length;
                parts[next - 1].2.points.extend(run.points.into_iter().skip(1));
            }
        }
    }
}

/// The stroke of a run, one piece of its chain more.
fn stroke(chain: Option<Id>, pieces: &mut FxHashMap<Id, u32>, run: &PenRun) -> Stroke {
    let point = |point: &InkPoint| StrokePoint { place: point.place, width: point.width };
    let next = chain.map(|chain| pieces.entry(chain).or_default());
    let piece = next.map_or(0, |next| std::mem::replace(next, *next + 1));
    Stroke { chain, piece, points: run.points.iter().map(point).collect(), closed: run.closed }
}

/// A layer, in the order of plotting where a pen follows its lines.
pub(super) fn layer(name: String, pen: Pen, mut strokes: Vec<Stroke>, sheet: &Sheet, style: &Style) -> Layer {
    if style.plot.registration {
        strokes.extend(marks(sheet, style.broadest()));
    }
    let is_even = strokes.iter().flat_map(|stroke| &stroke.points).all(|point| point.width == 1.0);
    let found = plot::Journey::through(&strokes);
    match is_even {
        true => Layer {
            name,
            pen,
            form: StrokeForm::CentreLines,
            found,
            strokes: plot::planned(strokes),
            areas: Vec::new(),
        },
        false => Layer { name, pen, form: StrokeForm::Outlines, found, strokes, areas: Vec::new() },
    }
}

/// Brackets in the corners of the area, by which one layer is laid over another: in the same places whatever the pen, if
/// `pen` is the broadest.
fn marks(sheet: &Sheet, pen: f64) -> impl Iterator<Item = Stroke> {
    let [low, high] = sheet.area();
    let (low, high) = (low + inset(pen), high - inset(pen));
    let arm = ((high - low).min_element() / 2.0).clamp(0.0, MARK);
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    corners.into_iter().filter(move |_| arm > 0.0).map(move |corner| {
        let inward = ((low + high) / 2.0 - corner).signum() * arm;
        let places = [corner + DVec2::new(inward.x, 0.0), corner, corner + DVec2::new(0.0, inward.y)];
        let points = places.map(|place| StrokePoint { place, width: 1.0 }).to_vec();
        Stroke { chain: None, piece: 0, points, closed: false }
    })
}
