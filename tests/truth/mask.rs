//! Masks: what hangs together, what pops, and truth drawn as one.

use hachure::truth::{Inked, Mask};

use super::metrics::{PAGE, ink, row, straight};
use crate::judged::{moved, truth};

fn at(column: u32, row: u32) -> Inked {
    Inked { column, row, distance: 1.0 }
}

/// Sizes of what hangs together, in the order of first pixels.
fn sizes(size: [u32; 2], inked: &[Inked]) -> Vec<usize> {
    Mask { size, inked: inked.to_vec() }.components().iter().map(Vec::len).collect()
}

#[test]
fn all_eight_neighbours_hang_together_and_no_others() {
    for (dx, dy) in (-2..=2).flat_map(|dx: i32| (-2..=2).map(move |dy: i32| (dx, dy))).filter(|d| *d != (0, 0)) {
        let pair = [at(50, 40), at(50_u32.strict_add_signed(dx), 40_u32.strict_add_signed(dy))];
        let expected = if dx.abs().max(dy.abs()) == 1 { vec![2] } else { vec![1, 1] };
        assert_eq!(sizes(PAGE, &pair), expected, "{dx} right, {dy} down");
    }
    let diagonal: Vec<Inked> = (0..96).map(|i| at(i, 95 - i)).collect();
    assert_eq!(sizes(PAGE, &diagonal), [96], "a diagonal from edge to edge");
    // Two combs that touch only at the last pixel looked at.
    let ring: Vec<Inked> = (0..10).flat_map(|i| [at(i, 0), at(0, i), at(9, i), at(i, 9)]).collect();
    let ring = Mask { size: [10, 10], inked: ring }.pixels();
    let ring: Vec<Inked> = (0..100).filter(|i| ring[*i as usize]).map(|i| at(i % 10, i / 10)).collect();
    assert_eq!(sizes([10, 10], &ring), [36], "the page's border is one ring");
}

#[test]
fn rows_do_not_run_on_at_the_edge_of_the_page() {
    let [right, bottom] = PAGE.map(|n| n - 1);
    assert_eq!(sizes(PAGE, &[at(right, 10), at(0, 11)]), [1, 1], "right end of a row and left end of the next");
    assert_eq!(sizes(PAGE, &[at(0, 10), at(right, 10)]), [1, 1], "both ends of a row");
    assert_eq!(sizes(PAGE, &[at(7, 0), at(7, bottom)]), [1, 1], "both ends of a column");
    assert_eq!(sizes([1, 3], &[at(0, 0), at(0, 1), at(0, 2)]), [3], "a page one pixel wide");
    assert_eq!(sizes([3, 1], &[at(0, 0), at(2, 0)]), [1, 1], "a page one pixel high");
    let [end, start] = [at(right, 10), at(0, 11)].map(|p| Mask { size: PAGE, inked: vec![p] });
    assert_eq!(end.pop(&start), 1.0, "ink pops although the next row begins with ink");
}

#[test]
fn each_pixel_is_in_one_set_and_fragments_are_counted_by_size() {
    let mask = ink(&[row(3, 0..5), row(10, 0..6), row(20, 0..7), row(30, 0..1)]);
    let mut all = mask.components().concat();
    all.sort_unstable();
    assert_eq!(all, (0..mask.inked.len()).collect::<Vec<_>>());
    for (pixels, share) in [(1, 0.0), (2, 0.25), (6, 0.5), (7, 0.75), (8, 1.0)] {
        assert_eq!(mask.fragments(pixels), share, "fewer than {pixels} px");
    }
    assert_eq!(ink(&[]).fragments(6), 0.0, "no ink");
}

#[test]
fn ink_pops_when_it_moves_by_more_than_a_pixel() {
    let line = ink(&[row(20, 10..110)]);
    for (rows, pop) in [(0, 0.0), (1, 0.0), (2, 1.0), (3, 1.0)] {
        assert_eq!(line.pop(&moved(&line, [0, rows])), pop, "{rows} px down");
        assert_eq!(line.pop(&moved(&line, [0, -rows])), pop, "{rows} px up");
        // Along itself a line leaves all but a pixel of what it moves by.
        let left = f64::from((rows - 1).max(0)) / 100.0;
        assert_eq!(line.pop(&moved(&line, [rows, 0])), left, "{rows} px right");
    }
    assert_eq!(line.pop(&moved(&line, [0, 1])), line.pop(&line), "diagonals count");
    assert_eq!(line.pop(&ink(&[])), 1.0, "all ink pops when nothing follows");
    assert_eq!(ink(&[]).pop(&line), 0.0, "no ink, no pop");
}

#[test]
fn excess_pop_is_what_truth_does_not_do() {
    let [before, after] = [20.5, 23.5].map(|y| Mask::of_truth(&truth(PAGE, straight([10.0, y], [110.0, y], 1.0))));
    let excess = |mask: &Mask, next: &Mask| mask.pop(next) - before.pop(&after);
    assert_eq!(excess(&before, &after), 0.0, "ink that moves as truth does");
    assert_eq!(excess(&before, &before), -1.0, "ink that stays");
    // Twenty flickering pixels of 120.
    let flicker = ink(&[row(20, 10..110), row(60, 0..20)]);
    let still = flicker.pop(&before) - before.pop(&before);
    assert!((still - 20.0 / 120.0).abs() < 1e-12, "{still}");
}

#[test]
fn truth_is_drawn_one_pixel_wide() {
    let down = straight([30.5, 10.0], [30.5, 90.0], 7.0);
    let slant = straight([40.0, 10.0], [80.0, 50.0], 9.0);
    let [out, left] = [straight([124.0, 5.5], [131.0, 5.5], 5.0), straight([-3.0, 9.5], [-1.0, 9.5], 5.0)];
    let mask = Mask::of_truth(&truth(PAGE, [slant, down, out, left].concat()));
    let expected: Vec<Inked> = (0..96)
        .flat_map(|row| {
            let out = (124..128).filter(move |_| row == 5).map(move |column| Inked { column, row, distance: 5.0 });
            let down = (10..90).contains(&row).then_some(Inked { column: 30, row, distance: 7.0 });
            let slant = (10..50).contains(&row).then(|| Inked { column: 30 + row, row, distance: 9.0 });
            down.into_iter().chain(slant).chain(out)
        })
        .collect();
    assert_eq!(mask.inked, expected, "row by row, each pixel once");
    assert_eq!(mask.size, PAGE);
    assert_eq!(mask.pixels().iter().filter(|ink| **ink).count(), expected.len());
}
