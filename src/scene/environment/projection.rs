//! How the pixels of an image lie on the sphere, and the conversion of cubes to the equirectangular form.

use glam::{Mat3, Vec2, Vec3};
use rayon::prelude::*;

use super::direction::TexelDirections;

/// The projection of an environment image.
#[derive(Clone, Copy, Debug)]
pub enum Projection {
    /// Longitude and latitude.
    Equirectangular,
    /// Six faces.
    Cube(&'static Layout),
}

/// Where the faces of a cube are in an image.
#[derive(Debug)]
pub struct Layout {
    /// Its name, for messages.
    pub name: &'static str,
    /// Columns and rows of faces.
    grid: (u32, u32),
    /// Column and row of the faces right, left, up, down, front (-Z), back, each as it is seen from the center of the cube with the
    /// front upright, and whether it is turned by 180 degrees.
    faces: [(u32, u32, bool); 6],
    /// Whether the outermost texel centers lie on the edges of the cube.
    reaches_edges: bool,
}

/// The order of OpenGL, whose z points away from the front: +X -X +Y -Y +Z -Z.
const ROW: [(u32, u32, bool); 6] =
    [(0, 0, false), (1, 0, false), (2, 0, false), (3, 0, false), (4, 0, false), (5, 0, false)];

/// Six faces in the order of OpenGL, side by side.
pub static GL_ROW: Layout =
    Layout { name: "six faces of a cube from left to right", grid: (6, 1), faces: ROW, reaches_edges: false };

static LAYOUTS: [&Layout; 4] = [
    &Layout {
        name: "a horizontal cross of six faces of a cube",
        grid: (4, 3),
        faces: [(2, 1, false), (0, 1, false), (1, 0, false), (1, 2, false), (1, 1, false), (3, 1, false)],
        reaches_edges: false,
    },
    &Layout {
        name: "a vertical cross of six faces of a cube",
        grid: (3, 4),
        faces: [(2, 1, false), (0, 1, false), (1, 0, false), (1, 2, false), (1, 1, false), (1, 3, true)],
        reaches_edges: false,
    },
    &GL_ROW,
    &Layout {
        name: "six faces of a cube, one below the other",
        grid: (1, 6),
        faces: [(0, 0, false), (0, 1, false), (0, 2, false), (0, 3, false), (0, 4, false), (0, 5, false)],
        reaches_edges: false,
    },
];

/// The cube of OpenEXR's `envmap` attribute (ImfEnvmap.h). Its +X is left of the middle of an equirectangular image.
pub static OPEN_EXR_CUBE: Layout = Layout {
    name: "the cube of its attribute envmap",
    grid: (1, 6),
    faces: [(0, 1, false), (0, 0, false), (0, 2, true), (0, 3, true), (0, 4, false), (0, 5, false)],
    reaches_edges: true,
};

impl Projection {
    /// The projection that images of this shape have; `None` if none has it.
    pub fn of_shape(width: u32, height: u32) -> Option<Self> {
        if u64::from(width) == 2 * u64::from(height) {
            return Some(Self::Equirectangular);
        }
        LAYOUTS.into_iter().find(|layout| layout.fits(width, height)).map(Self::Cube)
    }
}

impl Layout {
    /// Whether square faces fill an image of this size.
    pub fn fits(&self, width: u32, height: u32) -> bool {
        let (columns, rows) = self.grid;
        width.is_multiple_of(columns) && height.is_multiple_of(rows) && width / columns == height / rows
    }

    /// Width, height and pixels of the equirectangular image, which is at most `widest` pixels wide.
    pub fn unwrap(
        &self,
        (width, height): (u32, u32),
        pixels: &[[f32; 4]],
        widest: u32,
        cube_from_world: Mat3,
    ) -> (u32, u32, Vec<[f32; 4]>) {
        let side = (width / self.grid.0).min(height / self.grid.1);
        let columns = (4 * side).min(widest);
        let directions = TexelDirections::new(columns as usize, columns as usize / 2);
        let mut unwrapped = vec![[0.0; 4]; columns as usize * (columns as usize / 2)];
        unwrapped.par_chunks_exact_mut(columns as usize).enumerate().for_each(|(y, row)| {
            for (pixel, direction) in row.iter_mut().zip(directions.row(y)) {
                *pixel = self.sample(width, side, pixels, cube_from_world * direction);
            }
        });
        (columns, columns / 2, unwrapped)
    }

    /// The texels around a direction, weighted by their distance to it.
    fn sample(&self, width: u32, side: u32, pixels: &[[f32; 4]], direction: Vec3) -> [f32; 4] {
        let (face, at) = face(direction);
        let (column, row, is_turned) = self.faces[face];
        let at = if is_turned { -at } else { at };
        let last = (side - 1) as f32;
        let at = match self.reaches_edges {
            true => (at + 1.0) * 0.5 * last,
            false => (at + 1.0) * 0.5 * side as f32 - 0.5,
        };
        let at = at.clamp(Vec2::ZERO, Vec2::splat(last));
        let low = at.floor().min(Vec2::splat((last - 1.0).max(0.0)));
        let weight = at - low;
        let texel = |dx: u32, dy: u32| {
            let (x, y) = ((low.x as u32 + dx).min(side - 1), (low.y as u32 + dy).min(side - 1));
            let (x, y) = (column * side + x, row * side + y);
            glam::Vec4::from(pixels[y as usize * width as usize + x as usize])
        };
        let (upper, lower) = (texel(0, 0).lerp(texel(1, 0), weight.x), texel(0, 1).lerp(texel(1, 1), weight.x));
        upper.lerp(lower, weight.y).to_array()
    }
}

/// The face that a direction meets, and where: from -1 to 1, rightwards and downwards.
fn face(direction: Vec3) -> (usize, Vec2) {
    // z points away from the front, as in OpenGL's cube maps.
    let Vec3 { x, y, z } = direction * Vec3::new(1.0, 1.0, -1.0);
    let size = direction.abs();
    let (face, right, down, depth) = if size.x >= size.y && size.x >= size.z {
        if x > 0.0 { (0, -z, -y, size.x) } else { (1, z, -y, size.x) }
    } else if size.y >= size.z {
        if y > 0.0 { (2, x, z, size.y) } else { (3, x, -z, size.y) }
    } else if z > 0.0 {
        (4, x, -y, size.z)
    } else {
        (5, -x, -y, size.z)
    };
    (face, Vec2::new(right, down) / depth)
}
