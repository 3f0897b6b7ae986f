//! Which label each piece of a line bears, where pieces speak for labels and changes are dear.
//!
//! Method: dynamic programming over the pieces (Viterbi 1967): the labels whose costs, and those of the changes between
//! them, are least in all. Cost: pieces times labels. Does not handle: closed lines, which are cut open somewhere.

/// A piece of a line among others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Labelled<const N: usize> {
    /// What each label costs here.
    pub costs: [f64; N],
    /// By how much the label is expected to change before this piece; more than the last label is the last one.
    pub step: isize,
}

/// The cheapest labels, where any change but the expected one costs `change`. Of equals the expected one, then the lowest.
pub(super) fn cheapest<const N: usize>(pieces: &[Labelled<N>], change: f64) -> Vec<usize> {
    let mut costs = [0.0; N];
    let mut came = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let lowest = lowest(&costs);
        let mut from = [lowest; N];
        let mut next = [costs[lowest] + change; N];
        for (label, &cost) in costs.iter().enumerate() {
            let Some(to) = label.checked_add_signed(piece.step) else { continue };
            let to = to.min(N - 1);
            if cost <= next[to] {
                (next[to], from[to]) = (cost, label);
            }
        }
        came.push(from);
        costs = std::array::from_fn(|label| next[label] + piece.costs[label]);
    }
    let mut label = lowest(&costs);
    let mut labels = vec![0; pieces.len()];
    for (i, from) in came.iter().enumerate().rev() {
        labels[i] = label;
        label = from[label];
    }
    labels
}

/// The first label of the least cost.
fn lowest<const N: usize>(costs: &[f64; N]) -> usize {
    (1..N).fold(0, |low, label| if costs[label] < costs[low] { label } else { low })
}
