//! Places for the labels of a plot: beside their points, on nothing else.
//!
//! Method: labels are placed one after the other, the widest kind first. Each tries eight directions around its points
//! at growing distances and takes the first place that meets no marker, no line and no label placed before; if there is
//! none, the first that meets no marker and no label. Cost: a few thousand rectangles a plot.
//!
//! Does not handle: moving a placed label again, which a crowded plot could gain from. Widths of texts are estimates on
//! the safe side, since an SVG's reader chooses the font.

/// A rectangle of the page, px: left, top, right, bottom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect(pub [f64; 4]);

/// A text and the point it stands beside.
pub(super) struct Choice {
    pub point: [f64; 2],
    pub text: String,
}

/// Where a label stands.
pub(super) struct Placed<'a> {
    /// The choice that was taken.
    pub choice: &'a Choice,
    pub rect: Rect,
    /// On which side of its point it stands: -1 left, 0 above or below, 1 right.
    pub side: f64,
}

/// What labels must stay clear of.
pub(super) struct Obstacles {
    /// Where labels may stand.
    pub inside: Rect,
    /// Rectangles around markers, and labels that stand already.
    pub taken: Vec<Rect>,
    /// Ends of straight lines.
    pub lines: Vec<[[f64; 2]; 2]>,
    /// Height of the text, px.
    pub text_px: f64,
}

/// Distances from a point to a label's nearest corner that are tried, px.
const DISTANCES: [f64; 9] = [9.0, 11.0, 14.0, 20.0, 28.0, 40.0, 60.0, 90.0, 130.0];
/// Directions that are tried, best first; y grows downwards.
const DIRECTIONS: [[f64; 2]; 8] =
    [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0], [0.0, -1.0], [0.0, 1.0], [1.0, 0.0], [-1.0, 0.0]];
/// Width of a letter as a share of the text's height: that of a wide serif face.
const LETTER: f64 = 0.66;

impl Rect {
    /// The square around a point.
    pub(super) fn around(point: [f64; 2], half: f64) -> Self {
        Self([point[0] - half, point[1] - half, point[0] + half, point[1] + half])
    }

    /// The place in it that is nearest to a point.
    pub(super) fn nearest(&self, point: [f64; 2]) -> [f64; 2] {
        let [l, t, r, b] = self.0;
        [point[0].clamp(l, r), point[1].clamp(t, b)]
    }

    fn meets(&self, other: &Self) -> bool {
        let ([l, t, r, b], [ol, ot, or, ob]) = (self.0, other.0);
        l < or && ol < r && t < ob && ot < b
    }

    fn holds(&self, other: &Self) -> bool {
        let ([l, t, r, b], [ol, ot, or, ob]) = (self.0, other.0);
        l <= ol && t <= ot && r >= or && b >= ob
    }

    /// Whether a straight line passes through: it is cut to the rectangle, axis by axis (Liang and Barsky 1984).
    fn is_crossed_by(&self, [from, to]: &[[f64; 2]; 2]) -> bool {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (low, high, way) = (self.0[axis], self.0[axis + 2], to[axis] - from[axis]);
            if way == 0.0 {
                if from[axis] < low || from[axis] > high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - from[axis]) / way, (high - from[axis]) / way);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter < leave
    }
}

/// A place for each label, which is one of several choices, in their order; `None` where the page has none left.
///
/// Places that were found are taken from then on.
pub(super) fn place<'a>(labels: &'a [Vec<Choice>], page: &mut Obstacles) -> Vec<Option<Placed<'a>>> {
    let mut places = Vec::with_capacity(labels.len());
    for label in labels {
        let free = |rect: &Rect| page.inside.holds(rect) && !page.taken.iter().any(|other| other.meets(rect));
        let clear = |rect: &Rect| !page.lines.iter().any(|line| rect.is_crossed_by(line));
        let candidates = || candidates(label, page.text_px).filter(|placed| free(&placed.rect));
        let found = candidates().find(|placed| clear(&placed.rect)).or_else(|| candidates().next());
        page.taken.extend(found.as_ref().map(|placed| placed.rect));
        places.push(found);
    }
    places
}

/// Every place a label may take, nearest ones first.
fn candidates(label: &[Choice], text_px: f64) -> impl Iterator<Item = Placed<'_>> {
    DISTANCES.iter().flat_map(move |distance| {
        label.iter().flat_map(move |choice| {
            DIRECTIONS.iter().map(move |direction| {
                let rect = beside(choice, *direction, *distance, text_px);
                Placed { choice, rect, side: direction[0] }
            })
        })
    })
}

/// The rectangle of a text that begins so far from its point in this direction.
fn beside(choice: &Choice, direction: [f64; 2], distance: f64, text_px: f64) -> Rect {
    let size = [choice.text.chars().count() as f64 * LETTER * text_px, text_px];
    // Diagonal places are to be as far away as straight ones.
    let reach = if direction[0] * direction[1] == 0.0 { distance } else { distance * 0.75 };
    let start = |i: usize| choice.point[i] + direction[i] * reach + (direction[i] - 1.0) / 2.0 * size[i];
    Rect([start(0), start(1), start(0) + size[0], start(1) + size[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> Obstacles {
        Obstacles { inside: Rect([0.0, 0.0, 200.0, 100.0]), taken: Vec::new(), lines: Vec::new(), text_px: 10.0 }
    }

    fn labels(count: usize) -> Vec<Vec<Choice>> {
        (0..count).map(|i| vec![Choice { point: [50.0, 50.0], text: format!("label {i}") }]).collect()
    }

    #[test]
    fn no_two_labels_meet_and_a_full_page_leaves_the_rest_out() {
        let (labels, mut page) = (labels(60), page());
        let places = place(&labels, &mut page);
        let rects: Vec<Rect> = places.iter().flatten().map(|placed| placed.rect).collect();
        assert!(rects.len() >= 8 && rects.len() < 60, "{} places", rects.len());
        for (i, rect) in rects.iter().enumerate() {
            assert!(page.inside.holds(rect), "{rect:?}");
            assert!(!rects[..i].iter().any(|other| other.meets(rect)), "{rect:?} lies on another");
        }
    }

    #[test]
    fn labels_keep_off_markers_and_lines() {
        let (labels, marker) = (labels(1), Rect::around([60.0, 42.0], 4.0));
        let mut obstructed = Obstacles { taken: vec![marker], lines: vec![[[50.0, 50.0], [150.0, 62.0]]], ..page() };
        let placed = place(&labels, &mut obstructed).remove(0).expect("a place");
        assert!(!placed.rect.meets(&marker) && !placed.rect.is_crossed_by(&obstructed.lines[0]));
        // Without obstacles the label stands where one was: the test can fail.
        assert!(place(&labels, &mut page()).remove(0).expect("a place").rect.meets(&marker));
    }

    #[test]
    fn a_line_that_ends_before_a_rectangle_does_not_cross_it() {
        let rect = Rect([10.0, 10.0, 20.0, 20.0]);
        assert!(rect.is_crossed_by(&[[0.0, 15.0], [30.0, 15.0]]));
        assert!(rect.is_crossed_by(&[[0.0, 0.0], [30.0, 30.0]]));
        assert!(!rect.is_crossed_by(&[[0.0, 15.0], [9.0, 15.0]]));
        assert!(!rect.is_crossed_by(&[[0.0, 25.0], [30.0, 25.0]]));
    }
}
