//! What is said of a plot: how far its pens go, and how long that takes.

use super::progress::duration;
use super::talk::Talk;
use crate::error::Result;
use crate::ink::plot::Journey;
use crate::ink::style::Plot;
use crate::ink::{Drawing, Layer, StrokeForm};

/// Says what the pens of a plotter will do with the layers of lines for them, where a style is meant for plotters.
///
/// # Errors
/// As [`Talk::say`].
pub(crate) fn tell(drawing: &Drawing, plotter: &Plot, talk: &Talk) -> Result<()> {
    let is_line = |layer: &&Layer| layer.form == StrokeForm::CentreLines;
    let layers: Vec<&Layer> = drawing.layers.iter().filter(is_line).collect();
    if layers.is_empty() || !plotter.centre_lines {
        return Ok(());
    }
    let journey: Journey = layers.iter().map(|layer| Journey::through(&layer.strokes)).sum();
    let found: Journey = layers.iter().map(|layer| layer.found).sum();
    talk.say(&format!(
        "plot: {} with the pen down, {} up ({} as found), {} strokes in {} layers, {} at {} mm/s",
        metres(journey.drawn),
        metres(journey.travel),
        metres(found.travel),
        journey.strokes,
        layers.len(),
        duration(journey.seconds(plotter)),
        plotter.speed
    ))
}

fn metres(mm: f64) -> String {
    format!("{:.2} m", mm / 1000.0)
}
