//! Names of chains: unique in a frame, the same in the next.

use std::collections::HashSet;

use glam::DVec2;
use hachure::door::line::identity::{Held, key, names};
use hachure::door::line::visible::chains;
use hachure::line::{Chain, Curve, Id};

use crate::page_curves::{PAGE, disc};
use crate::scenes::Random;
use crate::tolerances::NAMES_KEPT;

/// Chains that hold so many random cells each, some px of each.
fn random_chains(count: usize, random: &mut Random) -> Vec<Vec<Held>> {
    let mut chain = || {
        let cells = 1 + random.below(60);
        let first = random.below(2000);
        (first..first + cells).map(|cell| Held { key: cell.into(), length: random.between(0.5, 8.0) }).collect()
    };
    (0..count).map(|_| chain()).collect()
}

/// Share of the length that is called the same in both.
fn kept(held: &[Vec<Held>], before: &[Option<Id>], after: &[Option<Id>]) -> f64 {
    let length = |held: &Vec<Held>| held.iter().map(|held| held.length).sum::<f64>();
    let all: f64 = held.iter().map(length).sum();
    let same = held.iter().zip(before.iter().zip(after)).filter(|(_, (before, after))| before == after);
    same.map(|(held, _)| length(held)).sum::<f64>() / all
}

#[test]
fn no_two_chains_are_called_the_same() {
    let mut random = Random::new(1);
    let mut held = random_chains(300, &mut random);
    // Many in one cell, among them equal ones.
    held.extend((0..40).map(|i| vec![Held { key: 7, length: f64::from(1 + i / 2) }]));
    let names = names(&held);
    let all: HashSet<Id> = names.iter().map(|name| name.expect("a name")).collect();
    assert_eq!(all.len(), held.len());
    // Of those in one cell the longest has its own name.
    let own = names.iter().position(|&name| name == Some(Id(7)));
    assert!(own.is_some_and(|i| i >= 338 || held[i].len() > 1), "{own:?}");
}

#[test]
fn names_do_not_depend_on_the_order() {
    let mut random = Random::new(2);
    let mut held = random_chains(200, &mut random);
    let mut given: Vec<(Vec<Held>, Option<Id>)> = held.iter().cloned().zip(names(&held)).collect();
    held.reverse();
    given.reverse();
    held.iter_mut().for_each(|held| held.reverse());
    let expected: Vec<Option<Id>> = given.into_iter().map(|(_, name)| name).collect();
    assert_eq!(names(&held), expected);
}

#[test]
fn names_stay_while_lengths_change_a_little() {
    let mut random = Random::new(3);
    let held = random_chains(300, &mut random);
    let before = names(&held);
    let mut changed = |share: f64| {
        let mut next = held.clone();
        next.iter_mut().flatten().for_each(|held| held.length *= 1.0 + random.between(-share, share));
        kept(&held, &before, &names(&next))
    };
    let (little, much) = (changed(0.03), changed(1.0));
    assert!(little >= NAMES_KEPT, "{little}");
    assert!(much < little, "the measure must see a change: {much}");
}

#[test]
fn a_chain_that_loses_its_end_keeps_its_name() {
    let mut random = Random::new(4);
    let held = random_chains(300, &mut random);
    let before = names(&held);
    let mut next = held.clone();
    next.iter_mut().for_each(|held| held.truncate(held.len() - held.len() / 20));
    let kept = kept(&held, &before, &names(&next));
    assert!(kept >= NAMES_KEPT, "{kept}");
}

#[test]
fn cells_are_those_of_level_1_whatever_the_side() {
    let (east, west) = (DVec2::new(0.6, -0.8), DVec2::new(-0.6, -0.8));
    let cell = 64 * 256;
    assert_eq!(key([cell, 5 * cell], east), key([2 * cell - 1, 6 * cell - 1], east));
    let others = [key([cell, 5 * cell], east), key([cell - 1, 5 * cell], east), key([cell, 6 * cell], east)];
    assert_eq!(HashSet::from(others).len(), 3);
    assert_ne!(key([0, 0], east), key([0, 0], west));
    assert_ne!(key([-1, 0], east), key([0, 0], east));
}

/// Discs that overlap, moved on the page and in size.
fn discs(shift: f64) -> Vec<Curve> {
    let mut random = Random::new(6);
    let mut one = |i: u32| {
        let middle = DVec2::new(random.between(20.0, 220.0), random.between(20.0, 160.0));
        disc(middle + shift, random.between(5.0, 40.0) * (1.0 + shift / 50.0), 0.2 + 0.04 * f64::from(i))
    };
    (0..20).map(&mut one).collect()
}

#[test]
fn chains_of_a_moved_scene_are_called_the_same() {
    let named = |chains: &[Chain]| chains.iter().map(|chain| chain.id.expect("a name")).collect::<HashSet<Id>>();
    let length = |chain: &Chain| chain.points.len() as f64;
    let before = chains(discs(0.0), PAGE);
    let kept = |shift: f64| {
        let after = named(&chains(discs(shift), PAGE));
        let kept = before.iter().filter(|chain| chain.id.is_some_and(|id| after.contains(&id)));
        kept.map(length).sum::<f64>() / before.iter().map(length).sum::<f64>()
    };
    let (little, far) = (kept(0.03), kept(20.0));
    assert!(little >= NAMES_KEPT, "{little}");
    assert!(far < 0.5, "the measure must see a change: {far}");
}
