//! A drawing as SVG: a group for each layer, a path for each stroke, a unit for each millimetre.
//!
//! Groups are layers to Inkscape and to programs for plotters. A path is called after the chain it draws, `c` and its
//! number, then which piece of it: so scripts find it again in the next frame. Nothing but paths: no text, clips, masks,
//! transforms, and no paper. Letters are paths too, one each. What a drawing is called is its title; where it has a seal, metadata
//! tell what made it.
//!
//! Cost: .2 s for a million points of outlines on two cores; memory for two pieces of a layer a core.

use std::io::{self, Write};

use super::paths::{Path, borders, in_order, micrometres, number, paths};
use super::{Drawing, Layer, Seal, Sheet, Stroke, StrokeForm};

/// Writes the drawing; lengths are in micrometres as decimals of a millimetre.
///
/// Errors are those of the writer.
pub fn write_svg(drawing: &Drawing, mut out: impl Write) -> io::Result<()> {
    out.write_all(head(&drawing.sheet).as_bytes())?;
    let called = drawing.title.as_ref().map(|title| format!("<title>{}</title>\n", escaped(title)));
    called.map_or(Ok(()), |called| out.write_all(called.as_bytes()))?;
    drawing.seal.as_ref().map_or(Ok(()), |seal| out.write_all(metadata(seal).as_bytes()))?;
    for (i, layer) in drawing.layers.iter().enumerate() {
        out.write_all(group(i + 1, layer).as_bytes())?;
        in_order(&layer.strokes, |piece| elements(piece, layer)).try_for_each(|text| out.write_all(&text))?;
        for area in &layer.areas {
            let mut text = b"<path".to_vec();
            write_paths(&borders(area), &mut text);
            out.write_all(&text)?;
        }
        out.write_all(b"</g>\n")?;
    }
    out.write_all(b"</svg>\n")?;
    out.flush()
}

fn head(sheet: &Sheet) -> String {
    let [width, height] = sheet.size.to_array().map(decimal);
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n"
    )
}

/// What made it.
fn metadata(seal: &Seal) -> String {
    format!("<metadata>{}; {seal}; {}</metadata>\n", Seal::SOFTWARE, escaped(&seal.adapter))
}

/// The start of a layer, with all that its strokes have in common.
fn group(number: usize, layer: &Layer) -> String {
    let (label, colour) = (escaped(&layer.name), layer.pen.colour);
    let ink = match layer.form {
        StrokeForm::Outlines => format!("fill=\"{colour}\""),
        StrokeForm::CentreLines => {
            let width = decimal(layer.pen.width);
            format!(
                "fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\" \
                 stroke-linejoin=\"round\""
            )
        }
    };
    let opacity = if layer.pen.opacity < 1.0 { format!(" opacity=\"{}\"", layer.pen.opacity) } else { String::new() };
    format!("<g id=\"layer{number}\" inkscape:groupmode=\"layer\" inkscape:label=\"{label}\" {ink}{opacity}>\n")
}

/// The paths of strokes.
fn elements(strokes: &[Stroke], layer: &Layer) -> Vec<u8> {
    let mut text = Vec::new();
    for stroke in strokes {
        text.extend(b"<path");
        if let Some(chain) = stroke.chain {
            text.extend(format!(" id=\"{}", chain.written()).as_bytes());
            if stroke.piece > 0 {
                text.extend(format!("-{}", stroke.piece).as_bytes());
            }
            text.push(b'"');
        }
        write_paths(&paths(stroke, layer), &mut text);
    }
    text
}

/// Writes paths as the data of one element, and its end.
fn write_paths(paths: &[Path], text: &mut Vec<u8>) {
    text.extend(b" d=\"");
    for path in paths {
        for (i, [x, y]) in path.corners.iter().enumerate() {
            text.push(if i == 0 { b'M' } else { b'L' });
            number(*x, text);
            text.push(b' ');
            number(*y, text);
        }
        if path.closed {
            text.push(b'Z');
        }
    }
    text.extend(b"\"/>\n");
}

fn decimal(mm: f64) -> String {
    let mut text = Vec::new();
    number(micrometres(mm), &mut text);
    String::from_utf8_lossy(&text).into_owned()
}

/// Text inside a quoted attribute; what XML cannot hold is replaced.
fn escaped(text: &str) -> String {
    let escape = |c: char| match c {
        '&' => "&amp;".into(),
        '<' => "&lt;".into(),
        '>' => "&gt;".into(),
        '"' => "&quot;".into(),
        '\t' | '\n' | '\r' => format!("&#{};", u32::from(c)),
        '\0'..' ' | '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER.into(),
        c => c.into(),
    };
    text.chars().map(escape).collect::<String>()
}
