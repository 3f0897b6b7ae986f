//! What the figures say, in words: which run is best, which method to use when.
//!
//! Nothing is judged beforehand: every sentence follows from the results alone, by the thresholds below. A method at a
//! level is judged by its worst scene, since a user does not know beforehand which one theirs will be like.
//!
//! Does not handle: methods and levels that were not drawn in every scene; they appear in the tables only.

use serde::Serialize;

use super::{Results, merge};
use crate::measure::figures::{DrawnLevel, FloorFigures, Run};
use crate::plan::Method;

/// F from which on a drawing is good enough to be chosen by its speed.
const GOOD_F: f64 = 0.99;
/// Precision below which a method floods the page: more ink beside the line than on it.
const FLOODED: f64 = 0.5;

/// Sentences for the report.
#[derive(Debug, Serialize)]
pub(super) struct Words {
    /// The whole comparison in a sentence.
    pub headline: String,
    /// What to take for what: a few words, and why.
    pub advice: Vec<(&'static str, String)>,
    /// Method, how it works, what was found.
    pub methods: Vec<(&'static str, &'static str, String)>,
}

/// A method at a level, over all scenes.
struct Candidate<'a> {
    method: &'static str,
    level: DrawnLevel,
    runs: Vec<&'a Run>,
}

impl Candidate<'_> {
    /// A share in the scene where it is least.
    fn least(&self, share: impl Fn(&Run) -> f64) -> f64 {
        self.runs.iter().map(|run| share(run)).fold(1.0, f64::min)
    }

    fn f(&self) -> f64 {
        self.least(|run| run.f)
    }

    /// Of its ink, the share on a line; a blank page drowns no line.
    fn precision(&self) -> f64 {
        self.least(|run| if run.inked > 0 { run.precision } else { 1.0 })
    }

    fn floods(&self) -> bool {
        self.precision() < FLOODED
    }

    /// Of its slowest scene.
    fn ms(&self) -> f64 {
        self.runs.iter().map(|run| run.frame_ms).fold(0.0, f64::max)
    }

    fn gaps(&self) -> usize {
        self.runs.iter().map(|run| run.gaps).sum()
    }

    fn name(&self) -> String {
        format!("{} at level {}", self.method, self.level)
    }

    /// "F 0.9985 in 56.2 ms a frame", the worst of each where there are several scenes.
    fn figures(&self) -> String {
        let (f, ms) = (self.f(), milliseconds(self.ms()));
        match self.runs.len() {
            1 => format!("F {f:.4} in {ms} ms a frame"),
            scenes => format!("at least F {f:.4} in at most {ms} ms a frame, in each of {scenes} scenes"),
        }
    }
}

/// Reads the sentences off the results.
pub(super) fn words(results: &Results) -> Words {
    let candidates = candidates(results);
    let best = candidates.iter().min_by(|a, b| b.f().total_cmp(&a.f()).then(a.ms().total_cmp(&b.ms())));
    let headline = match best {
        Some(best) => format!("{} comes closest to truth: {}.", capital(&best.name()), best.figures()),
        None => "No method was drawn in every scene.".into(),
    };
    Words { headline, advice: advice(results, &candidates, best), methods: methods(&candidates) }
}

/// Methods and levels that were drawn in every scene.
fn candidates(results: &Results) -> Vec<Candidate<'_>> {
    let mut candidates: Vec<Candidate> = Vec::new();
    for run in &results.runs {
        match candidates.iter_mut().find(|c| (c.method, c.level) == (run.method, run.level)) {
            Some(candidate) => candidate.runs.push(run),
            None => candidates.push(Candidate { method: run.method, level: run.level, runs: vec![run] }),
        }
    }
    candidates.retain(|candidate| candidate.runs.len() == results.scenes.len());
    candidates
}

/// What to take for the best line, what for speed, where judging ends, and what to beware of.
fn advice(results: &Results, candidates: &[Candidate], best: Option<&Candidate>) -> Vec<(&'static str, String)> {
    let Some(best) = best else { return Vec::new() };
    let named = |c: &Candidate| format!("{}: {}.", c.name(), c.figures());
    let fastest = |least: f64| candidates.iter().filter(|c| c.f() >= least).min_by(|a, b| a.ms().total_cmp(&b.ms()));
    let mut advice = vec![("The best line", named(best))];
    // What truth at half the level gets wrong cannot be told from what a method gets wrong.
    let doubt = 1.0 - results.truth.self_f;
    if let Some(equal) = fastest(best.f() - doubt).filter(|equal| equal.ms() < best.ms()) {
        let why =
            format!("Truth may be off by {doubt:.4} of F itself, so that the best line cannot be told from this one.");
        advice.push(("As good, as far as truth can tell", format!("{} {why}", named(equal))));
    }
    let speed = match fastest(GOOD_F) {
        Some(fast) if fast.ms() < best.ms() => format!("{} It is the fastest that reaches F {GOOD_F}.", named(fast)),
        Some(_) => format!("The same: nothing faster reaches F {GOOD_F}."),
        None => format!("Nothing reaches F {GOOD_F}; what is faster than the best line is worse."),
    };
    advice.push(("Good lines, fast", speed));
    if let Some(least) = fastest(0.0).filter(|least| least.f() < GOOD_F && least.ms() < best.ms()) {
        advice.push(("Speed above all", named(least)));
    }
    advice.extend(limits(best).map(|why| ("How far from the limit", why)));
    let methods = by_method(candidates);
    let floods = methods.iter().filter_map(|levels| Some(format!("{} {}", levels[0].method, flooded(levels)?)));
    let floods: Vec<String> = floods.collect();
    if !floods.is_empty() {
        advice.push(("Floods the page", format!("{}.", listed(&floods))));
    }
    let gappy: Vec<&str> =
        methods.iter().filter(|levels| levels.iter().all(|c| c.gaps() > 0)).map(|levels| levels[0].method).collect();
    if !gappy.is_empty() {
        advice.push(("Leaves gaps", format!("{}, at every level.", listed(&gappy))));
    }
    advice
}

/// How the best line's frames stand beside a bare copy and a depth draw, where those were timed.
fn limits(best: &Candidate) -> Option<String> {
    let floors = best.runs.iter().map(|run| run.floor.as_ref()).collect::<Option<Vec<_>>>()?;
    let most = |per: fn(&FloorFigures) -> Option<f64>| {
        floors.iter().try_fold(0.0, |most: f64, floor| Some(most.max(per(floor)?)))
    };
    let beside = |what: &str, per: Option<f64>| per.map(|per| format!("{per:.1} times as long as {what}"));
    let copy = beside("a bare copy of as many bytes", most(|floor| floor.frame_per_copy));
    let draw = beside("a hardware depth draw of its facets", most(|floor| floor.frame_per_draw));
    let limits: Vec<String> = copy.into_iter().chain(draw).collect();
    let at_most = if best.runs.len() > 1 { "at most " } else { "" };
    (!limits.is_empty()).then(|| format!("A frame of {} takes {at_most}{}.", best.name(), listed(&limits)))
}

/// What was found of each method.
fn methods(candidates: &[Candidate]) -> Vec<(&'static str, &'static str, String)> {
    let found = |levels: Vec<&Candidate>| {
        let best = levels.iter().copied().reduce(|a, b| if b.f() > a.f() { b } else { a })?;
        let (precision, recall) = (best.precision(), best.least(|run| run.recall));
        let shares = format!("precision {precision:.4}, recall {recall:.4}");
        let mut found = vec![format!("Best at level {}: {} ({shares}).", best.level, best.figures())];
        found.extend(flooded(&levels).map(|where_| format!("It floods the page {where_}.")));
        found.push(gaps(&levels));
        Some((best.method, how(best.method), found.join(" ")))
    };
    by_method(candidates).into_iter().filter_map(found).collect()
}

/// The levels of each method, in the methods' order.
fn by_method<'a, 'b>(candidates: &'b [Candidate<'a>]) -> Vec<Vec<&'b Candidate<'a>>> {
    let names = merge(std::iter::once(candidates.iter().map(|candidate| candidate.method).collect()));
    let levels = |name| {
        let mut levels: Vec<_> = candidates.iter().filter(|candidate| candidate.method == name).collect();
        levels.sort_by_key(|candidate| candidate.level);
        levels
    };
    names.into_iter().map(levels).collect()
}

/// "at levels 4 and 8, where as little as 3.90 % of its ink lies on a line": where most ink lies beside it.
fn flooded(levels: &[&Candidate]) -> Option<String> {
    let flooded: Vec<DrawnLevel> = levels.iter().filter(|c| c.floods()).map(|c| c.level).collect();
    let least = 100.0 * levels.iter().map(|c| c.precision()).fold(1.0, f64::min);
    let at = named(&flooded, levels.len());
    (!flooded.is_empty()).then(|| format!("at {at} (as little as {least:.1} % of its ink lies on a line)"))
}

/// How many stretches of the line are missing.
fn gaps(levels: &[&Candidate]) -> String {
    if levels.iter().all(|c| c.gaps() == 0) {
        return "It leaves no gaps.".into();
    }
    let counts: Vec<String> = levels.iter().map(|c| format!("{} at level {}", c.gaps(), c.level)).collect();
    format!("Gaps: {}.", counts.join(", "))
}

/// "every level" where there are no others, else "level 4", "levels 2, 4 and 8".
fn named(levels: &[DrawnLevel], of: usize) -> String {
    match levels {
        _ if levels.len() == of => "every level".into(),
        [one] => format!("level {one}"),
        _ => format!("levels {}", listed(levels)),
    }
}

/// "2, 4 and 8".
fn listed(items: &[impl ToString]) -> String {
    let texts: Vec<String> = items.iter().map(ToString::to_string).collect();
    match &texts[..] {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => texts.concat(),
    }
}

/// How a method works, in a sentence; nothing of a method that is not in the registry.
fn how(method: &str) -> &'static str {
    Method::named(method).map_or("", |method| method.entry().rule)
}

/// Milliseconds to three digits.
pub(super) fn milliseconds(ms: f64) -> String {
    match ms {
        _ if ms < 10.0 => format!("{ms:.2}"),
        _ if ms < 100.0 => format!("{ms:.1}"),
        _ => format!("{ms:.0}"),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
