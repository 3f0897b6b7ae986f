//! What a comparison finds, in lines for those who wait.

use super::words::milliseconds;
use crate::measure::compare::Finding;
use crate::measure::figures::{ChainFigures, Convergence, FloorFigures, Run, SequenceRun, TruthReport};

/// Lines on what was found: those for everyone, and those for who wants to know more. Pictures speak for themselves.
pub fn lines(found: &Finding<'_>) -> [Vec<String>; 2] {
    match found {
        Finding::Truth(scene, truth, convergence) => {
            let mut lines = vec![truth_line(scene, truth)];
            lines.extend(convergence.and_then(|convergence| convergence_line(scene, convergence)));
            [lines, Vec::new()]
        }
        Finding::Run(run) => [
            vec![run_line(run), chains_line(&run.of_chains)],
            vec![format!("  masks of the warm frames: {}", run.mask_hashes.join(" "))],
        ],
        Finding::Sequence(run) => [vec![sequence_line(run)], Vec::new()],
        Finding::Picture(..) => [Vec::new(), Vec::new()],
    }
}

/// A truth in a line.
fn truth_line(name: &str, truth: &TruthReport) -> String {
    let TruthReport { level, length_px, border_px, short_chains, self_f, facets, rays, truth_ms, .. } = truth;
    format!(
        "{name} truth at level {level}: {length_px:.0} px of line ({border_px:.0} of border), {:.1} % of its chains under \
         6 px, F of half the level {self_f:.4}; {facets} facets, {rays} rays, {:.2} s",
        100.0 * short_chains,
        truth_ms / 1e3
    )
}

/// How coarser levels close in on truth, in a line; `None` with too few of them.
fn convergence_line(name: &str, convergence: &Convergence) -> Option<String> {
    let Convergence { slope, fitted_levels, .. } = convergence;
    let slope = (*slope)?;
    Some(format!("{name} flip edges close in on truth: slope {slope:.2} over levels {fitted_levels:?}"))
}

/// A run in a line: every figure beside its time and what was computed.
fn run_line(run: &Run) -> String {
    let Run { scene, method, level, precision, recall, f, gaps, spurious, .. } = run;
    let Run { pixel_recall, frame_ms, first_frame_ms, facets, inked, floor, .. } = run;
    let floor = floor.as_ref().map_or(String::new(), |floor| format!("; {}", floor_words(floor, *frame_ms)));
    format!(
        "{scene} {method} level {level}: P {precision:.4} R {recall:.4} ({pixel_recall:.4} of pixels) F {f:.4}, {gaps} gaps, {spurious} spurious; \
         {frame_ms:.1} ms (first frame {first_frame_ms:.1}), {facets} facets, {inked} px of ink{floor}"
    )
}

/// "  214 chains, 3810 px: 0.057 px from truth, 95 % within 0.110; P 0.9990 R 0.9812 (economy removes 6.2 %);
/// 11.2 % under 6 px; 94.0 % of ids kept".
fn chains_line(chains: &ChainFigures) -> String {
    let ChainFigures { chains: count, chains_px, short_chains, chain_precision, chain_recall, .. } = chains;
    let offsets = chains.chain_mean_px.zip(chains.chain_p95_px);
    let offsets =
        offsets.map_or(String::new(), |(mean, p95)| format!("{mean:.3} px from truth, 95 % within {p95:.3}; "));
    let removed = chains.economy_removed;
    let removed = removed.map_or(String::new(), |removed| format!(" (economy removes {:.1} %)", 100.0 * removed));
    let kept = chains.ids_kept.map_or(String::new(), |kept| format!("; {:.1} % of ids kept", 100.0 * kept));
    format!(
        "  {count} chains, {chains_px:.0} px: {offsets}P {chain_precision:.4} R {chain_recall:.4}{removed}; {:.1} % under 6 px{kept}",
        100.0 * short_chains
    )
}

/// A sequence in a line: what pops, beside how much of truth is drawn and what that took.
fn sequence_line(run: &SequenceRun) -> String {
    let SequenceRun { scene, method, level, frames, step_m, pop, truth_pop, excess_pop, recall, .. } = run;
    let SequenceRun { least_recall, strokes_lost, strokes_excess_pop, ids_kept, inked, frame_ms, .. } = run;
    let percent = |share: f64| format!("{:.3} %", 100.0 * share);
    let kept = ids_kept.map_or(String::new(), |kept| format!("; {:.1} % of ids kept", 100.0 * kept));
    format!(
        "{scene} {method} level {level}, {frames} frames {step_m} m apart: excess pop {} (ink {}, truth {}), R {recall:.4} (least \
         {least_recall:.4}); of strokes {} (of {} lost){kept}; {frame_ms:.0} ms a frame, {inked} px of ink",
        percent(*excess_pop),
        percent(*pop),
        percent(*truth_pop),
        percent(*strokes_excess_pop),
        percent(*strokes_lost),
    )
}

/// "98 MB at 4.1 GB/s, a bare copy 9.8 GB/s (frame / copy 2.4), depth draw 40.2 ms (frame / draw 0.6)".
fn floor_words(floor: &FloorFigures, frame_ms: f64) -> String {
    let FloorFigures { bytes, copy_ms, draw_ms, lacking, frame_per_copy, frame_per_draw } = floor;
    // Bytes a millisecond are kilobytes a second.
    let rate = |ms: f64| *bytes as f64 / ms / 1e6;
    let mut words = format!("{:.0} MB at {:.2} GB/s", *bytes as f64 / 1e6, rate(frame_ms));
    if let (Some(ms), Some(per)) = (copy_ms, frame_per_copy) {
        words += &format!(", a bare copy {:.2} GB/s (frame / copy {per:.2})", rate(*ms));
    }
    if let (Some(ms), Some(per)) = (draw_ms, frame_per_draw) {
        words += &format!(", depth draw {} ms (frame / draw {per:.2})", milliseconds(*ms));
    }
    lacking.map_or(words.clone(), |why| format!("{words}, lacking: {why}"))
}
