//! Functions of the tree as the CPU evaluates them, from the papers that the shaders name. None of this is read from the shaders.

mod layers;

use std::f64::consts::PI;

pub use layers::*;

/// A value that a statement has: a part of the text of its line, and the variable. An empty line is the header of the function, whose arguments
/// have no statement of their own; an empty variable is what the statement returns.
pub struct Place(pub &'static str, pub &'static str);

/// A function of the tree, or statements of one, with its formula.
pub struct Formula {
    pub file: &'static str,
    /// A part of the line of its header.
    pub header: &'static str,
    pub inputs: &'static [Place],
    pub output: Place,
    pub cpu: fn(&[Vec<f64>]) -> Vec<f64>,
    /// The largest error, in steps of floats relative to the result or to `floor`, whichever is larger.
    pub steps: f64,
    pub floor: f64,
}

const NDF: &str = "brdf/ndf.glsl";
const VISIBILITY: &str = "brdf/visibility.glsl";
const FRESNEL: &str = "brdf/fresnel.glsl";
const DIFFUSE: &str = "brdf/diffuse.glsl";

/// A function with these parameters. `returns`: a part of the line of its result.
const fn function(
    file: &'static str,
    header: &'static str,
    inputs: &'static [Place],
    returns: &'static str,
    cpu: fn(&[Vec<f64>]) -> Vec<f64>,
) -> Formula {
    Formula { file, header, inputs, output: Place(returns, ""), cpu, steps: 16.0, floor: 0.0 }
}

impl Formula {
    const fn within(self, steps: f64, floor: f64) -> Self {
        Self { steps, floor, ..self }
    }
}

fn each(a: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    a.iter().copied().map(f).collect()
}

fn root_ggx(c: f64, a2: f64) -> f64 {
    (c * c * (1.0 - a2) + a2).sqrt()
}

/// Walter et al. 2007, eq. 27, as c (1 + 2 Lambda).
fn root_beckmann(c: f64, a2: f64) -> f64 {
    let tan = (1.0 - c * c).max(0.0).sqrt() / c;
    let a = 1.0 / (a2.sqrt() * tan).max(1e-12);
    let lambda = if a < 1.6 { (1.0 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a) } else { 0.0 };
    c * (1.0 + 2.0 * lambda)
}

fn schlick(f0: f64, f90: f64, c: f64) -> f64 {
    f0 + (f90 - f0) * (1.0 - c).powi(5)
}

/// Walter et al. 2007, eq. 22.
fn dielectric(n: f64, c: f64) -> f64 {
    let g = (n * n - 1.0 + c * c).sqrt();
    0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + ((c * (g + c) - 1.0) / (c * (g - c) + 1.0)).powi(2))
}

pub const D_GGX: Formula = function(
    NDF,
    "float d_ggx(float n_dot_h",
    &[Place("", "n_dot_h"), Place("", "sin2_h"), Place("", "alpha")],
    "return a2 / (PI * spread * spread)",
    |a| {
        let a2 = a[2][0] * a[2][0];
        vec![a2 / (PI * (a[0][0] * a[0][0] * a2 + a[1][0]).powi(2))]
    },
);

pub const D_GGX_ANISOTROPIC: Formula = function(
    NDF,
    "float d_ggx_anisotropic(",
    &[Place("", "h_ts"), Place("", "alpha")],
    "return 1.0 / (PI * alpha.x * alpha.y * spread * spread)",
    |a| {
        let (h, alpha) = (&a[0], &a[1]);
        let sum = (h[0] / alpha[0]).powi(2) + (h[1] / alpha[1]).powi(2) + h[2] * h[2];
        vec![1.0 / (PI * alpha[0] * alpha[1] * sum * sum)]
    },
);

pub const D_BECKMANN: Formula = function(
    NDF,
    "float d_beckmann_anisotropic(",
    &[Place("", "h_ts"), Place("", "alpha")],
    "return exp(-dot(slope, slope) / cos2)",
    |a| {
        let (h, alpha) = (&a[0], &a[1]);
        let cos2 = (h[2] * h[2]).max(1e-6);
        let exponent = ((h[0] / alpha[0]).powi(2) + (h[1] / alpha[1]).powi(2)) / cos2;
        vec![(-exponent).exp() / (PI * alpha[0] * alpha[1] * cos2 * cos2)]
    },
)
.within(512.0, 1e-4);

pub const ROOT_GGX: Formula =
    function(VISIBILITY, "float smith_root_ggx(", &[Place("", "c"), Place("", "a2")], "float smith_root_ggx(", |a| {
        vec![root_ggx(a[0][0], a[1][0])]
    });

const MASKING: &[Place] = &[Place("", "n_dot_l"), Place("", "n_dot_v"), Place("", "a2_l"), Place("", "a2_v")];

pub const V_HEIGHT_CORRELATED: Formula =
    function(VISIBILITY, "float v_height_correlated(", MASKING, "return 0.5 / (n_dot_v * smith_root", |a| {
        let (l, v) = (a[0][0], a[1][0]);
        vec![0.5 / (v * root_ggx(l, a[2][0]) + l * root_ggx(v, a[3][0]))]
    });

/// With Beckmann's root: of the variant that has both.
pub const V_SEPARABLE: Formula =
    function(VISIBILITY, "float v_separable(", MASKING, "return 1.0 / ((n_dot_l + smith_root", |a| {
        let (l, v) = (a[0][0], a[1][0]);
        vec![1.0 / ((l + root_beckmann(l, a[2][0])) * (v + root_beckmann(v, a[3][0])))]
    })
    .within(256.0, 0.0);

pub const V_SCHLICK: Formula =
    function(VISIBILITY, "float v_schlick(", MASKING, "return 0.25 / ((n_dot_l * (1.0 - k_l)", |a| {
        let k = [a[2][0].sqrt() / 2.0, a[3][0].sqrt() / 2.0];
        let (l, v) = (a[0][0], a[1][0]);
        vec![0.25 / ((l * (1.0 - k[0]) + k[0]) * (v * (1.0 - k[1]) + k[1]))]
    });

pub const F_SCHLICK: Formula = function(
    FRESNEL,
    "vec3 f_schlick(",
    &[Place("", "f0"), Place("", "f90"), Place("", "c")],
    "vec3 f_schlick(",
    |a| (0..3).map(|at| schlick(a[0][at], a[1][at], a[2][0])).collect(),
)
.within(32.0, 1e-3);

pub const F_DIELECTRIC: Formula = function(
    FRESNEL,
    "float f_dielectric_exact(",
    &[Place("", "ior"), Place("", "c")],
    "return 0.5 * root_s * root_s",
    |a| vec![dielectric(a[0][0], a[1][0])],
)
.within(128.0, 1e-2);

/// Born & Wolf 1999, section 14.4, by complex numbers: the two amplitudes of a boundary with the index n + i k.
pub const F_CONDUCTOR: Formula = function(
    FRESNEL,
    "vec3 f_conductor(",
    &[Place("", "n"), Place("", "k"), Place("", "c")],
    "return saturate(0.5 * f_s * (1.0 + ratio))",
    |a| {
        type Complex = (f64, f64);
        let mul = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let size = |a: Complex| a.0 * a.0 + a.1 * a.1;
        let root = |a: Complex| {
            let length = size(a).sqrt();
            (((length + a.0) / 2.0).sqrt(), ((length - a.0) / 2.0).max(0.0).sqrt())
        };
        let c = a[2][0];
        let of = |at: usize| {
            let index2 = mul((a[0][at], a[1][at]), (a[0][at], a[1][at]));
            let inner = root((index2.0 - 1.0 + c * c, index2.1));
            let s = size((c - inner.0, -inner.1)) / size((c + inner.0, inner.1));
            let outer = (index2.0 * c, index2.1 * c);
            let p = size((outer.0 - inner.0, outer.1 - inner.1)) / size((outer.0 + inner.0, outer.1 + inner.1));
            (0.5 * (s + p)).clamp(0.0, 1.0)
        };
        (0..3).map(of).collect()
    },
)
.within(256.0, 0.1);

/// Kutz, Hasan & Edmondson 2021.
pub const F_82: Formula = function(
    FRESNEL,
    "vec3 f_82(",
    &[Place("", "f0"), Place("", "f82"), Place("", "c")],
    "return saturate(f_schlick(f0, vec3(1.0), c) - beta",
    |a| {
        let c = a[2][0];
        let of = |at: usize| {
            let (f0, c82) = (a[0][at], 1.0 / 7.0);
            let beta = (schlick(f0, 1.0, c82) - a[1][at]) / (c82 * (1.0 - c82).powi(6));
            (schlick(f0, 1.0, c) - beta * c * (1.0 - c).powi(6)).clamp(0.0, 1.0)
        };
        (0..3).map(of).collect()
    },
)
.within(64.0, 0.1);

pub const F_LAMBERT: Formula =
    function(DIFFUSE, "vec3 f_lambert(", &[Place("", "albedo")], "vec3 f_lambert(", |a| each(&a[0], |x| x / PI));

const BURLEY: &[Place] = &[Place("", "n_dot_l"), Place("", "n_dot_v"), Place("", "v_dot_h"), Place("", "roughness")];

pub const F_BURLEY: Formula =
    function(DIFFUSE, "float f_burley(", BURLEY, "return (1.0 + rise * pow5(1.0 - n_dot_l))", |a| {
        let fd90 = 0.5 + 2.0 * a[3][0] * a[2][0] * a[2][0];
        vec![schlick(1.0, fd90, a[0][0]) * schlick(1.0, fd90, a[1][0]) / PI]
    });

/// Lagarde & de Rousiers 2014, listing 1.
pub const F_RENORMALIZED_BURLEY: Formula =
    function(DIFFUSE, "float f_renormalized_burley(", BURLEY, "return scale * (1.0 + rise", |a| {
        let r = a[3][0];
        let fd90 = 0.5 * r + 2.0 * a[2][0] * a[2][0] * r;
        let scale = (1.0 - r) + r / 1.51;
        vec![schlick(1.0, fd90, a[0][0]) * schlick(1.0, fd90, a[1][0]) * scale / PI]
    })
    .within(32.0, 0.0);

/// EON: Portsmouth, Kutz & Hill 2025.
pub const F_OREN_NAYAR: Formula = function(
    DIFFUSE,
    "vec3 f_oren_nayar(",
    &[Place("", "albedo"), Place("", "n_dot_l"), Place("", "n_dot_v"), Place("", "l_dot_v"), Place("", "r")],
    "return (single + multi) / PI",
    |a| {
        let (l, v, r) = (a[1][0], a[2][0], a[4][0]);
        let s = a[3][0] - l * v;
        let af = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
        let g = |c: f64| {
            let x = 1.0 - c;
            0.0571085289 * x + 0.491881867 * x.powi(2) - 0.332181442 * x.powi(3) + 0.0714429953 * x.powi(4)
        };
        let albedo = |c: f64| af * (1.0 + r * g(c));
        let mean = af * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
        let s_over_t = if s > 0.0 { s / l.max(v) } else { s };
        each(&a[0], |rho| {
            let single = rho / PI * af * (1.0 + r * s_over_t);
            let bounced = rho * rho * mean / (1.0 - rho * (1.0 - mean));
            let lost = (1.0 - albedo(l)).max(0.0) * (1.0 - albedo(v)).max(0.0) / (1.0 - mean).max(1e-6);
            single + bounced / PI * lost
        })
    },
)
.within(64.0, 1e-2);

/// Chan 2018.
pub const F_CALL_OF_DUTY: Formula = function(
    DIFFUSE,
    "float f_call_of_duty(",
    &[Place("", "n_dot_l"), Place("", "n_dot_v"), Place("", "n_dot_h"), Place("", "v_dot_h"), Place("", "alpha")],
    "return (lobe + bump) / PI",
    |a| {
        let (l, v, h, vh, alpha) = (a[0][0], a[1][0], a[2][0], a[3][0], a[4][0]);
        let g = ((2.0 / (alpha * alpha) - 1.0).log2() / 18.0).clamp(0.0, 1.0);
        let rough = vh + (1.0 - vh).powi(5);
        let even = (1.0 - 0.75 * (1.0 - l).powi(5)) * (1.0 - 0.75 * (1.0 - v).powi(5));
        let part = (2.2 * g - 0.5).clamp(0.0, 1.0);
        let bump = ((34.5 * g - 59.0) * g + 24.5) * vh * (-(73.2 * g - 21.2).max(8.9) * h.sqrt()).exp2();
        vec![(rough + (even - rough) * part + bump) / PI]
    },
)
.within(1024.0, 0.1);

pub const F_KULLA_CONTY: Formula = function(
    "brdf/energy/multiscatter.glsl",
    "float f_kulla_conty(",
    &[Place("", "lost_l"), Place("", "lost_v"), Place("", "lost_mean")],
    "float f_kulla_conty(",
    |a| vec![a[0][0] * a[1][0] / (PI * a[2][0].max(1e-5))],
);
