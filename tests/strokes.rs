//! From lines to layers of strokes: widths, tapers, zones of distance, pens, dashes, wobble, on lines made here.

use glam::{DVec2, DVec3};
use hachure::door::line::ends;
use hachure::error::Error;
use hachure::ink::Surround;
use hachure::ink::style::{Dashes, Plot, Weight, Wobble};
use hachure::ink::{Drawing, Pen, Sheet, Stroke, StrokeForm, Style, draw};
use hachure::line::{Chain, ChainPoint, Id, Line, Lines, Recession};

/// A sheet of 200 x 100 mm without margins, and its frame of 2 pixels a millimetre.
const SHEET: Sheet = Sheet { size: DVec2::new(200.0, 100.0), margin: 0.0, surround: Surround::NONE };
const FRAME: [u32; 2] = [400, 200];

/// A point of a skyline so far away, m; its place in mm.
fn point(place: [f64; 2], distance: f64, weight: f32) -> ChainPoint {
    let (place, depth) = (DVec2::from(place) * 2.0, (1.0 / distance) as f32);
    ChainPoint {
        place,
        line: Line::Skyline,
        depth,
        behind: 0.0,
        world: DVec3::Y * distance,
        crowd: 0,
        weight,
        black: 1.0,
    }
}

/// A level chain, a point a millimetre, at height `y`.
fn level(id: u64, [from, to]: [i32; 2], y: f64, of: impl Fn(f64) -> (f64, f32)) -> Chain {
    let at = |x: i32| {
        let (distance, weight) = of(x.into());
        point([x.into(), y], distance, weight)
    };
    Chain { id: Some(Id(id)), points: (from..=to).map(at).collect(), closed: false }
}

fn plain(id: u64, ends: [i32; 2], y: f64) -> Chain {
    level(id, ends, y, |_| (1000.0, 1.0))
}

fn lines(chains: Vec<Chain>, hidden: Vec<Chain>) -> Lines {
    let recession = Recession::of(chains.iter().flat_map(|chain| &chain.points).map(|point| (point.depth, 1.0)));
    let [width, height] = FRAME;
    Lines { width, height, eye: DVec3::ZERO, chains, hidden, recession, own: vec![] }
}

/// Blunt lines that are as wide as their pen.
fn even() -> Style {
    Style { weight: Weight { far: 1.0, flat: 1.0, taper: 0.0, ..Weight::default() }, ..Style::default() }
}

fn drawn(chains: Vec<Chain>, style: &Style, split: &[f64]) -> Drawing {
    draw(&lines(chains, vec![]), &SHEET, style, split).expect("a drawing")
}

/// From the leftmost to the rightmost place of a stroke, mm.
fn extent(stroke: &Stroke) -> [f64; 2] {
    let x = stroke.points.iter().map(|point| point.place.x);
    [x.clone().fold(f64::INFINITY, f64::min), x.fold(f64::NEG_INFINITY, f64::max)]
}

fn names(drawing: &Drawing) -> Vec<&str> {
    drawing.layers.iter().map(|layer| layer.name.as_str()).collect()
}

fn near(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() < 0.06
}

#[test]
fn free_ends_taper_and_others_do_not() {
    let across = plain(1, [40, 160], 50.0);
    let upright = (0..=40).map(|y| point([100.0, 10.0 + f64::from(y)], 1000.0, 1.0)).collect();
    // Its lower end lies on the first.
    let onto = Chain { id: Some(Id(2)), points: upright, closed: false };
    let off_page = plain(3, [0, 60], 80.0);
    let chains = vec![across, onto, off_page];
    assert_eq!(ends::free(&chains, FRAME), [[true, true], [true, false], [false, true]]);
    let style = Style { weight: Weight { taper: 10.0, ..even().weight }, ..even() };
    let drawing = drawn(chains, &style, &[]);
    let stroke = |id| drawing.layers[0].strokes.iter().find(|stroke| stroke.chain == Some(Id(id))).expect("a stroke");
    let widths = |id| stroke(id).points.iter().map(|point| point.width).collect::<Vec<_>>();
    assert_eq!((widths(1)[0], widths(1).last()), (0.0, Some(&0.0)));
    assert_eq!((widths(2)[0], widths(2).last()), (0.0, Some(&1.0)));
    assert_eq!((widths(3)[0], widths(3).last()), (1.0, Some(&0.0)));
    // Whole from 10 mm on, and wider all the way there.
    let inner = stroke(1).points.iter().filter(|point| (50.01..149.99).contains(&point.place.x));
    assert!(inner.clone().count() > 90 && inner.clone().all(|point| point.width > 0.999));
    assert!(widths(1)[..20].is_sorted(), "{:?}", &widths(1)[..20]);
    assert_eq!(drawing.layers[0].form, StrokeForm::Outlines);
    // However short the taper, there are few points more; and a line without length is no number.
    let style = Style { weight: Weight { taper: 1e-9, ..even().weight }, ..even() };
    let drawing = drawn(vec![plain(1, [40, 160], 50.0)], &style, &[]);
    assert!(drawing.layers[0].strokes[0].points.len() < 200);
    let spot = Chain { id: None, points: vec![point([50.0, 50.0], 1000.0, 1.0); 2], closed: false };
    let drawing = drawn(vec![spot], &style, &[]);
    let points = drawing.layers.iter().flat_map(|layer| &layer.strokes).flat_map(|stroke| &stroke.points);
    assert!(points.clone().all(|point| point.place.is_finite() && point.width.is_finite()));
    // A ring has no end.
    let ring = (0..60).map(|i| DVec2::from_angle(f64::from(i) / 60.0 * std::f64::consts::TAU) * 20.0 + 50.0);
    let ring = Chain { id: None, points: ring.map(|at| point(at.to_array(), 1000.0, 1.0)).collect(), closed: true };
    let drawing = drawn(vec![ring], &style, &[]);
    assert!(drawing.layers[0].strokes[0].closed);
    assert_eq!(drawing.layers[0].form, StrokeForm::CentreLines, "all of one width");
}

#[test]
fn layers_part_at_distances_the_farthest_first() {
    let receding = level(1, [10, 190], 50.0, |x| (x * 100.0, 1.0));
    let drawing = drawn(vec![receding], &even(), &[5000.0, 10_000.0]);
    let wanted = ["1 silhouette beyond 10 km", "2 silhouette 5 to 10 km", "3 silhouette to 5 km"];
    assert_eq!(names(&drawing), wanted);
    let found: Vec<[f64; 2]> = drawing.layers.iter().map(|layer| extent(&layer.strokes[0])).collect();
    for (found, wanted) in found.iter().zip([[100.0, 190.0], [50.0, 100.0], [10.0, 50.0]]) {
        assert!(near(found[0], wanted[0]) && near(found[1], wanted[1]), "{found:?}, {wanted:?}");
    }
    // One chain, three strokes: each has a name of its own.
    let pieces: Vec<u32> = drawing.layers.iter().map(|layer| layer.strokes[0].piece).collect();
    assert_eq!(pieces, [0, 1, 2]);
    assert_eq!(names(&drawn(vec![plain(1, [10, 50], 20.0)], &even(), &[])), ["1 silhouette"]);
}

#[test]
fn hachures_recede_by_a_share_of_their_own() {
    let two = |line: Line| {
        let mut chains = [1000.0, 10_000.0].map(|distance| level(1, [40, 160], distance / 200.0, |_| (distance, 1.0)));
        chains.iter_mut().flat_map(|chain| &mut chain.points).for_each(|point| point.line = line);
        chains.to_vec()
    };
    let mut style = Style { weight: Weight { far: 0.2, ..even().weight }, ..even() };
    style.hachures.far = 0.5;
    for (line, far) in [(Line::Skyline, 0.2), (Line::Hachure, 0.5)] {
        let drawing = drawn(two(line), &style, &[]);
        let pen = &drawing.layers[0];
        let mut widths: Vec<f64> = pen.strokes.iter().map(|stroke| stroke.points[60].width).collect();
        widths.sort_by(f64::total_cmp);
        assert!((widths[0] / widths[1] - far).abs() < 1e-3, "{line:?}: {widths:?}");
    }
}

/// A style of pens of one width each.
fn pens(widths: &[f64]) -> Style {
    let mut style = even();
    style.pens.silhouette.width = 1.0;
    style.plot = Plot { centre_lines: true, widths: widths.to_vec(), ..Plot::default() };
    style
}

#[test]
fn varying_widths_become_a_layer_a_pen() {
    // Thinning from 1 mm at 32 mm to a twentieth of that at 184 mm.
    let thinning = || level(1, [10, 190], 50.0, |x| (1000.0, (1.2 - x / 160.0).clamp(0.05, 1.0) as f32));
    let drawing = drawn(vec![thinning()], &pens(&[0.3, 1.0]), &[]);
    assert_eq!(names(&drawing), ["1 silhouette 0.3 mm", "2 silhouette 1 mm"]);
    assert!(drawing.layers.iter().all(|layer| layer.form == StrokeForm::CentreLines && layer.strokes.len() == 1));
    assert_eq!(drawing.layers.iter().map(|layer| layer.pen.width).collect::<Vec<_>>(), [0.3, 1.0]);
    let found: Vec<[f64; 2]> = drawing.layers.iter().map(|layer| extent(&layer.strokes[0])).collect();
    // Half-way between two pens, and at half the finest.
    for (found, wanted) in found.iter().zip([[88.0, 168.0], [10.0, 88.0]]) {
        assert!(near(found[0], wanted[0]) && near(found[1], wanted[1]), "{found:?}, {wanted:?}");
    }
    // Without pens at hand the line's own.
    let own = drawn(vec![thinning()], &pens(&[]), &[]);
    assert_eq!(names(&own), ["1 silhouette 1 mm"]);
    assert!(near(extent(&own.layers[0].strokes[0])[1], 112.0));
}

/// A chain of a layer of the user's own lines, 1 km away up to 100 px and 9 km from there on.
fn own(layer: u16, y: f64) -> Chain {
    let mut chain = level(u64::from(layer), [10, 190], y, |x| (if x < 100.0 { 1000.0 } else { 9000.0 }, 1.0));
    chain.points.iter_mut().for_each(|point| point.line = Line::Own(layer));
    chain
}

#[test]
fn layers_of_own_lines_have_their_order_name_and_pen() {
    let chains = vec![own(2, 50.0), plain(9, [10, 190], 60.0), own(0, 20.0), own(1, 30.0), own(3, 40.0)];
    let called = |names: &[&str]| Lines {
        own: names.iter().map(|name| (*name).to_owned()).collect(),
        ..lines(chains.clone(), vec![])
    };
    let mut style = even();
    let road = Pen { width: 0.7, ..Pen::default() };
    style.pens.lines = [("roads".to_owned(), road), ("nowhere".to_owned(), Pen::default())].into();
    let of = |names: &[&str], style: &Style, split: &[f64]| {
        let drawing = draw(&called(names), &SHEET, style, split).expect("a drawing");
        drawing.layers.iter().map(|layer| (layer.name.clone(), layer.pen.width)).collect::<Vec<_>>()
    };
    let listed =
        |layers: &[(&str, f64)]| layers.iter().map(|(name, pen)| ((*name).to_owned(), *pen)).collect::<Vec<_>>();
    let own = style.pens.own.width;
    let all = ["roads", "silhouette", "roads", "roads 2"];
    assert_eq!(
        of(&all, &style, &[]),
        listed(&[
            ("1 roads", 0.7),
            ("2 silhouette 2", own),
            ("3 roads 2", 0.7),
            ("4 roads 2 2", own),
            ("5 silhouette", style.pens.silhouette.width)
        ])
    );
    // Without a name, the pen of all.
    assert_eq!(of(&[], &style, &[])[..2], listed(&[("1 own", own), ("2 own", own)]));
    let zones = of(&all, &style, &[5000.0]);
    assert_eq!(zones[..2], listed(&[("1 roads beyond 5 km", 0.7), ("2 roads to 5 km", 0.7)]));
    style.plot = Plot { centre_lines: true, widths: vec![0.3, 0.7], ..Plot::default() };
    assert_eq!(of(&all, &style, &[])[..2], listed(&[("1 roads 0.7 mm", 0.7), ("2 silhouette 2 0.3 mm", 0.3)]));
}

#[test]
fn short_changes_of_width_change_no_pen() {
    let dips = |from: f64, to: f64, weight: f32| {
        level(1, [10, 190], 50.0, move |x| (1000.0, if (from..to).contains(&x) { weight } else { 1.0 }))
    };
    let layers = |chain| {
        let drawing = drawn(vec![chain], &pens(&[0.4, 1.0]), &[]);
        drawing.layers.iter().map(|layer| layer.strokes.len()).collect::<Vec<_>>()
    };
    assert_eq!(layers(dips(100.0, 130.0, 0.4)), [1], "30 mm of a finer pen");
    assert_eq!(layers(dips(80.0, 130.0, 0.4)), [1, 2], "50 mm");
    assert_eq!(layers(dips(100.0, 101.0, 0.1)), [1], "a gap of a millimetre");
    assert_eq!(layers(dips(100.0, 110.0, 0.1)), [2], "one of ten");
}

#[test]
fn every_layer_of_a_plot_has_its_marks() {
    let style = Style { plot: Plot { registration: true, ..pens(&[0.4, 1.0]).plot }, ..pens(&[0.4, 1.0]) };
    let chains = vec![plain(1, [20, 180], 50.0), level(2, [20, 180], 70.0, |_| (1000.0, 0.4))];
    let drawing = drawn(chains, &style, &[]);
    assert_eq!(drawing.layers.len(), 2);
    let places = |layer: &hachure::ink::Layer| {
        let marks = layer.strokes.iter().filter(|stroke| stroke.chain.is_none());
        let points = marks.flat_map(|mark| &mark.points).map(|point| point.place.to_array().map(f64::to_bits));
        points.collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(places(&drawing.layers[0]), places(&drawing.layers[1]), "one lies on the other");
    for layer in &drawing.layers {
        let marks: Vec<_> = layer.strokes.iter().filter(|stroke| stroke.chain.is_none()).collect();
        assert_eq!(marks.len(), 4, "{}", layer.name);
        assert!(marks.iter().all(|mark| extent(mark)[1] - extent(mark)[0] > 3.9));
    }
    assert!(drawn(vec![], &style, &[]).layers.is_empty(), "nothing to lay over nothing");
}

#[test]
fn hidden_lines_are_dashed_in_a_layer_below() {
    let style = Style { dashes: Dashes { dash: 3.0, gap: 2.0 }, ..even() };
    let hidden = vec![plain(7, [20, 120], 30.0), plain(8, [20, 22], 60.0)];
    let drawing = draw(&lines(vec![plain(1, [10, 190], 50.0)], hidden), &SHEET, &style, &[]).expect("a drawing");
    assert_eq!(names(&drawing), ["1 hidden", "2 silhouette"]);
    let dashes = &drawing.layers[0].strokes;
    // Half a dash at either end, and nothing of what is shorter than one.
    assert_eq!(dashes.len(), 21);
    let length: f64 = dashes.iter().map(|dash| extent(dash)[1] - extent(dash)[0]).sum();
    assert!(near(length, 60.0), "{length}");
    assert!(dashes.iter().all(|dash| dash.chain == Some(Id(7))));
    // Where economy leaves no weight nothing is dashed.
    let faded = vec![level(7, [20, 120], 30.0, |x| (1000.0, if x < 70.0 { 1.0 } else { 0.0 }))];
    let drawing = draw(&lines(vec![], faded), &SHEET, &style, &[]).expect("a drawing");
    assert!(drawing.layers[0].strokes.iter().all(|dash| extent(dash)[1] < 71.0));
}

#[test]
fn lines_of_one_width_are_drawn_by_the_nearest_pen_however_fine_they_are() {
    let mut style = pens(&[0.5, 1.0]);
    style.pens.hidden.width = 0.1;
    let drawing = draw(&lines(vec![], vec![plain(7, [20, 120], 30.0)]), &SHEET, &style, &[]).expect("a drawing");
    assert_eq!(names(&drawing), ["1 hidden 0.5 mm"]);
}

#[test]
fn a_pen_broader_than_the_sheet_draws_nothing() {
    let mut style = pens(&[0.5, 10.0]);
    style.pens.silhouette.width = 10.0;
    style.plot.registration = true;
    let sheet = Sheet { size: DVec2::new(20.0, 10.0), margin: 1.0, surround: Surround::NONE };
    let drawing = draw(&lines(vec![plain(1, [10, 190], 50.0)], vec![]), &sheet, &style, &[]).expect("a drawing");
    assert!(drawing.layers.is_empty(), "{:?}", names(&drawing));
}

#[test]
fn a_style_that_asks_for_too_many_strokes_is_refused() {
    let style = Style { dashes: Dashes { dash: 0.05, gap: 0.05 }, ..even() };
    let hidden = |count: u64| (0..count).map(|i| plain(i, [0, 200], 10.0 + i as f64 / 1000.0)).collect::<Vec<_>>();
    let refused = draw(&lines(vec![], hidden(2500)), &SHEET, &style, &[]);
    let Err(Error::Limit { what, .. }) = refused else { panic!("5 million dashes") };
    assert_eq!(what.to_string(), "hidden lines fall into 5000000 dashes; a drawing holds 4000000 strokes");
    assert!(draw(&lines(vec![], hidden(10)), &SHEET, &style, &[]).is_ok());
}

#[test]
fn a_hand_strays_no_farther_than_it_may_and_lines_still_meet() {
    let wobble = Wobble { reach: 0.5, length: 4.0, seed: 1 };
    let chains = || vec![plain(1, [20, 180], 50.0), plain(2, [20, 180], 50.0), plain(3, [180, 190], 50.0)];
    let hand = |wobble| drawn(chains(), &Style { tolerance: 1.0, wobble, ..even() }, &[]);
    let (steady, strayed) = (hand(Wobble { reach: 0.0, ..wobble }), hand(wobble));
    let strokes = |drawing: &Drawing| drawing.layers[0].strokes.clone();
    let off = |stroke: &Stroke| stroke.points.iter().map(|p| (p.place.y - 50.0).abs()).fold(0.0, f64::max);
    let farthest = strokes(&strayed).iter().map(off).fold(0.0, f64::max);
    assert!(
        strokes(&steady).iter().all(|stroke| off(stroke) == 0.0) && farthest > 0.1 && farthest <= 0.5,
        "{farthest}"
    );
    assert_eq!(strayed, hand(wobble), "the same seed, the same hand");
    assert_ne!(strayed, hand(Wobble { seed: 2, ..wobble }));
    // Nothing leaps: neighbours stray alike.
    for stroke in strokes(&strayed) {
        let leaps =
            stroke.points.windows(2).map(|w| (w[1].place - w[0].place).y.abs() / w[0].place.distance(w[1].place));
        assert!(leaps.fold(0.0, f64::max) < 0.8);
    }
}
