//! What a ray from the eye meets.
//!
//! Method: the quadtree of bounds leads to cells, a patch is halved along its sides until a facet of the level is
//! reached. The points of a part of a patch leave the triangle over its corners by at most 5/3 of the patch's largest
//! second difference of control points, per axis, times the square of the part's share of the cell: for a quadratic form
//! with second derivatives of at most M along the three sides the interpolation error is at most 0.625 M sum l (1 - l)^2
//! over the barycentrics l, 4/9 at most, and M is 6 second differences. Facets of any level lie within the same bounds,
//! for their vertices do. Cost: some microseconds a ray, more where it grazes.

use glam::DVec3;

use super::cell::{Cell, point, vertices};
use super::terrain::{Box3, Terrain};
use crate::surface::Patch;

/// 5/3, and room for rounding.
const BULGE: f64 = 1.7;

/// A terrain from an eye, as facets of one level.
pub(super) struct Sight<'a> {
    pub terrain: &'a Terrain<'a>,
    pub eye: DVec3,
    /// Subdivisions of a cell's edge.
    pub level: u32,
}

/// The segment from the eye to a target, metres from the eye.
struct Ray {
    target: DVec3,
    inverse: DVec3,
}

/// A part of a patch: the triangle of half `half` in the quad with north-west corner (i, j), `size` quads wide.
#[derive(Clone, Copy)]
struct Part {
    half: usize,
    i: u32,
    j: u32,
    size: u32,
    /// Counter-clockwise from above.
    corners: [DVec3; 3],
}

/// The cell that stood in the way of the last hidden ray: it mostly stands in the way of the next one too.
#[derive(Default)]
pub(super) struct Blocker(Option<Cell>);

impl Sight<'_> {
    /// Whether no facet stands between the eye and `target`, metres from the eye. `last` is where to look first.
    pub(super) fn reaches(&self, target: DVec3, last: &mut Blocker) -> bool {
        let ray = Ray { target, inverse: target.recip() };
        if last.0.as_ref().is_some_and(|cell| self.cell_blocks(cell, &ray)) {
            return false;
        }
        let found = self.blocker(self.terrain.layers() - 1, 0, 0, &ray);
        let reached = found.is_none();
        last.0 = found.or(last.0.take());
        reached
    }

    /// A cell below a node of the quadtree that stands in the way.
    fn blocker(&self, layer: usize, c: isize, r: isize, ray: &Ray) -> Option<Cell> {
        if !self.terrain.bounding_box(layer, c, r, self.eye).is_some_and(|bounds| ray.meets(&bounds)) {
            return None;
        }
        if layer == 0 {
            let cell = Cell::new(self.terrain.surface, self.eye, c, r);
            return self.cell_blocks(&cell, ray).then_some(cell);
        }
        // Those nearer to the eye first: a hidden ray mostly ends early.
        let columns = if ray.target.x < 0.0 { [1, 0] } else { [0, 1] };
        let rows = if ray.target.y < 0.0 { [0, 1] } else { [1, 0] };
        let below = rows.into_iter().flat_map(|dr| columns.map(|dc| (dc, dr)));
        below.flat_map(|(dc, dr)| self.blocker(layer - 1, 2 * c + dc, 2 * r + dr, ray)).next()
    }

    /// Whether a facet of a cell stands in the way.
    fn cell_blocks(&self, cell: &Cell, ray: &Ray) -> bool {
        (0..2).any(|half| cell.patches[half].as_ref().is_some_and(|patch| self.patch_blocks(patch, half, ray)))
    }

    fn patch_blocks(&self, patch: &Patch, half: usize, ray: &Ray) -> bool {
        let bulge = patch.largest_second_difference() * BULGE;
        let corner = |at: [u32; 2]| point(patch, half, at.map(|k| f64::from(k) / f64::from(self.level)));
        let corners = vertices(half, 0, 0).map(|[i, j]| corner([i * self.level, j * self.level]));
        Part { half, i: 0, j: 0, size: self.level, corners }.blocks(ray, bulge, &corner)
    }
}

impl Part {
    /// Whether a facet of it stands in the way. `bulge`: how far its points may leave the triangle over its corners.
    fn blocks(&self, ray: &Ray, bulge: DVec3, corner: &impl Fn([u32; 2]) -> DVec3) -> bool {
        if self.size == 1 {
            return ray.crosses(self.corners);
        }
        let [a, b, c] = self.corners;
        ray.meets(&Box3 { low: a.min(b).min(c) - bulge, high: a.max(b).max(c) + bulge })
            && self.halved(corner).iter().any(|part| part.blocks(ray, bulge / 4.0, corner))
    }

    /// Its four parts of half the size.
    fn halved(&self, corner: impl Fn([u32; 2]) -> DVec3) -> [Self; 4] {
        let size = self.size / 2;
        let Self { half, i, j, corners: [a, b, c], .. } = *self;
        // Middles of the sides opposite to the corners.
        let places = vertices(half, 0, 0).map(|[x, y]| [i + x * self.size, j + y * self.size]);
        let middle = |m: usize, n: usize| corner([0, 1].map(|k| (places[m][k] + places[n][k]) / 2));
        let (ab, bc, ca) = (middle(0, 1), middle(1, 2), middle(2, 0));
        let part = |half, di: u32, dj: u32, corners| Self { half, i: i + di * size, j: j + dj * size, size, corners };
        if half == 0 {
            [
                part(0, 0, 0, [a, ab, ca]),
                part(0, 0, 1, [ab, b, bc]),
                part(0, 1, 1, [ca, bc, c]),
                part(1, 0, 1, [ab, bc, ca]),
            ]
        } else {
            [
                part(1, 0, 0, [a, ab, ca]),
                part(1, 1, 1, [ab, b, bc]),
                part(1, 1, 0, [ca, bc, c]),
                part(0, 1, 0, [ca, ab, bc]),
            ]
        }
    }
}

impl Ray {
    /// Whether the segment meets a box.
    fn meets(&self, bounds: &Box3) -> bool {
        let (mut enter, mut exit) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            if self.target[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low * self.inverse[axis], high * self.inverse[axis]);
            enter = enter.max(a.min(b));
            exit = exit.min(a.max(b));
        }
        enter <= exit
    }

    /// Whether the segment crosses a facet or its sides, short of the target.
    fn crosses(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let side = |p: DVec3, q: DVec3| self.target.dot(p.cross(q));
        let volumes = [side(a, b), side(b, c), side(c, a)];
        if volumes.iter().any(|v| *v > 0.0) && volumes.iter().any(|v| *v < 0.0) {
            return false;
        }
        let normal = (b - a).cross(c - a);
        let (at, along) = (normal.dot(a), normal.dot(self.target));
        // 0 < at / along < 1; a facet seen edge-on hides nothing that its neighbours do not hide.
        along != 0.0 && at * along > 0.0 && at.abs() < along.abs()
    }
}
