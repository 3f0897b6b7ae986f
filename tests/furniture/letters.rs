//! Letters by themselves.

use glam::DVec2;
use hachure::door::ink::letters::{Face, Lettering};

const FACES: [Face; 2] = [Face::Outlines, Face::SingleStroke];

fn set(face: Face, text: &str, spacing: f64) -> Lettering {
    face.set(text, 10.0, spacing).expect("letters")
}

/// Twice the area of a ring, positive where it runs clockwise as seen with y down.
fn turn(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

#[test]
fn capitals_stand_on_the_baseline_as_high_as_told() {
    for face in FACES {
        let [low, high] = set(face, "H", 0.0).bounds();
        assert!(high.y.abs() < 0.01 && (-low.y - 10.0 * face.cap_height()).abs() < 0.02, "{face:?}: {low} {high}");
        let [_, descends] = set(face, "gpqyj,()", 0.0).bounds();
        assert!(descends.y > 1.0 && descends.y < 10.0 * face.descent() + 0.6, "{face:?}: {descends}");
    }
}

#[test]
fn letters_kern_and_can_be_spaced_out() {
    let width = |text: &str, spacing: f64| set(Face::Outlines, text, spacing).width();
    let alone = |letter: &str| {
        let twice = width(&letter.repeat(2), 0.0);
        twice - width(letter, 0.0)
    };
    // From one letter to the next of its kind is its advance; of A and V less.
    assert!(width("AVA", 0.0) < width("A", 0.0) + alone("A") + alone("V") - 0.5, "kerned");
    for face in FACES {
        let [tight, apart] = [0.0, 0.2].map(|spacing| set(face, "ALPS", spacing).width());
        assert!((apart - tight - 3.0 * 2.0).abs() < 1e-6, "{face:?}: three gaps of 2 mm: {tight} {apart}");
    }
    assert_eq!(set(Face::Outlines, "fi", 0.0).letters.len(), 1, "a ligature");
    assert_eq!(set(Face::Outlines, "fi", 0.1).letters.len(), 2, "none where letters stand apart");
}

#[test]
fn holes_run_the_other_way() {
    let o = set(Face::Outlines, "O", 0.0);
    let [outer, inner] = &o.letters[0][..] else { panic!("two rings: {}", o.letters[0].len()) };
    assert!(turn(outer) * turn(inner) < 0.0);
    assert!(turn(outer).abs() > 1.2 * turn(inner).abs());
}

#[test]
fn what_a_face_lacks_is_named() {
    let text = "Ærøskøbing Łódź Öræfajökull Šar Ďáblice Kraków 12° · “Ça” – ½ × 3′";
    for face in FACES {
        assert_eq!(face.lacking(text).expect("a font"), None, "{face:?}");
        for (text, letter) in [("Fuji 富士", '富'), ("one\ntwo", '\n'), ("שלום", 'ש')] {
            assert_eq!(face.lacking(text).expect("a font"), Some(letter), "{face:?}");
        }
    }
    assert_eq!(Face::Outlines.lacking("Όλυμπος, Эльбрус").expect("a font"), None);
    assert_eq!(Face::SingleStroke.lacking("Όλυμπος").expect("letters"), Some('Ό'));
    // All that texts of our own are made of.
    let own = "From 0123456789.° N S E W, at −12 345 m looking from true grid north level up down · field of view heights × : () ″";
    let own = own.replace("12 345", "12\u{202f}345\u{a0}");
    assert!(FACES.iter().all(|face| face.lacking(&own).expect("a font").is_none()));
}

#[test]
fn marks_find_their_letters_however_they_are_written() {
    let [composed, apart] = ["\u{e9}", "e\u{301}"].map(|text| set(Face::Outlines, text, 0.0).bounds());
    assert!(composed[0].distance(apart[0]) < 0.3 && composed[1].distance(apart[1]) < 0.3, "{composed:?} {apart:?}");
}

#[test]
fn every_letter_of_single_strokes_is_read() {
    let file = include_str!("../../src/ink/letters/single_stroke.txt");
    let lines: Vec<&str> = file.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(lines.len() > 300 && file.contains("Dr. A. V. Hershey"), "{}", lines.len());
    let mut blank = 0;
    for line in lines {
        let code = line.split(' ').next().and_then(|code| u32::from_str_radix(code, 16).ok());
        let letter = code.and_then(char::from_u32).expect("a letter");
        let set = set(Face::SingleStroke, &letter.to_string(), 0.0);
        assert_eq!(Face::SingleStroke.lacking(&letter.to_string()).expect("letters"), None, "{letter}");
        blank += usize::from(set.letters.is_empty());
        let [low, high] = set.bounds();
        let typed = |axis: usize| {
            line.split([' ', ';']).skip(2).filter_map(move |pair| pair.split(',').nth(axis)?.parse::<f64>().ok())
        };
        let wide = typed(0).fold(f64::NEG_INFINITY, f64::max) - typed(0).fold(f64::INFINITY, f64::min);
        // Rounding takes a little off where a bowl has a corner outmost.
        assert!(
            set.letters.is_empty() || ((high.x - low.x) * 100.0 - wide).abs() < 25.0,
            "{letter}: {low} {high} {wide}"
        );
    }
    assert_eq!(blank, 5, "spaces");
}

#[test]
fn bowls_are_round_and_stems_straight() {
    let corners = |text: &str| set(Face::SingleStroke, text, 0.0).letters.concat();
    assert!(corners("H").iter().all(|stroke| stroke.len() == 2), "three straight strokes");
    let o = corners("O").concat();
    let sharpest =
        o.windows(3).map(|three| (three[1] - three[0]).angle_to(three[2] - three[1]).abs()).fold(0.0, f64::max);
    assert!(sharpest < 0.35, "{sharpest} radians");
}
