//! The inspector reads a pixel in many modes at once, and measures its material.

use crate::support::{SIZE, Session, assert_validated, compiler, gpu, model, renderer, settings};
use specula::headless::Headless;
use specula::measure::{Curves, Material, prepare};
use specula::shader::{Change, Library, Mode, PixelValue, Source, Update};

/// Modes of every kind: light with a background, derivatives that use neighboring pixels, numbers, vectors, terms, edges, layers.
const SLUGS: [&str; 20] = [
    "final",
    "position",
    "facet-normal",
    "mip-level",
    "uv1",
    "wireframe",
    "overdraw",
    "base-color",
    "roughness",
    "normal-texture",
    "clearcoat",
    "sheen-color",
    "d",
    "f",
    "specular-lobe",
    "n-dot-l",
    "direct-specular",
    "ambient",
    "luminance",
    "nan",
];

fn modes(headless: &Headless, slugs: &[&str]) -> Vec<Mode> {
    headless.shaders().modes.iter().filter(|mode| slugs.contains(&&*mode.slug)).cloned().collect()
}

/// Whether two values are the same, but for the rounding of interpolated coordinates.
fn is_same(a: &PixelValue, b: &PixelValue) -> bool {
    let length = a.value.iter().map(|number| number.abs()).fold(1e-3, f32::max);
    let is_close = a.value.iter().zip(&b.value).all(|(a, b)| (a - b).abs() <= 1e-4 * length);
    // Where there is no data, the color is that of a checkerboard.
    (a.no_data, a.not_finite) == (b.no_data, b.not_finite) && (is_close || a.no_data)
}

/// Compares modes at some pixels with what `specula probe` prints.
fn compare(name: &str, with: &[&str], slugs: &[&str], pixels: &[(u32, u32)]) {
    let with = [&["view.msaa=1"], with].concat();
    let mut headless = renderer(model(name), settings(&with), SIZE);
    let modes = modes(&headless, slugs);
    assert_eq!(modes.len(), slugs.len());
    for at in pixels {
        let found = headless.inspect(*at, &modes).unwrap();
        assert_eq!(found.len(), modes.len());
        let probed = headless.pixel(*at, &modes).unwrap();
        let mut differ = Vec::new();
        for (mode, probed) in modes.iter().zip(&probed) {
            let (_, value) = found.iter().find(|(slug, _)| *slug == mode.slug).unwrap();
            if !is_same(value, probed) {
                differ.push(format!("{} {value:?} {probed:?}", mode.slug));
            }
        }
        assert!(differ.is_empty(), "{name} at {at:?}:\n{}", differ.join("\n"));
    }
    assert_validated();
}

/// Pixels of even and odd rows and columns have the derivatives of the picture.
#[test]
fn values_are_those_of_probe() {
    compare("shader-ball", &["environment.name=studio"], &SLUGS, &[(48, 30), (47, 31), (2, 2)]);
}

#[test]
fn values_of_layered_materials_are_those_of_probe() {
    let slugs = ["final", "clearcoat", "clearcoat-lobe", "clearcoat-light", "d", "light-2"];
    compare("clearcoat", &["lights.chosen=2"], &slugs, &[(31, 32), (62, 33)]);
}

/// Intermediate results of the built-in shaders are finite, so the first line with NaN is the user's.
#[test]
fn a_search_at_a_finite_pixel_finds_nothing() {
    // The coat's direct light is a part of its picture.
    let cases = [("shader-ball", (48, 30), &["final", "direct-specular"][..]), ("clearcoat", (31, 32), &["final"])];
    for (name, at, slugs) in cases {
        let mut headless = renderer(model(name), settings(&["view.msaa=1", "environment.name=none"]), SIZE);
        for mode in modes(&headless, slugs) {
            let found = headless.first_not_finite(at, &mode).unwrap();
            assert_eq!(found, None, "{name} at {at:?} in {}", mode.slug);
        }
    }
    assert_validated();
}

/// The header of a loop, a condition, an array, a statement that shares its line and one in a macro.
#[test]
fn a_search_finds_statements_of_every_kind() {
    let settings = settings(&["view.msaa=1", "environment.name=none"]);
    let mut session = Session::new(model("shader-ball"), settings);
    let mode = modes(&session.headless, &["roughness"]).remove(0);
    let mut line = "s.roughness = saturate(s.roughness * roughness_scale);".to_owned();
    let negative = "(-1.0 - s.roughness)";
    for (edit, code, components) in [
        (
            format!("for (float t = 0.0; t < sqrt{negative}; ++t) s.roughness = 0.5;"),
            "for (float t = 0.0; t < sqrt(-1.0 - s.roughness); ++t)",
            &["NaN"][..],
        ),
        (
            format!("if (s.roughness > log{negative}) s.roughness = 0.5;"),
            "if (s.roughness > log(-1.0 - s.roughness))",
            &["NaN"],
        ),
        (
            "float all[2] = float[](1.0 / (s.roughness - s.roughness), 2.0); s.roughness = all[1];".to_owned(),
            "float all[2] = float[](1.0 / (s.roughness - s.roughness), 2.0);",
            &["Inf"],
        ),
        (
            "float zero = s.roughness - s.roughness; vec3 all = vec3(zero, 1.0 / zero, -1.0 / zero);".to_owned(),
            "vec3 all = vec3(zero, 1.0 / zero, -1.0 / zero);",
            &["finite", "Inf", "-Inf"],
        ),
        (
            format!("\n#define ROOT(x) sqrt(x)\ns.roughness = ROOT{negative};"),
            "s.roughness = ROOT(-1.0 - s.roughness);",
            &["NaN"],
        ),
    ] {
        crate::support::ready(&session.edit("user.glsl", &line, &edit));
        let found = session.headless.first_not_finite((48, 30), &mode).unwrap().expect(code);
        assert_eq!((&*found.first.code, &*found.components), (code, components), "{found:?}");
        let text = session.tree.read("user.glsl");
        let at = found.first.line as usize - 1;
        assert!(text.lines().nth(at).unwrap()[found.first.column as usize - 1..].starts_with(&code[..9]), "{found:?}");
        line = edit;
    }
    assert_validated();
}

/// What looks up an image of another pass, or noise, finds it at the pixel's place in the picture.
#[test]
fn values_with_shadows_and_screen_space_occlusion_are_those_of_probe() {
    let with = ["environment.name=studio", "SHADOWS=Soft", "AMBIENT_OCCLUSION=true"];
    compare("shader-ball", &with, &["final", "ambient", "direct-diffuse", "light-1"], &[(45, 41), (52, 44)]);
}

#[test]
fn an_edit_changes_values() {
    let mut session = Session::new(model("shader-ball"), settings(&[]));
    let modes = modes(&session.headless, &["roughness", "metallic", "position"]);
    let of = |session: &mut Session, slug: &str| {
        let found = session.headless.inspect((48, 30), &modes).unwrap();
        found.into_iter().find(|(other, _)| other == slug).unwrap().1
    };
    let before = of(&mut session, "roughness");
    let line = "else if (MODE == MODE_ROUGHNESS) value = vec3(s.roughness);";
    let nan = "else if (MODE == MODE_ROUGHNESS) value = vec3(sqrt(-1.0 - s.roughness));";
    crate::support::ready(&session.edit("debug/surface.glsl", line, nan));
    assert!(!before.not_finite && of(&mut session, "roughness").not_finite);
    assert_validated();
}

/// The texts of a tree with this replacement, as a window knows them.
fn texts(
    file: &str,
    from: &str,
    to: &str,
) -> std::collections::BTreeMap<specula::shader::TreePath, std::sync::Arc<str>> {
    let source = Source::embedded();
    let stages = specula::frame::stages::stages();
    let mut library = Library::new(source, compiler().clone(), &stages);
    let Update::Ready(shaders, _) = library.update(&Change::All) else { panic!("the tree does not compile") };
    let mut texts = shaders.texts.clone();
    assert!(texts.keys().all(|path| !path.as_str().starts_with("measure/")), "the window compiles no measuring stage");
    let path = specula::shader::TreePath::from(file);
    let edited = texts[&path].replace(from, to);
    assert!(from == to || *edited != *texts[&path]);
    texts.insert(path, edited.into());
    texts
}

#[test]
fn curves_are_measured_with_the_texts_of_an_edit() {
    let tree = Source::embedded();
    let settings = settings(&[]);
    let of = |texts| {
        let bench = prepare(gpu(), compiler(), &tree, &texts, &settings).unwrap();
        let material = Material { base_color: [0.8, 0.4, 0.2], metallic: 0.0, roughness: 0.5, light_deg: 45.0 };
        Curves::measure(&bench, &material).unwrap()
    };
    let file = "brdf/ndf.glsl";
    let before = of(texts(file, "", ""));
    let after = of(texts(file, "float a2 = alpha * alpha;", "float a2 = 4.0 * alpha * alpha;"));
    assert_eq!((before.lobes.len(), before.albedo.len(), before.furnace.len()), (721, 45, 45));
    let diffuse = before.lobes[360].diffuse;
    assert!(diffuse[0] > diffuse[1] && diffuse[1] > diffuse[2], "the color of the base: {diffuse:?}");
    assert!(before.albedo[0][0] > 0.5 && before.albedo[0][0] < 1.0, "{:?}", before.albedo[0]);
    assert!(before.furnace[0][2] > before.albedo[0][2], "white reflects more");
    assert_ne!(before.lobes, after.lobes);
    // In space, the ring at the angle of the mirror direction has the largest value in that direction.
    let hemisphere = before.hemisphere.unwrap();
    assert_eq!(hemisphere.values.len(), hemisphere.azimuths * 32);
    let ring = &hemisphere.values[16 * hemisphere.azimuths..17 * hemisphere.azimuths];
    let most = (0..ring.len()).max_by(|a, b| ring[*a][0].total_cmp(&ring[*b][0])).unwrap();
    assert_eq!(most, 0, "{ring:?}");
    assert_validated();
}

/// A slider in the BRDF, in the file of sliders whose `when=` names constants of passes, which are not measured.
#[test]
fn curves_have_the_value_of_a_slider_in_the_brdf() {
    let (tree, file, squared) = (Source::embedded(), "brdf/ndf.glsl", "float a2 = alpha * alpha;");
    let of = |texts, assignments: &[&str]| {
        let bench = prepare(gpu(), compiler(), &tree, &texts, &settings(assignments)).unwrap();
        let material = Material { base_color: [0.8, 0.4, 0.2], metallic: 1.0, roughness: 0.5, light_deg: 45.0 };
        Curves::measure(&bench, &material).unwrap()
    };
    let mut with_slider = texts(file, squared, "float a2 = roughness_scale * alpha * alpha;");
    let include = "#include \"common/math.glsl\"\n";
    let text = with_slider.get_mut(&file.into()).unwrap();
    *text = text.replace(include, &format!("{include}#include \"user/params.glsl\"\n")).into();
    let with_number = of(texts(file, squared, "float a2 = 0.5 * alpha * alpha;"), &[]);
    assert_eq!(of(with_slider.clone(), &["roughness_scale=0.5"]), with_number);
    assert_eq!(of(with_slider, &[]), of(texts(file, "", ""), &[]), "at its default of 1");
    assert_validated();
}

#[test]
fn a_tree_without_measuring_stages_says_so() {
    let tree = Source::memory([]);
    let texts = texts("brdf/ndf.glsl", "", "");
    let Err(message) = prepare(gpu(), compiler(), &tree, &texts, &settings(&[])) else { panic!("measured nothing") };
    assert!(message.contains("measure/furnace.comp") && message.contains("specula new"), "{message}");
}
