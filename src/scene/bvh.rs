//! A bounding volume hierarchy over triangles, in the flat layout that `shaders/paths/bvh.glsl` walks.
//!
//! The builder splits top-down. It sorts the centers of a node's triangles into bins along each axis, and splits between two
//! bins where the surface area heuristic expects the cheapest traversal (Wald 2007, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies").

use glam::Vec3;

use crate::interface::{BvhNode, MAX_BVH_DEPTH};

/// Bins along each axis. More improve the tree by less than a percent.
const BINS: usize = 12;
/// A leaf has at most this many triangles.
const LEAF: usize = 4;
/// Cost of visiting a node over the cost of intersecting a triangle.
const VISIT_COST: f32 = 1.0;
/// Below this depth, nodes are split in the middle of their list. 2^31 triangles then still stay above [`MAX_BVH_DEPTH`].
const BALANCED_DEPTH: u32 = MAX_BVH_DEPTH - 32;

/// The hierarchy.
#[derive(Debug, Default)]
pub struct Bvh {
    /// The nodes; the root is the first. A node without triangles and without children (`first` is 0) is an empty root.
    pub nodes: Vec<BvhNode>,
    /// The triangles in the order of the leaves, as indices into the input.
    pub order: Vec<u32>,
}

#[derive(Clone, Copy)]
struct Bounds {
    min: Vec3,
    max: Vec3,
}

impl Bounds {
    /// The neutral element of [`Bounds::join`].
    const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };
    /// The bounds of an empty tree: finite, so that a shader may compute with them.
    const NOTHING: Self = Self { min: Vec3::ZERO, max: Vec3::ZERO };

    fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Half of the surface area; 0 if empty.
    fn area(self) -> f32 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A triangle while the tree is built.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    index: u32,
}

impl Item {
    /// Twice the center of the bounds, which spares a multiplication.
    fn center(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

/// Where to split a node.
struct Split {
    axis: usize,
    /// First bin of the right child.
    bin: usize,
    cost: f32,
}

/// Maps the centers of a node's items to bins.
struct Binning {
    first: Vec3,
    scale: Vec3,
}

impl Binning {
    fn new(items: &[Item]) -> Self {
        let start = Bounds::EMPTY;
        let centers = items.iter().fold(start, |all, item| {
            let center = item.center();
            all.join(Bounds { min: center, max: center })
        });
        let size = centers.max - centers.min;
        // Along an axis on which all centers agree, every item falls into bin 0.
        let scale = |size: f32| if size > 0.0 { BINS as f32 / size } else { 0.0 };
        Self { first: centers.min, scale: Vec3::new(scale(size.x), scale(size.y), scale(size.z)) }
    }

    fn bins(&self, item: &Item) -> [usize; 3] {
        let bins = (item.center() - self.first) * self.scale;
        bins.to_array().map(|bin| (bin as usize).min(BINS - 1))
    }

    fn best_split(&self, items: &[Item]) -> Option<Split> {
        let mut bins = [[(Bounds::EMPTY, 0usize); BINS]; 3];
        for item in items {
            for (bins, at) in bins.iter_mut().zip(self.bins(item)) {
                bins[at] = (bins[at].0.join(item.bounds), bins[at].1 + 1);
            }
        }
        let splits = bins.iter().enumerate().filter_map(|(axis, bins)| cheapest(axis, bins));
        splits.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// The cheapest split along an axis: the sum over both children of area times number of triangles. `None` if all triangles
/// are in one bin.
fn cheapest(axis: usize, bins: &[(Bounds, usize); BINS]) -> Option<Split> {
    let mut right = [0.0; BINS];
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for bin in (1..BINS).rev() {
        bounds = bounds.join(bins[bin].0);
        count += bins[bin].1;
        right[bin] = if count == 0 { f32::INFINITY } else { bounds.area() * count as f32 };
    }
    let mut best: Option<Split> = None;
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for bin in 1..BINS {
        bounds = bounds.join(bins[bin - 1].0);
        count += bins[bin - 1].1;
        let cost = bounds.area() * count as f32 + right[bin];
        if count > 0 && cost.is_finite() && best.as_ref().is_none_or(|best| cost < best.cost) {
            best = Some(Split { axis, bin, cost });
        }
    }
    best
}

impl Bvh {
    /// Builds the hierarchy of triangles with finite corners.
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let item = |(index, [a, b, c]): (usize, &[Vec3; 3])| {
            let bounds = Bounds { min: a.min(*b).min(*c), max: a.max(*b).max(*c) };
            Item { bounds, index: index as u32 }
        };
        let mut items: Vec<Item> = triangles.iter().enumerate().map(item).collect();
        let mut nodes = vec![BvhNode::default()];
        // Nodes that have no content yet: index, range of items, depth.
        let mut waiting = vec![(0, 0..items.len(), 0)];
        while let Some((node, range, depth)) = waiting.pop() {
            let own = &mut items[range.clone()];
            let bounds = own.iter().map(|item| item.bounds).reduce(Bounds::join).unwrap_or(Bounds::NOTHING);
            let middle = split(own, bounds, depth);
            let (first, count) = match middle {
                None => (range.start, own.len()),
                Some(middle) => {
                    let children = nodes.len();
                    nodes.resize(children + 2, BvhNode::default());
                    let middle = range.start + middle;
                    waiting.push((children, range.start..middle, depth + 1));
                    waiting.push((children + 1, middle..range.end, depth + 1));
                    (children, 0)
                }
            };
            let (min_ws, max_ws) = (bounds.min.to_array(), bounds.max.to_array());
            nodes[node] = BvhNode { min_ws, first: first as u32, max_ws, count: count as u32 };
        }
        Self { nodes, order: items.iter().map(|item| item.index).collect() }
    }
}

/// Reorders the items of a node so that those of the left child come first. Returns their number, or `None` for a leaf.
fn split(items: &mut [Item], bounds: Bounds, depth: u32) -> Option<usize> {
    if items.len() <= 1 {
        return None;
    }
    let middle = items.len() / 2;
    if depth >= BALANCED_DEPTH {
        return (items.len() > LEAF).then_some(middle);
    }
    let binning = Binning::new(items);
    let best = binning.best_split(items);
    // A leaf costs its area times its number of triangles; a split costs a visit more than its children.
    let leaf_cost = bounds.area() * items.len() as f32;
    let best = best.filter(|best| items.len() > LEAF || best.cost + VISIT_COST * bounds.area() < leaf_cost);
    match best {
        Some(Split { axis, bin, .. }) => Some(partition(items, |item| binning.bins(item)[axis] < bin)),
        // All centers coincide.
        None => (items.len() > LEAF).then_some(middle),
    }
}

/// Moves the items for which `is_left` holds to the front. Returns their number.
fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let mut left = 0;
    for at in 0..items.len() {
        if is_left(&items[at]) {
            items.swap(left, at);
            left += 1;
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles of about `size` at pseudorandom places in a unit cube.
    fn cloud(count: usize, size: f32) -> Vec<[Vec3; 3]> {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        let mut point = || Vec3::new(random(), random(), random());
        (0..count).map(|_| (point(), point(), point())).map(|(at, b, c)| [at, at + b * size, at + c * size]).collect()
    }

    /// Checks that every node contains its children or triangles, that every triangle is in one leaf, and returns the depth.
    fn checked_depth(bvh: &Bvh, triangles: &[[Vec3; 3]]) -> u32 {
        let (mut seen, mut deepest) = (vec![false; triangles.len()], 0);
        let mut waiting = vec![(0, 0)];
        while let Some((at, depth)) = waiting.pop() {
            let node = &bvh.nodes[at];
            let (min, max) = (Vec3::from(node.min_ws), Vec3::from(node.max_ws));
            let first = node.first as usize;
            deepest = deepest.max(depth);
            for index in first..first + node.count as usize {
                let index = bvh.order[index] as usize;
                assert!(triangles[index].iter().all(|p| p.cmpge(min).all() && p.cmple(max).all()), "{index} of {at}");
                assert!(!std::mem::replace(&mut seen[index], true), "{index} is in two leaves");
            }
            if node.count == 0 && node.first != 0 {
                for child in [first, first + 1] {
                    let (low, high) = (Vec3::from(bvh.nodes[child].min_ws), Vec3::from(bvh.nodes[child].max_ws));
                    assert!(low.cmpge(min).all() && high.cmple(max).all(), "child {child} of {at}");
                    waiting.push((child, depth + 1));
                }
            }
        }
        assert!(seen.iter().all(|seen| *seen));
        deepest
    }

    #[test]
    fn every_triangle_is_in_the_bounds_of_its_leaf() {
        let triangles = cloud(5000, 0.02);
        let bvh = Bvh::new(&triangles);
        let depth = checked_depth(&bvh, &triangles);
        assert!((11..30).contains(&depth), "{depth}");
        assert!(bvh.nodes.len() < 2 * triangles.len());
    }

    #[test]
    fn coincident_and_degenerate_triangles_have_leaves_too() {
        let same = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 1000];
        assert_eq!(checked_depth(&Bvh::new(&same), &same), 8);
        let points = vec![[Vec3::ONE; 3]; 9];
        checked_depth(&Bvh::new(&points), &points);
        // Centers that halve their distance at each step would make the deepest tree.
        let halving: Vec<_> = (0..2000).map(|i| [Vec3::X * 0.5f32.powi(i / 16); 3]).collect();
        assert!(checked_depth(&Bvh::new(&halving), &halving) < MAX_BVH_DEPTH);
        let one = cloud(1, 1.0);
        assert_eq!(checked_depth(&Bvh::new(&one), &one), 0);
    }

    #[test]
    fn no_triangles_make_an_empty_leaf() {
        let bvh = Bvh::new(&[]);
        assert_eq!((bvh.nodes.len(), bvh.nodes[0].first, bvh.nodes[0].count, bvh.order.len()), (1, 0, 0, 0));
    }
}
