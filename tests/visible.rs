//! From curves to the chains that the eye sees, where the answer is known.

use glam::DVec2;
use hachure::door::line::visible::chains;
use hachure::line::{Bound, Chain, Curve, Line, Sight, Stretch};

use crate::page_curves::{PAGE, disc, seen, through, with};
use crate::scenes::Random;
use crate::tolerances::ON_LINE_PX;

const DOUBT: Sight = Sight::Doubt { free: true };

/// Length of a chain on the page, px.
fn length(chain: &Chain) -> f64 {
    let pieces = chain.points.windows(2).map(|pair| pair[0].place.distance(pair[1].place));
    let last = chain.points.len() - 1;
    pieces.sum::<f64>() + if chain.closed { chain.points[last].place.distance(chain.points[0].place) } else { 0.0 }
}

/// First and last place of a chain.
fn ends(chain: &Chain) -> [DVec2; 2] {
    [chain.points[0].place, chain.points[chain.points.len() - 1].place]
}

/// A slanting ridge before a level line behind it, both walked to the left; the line is hidden beyond x = 140.
fn ridge_and_line(sight: impl Fn(f64) -> Sight) -> Vec<Curve> {
    let ridge = through(&[[200.0, 100.0, 1.0], [20.0, 136.0, 1.0]]);
    let line = through(&[[190.0, 112.0, 0.5], [10.0, 112.0, 0.5]]);
    vec![ridge, with(line, |place, stretch| stretch.sight = sight(place.x - 140.0))]
}

/// The only chain that lies farther than depth 0.7.
fn far(curves: Vec<Curve>) -> Chain {
    let mut far: Vec<Chain> = chains(curves, PAGE).into_iter().filter(|chain| chain.points[0].depth < 0.7).collect();
    assert_eq!(far.len(), 1, "{far:#?}");
    far.remove(0)
}

/// Free and hidden beyond a margin of so many px, between them always the same.
fn within(margin: f64, between: Sight) -> impl Fn(f64) -> Sight {
    move |beyond| match beyond {
        x if x > margin => Sight::Hidden,
        x if x < -margin => Sight::Free,
        _ => between,
    }
}

#[test]
fn a_line_behind_a_ridge_ends_on_it() {
    let crossing = DVec2::new(140.0, 112.0);
    for free in [true, false] {
        let chain = far(ridge_and_line(within(6.0, Sight::Doubt { free })));
        let [first, last] = ends(&chain);
        assert!(first.distance(crossing) < ON_LINE_PX, "begins at {first} where pixels say {free}");
        assert_eq!(last, DVec2::new(10.0, 112.0));
    }
    // Without doubt, a pixel and a half off.
    for off in [-1.2, 1.2] {
        let sight = move |beyond: f64| if beyond > off { Sight::Hidden } else { Sight::Free };
        let [first, _] = ends(&far(ridge_and_line(sight)));
        assert!(first.distance(crossing) < ON_LINE_PX, "begins at {first} where it is off by {off}");
    }
}

#[test]
fn a_line_before_a_ridge_does_not_end_on_it() {
    let mut curves = ridge_and_line(within(6.0, DOUBT));
    for point in &mut curves[1].points {
        *point = seen(point.place, 2.0);
    }
    let found = chains(curves, PAGE);
    let near = found.iter().find(|chain| chain.points[0].depth > 1.5).expect("a chain");
    // Nothing explains the change: pixels say where it is, here the last doubtful one.
    assert!((ends(near)[0].x - 146.0).abs() <= 1.0, "{:?}", ends(near));
}

#[test]
fn sheets_are_counted_where_hills_overlap() {
    // Into the first hill, into the second, out of the first: still behind the second.
    let hills = [disc(DVec2::new(90.0, 90.0), 30.0, 1.0), disc(DVec2::new(120.0, 90.0), 30.0, 1.5)];
    let line = through(&[[200.0, 90.0, 0.5], [10.0, 90.0, 0.5]]);
    let line = with(line, |place, stretch| {
        stretch.sight = match place.x {
            x if !(55.0..155.0).contains(&x) => Sight::Free,
            // Nobody is sure, and most pixels are wrong.
            x => Sight::Doubt { free: (90.0..150.0).contains(&x) },
        }
    });
    let mut curves = hills.to_vec();
    curves.push(line);
    let found = chains(curves, PAGE);
    let mut far: Vec<[f64; 2]> =
        found.iter().filter(|c| c.points[0].depth < 0.7).map(|c| ends(c).map(|end| end.x)).collect();
    far.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let expected = [[60.0, 10.0], [200.0, 150.0]];
    let off = far.iter().zip(expected).map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()));
    // The discs are polygons: chords lie 0.005 px inside.
    assert!(far.len() == 2 && off.fold(0.0, f64::max) < 0.01, "{far:?}");
}

#[test]
fn of_random_discs_all_is_seen_that_no_nearer_disc_covers() {
    let mut random = Random::new(16);
    for _ in 0..20 {
        let discs: Vec<(DVec2, f64, f64)> = (0..12)
            .map(|_| {
                let middle = DVec2::new(random.between(40.0, 200.0), random.between(40.0, 140.0));
                (middle, random.between(8.0, 36.0), random.between(0.2, 1.0))
            })
            .collect();
        // Near an edge nobody is sure, and every third pixel is wrong.
        let depth_inside = |place: DVec2, depth: f64| {
            let nearer = discs.iter().filter(|disc| disc.2 > depth);
            nearer.map(|&(middle, radius, _)| radius - place.distance(middle)).fold(f64::MIN, f64::max)
        };
        let curve = |&(middle, radius, depth): &(DVec2, f64, f64)| {
            with(disc(middle, radius, depth), |place, stretch| {
                stretch.sight = match depth_inside(place, depth) {
                    inside if inside > 1.5 => Sight::Hidden,
                    inside if inside < -1.5 => Sight::Free,
                    inside => Sight::Doubt { free: (inside < 0.0) == (random.below(3) > 0) },
                }
            })
        };
        let curves: Vec<Curve> = discs.iter().map(curve).collect();
        let found = chains(curves.clone(), PAGE);
        for point in found.iter().flat_map(|chain| &chain.points) {
            let inside = depth_inside(point.place, f64::from(point.depth) * 1.0001);
            assert!(inside < 0.03, "{} is {inside} px inside", point.place);
        }
        let free = |curve: &Curve| {
            let stretches = (0..curve.stretches.len()).filter(|&i| {
                let [a, b] = curve.ends(i);
                depth_inside(a.place.midpoint(b.place), a.depth) < 0.0
            });
            stretches.map(|i| curve.length(i)).sum::<f64>()
        };
        let (all, drawn) = (curves.iter().map(free).sum::<f64>(), found.iter().map(length).sum::<f64>());
        // Parts under 2 px are left out, gaps under 2 px closed.
        assert!((all - drawn).abs() < 0.02 * all, "{drawn} px of {all} px");
    }
}

/// A curve that turns back at a cusp at (50, 100): convex on the way there, concave back, `fall` with such noise.
fn cusped(noise: f64) -> Curve {
    let arm = |t: f64| [50.0 + t * t, 100.0 + 0.1 * t * t * t, 1.0 - 0.01 * t];
    let curve = through(&(-400..=400).map(|i| arm(f64::from(i) / 50.0)).collect::<Vec<_>>());
    let mut random = Random::new(3);
    let n = curve.stretches.len() as f64;
    let mut i = 0.0;
    with(curve, |_, stretch| {
        i += 1.0;
        stretch.fall = (0.5 - i / n + random.between(-noise, noise)) as f32;
    })
}

#[test]
fn a_chain_ends_once_at_a_cusp() {
    let curve = cusped(0.12);
    let turns = curve.stretches.windows(2).filter(|pair| (pair[0].fall < 0.0) != (pair[1].fall < 0.0)).count();
    assert!(turns > 20, "noise that turns only {turns} times proves nothing");
    let found = chains(vec![curve], PAGE);
    assert_eq!(found.len(), 1, "{} chains", found.len());
    let [first, last] = ends(&found[0]);
    assert_eq!(first, DVec2::new(114.0, 48.8));
    assert!(last.distance(DVec2::new(50.0, 100.0)) < 1.0, "ends at {last}");
}

#[test]
fn lines_a_pixel_apart_are_seen_or_hidden_whole() {
    // Pixels say of the doubtful middle that it is hidden above the ridge, free below it.
    let ridge = through(&[[200.0, 100.0, 1.0], [20.0, 100.0, 1.0]]);
    let beside = |y: f64, sure: Sight, free: bool| {
        with(through(&[[190.0, y, 0.5], [30.0, y, 0.5]]), |place, stretch| {
            stretch.sight = if (60.0..160.0).contains(&place.x) { Sight::Doubt { free } } else { sure };
        })
    };
    let above = chains(vec![ridge.clone(), beside(99.0, Sight::Free, false)], PAGE);
    assert_eq!(above.iter().map(|chain| length(chain).round()).collect::<Vec<_>>(), [160.0, 180.0]);
    let below = chains(vec![ridge, beside(101.0, Sight::Hidden, true)], PAGE);
    assert_eq!(below.iter().map(|chain| length(chain).round()).collect::<Vec<_>>(), [180.0]);
}

/// Lengths of the chains of a line from x = 200 to 20, of which nearer bars hide what lies between these.
fn behind_bars(bars: &[[f64; 2]], depths: [f64; 2]) -> Vec<f64> {
    let line = through(&[
        [200.0, 90.0, depths[0]],
        [110.0, 90.0, depths[0]],
        [109.0, 90.0, depths[1]],
        [20.0, 90.0, depths[1]],
    ]);
    let is_hidden = |x: f64| bars.iter().any(|bar| (bar[0]..bar[1]).contains(&x));
    let sight = |x: f64| if is_hidden(x) { Sight::Doubt { free: false } } else { Sight::Free };
    let bar = |[left, right]: [f64; 2]| {
        through(&[[right, 40.0, 1.0], [left, 40.0, 1.0], [left, 140.0, 1.0], [right, 140.0, 1.0], [right, 40.0, 1.0]])
    };
    let mut curves: Vec<Curve> = bars.iter().map(|&b| bar(b)).collect();
    curves.push(with(line, |place, stretch| stretch.sight = sight(place.x)));
    let far = chains(curves, PAGE).into_iter().filter(|chain| chain.points[0].depth < 0.7);
    let mut lengths: Vec<f64> = far.map(|chain| length(&chain)).collect();
    lengths.sort_by(f64::total_cmp);
    lengths
}

/// Whether these are the lengths, but for rounding.
fn are(lengths: &[f64], expected: &[f64]) -> bool {
    lengths.len() == expected.len() && lengths.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn short_gaps_are_closed_and_specks_left_out() {
    let cases: [(&[[f64; 2]], &[f64]); 4] = [
        (&[[100.0, 101.9]], &[180.0]),
        (&[[100.0, 102.1]], &[80.0, 97.9]),
        // A speck of 1.9 px between two bars, and one of 2.1 px.
        (&[[100.0, 110.0], [111.9, 120.0]], &[80.0, 80.0]),
        (&[[100.0, 110.0], [112.1, 120.0]], &[2.1, 80.0, 80.0]),
    ];
    for (bars, expected) in cases {
        let lengths = behind_bars(bars, [0.5, 0.5]);
        assert!(are(&lengths, expected), "{bars:?}: {lengths:?}");
    }
    // Behind the bar the line leaps to six tenths of its distance: that gap is kept.
    let lengths = behind_bars(&[[108.5, 110.3]], [0.5, 0.3]);
    assert!(are(&lengths, &[88.5, 89.7]), "{lengths:?}");
}

#[test]
fn a_chain_runs_through_what_it_draws() {
    let line = with(through(&[[200.0, 90.0, 0.5], [20.0, 90.0, 0.5]]), |place, stretch| {
        // Sky behind, but for a flicker of 2 px; land; then the rim.
        let (bound, behind) = match place.x {
            x if x > 150.0 && !(170.0..172.0).contains(&x) => (Bound::Contour, 0.0),
            x if x > 60.0 => (Bound::Contour, 0.1),
            _ => (Bound::Rim, 0.1),
        };
        *stretch = Stretch { bound, behind, ..*stretch };
    });
    let found = chains(vec![line], PAGE);
    assert_eq!(found.len(), 1);
    let points = &found[0].points;
    let changes = points.windows(2).filter(|pair| pair[0].line != pair[1].line);
    let changes: Vec<(f64, Line)> = changes.map(|pair| (pair[1].place.x.round(), pair[1].line)).collect();
    assert_eq!(points[0].line, Line::Skyline);
    assert_eq!(changes, [(150.0, Line::Occluding), (60.0, Line::Border)]);
    assert_eq!(found[0].line(), Line::Occluding);
    let apart = points.windows(2).map(|pair| pair[0].place.distance(pair[1].place));
    let apart: Vec<f64> = apart.collect();
    assert!(apart.iter().all(|&apart| apart <= 4.0 + 1e-9), "{apart:?}");
    assert!(points.len() < 60, "{} points of a straight line", points.len());
}

#[test]
fn points_left_out_lie_on_the_chain() {
    let curve = disc(DVec2::new(100.0, 90.0), 60.0, 0.5);
    let found = chains(vec![curve.clone()], PAGE);
    assert!(found[0].closed && found.len() == 1);
    let points = &found[0].points;
    assert!(points.len() < curve.points.len() / 2, "{} of {} points", points.len(), curve.points.len());
    let off = |place: DVec2| {
        let pieces = (0..points.len()).map(|i| [points[i].place, points[(i + 1) % points.len()].place]);
        let to = |[a, b]: [DVec2; 2]| {
            let t = (place - a).dot(b - a) / (b - a).length_squared();
            place.distance(a.lerp(b, t.clamp(0.0, 1.0)))
        };
        pieces.map(to).fold(f64::MAX, f64::min)
    };
    let worst = curve.points.iter().map(|point| off(point.place)).fold(0.0, f64::max);
    assert!(worst <= 0.03 + 1e-9, "{worst} px");
}

#[test]
fn chains_end_at_the_edge_of_the_page() {
    let found = chains(vec![through(&[[260.0, 90.0, 0.5], [-20.0, 70.0, 0.5]])], PAGE);
    assert_eq!(found.len(), 1);
    assert_eq!(ends(&found[0]).map(|end| end.x.abs().round() as u32), [PAGE[0], 0]);
}

#[test]
fn the_same_curves_in_any_order_give_the_same_bytes() {
    let mut random = Random::new(5);
    let mut curves: Vec<Curve> = (0..20)
        .map(|i| {
            let middle = DVec2::new(random.between(10.0, 230.0), random.between(10.0, 170.0));
            let curve = disc(middle, random.between(5.0, 40.0), 0.2 + 0.04 * f64::from(i));
            with(curve, |_, stretch| {
                stretch.sight = [Sight::Free, Sight::Free, Sight::Hidden, DOUBT][random.below(4) as usize];
                stretch.fall = random.between(-0.2, 1.0) as f32;
            })
        })
        .collect();
    let given = chains(curves.clone(), PAGE);
    assert!(given.len() > 20, "{} chains", given.len());
    for _ in 0..5 {
        for i in 1..curves.len() {
            curves.swap(i, random.below(i as u32 + 1) as usize);
        }
        for curve in &mut curves {
            let n = curve.points.len() as u32;
            curve.turn(random.below(n) as usize);
        }
        assert!(chains(curves.clone(), PAGE) == given);
    }
}
