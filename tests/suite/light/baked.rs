//! The baked maps of the built-in environments, against sums over every texel.

use crate::support::{Session, assert_validated, glb, load, ready, settings};
use glam::{DVec2, DVec3, Vec3};
use specula::interface::{MIRROR_SIDE, SPECULAR_LEVELS, SPECULAR_SIDE};
use specula::scene::environment::direction_from_uv;
use specula::scene::{Environment, EnvironmentFile};

/// The level of roughness 1. Each level is 2^(1/4) times as rough as the one before (ibl/maps/levels.glsl).
const LAST: f64 = SPECULAR_LEVELS as f64;
/// Replaces a lookup by one at the center of the nearest texel, like [`texel`].
const AT_TEXEL: &str = "vec2 place = floor(place_in_tile(p, tile)) + 0.5;";

/// The center of the texel around `n` in the octahedral map of a level; `None` where rounding may select another texel.
fn texel(n: DVec3, level: f64) -> Option<DVec3> {
    let (widest, row) = (f64::from(SPECULAR_SIDE), (0.5 * level + 0.5).floor());
    let scale = 0.75_f64.powf(row - 1.0);
    let side = widest * scale;
    let left = if level == 2.0 * row { widest } else { 0.0 };
    let corner = DVec2::new(left, f64::from(MIRROR_SIDE) + 4.0 * widest * (1.0 - scale));
    let d = n / n.abs().element_sum();
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    let folded = DVec2::new((1.0 - d.z.abs()) * sign(d.x), (1.0 - d.x.abs()) * sign(d.z));
    let p = if d.y >= 0.0 { DVec2::new(d.x, d.z) } else { folded };
    let place = corner + 0.5 * side + p * (0.5 * side - 1.0);
    let p = (place.floor() + 0.5 - corner - 0.5 * side) / (0.5 * side - 1.0);
    let y = 1.0 - p.x.abs() - p.y.abs();
    let at = DVec3::new(p.x - sign(p.x) * (-y).max(0.0), y, p.y - sign(p.y) * (-y).max(0.0)).normalize();
    // The texels of the border are tested by the lookups between texels.
    let is_sure = place.fract().cmpge(DVec2::splat(0.02)).all() && place.fract().cmple(DVec2::splat(0.98)).all();
    (is_sure && p.abs().max_element() < 1.0).then_some(at)
}

/// A texel of a map: unit direction, radiance times solid angle, solid angle.
type Texel = (DVec3, DVec3, f64);

/// Every texel of a map.
struct Sky {
    texels: Vec<Texel>,
    /// Those of a source that the baked levels leave out.
    sun: Vec<Texel>,
}

impl Sky {
    fn new(map: &Environment) -> Self {
        let (width, height) = (map.width as usize, map.height as usize);
        let cosine = |edge: usize| (edge as f64 / height as f64 * std::f64::consts::PI).cos();
        let texel = |(i, pixel): (usize, &[f32; 4])| {
            let (x, y) = (i % width, i / width);
            let at = direction_from_uv((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
            let solid_angle = (cosine(y) - cosine(y + 1)) * std::f64::consts::TAU / width as f64;
            let radiance = Vec3::new(pixel[0], pixel[1], pixel[2]).as_dvec3();
            (at.as_dvec3(), radiance * solid_angle, solid_angle)
        };
        let texels: Vec<Texel> = map.pixels.iter().enumerate().map(texel).collect();
        let radiance = |(_, light, area): &Texel| light.max_element() / area;
        let brightest = texels.iter().max_by(|a, b| radiance(a).total_cmp(&radiance(b))).unwrap().0;
        let average =
            texels.iter().map(|(_, light, _)| light.max_element()).sum::<f64>() / (4.0 * std::f64::consts::PI);
        let is_sun = |texel: &&Texel| texel.0.dot(brightest) > 0.02_f64.cos() && radiance(texel) > 100.0 * average;
        Self { sun: texels.iter().filter(is_sun).copied().collect(), texels }
    }

    /// Mean radiance, weighted by a function of the cosine to `n`.
    fn mean(&self, n: DVec3, weight: impl Fn(f64) -> f64) -> DVec3 {
        let (sum, weights) = sums(&self.texels, n, &weight);
        sum / weights
    }

    /// The same where a lookup reads the texel at `texel`, but adds the sun for `n`.
    fn mean_at_texel(&self, n: DVec3, texel: DVec3, weight: impl Fn(f64) -> f64) -> DVec3 {
        let (sum, weights) = sums(&self.texels, texel, &weight);
        (sum - sums(&self.sun, texel, &weight).0 + sums(&self.sun, n, &weight).0) / weights
    }
}

/// The weighted sums of light and of solid angle.
fn sums(texels: &[Texel], n: DVec3, weight: impl Fn(f64) -> f64) -> (DVec3, f64) {
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (at, radiance, solid_angle) in texels {
        let cosine = at.dot(n);
        if cosine > 0.0 {
            let weight = weight(cosine);
            sum += *radiance * weight;
            weights += weight * solid_angle;
        }
    }
    (sum, weights)
}

/// D V NoL of GGX with n = v, without constant factors: NoH^2 = (1 + NoL) / 2, and V = 1 / 2 (root + NoL) (Heitz 2014, eq. 99).
fn ggx(alpha: f64) -> impl Fn(f64) -> f64 {
    let a2 = alpha * alpha;
    move |n_dot_l| {
        let q = 1.0 - (1.0 - a2) * (1.0 + n_dot_l) / 2.0;
        let root = (n_dot_l * n_dot_l * (1.0 - a2) + a2).sqrt();
        n_dot_l / (q * q * (root + n_dot_l))
    }
}

/// The same for a smooth Beckmann, which masks nothing near n: D alone (Walter et al. 2007, eq. 25), cos^2 = (1 + NoL) / 2.
fn beckmann(alpha: f64) -> impl Fn(f64) -> f64 {
    move |n_dot_l| {
        let cos2 = (1.0 + n_dot_l) / 2.0;
        (-(1.0 - cos2) / (cos2 * alpha * alpha)).exp() / (cos2 * cos2)
    }
}

/// The values of a mode on the sphere, at each pixel of a step, with their normals.
fn shown(session: &mut Session, slug: &str, step: usize) -> Vec<(DVec3, DVec3)> {
    let mut out = Vec::new();
    for eye in ["[3, 1, 2]", "[-3, -1, -2]"] {
        session.set(&format!("camera.eye={eye}"));
        session.set("camera.target=[0, 0, 0]");
        let normals = session.mode("shading-normal");
        let values = session.mode(slug);
        let pixels = values.raw.iter().zip(&normals.raw).filter(|(value, _)| value[3] == 1.0);
        let vector = |v: &[f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        out.extend(pixels.step_by(step).map(|(value, normal)| (vector(normal).normalize(), vector(value))));
    }
    assert!(out.len() > 20, "{} pixels", out.len());
    out
}

/// Root mean square of the differences, relative to the mean.
fn rmse(pairs: &[(DVec3, DVec3)]) -> f64 {
    let square: f64 = pairs.iter().map(|(a, b)| (*a - *b).length_squared() / 3.0).sum();
    let mean: f64 = pairs.iter().map(|(_, truth)| truth.element_sum() / 3.0).sum();
    (square / pairs.len() as f64).sqrt() / (mean / pairs.len() as f64)
}

fn baked_like_brute_force(environment: &str) {
    let name = format!("environment.name={environment}");
    let chosen = settings(&[&name, "lights.source=none", "view.msaa=1", "view.background=none"]);
    let mut session = Session::new(load(&glb::model(&glb::sphere(24, 48), &glb::gray())), chosen);
    ready(&session.edit("debug/light.glsl", "specular_radiance(s, v)", "prefiltered_radiance(s.n, s.roughness)"));
    let sky = Sky::new(&EnvironmentFile::open(environment).unwrap().decode().unwrap());
    session.set("material.enabled=true");
    // Three kinds of lookup: between levels, on a level, where the sampler's interpolation contributes, and at texel
    // centers, where only the bake does.
    let between: &[f64] = &[4.5, 6.5, 8.5, 9.5, 10.5, 12.5, 15.5];
    let whole: &[f64] = &[4.0, 5.0, 7.0, 8.0, 10.0, 11.0, 13.0, 16.0];
    let edits = [(between, 0.03), (whole, 0.03), (whole, 0.017)];
    for (pass, (levels, allowed)) in edits.into_iter().enumerate() {
        let at_texels = pass == 2;
        if at_texels {
            let place = "vec2 place = place_in_tile(p, tile);";
            ready(&session.edit("lighting/environment.glsl", place, AT_TEXEL));
        }
        for level in levels {
            let roughness = (0.25 * (level - LAST)).exp2();
            session.set(&format!("material.roughness={roughness}"));
            let found = shown(&mut session, "prefiltered", if at_texels { 21 } else { 63 });
            let alpha = roughness * roughness;
            let place = |n: DVec3| if at_texels { texel(n, *level) } else { Some(n) };
            let known = found.iter().filter_map(|(n, value)| Some((*value, *n, place(*n)?)));
            let pairs: Vec<_> = known.map(|(value, n, at)| (value, sky.mean_at_texel(n, at, ggx(alpha)))).collect();
            assert!(pairs.len() > 20, "{} texels", pairs.len());
            let error = rmse(&pairs);
            let what = format!("{environment}, roughness {roughness}, at texels: {at_texels}");
            println!("{what}: {:.3} %", error * 100.0);
            assert!(error < allowed, "{what}: {error}");
        }
    }
    let found = shown(&mut session, "irradiance", 21);
    let truth = |n: DVec3| sky.mean(n, |cosine| cosine) * std::f64::consts::PI;
    let pairs: Vec<_> = found.iter().map(|(n, value)| (*value, truth(*n))).collect();
    let error = rmse(&pairs);
    println!("{environment}, irradiance: {:.3} %", error * 100.0);
    assert!(error < 0.005, "{environment}, irradiance: {error}");
    assert_validated();
}

/// A disk whose normals point to all sides of `center`, with angles that grow by the same factor from ring to ring.
fn disk_of_normals(center: Vec3, rings: u32, sectors: u32) -> glb::Mesh {
    let (x, y) = center.any_orthonormal_pair();
    let mut mesh = glb::Mesh::default();
    for ring in 0..=rings {
        let radius = ring as f32 / rings as f32;
        let angle = SMALLEST_ANGLE * (LARGEST_ANGLE / SMALLEST_ANGLE).powf(radius);
        for sector in 0..=sectors {
            let azimuth = std::f32::consts::TAU * sector as f32 / sectors as f32;
            mesh.positions.push([radius * azimuth.cos(), radius * azimuth.sin(), 0.0]);
            let side = x * azimuth.cos() + y * azimuth.sin();
            mesh.normals.push((center * angle.cos() + side * angle.sin()).to_array());
        }
    }
    let index = |ring: u32, sector: u32| ring * (sectors + 1) + sector;
    for (ring, sector) in (0..rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector))) {
        let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| index(ring + i, sector + j));
        mesh.indices.extend([a, b, c, a, c, d]);
    }
    mesh
}

/// Radians.
const SMALLEST_ANGLE: f32 = 0.001;
const LARGEST_ANGLE: f32 = 1.0;

/// The sky with every texel near the sun split into `parts` x `parts`, interpolated as the bake's sampler does.
fn with_fine_sun(map: &Environment, sun: Vec3, parts: usize) -> Sky {
    let mut sky = Sky::new(map);
    let near = |at: &DVec3| at.dot(sun.as_dvec3()) > 0.05_f64.cos();
    sky.texels.retain(|(at, ..)| !near(at));
    let (width, height) = (map.width as usize, map.height as usize);
    let pixel = |x: usize, y: usize| {
        let [r, g, b, _] = map.pixels[y.min(height - 1) * width + x % width];
        Vec3::new(r, g, b).as_dvec3()
    };
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let center = direction_from_uv((x as f32 + 0.5) / width as f32, (y as f32 + 0.5) / height as f32);
        if !near(&center.as_dvec3()) {
            continue;
        }
        for part in 0..parts * parts {
            let [s, t] = [part % parts, part / parts].map(|i| (i as f64 + 0.5) / parts as f64);
            let (u, v) = ((x as f64 + s) / width as f64, (y as f64 + t) / height as f64);
            // Between the centers of four texels.
            let (left, above) = (x as f64 + s - 0.5, y as f64 + t - 0.5);
            let (i, j) = (left.floor() as usize, above.floor() as usize);
            let (p, q) = (left.fract(), above.fract());
            let upper = pixel(i, j).lerp(pixel(i + 1, j), p);
            let radiance = upper.lerp(pixel(i, j + 1).lerp(pixel(i + 1, j + 1), p), q);
            let area = std::f64::consts::TAU * std::f64::consts::PI / (width * height * parts * parts) as f64;
            let solid_angle = area * (v * std::f64::consts::PI).sin();
            sky.texels.push((direction_from_uv(u as f32, v as f32).as_dvec3(), radiance * solid_angle, solid_angle));
        }
    }
    sky
}

/// Around the sun, every highlight has the shape of the lobe, however smooth the surface is.
#[test]
fn the_suns_highlight() {
    let map = EnvironmentFile::open("sky").unwrap().decode().unwrap();
    let brightest = (0..).zip(&map.pixels).max_by(|a, b| a.1[0].total_cmp(&b.1[0])).unwrap().0;
    let (x, y) = (brightest % map.width, brightest / map.width);
    let sun = direction_from_uv((x as f32 + 0.5) / map.width as f32, (y as f32 + 0.5) / map.height as f32);
    let sky = with_fine_sun(&map, sun, 6);
    let chosen = settings(&["environment.name=sky", "lights.source=none", "view.msaa=1", "view.background=none"]);
    let mut session = Session::new(load(&glb::model(&disk_of_normals(sun, 64, 64), &glb::gray())), chosen);
    ready(&session.edit("debug/light.glsl", "specular_radiance(s, v)", "prefiltered_radiance(s.n, s.roughness)"));
    // Half floats hold small differences with more digits.
    let difference = format!("value = s.n - vec3({}, {}, {});", sun.x, sun.y, sun.z);
    ready(&session.edit("debug/geometry.glsl", "value = s.n;", &difference));
    for assignment in ["camera.eye=[0, 0, 3]", "camera.target=[0, 0, 0]", "camera.fovy=35", "material.enabled=true"] {
        session.set(assignment);
    }
    let normals = session.mode("shading-normal");
    let ggx_levels = [1.0, 1.5, 2.5, 3.0, 4.5, 6.0, 7.5, 9.5, 12.0, 14.5, 16.0].map(|level| (level, "GGX"));
    let beckmann_levels = [1.0, 1.5, 2.5, 3.0, 4.5].map(|level| (level, "Beckmann"));
    for (level, ndf) in ggx_levels.into_iter().chain(beckmann_levels) {
        session.set(&format!("NDF={ndf}"));
        let roughness = (0.25 * (level - LAST)).exp2();
        let alpha: f64 = roughness * roughness;
        session.set(&format!("material.roughness={roughness}"));
        let found = session.mode("prefiltered");
        let vector = |v: &[f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let pixels = found.raw.iter().zip(&normals.raw).filter(|(value, _)| value[3] == 1.0);
        // The angle of h is half of this one. Beckmann's tail is so steep that the disk's shape shows in it.
        let reach = if ndf == "GGX" { 4.0 } else { 2.0 };
        let around = pixels.map(|(value, n)| (vector(value), vector(n))).filter(|(_, n)| n.length() < reach * alpha);
        let around: Vec<_> = around.collect();
        // Wide lobes cover many pixels, whose errors are alike.
        let step = if around.len() > 1400 { 20 } else { 5 };
        let errors: Vec<f64> = around
            .into_iter()
            .step_by(step)
            .map(|(value, n)| {
                let n = (sun.as_dvec3() + n).normalize();
                let truth = if ndf == "GGX" { sky.mean(n, ggx(alpha)) } else { sky.mean(n, beckmann(alpha)) };
                (value.element_sum() / truth.element_sum() - 1.0).powi(2)
            })
            .collect();
        let error = (errors.iter().sum::<f64>() / errors.len() as f64).sqrt();
        println!("{ndf}, level {level}, {} pixels: {:.3} %", errors.len(), error * 100.0);
        // The sun's disk widens the lobe, which is exact to the second order of their ratio. Up to level 2 the disk, as the map
        // shows it, is half as wide as the lobe or more.
        let allowed = if level < 2.5 { 0.08 } else { 0.031 };
        assert!(errors.len() > 60 && error < allowed, "{ndf}, level {level}: {error} of {} pixels", errors.len());
    }
    assert_validated();
}

#[test]
fn the_studio() {
    baked_like_brute_force("studio");
}

#[test]
fn sun_and_sky() {
    baked_like_brute_force("sky");
}
