//! `specula brdf`: the BRDF of the shader tree, checked against physics and against its own claims.

use std::path::Path;

use crate::support::process::{Finished, run};
use crate::support::{Tree, assert_validated, compiler, gpu, settings};
use serde_json::Value;
use specula::frame::stages::all_stages;
use specula::measure::{BrdfMeter, Claim, Grid, Surface, choices, unclaimed};
use specula::settings::{Settings, ShaderValue};
use specula::shader::{Change, Constant, Library, Source, Update};

/// Largest albedo that counts as energy conserving; the tolerance covers the errors of tables and estimate.
const MOST: f64 = 1.003;
/// The same for the renormalized Burley lobe from 85 to 89.9 degrees, where its fit gains energy (brdf/models.glsl states it).
const MOST_OF_BURLEY: f64 = 1.029;

/// Runs `specula brdf` with these arguments and validation layers.
fn brdf(directory: &Path, args: &[&str]) -> Finished {
    run(directory, &[&["brdf"], args, &["--validate"]].concat())
}

fn json(args: &[&str]) -> Value {
    let directory = tempfile::tempdir().unwrap();
    brdf(directory.path(), &[args, &["--json"]].concat()).expect(0, &[]).json()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect()
}

#[test]
fn a_white_metal_returns_all_light() {
    let furnace = json(&["furnace"]);
    let rows = furnace["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 20 * 18);
    for row in rows {
        let albedo = numbers(&row["albedo"]);
        assert!(albedo.len() == 3 && albedo.iter().all(|a| (a - 1.0).abs() < 0.005), "{row}");
    }
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    assert_eq!((&first["roughness"], &first["cos_theta"]), (&Value::from(0.05), &Value::from(1.0)));
    assert_eq!(last["roughness"], 1.0);
    assert!((last["cos_theta"].as_f64().unwrap() - 85_f64.to_radians().cos()).abs() < 1e-6);
    let all: Vec<f64> = rows.iter().flat_map(|row| numbers(&row["albedo"])).collect();
    assert_eq!(furnace["max"].as_f64().unwrap(), all.iter().copied().fold(f64::MIN, f64::max));
    assert_eq!(furnace["min"].as_f64().unwrap(), all.iter().copied().fold(f64::MAX, f64::min));
    assert_eq!(furnace["claims_conservation"], true);
}

#[test]
fn a_white_metal_loses_nothing_at_grazing_angles() {
    let mut library = Library::new(Source::embedded(), compiler().clone(), &all_stages());
    let Update::Ready(shaders, _) = library.update(&Change::All) else { panic!("the embedded tree compiles") };
    for distribution in ["GGX", "Beckmann"] {
        for masking in ["HeightCorrelated", "Separable", "Schlick"] {
            let chosen = [format!("NDF={distribution}"), format!("MASKING_SHADOWING={masking}")];
            let settings = settings(&chosen.each_ref().map(String::as_str));
            let bench = BrdfMeter::new(gpu(), &shaders, &settings).unwrap();
            // Smoother lobes need more samples at these angles than a loop has rounds.
            let grid = Grid { rows: 9, roughness: (0.2, 1.0), columns: 6, theta: (85.0, 89.9), samples: 16384 };
            let albedo = bench.furnace(Surface { base_color: [1.0; 3], metallic: 1.0 }, grid).unwrap();
            for (rgb, cell) in albedo.iter().zip(0..) {
                let place = (grid.roughness_of(cell / grid.columns), grid.theta_of(cell % grid.columns));
                assert!(rgb.iter().all(|a| (a - 1.0).abs() < 0.003), "{chosen:?}, {place:?}: {rgb:?}");
            }
        }
    }
    assert_validated();
}

#[test]
fn the_split_sum_is_reported_by_roughness() {
    let near = |metallic: &str| {
        let found = json(&["split-sum", "--env", "furnace", "--frames", "16", "--metallic", metallic]);
        let rows = found["rows"].as_array().unwrap().clone();
        assert_eq!(rows.len(), 10);
        rows.iter().map(|row| row["bias"].as_f64().unwrap().abs()).fold(0.0, f64::max)
    };
    // In a furnace the split sum is exact.
    assert!(near("1") < 0.01, "{}", near("1"));
    // Under a studio it is not, but the error is small.
    let studio = json(&["split-sum", "--frames", "16"]);
    let rms = |row: &Value| row["rms"].as_f64().unwrap();
    let rows = studio["rows"].as_array().unwrap();
    assert!(rows.iter().all(|row| rms(row) > 0.001 && rms(row) < 0.3), "{studio}");
}

#[test]
fn without_multiple_scattering_a_rough_metal_keeps_light() {
    let furnace = json(&["furnace", "--set", "MULTI_SCATTER=None"]);
    let rows = furnace["rows"].as_array().unwrap();
    let of = |roughness: f64| rows.iter().filter(move |row| row["roughness"] == roughness);
    // Walter et al. 2007, figure 11, and Heitz 2014, section 5.2: it keeps about half at roughness 1.
    let rough = of(1.0).flat_map(|row| numbers(&row["albedo"])).fold(f64::MAX, f64::min);
    assert!((0.3..0.6).contains(&rough), "{rough}");
    assert!(of(0.05).all(|row| numbers(&row["albedo"])[0] > 0.99));
}

#[test]
fn a_dark_metal_takes_on_its_color() {
    let furnace = json(&["furnace", "--base-color", "1,0.5,0"]);
    let smooth_from_above = numbers(&furnace["rows"][0]["albedo"]);
    let expected = [1.0, 0.5, 0.0];
    assert!(smooth_from_above.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.005), "{smooth_from_above:?}");
}

#[test]
fn a_dielectric_that_does_not_claim_to_conserve_says_why() {
    let directory = tempfile::tempdir().unwrap();
    let more = ["furnace", "--metallic", "0", "--set", "DIFFUSE=Burley", "--set", "DIFFUSE_COUPLING=Albedo"];
    let said = brdf(directory.path(), &more);
    said.expect(0, &[]);
    assert!(said.stdout.contains("does not claim to conserve energy (DIFFUSE=Burley)"), "{said:#?}");
}

/// Applies one edit to brdf/ndf.glsl and runs furnace and normalization.
fn edited(from: &str, to: &str) -> [Finished; 2] {
    let tree = Tree::new();
    tree.write("brdf/ndf.glsl", &tree.edited("brdf/ndf.glsl", from, to));
    let root = tree.root();
    let shaders = root.to_str().unwrap();
    ["furnace", "normalization"].map(|what| brdf(&root, &[what, "--shaders", shaders]))
}

#[test]
fn a_distribution_without_its_pi_fails_both() {
    let [furnace, normalization] = edited("a2 / (PI * spread * spread)", "a2 / (spread * spread)");
    furnace.expect(1, &["furnace", "claims to conserve energy"]);
    normalization.expect(1, &["normalization", "3.14"]);
}

#[test]
fn a_distribution_of_another_width_fails_the_furnace() {
    // The edited D is still normalized, but it no longer matches G.
    let [furnace, normalization] = edited("float a2 = alpha * alpha;", "float a2 = alpha;");
    furnace.expect(1, &["furnace", "claims to conserve energy"]);
    normalization.expect(0, &[]);
}

#[test]
fn every_distribution_is_normalized() {
    for distribution in ["GGX", "Beckmann"] {
        let measured = json(&["normalization", "--set", &format!("NDF={distribution}")]);
        let rows = measured["rows"].as_array().unwrap();
        assert_eq!((rows.len(), &rows[0]["roughness"], &rows[19]["roughness"]), (20, &0.05.into(), &1.0.into()));
        for row in rows {
            assert!((row["integral"].as_f64().unwrap() - 1.0).abs() < 0.005, "{distribution}: {row}");
        }
    }
}

#[test]
fn what_claims_to_be_reciprocal_is() {
    let reciprocal = json(&["reciprocity"]);
    assert!(reciprocal["error"].as_f64().unwrap() < 1e-4, "{reciprocal}");
    assert_eq!((&reciprocal["claims_reciprocity"], &reciprocal["reciprocal"]), (&true.into(), &true.into()));
    // FdezAguera is not reciprocal, which shows that the measurement can fail.
    let other = json(&["reciprocity", "--set", "MULTI_SCATTER=FdezAguera"]);
    assert!(other["error"].as_f64().unwrap() > 0.01, "{other}");
    assert_eq!((&other["claims_reciprocity"], &other["reciprocal"]), (&false.into(), &false.into()));
}

#[test]
fn numbers_out_of_range_are_usage_errors() {
    let directory = tempfile::tempdir().unwrap();
    for (args, said) in [
        (["furnace", "--metallic", "1.5"], "0 to 1"),
        (["furnace", "--base-color", "1,1"], "found 2"),
        (["reciprocity", "--base-color", "1,2,1"], "0 to 1"),
        (["plot", "--angle", "95"], "0 to 89"),
        (["plot", "--roughness", "0.5,x"], "a number"),
    ] {
        brdf(directory.path(), &args).expect(2, &[args[1], said]);
    }
    brdf(directory.path(), &["furnace", "--set", "view.ev=2"]).expect(2, &["--set", "specula modes"]);
    brdf(directory.path(), &["furnace", "--set", "NDF=Phong"]).expect(2, &["NDF", "GGX or Beckmann"]);
    brdf(directory.path(), &["plot", "--out", "lobes.exr"]).expect(2, &["lobes.exr", ".png"]);
}

#[test]
fn a_plot_is_drawn() {
    let directory = tempfile::tempdir().unwrap();
    brdf(directory.path(), &["plot", "--out", "lobes.png", "--roughness", "0.3,0.7"]).expect(0, &[]);
    let picture = crate::support::open_image(&directory.path().join("lobes.png")).into_rgb8();
    // The curve of each lobe, in its own color.
    for ink in [[224, 108, 32], [36, 104, 214], [34, 150, 92]] {
        let inked = picture.pixels().filter(|pixel| pixel.0 == ink).count();
        assert!(inked > 200, "{inked} pixels of {ink:?}");
    }
}

/// Every combination of the choices that `kept` accepts, over these constants.
fn combinations(constants: &[&Constant], kept: impl Fn(&Constant, &str) -> bool) -> Vec<Settings> {
    let mut all = vec![Settings::default()];
    for constant in constants {
        let mut longer = Vec::new();
        for (name, _) in constant.choices.iter().filter(|(name, _)| kept(constant, name)) {
            for before in &all {
                let mut settings = before.clone();
                settings.shader.insert(constant.name.clone(), ShaderValue::Name(name.clone()));
                longer.push(settings);
            }
        }
        all = longer;
    }
    all
}

#[test]
fn no_combination_that_claims_to_conserve_gains_energy() {
    let mut library = Library::new(Source::embedded(), compiler().clone(), &all_stages());
    let Update::Ready(shaders, _) = library.update(&Change::All) else { panic!("the embedded tree compiles") };
    let bench = BrdfMeter::new(gpu(), &shaders, &Settings::default()).unwrap();
    let steep = Grid { rows: 11, roughness: (0.0, 1.0), columns: 8, theta: (0.0, 85.0), samples: 1024 };
    let grazing = Grid { columns: 6, theta: (86.0, 89.9), ..steep };
    // The largest albedo of a grid, with its roughness and angle. NaN counts as more than any albedo.
    let largest_of = |settings: &Settings, metallic: f32, grid: Grid| {
        let surface = Surface { base_color: [1.0; 3], metallic };
        let albedo = bench.with(settings).unwrap().furnace(surface, grid).unwrap();
        let known = |a: f32| if a.is_nan() { f32::INFINITY } else { a };
        let of_cell = |rgb: &[f32; 3]| rgb.map(known).into_iter().fold(0.0, f32::max);
        let cells = (0..).zip(albedo.iter().map(of_cell));
        let (cell, most) = cells.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let place = (grid.roughness_of(cell / grid.columns), grid.theta_of(cell % grid.columns));
        (f64::from(most), place)
    };
    let largest = |settings: &Settings, metallic: f32| largest_of(settings, metallic, steep).0;
    let claiming = |c: &Constant, name: &str| Claim::Conserves.of(c).unwrap().iter().any(|n| n == name);
    // Leave out constants that do not affect a metal, or a dielectric.
    let parts = |without: &[&str]| -> Vec<&Constant> {
        let models = shaders.constants.iter().filter(|c| Claim::Conserves.of(c).is_some());
        models.filter(|c| !without.contains(&c.name.as_str())).collect()
    };
    let metal = parts(&["DIFFUSE", "DIFFUSE_COUPLING", "FRESNEL_DIELECTRIC"]);
    let dielectric = parts(&["FRESNEL_METAL"]);
    let mut worst = [(0.0, String::new()), (0.0, String::new())];
    let mut count = 0;
    for (constants, metallic) in [(metal, 1.0), (dielectric, 0.0)] {
        for settings in combinations(&constants, claiming) {
            let is_burley = settings.shader.get("DIFFUSE") == Some(&ShaderValue::Name("RenormalizedBurley".into()));
            let at_grazing = if is_burley { MOST_OF_BURLEY } else { MOST };
            for ((grid, allowed), worst) in [(steep, MOST), (grazing, at_grazing)].into_iter().zip(&mut worst) {
                let (max, (roughness, theta)) = largest_of(&settings, metallic, grid);
                let what =
                    format!("roughness {roughness}, {theta} degrees, metallic {metallic}: {:?}", settings.shader);
                assert!(max <= allowed, "{max} of the light at {what}");
                if max > worst.0 {
                    *worst = (max, what);
                }
            }
            count += 1;
        }
    }
    for (max, what) in worst {
        println!("{count} combinations claim to conserve; the largest albedo is {max:.4}, {what}");
    }
    // Prints the choices without the claim, one constant at a time, with conserving choices for the others.
    let mut sound = Settings::default();
    for (constant, _) in unclaimed(Claim::Conserves, &sound.clone(), &shaders) {
        let claiming = Claim::Conserves.of(constant).unwrap()[0].clone();
        sound.shader.insert(constant.name.clone(), ShaderValue::Name(claiming));
    }
    assert!(unclaimed(Claim::Conserves, &sound, &shaders).is_empty());
    for (constant, _) in choices(&sound, &shaders) {
        let Some(claims) = Claim::Conserves.of(constant) else { continue };
        for (name, _) in constant.choices.iter().filter(|(name, _)| !claims.contains(name)) {
            let mut settings = sound.clone();
            settings.shader.insert(constant.name.clone(), ShaderValue::Name(name.clone()));
            println!("{}={name} does not: {:.4}", constant.name, largest(&settings, 0.0));
        }
    }
    assert_validated();
}
