//! A drawing as PDF, whose layers readers can switch on and off.
//!
//! Method: the page's unit is turned from a 72nd of an inch into a millimetre once, y downwards. A layer is a form inside
//! an optional-content group, and consists of forms that hold some thousand strokes each: so it may be of any size.
//! Where it lets the paper through, it is a transparency group painted with its opacity: crossings are not darker. The
//! bytes tell nothing but the drawing, and what made it where it has a seal: no dates.
//!
//! Cost: .8 s for a million points of outlines on two cores, most of it compression; memory for the whole file. Does not
//! handle: files beyond 10 GB, which the format's cross references cannot tell.

use std::io::{self, Write};

use glam::DVec2;
use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::writers::Resources;
use pdf_writer::{Content, Dict, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};

use super::paths::{Path, borders, in_order, number, paths};
use super::{Area, Drawing, Layer, Seal, Stroke, StrokeForm};

/// Points in a millimetre.
const POINTS: f64 = 72.0 / 25.4;
/// How hard is compressed, of 10: 4 takes half as long again for a tenth less, 6 six times as long.
const LEVEL: u8 = 2;
/// Offsets in a file are of ten digits.
const LARGEST: usize = 9_999_999_999;

/// A layer in the file.
struct Written<'a> {
    layer: &'a Layer,
    form: Ref,
    group: Ref,
}

/// Writes the drawing; lengths are in micrometres as decimals of a millimetre.
///
/// Errors are those of the writer, and `FileTooLarge` where PDF cannot hold the drawing.
pub fn write_pdf(drawing: &Drawing, mut out: impl Write) -> io::Result<()> {
    let (mut pdf, mut next) = (Pdf::new(), Ref::new(1));
    let [catalog, pages, page, contents] = [(); 4].map(|()| next.bump());
    if drawing.seal.is_some() || drawing.title.is_some() {
        write_about(&mut pdf, next.bump(), drawing.title.as_deref(), drawing.seal.as_ref());
    }
    let size = drawing.sheet.size;
    let layers: Vec<Written> =
        drawing.layers.iter().map(|layer| write_layer(&mut pdf, &mut next, layer, size)).collect();

    let mut root = pdf.catalog(catalog);
    root.pages(pages);
    write_list(&mut root, &layers);
    root.finish();
    pdf.pages(pages).kids([page]).count(1);
    let mut sheet = pdf.page(page);
    sheet.parent(pages).media_box(rect(size * POINTS)).contents(contents);
    if layers.iter().any(Written::shows_through) {
        // Colours are blended as they are given.
        sheet.group().transparency().color_space().device_rgb();
    }
    write_resources(&mut sheet.resources(), &layers);
    sheet.finish();
    pdf.stream(contents, &content(&layers, size));

    let file = pdf.finish();
    if file.len() > LARGEST {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "PDF cannot hold more than 10 GB"));
    }
    out.write_all(&file)?;
    out.flush()
}

impl Written<'_> {
    fn shows_through(&self) -> bool {
        self.layer.pen.opacity < 1.0
    }
}

/// A rectangle from the origin on.
fn rect(size: DVec2) -> Rect {
    Rect::new(0.0, 0.0, size.x as f32, size.y as f32)
}

/// What a thing is called in a dictionary.
fn name(kind: char, i: usize) -> String {
    format!("{kind}{i}")
}

/// Writes the form of a layer, the forms of its strokes, and what readers list it as.
fn write_layer<'a>(pdf: &mut Pdf, next: &mut Ref, layer: &'a Layer, size: DVec2) -> Written<'a> {
    let strokes = in_order(&layer.strokes, |piece| compress_to_vec_zlib(&operators(piece, layer), LEVEL));
    let areas = (!layer.areas.is_empty()).then(|| compress_to_vec_zlib(&filled(&layer.areas), LEVEL));
    let pieces: Vec<Ref> = strokes
        .chain(areas)
        .map(|piece| {
            let id = next.bump();
            pdf.form_xobject(id, &piece).bbox(rect(size)).filter(Filter::FlateDecode);
            id
        })
        .collect();

    let mut content = Content::new();
    let [red, green, blue] = layer.pen.colour.0.map(|share| f32::from(share) / 255.0);
    match layer.form {
        StrokeForm::Outlines => content.set_fill_rgb(red, green, blue),
        StrokeForm::CentreLines => content
            .set_stroke_rgb(red, green, blue)
            .set_line_width(layer.pen.width as f32)
            .set_line_cap(LineCapStyle::RoundCap)
            .set_line_join(LineJoinStyle::RoundJoin),
    };
    (0..pieces.len()).for_each(|i| {
        content.x_object(Name(name('P', i).as_bytes()));
    });

    let written = Written { layer, form: next.bump(), group: next.bump() };
    let content = content.finish();
    let mut form = pdf.form_xobject(written.form, &content);
    form.bbox(rect(size));
    if written.shows_through() {
        form.group().transparency().isolated(true).color_space().device_rgb();
    }
    let mut resources = form.resources();
    let mut forms = resources.x_objects();
    pieces.iter().enumerate().for_each(|(i, id)| {
        forms.pair(Name(name('P', i).as_bytes()), *id);
    });
    forms.finish();
    resources.finish();
    form.finish();
    let mut group = pdf.indirect(written.group).dict();
    group.pair(Name(b"Type"), Name(b"OCG")).pair(Name(b"Name"), TextStr(&layer.name));
    written
}

/// What it is called and what made it, in the information about the document.
fn write_about(pdf: &mut Pdf, id: Ref, title: Option<&str>, seal: Option<&Seal>) {
    let plain = |text: &str| text.replace(|c: char| !c.is_ascii(), "?");
    let mut about = pdf.document_info(id);
    title.into_iter().for_each(|title| {
        about.title(TextStr(title));
    });
    let Some(seal) = seal else { return };
    about.producer(TextStr(Seal::SOFTWARE));
    about.keywords(TextStr(&seal.to_string()));
    about.subject(TextStr(&plain(&seal.adapter)));
}

/// The list of layers that readers show.
fn write_list(root: &mut Dict, layers: &[Written]) {
    let groups = || layers.iter().map(|written| written.group);
    let mut list = root.insert(Name(b"OCProperties")).dict();
    list.insert(Name(b"OCGs")).array().items(groups());
    let mut shown = list.insert(Name(b"D")).dict();
    ["Order", "ON"].into_iter().for_each(|key| {
        shown.insert(Name(key.as_bytes())).array().items(groups());
    });
}

/// What the page's content names: forms, groups and opacities of layers.
fn write_resources(resources: &mut Resources, layers: &[Written]) {
    let mut forms = resources.x_objects();
    layers.iter().enumerate().for_each(|(i, written)| {
        forms.pair(Name(name('L', i).as_bytes()), written.form);
    });
    forms.finish();
    let mut groups = resources.insert(Name(b"Properties")).dict();
    layers.iter().enumerate().for_each(|(i, written)| {
        groups.pair(Name(name('G', i).as_bytes()), written.group);
    });
    groups.finish();
    let mut states = resources.ext_g_states();
    for (i, written) in layers.iter().enumerate().filter(|(_, written)| written.shows_through()) {
        let opacity = written.layer.pen.opacity as f32;
        let mut state = states.insert(Name(name('S', i).as_bytes())).dict();
        state.pair(Name(b"ca"), opacity).pair(Name(b"CA"), opacity);
    }
}

/// The page: each layer once, from bottom to top.
fn content(layers: &[Written], size: DVec2) -> Vec<u8> {
    let mut content = Content::new();
    content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, size.y * POINTS].map(|v| v as f32));
    for (i, written) in layers.iter().enumerate() {
        content.begin_marked_content_with_properties(Name(b"OC")).properties_named(Name(name('G', i).as_bytes()));
        content.save_state();
        if written.shows_through() {
            content.set_parameters(Name(name('S', i).as_bytes()));
        }
        content.x_object(Name(name('L', i).as_bytes())).restore_state().end_marked_content();
    }
    content.finish().into_vec()
}

/// What paints strokes.
fn operators(strokes: &[Stroke], layer: &Layer) -> Vec<u8> {
    let mut text = Vec::new();
    for stroke in strokes {
        write_paths(&paths(stroke, layer), &mut text);
        text.extend(if layer.form == StrokeForm::Outlines { b"f\n" } else { b"S\n" });
    }
    text
}

/// What fills areas.
fn filled(areas: &[Area]) -> Vec<u8> {
    let mut text = Vec::new();
    for area in areas {
        write_paths(&borders(area), &mut text);
        text.extend(b"f\n");
    }
    text
}

fn write_paths(paths: &[Path], text: &mut Vec<u8>) {
    for path in paths {
        for (i, [x, y]) in path.corners.iter().enumerate() {
            number(*x, text);
            text.push(b' ');
            number(*y, text);
            text.extend(if i == 0 { b" m\n" } else { b" l\n" });
        }
        if path.closed {
            text.extend(b"h\n");
        }
    }
}
