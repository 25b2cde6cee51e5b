//! assets/ltc.bin, the table of linearly transformed cosines, against the lobe that it approximates: an independent GGX
//! (Walter et al. 2007) with height-correlated Smith (Heitz 2014), integrated over the hemisphere.

use std::f64::consts::PI;

use half::f16;

const SIZE: usize = 64;
const TABLE: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/ltc.bin"));

/// a, b, c, d of the inverse matrix (a 0 b; 0 1 0; c 0 d).
fn texel(column: usize, row: usize) -> [f64; 4] {
    std::array::from_fn(|k| {
        let at = ((row * SIZE + column) * 4 + k) * 2;
        f16::from_le_bytes([TABLE[at], TABLE[at + 1]]).to_f64()
    })
}

/// D V NoL at F = 1, v in the plane y = 0 at x > 0.
fn ggx(l: [f64; 3], n_dot_v: f64, alpha: f64) -> f64 {
    let v = [(1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v];
    let h = [l[0] + v[0], l[1] + v[1], l[2] + v[2]];
    let n_dot_h_squared = h[2] * h[2] / (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    let a2 = alpha * alpha;
    let d = a2 / (PI * (n_dot_h_squared * (a2 - 1.0) + 1.0).powi(2));
    let lambda = |c: f64| ((1.0 + a2 * (1.0 - c * c) / (c * c)).sqrt() - 1.0) / 2.0;
    d / (4.0 * n_dot_v * (1.0 + lambda(l[2]) + lambda(n_dot_v)))
}

/// The transformed cosine, scaled up to compensate for clipping at the horizon, as in shaders/lighting/area.glsl.
fn transformed_cosine(l: [f64; 3], [a, b, c, d]: [f64; 4]) -> f64 {
    let (x, y, z) = (a * l[0] + b * l[2], l[1], c * l[0] + d * l[2]);
    let above = 0.5 + 0.5 * a / a.hypot(c);
    (a * d - b * c) / PI * z.max(0.0) / (x * x + y * y + z * z).powi(2) / above
}

/// Sums over directions of equal solid angle. Returns the integral of the transformed cosine, and half the integral of
/// the absolute difference of the two normalized shapes, which bounds the error for a light of any outline.
fn compare(column: usize, row: usize) -> (f64, f64) {
    let roughness = column as f64 / (SIZE - 1) as f64;
    let n_dot_v = 1.0 - (row as f64 / (SIZE - 1) as f64).powi(2);
    let matrix = texel(column, row);
    let (rings, sectors) = (500, 500);
    let solid_angle = 2.0 * PI / f64::from(rings * sectors);
    let pairs: Vec<(f64, f64)> = (0..rings * sectors)
        .map(|i| {
            let z = (f64::from(i / sectors) + 0.5) / f64::from(rings);
            let (sin, cos) = (2.0 * PI * (f64::from(i % sectors) + 0.5) / f64::from(sectors)).sin_cos();
            let s = (1.0 - z * z).sqrt();
            let l = [s * cos, s * sin, z];
            (ggx(l, n_dot_v, roughness * roughness), transformed_cosine(l, matrix))
        })
        .collect();
    let albedo = pairs.iter().map(|(g, _)| g * solid_angle).sum::<f64>();
    let mass = pairs.iter().map(|(_, t)| t * solid_angle).sum::<f64>();
    let distance = pairs.iter().map(|(g, t)| (g / albedo - t).abs() * solid_angle / 2.0).sum();
    (mass, distance)
}

#[test]
fn transformed_cosines_have_the_shape_of_ggx() {
    assert_eq!(TABLE.len(), SIZE * SIZE * 4 * 2);
    // Column, row, and a bound of 1.2 times the error of the fit.
    let bounds = [(24, 0, 0.013), (24, 36, 0.032), (40, 20, 0.031), (40, 50, 0.094), (63, 44, 0.032), (63, 0, 0.019)];
    for (column, row, most) in bounds {
        let (mass, distance) = compare(column, row);
        assert!((mass - 1.0).abs() < 2e-3, "column {column}, row {row}: the lobe integrates to {mass}, not 1");
        assert!(distance < most, "column {column}, row {row}: off GGX by {distance}, expected less than {most}");
    }
}

#[test]
fn seen_from_straight_above_the_lobe_is_round() {
    for column in 0..SIZE {
        let [a, b, c, d] = texel(column, 0);
        assert!(a == 1.0 && b == 0.0 && c == 0.0 && d > 0.0, "column {column}: {a} {b} {c} {d}");
    }
}

#[test]
fn a_rougher_surface_has_a_wider_lobe() {
    let determinant = |[a, b, c, d]: [f64; 4]| a * d - b * c;
    for row in [0, 16, 32] {
        for column in 4..SIZE {
            let (sharper, wider) = (determinant(texel(column - 1, row)), determinant(texel(column, row)));
            assert!(wider > sharper, "row {row}, column {column}: {wider} after {sharper}");
        }
    }
}
