//! The connected parts of some samples of a grid, corners count.
//!
//! Method: one pass in reading order, equal labels joined in a forest (Hoshen, Kopelman 1976, Percolation and cluster
//! distribution, Physical Review B 14). Cost: four looks a sample and 4 bytes.

/// The label of samples that are in no part.
pub(super) const NONE: u32 = u32::MAX;

/// The part of each of `size` samples (columns, rows), from 0, [`NONE`] where `is_in` does not hold, and how many there are.
pub(super) fn parts(size: [usize; 2], is_in: impl Fn(usize) -> bool) -> (Vec<u32>, usize) {
    let [columns, rows] = size;
    let mut labels = vec![NONE; columns * rows];
    let mut forest: Vec<u32> = Vec::new();
    for i in (0..columns * rows).filter(|i| is_in(*i)) {
        let (c, above) = (i % columns, i >= columns);
        let left = c > 0;
        let before = [
            left.then(|| i - 1),
            (left && above).then(|| i - columns - 1),
            above.then(|| i - columns),
            (above && c + 1 < columns).then(|| i + 1 - columns),
        ];
        let mut own = NONE;
        for label in before.into_iter().flatten().map(|i| labels[i]).filter(|label| *label != NONE) {
            let [one, other] = [own.min(label), label].map(|label| root(&mut forest, label));
            own = one.min(other);
            forest[one.max(other) as usize] = own;
        }
        if own == NONE {
            own = forest.len() as u32;
            forest.push(own);
        }
        labels[i] = own;
    }
    // Roots come before their branches.
    let mut count = 0;
    let mut numbers = vec![0; forest.len()];
    for label in 0..forest.len() {
        let root = root(&mut forest, label as u32) as usize;
        if root == label {
            numbers[label] = count;
            count += 1;
        } else {
            numbers[label] = numbers[root];
        }
    }
    labels.iter_mut().filter(|label| **label != NONE).for_each(|label| *label = numbers[*label as usize]);
    (labels, count as usize)
}

/// The first of all labels that are joined with this one.
fn root(forest: &mut [u32], mut label: u32) -> u32 {
    while forest[label as usize] != label {
        forest[label as usize] = forest[forest[label as usize] as usize];
        label = forest[label as usize];
    }
    label
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_hold_together_by_sides_and_corners() {
        let map = ["x.x....x", "x.x...x.", "xxx.x...", ".....x.x", "xx.....x"];
        let samples: Vec<bool> = map.iter().flat_map(|row| row.chars().map(|c| c == 'x')).collect();
        let (labels, count) = parts([8, 5], |i| samples[i]);
        assert_eq!(count, 5);
        assert!(labels.iter().zip(&samples).all(|(label, is_in)| (*label != NONE) == *is_in));
        let same = |a: [usize; 2], b: [usize; 2]| labels[a[1] * 8 + a[0]] == labels[b[1] * 8 + b[0]];
        assert!(same([0, 0], [2, 0]) && same([7, 0], [6, 1]) && same([4, 2], [5, 3]) && same([7, 3], [7, 4]));
        assert!(!same([0, 0], [7, 0]) && !same([5, 3], [7, 3]) && !same([0, 0], [0, 4]));
    }
}
