//! The BRDF of glTF 2.0, appendix B, with the extensions that change it, implemented from the specifications.
//!
//! `l` is the direction towards the light, `v` towards the eye, `n` the normal, all unit and in world space. Every lobe
//! includes its cosine: it is the radiance for an irradiance of 1 on a plane perpendicular to `l`.

use std::f64::consts::PI;

use glam::DVec3;

use super::{film, sheen};

/// The BRDF inputs as the extensions name them: textures and factors multiplied.
#[derive(Clone, Debug)]
pub struct Surface {
    pub n: DVec3,
    /// The mesh's interpolated normal, on the side of the eye.
    pub ng: DVec3,
    pub base_color: DVec3,
    pub metallic: f64,
    /// Perceptual.
    pub roughness: f64,
    pub ior: f64,
    /// KHR_materials_specular: `dielectric_f0` and `dielectric_f90`.
    pub f0: DVec3,
    pub f90: f64,
    pub emissive: DVec3,
    /// KHR_materials_anisotropy: the direction along which the lobe is long, and its strength.
    pub t: Option<DVec3>,
    pub anisotropy: f64,
    pub coat: Coat,
    /// KHR_materials_sheen.
    pub sheen_color: DVec3,
    pub sheen_roughness: f64,
    pub film: film::Film,
    pub transmission: f64,
    pub diffuse_transmission: f64,
    pub diffuse_transmission_color: DVec3,
    /// KHR_materials_volume: transmittance.
    pub attenuation: DVec3,
}

/// KHR_materials_clearcoat.
#[derive(Clone, Debug)]
pub struct Coat {
    pub n: DVec3,
    pub factor: f64,
    pub roughness: f64,
}

/// How G combines the Lambda of both directions (Heitz 2014, eq. 98 and 99).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Masking {
    /// The specification's (B.3.2).
    Separable,
    /// The renderer's default.
    HeightCorrelated,
}

/// Reflected or transmitted light, by lobe.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lobes {
    pub diffuse: DVec3,
    pub specular: DVec3,
    /// From the other side, refracted or scattered.
    pub transmitted: DVec3,
    pub sheen: DVec3,
    pub coat: DVec3,
}

impl Lobes {
    /// Their sum.
    pub fn all(&self) -> DVec3 {
        self.diffuse + self.specular + self.transmitted + self.sheen + self.coat
    }

    /// `self` + `lobes` times `irradiance`.
    pub fn plus(self, lobes: Self, irradiance: DVec3) -> Self {
        Self {
            diffuse: self.diffuse + lobes.diffuse * irradiance,
            specular: self.specular + lobes.specular * irradiance,
            transmitted: self.transmitted + lobes.transmitted * irradiance,
            sheen: self.sheen + lobes.sheen * irradiance,
            coat: self.coat + lobes.coat * irradiance,
        }
    }
}

/// alpha along `t` and `cross(n, t)`. The renderer has the minimum of 0.0025, since a punctual light would have no
/// reflection at 0.
struct Widths {
    t: DVec3,
    b: DVec3,
    along_t: f64,
    along_b: f64,
}

fn alpha(roughness: f64) -> f64 {
    (roughness * roughness).max(0.0025)
}

impl Widths {
    fn round(n: DVec3, roughness: f64) -> Self {
        let (t, b) = n.any_orthonormal_pair();
        Self { t, b, along_t: alpha(roughness), along_b: alpha(roughness) }
    }

    /// KHR_materials_anisotropy: `directionAlphaRoughness`.
    fn of(s: &Surface) -> Self {
        let Some(t) = s.t else { return Self::round(s.n, s.roughness) };
        let t = (t - s.n * s.n.dot(t)).normalize();
        let (narrow, strength2) = (alpha(s.roughness), s.anisotropy * s.anisotropy);
        Self { t, b: s.n.cross(t), along_t: narrow * (1.0 - strength2) + strength2, along_b: narrow }
    }

    /// D(h) from KHR_materials_anisotropy; with equal alphas it is that of B.3.2.
    fn d(&self, n: DVec3, h: DVec3) -> f64 {
        let (t, b) = (h.dot(self.t) / self.along_t, h.dot(self.b) / self.along_b);
        let sum = t * t + b * b + h.dot(n).powi(2);
        1.0 / (PI * self.along_t * self.along_b * sum * sum)
    }

    /// Lambda(w) = (sqrt(1 + alpha^2 tan^2) - 1) / 2, with alpha in the direction of w (Heitz 2014, eq. 72 and section
    /// 5.3).
    fn lambda(&self, n: DVec3, w: DVec3) -> f64 {
        let (t, b) = (w.dot(self.t) * self.along_t, w.dot(self.b) * self.along_b);
        ((1.0 + (t * t + b * b) / w.dot(n).powi(2)).sqrt() - 1.0) / 2.0
    }

    /// `specular_brdf`: G D / (4 |NoL| |NoV|). l and v are on the same side of the surface.
    fn lobe(&self, n: DVec3, l: DVec3, v: DVec3, masking: Masking) -> f64 {
        let (to_l, to_v) = (self.lambda(n, l), self.lambda(n, v));
        let g = match masking {
            Masking::Separable => 1.0 / ((1.0 + to_l) * (1.0 + to_v)),
            Masking::HeightCorrelated => 1.0 / (1.0 + to_l + to_v),
        };
        g * self.d(n, (l + v).normalize()) / (4.0 * (n.dot(l) * n.dot(v)).abs())
    }
}

fn schlick(f0: DVec3, f90: f64, c: f64) -> DVec3 {
    f0 + (DVec3::splat(f90) - f0) * (1.0 - c).powi(5)
}

fn mix(a: DVec3, b: DVec3, part: f64) -> DVec3 {
    a * (1.0 - part) + b * part
}

/// `dielectric_fresnel` and `conductor_fresnel`, with the thin film if there is one (KHR_materials_iridescence).
fn fresnel(s: &Surface, v_dot_h: f64) -> (DVec3, DVec3) {
    let under_film = |f: DVec3, f0: DVec3| match s.film.strength {
        0.0 => f,
        strength => mix(f, s.film.fresnel(f0, v_dot_h), strength),
    };
    let dielectric = under_film(schlick(s.f0, s.f90, v_dot_h), s.f0);
    (dielectric, under_film(schlick(s.base_color, 1.0, v_dot_h), s.base_color))
}

/// `material` of B.2, without sheen and coat. The dielectric's base includes `specular_btdf`
/// (KHR_materials_transmission) and `diffuse_btdf` (KHR_materials_diffuse_transmission).
fn material(s: &Surface, l: DVec3, v: DVec3, masking: Masking) -> Lobes {
    let cosine = s.n.dot(l);
    // A light behind the surface is mirrored to the eye's side; its half vector is H_T.
    let mirrored = l - 2.0 * cosine.min(0.0) * s.n;
    let (dielectric, metal) = fresnel(s, v.dot((mirrored + v).normalize()));
    let enters = (1.0 - s.metallic) * (1.0 - dielectric.max_element()) * cosine.abs();
    let scattered = enters * (1.0 - s.transmission);
    if cosine > 0.0 {
        let lobe = Widths::of(s).lobe(s.n, l, v, masking);
        let diffuse = s.base_color / PI * scattered * (1.0 - s.diffuse_transmission);
        return Lobes { diffuse, specular: mix(dielectric, metal, s.metallic) * lobe * cosine, ..Lobes::default() };
    }
    // "This effect will be modulated by the index of refraction": the renderer's line from index 1, where facets do not
    // deflect light, to 1.5, where the lobe is as wide as the reflected one.
    let width = Widths::round(s.n, s.roughness * (2.0 * s.ior - 2.0).clamp(0.0, 1.0));
    let straight = s.base_color * width.lobe(s.n, mirrored, v, masking) * enters * s.transmission;
    let diffuse = s.diffuse_transmission_color / PI * scattered * s.diffuse_transmission;
    Lobes { transmitted: (straight + diffuse) * s.attenuation, ..Lobes::default() }
}

/// The part of light from `l` that a bump with the normal `n` sees over the mesh with the normal `ng`: Smith's G1 of GGX with
/// alpha^2 = min(tan^2(ng, n) / 8, 1) (Estevez, Lecocq & Stein 2019). No specification of glTF says what happens below the mesh.
fn horizon(ng: DVec3, n: DVec3, l: DVec3) -> f64 {
    let (over_mesh, between) = (ng.dot(l), ng.dot(n));
    if over_mesh * n.dot(l) <= 0.0 {
        return 0.0;
    }
    let alpha2 = ((1.0 / (between * between) - 1.0) / 8.0).clamp(0.0, 1.0);
    let tan2 = 1.0 / (over_mesh * over_mesh) - 1.0;
    2.0 / (1.0 + (1.0 + alpha2 * tan2).sqrt())
}

/// The fraction of light that the coat reflects: `weight * fr` of `fresnel_coat`.
fn coat_weight(coat: &Coat, v: DVec3) -> f64 {
    coat.factor * schlick(DVec3::splat(0.04), 1.0, coat.n.dot(v).abs()).x
}

/// The coated material (KHR_materials_clearcoat over KHR_materials_sheen over the rest).
pub fn shade(s: &Surface, l: DVec3, v: DVec3, masking: Masking) -> Lobes {
    let mut lobes = material(s, l, v, masking);
    let cosine = s.n.dot(l);
    if s.sheen_color != DVec3::ZERO {
        let passes = sheen::passes(s.sheen_color, s.sheen_roughness, cosine.abs(), s.n.dot(v));
        lobes = Lobes::default().plus(lobes, DVec3::splat(passes));
        if cosine > 0.0 {
            let n_dot_h = s.n.dot((l + v).normalize());
            lobes.sheen = s.sheen_color * sheen::lobe(s.sheen_roughness, cosine, s.n.dot(v), n_dot_h) * cosine;
        }
    }
    lobes = Lobes::default().plus(lobes, DVec3::splat(horizon(s.ng, s.n, l)));
    if s.coat.factor > 0.0 {
        let weight = coat_weight(&s.coat, v);
        lobes = Lobes::default().plus(lobes, DVec3::splat(1.0 - weight));
        let (n, coat_cosine) = (s.coat.n, s.coat.n.dot(l));
        if coat_cosine > 0.0 {
            let lobe = Widths::round(n, s.coat.roughness).lobe(n, l, v, masking);
            lobes.coat = DVec3::splat(weight * lobe * coat_cosine * horizon(s.ng, n, l));
        }
    }
    lobes
}

/// `coated_emission`.
pub fn emission(s: &Surface, v: DVec3) -> DVec3 {
    s.emissive * (1.0 - coat_weight(&s.coat, v))
}
