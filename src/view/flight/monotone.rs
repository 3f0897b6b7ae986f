//! Smooth numbers between given ones that never overshoot them: piecewise cubics with slopes by Fritsch and Butland.
//!
//! Fritsch, Butland 1984, "A method for constructing local monotone piecewise cubic interpolants": the slope at a knot is
//! the weighted harmonic mean of those on both sides, 0 where they differ in sign. Where the numbers rise or fall the
//! curve does, where they stay it stays, and its slope has no jumps. Cost: one search a value. Its second derivative may jump.

/// A smooth function through knots.
#[derive(Debug, Clone)]
pub(super) struct Monotone {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

impl Monotone {
    /// One number everywhere.
    pub(super) fn constant(y: f64) -> Self {
        Self { x: vec![0.0], y: vec![y], slope: vec![0.0] }
    }

    /// Through (x, y), x rising, at least one; beyond its ends it stays as it is there.
    pub(super) fn new(x: &[f64], y: &[f64]) -> Self {
        let steps: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
        let rises: Vec<f64> = y.windows(2).zip(&steps).map(|(y, step)| (y[1] - y[0]) / step).collect();
        let slope = (0..x.len().min(y.len())).map(|i| slope(&steps, &rises, i)).collect();
        Self { x: x.to_vec(), y: y.to_vec(), slope }
    }

    /// The same for what comes round: the last knot is the first again, higher by `rise`, and is as smooth as the others.
    pub(super) fn closed(x: &[f64], y: &[f64], rise: f64) -> Self {
        let count = x.len();
        if count < 3 {
            return Self::new(x, y);
        }
        let length = x[count - 1] - x[0];
        let around: Vec<(f64, f64)> = [(x[count - 2] - length, y[count - 2] - rise)]
            .into_iter()
            .chain(x.iter().copied().zip(y.iter().copied()))
            .chain([(x[1] + length, y[1] + rise)])
            .collect();
        let (x, y): (Vec<f64>, Vec<f64>) = around.into_iter().unzip();
        let Self { x, y, slope } = Self::new(&x, &y);
        Self { x: x[1..=count].to_vec(), y: y[1..=count].to_vec(), slope: slope[1..=count].to_vec() }
    }

    /// Its value.
    pub(super) fn at(&self, at: f64) -> f64 {
        let i = self.x.partition_point(|x| *x <= at);
        if i == 0 || i == self.x.len() {
            return self.y[i.saturating_sub(1)];
        }
        let step = self.x[i] - self.x[i - 1];
        let t = (at - self.x[i - 1]) / step;
        let (low, high) = (self.y[i - 1], self.y[i]);
        let bend = t * (1.0 - t);
        let shares = [self.slope[i - 1] * step * bend * (1.0 - t), -self.slope[i] * step * bend * t];
        low + (high - low) * t * t * (3.0 - 2.0 * t) + shares[0] + shares[1]
    }

    /// The first x at which a function that never falls is `y` or more.
    pub(super) fn first_at(&self, y: f64) -> f64 {
        self.parted(|value| value < y)[1]
    }

    /// The last x at which a function that never falls is `y` or less.
    pub(super) fn last_at(&self, y: f64) -> f64 {
        self.parted(|value| value <= y)[0]
    }

    /// Neighbouring numbers, the last one `before` something and the first one after, or an end of the function.
    fn parted(&self, before: impl Fn(f64) -> bool) -> [f64; 2] {
        let [mut low, mut high] = [self.x[0], self.x[self.x.len() - 1]];
        if !before(self.at(low)) {
            return [low; 2];
        }
        if before(self.at(high)) {
            return [high; 2];
        }
        // Until no number lies between, which halving reaches.
        loop {
            let middle = low + (high - low) / 2.0;
            if middle <= low || middle >= high {
                return [low, high];
            }
            if before(self.at(middle)) { low = middle } else { high = middle }
        }
    }
}

/// The slope at knot `i` from the rises of the pieces beside it.
fn slope(steps: &[f64], rises: &[f64], i: usize) -> f64 {
    let last = rises.len();
    match (i, last) {
        (_, 0) => 0.0,
        (_, 1) => rises[0],
        (0, _) => at_end([steps[0], steps[1]], [rises[0], rises[1]]),
        _ if i == last => at_end([steps[last - 1], steps[last - 2]], [rises[last - 1], rises[last - 2]]),
        _ => {
            let ([h, k], [r, s]) = ([steps[i - 1], steps[i]], [rises[i - 1], rises[i]]);
            if r * s <= 0.0 { 0.0 } else { 3.0 * (h + k) / ((2.0 * k + h) / r + (k + 2.0 * h) / s) }
        }
    }
}

/// At an end: that of the parabola through three knots, held so that nothing overshoots.
fn at_end([h, k]: [f64; 2], [r, s]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h + k) * r - h * s) / (h + k);
    if slope * r <= 0.0 {
        0.0
    } else if r * s <= 0.0 && slope.abs() > 3.0 * r.abs() {
        3.0 * r
    } else {
        slope
    }
}
