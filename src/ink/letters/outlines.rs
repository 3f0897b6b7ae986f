//! Outlines of letters: Old Standard, regular.
//!
//! Method: harfrust shapes the text (kerning, ligatures where letters are not spaced out, marks on letters), skrifa gives
//! outlines in units of the font, whose curves become chords. Cost: some microseconds a letter.

use std::sync::OnceLock;

use glam::DVec2;
use harfrust::{Buffer, Feature, ShapeOptions, ShaperFont, Tag};
use skrifa::{DrawMemory, Font, GlyphId, PathSink, ScalerFont};

use super::along;
use crate::error::{Error, Result};

/// The font, under the licence beside it.
static BYTES: &[u8] = include_bytes!("OldStandard-Regular.ttf");
/// Height of capitals, em.
pub(super) const CAP_HEIGHT: f64 = 0.712;
/// How far letters reach below the baseline, em.
pub(super) const DESCENT: f64 = 0.23;
/// How far chords of curves may be off, mm.
const CHORD: f64 = 0.002;

/// Shapes and draws.
struct Letters {
    font: Font,
    scaler: ScalerFont,
}

/// The font, read once.
fn letters() -> Result<&'static Letters> {
    static LETTERS: OnceLock<Option<Letters>> = OnceLock::new();
    let read = || Font::new(BYTES, 0).map(|font| Letters { scaler: ScalerFont::unhinted(font.clone(), None), font });
    LETTERS.get_or_init(read).as_ref().ok_or_else(|| Error::mistake("the font of titles cannot be read"))
}

/// The first letter of a text that the font lacks.
pub(super) fn lacking(text: &str) -> Result<Option<char>> {
    let charmap = letters()?.font.charmap();
    Ok(text.chars().find(|letter| charmap.map_unicode(*letter).is_none_or(|glyph| glyph == GlyphId::NOTDEF)))
}

/// The rings of each letter of a text, `em` mm large, `spacing` em farther apart than usual.
pub(super) fn set(text: &str, em: f64, spacing: f64) -> Result<Vec<Vec<Vec<DVec2>>>> {
    let Letters { font, scaler } = letters()?;
    let mut buffer = Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    // Ligatures do not give way to spaces.
    let apart = [Feature::new(Tag::new(b"liga"), 0, ..)];
    let options = ShapeOptions::new().features(if spacing > 0.0 { &apart } else { &[] });
    harfrust::shape(&ShaperFont::new(font), &mut buffer, options)
        .map_err(|error| Error::mistake(format!("a title cannot be set: {error}")))?;
    let scale = em / f64::from(font.units_per_em());
    let (mut pen, mut set) = (DVec2::ZERO, Vec::new());
    for (glyph, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        let offset = DVec2::new(position.x_offset.into(), position.y_offset.into());
        let mut rings = Rings { origin: pen + offset, scale, rings: Vec::new() };
        if let Some(outline) = scaler.outline(GlyphId::new(glyph.glyph_id)) {
            let drawn = outline.draw(DrawMemory::Scratch, &mut rings);
            drawn.map_err(|error| Error::mistake(format!("a letter has no outline: {error}")))?;
        }
        rings.rings.iter_mut().for_each(|ring| ring.dedup());
        set.push(rings.rings);
        pen.x += f64::from(position.x_advance);
        if position.x_advance > 0 {
            pen.x += spacing * f64::from(font.units_per_em());
        }
    }
    set.retain(|rings: &Vec<Vec<DVec2>>| !rings.is_empty());
    Ok(set)
}

/// The rings of a glyph, in millimetres, y down.
struct Rings {
    /// Where the glyph stands, units of the font, y up.
    origin: DVec2,
    /// Millimetres of such a unit.
    scale: f64,
    rings: Vec<Vec<DVec2>>,
}

impl Rings {
    fn place(&self, x: f32, y: f32) -> DVec2 {
        (self.origin + DVec2::new(x.into(), y.into())) * DVec2::new(self.scale, -self.scale)
    }

    fn add(&mut self, places: impl IntoIterator<Item = DVec2>) {
        if let Some(ring) = self.rings.last_mut() {
            ring.extend(places);
        }
    }

    /// Where the way stands.
    fn last(&self) -> DVec2 {
        self.rings.last().and_then(|ring| ring.last()).copied().unwrap_or_default()
    }
}

impl PathSink for Rings {
    fn move_to(&mut self, x: f32, y: f32) {
        self.rings.push(vec![self.place(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add([self.place(x, y)]);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.add(along(self.last(), self.place(cx, cy), self.place(x, y), CHORD));
    }

    /// The font has quadratic curves alone; another one would be drawn by the middle of both controls.
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.quad_to((ax + bx) / 2.0, (ay + by) / 2.0, x, y);
    }

    fn close(&mut self) {}
}
