//! How much of the darkness of a page pops: is there in one frame and not in the next, though the line that it draws still is.
//!
//! Method: darkness is what a pen leaves along a line, its width times the length. Lines are looked at every quarter pixel, and
//! each look is projected from where it lies in the world onto the page of the other frame: a line that moves with the land
//! does not pop, however far. What is lost there is the look's width less that of the widest line within 1 px: a line that is
//! gone loses all, one that thins what it thins by. Truth, drawn as wide everywhere, is looked at in the same way: where its own
//! line is lost, hidden by nearer land or out from behind it, so may be what draws it. Strokes pop where they lose
//! darkness and the truth that they draw, within 1.5 px, loses nothing, or is not there at all. What comes pops as what goes does: ask
//! with the frames changed about.
//!
//! So the figure is that of the drawing itself, to some hundredths of a pixel, without the steps of pixels. Cost: some microseconds
//! a look. Does not handle: what is on one of the two pages only, which does not count; darkness that strokes side by side lose
//! or win together.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::looks::{along, on_page};
use crate::ink::Drawing;
use crate::line::{Chain, Lines};
use crate::truth::{Truth, TruthPiece};
use crate::view::cut::steps;
use crate::view::{Camera, Perspective};

/// Within this a line is where it was, px.
const HERE: f64 = 1.0;
/// Within this a stroke draws a line of truth, px.
const DRAWS: f64 = 1.5;
/// Metres to the near plane of depths; any would do.
const NEAR: f64 = 1.0;

/// A look at a line with a width.
#[derive(Debug, Clone, Copy)]
struct WideLook {
    place: DVec2,
    world: DVec3,
    /// Of line that it stands for, px.
    length: f64,
    /// Px; truth has 1 everywhere.
    width: f64,
}

/// The lines of a page, looked at.
pub struct Looked {
    perspective: Perspective,
    looks: Vec<WideLook>,
    /// Places of the looks.
    tree: RTree<GeomWithData<[f64; 2], usize>>,
}

/// Darkness, px of width times px of length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Popped {
    /// What may be seen from both eyes.
    pub darkness: f64,
    /// Of it, what the other frame has not.
    pub lost: f64,
    /// Of that, what truth has.
    pub popped: f64,
}

impl Looked {
    /// A drawing of lines that a camera sees, on a sheet without margins.
    pub fn of_strokes(camera: &Camera, lines: &Lines, drawing: &Drawing) -> Self {
        let perspective = Perspective::new(camera, NEAR);
        let size = [camera.width, camera.height];
        // Where on the land strokes lie say the chains they draw.
        let land = |look: super::looks::LineLook| GeomWithData::new(look.place.to_array(), look.world);
        let pairs = lines.chains.iter().flat_map(Chain::pairs);
        let land = RTree::bulk_load(pairs.flat_map(|pair| along(pair, &perspective)).map(land).collect());
        let placement = drawing.sheet.placement(size);
        let mut looks = Vec::new();
        for layer in &drawing.layers {
            let pen = layer.pen.width * layer.pen.opacity * placement.px_per_mm;
            for stroke in &layer.strokes {
                let closing = stroke.points.first().filter(|_| stroke.closed);
                let points: Vec<_> = stroke.points.iter().chain(closing).collect();
                for pair in points.windows(2) {
                    let [a, b] = [pair[0], pair[1]].map(|point| (placement.in_frame(point.place), point.width * pen));
                    looks.extend(steps(size, a.0, b.0).filter_map(|step| {
                        let place = a.0.lerp(b.0, step.middle);
                        let width = a.1 + (b.1 - a.1) * step.middle;
                        let world = land.nearest_neighbor(place.to_array())?.data;
                        Some(WideLook { place, world, length: step.length, width })
                    }));
                }
            }
        }
        Self::new(perspective, looks)
    }

    /// The truth of what a camera sees.
    pub fn of_truth(camera: &Camera, truth: &Truth) -> Self {
        let perspective = Perspective::new(camera, NEAR);
        let look = |piece: &TruthPiece| {
            let place = piece.middle();
            let world = perspective.unproject(place, NEAR / piece.distance);
            WideLook { place, world, length: piece.length(), width: 1.0 }
        };
        Self::new(perspective, truth.on_page().map(look).collect())
    }

    fn new(perspective: Perspective, looks: Vec<WideLook>) -> Self {
        let indexed = |(i, look): (usize, &WideLook)| GeomWithData::new(look.place.to_array(), i);
        let tree = RTree::bulk_load(looks.iter().enumerate().map(indexed).collect());
        Self { perspective, looks, tree }
    }

    /// Of each look, how much narrower the widest line of another page is there, px; `None` where that page does not show the
    /// place.
    pub fn lost(&self, other: &Self) -> Vec<Option<f64>> {
        let lost = |look: &WideLook| {
            let there = on_page(&other.perspective, look.world)?.to_array();
            let near = other.tree.locate_within_distance(there, HERE * HERE);
            let widest = near.map(|near| other.looks[near.data].width).fold(0.0, f64::max);
            Some((look.width - widest).max(0.0))
        };
        self.looks.par_iter().map(lost).collect()
    }

    /// What strokes lose towards another page, and what of it pops: where truth loses nothing, of whose looks `truth_lost`
    /// tells.
    pub fn popped(&self, other: &Self, truth: &Self, truth_lost: &[Option<f64>]) -> Popped {
        let of_look = |(look, lost): (&WideLook, Option<f64>)| {
            let Some(lost) = lost else { return Popped::default() };
            let mut drawn = truth.tree.locate_within_distance(look.place.to_array(), DRAWS * DRAWS);
            let is_truths = lost > 0.0 && drawn.any(|near| truth_lost[near.data] != Some(0.0));
            let lost = lost * look.length;
            Popped { darkness: look.width * look.length, lost, popped: if is_truths { 0.0 } else { lost } }
        };
        let all: Vec<Popped> = self.looks.par_iter().zip(self.lost(other)).map(of_look).collect();
        all.into_iter().fold(Popped::default(), Popped::and)
    }
}

impl Popped {
    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            darkness: self.darkness + other.darkness,
            lost: self.lost + other.lost,
            popped: self.popped + other.popped,
        }
    }
}
