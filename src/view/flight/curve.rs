//! The way over the map, by metres from its start: a centripetal Catmull-Rom spline, or a circle.
//!
//! Yuksel, Schaefer, Keyser 2011, "Parameterization and applications of Catmull-Rom curves": knots apart by the square
//! root of the distance make no cusp and no loop within a piece, wherever the points lie. At an open end the last piece
//! leaves straight for its point. The length comes by Gauss and Legendre over parts that are halved until both halves
//! agree with the whole, the way back from metres to a place by Newton within a part: both to about 1e-10. The tangent has
//! no jumps but where the way turns right back. Cost: some tens of parts a piece, once; a search and five places a place.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

/// Nodes and weights of Gauss and Legendre on 0 to 1, five of them.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];
/// By how much of it two halves may differ from the whole.
const AGREED: f64 = 1e-10;
/// How often a piece is halved at least and at most.
const HALVINGS: [u32; 2] = [4, 16];
/// A tangent is taken so far within a piece, as a share: at its end it may be nought.
const WITHIN: f64 = 1e-6;
/// Turns that differ by less from right back are right back, clockwise: radians.
const RIGHT_BACK: f64 = 1e-6;

/// A way over the map.
#[derive(Debug, Clone)]
pub(super) enum Curve {
    /// Through points.
    Spline(Spline),
    /// Clockwise around a centre, from its south.
    Circle {
        /// Metres of the world.
        centre: DVec2,
        /// Metres.
        radius: f64,
    },
}

/// Cubic pieces and how long they are.
#[derive(Debug, Clone)]
pub(super) struct Spline {
    pieces: Vec<Cubic>,
    parts: Vec<Part>,
    /// Metres to each point; of a closed one to the first again.
    pub knots: Vec<f64>,
    length: f64,
    closed: bool,
}

/// A cubic over 0 to 1, by powers.
#[derive(Debug, Clone, Copy)]
struct Cubic([DVec2; 4]);

/// A part of a piece.
#[derive(Debug, Clone, Copy)]
struct Part {
    piece: usize,
    from: f64,
    to: f64,
    /// Metres from the start.
    metres: f64,
    length: f64,
}

impl Curve {
    /// Metres over ground.
    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Spline(spline) => spline.length,
            Self::Circle { radius, .. } => TAU * radius,
        }
    }

    /// Whether it ends where it begins.
    pub(super) fn is_closed(&self) -> bool {
        match self {
            Self::Spline(spline) => spline.closed,
            Self::Circle { .. } => true,
        }
    }

    /// The place so many metres from its start.
    pub(super) fn place(&self, metres: f64) -> DVec2 {
        match self {
            Self::Spline(spline) => spline.place(metres),
            Self::Circle { centre, radius } => {
                let (sin, cos) = (metres / radius + PI).sin_cos();
                *centre + DVec2::new(sin, cos) * *radius
            }
        }
    }
}

impl Spline {
    /// Through points, at least two, none where the one before it is; a closed one goes on from the last to the first.
    pub(super) fn new(points: &[DVec2], closed: bool) -> Self {
        let count = points.len();
        let point = |i: isize| match closed {
            true => points[i.rem_euclid(count as isize) as usize],
            // Beyond an end lies the image of the second point.
            false if i < 0 => 2.0 * points[0] - points[1],
            false if i >= count as isize => 2.0 * points[count - 1] - points[count - 2],
            false => points[i as usize],
        };
        let pieces = if closed { count } else { count - 1 };
        let pieces: Vec<_> =
            (0..pieces as isize).map(|i| Cubic::through([-1, 0, 1, 2].map(|d| point(i + d)))).collect();
        let (mut parts, mut knots, mut metres) = (Vec::new(), vec![0.0], 0.0);
        for (number, piece) in pieces.iter().enumerate() {
            piece.part(0.0, 1.0, piece.length(0.0, 1.0), 0, &mut |from, to, length| {
                parts.push(Part { piece: number, from, to, metres, length });
                metres += length;
            });
            knots.push(metres);
        }
        Self { pieces, parts, knots, length: metres, closed }
    }

    fn place(&self, metres: f64) -> DVec2 {
        let i = self.parts.partition_point(|part| part.metres <= metres).saturating_sub(1);
        let Some(part) = self.parts.get(i) else { return DVec2::ZERO };
        let piece = &self.pieces[part.piece];
        let wanted = (metres - part.metres).clamp(0.0, part.length);
        let (mut low, mut high) = (part.from, part.to);
        let mut at = low + (high - low) * wanted / part.length.max(f64::MIN_POSITIVE);
        for _ in 0..40 {
            let off = piece.length(part.from, at) - wanted;
            if off.abs() <= AGREED * part.length {
                break;
            }
            if off < 0.0 {
                low = at
            } else {
                high = at
            }
            let next = at - off / piece.slope(at).length();
            at = if next > low && next < high { next } else { low + (high - low) / 2.0 };
        }
        piece.at(at)
    }

    /// Directions in the map along the way, radians clockwise from the y axis, not leaping at a full turn: (metres, radians),
    /// and how far a closed way turns in all.
    pub(super) fn headings(&self) -> (Vec<(f64, f64)>, f64) {
        let mut nodes: Vec<(f64, f64)> = Vec::new();
        let mut on = |metres: f64, slope: DVec2| {
            let heading = slope.x.atan2(slope.y);
            let heading = nodes.last().map_or(heading, |(_, last)| last + turned(heading - last));
            nodes.push((metres, heading));
        };
        for part in &self.parts {
            let piece = &self.pieces[part.piece];
            let within = WITHIN * (part.to - part.from);
            on(part.metres, piece.slope(part.from + within));
            on(part.metres + part.length, piece.slope(part.to - within));
        }
        let (Some((_, first)), Some((_, last))) = (nodes.first(), nodes.last()) else { return (nodes, 0.0) };
        let round = last + turned(first - last) - first;
        (nodes, round)
    }
}

impl Cubic {
    /// From the second of four points to the third: tangents by Barry and Goldman's recursion over centripetal knots.
    fn through([before, from, to, after]: [DVec2; 4]) -> Self {
        let apart = |a: DVec2, b: DVec2| a.distance(b).sqrt();
        let [first, own, last] = [apart(before, from), apart(from, to), apart(to, after)];
        let way = to - from;
        let leaving = own * (way / own + (from - before) / first - (to - before) / (first + own));
        let coming = own * (way / own + (after - to) / last - (after - from) / (own + last));
        Self([from, leaving, 3.0 * way - 2.0 * leaving - coming, leaving + coming - 2.0 * way])
    }

    fn at(&self, u: f64) -> DVec2 {
        let [a, b, c, d] = self.0;
        a + u * (b + u * (c + u * d))
    }

    fn slope(&self, u: f64) -> DVec2 {
        let [_, b, c, d] = self.0;
        b + u * (2.0 * c + u * 3.0 * d)
    }

    fn length(&self, from: f64, to: f64) -> f64 {
        let step = to - from;
        GAUSS.iter().map(|(node, weight)| weight * self.slope(from + node * step).length()).sum::<f64>() * step
    }

    /// Hands over parts whose length is well known.
    fn part(&self, from: f64, to: f64, length: f64, depth: u32, take: &mut impl FnMut(f64, f64, f64)) {
        let [least, most] = HALVINGS;
        let middle = (from + to) / 2.0;
        let halves = [self.length(from, middle), self.length(middle, to)];
        let agreed = (halves[0] + halves[1] - length).abs() <= AGREED * length;
        if depth >= most || depth >= least && agreed {
            take(from, to, halves[0] + halves[1]);
        } else {
            self.part(from, middle, halves[0], depth + 1, take);
            self.part(middle, to, halves[1], depth + 1, take);
        }
    }
}

/// A difference of directions to within half a turn, right back clockwise whatever was rounded.
fn turned(difference: f64) -> f64 {
    let turn = difference - TAU * (difference / TAU).round();
    if turn < RIGHT_BACK - PI { turn + TAU } else { turn }
}
