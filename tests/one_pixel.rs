//! Chains drawn one pixel wide: by truth's own rule, 8-connected, whatever their order.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use hachure::door::line::one_pixel_wide;
use hachure::line::{Chain, ChainPoint, Kind, Line, Marks};
use hachure::truth::{Inked, Mask};

use crate::judged::truth;
use crate::scenes::Random;
use crate::truth::straight;

const PAGE: [u32; 2] = [128, 96];

/// A chain through these places.
fn chain(places: &[[f64; 2]], line: Line, depth: f32) -> Chain {
    let point = |place: &[f64; 2]| ChainPoint {
        place: DVec2::from(*place),
        line,
        depth,
        behind: 0.0,
        world: DVec3::ZERO,
        crowd: 0,
        weight: 1.0,
        black: 1.0,
    };
    Chain { id: None, points: places.iter().map(point).collect(), closed: false }
}

fn pixels(marks: &Marks) -> BTreeSet<[u32; 2]> {
    marks.places().collect()
}

fn drawn(places: &[[f64; 2]]) -> Vec<[u32; 2]> {
    one_pixel_wide(&[chain(places, Line::Occluding, 1.0)], PAGE).places().collect()
}

#[test]
fn simple_lines_ink_the_pixels_they_pass() {
    assert_eq!(drawn(&[[3.2, 7.5], [6.9, 7.5]]), [[3, 7], [4, 7], [5, 7], [6, 7]]);
    assert_eq!(drawn(&[[5.5, 2.1], [5.5, 4.9]]), [[5, 2], [5, 3], [5, 4]]);
    assert_eq!(drawn(&[[1.0, 1.0], [4.0, 4.0]]), [[1, 1], [2, 2], [3, 3]], "a diagonal is one pixel wide");
    assert_eq!(drawn(&[[9.5, 9.5]]), [[9, 9]], "a dot");
    assert_eq!(drawn(&[[9.5, 9.5], [9.5, 9.5]]), [[9, 9]], "no length");
    let closed =
        Chain { closed: true, ..chain(&[[1.5, 1.5], [3.5, 1.5], [3.5, 3.5], [1.5, 3.5]], Line::Occluding, 1.0) };
    let ring: BTreeSet<_> = (1..4).flat_map(|x| (1..4).map(move |y| [x, y])).filter(|p| *p != [2, 2]).collect();
    assert_eq!(pixels(&one_pixel_wide(&[closed], PAGE)), ring);
}

#[test]
fn what_lies_beside_the_page_is_left_out() {
    assert_eq!(drawn(&[[-20.0, 3.5], [1.5, 3.5]]), [[0, 3], [1, 3]]);
    assert_eq!(drawn(&[[126.5, 3.5], [900.0, 3.5]]), [[126, 3], [127, 3]]);
    assert_eq!(drawn(&[[128.0, 3.5], [128.0, 30.5]]), [[0; 2]; 0], "the page's far edge");
    let row: Vec<[u32; 2]> = (0..128).map(|column| [column, 50]).collect();
    assert_eq!(drawn(&[[-1e9, -1e9], [-1.0, 50.0], [f64::MAX / 8.0, 1e300]]), row, "ends at the end of numbers");
    assert_eq!(drawn(&[[200.0, 20.0]]), [[0; 2]; 0]);
}

#[test]
fn lines_are_drawn_as_truth_is() {
    let mut random = Random::new(7);
    for _ in 0..200 {
        let [from, to] = [0, 1].map(|_| [random.between(0.0, 128.0), random.between(0.0, 96.0)]);
        let of_truth = Mask::of_truth(&truth(PAGE, straight(from, to, 1.0)));
        let of_truth: BTreeSet<[u32; 2]> = of_truth.inked.iter().map(|p| [p.column, p.row]).collect();
        let marks = one_pixel_wide(&[chain(&[from, to], Line::Occluding, 1.0)], PAGE);
        assert_eq!(pixels(&marks), of_truth, "from {from:?} to {to:?}");
        let inked = marks.places().map(|[column, row]| Inked { column, row, distance: 1.0 }).collect();
        assert_eq!(Mask { size: PAGE, inked }.components().len(), 1, "from {from:?} to {to:?}: 8-connected");
        // Thin: no pixel but is passed, and none has ink all about it.
        let length = DVec2::from(from) - DVec2::from(to);
        let most = length.x.abs() + length.y.abs() + 2.0;
        assert!(marks.inked() as f64 <= most, "{} px along {most}", marks.inked());
    }
}

#[test]
fn the_nearest_chain_stands_for_a_pixel_whatever_their_order() {
    let near = chain(&[[10.0, 20.25], [40.0, 20.25]], Line::Border, 0.5);
    let far = chain(&[[20.0, 20.5], [60.0, 20.5]], Line::Skyline, 0.25);
    let across = chain(&[[30.3, 10.0], [30.3, 30.0]], Line::Occluding, 0.375);
    let marks = one_pixel_wide(&[near.clone(), far.clone(), across.clone()], PAGE);
    for other in [[&far, &near, &across], [&across, &far, &near], [&near, &across, &far]] {
        assert_eq!(one_pixel_wide(&other.map(Chain::clone), PAGE), marks);
    }
    let at = |column, row| marks.at(column, row).expect("ink");
    assert_eq!((at(30, 20).pixel.kind(), at(30, 20).pixel.depth()), (Kind::Border, 0.5));
    assert_eq!((at(50, 20).pixel.kind(), at(50, 20).pixel.depth()), (Kind::Silhouette, 0.25));
    assert_eq!([at(50, 20), at(30, 15)].map(|mark| mark.beside_sky), [true, false]);
    assert_eq!(at(30, 15).pixel.place().x, -0.203_125, "to 1/64 px");
    assert_eq!(marks.inked(), 30 + 20 + 19);
}
