//! How large rules and letters are.

use glam::DVec2;

use super::layers::Rule;
use crate::ink::Style;

/// Square root of the area of an A4 sheet less usual margins, mm.
const A4: f64 = 229.0;
/// Least and greatest scale.
const SCALES: [f64; 2] = [0.3, 4.0];
/// On A4, mm: the em of titles, view lines, credits; the thin rule, the gap and the thick rule.
const TITLE: f64 = 7.6;
const VIEW_LINE: f64 = 3.1;
const CREDITS: f64 = 2.5;
const THIN: f64 = 0.18;
const GAP: f64 = 0.85;
const THICK: f64 = 0.75;
/// Width of a stem of a single stroke, em.
const STEM: f64 = 0.085;

/// Sizes on a sheet, mm.
#[derive(Debug, Clone)]
pub(super) struct Sizes {
    /// 1 on A4.
    pub scale: f64,
    /// Em of the title.
    pub title: f64,
    /// Em of the view line.
    pub view_line: f64,
    /// Em of the credits.
    pub credits: f64,
    /// Widths of pens at hand, from fine to broad; none where areas are filled.
    pens: Vec<f64>,
    thin: f64,
    gap: f64,
    /// Of which the thick rule consists, and how broad each is.
    thick: (u32, f64),
}

impl Sizes {
    /// For what is so large across and down.
    pub(super) fn of(size: DVec2, style: &Style) -> Self {
        let [least, most] = SCALES;
        Self::scaled((size.x * size.y).max(0.0).sqrt().clamp(least * A4, most * A4) / A4, style)
    }

    /// At a scale: what is read from near grows little, titles with the sheet.
    pub(super) fn scaled(scale: f64, style: &Style) -> Self {
        let small = scale.sqrt();
        let pens = match (style.plot.centre_lines, style.plot.widths.is_empty()) {
            (false, _) => Vec::new(),
            (true, true) => vec![style.pens.silhouette.width],
            (true, false) => style.plot.widths.clone(),
        };
        let (thin, thick) = match (pens.first(), pens.last()) {
            (Some(fine), Some(broad)) => (*fine, ((THICK * small / broad).round().max(1.0) as u32, *broad)),
            _ => (THIN * small, (1, THICK * small)),
        };
        let least = super::face(style).least();
        // Pens are blunter than outlines.
        let for_pens = if pens.is_empty() { 1.0 } else { 1.2 };
        Self {
            scale,
            title: TITLE * scale.powf(0.75),
            view_line: (VIEW_LINE * small * for_pens).max(least),
            credits: (CREDITS * small * for_pens).max(least),
            pens,
            thin,
            gap: GAP * small,
            thick,
        }
    }

    /// How far the neatline reaches from the picture.
    pub(super) fn neatline(&self) -> f64 {
        self.thin + self.gap + f64::from(self.thick.0) * self.thick.1
    }

    /// The rules around a picture between these corners, from the inside to the outside.
    pub(super) fn rules(&self, [low, high]: [DVec2; 2]) -> Vec<Rule> {
        let around = |off: f64, width: f64| Rule { low: low - off, high: high + off, width };
        let (count, broad) = self.thick;
        let thick = (0..count).map(|i| around(self.thin + self.gap + f64::from(i) * broad, broad));
        std::iter::once(around(0.0, self.thin)).chain(thick).collect()
    }

    /// The pen of small letters; 0 where areas are filled.
    pub(super) fn pen(&self) -> f64 {
        self.pens.first().copied().unwrap_or(0.0)
    }

    /// The pen of a title.
    pub(super) fn title_pen(&self, em: f64) -> f64 {
        let off = |pen: &f64| (pen - STEM * em).abs();
        self.pens.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0.0)
    }
}
