//! Importance sampling of an environment: an alias table over cells of its cube map, each as likely as it is bright and large.
//! `shaders/paths/environment_sampling.glsl` draws from it.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::interface::EnvironmentCell;

const FACES: usize = 6;

/// Luminance of linear RGB (ITU-R BT.709).
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The texels of a cube map's largest level, as luminance: faces +X -X +Y -Y +Z -Z, row by row.
pub struct CubeLuminance {
    side: usize,
    texels: Vec<f32>,
}

impl CubeLuminance {
    /// Takes `6 * side * side` texels of linear RGBA half floats. Values below 0 count as 0.
    pub fn new(side: usize, rgba: &[[half::f16; 4]]) -> Self {
        let luminance = |texel: &[half::f16; 4]| {
            let [r, g, b, _] = texel.map(half::f16::to_f32);
            Vec3::new(r, g, b).dot(LUMINANCE).max(0.0)
        };
        Self { side, texels: rgba.par_iter().map(luminance).collect() }
    }

    /// The cells of an alias table, and their number along a side of a face: half as many as texels. Without any light, there
    /// are no cells.
    pub fn alias_table(&self) -> (usize, Vec<EnvironmentCell>) {
        let side = (self.side / 2).max(1);
        let cell = |index: usize| {
            let (face, row, column) = (index / (side * side), index / side % side, index % side);
            self.mean(face, side, [column, row]) * solid_angle(side, [column, row])
        };
        let weights: Vec<f32> = (0..FACES * side * side).into_par_iter().map(cell).collect();
        let total: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
        if total <= 0.0 || !total.is_finite() {
            return (0, Vec::new());
        }
        (side, alias_table(&weights, total, side))
    }

    /// Mean luminance of a cell, with the linear interpolation of the sampler. So a cell next to a bright texel is not sampled
    /// too rarely, which would cause fireflies.
    fn mean(&self, face: usize, cells: usize, [column, row]: [usize; 2]) -> f32 {
        // The integral of linear interpolation over two texels, of which the neighbors reach into an eighth each.
        const WEIGHTS: [f32; 4] = [1.0 / 16.0, 7.0 / 16.0, 7.0 / 16.0, 1.0 / 16.0];
        if self.side == 1 {
            return self.texels[face];
        }
        let step = self.side / cells;
        let at = |cell: usize, tap: usize| (cell * step + tap) as isize - 1;
        let mut sum = 0.0;
        for (y, wy) in WEIGHTS.iter().enumerate() {
            for (x, wx) in WEIGHTS.iter().enumerate() {
                sum += wx * wy * self.texel(face, at(column, x), at(row, y));
            }
        }
        sum
    }

    /// A texel, at most one outside the face: read from the adjacent face, as a seamless sampler does.
    fn texel(&self, face: usize, x: isize, y: isize) -> f32 {
        let side = self.side as isize;
        let (face, x, y) = match (0..side).contains(&x) && (0..side).contains(&y) {
            true => (face, x as usize, y as usize),
            false => self.locate(direction(face, Vec2::new(center(x, side), center(y, side)))),
        };
        self.texels[(face * self.side + y) * self.side + x]
    }

    /// Face, column and row of the texel in a direction.
    fn locate(&self, d: Vec3) -> (usize, usize, usize) {
        let (face, st) = face_of(d);
        let index = |s: f32| (((s * 0.5 + 0.5) * self.side as f32) as usize).min(self.side - 1);
        (face, index(st.x), index(st.y))
    }
}

/// Center of a texel of a face that spans -1..1.
fn center(texel: isize, side: isize) -> f32 {
    (texel as f32 + 0.5) * 2.0 / side as f32 - 1.0
}

/// `cube_position` of shaders/ibl/maps/cube_map.glsl.
fn direction(face: usize, st: Vec2) -> Vec3 {
    match face {
        0 => Vec3::new(1.0, -st.y, -st.x),
        1 => Vec3::new(-1.0, -st.y, st.x),
        2 => Vec3::new(st.x, 1.0, st.y),
        3 => Vec3::new(st.x, -1.0, -st.y),
        4 => Vec3::new(st.x, -st.y, 1.0),
        _ => Vec3::new(-st.x, -st.y, -1.0),
    }
}

/// The inverse of [`direction`].
fn face_of(d: Vec3) -> (usize, Vec2) {
    let size = d.abs();
    let (face, st) = if size.x >= size.y && size.x >= size.z {
        if d.x > 0.0 { (0, Vec2::new(-d.z, -d.y)) } else { (1, Vec2::new(d.z, -d.y)) }
    } else if size.y >= size.z {
        if d.y > 0.0 { (2, Vec2::new(d.x, d.z)) } else { (3, Vec2::new(d.x, -d.z)) }
    } else if d.z > 0.0 {
        (4, Vec2::new(d.x, -d.y))
    } else {
        (5, Vec2::new(-d.x, -d.y))
    };
    (face, st / size.max_element())
}

/// Solid angle of a cell by the density at its center, (1 + s^2 + t^2)^(-3/2). The table stores the probability that results,
/// so an error here costs efficiency, not correctness.
fn solid_angle(side: usize, [column, row]: [usize; 2]) -> f32 {
    let at = |cell: usize| center(cell as isize, side as isize);
    (1.0 + at(column).powi(2) + at(row).powi(2)).powf(-1.5)
}

/// Vose 1991, "A Linear Algorithm For Generating Random Numbers With a Given Distribution": each cell keeps a part of its
/// probability of being chosen uniformly and gives the rest to one that needs more.
fn alias_table(weights: &[f32], total: f64, side: usize) -> Vec<EnvironmentCell> {
    let count = weights.len() as f64;
    let area = 4.0 / (side * side) as f64;
    let mut scaled: Vec<f64> = weights.iter().map(|weight| f64::from(*weight) * count / total).collect();
    let cell = |(index, weight): (usize, &f32)| EnvironmentCell {
        keep: 1.0,
        other: index as u32,
        density: (f64::from(*weight) / total / area) as f32,
    };
    let mut cells: Vec<EnvironmentCell> = weights.iter().enumerate().map(cell).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..weights.len()).partition(|index| scaled[*index] < 1.0);
    while let (Some(less), Some(&more)) = (small.pop(), large.last()) {
        cells[less].keep = scaled[less] as f32;
        cells[less].other = more as u32;
        scaled[more] -= 1.0 - scaled[less];
        if scaled[more] < 1.0 {
            large.pop();
            small.push(more);
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use half::f16;

    use super::*;

    fn cube(side: usize, value: impl Fn(usize) -> f32) -> CubeLuminance {
        let texel = |index: usize| [f16::from_f32(value(index)); 4];
        CubeLuminance::new(side, &(0..FACES * side * side).map(texel).collect::<Vec<_>>())
    }

    /// The probability of each cell that a draw from the table results in.
    fn drawn(cells: &[EnvironmentCell]) -> Vec<f64> {
        let mut probability = vec![0.0; cells.len()];
        for (index, cell) in cells.iter().enumerate() {
            probability[index] += f64::from(cell.keep) / cells.len() as f64;
            probability[cell.other as usize] += f64::from(1.0 - cell.keep) / cells.len() as f64;
        }
        probability
    }

    #[test]
    fn draws_have_the_density_that_the_table_states() {
        let (side, cells) = cube(16, |index| (index * 7919 % 101) as f32).alias_table();
        assert_eq!((side, cells.len()), (8, 6 * 64));
        let area = 4.0 / 64.0;
        for (cell, drawn) in cells.iter().zip(drawn(&cells)) {
            let stated = f64::from(cell.density) * area;
            assert!((stated - drawn).abs() < 1e-6, "{cell:?}: drawn with {drawn}");
        }
        let sum: f64 = cells.iter().map(|cell| f64::from(cell.density) * area).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
    }

    #[test]
    fn a_bright_texel_shines_into_the_cells_around_it_across_the_edges() {
        // The first texel of the first face is at the corner of +X, +Y and +Z.
        let (_, cells) = cube(8, |index| if index == 0 { 1.0 } else { 0.0 }).alias_table();
        let faces: Vec<usize> = (0..cells.len()).filter(|i| cells[*i].density > 0.0).map(|i| i / 16).collect();
        assert!([0, 2, 4].iter().all(|face| faces.contains(face)), "{faces:?}");
        assert!(!faces.contains(&1) && !faces.contains(&3) && !faces.contains(&5), "{faces:?}");
        let own = f64::from(cells[0].density) * 4.0 / 16.0;
        assert!(own > 0.7 && own < 0.95, "{own}");
    }

    #[test]
    fn faces_and_directions_agree() {
        for face in 0..FACES {
            for st in [Vec2::new(0.3, -0.7), Vec2::new(-0.9, 0.2)] {
                let (found, at) = face_of(direction(face, st));
                assert!(found == face && at.distance(st) < 1e-6, "{face} {st}: {found} {at}");
            }
        }
    }

    #[test]
    fn darkness_has_no_cells() {
        assert_eq!(cube(4, |_| 0.0).alias_table().0, 0);
        assert_eq!(cube(1, |_| 2.0).alias_table().1.len(), 6);
    }
}
