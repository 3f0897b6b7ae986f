//! Names, views, promises and exceptions of cases.

use std::collections::HashSet;

use hachure::dem::Dem;
use hachure::door::stress::exceptions::EXCEPTIONS;
use hachure::door::stress::invariance::{same_bits, turned};
use hachure::door::stress::{Case, Group, Promise, all, named, short};

/// Fails for a name that no file should have.
fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "-.".contains(c))
}

#[test]
fn cases_have_names_views_and_promises_of_their_own() {
    let cases = all();
    assert!(cases.len() >= 50, "only {} cases", cases.len());
    let names: HashSet<_> = cases.iter().map(|case| case.name).collect();
    assert_eq!(names.len(), cases.len(), "each has its own name");
    for case in &cases {
        assert!(is_plain(case.name) && !case.about.is_empty(), "{}", case.name);
        assert!(!case.views.is_empty(), "{} is not seen", case.name);
        let views: HashSet<_> = case.views.iter().map(|view| view.name).collect();
        assert!(views.len() == case.views.len() && views.iter().all(|name| is_plain(name)), "{}: {views:?}", case.name);
        let promises: HashSet<_> = case.promises.iter().map(|promise| promise.name()).collect();
        assert_eq!(promises.len(), case.promises.len(), "{} promises something twice", case.name);
        for promise in [Promise::Drawn, Promise::Finite, Promise::Watertight] {
            assert!(case.promises.contains(&promise), "{} does not promise {}", case.name, promise.name());
        }
        assert!(case.line().starts_with(case.name) && case.line().contains(case.group.name()));
        assert_eq!(named(case.name).expect(case.name).about, case.about);
    }
    for group in Group::ALL {
        assert!(cases.iter().any(|case| case.group == group), "no case is {}", group.name());
    }
    for promise in Promise::ALL {
        let of_it = cases.iter().filter(|case| case.promises.contains(&promise)).count();
        let of_flights = matches!(promise, Promise::Alone | Promise::Steady);
        let least = if of_flights { 15 } else { 30 };
        assert!(of_it >= least, "only {of_it} cases promise {}", promise.name());
    }
}

#[test]
fn the_short_list_has_a_case_of_each_kind() {
    let short = short();
    for group in Group::ALL {
        assert!(short.iter().any(|case| case.group == group), "none is {}", group.name());
    }
    assert!(short.len() < all().len() / 3);
}

#[test]
fn a_name_that_is_none_is_answered_by_the_nearest() {
    let error = named("needel").expect_err("no case").to_string();
    assert!(error.contains("no case is called needel") && error.contains("use `needle`"), "{error}");
    assert!(named("control").is_ok() && all().iter().all(|case| case.name != "control"), "it is run by name alone");
}

/// Exceptions to accuracy.
const MOST_OF_ACCURACY: usize = 3;

#[test]
fn exceptions_are_few_and_say_why() {
    let of_accuracy = EXCEPTIONS.iter().filter(|e| e.promise == Promise::Accurate).count();
    assert!(of_accuracy <= MOST_OF_ACCURACY, "{of_accuracy} exceptions to accuracy");
    let truthless = all().into_iter().filter(|case| !case.promises.contains(&Promise::Accurate));
    let pages = ["image-1x1", "image-7x3", "under-a-pixel"];
    let others: Vec<_> = truthless.map(|case| case.name).filter(|name| !pages.contains(name)).collect();
    assert_eq!(others, ["edge-on", "on-a-sample"], "cases that promise no accuracy");
    for e in EXCEPTIONS {
        let case = named(e.case).expect(e.case);
        assert!(case.views.iter().any(|view| view.name == e.view), "{} has no view {}", e.case, e.view);
        assert!(case.promises.contains(&e.promise) && e.promise.is_of(e.method), "{}: {}", e.case, e.promise.name());
        let (limit, at_least) = e.promise.limit();
        assert!(if at_least { e.limit < limit } else { e.limit > limit }, "{}: that is no exception", e.case);
        assert!(e.reason.len() > 80, "{}: say why, and what was tried", e.case);
    }
}

/// Heights of a case.
fn heights(case: &Case) -> Vec<Option<f32>> {
    let dem = &case.dem;
    (0..dem.rows()).flat_map(|r| (0..dem.columns()).map(move |c| dem.height(c, r))).collect()
}

#[test]
fn what_promises_bits_has_heights_of_few_digits() {
    let mut checked = 0;
    for case in all().iter().filter(|case| case.promises.contains(&Promise::SameBits)) {
        for moved in same_bits(&case.dem) {
            let (from, to) = (heights(case), heights(&Case { dem: moved.dem.clone(), ..case.clone() }));
            let back = |height: f32| match moved.how {
                "raised" => height - 301.0,
                "8 times as large" => height / 8.0,
                _ => height,
            };
            let there: Vec<_> = to.into_iter().map(|height| height.map(back)).collect();
            assert!(from == there, "{}, {}: heights are rounded", case.name, moved.how);
            let first = |dem: &Dem| {
                (0..dem.columns() * dem.rows()).find_map(|i| dem.height(i % dem.columns(), i / dem.columns()))
            };
            let lies = |dem: &Dem| (dem.extent().map(f64::to_bits), first(dem));
            assert_ne!(lies(&case.dem), lies(&moved.dem), "{}, {}: nothing moved", case.name, moved.how);
            checked += 1;
        }
    }
    assert!(checked > 100, "only {checked} moves");
}

#[test]
fn turned_land_looks_the_same_from_where_the_eye_goes() {
    let case = named("hills").expect("hills");
    let camera = case.views[1].camera;
    for moved in turned(&case.dem) {
        let there = (moved.camera)(&case.dem, &camera);
        let (columns, rows) = (case.dem.columns(), case.dem.rows());
        for (c, r) in [(3, 5), (100, 20), (64, 64)] {
            let (tc, tr) = if moved.mirrors { (r, c) } else { (columns - 1 - c, rows - 1 - r) };
            let (a, depth_a) = camera.project(case.dem.position(c, r));
            let (mut b, depth_b) = there.project(moved.dem.position(tc, tr));
            if moved.mirrors {
                b.x = f64::from(camera.width) - b.x;
            }
            assert!(a.distance(b) < 1e-6 && (depth_a - depth_b).abs() < 1e-6, "{}: {a} and {b}", moved.how);
        }
    }
}
