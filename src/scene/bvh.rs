//! A bounding volume hierarchy over triangles, in the flat layout that `shaders/paths/bvh.glsl` walks.
//!
//! The builder splits top-down. It sorts the centers of a node's triangles into bins along each axis, and splits between two
//! bins where the surface area heuristic expects the cheapest traversal (Wald 2007, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies").

use glam::Vec3;

use crate::interface::{BvhNode, MAX_BVH_DEPTH};

/// Bins along each axis. More improve the tree by less than a percent.
const BINS: usize = 12;
/// A leaf has at most this many triangles. Nodes of so few are not split further, which halves the time to build.
const LEAF: usize = 4;
/// Below this depth, nodes are split in the middle of their list, so that 2^31 triangles still stay above [`MAX_BVH_DEPTH`].
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
struct Aabb {
    min: Vec3,
    max: Vec3,
}

impl Aabb {
    /// The neutral element of [`Aabb::join`].
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
    bounds: Aabb,
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
        let start = Aabb::EMPTY;
        let centers = items.iter().fold(start, |all, item| {
            let center = item.center();
            all.join(Aabb { min: center, max: center })
        });
        let size = centers.max - centers.min;
        // Along an axis on which all centers agree, every item falls into bin 0.
        let scale = |size: f32| if size > 0.0 { BINS as f32 / size } else { 0.0 };
        Self { first: centers.min, scale: Vec3::new(scale(size.x), scale(size.y), scale(size.z)) }
    }

    fn bin(&self, item: &Item, axis: usize) -> usize {
        (((item.center()[axis] - self.first[axis]) * self.scale[axis]) as usize).min(BINS - 1)
    }

    fn best_split(&self, items: &[Item]) -> Option<Split> {
        let mut bins = [[(Aabb::EMPTY, 0usize); BINS]; 3];
        for item in items {
            for (axis, bins) in bins.iter_mut().enumerate() {
                let (bounds, count) = &mut bins[self.bin(item, axis)];
                *bounds = bounds.join(item.bounds);
                *count += 1;
            }
        }
        let splits = bins.iter().enumerate().filter_map(|(axis, bins)| cheapest(axis, bins));
        splits.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// The cheapest split along an axis: the sum over both children of area times number of triangles. `None` if all triangles
/// are in one bin.
fn cheapest(axis: usize, bins: &[(Aabb, usize); BINS]) -> Option<Split> {
    let mut right = [0.0; BINS];
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
    for bin in (1..BINS).rev() {
        bounds = bounds.join(bins[bin].0);
        count += bins[bin].1;
        right[bin] = if count == 0 { f32::INFINITY } else { bounds.area() * count as f32 };
    }
    let mut best: Option<Split> = None;
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
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
            let bounds = Aabb { min: a.min(*b).min(*c), max: a.max(*b).max(*c) };
            Item { bounds, index: index as u32 }
        };
        let mut items: Vec<Item> = triangles.iter().enumerate().map(item).collect();
        let nodes = build(&mut items, 0, 0);
        Self { nodes, order: items.iter().map(|item| item.index).collect() }
    }
}

/// Below this many items, a subtree is built on one thread.
const ITEMS_A_TASK: usize = 1 << 14;

/// The subtree of these items, its root first; indices of children count from there. `start`: the place of the first item in
/// the whole list.
fn build(items: &mut [Item], start: usize, depth: u32) -> Vec<BvhNode> {
    if items.len() <= ITEMS_A_TASK {
        return build_on_one_thread(items, start, depth);
    }
    let root = node(items);
    let Some(middle) = split(items, depth) else { return build_on_one_thread(items, start, depth) };
    let (left, right) = items.split_at_mut(middle);
    let (left, right) = rayon::join(|| build(left, start, depth + 1), || build(right, start + middle, depth + 1));

    // The roots of both children are neighbors. After them come the rest of the left subtree and that of the right.
    let moved = |node: &BvhNode, by: usize| match node.count {
        0 => BvhNode { first: node.first + by as u32, ..*node },
        _ => *node,
    };
    let mut nodes = Vec::with_capacity(1 + left.len() + right.len());
    nodes.extend([BvhNode { first: 1, ..root }, moved(&left[0], 2), moved(&right[0], left.len() + 1)]);
    nodes.extend(left[1..].iter().map(|node| moved(node, 2)));
    nodes.extend(right[1..].iter().map(|node| moved(node, left.len() + 1)));
    nodes
}

/// [`build`] without threads, and without copying nodes.
fn build_on_one_thread(items: &mut [Item], start: usize, depth: u32) -> Vec<BvhNode> {
    let mut nodes = vec![BvhNode::default()];
    // Nodes without content yet: index, range of items, depth.
    let mut waiting = vec![(0, 0..items.len(), depth)];
    while let Some((at, range, depth)) = waiting.pop() {
        let own = &mut items[range.clone()];
        nodes[at] = match split(own, depth) {
            None => BvhNode { first: (start + range.start) as u32, count: own.len() as u32, ..node(own) },
            Some(middle) => {
                let children = nodes.len();
                nodes.resize(children + 2, BvhNode::default());
                let middle = range.start + middle;
                waiting.push((children, range.start..middle, depth + 1));
                waiting.push((children + 1, middle..range.end, depth + 1));
                BvhNode { first: children as u32, ..node(&items[range]) }
            }
        };
    }
    nodes
}

/// A node around these items, without children or triangles.
fn node(items: &[Item]) -> BvhNode {
    let bounds = items.iter().map(|item| item.bounds).reduce(Aabb::join).unwrap_or(Aabb::NOTHING);
    BvhNode { min_ws: bounds.min.to_array(), max_ws: bounds.max.to_array(), ..BvhNode::default() }
}

/// Reorders the items of a node so that those of the left child come first. Returns their number, or `None` for a leaf.
fn split(items: &mut [Item], depth: u32) -> Option<usize> {
    if items.len() <= LEAF {
        return None;
    }
    let middle = items.len() / 2;
    if depth >= BALANCED_DEPTH {
        return Some(middle);
    }
    let binning = Binning::new(items);
    match binning.best_split(items) {
        Some(Split { axis, bin, .. }) => Some(partition(items, |item| binning.bin(item, axis) < bin)),
        // All centers coincide.
        None => Some(middle),
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
        // One thread, and several.
        for count in [5000, 3 * ITEMS_A_TASK] {
            let triangles = cloud(count, 0.02);
            let bvh = Bvh::new(&triangles);
            let depth = checked_depth(&bvh, &triangles);
            assert!((11..30).contains(&depth), "{depth}");
            assert!(bvh.nodes.len() < triangles.len());
        }
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
