//! The sheet of paper: its size, its margins, and how the pixels of a frame lie on it.
//!
//! A frame fills the sheet less its margins and what stands around it. Its pixels are as wide as the area divided by their number, and square; so the
//! last row may stand over by less than one, half of that on either side.

use glam::{DVec2, UVec2};

use crate::error::{Error, Result, Setting};
use crate::message;

/// Papers by name, upright, mm.
pub const PAPERS: [(&str, [f64; 2]); 10] = [
    ("A0", [841.0, 1189.0]),
    ("A1", [594.0, 841.0]),
    ("A2", [420.0, 594.0]),
    ("A3", [297.0, 420.0]),
    ("A4", [210.0, 297.0]),
    ("A5", [148.0, 210.0]),
    ("A6", [105.0, 148.0]),
    ("letter", [215.9, 279.4]),
    ("legal", [215.9, 355.6]),
    ("tabloid", [279.4, 431.8]),
];

/// A sheet, in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Across and down.
    pub size: DVec2,
    /// Blank on all four sides.
    pub margin: f64,
    /// What stands between that and the frame.
    pub surround: Surround,
}

/// The room around a frame, within the margins, for rules and letters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surround {
    /// On the left and on the right, mm.
    pub sides: f64,
    /// Above, mm.
    pub head: f64,
    /// Below, mm.
    pub foot: f64,
    /// How large what stands there is: 1 on a sheet of A4.
    pub scale: f64,
}

impl Surround {
    /// No room at all.
    pub const NONE: Self = Self { sides: 0.0, head: 0.0, foot: 0.0, scale: 1.0 };

    /// What it takes of a sheet across and down, mm.
    pub fn size(&self) -> DVec2 {
        DVec2::new(2.0 * self.sides, self.head + self.foot)
    }
}

impl Sheet {
    /// Pixels of a frame for each millimetre, unless told otherwise: lines are found to some .01 mm.
    pub const FRAME_PX_PER_MM: f64 = 8.0;

    /// Width of a sheet of which nothing is known but a frame's pixels, mm: 1920 of these at 8 a millimetre.
    pub const WIDTH: f64 = 240.0;

    /// The sheet for a frame of so many pixels across and down: [`Self::WIDTH`] wide, without margins.
    pub fn for_frame([width, height]: [u32; 2]) -> Self {
        let height = Self::WIDTH * f64::from(height) / f64::from(width);
        Self { size: DVec2::new(Self::WIDTH, height), margin: 0.0, surround: Surround::NONE }
    }

    /// A larger sheet on which the same area has margins and a surround.
    pub fn surrounded(&self, margin: f64, surround: Surround) -> Self {
        Self { size: self.inner() + surround.size() + 2.0 * margin, margin, surround }
    }

    /// Size of that, mm.
    pub fn inner(&self) -> DVec2 {
        self.size - 2.0 * self.margin - self.surround.size()
    }

    /// Pixels across and down of a frame that fills the area, at least one, at about so many for each millimetre.
    pub fn frame(&self, px_per_mm: f64) -> [u32; 2] {
        let across = (self.inner().x * px_per_mm).round().max(1.0);
        self.frame_across(across)
    }

    fn frame_across(&self, across: f64) -> [u32; 2] {
        // A rounding of millimetres is no row.
        let down = (self.inner().y * across / self.inner().x - 1e-6).ceil().max(1.0);
        [across, down].map(|px| px as u32)
    }

    /// How the pixels of a frame lie on the sheet.
    pub fn placement(&self, frame: [u32; 2]) -> Placement {
        let px_per_mm = f64::from(frame[0]) / self.inner().x;
        let down = (self.surround.head - self.surround.foot) / 2.0;
        let centre = self.size / 2.0 + DVec2::new(0.0, down);
        Placement { px_per_mm, centre, frame_centre: UVec2::from(frame).as_dvec2() / 2.0 }
    }
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Sheet {
    /// Where lines may lie: its corners towards the top left and the bottom right.
    pub fn area(&self) -> [DVec2; 2] {
        let Surround { sides, head, foot, .. } = self.surround;
        [self.margin + DVec2::new(sides, head), self.size - self.margin - DVec2::new(sides, foot)]
    }

    /// Whether a frame fills the area.
    ///
    /// # Errors
    /// [`Error::Setting`] where it is longer or shorter by a pixel or more.
    pub fn check_frame(&self, [width, height]: [u32; 2]) -> Result<()> {
        let fitting = self.frame_across(f64::from(width));
        let down = self.inner().y * f64::from(width) / self.inner().x;
        if (f64::from(height) - down).abs() < 1.0 {
            return Ok(());
        }
        let [x, y] = self.inner().to_array().map(|mm| (mm * 10.0).round() / 10.0);
        let what = format!("{width}x{height} is not as the page less its margins, {x} x {y} mm");
        let fits = format!("{}x{}", fitting[0], fitting[1]);
        Err(Error::setting(Setting::Size, what, message!["use ", Setting::Size.at(fits), ", or leave it out"]))
    }
}

/// From pixels of a frame to millimetres of its sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Pixels for each millimetre.
    pub px_per_mm: f64,
    centre: DVec2,
    frame_centre: DVec2,
}

/// What other stages and tests look into.
#[doc(hidden)]
impl Placement {
    /// The place on the sheet of one in the frame.
    pub fn on_sheet(&self, place: DVec2) -> DVec2 {
        self.centre + (place - self.frame_centre) / self.px_per_mm
    }

    /// The place in the frame of one on the sheet.
    pub fn in_frame(&self, place: DVec2) -> DVec2 {
        self.frame_centre + (place - self.centre) * self.px_per_mm
    }
}
