//! Which way facets face, and proofs for whole patches.
//!
//! A facet of any level has the normal s x e with s a chord of a step south and e a chord of a step east. A chord over
//! the length of its step is the mean of a derivative, so it lies in the hull of three times the differences of the
//! control points in that direction; a vertex lies in the box around the control points. (s x e) . p is linear in each,
//! so its sign over a patch is known where it is the same at all corners of the two hulls and the box (Farin 2002, Curves
//! and Surfaces for CAGD, 17.3, for the hulls). Cost: a few hundred operations a patch.

use glam::DVec3;

use crate::surface::Patch;

/// Which way the facets of a patch face, whatever the level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Facing {
    /// There is no patch.
    Missing,
    /// All toward the eye.
    Toward,
    /// All away.
    Away,
    /// Not proven: facet by facet.
    Mixed,
}

/// Whether both halves of a quad, vertices NW, SW, SE, NE in metres from the eye, face the eye; zero is away.
pub(super) fn halves_toward([nw, sw, se, ne]: [DVec3; 4]) -> [bool; 2] {
    // Both normals, times nw, hold the diagonal times nw.
    let diagonal = (se - nw).cross(nw);
    [(sw - nw).dot(diagonal) < 0.0, (ne - nw).dot(diagonal) > 0.0]
}

/// The same for one half alone, vertices as the lattice orders them: the same operations, so the same answer.
pub(super) fn is_toward(half: usize, [a, b, c]: [DVec3; 3]) -> bool {
    halves_toward(if half == 0 { [a, b, c, a] } else { [a, a, b, c] })[half]
}

/// What bounds prove of a patch in metres from the eye.
pub(super) fn of_patch(patch: Option<&Patch>, half: usize) -> Facing {
    let Some(patch) = patch else { return Facing::Missing };
    let control = patch.control();
    // Corners 0, 1, 2 of patch 0 are NW, SW, SE, of patch 1 NW, SE, NE.
    let (south, east) = if half == 0 { ([0, 1], [1, 2]) } else { ([2, 1], [0, 2]) };
    let (south, east) = (differences(control, south), differences(control, east));
    let least = control.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let most = control.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let (middle, reach) = (least.midpoint(most), (most - least) / 2.0);
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for s in south {
        for e in east {
            let normal = s.cross(e);
            let (value, spread) = (normal.dot(middle), normal.abs().dot(reach));
            low = low.min(value - spread);
            high = high.max(value + spread);
        }
        if low < 0.0 && high >= 0.0 {
            return Facing::Mixed;
        }
    }
    if high < 0.0 { Facing::Toward } else { Facing::Away }
}

/// The six differences of control points in the direction from one corner to another.
fn differences(control: &[DVec3; 10], [from, to]: [usize; 2]) -> [DVec3; 6] {
    const PLACES: [[usize; 2]; 6] = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [0, 2]];
    PLACES.map(|[j, k]| {
        let beside = |corner: usize| control[Patch::index(j + usize::from(corner == 1), k + usize::from(corner == 2))];
        beside(to) - beside(from)
    })
}
