//! Chains drawn one pixel wide: the mask of a method that yields curves.
//!
//! Method: that of truth's own drawing, so that the two compare: the line between two points is cut into equal steps of
//! at most a quarter pixel, and the pixels that hold their middles are ink. Neighbouring middles lie in one pixel or in two of
//! 8 neighbours; a corner that the line cuts off by less than a quarter pixel may be missed. Of several chains in a pixel the
//! nearest stands for it, whatever the order in which they are given. Cost: a sort of four places a pixel.

use glam::DVec2;

use super::{Chain, Kind, Line, Mark, Marks, Pixel};
use crate::view::cut::steps;

/// The pixels of a page of this size, px across and down, that chains pass through.
pub fn one_pixel_wide(chains: &[Chain], size: [u32; 2]) -> Marks {
    let mut marks: Vec<Mark> = chains.iter().flat_map(|chain| passed(chain, size)).collect();
    marks.sort_by(|a, b| {
        let key = |mark: &Mark| (mark.row, mark.column);
        let place = |mark: &Mark| mark.pixel.place();
        let [p, q] = [place(a), place(b)];
        let nearest = b.pixel.depth().total_cmp(&a.pixel.depth());
        let middlemost = p.length_squared().total_cmp(&q.length_squared());
        let any = p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y));
        key(a).cmp(&key(b)).then(nearest).then(middlemost).then(any).then(b.beside_sky.cmp(&a.beside_sky))
    });
    marks.dedup_by_key(|mark| (mark.row, mark.column));
    Marks::new(size, marks)
}

/// The pixels that a chain passes through, some several times.
fn passed(chain: &Chain, size: [u32; 2]) -> impl Iterator<Item = Mark> {
    chain.pairs().flat_map(move |[a, b]| {
        steps(size, a.place, b.place).filter_map(move |step| {
            let place = a.place.lerp(b.place, step.middle);
            let [column, row] = place.floor().as_uvec2().to_array();
            let kind = if a.line == Line::Border { Kind::Border } else { Kind::Silhouette };
            let depth = a.depth + (b.depth - a.depth) * step.middle as f32;
            let from_centre = place - DVec2::new(f64::from(column), f64::from(row)) - 0.5;
            let pixel = Pixel::new(kind, from_centre, depth);
            // The page's far edges belong to no pixel.
            let on_page = column < size[0] && row < size[1];
            on_page.then_some(Mark { column, row, pixel, beside_sky: a.line == Line::Skyline })
        })
    })
}
