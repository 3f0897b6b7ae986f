//! A quadtree over the lattice: squares that are split into four, and found by their place.
//!
//! A node is one number, as the shaders read it: a leaf's slot, [`NO_SLOT`] for nothing, or [`INNER`] plus the index of
//! the first of its four children (north-west, north-east, south-west, south-east). The roots come first, row by row.

/// No leaf has this slot.
pub const NO_SLOT: u32 = u32::MAX;
/// Bit of a node that has children.
pub const INNER: u32 = 1 << 31;

/// A grid of square roots, each split into four, and so on.
#[derive(Debug, Clone)]
pub struct Quadtree {
    nodes: Vec<u32>,
    roots: [u32; 2],
    root_size: u32,
}

/// A square: lattice place of its north-west corner, and the length of its side.
type Square = ([u32; 2], u32);

/// How far a tree is split.
pub trait Splits {
    /// Whether the square with this north-west corner and size is split.
    fn splits(&mut self, corner: [u32; 2], size: u32) -> bool;

    /// Whether no larger square may touch this one.
    fn stands_among_equals(&self, corner: [u32; 2], size: u32) -> bool;

    /// Hears that a square, split or not, and all in it is done.
    fn done(&mut self, corner: [u32; 2], size: u32, split: bool);
}

/// Neighbours by their place relative to a square's: the sides north, east, south and west, then the corners.
const AROUND: [[i64; 2]; 8] = [[0, -1], [1, 0], [0, 1], [-1, 0], [-1, -1], [1, -1], [-1, 1], [1, 1]];

impl Quadtree {
    /// So many roots across and down, `root_size` lattice units along a side (a power of two); all are leaves.
    pub fn new(roots: [u32; 2], root_size: u32) -> Self {
        Self { nodes: vec![NO_SLOT; (roots[0] * roots[1]) as usize], roots, root_size }
    }

    /// Roots across and down.
    pub fn roots(&self) -> [u32; 2] {
        self.roots
    }

    /// Lattice units along a root's side.
    pub fn root_size(&self) -> u32 {
        self.root_size
    }

    /// The nodes as the shaders read them.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Splits the roots as `growth` says, from a lattice place outwards: what lies before a square as seen from there is
    /// done before it.
    pub fn grow(&mut self, from: [f64; 2], growth: &mut impl Splits) {
        let eye = from.map(|at| (at / f64::from(self.root_size)).floor());
        let corners = (0..self.roots[1]).flat_map(|y| (0..self.roots[0]).map(move |x| [x, y]));
        let mut roots: Vec<[u32; 2]> = corners.collect();
        let steps = |root: [u32; 2]| (0..2).map(|axis| (f64::from(root[axis]) - eye[axis]).abs()).sum::<f64>();
        roots.sort_by(|a, b| steps(*a).total_cmp(&steps(*b)));
        for [x, y] in roots {
            let root = (y * self.roots[0] + x) as usize;
            self.grow_node(root, ([x, y].map(|at| at * self.root_size), self.root_size), from, growth);
        }
    }

    fn grow_node(&mut self, node: usize, square: Square, from: [f64; 2], growth: &mut impl Splits) {
        let splits = growth.splits(square.0, square.1);
        if splits {
            let children = self.split_leaf(node, square);
            // The quarter on the viewpoint's side first, the one across from it last.
            let near = [0, 1].map(|axis| usize::from(from[axis] >= f64::from(square.0[axis] + square.1 / 2)));
            for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                let (child, quarter) = children[(near[1] ^ y) * 2 + (near[0] ^ x)];
                self.grow_node(child, quarter, from, growth);
            }
        }
        growth.done(square.0, square.1, splits);
    }

    /// Splits leaves until none is more than twice as large as another that touches it, be it in a corner, nor larger
    /// than one that `growth` wants among equals.
    pub fn balance(&mut self, growth: &impl Splits) {
        let mut open = self.leaves();
        while let Some((_, square)) = open.pop() {
            let largest = square.1 * if growth.stands_among_equals(square.0, square.1) { 1 } else { 2 };
            for around in AROUND {
                // Its ancestors are split one after the other: each new leaf looks around itself in turn.
                while let Some((node, beside)) = self.larger_beside(square, around).filter(|(_, b)| b.1 > largest) {
                    open.extend(self.split_leaf(node, beside));
                }
            }
        }
    }

    /// The sides (bit 0 north, then clockwise) of a leaf beyond which a larger leaf lies that begins before `end`.
    pub fn larger_neighbours(&self, corner: [u32; 2], size: u32, end: [u32; 2]) -> u32 {
        let begins = |(at, _): Square| at[0] < end[0] && at[1] < end[1];
        let larger =
            |k: &usize| self.larger_beside((corner, size), AROUND[*k]).is_some_and(|(_, beside)| begins(beside));
        (0..4).filter(larger).map(|k| 1 << k).sum()
    }

    /// Gives slots to leaves, those of the first rank first, each rank depth first, and returns them in that order. Leaves
    /// without a rank get none.
    pub fn number<R: Ord>(&mut self, rank: impl Fn([u32; 2], u32) -> Option<R>) -> Vec<(R, Square)> {
        let ranked = |(node, square): (usize, Square)| (node, square, rank(square.0, square.1));
        let mut leaves: Vec<_> = self.leaves().into_iter().map(ranked).collect();
        leaves.iter().for_each(|(node, ..)| self.nodes[*node] = NO_SLOT);
        leaves.retain(|(.., rank)| rank.is_some());
        leaves.sort_by(|(.., a), (.., b)| a.cmp(b));
        (0..).zip(&leaves).for_each(|(slot, (node, ..))| self.nodes[*node] = slot);
        leaves.into_iter().filter_map(|(_, square, rank)| Some((rank?, square))).collect()
    }

    /// All leaves with their nodes, depth first, roots row by row.
    fn leaves(&self) -> Vec<(usize, Square)> {
        let mut leaves = Vec::new();
        let mut open = Vec::new();
        for root in 0..self.roots[0] * self.roots[1] {
            let corner = [root % self.roots[0], root / self.roots[0]].map(|at| at * self.root_size);
            open.push((root as usize, (corner, self.root_size)));
            while let Some((node, square)) = open.pop() {
                match self.children(node) {
                    Some(first) => {
                        open.extend(quarters(square).into_iter().enumerate().rev().map(|(k, q)| (first + k, q)))
                    }
                    None => leaves.push((node, square)),
                }
            }
        }
        leaves
    }

    fn children(&self, node: usize) -> Option<usize> {
        let value = self.nodes[node];
        (value != NO_SLOT && value & INNER != 0).then_some((value & !INNER) as usize)
    }

    fn split_leaf(&mut self, node: usize, square: Square) -> [(usize, Square); 4] {
        let first = self.nodes.len();
        self.nodes[node] = INNER | first as u32;
        self.nodes.extend([NO_SLOT; 4]);
        let [a, b, c, d] = quarters(square);
        [(first, a), (first + 1, b), (first + 2, c), (first + 3, d)]
    }

    /// The leaf beside a square if it is larger.
    fn larger_beside(&self, (corner, size): Square, around: [i64; 2]) -> Option<(usize, Square)> {
        let at = [0, 1].map(|axis| i64::from(corner[axis]) + around[axis] * i64::from(size));
        let inside = |axis: usize| (0..i64::from(self.roots[axis]) * i64::from(self.root_size)).contains(&at[axis]);
        let in_parent = |at: i64| at & !(2 * i64::from(size) - 1);
        let in_same_parent = |axis: usize| in_parent(at[axis]) == in_parent(i64::from(corner[axis]));
        // In the same parent squares are no larger, nor is anything larger than a root.
        if size == self.root_size || !(inside(0) && inside(1)) || in_same_parent(0) && in_same_parent(1) {
            return None;
        }
        Some(self.leaf(at.map(|at| at as u32))).filter(|(_, beside)| beside.1 > size)
    }

    /// The leaf that holds a lattice place.
    fn leaf(&self, at: [u32; 2]) -> (usize, Square) {
        let mut size = self.root_size;
        let [x, y] = at.map(|at| at >> size.trailing_zeros());
        let mut node = (y * self.roots[0] + x) as usize;
        while let Some(first) = self.children(node) {
            size /= 2;
            let [east, south] = at.map(|at| usize::from(at & size != 0));
            node = first + 2 * south + east;
        }
        (node, (at.map(|at| at & !(size - 1)), size))
    }
}

fn quarters(([x, y], size): Square) -> [Square; 4] {
    let half = size / 2;
    [[x, y], [x + half, y], [x, y + half], [x + half, y + half]].map(|corner| (corner, half))
}
