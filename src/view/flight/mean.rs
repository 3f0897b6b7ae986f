//! Means of a function of straight pieces under a sliding triangle, from its second antiderivative.
//!
//! The weight falls from the middle of a window to both its ends, so that the mean has a slope without jumps wherever the
//! function is continuous, and bends by at most four times the function's range over the square of the half window, even
//! where the function jumps. The triangle is two boxes, one over the other: (G(x + h) - 2 G(x) + G(x - h)) / h^2 with
//! G'' = y. Exact but for rounding, about 1e-16 of the range times the square of length over h. Cost: three searches a mean.

/// A function of straight pieces.
#[derive(Debug, Clone)]
pub(super) struct Pieces {
    x: Vec<f64>,
    y: Vec<f64>,
    /// First and second antiderivative at each node.
    sums: Vec<[f64; 2]>,
}

impl Pieces {
    /// Through nodes (x, y), at least one, x never falling: two nodes at one x are a jump. Beyond its ends it is level.
    pub(super) fn new(nodes: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = nodes.into_iter().unzip();
        let base = y.first().copied().unwrap_or_default();
        let mut sums = vec![[0.0; 2]; x.len()];
        for i in 1..x.len() {
            let (h, low, high) = (x[i] - x[i - 1], y[i - 1] - base, y[i] - base);
            let [first, second] = sums[i - 1];
            sums[i] = [first + h * (low + high) / 2.0, second + h * (first + h * (2.0 * low + high) / 6.0)];
        }
        Self { x, y, sums }
    }

    /// The second antiderivative of what it has more than its first node.
    fn twice(&self, at: f64) -> f64 {
        let i = self.x.partition_point(|x| *x <= at).saturating_sub(1);
        let (Some(x), Some(y), Some([first, second])) = (self.x.get(i), self.y.get(i), self.sums.get(i)) else {
            return 0.0;
        };
        let (h, y) = (at - x, y - self.y[0]);
        let slope = match (self.x.get(i + 1), self.y.get(i + 1)) {
            (Some(next), Some(high)) if at > *x && next > x => (high - self.y[0] - y) / (next - x),
            _ => 0.0,
        };
        second + h * (first + h * (y / 2.0 + h * slope / 6.0))
    }

    /// Its mean over `at` - `half` to `at` + `half`, weighted by a triangle; `half` above 0.
    pub(super) fn mean(&self, at: f64, half: f64) -> f64 {
        let base = self.y.first().copied().unwrap_or_default();
        let sum = self.twice(at + half) - 2.0 * self.twice(at) + self.twice(at - half);
        base + sum / (half * half)
    }

    /// Largest less smallest value.
    pub(super) fn range(&self) -> f64 {
        let low = self.y.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self.y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (high - low).max(0.0)
    }
}

/// How a function goes on beyond the ends of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// As its own image, turned about its end: a slope goes on, and the mean at the end is the value there.
    Turned,
    /// As it began, higher by so much each time round.
    Again(f64),
}

/// Nodes over 0 to `length`, and as many before and after.
pub(super) fn beyond(nodes: &[(f64, f64)], length: f64, how: Beyond) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (nodes.first(), nodes.last()) else { return Vec::new() };
    let turned = |about: &(f64, f64), node: &(f64, f64)| (2.0 * about.0 - node.0, 2.0 * about.1 - node.1);
    let (before, after): (Vec<_>, Vec<_>) = match how {
        Beyond::Turned => (
            nodes.iter().skip(1).rev().map(|node| turned(first, node)).collect(),
            nodes.iter().rev().skip(1).map(|node| turned(last, node)).collect(),
        ),
        Beyond::Again(rise) => (
            nodes.iter().map(|(x, y)| (x - length, y - rise)).collect(),
            nodes.iter().map(|(x, y)| (x + length, y + rise)).collect(),
        ),
    };
    [&before[..], nodes, &after[..]].concat()
}
