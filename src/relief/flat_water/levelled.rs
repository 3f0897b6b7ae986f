//! Heights of which those that are nearly level are level, so that equal heights tell water.
//!
//! Water that someone made level is not always so to the last bit: files put it together of parts that differ by decimetres,
//! and who warps a DEM leaves waves beside its shores (cubic weights swing below by 7 % of what rises there).
//!
//! Method: equal heights that share edges and hold a block of 3 x 3 are a flat. Flats that lie within two samples of each
//! other and three quarters of a metre of the largest among them are one. What lies beside a flat and below it, down to as much,
//! is under water, too. Samples that are almost surrounded by a flat at such a height belong to it, and those that lie below
//! it, or hardly above, as a wave does. Land beside a flat is as far above it as above the part of it that lies there.

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use crate::dem::Samples;

/// How far parts of one water may lie apart, metres.
const APART: f32 = 0.75;
/// Samples between flats that are one.
const BETWEEN: usize = 3;
/// Fewest samples of a flat to which others are added.
const LEAST: u32 = 64;
/// Samples about one in which it is looked for a flat: farther away outlets of steep valleys would count as waves.
const ABOUT: usize = 2;
/// How many of those are of a flat where that almost surrounds it, of how many.
const SURROUNDED: [usize; 2] = [2, 3];
/// Fewest samples of a flat about a wave beside it.
const SOME: usize = 3;
/// How far a wave swings below its water and above, in shares of the relief about it.
const WAVE: [f32; 2] = [0.15, 0.015];

/// Equal heights that hang together.
struct Flat {
    height: f32,
    samples: u32,
}

/// The heights of all samples, NaN at voids. They are multiplied by `exaggeration`, before and afterwards.
pub(super) fn levelled(samples: &Samples, exaggeration: f32) -> Vec<f32> {
    let [columns, rows] = samples.size();
    let mut heights = vec![f32::NAN; columns * rows];
    heights.par_chunks_mut(columns).enumerate().for_each(|(r, row)| {
        row.iter_mut().zip(samples.row_from(0, r)).for_each(|(onto, height)| *onto = height.unwrap_or(f32::NAN));
    });
    let apart = APART * exaggeration;
    let (mut labels, flats) = flats(&heights, columns);
    let merged = merged(&flats, &neighbours(&labels, &flats, columns, apart), apart);
    // From here on a label is that of the flat that others are part of.
    labels.par_iter_mut().for_each(|label| *label = merged[*label as usize]);
    flood(&mut labels, &heights, columns, |label| flats[label as usize].height - apart);
    let mut level = vec![0.0; heights.len()];
    level.par_chunks_mut(columns).enumerate().for_each(|(r, row)| {
        for (c, level) in row.iter_mut().enumerate() {
            let i = r * columns + c;
            let of = |label: u32| flats[label as usize].height;
            *level = match labels[i] {
                0 => match beside(&heights, &labels, columns, [c, r], apart) {
                    Some(flat) => of(flat),
                    // The land stands over its own part of the water, whatever the level of others.
                    None => four(i, columns, labels.len())
                        .find(|i| labels[*i] != 0)
                        .map_or(heights[i], |wet| heights[i] + (of(labels[wet]) - heights[wet])),
                },
                label => of(label),
            };
        }
    });
    level
}

/// The flat of each sample, by its place in the list, which holds none in its first place.
fn flats(heights: &[f32], columns: usize) -> (Vec<u32>, Vec<Flat>) {
    let rows = heights.len() / columns;
    let is_block = |i: usize| {
        let (c, r) = (i % columns, i / columns);
        // Hardly any sample comes farther.
        if c + 1 < columns && heights[i + 1] != heights[i] {
            return false;
        }
        let mut around = (r.saturating_sub(1)..(r + 2).min(rows))
            .flat_map(|r| (c.saturating_sub(1)..(c + 2).min(columns)).map(move |c| r * columns + c));
        around.all(|other| heights[other] == heights[i])
    };
    let mut labels = vec![0; heights.len()];
    let mut flats = vec![Flat { height: f32::NAN, samples: 0 }];
    let mut open = Vec::new();
    for start in 0..heights.len() {
        if labels[start] != 0 || !is_block(start) {
            continue;
        }
        let label = flats.len() as u32;
        let mut flat = Flat { height: heights[start], samples: 0 };
        labels[start] = label;
        open.push(start);
        while let Some(i) = open.pop() {
            flat.samples += 1;
            for other in four(i, columns, heights.len()) {
                if labels[other] == 0 && heights[other] == flat.height {
                    labels[other] = label;
                    open.push(other);
                }
            }
        }
        flats.push(flat);
    }
    (labels, flats)
}

/// The samples that share an edge with one of so many.
pub(super) fn four(i: usize, columns: usize, samples: usize) -> impl Iterator<Item = usize> {
    let c = i % columns;
    let [west, east] = [(c > 0).then(|| i - 1), (c + 1 < columns).then(|| i + 1)];
    let south = Some(i + columns).filter(|south| *south < samples);
    [west, east, i.checked_sub(columns), south].into_iter().flatten()
}

/// Pairs of flats that lie near each other and at nearly the same height, each both ways, in order.
fn neighbours(labels: &[u32], flats: &[Flat], columns: usize, apart: f32) -> Vec<[u32; 2]> {
    let of_row = |r: usize| {
        let mut pairs = FxHashSet::default();
        for (c, i) in (0..columns).map(|c| (c, r * columns + c)).filter(|(_, i)| labels[*i] != 0) {
            let east = (1..=BETWEEN).take_while(|k| c + k < columns).map(|k| i + k);
            let south = (1..=BETWEEN).map(|k| i + k * columns).take_while(|i| *i < labels.len());
            for other in
                [east.clone().find(|i| labels[*i] != 0), south.clone().find(|i| labels[*i] != 0)].into_iter().flatten()
            {
                let [a, b] = [labels[i], labels[other]];
                if a != b && (flats[a as usize].height - flats[b as usize].height).abs() <= apart {
                    pairs.extend([[a, b], [b, a]]);
                }
            }
        }
        pairs
    };
    let rows = (0..labels.len() / columns).into_par_iter().map(of_row);
    let pairs = rows.reduce(FxHashSet::default, |mut one, other| {
        one.extend(other);
        one
    });
    let mut pairs: Vec<_> = pairs.into_iter().collect();
    pairs.sort_unstable();
    pairs
}

/// The flat that each flat is part of; 0 where it is too small to be one.
fn merged(flats: &[Flat], neighbours: &[[u32; 2]], apart: f32) -> Vec<u32> {
    let mut merged = vec![0; flats.len()];
    let mut order: Vec<u32> = (1..flats.len() as u32).collect();
    order.sort_by_key(|label| (std::cmp::Reverse(flats[*label as usize].samples), *label));
    let mut open = Vec::new();
    for root in order {
        if merged[root as usize] != 0 || flats[root as usize].samples < LEAST {
            continue;
        }
        merged[root as usize] = root;
        open.push(root);
        while let Some(flat) = open.pop() {
            let first = neighbours.partition_point(|[of, _]| *of < flat);
            let near = neighbours[first..].iter().take_while(|[of, _]| *of == flat).map(|[_, near]| *near);
            for near in near {
                let is_level = (flats[near as usize].height - flats[root as usize].height).abs() <= apart;
                if is_level && merged[near as usize] == 0 {
                    merged[near as usize] = root;
                    open.push(near);
                }
            }
        }
    }
    merged
}

/// Labels what lies beside a flat and not above it, down to the lowest height that a flat may have.
fn flood(labels: &mut [u32], heights: &[f32], columns: usize, lowest: impl Fn(u32) -> f32 + Sync) {
    let wet = |labels: &[u32], i: usize, other: usize| {
        labels[other] == 0 && heights[other] <= heights[i] && heights[other] >= lowest(labels[i])
    };
    let at_rim = |i: &usize| labels[*i] != 0 && four(*i, columns, labels.len()).any(|other| wet(labels, *i, other));
    let mut open: Vec<usize> = (0..labels.len()).into_par_iter().filter(at_rim).collect();
    while let Some(i) = open.pop() {
        for other in four(i, columns, labels.len()) {
            if wet(labels, i, other) {
                labels[other] = labels[i];
                open.push(other);
            }
        }
    }
}

/// The flat that a sample of none belongs to all the same.
fn beside(heights: &[f32], labels: &[u32], columns: usize, [c, r]: [usize; 2], apart: f32) -> Option<u32> {
    let rows = labels.len() / columns;
    let span = |at: usize, end: usize| at.saturating_sub(ABOUT)..(at + ABOUT + 1).min(end);
    let around = || span(r, rows).flat_map(|r| span(c, columns).map(move |c| r * columns + c));
    let first = around().find(|i| labels[*i] != 0)?;
    // What was flooded may lie below the level.
    let (mut all, mut of_flat, mut level) = (0, 0, f32::NEG_INFINITY);
    let mut range = [f32::INFINITY, f32::NEG_INFINITY];
    for i in around() {
        all += 1;
        if labels[i] == labels[first] {
            of_flat += 1;
            level = level.max(heights[i]);
        }
        // Voids count for nothing here.
        range = [range[0].min(heights[i]), range[1].max(heights[i])];
    }
    let (above, relief) = (heights[r * columns + c] - level, range[1] - range[0]);
    let is_surrounded = of_flat * SURROUNDED[1] >= all * SURROUNDED[0] && above.abs() <= apart;
    let is_wave = of_flat >= SOME && (-WAVE[0] * relief..=WAVE[1] * relief).contains(&above);
    (is_surrounded || is_wave).then_some(labels[first])
}
