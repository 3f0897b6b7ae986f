//! Letters as geometry: no reader of a drawing needs a font.
//!
//! Two faces: outlines of Old Standard, a type of the nineteenth century as maps were lettered with, and Hershey's Roman simplex, of
//! single strokes, for pens. Each stands in this folder with its licence.
//!
//! Does not handle: scripts that run from right to left, and lines that break by themselves.

mod outlines;
mod single_stroke;

use glam::DVec2;

use crate::error::Result;

/// How letters are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Of areas, to be filled.
    Outlines,
    /// Of lines that a pen follows.
    SingleStroke,
}

/// A line of text that is set, in millimetres from the left end of its baseline, x right, y down.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lettering {
    /// Of each letter that leaves ink its rings, which the non-zero rule fills together, or its strokes.
    pub letters: Vec<Vec<Vec<DVec2>>>,
}

impl Face {
    /// Height of capitals, em.
    pub fn cap_height(self) -> f64 {
        match self {
            Self::Outlines => outlines::CAP_HEIGHT,
            Self::SingleStroke => single_stroke::CAP_HEIGHT,
        }
    }

    /// How far letters reach below the baseline, em.
    pub fn descent(self) -> f64 {
        match self {
            Self::Outlines => outlines::DESCENT,
            Self::SingleStroke => single_stroke::DESCENT,
        }
    }

    /// Least em at which its small letters can be read, mm: 5 points, or as small as a pen of .3 mm writes.
    pub fn least(self) -> f64 {
        match self {
            Self::Outlines => 1.76,
            Self::SingleStroke => 2.4,
        }
    }

    /// The first letter of a text that it lacks.
    ///
    /// # Errors
    /// [`Error::Mistake`](crate::error::Error::Mistake) where the font is none.
    pub fn lacking(self, text: &str) -> Result<Option<char>> {
        match self {
            Self::Outlines => outlines::lacking(text),
            Self::SingleStroke => Ok(single_stroke::lacking(text)),
        }
    }

    /// Sets a text with an em of so many millimetres, letters so much of an em farther apart than usual. What the face lacks
    /// is left out.
    ///
    /// # Errors
    /// [`Error::Mistake`](crate::error::Error::Mistake) where the font is none.
    pub fn set(self, text: &str, em: f64, spacing: f64) -> Result<Lettering> {
        let letters = match self {
            Self::Outlines => outlines::set(text, em, spacing)?,
            Self::SingleStroke => single_stroke::set(text, em, spacing),
        };
        Ok(Lettering { letters })
    }
}

impl Lettering {
    /// Its corners towards the top left and the bottom right, by the ink; both at the origin where there is none.
    pub fn bounds(&self) -> [DVec2; 2] {
        let places = || self.letters.iter().flatten().flatten().copied();
        [places().reduce(DVec2::min).unwrap_or_default(), places().reduce(DVec2::max).unwrap_or_default()]
    }

    /// Width of its ink, mm.
    pub fn width(&self) -> f64 {
        let [low, high] = self.bounds();
        high.x - low.x
    }

    /// The same elsewhere.
    pub fn moved(mut self, by: DVec2) -> Self {
        self.letters.iter_mut().flatten().flatten().for_each(|place| *place += by);
        self
    }
}

/// Places along a quadratic curve from the first, which is left out, to the last; chords are off by no more than `within`.
fn along(from: DVec2, control: DVec2, to: DVec2, within: f64) -> impl Iterator<Item = DVec2> {
    let steps = ((from - 2.0 * control + to).length() / (4.0 * within)).sqrt().ceil().max(1.0) as u32;
    (1..=steps).map(move |step| {
        let share = f64::from(step) / f64::from(steps);
        from.lerp(control, share).lerp(control.lerp(to, share), share)
    })
}
