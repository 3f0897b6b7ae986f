//! Furniture as layers of a drawing: areas to fill, or strokes for pens.

use glam::DVec2;

use crate::ink::draw::layer;
use crate::ink::letters::{Face, Lettering};
use crate::ink::{Area, Drawing, Layer, Pen, Stroke, StrokeForm, StrokePoint, Style};

/// What its layers are called.
const NAME: &str = "furniture";

/// A rule around a rectangle, beyond these corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rule {
    pub low: DVec2,
    pub high: DVec2,
    /// mm.
    pub width: f64,
}

/// Furniture in its place on a sheet.
#[derive(Debug, Clone)]
pub struct Set {
    title: Option<String>,
    face: Face,
    rules: Vec<Rule>,
    /// Lines of text, each with the width of its pen.
    lines: Vec<(Lettering, f64)>,
}

impl Set {
    pub(super) fn new(title: Option<String>, face: Face) -> Self {
        Self { title, face, rules: Vec::new(), lines: Vec::new() }
    }

    pub(super) fn rule(&mut self, rule: Rule) {
        self.rules.push(rule);
    }

    pub(super) fn line(&mut self, line: Lettering, pen: f64) {
        self.lines.push((line, pen));
    }

    /// Puts it on top of a drawing in that style, in layers of its own: one, or one a pen; none where nothing is wanted.
    pub fn onto(self, drawing: &mut Drawing, style: &Style) {
        drawing.title = self.title.clone();
        let ink = Pen { opacity: 1.0, ..style.pens.silhouette };
        if self.face == Face::SingleStroke {
            for (pen, strokes) in self.by_pens(ink) {
                let name = format!("{} {NAME} {} mm", drawing.layers.len() + 1, pen.width);
                drawing.layers.push(layer(name, pen, strokes, &drawing.sheet, style));
            }
            return;
        }
        let areas = self.areas();
        if !areas.is_empty() {
            let name = format!("{} {NAME}", drawing.layers.len() + 1);
            let layer = layer(name, ink, Vec::new(), &drawing.sheet, style);
            drawing.layers.push(Layer { form: StrokeForm::Outlines, areas, ..layer });
        }
    }

    fn areas(self) -> Vec<Area> {
        let rules = self.rules.iter().map(Rule::area);
        let letters = self.lines.into_iter().flat_map(|(line, _)| line.letters).map(Area);
        rules.chain(letters).collect()
    }

    /// Strokes by the pen that draws them, the finest first.
    fn by_pens(self, ink: Pen) -> Vec<(Pen, Vec<Stroke>)> {
        let rules = self.rules.iter().map(|rule| (rule.width, rule.stroke()));
        let letters = self
            .lines
            .into_iter()
            .flat_map(|(line, pen)| line.letters.into_iter().flatten().map(move |places| (pen, stroke(places))));
        let strokes: Vec<(f64, Stroke)> = rules.chain(letters).collect();
        let mut pens: Vec<f64> = strokes.iter().map(|(pen, _)| *pen).collect();
        pens.sort_by(f64::total_cmp);
        pens.dedup();
        let of = |width: f64| {
            let own = strokes.iter().filter(|(pen, _)| *pen == width).map(|(_, stroke)| stroke.clone()).collect();
            (Pen { width, ..ink }, own)
        };
        pens.into_iter().map(of).collect()
    }
}

impl Rule {
    /// Its border inside and outside.
    fn area(&self) -> Area {
        let corners = |off: f64| corners(self.low - off, self.high + off);
        let (mut inside, outside) = (corners(0.0), corners(self.width));
        inside.reverse();
        Area(vec![outside, inside])
    }

    /// Its middle.
    fn stroke(&self) -> Stroke {
        let off = self.width / 2.0;
        let mut places = corners(self.low - off, self.high + off);
        places.push(places[0]);
        stroke(places)
    }
}

fn corners(low: DVec2, high: DVec2) -> Vec<DVec2> {
    vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

/// A stroke of even width, closed where it ends at its beginning.
fn stroke(mut places: Vec<DVec2>) -> Stroke {
    let closed = places.len() > 3 && places.first() == places.last();
    if closed {
        places.pop();
    }
    let points = places.into_iter().map(|place| StrokePoint { place, width: 1.0 }).collect();
    Stroke { chain: None, piece: 0, points, closed }
}
