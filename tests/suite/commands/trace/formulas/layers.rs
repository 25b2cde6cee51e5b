//! Layers above the base, the sum of all lobes, and the tone map.

use std::f64::consts::PI;

use super::{Formula, Place, each, function, root_ggx, schlick};

const EVALUATE: &str = "brdf/evaluate.glsl";
const SHEEN: &str = "brdf/layers/sheen.glsl";

/// Estevez & Kulla 2017, eq. 2.
pub const D_CHARLIE: Formula = function(
    SHEEN,
    "float d_charlie(",
    &[Place("", "n_dot_h"), Place("", "alpha")],
    "return (2.0 + 1.0 / alpha) * pow(",
    |a| {
        let sine = (1.0 - a[0][0] * a[0][0]).max(0.0).sqrt();
        vec![(2.0 + 1.0 / a[1][0]) * sine.powf(1.0 / a[1][0]) / (2.0 * PI)]
    },
)
.within(2048.0, 1e-2);

/// The same, eq. 3.
pub const V_CHARLIE: Formula = function(
    SHEEN,
    "float v_charlie(",
    &[Place("", "n_dot_l"), Place("", "n_dot_v"), Place("", "alpha")],
    "return 1.0 / (4.0 * shadowed",
    |a| {
        let t = (1.0 - a[2][0]).powi(2);
        let of = |smooth: f64, rough: f64| t * rough + (1.0 - t) * smooth;
        let [ka, kb, kc, kd, ke] = [
            of(21.5473, 25.3245),
            of(3.82987, 3.32435),
            of(0.19823, 0.16801),
            of(-1.97760, -1.27393),
            of(-4.32054, -4.85967),
        ];
        let log = |x: f64| ka / (1.0 + kb * x.powf(kc)) + kd * x + ke;
        let lambda = |x: f64| if x < 0.5 { log(x).exp() } else { (2.0 * log(0.5) - log(1.0 - x)).exp() };
        let (l, v) = (a[0][0], a[1][0]);
        vec![1.0 / (4.0 * (1.0 + lambda(l) + lambda(v)) * (l * v).max(1e-7))]
    },
)
.within(2048.0, 0.0);

/// KHR_materials_clearcoat: the coat's lobe, from values of the statements before.
pub const CLEARCOAT: Formula = Formula {
    file: EVALUATE,
    header: "float evaluate_clearcoat(",
    inputs: &[
        Place("float n_dot_l = saturate(dot(s.clearcoat_n, l))", "n_dot_l"),
        Place("float n_dot_v = n_dot_v_of(s.clearcoat_n, v)", "n_dot_v"),
        Place("float alpha = alpha_from_roughness(s.clearcoat_roughness)", "alpha"),
        Place("float d = d_specular(saturate(dot(s.clearcoat_n, h))", "d"),
        Place("float weight = s.clearcoat * f_schlick", "weight"),
        Place("float turned = n_dot_l / max(", "turned"),
    ],
    output: Place("brdf.clearcoat = vec3(weight * d", "brdf.clearcoat"),
    cpu: |a| {
        let (l, v, a2) = (a[0][0], a[1][0], a[2][0] * a[2][0]);
        let masking = 0.5 / (v * root_ggx(l, a2) + l * root_ggx(v, a2));
        vec![a[4][0] * a[3][0] * masking * a[5][0]; 3]
    },
    steps: 32.0,
    floor: 0.0,
};

/// The sum of the lobes of a surface without a coat and without transmission.
pub const VALUE: Formula = Formula {
    file: EVALUATE,
    header: "Brdf evaluate_brdf(",
    inputs: &[
        Place("brdf.diffuse = f_diffuse(", "brdf.diffuse"),
        Place("brdf.specular = brdf.k_s * (", "brdf.specular"),
        Place("brdf.multiple *= above;", "brdf.multiple"),
        Place("brdf.sheen *= above;", "brdf.sheen"),
    ],
    output: Place("brdf.value = brdf.diffuse + ", "brdf.value"),
    cpu: |a| (0..3).map(|at| a.iter().map(|lobe| lobe[at]).sum()).collect(),
    steps: 16.0,
    floor: 0.0,
};

/// Belcour & Barla 2017, with the constants of their section 4.
pub const F_FILM: Formula = function(
    "brdf/layers/iridescence.glsl",
    "vec3 f_film(",
    &[Place("", "f0"), Place("", "ior"), Place("", "nm"), Place("", "outside"), Place("", "c")],
    "return saturate(fresnel)",
    |a| {
        let (nm, outside, c) = (a[2][0], a[3][0], a[4][0]);
        let t = (nm / 30.0).clamp(0.0, 1.0);
        let ior = outside + (a[1][0] - outside) * t * t * (3.0 - 2.0 * t);
        let cos2 = (1.0 - (1.0 - c * c) / (ior * ior)).sqrt();
        let cos1 = (1.0 - (1.0 - c * c) / (outside * outside)).sqrt();
        let r12 = schlick(((ior / outside - 1.0) / (ior / outside + 1.0)).powi(2), 1.0, cos1);
        let base: Vec<f64> = each(&a[0], |f0| (1.0 + f0.min(0.9999).sqrt()) / (1.0 - f0.min(0.9999).sqrt()));
        let r23: Vec<f64> = each(&base, |base| schlick(((base - ior) / (base + ior)).powi(2), 1.0, cos2));
        let turned = if ior < outside { 0.0 } else { PI };
        let shift: Vec<f64> = each(&base, |base| turned + if base < ior { PI } else { 0.0 });
        let path = 2.0 * ior * nm * 1e-9 * cos2;
        let sensitivity = |order: f64| -> Vec<f64> {
            let phase = 2.0 * PI * path * order;
            let wave = |height: f64, place: f64, variance: f64, shift: f64| {
                height
                    * (2.0 * PI * variance).sqrt()
                    * (place * phase + shift * order).cos()
                    * (-phase * phase * variance).exp()
            };
            let x = wave(5.4856e-13, 1.6810e6, 4.3278e9, shift[0]) + wave(9.7470e-14, 2.2399e6, 4.5282e9, shift[0]);
            let y = wave(4.4201e-13, 1.7953e6, 9.3046e9, shift[1]);
            let z = wave(5.2481e-13, 2.2084e6, 6.6121e9, shift[2]);
            let rgb = [
                [3.2404542, -1.5371385, -0.4985314],
                [-0.9692660, 1.8760108, 0.0415560],
                [0.0556434, -0.2040259, 1.0572252],
            ];
            rgb.iter().map(|row| (row[0] * x + row[1] * y + row[2] * z) / 1.0685e-7).collect()
        };
        let orders = [sensitivity(1.0), sensitivity(2.0)];
        let of = |at: usize| {
            let r123 = (r12 * r23[at]).clamp(1e-5, 0.9999);
            let rs = (1.0 - r12).powi(2) * r23[at] / (1.0 - r123);
            let order = (rs - (1.0 - r12)) * r123.sqrt();
            (r12 + rs + 2.0 * order * (orders[0][at] + r123.sqrt() * orders[1][at])).clamp(0.0, 1.0)
        };
        (0..3).map(of).collect()
    },
)
.within(2048.0, 1.0);

/// The tone maps, by the number of the curve.
pub const TONEMAP: Formula = function(
    "common/tonemap.glsl",
    "vec3 tonemap(vec3 x, uint curve)",
    &[Place("", "x"), Place("", "curve")],
    "return saturate(x);",
    |a| {
        let x: Vec<f64> = each(&a[0], |x| x.clamp(0.0, 1e6));
        let rows = |m: [[f64; 3]; 3], x: &[f64]| {
            m.iter().map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum()).collect::<Vec<f64>>()
        };
        let hable =
            |x: f64| ((x * (0.15 * x + 0.1 * 0.5) + 0.2 * 0.02) / (x * (0.15 * x + 0.5) + 0.2 * 0.3)) - 0.02 / 0.3;
        let mapped = match a[1][0] as u32 {
            1 => each(&x, |x| x / (1.0 + x)),
            2 => {
                let luminance = 0.2126 * x[0] + 0.7152 * x[1] + 0.0722 * x[2];
                each(&x, |x| x / (1.0 + luminance))
            }
            3 => each(&x, |x| hable(2.0 * x) / hable(11.2)),
            4 => each(&x, |x| x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)),
            5 => {
                let input = [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
                let output =
                    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];
                let fit = |v: f64| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
                rows(output, &each(&rows(input, &x), fit))
            }
            6 => {
                let inset = [
                    [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
                    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
                    [0.0423756549057051, 0.0784336, 0.879142973793104],
                ];
                let outset = [
                    [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
                    [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
                    [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
                ];
                let (least, most) = (-12.47393, 4.026069);
                let bent = each(&rows(inset, &x), |x| {
                    let t = ((x.max(1e-10).log2() - least) / (most - least)).clamp(0.0, 1.0);
                    15.5 * t.powi(6) - 40.14 * t.powi(5) + 31.96 * t.powi(4) - 6.868 * t.powi(3)
                        + 0.4298 * t * t
                        + 0.1191 * t
                        - 0.00232
                });
                each(&rows(outset, &bent), |x| x.max(0.0).powf(2.2))
            }
            7 => {
                let low = x.iter().copied().fold(f64::INFINITY, f64::min);
                let offset = if low < 0.08 { low - 6.25 * low * low } else { 0.04 };
                let x = each(&x, |x| x - offset);
                let peak = x.iter().copied().fold(0.0, f64::max);
                if peak < 0.76 {
                    x
                } else {
                    let newer = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
                    let gray = 1.0 - 1.0 / (0.15 * (peak - newer) + 1.0);
                    each(&x, |x| x * newer / peak * (1.0 - gray) + newer * gray)
                }
            }
            _ => x,
        };
        each(&mapped, |x| x.clamp(0.0, 1.0))
    },
)
.within(2048.0, 0.1);
