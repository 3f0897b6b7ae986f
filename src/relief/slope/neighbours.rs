//! The lines about a block, and how much room they leave.
//!
//! Pieces of lines lie in buckets of a spacing, each a chain; buckets are searched in rings about a place until what is found is
//! nearer than the next ring. Cost: 0.1 us where a line is near, 1 us where the farthest room is looked for. Memory: 28 bytes a
//! piece, 4 a bucket, while a block is made.

use glam::{DVec2, Vec2};

/// Longest piece, buckets: it is told from the bend of the line by less than a hundredth of the spacing.
const LONGEST: f32 = 0.125;
/// The end of a chain.
const NONE: u32 = u32::MAX;

/// Pieces of lines in a rectangle.
#[derive(Debug)]
pub struct Neighbours {
    low: DVec2,
    /// Side of a bucket, metres.
    side: f32,
    /// Buckets along x and y.
    size: [i32; 2],
    /// The last piece of each bucket, row by row.
    last: Vec<u32>,
    pieces: Vec<Piece>,
    /// Half of the longest piece, metres.
    half: f32,
}

/// A straight piece of a line; metres from the low corner.
#[derive(Debug, Clone, Copy)]
struct Piece {
    middle: Vec2,
    way: Vec2,
    half: f32,
    /// The most along it.
    room: f32,
    /// The piece before in its bucket.
    before: u32,
}

/// A place of a line, and the room that it has; metres.
pub type Spaced = (DVec2, f32);

impl Neighbours {
    /// None yet, in a rectangle with buckets of a side; metres.
    pub fn new([low, high]: [DVec2; 2], side: f64) -> Self {
        let size = ((high - low) / side).ceil().as_ivec2().to_array().map(|buckets| buckets.max(1));
        let last = vec![NONE; (size[0] * size[1]) as usize];
        Self { low, side: side as f32, size, last, pieces: Vec::new(), half: 0.0 }
    }

    /// Takes in a line whose points lie a step apart, as far as it lies in the rectangle.
    pub fn add(&mut self, line: &[Spaced], step: f64) {
        let points = ((self.side * LONGEST) as f64 / step).max(1.0) as usize;
        for from in (0..line.len() - 1).step_by(points) {
            let part = &line[from..=(from + points).min(line.len() - 1)];
            let [a, b] = [0, part.len() - 1].map(|k| (part[k].0 - self.low).as_vec2());
            let middle = a.midpoint(b);
            let [x, y] = self.bucket(middle);
            if x < 0 || y < 0 || x >= self.size[0] || y >= self.size[1] {
                continue;
            }
            let half = a.distance(b) / 2.0;
            let room = part.iter().map(|(_, room)| *room).fold(0.0, f32::max);
            let last = &mut self.last[(y * self.size[0] + x) as usize];
            self.pieces.push(Piece { middle, way: (b - a).normalize_or_zero(), half, room, before: *last });
            *last = self.pieces.len() as u32 - 1;
            self.half = self.half.max(half);
        }
    }

    /// How far a place is from the nearest line that has more room than that, at most `most`; metres. Anything below `enough` is as
    /// good as the least: the search ends there.
    pub fn room(&self, place: DVec2, most: f32, enough: f32) -> f32 {
        let place = (place - self.low).as_vec2();
        let [x, y] = self.bucket(place);
        let aside = place - Vec2::new(x as f32, y as f32) * self.side;
        let aside = aside.min(Vec2::splat(self.side) - aside).min_element();
        let mut room = most;
        let mut ring = 0;
        while room >= enough && (ring as f32 - 1.0) * self.side + aside - self.half < room {
            for row in (y - ring).max(0)..=(y + ring).min(self.size[1] - 1) {
                let step = if (row - y).abs() == ring { 1 } else { 2 * ring };
                let columns = (x - ring..=x + ring).step_by(step as usize);
                for column in columns.filter(|column| (0..self.size[0]).contains(column)) {
                    room = self.room_in((row * self.size[0] + column) as usize, place, room);
                }
            }
            ring += 1;
        }
        room
    }

    /// The same, of the lines in a bucket.
    fn room_in(&self, bucket: usize, place: Vec2, most: f32) -> f32 {
        let first = self.pieces.get(self.last[bucket] as usize);
        let chain = std::iter::successors(first, |piece| self.pieces.get(piece.before as usize));
        chain.fold(most, |room, piece| {
            let off = place - piece.middle;
            let beyond = (off.dot(piece.way).abs() - piece.half).max(0.0);
            let across = off.perp_dot(piece.way);
            let squared = beyond * beyond + across * across;
            if squared < room * room && squared < piece.room * piece.room { squared.sqrt() } else { room }
        })
    }

    fn bucket(&self, place: Vec2) -> [i32; 2] {
        (place / self.side).floor().as_ivec2().to_array()
    }
}
