//! Lines that chains or the mask have alone are counted.

use glam::{DVec2, DVec3};
use hachure::line::{Chain, ChainPoint, Kind, Line, Mark, Marks, Pixel, Strays};

const PAGE: [u32; 2] = [64, 32];

fn row_of_ink(row: u32, columns: std::ops::Range<u32>) -> impl Iterator<Item = Mark> {
    columns.map(move |column| {
        let pixel = Pixel::new(Kind::Silhouette, DVec2::ZERO, 0.1);
        Mark { column, row, pixel, beside_sky: false }
    })
}

fn level_chain(y: f64, from: f64, to: f64) -> Chain {
    let point = |x: f64| ChainPoint {
        place: DVec2::new(x, y),
        line: Line::Occluding,
        depth: 0.1,
        behind: 0.0,
        world: DVec3::ZERO,
        crowd: 0,
        weight: 1.0,
    };
    Chain { id: None, points: [from, to].map(point).to_vec(), closed: false }
}

fn strays(chains: &[Chain], ink: Vec<Mark>) -> [usize; 2] {
    let Strays { chains, ink } = Strays::of(chains, &Marks::new(PAGE, ink));
    [chains, ink]
}

#[test]
fn what_one_of_them_has_alone_is_counted() {
    let chain = level_chain(10.5, 4.0, 24.0);
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(10, 4..24).collect()), [0, 0]);
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(11, 4..24).collect()), [0, 0], "a pixel beside it");
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(12, 4..24).collect()), [20, 20], "two pixels");
    assert_eq!(strays(std::slice::from_ref(&chain), row_of_ink(10, 4..14).collect()), [9, 0], "half the ink");
    let specks = row_of_ink(10, 4..24).chain(row_of_ink(20, 4..9)).chain(row_of_ink(25, 4..10));
    assert_eq!(strays(&[chain], specks.collect()), [0, 6], "five pixels are no line");
    assert_eq!(strays(&[], Vec::new()), [0, 0]);
}
