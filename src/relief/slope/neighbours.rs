//! The lines about a block, and how much room they leave.
//!
//! Pieces of lines lie in buckets of a spacing, each a chain; buckets are searched in rings about a place until what is found is
//! nearer than the next ring. Cost: 0.1 us where a line is near, 1 us where the farthest room is looked for. Memory: 28 bytes a
//! piece, 4 a bucket, while a block is made.

use glam::{DVec2, IVec2, Vec2};

use super::SlopePoint;

/// Longest piece, buckets: it is told from the bend of the line by less than a hundredth of the spacing.
const LONGEST: f32 = 0.125;
/// A line ends so many times as near to the end of another as it runs beside one.
const AHEAD: f32 = 2.0;
/// The end of a chain.
const NONE: u32 = u32::MAX;

/// Pieces of lines in a rectangle.
#[derive(Debug)]
pub(super) struct Neighbours {
    low: DVec2,
    /// Side of a bucket, metres.
    side: f32,
    /// Buckets along x and y.
    size: [i32; 2],
    /// The last piece of each bucket, row by row.
    last: Vec<u32>,
    pieces: Vec<LinePiece>,
    /// Half of the longest piece, metres.
    half: f32,
}

/// A straight piece of a line; metres from the low corner.
#[derive(Debug, Clone, Copy)]
struct LinePiece {
    middle: Vec2,
    way: Vec2,
    half: f32,
    /// The most along it.
    room: f32,
    /// The piece before in its bucket.
    before: u32,
}

impl LinePiece {
    /// From a place, squared: across, and [`AHEAD`] times as far before its ends.
    fn distance_squared(&self, place: Vec2) -> f32 {
        let off = place - self.middle;
        let beyond = AHEAD * (off.dot(self.way).abs() - self.half).max(0.0);
        let across = off.perp_dot(self.way);
        beyond * beyond + across * across
    }
}

impl Neighbours {
    /// None yet, in a rectangle with buckets of a side; metres.
    pub(super) fn new([low, high]: [DVec2; 2], side: f64) -> Self {
        let size = ((high - low) / side).ceil().as_ivec2().to_array().map(|buckets| buckets.max(1));
        let last = vec![NONE; (size[0] * size[1]) as usize];
        Self { low, side: side as f32, size, last, pieces: Vec::new(), half: 0.0 }
    }

    /// Takes in a line whose points lie at most a step apart, metres, as far as it lies in the rectangle; `place` tells their
    /// metres.
    pub(super) fn add(&mut self, line: &[SlopePoint], step: f64, place: impl Fn(&SlopePoint) -> DVec2) {
        let (low, last) = (self.low, line.len() - 1);
        let size = IVec2::from(self.size).as_vec2() * self.side;
        let points = (f64::from(self.side * LONGEST) / step).max(1.0) as usize;
        let near = |k: usize| (place(&line[k]) - low).as_vec2();
        let (mut k, mut from) = (0, near(0));
        while k < last {
            // So many pieces at least lie outside.
            let outside = (from - size).max(-from).max_element();
            let skipped = (f64::from(outside) / step) as usize / points;
            if skipped > 1 {
                k += (skipped - 1) * points;
                from = near(k.min(last));
                continue;
            }
            let end = (k + points).min(last);
            let to = near(end);
            let middle = from.midpoint(to);
            if let Some([x, y]) = self.bucket(middle) {
                let half = from.distance(to) / 2.0;
                let room = line[k..=end].iter().map(|point| point.room).fold(0.0, f32::max);
                let before = &mut self.last[(y * self.size[0] + x) as usize];
                self.pieces.push(LinePiece {
                    middle,
                    way: (to - from).normalize_or_zero(),
                    half,
                    room,
                    before: *before,
                });
                *before = self.pieces.len() as u32 - 1;
                self.half = self.half.max(half);
            }
            (k, from) = (end, to);
        }
    }

    /// Whether no line is so near to a place that has more room than that, metres.
    pub(super) fn leave(&self, place: DVec2, distance: f32) -> bool {
        let place = (place - self.low).as_vec2();
        // Buckets are as wide as spacings: all that is nearer than one lies in those about the place, and in its own most likely.
        let Some([x, y]) = self.bucket(place) else { return true };
        let [columns, rows] = self.size;
        let reach = ((distance + self.half) / self.side).ceil() as i32;
        let is_far = |piece: &LinePiece| piece.distance_squared(place) >= distance.min(piece.room).powi(2);
        let is_clear = |column: i32, row: i32| {
            let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
            !is_inside || self.of_bucket(row * columns + column).all(is_far)
        };
        is_clear(x, y) && (y - reach..=y + reach).all(|row| (x - reach..=x + reach).all(|column| is_clear(column, row)))
    }

    /// How far a place is from the nearest line that has more room than that, at most `most`, metres: across the line, and ahead
    /// of its ends [`AHEAD`] times as far. Anything below `enough` is as good as the least: the search ends there.
    pub(super) fn room(&self, place: DVec2, most: f32, enough: f32) -> f32 {
        let place = (place - self.low).as_vec2();
        let Some([x, y]) = self.bucket(place) else { return most };
        let corner = Vec2::new(x as f32, y as f32) * self.side;
        let aside = (place - corner).min(corner + self.side - place).min_element();
        let [columns, rows] = self.size;
        let mut room = most;
        let mut ring = 0;
        while room >= enough && (ring as f32 - 1.0) * self.side + aside - self.half < room {
            let [west, east] = [x - ring, x + ring];
            for row in (y - ring).max(0)..=(y + ring).min(rows - 1) {
                let of_row = row * columns;
                if (row - y).abs() == ring {
                    let all = west.max(0)..=east.min(columns - 1);
                    room = all.fold(room, |room, column| self.room_in(of_row + column, place, room));
                } else {
                    let both = [west, east].into_iter().filter(|column| *column >= 0 && *column < columns);
                    room = both.fold(room, |room, column| self.room_in(of_row + column, place, room));
                }
            }
            ring += 1;
        }
        room
    }

    /// The same, of the lines in a bucket.
    fn room_in(&self, bucket: i32, place: Vec2, most: f32) -> f32 {
        self.of_bucket(bucket).fold(most, |room, piece| {
            let distance = piece.distance_squared(place);
            if distance < room * room && distance < piece.room * piece.room { distance.sqrt() } else { room }
        })
    }

    fn of_bucket(&self, bucket: i32) -> impl Iterator<Item = &LinePiece> {
        let first = self.pieces.get(self.last[bucket as usize] as usize);
        std::iter::successors(first, |piece| self.pieces.get(piece.before as usize))
    }

    /// Column and row of the bucket of a place in the rectangle.
    fn bucket(&self, place: Vec2) -> Option<[i32; 2]> {
        let [x, y] = [place.x / self.side, place.y / self.side];
        let inside = x >= 0.0 && y >= 0.0 && x < self.size[0] as f32 && y < self.size[1] as f32;
        inside.then_some([x as i32, y as i32])
    }
}
