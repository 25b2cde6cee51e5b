//! Sorts the lights of a frame into the cells of a grid, so that a point is lit by the lights that reach it alone (clustered
//! shading: Olsson, Billeter and Assarsson 2012).
//!
//! The cells are boxes in world space, not in the camera's frustum as in that paper. So one grid serves every camera, size and view of a
//! frame, and also what no camera sees: hits of path tracing, the ground, compute passes. It changes with the lights alone. It spans only
//! the part of the model's bounds that lights with a range reach. Its outermost cells have no end: they hold the points outside of it.
//!
//! A light is in the list of every cell that it may reach, so the picture is that of a loop over all lights: beyond its range and outside
//! its cone, a light of KHR_lights_punctual is exactly 0. Lights without an end, or in more than half of the cells, are in one list for
//! all cells, which comes first. Lists are in ascending order, so sums are the same in each frame, and up to the last bits those of a loop. (`lights.cutoff` gives lights of a file without a range an end.)
//!
//! Limits: a cone narrows its light's place to the sphere around the cone, not to the cone. If `user_light` changes more of a light than
//! its intensity, every light counts for every point, since the grid cannot follow it.

use glam::{Vec3, Vec4Swizzles};

use super::model::Bounds;
use crate::interface::{self, Light};

/// Cells of a grid, at most, without the layers for points outside.
const MOST_CELLS: usize = 32_768;
/// Cells that lists may name in all. Beyond it, the lights with the largest range go to the list for all cells.
const MOST_NAMED: u64 = 1 << 20;
/// End of a list.
const END: u32 = u32::MAX;

/// The lights of a frame by place, as the bytes of `BINDING_LIGHT_GRID`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LightGrid {
    bytes: Vec<u8>,
}

/// A box and a sphere in it that hold all points that a light reaches, in cells from the grid's corner.
struct Reach {
    light: u32,
    center: Vec3,
    radius: Vec3,
    first: [u32; 3],
    end: [u32; 3],
}

impl Reach {
    fn cells(&self) -> u64 {
        (0..3).map(|axis| u64::from(self.end[axis].saturating_sub(self.first[axis]))).product()
    }
}

impl LightGrid {
    /// The grid of lights that shine on a model with these bounds.
    pub fn new(lights: &[Light], bounds: &Bounds) -> Self {
        let spheres: Vec<Option<(Vec3, f32)>> = lights.iter().map(sphere).collect();
        let known = || spheres.iter().flatten();
        let corner = |pick: fn(Vec3, Vec3) -> Vec3, side: f32, none: Vec3| {
            known().map(|(center, radius)| *center + Vec3::splat(side * radius)).fold(none, pick)
        };
        // A flat model has a grid of some height, and rounding leaves no point of the model outside.
        let margin = 1e-3 * bounds.radius() + 1e-5 * bounds.center().abs().max_element();
        let (reached_min, reached_max) = (corner(Vec3::min, -1.0, Vec3::MAX), corner(Vec3::max, 1.0, Vec3::MIN));
        let (mut min, mut max) = (reached_min.max(bounds.min - margin), reached_max.min(bounds.max + margin));
        let size = max - min;
        if !(size.is_finite() && size.min_element() > 0.0) {
            // No light with a range reaches the model. Points outside of it may still be lit.
            return Self::everywhere(lights.len());
        }
        let mut cells = cells_of(size);
        let per_m = Vec3::from(cells.map(|count| count as f32)) / size;
        // Where no light reaches beyond the grid, an outermost layer without lights is for the points there.
        for axis in 0..3 {
            if reached_min[axis] >= min[axis] {
                min[axis] -= 1.0 / per_m[axis];
                cells[axis] += 1;
            }
            if reached_max[axis] <= max[axis] {
                max[axis] += 1.0 / per_m[axis];
                cells[axis] += 1;
            }
        }
        // What rounding may move a point by, in cells.
        let slack = 1e-3 + 4e-7 * min.abs().max(max.abs()).max_element() * per_m.max_element();
        let mut reaches: Vec<Reach> = Vec::new();
        for (light, sphere) in spheres.iter().enumerate() {
            let Some((center, radius)) = *sphere else { continue };
            let (center, radius) = ((center - min) * per_m, radius * per_m + 2.0 * slack);
            let index = |at: Vec3| [0, 1, 2].map(|axis| at[axis].floor().clamp(0.0, cells[axis] as f32 - 1.0) as u32);
            let (first, end) = (index(center - radius), index(center + radius).map(|last| last + 1));
            reaches.push(Reach { light: light as u32, center, radius, first, end });
        }
        let limit = largest_reach(&reaches, cells.iter().product());
        // Cells and lights that reach them. Sorted by cell, they stay in the order of the lights.
        let mut named: Vec<[u32; 2]> = Vec::new();
        let mut is_everywhere: Vec<bool> = spheres.iter().map(Option::is_none).collect();
        for reach in &reaches {
            if reach.cells() > limit {
                is_everywhere[reach.light as usize] = true;
                continue;
            }
            reach.name_cells(cells, &mut named);
        }
        let everywhere = (0..lights.len()).filter(|light| is_everywhere[*light]).map(|light| light as u32).collect();
        let head = interface::LightGrid {
            min_ws: min.to_array(),
            cells_per_m: per_m.to_array(),
            cells,
            ..interface::LightGrid::default()
        };
        Self::of_lists(head, &named, everywhere)
    }

    /// All lights for every point.
    pub fn everywhere(count: usize) -> Self {
        Self::of_lists(interface::LightGrid::default(), &[], (0..count as u32).collect())
    }

    /// The words after the head: where the list of each cell begins, and the end of the last; then the lists, each with [`END`] behind
    /// it, and the list for all points. Without cells there is one empty list.
    fn of_lists(mut head: interface::LightGrid, named: &[[u32; 2]], everywhere: Vec<u32>) -> Self {
        let lists = head.cells.iter().product::<u32>().max(1) as usize;
        let mut places = vec![1; lists + 1];
        for [cell, _] in named {
            places[*cell as usize] += 1;
        }
        let mut at = lists as u32 + 1;
        for place in &mut places {
            at += std::mem::replace(place, at);
        }
        (head.everywhere, head.everywhere_count) = (places[lists], everywhere.len() as u32);
        let mut words = places.clone();
        words.resize(places[lists] as usize, END);
        for [cell, light] in named {
            let place = &mut places[*cell as usize];
            words[*place as usize] = *light;
            *place += 1;
        }
        words.extend(everywhere);
        words.push(END);
        Self { bytes: [bytemuck::bytes_of(&head), bytemuck::cast_slice(&words)].concat() }
    }

    /// The content of the buffer.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }
}

impl Reach {
    /// Names each cell that the sphere touches. Cells may be flat boxes, so distances are measured in radii. The outermost have no end.
    fn name_cells(&self, cells: [u32; 3], named: &mut Vec<[u32; 2]>) {
        // Squared distance of the cells at a place along an axis, in radii.
        let apart = |axis: usize, at: u32| {
            let (low, center) = (at as f32, self.center[axis]);
            let below = if at == 0 { 0.0 } else { low - center };
            let above = if at + 1 == cells[axis] { 0.0 } else { center - low - 1.0 };
            let distance = below.max(above).max(0.0) / self.radius[axis];
            distance * distance
        };
        let row = |axis: usize| (self.first[axis]..self.end[axis]).map(move |at| (at, apart(axis, at)));
        let xs: Vec<(u32, f32)> = row(0).collect();
        for (z, of_z) in row(2) {
            for (y, of_y) in row(1) {
                let row = (z * cells[1] + y) * cells[0];
                let touched = xs.iter().filter(|(_, of_x)| of_x + of_y + of_z <= 1.0);
                named.extend(touched.map(|(x, _)| [row + x, self.light]));
            }
        }
    }
}

/// The most cells that a light may have of its own: half of them, or fewer if the lists would become too long.
fn largest_reach(reaches: &[Reach], count: u32) -> u64 {
    let limit = u64::from(count).div_ceil(2);
    let mut sizes: Vec<u64> = reaches.iter().map(Reach::cells).filter(|cells| *cells <= limit).collect();
    sizes.sort_unstable();
    let mut named = 0;
    for cells in sizes {
        named += cells;
        if named > MOST_NAMED {
            return cells - 1;
        }
    }
    limit
}

/// The numbers of cells along the axes of a box of this size, m: as many as there may be, as close to cubes as they can be.
fn cells_of(size: Vec3) -> [u32; 3] {
    let cells = |side: f32| size.to_array().map(|size| (size / side).ceil().clamp(1.0, MOST_CELLS as f32) as u32);
    let count = |side: f32| cells(side).iter().map(|cells| u64::from(*cells)).product::<u64>();
    let (mut low, mut high) = (0.0, size.max_element());
    for _ in 0..24 {
        let side = 0.5 * (low + high);
        if side > 0.0 && count(side) <= MOST_CELLS as u64 { high = side } else { low = side }
    }
    cells(high)
}

/// Center and radius of a sphere that holds all points that the light reaches, world space. `None` if there is no end to them.
fn sphere(light: &Light) -> Option<(Vec3, f32)> {
    // A little more, for what rounding adds to a distance.
    let range = 1.0001 / light.inverse_range;
    let ends = matches!(light.kind, interface::LIGHT_POINT | interface::LIGHT_SPOT);
    let center = glam::Vec4::from(light.position_ws).xyz();
    let sphere = match light.kind {
        interface::LIGHT_SPOT if light.angle_scale > 0.0 => {
            // The cosine of the outer angle, where the ramp is 0.
            let cosine = (-light.angle_offset / light.angle_scale - 1e-4).clamp(0.0, 1.0);
            let direction = Vec3::from(light.direction_ws);
            if cosine * cosine > 0.5 {
                let radius = 0.5 * range / cosine;
                (center + direction * radius, radius * 1.0001)
            } else {
                (center + direction * (range * cosine), range * (1.0 - cosine * cosine).sqrt() * 1.0001)
            }
        }
        _ => (center, range),
    };
    (ends && range.is_finite() && range > 0.0 && sphere.0.is_finite()).then_some(sphere)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of point lights along x from 0 to 10, each with this range.
    fn row(count: usize, range: f32) -> Vec<Light> {
        let at = |index: usize| 10.0 * index as f32 / (count - 1) as f32;
        let light = |index| Light {
            position_ws: [at(index), 0.0, 0.0, 1.0],
            kind: interface::LIGHT_POINT,
            inverse_range: 1.0 / range,
            angle_offset: 1.0,
            ..Light::default()
        };
        (0..count).map(light).collect()
    }

    fn bounds() -> Bounds {
        Bounds { min: Vec3::new(-1.0, -2.0, -3.0), max: Vec3::new(11.0, 2.0, 3.0) }
    }

    /// The lists that a shader finds for a point: of its cell, and for all points.
    fn lists(grid: &LightGrid, point: Vec3) -> [Vec<u32>; 2] {
        let (head, words) = grid.bytes.split_at(size_of::<interface::LightGrid>());
        let head: interface::LightGrid = bytemuck::pod_read_unaligned(head);
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(words);
        let at = ((point - Vec3::from(head.min_ws)) * Vec3::from(head.cells_per_m)).floor();
        let cells = Vec3::from(head.cells.map(|cells| cells as f32));
        let [x, y, z] = at.clamp(Vec3::ZERO, (cells - 1.0).max(Vec3::ZERO)).to_array().map(|at| at as u32);
        let cell = (z * head.cells[1] + y) * head.cells[0] + x;
        let list = |place: u32| words[place as usize..].iter().copied().take_while(|word| *word != END).collect();
        let [of_cell, next]: [u32; 2] = words[cell as usize..][..2].try_into().unwrap();
        let of_cell_list: Vec<u32> = list(of_cell);
        assert_eq!(of_cell_list.len() as u32, next - of_cell - 1);
        let everywhere: Vec<u32> = list(head.everywhere);
        assert_eq!(everywhere.len() as u32, head.everywhere_count);
        [of_cell_list, everywhere]
    }

    /// Points in and around the bounds.
    fn points() -> impl Iterator<Item = Vec3> {
        let part = |index: u32, step: u32| (index * step % 4096) as f32 / 4095.0;
        (0..4096).map(move |index| {
            let part = Vec3::new(part(index, 1), part(index, 641), part(index, 1789));
            Vec3::new(-3.0, -3.0, -4.0) + part * Vec3::new(16.0, 6.0, 8.0)
        })
    }

    #[test]
    fn every_light_that_reaches_a_point_is_listed_in_order() {
        let mut lights = row(300, 0.7);
        lights[7].inverse_range = 0.0;
        lights[8].inverse_range = 1.0 / 40.0;
        lights[9] = Light { kind: interface::LIGHT_DIRECTIONAL, position_ws: [0.0, 1.0, 0.0, 0.0], ..lights[9] };
        let grid = LightGrid::new(&lights, &bounds());
        let mut named = 0;
        for point in points() {
            let [cell, everywhere] = lists(&grid, point);
            assert_eq!(everywhere, [7, 8, 9]);
            assert!(cell.is_sorted());
            for (index, light) in lights.iter().enumerate() {
                let distance = point.distance(glam::Vec4::from(light.position_ws).xyz());
                let reaches = distance * light.inverse_range < 1.0;
                let is_listed = cell.contains(&(index as u32)) || everywhere.contains(&(index as u32));
                assert!(is_listed || !reaches, "{point} {index}");
            }
            named += cell.len();
        }
        // A sphere has 1.4 m3, the box of all points 768: of 300 lights, each point is reached by 0.6 on average.
        assert!(named < 2 * 4096, "{named}");
    }

    #[test]
    fn a_narrow_cone_is_in_fewer_cells_than_the_sphere_around_its_light() {
        let aimed = |angle: f32| {
            let (cosine, scale) = (angle.to_radians().cos(), 10.0);
            let spot = |light| Light {
                kind: interface::LIGHT_SPOT,
                direction_ws: [0.0, 0.6, 0.8],
                angle_scale: scale,
                angle_offset: -cosine * scale,
                ..light
            };
            row(100, 2.0).into_iter().map(spot).collect::<Vec<_>>()
        };
        let named = |lights: &[Light]| {
            let grid = LightGrid::new(lights, &bounds());
            let listed = points().map(|point| (point, lists(&grid, point).concat()));
            let mut named = 0;
            for (point, list) in listed {
                named += list.len();
                for (index, light) in lights.iter().enumerate() {
                    let to = point - glam::Vec4::from(light.position_ws).xyz();
                    let cosine = to.normalize().dot(Vec3::from(light.direction_ws));
                    let is_lit = to.length() < 2.0 && cosine * light.angle_scale + light.angle_offset > 0.0;
                    assert!(!is_lit || light.kind != interface::LIGHT_SPOT || list.contains(&(index as u32)));
                }
            }
            named
        };
        let of_spheres = named(&row(100, 2.0));
        let [narrow, wide] = [20.0, 60.0].map(|angle| named(&aimed(angle)));
        assert!(4 * narrow < of_spheres && narrow < wide, "{narrow} {wide} {of_spheres}");
    }

    #[test]
    fn lists_stay_short_enough_for_memory() {
        // Each reaches 0.4 of the model.
        let lights: Vec<Light> = row(30_000, 2.2);
        let grid = LightGrid::new(&lights, &bounds());
        assert!(grid.bytes.len() < 8 << 20, "{}", grid.bytes.len());
        let [cell, everywhere] = lists(&grid, Vec3::new(5.0, 0.0, 0.0));
        assert!(cell.len() + everywhere.len() > 10_000);
    }

    #[test]
    fn without_lights_or_a_model_there_is_no_grid() {
        for (lights, bounds) in [(Vec::new(), bounds()), (row(3, 1.0), Bounds::default()), (row(3, 0.0), bounds())] {
            let grid = LightGrid::new(&lights, &bounds);
            assert_eq!(grid, LightGrid::everywhere(lights.len()));
            let all: Vec<u32> = (0..lights.len() as u32).collect();
            assert_eq!(lists(&grid, Vec3::ONE), [Vec::new(), all]);
        }
    }
}
