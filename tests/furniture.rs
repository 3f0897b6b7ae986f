//! Furniture: rules and letters around a picture, in their place to the micrometre, as areas or as strokes of a pen.

mod letters;
mod typed;

use glam::DVec2;
use hachure::door::ink::furniture::{Credits, Texts};
use hachure::ink::{Drawing, Layer, Sheet, Style, styles};
use hachure::ink::{Furniture, Surround};

use crate::tolerances::{CROWDED, LENGTH_MM};
use crate::vectors::pictures::{difference, pdf, png, seen, svg};
use crate::vectors::strangers::Poppler;

/// All that there is.
fn whole() -> Furniture {
    Furniture {
        title: Some("THE HILL, 60 m".to_owned()),
        neatline: true,
        view_line: true,
        credits: Some(Credits::OfFiles),
    }
}

fn texts() -> Texts {
    Texts {
        view_line: "From\u{a0}36.1234°\u{a0}N, 117.0000°\u{a0}W\u{a0}at\u{a0}312\u{a0}m · looking\u{a0}318° · heights\u{a0}×\u{a0}2".to_owned(),
        credits: "Terrain: hill.asc · 40 × 40 samples · © Ærøskøbing Æ Ω".replace('Ω', ""),
    }
}

/// A sheet of this size with 10 mm of margin, and nothing on it but furniture.
fn furnished(furniture: &Furniture, size: DVec2, style: &Style, texts: &Texts) -> Drawing {
    let bare = Sheet { size, margin: 10.0, surround: Surround::NONE };
    let surround = furniture.within(bare.inner(), style).expect("room");
    let mut drawing = Drawing {
        sheet: Sheet { surround, ..bare },
        paper: hachure::ink::Colour([255; 3]),
        layers: Vec::new(),
        title: None,
        seal: None,
    };
    furniture.set(&drawing.sheet, style, texts).expect("it fits").onto(&mut drawing, style);
    drawing
}

const A4: DVec2 = DVec2::new(297.0, 210.0);
const A6: DVec2 = DVec2::new(105.0, 148.0);

fn plotter() -> Style {
    styles::find("plotter").expect("a style")
}

/// Corners of what a layer covers and the middles between them, mm.
fn covered(layer: &Layer) -> Vec<DVec2> {
    let half = DVec2::splat(layer.pen.width / 2.0);
    let strokes = layer.strokes.iter().flat_map(|stroke| {
        let places: Vec<DVec2> = stroke.points.iter().map(|point| point.place).collect();
        with_middles(&places, stroke.closed).into_iter().flat_map(|at| [at - half, at + half])
    });
    strokes.chain(layer.areas.iter().flat_map(|area| &area.0).flat_map(|ring| with_middles(ring, true))).collect()
}

fn with_middles(places: &[DVec2], closed: bool) -> Vec<DVec2> {
    let closing = places.last().zip(places.first()).filter(|_| closed).map(|(a, b)| a.midpoint(*b));
    let middles = places.windows(2).map(|pair| pair[0].midpoint(pair[1])).chain(closing);
    places.iter().copied().chain(middles).collect()
}

/// Where a drawing's furniture leaves the room that it has: below the picture, above the margin, or lies on the picture.
fn outside_its_room(drawing: &Drawing) -> Vec<DVec2> {
    let Sheet { size, margin, .. } = drawing.sheet;
    let [low, high] = drawing.sheet.area();
    let near = |a: f64, b: f64| a > b - LENGTH_MM;
    let on_picture = |at: &DVec2| {
        at.x > low.x + LENGTH_MM && at.x < high.x - LENGTH_MM && at.y > low.y + LENGTH_MM && at.y < high.y - LENGTH_MM
    };
    let in_margin = |at: &DVec2| {
        !(near(at.x, margin) && near(at.y, margin) && near(size.x - margin, at.x) && near(size.y - margin, at.y))
    };
    let all = drawing.layers.iter().flat_map(|layer| {
        let mut layer = layer.clone();
        // Marks that lay one layer over another stand in the corners of the picture.
        layer.strokes.retain(|stroke| !is_mark(stroke, [low, high]));
        covered(&layer)
    });
    all.filter(|at| on_picture(at) || in_margin(at)).collect()
}

/// Whether a stroke is one of the brackets in the corners of the picture.
fn is_mark(stroke: &hachure::ink::Stroke, [low, high]: [DVec2; 2]) -> bool {
    let inside = |at: DVec2| at.cmpgt(low).all() && at.cmplt(high).all();
    stroke.points.len() == 3 && stroke.points.iter().all(|point| inside(point.place))
}

#[test]
fn it_keeps_off_picture_and_margins() {
    for style in [Style::default(), plotter()] {
        for size in [A4, A6, DVec2::new(841.0, 1189.0), DVec2::new(90.0, 60.0)] {
            let drawing = furnished(&whole(), size, &style, &texts());
            assert_eq!(outside_its_room(&drawing), [], "{size} mm, {}", style.plot.centre_lines);
            assert!(drawing.layers.iter().map(covered).map(|all| all.len()).sum::<usize>() > 500);
            // The check sees all of it a millimetre higher or lower.
            for by in [-1.0, 1.0] {
                let mut drawing = drawing.clone();
                let moved = |at: &mut DVec2| at.y += by;
                drawing.layers.iter_mut().for_each(|layer| {
                    layer.areas.iter_mut().flat_map(|area| &mut area.0).flatten().for_each(moved);
                    layer
                        .strokes
                        .iter_mut()
                        .flat_map(|stroke| &mut stroke.points)
                        .for_each(|point| moved(&mut point.place));
                });
                assert!(!outside_its_room(&drawing).is_empty(), "{by} mm");
            }
        }
    }
}

#[test]
fn nothing_asked_is_no_room() {
    let style = Style::default();
    assert_eq!(Furniture::default().within(A4, &style).expect("none"), Surround::NONE);
    let drawing = furnished(&Furniture::default(), A4, &style, &texts());
    assert_eq!(drawing.sheet.area(), [DVec2::splat(10.0), A4 - 10.0]);
    // One empty layer would be one too many; its title neither.
    assert!(drawing.layers.is_empty() && drawing.title.is_none());
    let title = Furniture { title: Some("A".to_owned()), ..Furniture::default() };
    let [low, high] = furnished(&title, A4, &style, &texts()).sheet.area();
    assert!(low == DVec2::splat(10.0) && high.x == A4.x - 10.0 && high.y < A4.y - 15.0, "{low} {high}");
}

#[test]
fn the_neatline_touches_the_picture_all_around() {
    let neatline = Furniture { neatline: true, ..Furniture::default() };
    let drawing = furnished(&neatline, A4, &Style::default(), &texts());
    let [low, high] = drawing.sheet.area();
    let [layer] = &drawing.layers[..] else { panic!("one layer") };
    assert_eq!((layer.name.as_str(), layer.strokes.len(), layer.areas.len()), ("1 furniture", 0, 2));
    let bounds = |ring: &Vec<DVec2>| {
        let all = || ring.iter().copied();
        [all().reduce(DVec2::min).expect("corners"), all().reduce(DVec2::max).expect("corners")]
    };
    let [thin, thick] = [0, 1].map(|i| layer.areas[i].0.iter().map(bounds).collect::<Vec<_>>());
    assert_eq!(thin[1], [low, high], "the thin rule begins where the picture ends");
    assert_eq!(
        thick[0].map(|corner| (corner * 1e6).round() / 1e6),
        [DVec2::splat(10.0), A4 - 10.0],
        "and the thick one ends at the margin"
    );
    let [fine, gap, broad] =
        [thin[1][0] - thin[0][0], thin[0][0] - thick[1][0], thick[1][0] - thick[0][0]].map(|d| d.x);
    assert!(0.1 < fine && 3.0 * fine < broad && gap > broad && broad < 1.0, "{fine} {gap} {broad} mm");
    // A pen's rule is as broad as the pen: its edge lies on the picture's.
    let style = plotter();
    let drawing = furnished(&neatline, A4, &style, &texts());
    let [low, high] = drawing.sheet.area();
    let rules =
        drawing.layers.iter().flat_map(|layer| layer.strokes.iter().map(move |stroke| (layer.pen.width, stroke)));
    let rules: Vec<_> = rules.filter(|(_, stroke)| stroke.closed).collect();
    assert!(rules.len() >= 2, "{}", rules.len());
    let inner = rules.iter().map(|(pen, stroke)| {
        let all = || stroke.points.iter().map(|point| point.place);
        [all().reduce(DVec2::min).expect("places") + pen / 2.0, all().reduce(DVec2::max).expect("places") - pen / 2.0]
    });
    let nearest = inner.map(|[a, b]| a.distance(low).max(b.distance(high))).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{nearest} mm");
}

#[test]
fn strangers_see_the_same_letters_in_every_file() {
    let poppler = Poppler::find();
    for style in [Style::default(), plotter()] {
        // Of long upright edges between pixels each rasteriser has its own mind.
        let lettered = Furniture { neatline: false, ..whole() };
        let drawing = furnished(&lettered, A6, &style, &texts());
        let bare = furnished(&Furniture { title: None, ..lettered }, A6, &style, &texts());
        for seen in seen(&drawing, 8.0, poppler.as_ref()) {
            // Small letters are lines that crowd.
            let differs = |drawing: &Drawing| difference(&png(drawing, 8.0), &seen.picture, seen.darkness * CROWDED);
            assert_eq!(differs(&drawing), None, "{}, {}", seen.who, style.plot.centre_lines);
            assert!(differs(&bare).is_some(), "a title is seen");
        }
        let drawing = furnished(&whole(), A6, &style, &texts());
        let [low, high] = drawing.sheet.area();
        let edge = drawing.sheet.margin + 0.2;
        let others = seen(&drawing, 8.0, poppler.as_ref()).into_iter().map(|seen| seen.picture);
        for picture in others.chain([png(&drawing, 8.0)]) {
            let dark = |[x, y]: [f64; 2]| picture.get_pixel((x * 8.0) as u32, (y * 8.0) as u32).0[0] < 128;
            assert!(dark([edge, 70.0]) && dark([70.0, edge]), "the thick rule");
            assert!(!dark([low.x + 1.0, high.y - 1.0]) && !dark([5.0, 70.0]), "picture and margin are blank");
        }
    }
}

#[test]
fn pens_write_single_strokes_and_nothing_is_filled() {
    let style = plotter();
    let drawing = furnished(&whole(), A4, &style, &texts());
    let names: Vec<&str> = drawing.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["1 furniture 0.3 mm", "2 furniture 0.5 mm"]);
    let text = String::from_utf8(svg(&drawing)).expect("text");
    let groups = || text.lines().filter(|line| line.starts_with("<g "));
    assert_eq!(groups().count(), 2);
    assert!(groups().all(|group| group.contains("fill=\"none\" stroke=\"#000000\"")), "{text}");
    let even = drawing.layers.iter().flat_map(|layer| &layer.strokes).flat_map(|stroke| &stroke.points);
    assert!(even.into_iter().all(|point| point.width == 1.0));
    let filled = String::from_utf8(svg(&furnished(&whole(), A4, &Style::default(), &texts()))).expect("text");
    assert!(filled.contains("fill=\"#") && !filled.contains("stroke="), "outlines are filled");
}

#[test]
fn it_is_the_same_every_time_and_bears_its_title() {
    let files = || {
        let mut furniture = whole();
        furniture.title = Some("<Hill & \"Dale\">".to_owned());
        let drawing = furnished(&furniture, A4, &Style::default(), &texts());
        (svg(&drawing), pdf(&drawing))
    };
    let (svg, pdf) = files();
    assert!(files() == (svg.clone(), pdf.clone()));
    let svg = String::from_utf8(svg).expect("text");
    assert!(svg.contains("<title>&lt;Hill &amp; &quot;Dale&quot;&gt;</title>"), "{}", &svg[..400]);
    assert!(!svg.contains("<text") && !svg.contains("font"), "letters are paths");
    let pdf = String::from_utf8_lossy(&pdf).into_owned();
    assert!(pdf.contains("/Title (<Hill & \"Dale\">)") && !pdf.contains("/Font"), "{}", &pdf[..300]);
}

#[test]
fn long_texts_are_set_smaller_then_in_two_lines_then_refused() {
    let style = Style::default();
    let height = |title: &str| {
        let furniture = Furniture { title: Some(title.to_owned()), ..Furniture::default() };
        furniture.within(A6 - 20.0, &style).map(|surround| surround.foot)
    };
    let (short, long) = (
        height("Mont Blanc").expect("room"),
        height("The mountains of the Mont Blanc as seen from the lake of Geneva").expect("room"),
    );
    assert!(long < 0.8 * short, "{long} of {short} mm");
    let error = height(&"A very long title ".repeat(20)).expect_err("too long").to_string();
    assert!(error.starts_with("title: \"A very long title") && error.contains("shorten it"), "{error}");
    // Credits of one line, of two, of more.
    let lines = |credits: &str| {
        let furniture = Furniture { credits: Some(Credits::Own(credits.to_owned())), ..Furniture::default() };
        furniture.within(A6 - 20.0, &style).map(|surround| surround.foot)
    };
    let (one, two) = (lines("By nobody").expect("room"), lines(&"By nobody ".repeat(14)).expect("room"));
    assert!(two > 1.4 * one, "{one} {two} mm");
    assert!(lines(&"By nobody ".repeat(40)).is_err());
}
