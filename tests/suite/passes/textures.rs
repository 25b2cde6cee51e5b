//! Cube maps, volumes and arrays of the tree: what stages read at each place, every form of file, and errors with their line.

mod errors;

use crate::support::{SIZE, Session, assert_differ, assert_same, failed, glb, lines, load, ready, settings, stages};
use image::{ImageBuffer, Rgb32FImage, Rgba, RgbaImage};
use specula::render::Capture;

/// A gray sphere, one sample a pixel, on nothing.
fn sphere() -> Session {
    let model = load(&glb::model(&glb::sphere(16, 32), &glb::gray()));
    let session = Session::new(model, settings(&["view.msaa=1", "view.background=none", "environment.name=none"]));
    std::fs::create_dir_all(session.tree.path("passes")).unwrap();
    session
}

/// A pass that shows the values of these expressions side by side.
fn columns(uniforms: &str, values: &[String]) -> String {
    let cases: String =
        values.iter().enumerate().map(|(at, value)| format!("case {at}: color = {value}; break;\n")).collect();
    format!(
        "//@pass show to=picture\n#version 460\n#include \"pass.glsl\"\n{uniforms}\nvoid main() {{\n    \
         color = vec4(0.0);\n    switch (int(uv.x * {}.0)) {{\n{cases}    }}\n}}\n",
        values.len()
    )
}

/// The values of [`columns`].
fn values(capture: &Capture, count: usize) -> Vec<[f32; 4]> {
    let column = |at: usize| (at * 2 + 1) as u32 * SIZE.0 / (count as u32 * 2);
    (0..count).map(|at| capture.raw_at(column(at), SIZE.1 / 2).unwrap()).collect()
}

/// Shows expressions of a texture, and returns their values.
#[track_caller]
fn read(session: &mut Session, uniforms: &str, expressions: &[String]) -> Vec<[f32; 4]> {
    ready(&session.save("passes/show.frag", &columns(uniforms, expressions)));
    values(&session.render(), expressions.len())
}

#[track_caller]
fn assert_near(found: &[[f32; 4]], expected: &[[f32; 4]], most: f32, what: &str) {
    assert_eq!(found.len(), expected.len());
    for (at, (found, expected)) in found.iter().zip(expected).enumerate() {
        let far = (0..4).any(|c| (found[c] - expected[c]).abs() > most);
        assert!(!far, "{what}: value {at} is {found:?}, not {expected:?}");
    }
}

fn bytes([r, g, b, a]: [u8; 4]) -> [f32; 4] {
    [r, g, b, a].map(|byte| f32::from(byte) / 255.0)
}

/// The direction to a point on a face of a cube, as the Vulkan specification has it.
fn direction(face: usize, s: f32, t: f32) -> [f32; 3] {
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

/// A face with four texels of their own.
fn face(index: usize) -> RgbaImage {
    RgbaImage::from_fn(2, 2, |x, y| texel(index, x, y))
}

fn texel(face: usize, x: u32, y: u32) -> Rgba<u8> {
    Rgba([face as u8 * 50, x as u8 * 200, y as u8 * 100 + 30, 255])
}

/// Lookups of all texels of all faces, and what they read.
fn cube_lookups(name: &str) -> (Vec<String>, Vec<[f32; 4]>) {
    let all = (0..6).flat_map(|face| (0..4).map(move |at| (face, at % 2, at / 2)));
    all.map(|(face, x, y)| {
        let [dx, dy, dz] = direction(face, x as f32 - 0.5, y as f32 - 0.5);
        (format!("texture({name}, vec3({dx:?}, {dy:?}, {dz:?}))"), bytes(texel(face, x, y).0))
    })
    .unzip()
}

/// A picture of tiles: each an image, its column and its row.
fn tiled<'a>(columns: u32, rows: u32, tiles: impl IntoIterator<Item = (&'a RgbaImage, u32, u32)>) -> RgbaImage {
    let mut out: Option<RgbaImage> = None;
    for (tile, column, row) in tiles {
        let (width, height) = tile.dimensions();
        let out = out.get_or_insert_with(|| RgbaImage::new(columns * width, rows * height));
        image::imageops::replace(out, tile, (column * width).into(), (row * height).into());
    }
    out.unwrap()
}

const FACES: [&str; 6] = ["px", "nx", "py", "ny", "pz", "nz"];

fn save_faces(session: &Session, names: [&str; 6]) {
    for (index, name) in names.iter().enumerate() {
        face(index).save(session.tree.path(&format!("passes/sky_{name}.png"))).unwrap();
    }
}

const SKY: &str = "//@texture sky \"sky_*.png\" linear clamp\nuniform samplerCube sky;";

#[test]
fn six_files_are_the_faces_of_a_cube_map() {
    let (lookups, expected) = cube_lookups("sky");
    let sets = [FACES, ["posx", "negx", "posy", "negy", "posz", "negz"], ["0", "1", "2", "3", "4", "5"]];
    for names in sets {
        let mut session = sphere();
        save_faces(&session, names);
        assert_near(&read(&mut session, SKY, &lookups), &expected, 1e-3, names[0]);
    }
}

#[test]
fn one_file_holds_the_faces_of_a_cube_map() {
    let mut session = sphere();
    let faces: Vec<RgbaImage> = (0..6).map(face).collect();
    let at = |places: [(u32, u32); 6]| faces.iter().zip(places).map(|(face, (x, y))| (face, x, y)).collect::<Vec<_>>();
    let turned = image::imageops::rotate180(&faces[5]);
    let mut vertical = at([(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (1, 3)]);
    vertical[5].0 = &turned;
    let pictures = [
        tiled(6, 1, at([0, 1, 2, 3, 4, 5].map(|x| (x, 0)))),
        tiled(1, 6, at([0, 1, 2, 3, 4, 5].map(|y| (0, y)))),
        tiled(4, 3, at([(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)])),
        tiled(3, 4, vertical),
    ];
    let uniforms = "//@texture sky \"sky.png\" linear clamp\nuniform samplerCube sky;";
    let (lookups, expected) = cube_lookups("sky");
    session.tree.write("passes/show.frag", &columns(uniforms, &lookups));
    for picture in pictures {
        picture.save(session.tree.path("passes/sky.png")).unwrap();
        ready(&session.changed(&["passes/sky.png", "passes/show.frag"]));
        let what = format!("{:?}", picture.dimensions());
        assert_near(&values(&session.render(), lookups.len()), &expected, 1e-3, &what);
    }
}

/// The center column of an equirectangular picture is seen looking down -Z, columns to its right are towards +X.
#[test]
fn an_equirectangular_picture_becomes_a_cube_map() {
    let mut session = sphere();
    let directions = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [1, 1, 1], [-1, 1, -1]];
    let lookups: Vec<String> =
        directions.iter().map(|[x, y, z]| format!("texture(sky, vec3({x}, {y}, {z}))")).collect();
    let expected: Vec<[f32; 4]> = directions
        .iter()
        .map(|d| {
            let length = d.iter().map(|c| (c * c) as f32).sum::<f32>().sqrt();
            let [x, y, z] = d.map(|c| 4.0 + 4.0 * c as f32 / length);
            [x, y, z, 1.0]
        })
        .collect();
    let at = |x: u32, y: u32| {
        let (phi, theta) =
            ((x as f32 + 0.5) / 128.0 * std::f32::consts::TAU, (y as f32 + 0.5) / 64.0 * std::f32::consts::PI);
        // phi = 0 is the left edge, which looks down +Z with -X to its right.
        [-theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()]
    };
    let floats = Rgb32FImage::from_fn(128, 64, |x, y| image::Rgb(at(x, y).map(|c| 4.0 + 4.0 * c)));
    let of = |file: &str, options: &str| format!("//@texture sky \"{file}\" {options}\nuniform samplerCube sky;");
    for file in ["sky.exr", "sky.hdr"] {
        floats.save(session.tree.path(&format!("passes/{file}"))).unwrap();
        let found = read(&mut session, &of(file, "linear"), &lookups);
        assert_near(&found, &expected, 0.15, file);
    }
    // Colors in sRGB are blended as light.
    let encode = |value: f32| (crate::support::srgb(f64::from(value)) * 255.0).round() as u8;
    let encoded = RgbaImage::from_fn(128, 64, |x, y| {
        let [r, g, b] = at(x, y).map(|c| encode((4.0 + 4.0 * c) / 8.0));
        Rgba([r, g, b, 255])
    });
    encoded.save(session.tree.path("passes/sky.png")).unwrap();
    let expected: Vec<[f32; 4]> = expected.iter().map(|[r, g, b, _]| [r / 8.0, g / 8.0, b / 8.0, 1.0]).collect();
    assert_near(&read(&mut session, &of("sky.png", "srgb"), &lookups), &expected, 0.02, "sky.png");
}

/// A slice with texels of its own: 4 wide, 3 high.
fn slice(index: u32) -> RgbaImage {
    RgbaImage::from_fn(4, 3, |x, y| Rgba([x as u8 * 60, y as u8 * 100, index as u8 * 50, 255]))
}

/// Lookups of the texels in the first column and last row of five slices, at their centers.
fn slice_lookups(name: &str, third: impl Fn(u32) -> String) -> (Vec<String>, Vec<[f32; 4]>) {
    let all = (0..5).flat_map(|z| [(0, 2, z), (3, 0, z)]);
    all.map(|(x, y, z)| {
        let lookup =
            format!("texture({name}, vec3({:?}, {:?} / 3.0, {}))", (x as f32 + 0.5) / 4.0, y as f32 + 0.5, third(z));
        (lookup, bytes([x as u8 * 60, y as u8 * 100, z as u8 * 50, 255]))
    })
    .unzip()
}

/// The same slices as a volume and as an array, in each form of file.
#[test]
fn slices_and_layers_come_from_one_file_or_many() {
    let mut session = sphere();
    let slices: Vec<RgbaImage> = (0..5).map(slice).collect();
    let path = |name: &str| session.tree.path(&format!("passes/{name}"));
    tiled(1, 5, slices.iter().zip(0..).map(|(slice, y)| (slice, 0, y))).save(path("down.png")).unwrap();
    tiled(5, 1, slices.iter().zip(0..).map(|(slice, x)| (slice, x, 0))).save(path("across.png")).unwrap();
    // 10 follows 9, and a word follows the numbers.
    for (slice, name) in slices.iter().zip(["1", "02", "9", "10", "last"]) {
        slice.save(path(&format!("slice_{name}.png"))).unwrap();
    }
    let volume = slice_lookups("t", |z| format!("{z}.5 / 5.0"));
    let array = slice_lookups("t", |z| format!("{z}.0"));
    for file in ["\"down.png\" layers=5", "\"across.png\" layers=5", "\"slice_*.png\""] {
        for (glsl, (lookups, expected)) in [("sampler3D", &volume), ("sampler2DArray", &array)] {
            let uniforms = format!("//@texture t {file} linear\nuniform {glsl} t;");
            assert_near(&read(&mut session, &uniforms, lookups), expected, 1e-3, &uniforms);
        }
    }
    // Turned upside down, each slice stays in its place.
    let uniforms = "//@texture t \"down.png\" layers=5 linear flip\nuniform sampler3D t;";
    let lookups: Vec<String> = (0..5).map(|z| format!("texture(t, vec3(0.125, 0.5 / 3.0, {z}.5 / 5.0))")).collect();
    let expected: Vec<[f32; 4]> = (0..5).map(|z| bytes([0, 200, z * 50, 255])).collect();
    assert_near(&read(&mut session, uniforms, &lookups), &expected, 1e-3, "flip");
    // Repeated, the first slice follows the last.
    for (wrap, expected) in [("repeat", 0), ("clamp", 200)] {
        let uniforms = format!("//@texture t \"down.png\" layers=5 linear {wrap}\nuniform sampler3D t;");
        let found = read(&mut session, &uniforms, &["texture(t, vec3(0.125, 0.5 / 3.0, 5.5 / 5.0))".into()]);
        assert_near(&found, &[bytes([0, 0, expected, 255])], 1e-3, wrap);
    }
}

/// A table of colors, read as a volume and as slices side by side in the same stage.
#[test]
fn a_table_is_a_volume_or_a_strip() {
    let mut session = sphere();
    let colors: Vec<[f32; 3]> = (0..8).map(|at| [at as f32 / 2.0, (at % 3) as f32, 8.0 - at as f32]).collect();
    let text: String = colors.iter().map(|[r, g, b]| format!("{r} {g} {b}\n")).collect();
    session.tree.write("passes/grade.cube", &format!("LUT_3D_SIZE 2\n{text}"));
    let both = "//@texture grade \"grade.cube\" clamp\n#ifdef VOLUME\nuniform sampler3D grade;\n#else\nuniform sampler2D grade;\n#endif";
    let lookups: Vec<String> =
        (0..8).map(|at| format!("texture(grade, vec3({}, {}, {}) * 0.5 + 0.25)", at % 2, at / 2 % 2, at / 4)).collect();
    let expected: Vec<[f32; 4]> = colors.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
    assert_near(&read(&mut session, &format!("#define VOLUME\n{both}"), &lookups).clone(), &expected, 1e-2, "volume");
    let flat: Vec<String> =
        (0..8).map(|at| format!("texelFetch(grade, ivec2({}, {}), 0)", at % 2 + at / 4 * 2, at / 2 % 2)).collect();
    // Another pass reads the same table the other way.
    let other = "//@pass other size=1x1 format=rgba32f\n#version 460\n#include \"pass.glsl\"\nuniform sampler3D grade;\n\
        void main() { color = texture(grade, vec3(0.75)); }\n";
    session.tree.write("passes/other.frag", other);
    session.changed(&["passes/other.frag"]);
    let with_other: Vec<String> = flat.iter().cloned().chain(["texelFetch(other, ivec2(0), 0)".to_owned()]).collect();
    let uniforms = format!("{both}\nuniform sampler2D other;");
    let expected: Vec<[f32; 4]> = expected.iter().copied().chain([expected[7]]).collect();
    assert_near(&read(&mut session, &uniforms, &with_other), &expected, 1e-2, "both");
    std::fs::remove_file(session.tree.path("passes/other.frag")).unwrap();
    session.changed(&["passes/other.frag"]);
    // A strip of 4 x 2 pixels has two slices without being told.
    let strip = RgbaImage::from_fn(4, 2, |x, _| Rgba([(x / 2 * 255) as u8, 0, 0, 255]));
    strip.save(session.tree.path("passes/strip.png")).unwrap();
    let uniforms = "//@texture strip \"strip.png\" linear clamp\nuniform sampler3D strip;";
    let found = read(
        &mut session,
        uniforms,
        &["texture(strip, vec3(0.5, 0.5, 0.25))".into(), "texture(strip, vec3(0.5, 0.5, 0.75))".into()],
    );
    assert_near(&found, &[[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]], 1e-3, "strip");
}

/// Half of each picture is white: the last level is the mean, of light for sRGB.
#[test]
fn mip_levels_belong_to_their_layer_face_or_volume() {
    let mut session = sphere();
    let half =
        |white: [u8; 4]| move |x: u32, _: u32| if x.is_multiple_of(2) { Rgba([0, 0, 0, 255]) } else { Rgba(white) };
    let faces: Vec<RgbaImage> = (0..6).map(|at| RgbaImage::from_fn(4, 4, half([255, at * 50, 0, 255]))).collect();
    tiled(6, 1, faces.iter().zip(0..).map(|(face, x)| (face, x, 0))).save(session.tree.path("passes/six.png")).unwrap();
    let mean = |green: f32| [0.5, green / 2.0, 0.0, 1.0];
    let linear: Vec<[f32; 4]> = (0..6).map(|at| mean(at as f32 * 50.0 / 255.0)).collect();
    let array: Vec<String> = (0..6).map(|z| format!("textureLod(six, vec3(0.3, 0.3, {z}), 2.0)")).collect();
    let of = |glsl: &str, options: &str| format!("//@texture six \"six.png\" {options} mips\nuniform {glsl} six;");
    assert_near(&read(&mut session, &of("sampler2DArray", "layers=6 linear"), &array), &linear, 3e-3, "array");
    let cube: Vec<String> = (0..6)
        .map(|face| {
            let [x, y, z] = direction(face, 0.0, 0.0);
            format!("textureLod(six, vec3({x:?}, {y:?}, {z:?}), 1.0)")
        })
        .collect();
    assert_near(&read(&mut session, &of("samplerCube", "linear"), &cube), &linear, 3e-3, "cube");
    let found = read(&mut session, &of("samplerCube", "srgb"), &cube[..1]);
    assert_near(&found, &[[0.5, 0.0, 0.0, 1.0]], 3e-3, "light of a cube");
    // Slices of a volume are blended, too.
    let slices: Vec<RgbaImage> = [0, 255].map(|value| RgbaImage::from_pixel(2, 2, Rgba([value, 0, 0, 255]))).into();
    tiled(1, 2, slices.iter().zip(0..).map(|(slice, y)| (slice, 0, y)))
        .save(session.tree.path("passes/two.png"))
        .unwrap();
    for space in ["linear", "srgb"] {
        let uniforms = format!("//@texture two \"two.png\" {space} mips layers=2\nuniform sampler3D two;");
        let found = read(
            &mut session,
            &uniforms,
            &["textureLod(two, vec3(0.5), 1.0)".into(), "vec4(vec3(textureQueryLevels(two)), 1.0)".into()],
        );
        assert_near(&found, &[[0.5, 0.0, 0.0, 1.0], [2.0, 2.0, 2.0, 1.0]], 5e-3, space);
    }
    // Floats have levels as well, in half floats.
    let floats: Rgb32FImage = ImageBuffer::from_fn(4, 2, |x, _| image::Rgb([x as f32 * 100.0, 0.25, 0.0]));
    floats.save(session.tree.path("passes/float.exr")).unwrap();
    for (glsl, options, at, expected) in [
        ("sampler2D", "", "vec2(0.5), 2.0", 150.0),
        ("sampler2DArray", "layers=2", "vec3(0.5, 0.5, 1), 1.0", 250.0),
        ("sampler3D", "layers=2", "vec3(0.5), 1.0", 150.0),
    ] {
        let uniforms = format!("//@texture f \"float.exr\" {options} mips\nuniform {glsl} f;");
        let found = read(&mut session, &uniforms, &[format!("textureLod(f, {at})")]);
        assert_near(&found, &[[expected, 0.25, 0.0, 1.0]], 0.1, glsl);
    }
}

/// The model's stages, a vertex stage and a compute pass read them by name.
#[test]
fn every_stage_reads_them() {
    let mut session = sphere();
    save_faces(&session, FACES);
    let plain = session.render();
    let user = session.tree.read("user.glsl");
    let declared = format!("{}\nvoid user_surface(", SKY.replace("sky_", "passes/sky_"));
    let edited = user.replace("void user_surface(", &declared);
    assert!(edited.contains(&declared), "{user}");
    let at = edited.find("void user_surface(").unwrap();
    let body = at + edited[at..].find('{').unwrap() + 1;
    let edited = format!("{}\n    s.emissive += texture(sky, s.n).rgb;{}", &edited[..body], &edited[body..]);
    ready(&session.save("user.glsl", &edited));
    assert_differ(&plain, &session.render(), "the model's fragment stage");
    ready(&session.save("user.glsl", &user));
    assert_same(&plain, &session.render(), "without it");

    let slices: Vec<RgbaImage> = [0, 255].map(|value| RgbaImage::from_pixel(2, 2, Rgba([value; 4]))).into();
    tiled(1, 2, slices.iter().zip(0..).map(|(slice, y)| (slice, 0, y)))
        .save(session.tree.path("passes/two.png"))
        .unwrap();
    let vertex = session.tree.read("user/vertex.glsl");
    let declared = "//@texture two \"passes/two.png\" linear layers=2\nuniform sampler3D two;\nvoid user_vertex(";
    let edited = vertex.replace("void user_vertex(", declared);
    let at = edited.find("void user_vertex(").unwrap();
    let body = at + edited[at..].find('{').unwrap() + 1;
    let edited = format!(
        "{}\n    vertex.position *= 1.0 + textureLod(two, vec3(0.75), 0.0).r;{}",
        &edited[..body],
        &edited[body..]
    );
    ready(&session.save("user/vertex.glsl", &edited));
    assert_differ(&plain, &session.render(), "the model's vertex stage");
    ready(&session.save("user/vertex.glsl", &vertex));

    let compute = "//@pass cells size=6x1 format=rgba32f\n//@texture tiles \"two.png\" linear layers=2\n#version 460\n\
        #include \"interface.glsl\"\nlayout(local_size_x = 8) in;\nlayout(rgba32f) uniform writeonly image2D cells;\n\
        uniform sampler2DArray tiles;\nvoid main() {\n    int at = int(gl_GlobalInvocationID.x);\n    \
        if (at < 6) imageStore(cells, ivec2(at, 0), textureLod(tiles, vec3(0.5, 0.5, at), 0.0));\n}\n";
    ready(&session.save("passes/cells.comp", compute));
    let lookups: Vec<String> = (0..2).map(|x| format!("texelFetch(cells, ivec2({x}, 0), 0)")).collect();
    assert_near(&read(&mut session, "uniform sampler2D cells;", &lookups), &[[0.0; 4], [1.0; 4]], 1e-6, "compute");
}

#[test]
fn saving_one_face_changes_the_picture() {
    let mut session = sphere();
    save_faces(&session, FACES);
    // An image that is kept while its inputs stay.
    let dome = "//@pass dome size=6x1 format=rgba32f\n//@texture sky \"sky_*.png\" linear\n#version 460\n#include \"pass.glsl\"\n\
        uniform samplerCube sky;\nvoid main() { color = texture(sky, vec3(uv.x - 0.5, 0.0, -1.0)); }\n";
    ready(&session.save("passes/dome.frag", dome));
    let lookup = ["texelFetch(dome, ivec2(2, 0), 0)".to_owned()];
    let before = read(&mut session, "uniform sampler2D dome;", &lookup);
    assert!(before[0][0] > 0.9, "{before:?}");
    RgbaImage::from_pixel(2, 2, Rgba([10, 20, 30, 255])).save(session.tree.path("passes/sky_nz.png")).unwrap();
    let reload = session.changed(&["passes/sky_nz.png"]);
    ready(&reload);
    assert!(stages(&reload).is_empty(), "a texture compiles nothing");
    assert_near(&values(&session.render(), 1), &[bytes([10, 20, 30, 255])], 1e-3, "the new face");
    // A broken face costs nothing, nor does a missing one.
    let good = session.render();
    std::fs::write(session.tree.path("passes/sky_nz.png"), "no image").unwrap();
    let told = lines(failed(&session.changed(&["passes/sky_nz.png"])));
    assert!(told[0].contains("dome.frag:2:17: error:") && told[0].contains("sky_nz.png cannot be read"), "{told:#?}");
    assert_same(&good, &session.render(), "a broken face");
    // The header is good, and the rest is missing.
    let mut bytes = Vec::new();
    face(5).write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png).unwrap();
    std::fs::write(session.tree.path("passes/sky_nz.png"), &bytes[..40]).unwrap();
    let told = lines(failed(&session.changed(&["passes/sky_nz.png"])));
    assert!(told[0].contains("dome.frag:2:17: error:") && told[0].contains("sky_nz.png cannot be read"), "{told:#?}");
    std::fs::remove_file(session.tree.path("passes/sky_nz.png")).unwrap();
    let told = lines(failed(&session.changed(&["passes/sky_nz.png"])));
    assert!(told[0].contains("\"sky_*.png\" has no sky_nz.png; expected the six faces px nx py ny pz nz"), "{told:#?}");
    assert_same(&good, &session.render(), "a missing face");
}

#[test]
fn a_new_file_that_matches_is_a_new_layer() {
    let mut session = sphere();
    let paint = |session: &Session, name: &str, value: u8| {
        let path = session.tree.path(&format!("passes/{name}.png"));
        RgbaImage::from_pixel(2, 2, Rgba([value; 4])).save(path).unwrap();
    };
    paint(&session, "tile_1", 0);
    let uniforms = "//@texture tiles \"tile_*.png\" linear\nuniform sampler2DArray tiles;";
    let lookups =
        ["vec4(vec3(textureSize(tiles, 0).z), 1.0)".to_owned(), "texture(tiles, vec3(0.5, 0.5, 1))".to_owned()];
    assert_eq!(read(&mut session, uniforms, &lookups), [[1.0; 4], [0.0; 4]]);
    paint(&session, "tile_2", 255);
    ready(&session.changed(&["passes/tile_2.png"]));
    assert_eq!(values(&session.render(), 2), [[2.0, 2.0, 2.0, 1.0], [1.0; 4]]);
    std::fs::remove_file(session.tree.path("passes/tile_1.png")).unwrap();
    ready(&session.changed(&["passes/tile_1.png"]));
    assert_eq!(values(&session.render(), 2), [[1.0; 4]; 2]);
}
