//! KHR_materials_sheen: the lobe of Estevez & Kulla 2017, and how it attenuates the layers below.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

/// `alphaG`, with the renderer's minimum of 0.005.
fn alpha(roughness: f64) -> f64 {
    (roughness * roughness).max(0.005)
}

/// l(x, alphaG) of the specification.
fn fit(x: f64, alpha: f64) -> f64 {
    let part = (1.0 - alpha).powi(2);
    let [a, b, c, d, e] =
        [(21.5473, 25.3245), (3.82987, 3.32435), (0.19823, 0.16801), (-1.97760, -1.27393), (-4.32054, -4.85967)]
            .map(|(rough, smooth)| rough * (1.0 - part) + smooth * part);
    a / (1.0 + b * x.powf(c)) + d * x + e
}

fn lambda(cosine: f64, alpha: f64) -> f64 {
    let log = if cosine < 0.5 { fit(cosine, alpha) } else { 2.0 * fit(0.5, alpha) - fit(1.0 - cosine, alpha) };
    log.exp()
}

fn distribution(n_dot_h: f64, alpha: f64) -> f64 {
    (2.0 + 1.0 / alpha) * (1.0 - n_dot_h * n_dot_h).max(0.0).powf(0.5 / alpha) / TAU
}

/// sheenDistribution sheenVisibility, 1/sr.
pub fn lobe(roughness: f64, n_dot_l: f64, n_dot_v: f64, n_dot_h: f64) -> f64 {
    let alpha = alpha(roughness);
    let hidden = 1.0 + lambda(n_dot_l, alpha) + lambda(n_dot_v, alpha);
    distribution(n_dot_h, alpha) / (hidden * 4.0 * n_dot_l * n_dot_v)
}

/// E: the albedo of a lobe of color 1 in a direction. Midpoint rule over the azimuth and over u, where the cosine is
/// 3 u^2 - 2 u^3, so that samples are dense where Lambda is steep. The error is below 2e-4 for cosines of 0.02 or more.
pub fn albedo(roughness: f64, cosine: f64) -> f64 {
    const STEPS: usize = 48;
    let alpha = alpha(roughness);
    let sine = (1.0 - cosine * cosine).sqrt();
    let middles = || (0..STEPS).map(|i| (i as f64 + 0.5) / STEPS as f64);
    let hidden = 1.0 + lambda(cosine, alpha);
    let ring = |u: f64| {
        let n_dot_l = u * u * (3.0 - 2.0 * u);
        let across = (1.0 - n_dot_l * n_dot_l).sqrt() * sine;
        let facets: f64 = middles()
            .map(|half_turn| {
                let l_dot_v = across * (PI * half_turn).cos() + n_dot_l * cosine;
                distribution((n_dot_l + cosine) / (2.0 + 2.0 * l_dot_v).sqrt(), alpha)
            })
            .sum();
        6.0 * u * (1.0 - u) * facets / (4.0 * cosine * (hidden + lambda(n_dot_l, alpha)))
    };
    TAU * middles().map(ring).sum::<f64>() / (STEPS * STEPS) as f64
}

/// `sheenAlbedoScaling`. The fit of Lambda lets E exceed 1 at grazing angles; the result is then 0.
pub fn passes(color: DVec3, roughness: f64, n_dot_l: f64, n_dot_v: f64) -> f64 {
    let stopped = albedo(roughness, n_dot_l).max(albedo(roughness, n_dot_v));
    (1.0 - color.max_element() * stopped).max(0.0)
}
