//! What stands in the files: layers, names, numbers, by an XML parser and by GDAL's tools, which read PDFs.

use std::collections::HashSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use glam::{DVec2, dvec2};
use hachure::ink::{Drawing, Stroke};
use hachure::line::Id;
use resvg::usvg::roxmltree::{Document, Node};

use super::pictures::{pdf, svg};
use super::samples::{all, centre_lines, drawing, even, layer};
use super::strangers::skip;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// Names of layers that files must hold as they are.
const NAMES: [&str; 5] =
    ["1 hidden", "2 <&> \"quoted\" 'it' )(", "3 Höhenzüge 山", "4 0.35 mm\ttab", "5 beyond 12.5 km"];

fn text(drawing: &Drawing) -> String {
    String::from_utf8(svg(drawing)).expect("UTF-8")
}

fn groups<'a>(document: &'a Document) -> Vec<Node<'a, 'a>> {
    document.root_element().children().filter(Node::is_element).collect()
}

/// A line in each of the layers named.
fn named() -> Drawing {
    let line = |i: usize| even([dvec2(10.0, 10.0 * i as f64 + 10.0), dvec2(90.0, 10.0 * i as f64 + 10.0)]);
    drawing(NAMES.iter().enumerate().map(|(i, name)| layer(name, 2.0, [0; 3], 1.0, vec![line(i)])).collect())
}

#[test]
fn svgs_hold_one_group_a_layer_and_one_path_a_stroke() {
    let drawing = all();
    let text = text(&drawing);
    let document = Document::parse(&text).expect("XML");
    let root = document.root_element();
    assert_eq!(
        ["width", "height", "viewBox"].map(|name| root.attribute(name)),
        [Some("100.5mm"), Some("80.25mm"), Some("0 0 100.5 80.25")]
    );
    let groups = groups(&document);
    assert_eq!(groups.len(), drawing.layers.len());
    let mut ids = HashSet::new();
    for (group, layer) in groups.iter().zip(&drawing.layers) {
        assert_eq!(group.attribute((INKSCAPE, "label")), Some(layer.name.as_str()));
        assert_eq!(group.attribute((INKSCAPE, "groupmode")), Some("layer"));
        assert_eq!(group.attribute("opacity"), (layer.pen.opacity < 1.0).then_some("0.5"));
        let paths: Vec<Node> = group.children().filter(Node::is_element).collect();
        assert_eq!(paths.len(), layer.strokes.len());
        for (path, stroke) in paths.iter().zip(&layer.strokes) {
            let piece = if stroke.piece > 0 { format!("-{}", stroke.piece) } else { String::new() };
            let id = format!("c{:x}{piece}", stroke.chain.expect("a chain").0);
            assert_eq!(path.attributes().map(|a| a.name()).collect::<Vec<_>>(), ["id", "d"]);
            assert_eq!(path.attribute("id"), Some(id.as_str()));
        }
        ids.extend(paths.iter().chain([group]).map(|node| node.attribute("id").expect("an id")));
    }
    assert_eq!(ids.len(), drawing.layers.iter().map(|layer| layer.strokes.len() + 1).sum::<usize>());
    let elements: HashSet<&str> = root.descendants().filter(Node::is_element).map(|n| n.tag_name().name()).collect();
    assert_eq!(elements, HashSet::from(["svg", "g", "path"]), "no text, clips, masks or paper");
    let attributes: HashSet<&str> = root.descendants().flat_map(|n| n.attributes()).map(|a| a.name()).collect();
    assert!(["transform", "style", "clip-path", "mask", "class"].iter().all(|name| !attributes.contains(name)));
}

#[test]
fn layers_of_svgs_say_how_their_strokes_are_inked() {
    let text = text(&all());
    let document = Document::parse(&text).expect("XML");
    let groups = groups(&document);
    assert_eq!([0, 1].map(|i| groups[i].attribute("fill")), [Some("#000000"), Some("#261e18")]);
    assert_eq!([0, 1].map(|i| groups[i].attribute("stroke")), [None, None]);
    let said = |i: usize| {
        ["fill", "stroke", "stroke-width", "stroke-linecap", "stroke-linejoin"].map(|name| groups[i].attribute(name))
    };
    assert_eq!(said(2).map(Option::unwrap), ["none", "#143c8c", "0.5", "round", "round"]);
    assert_eq!(said(3).map(Option::unwrap), ["none", "#c80000", "2", "round", "round"]);
}

#[test]
fn numbers_are_micrometres_without_idle_digits() {
    let places = [(0.0, -0.0004), (1.5, 20.0), (0.02, 100.003), (-0.5, 7.0499), (7.0, 1e-9), (7.0, 0.0)];
    let stroke = even(places.map(|(x, y)| dvec2(x, y)));
    let closed = Stroke { closed: true, ..even([(0.9996, 12.0), (3.0, 4.0), (1.0, 12.0)].map(|(x, y)| dvec2(x, y))) };
    let lone = even([dvec2(3.25, 4.0)]);
    let mut drawing = drawing(vec![centre_lines(layer("1", 0.1 + 0.2, [0; 3], 1.0, vec![stroke, closed, lone]))]);
    drawing.layers[0].strokes[2].chain = None;
    drawing.layers[0].strokes[0].chain = Some(Id(u64::MAX));
    drawing.sheet.size = DVec2::new(240.0, 100.0 / 3.0);
    let text = text(&drawing);
    assert!(text.contains("width=\"240mm\" height=\"33.333mm\" viewBox=\"0 0 240 33.333\""), "{text}");
    assert!(text.contains("<path id=\"cffffffffffffffff\" d=\"M0 0L1.5 20L0.02 100.003L-0.5 7.05L7 0\"/>"), "{text}");
    assert!(text.contains("d=\"M1 12L3 4Z\"/>") && text.contains("<path d=\"M3.25 4L3.25 4\"/>"), "{text}");
    assert!(text.contains("stroke-width=\"0.3\""), "{text}");
}

#[test]
fn names_of_layers_survive_in_svg() {
    let text = text(&named());
    let document = Document::parse(&text).expect("XML");
    let labels = groups(&document).iter().map(|group| group.attribute((INKSCAPE, "label"))).collect::<Vec<_>>();
    assert_eq!(labels, NAMES.map(Some));
    let mut hostile = named();
    hostile.layers[0].name = "a\u{1}b\u{ffff}c\n".into();
    let text = self::text(&hostile);
    let document = Document::parse(&text).expect("XML");
    assert_eq!(groups(&document)[0].attribute((INKSCAPE, "label")), Some("a\u{fffd}b\u{fffd}c\n"));
}

#[test]
fn drawings_without_layers_are_files_without_layers() {
    let nothing = drawing(vec![]);
    let text = text(&nothing);
    assert!(groups(&Document::parse(&text).expect("XML")).is_empty());
    assert!(opened(&pdf(&nothing), &[]).is_none_or(|file| file.layers.is_empty()));
}

/// A PDF as GDAL reads it.
struct Opened {
    layers: Vec<String>,
    /// Mean of the first channel in each row.
    rows: Vec<f64>,
}

/// `None`, with a line that says so, where GDAL's tools read no PDFs. They run by themselves: a process that reads DEMs may
/// have closed its GDAL to other formats.
fn opened(file: &[u8], options: &[&str]) -> Option<Opened> {
    let run = |tool: &str, arguments: &[&str], folder: &Path| {
        let output = Command::new(tool).args(arguments).current_dir(folder).output();
        output.ok().filter(|output| output.status.success())
    };
    let folder = tempfile::tempdir().expect("a folder");
    if run("gdalinfo", &["--format", "PDF"], folder.path()).is_none() {
        skip("install GDAL's tools, with PDF");
        return None;
    }
    fs::write(folder.path().join("in.pdf"), file).expect("in.pdf");
    let info = run("gdalinfo", &["-mdd", "LAYERS", "in.pdf"], folder.path()).expect("GDAL reads it");
    let info = String::from_utf8(info.stdout).expect("text");
    let listed = info.lines().filter_map(|line| line.trim().strip_prefix("LAYER_"));
    let layers = listed.map(|line| line.split_once('=').expect("a name").1.to_owned()).collect();
    let options: Vec<&str> = options.iter().flat_map(|option| ["-oo", option]).collect();
    let arguments = [&["-q", "-of", "PNG"], &options[..], &["in.pdf", "out.png"]].concat();
    run("gdal_translate", &arguments, folder.path()).expect("GDAL draws it");
    let picture = image::open(folder.path().join("out.png")).expect("out.png").to_rgb8();
    let mean = |row: image::buffer::Pixels<image::Rgb<u8>>| {
        row.map(|pixel| f64::from(pixel.0[0])).sum::<f64>() / f64::from(picture.width())
    };
    Some(Opened { layers, rows: picture.rows().map(mean).collect() })
}

#[test]
fn readers_list_the_layers_of_a_pdf_and_hide_them() {
    let file = pdf(&named());
    let Some(all) = opened(&file, &["DPI=101.6"]) else { return };
    // GDAL leaves out and replaces what would trouble its own lists.
    assert_eq!(all.layers, NAMES.map(|name| name.replace('"', "").replace([' ', '.'], "_")));
    // 4 px a millimetre, lines every 10 mm.
    let drawn =
        |opened: &Opened| NAMES.iter().enumerate().map(|(i, _)| opened.rows[40 * (i + 1)] < 100.0).collect::<Vec<_>>();
    assert_eq!(drawn(&all), [true; 5]);
    let hidden = opened(&file, &["DPI=101.6", "LAYERS_OFF=1_hidden,5_beyond_12_5_km"]).expect("as before");
    assert_eq!(drawn(&hidden), [false, true, true, true, false]);
}

#[test]
fn pdfs_are_of_the_size_of_the_sheet_and_say_no_time() {
    let mut drawing = all();
    drawing.sheet.size = dvec2(210.0, 297.0);
    let file = String::from_utf8_lossy(&pdf(&drawing)).into_owned();
    assert!(file.starts_with("%PDF-1.7") && file.contains("/MediaBox [0 0 595.2756 841.8898]"));
    assert!(!file.contains("Date") && !file.contains("/ID") && !file.contains("/Producer"));
    // Only the two pale layers are groups, and the page that blends them.
    assert_eq!(file.matches("/S /Transparency").count(), 3);
    drawing.layers.iter_mut().for_each(|layer| layer.pen.opacity = 1.0);
    assert!(!String::from_utf8_lossy(&pdf(&drawing)).contains("/Transparency"), "printers need blend nothing");
}
