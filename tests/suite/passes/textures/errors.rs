//! What cannot be a cube map, a volume or an array is refused, with its line.

use std::path::Path;

use image::RgbaImage;

use super::{columns, sphere};
use crate::support::{assert_same, failed, gpu, lines, ready};

#[test]
fn errors_have_their_line_and_the_picture_stays() {
    let mut session = sphere();
    let before = session.render();
    let save = |path: &Path, width: u32, height: u32| RgbaImage::new(width, height).save(path).unwrap();
    let path = |name: &str| session.tree.path(&format!("passes/{name}.png"));
    for name in ["a_px", "a_nx", "a_py", "a_ny", "a_pz"] {
        save(&path(name), 2, 2);
    }
    for (name, height) in [("b_0", 2), ("b_1", 3), ("b_2", 2), ("b_3", 2), ("b_4", 2), ("b_5", 2)] {
        save(&path(name), 2, height);
        save(&path(&name.replace('b', "c")), 2, 3);
    }
    save(&path("odd"), 5, 7);
    save(&path("twelve"), 12, 8);
    save(&path("square"), 4, 4);
    let (layers, slices, side) = (gpu().max_layers(), gpu().max_volume_size(), gpu().max_cube_size());
    save(&path("layers"), 1, layers + 1);
    save(&path("slices"), 1, slices + 1);
    // Sizes are checked before a picture is decoded, so its pixels may be missing.
    let wide = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", side + 1, (side + 1) * 6);
    session.tree.write("passes/wide.hdr", &wide);
    session.tree.write("passes/table.cube", "LUT_3D_SIZE 2\n");
    session.tree.write(
        "passes/glow.frag",
        "//@pass glow size=1/2\n#version 460\n#include \"pass.glsl\"\nvoid main() { color = vec4(1.0); }\n",
    );
    ready(&session.changed(&["passes/glow.frag"]));
    let cases = [
        (
            "'a_*.png'",
            "samplerCube",
            "\"a_*.png\" has no a_nz.png; expected the six faces px nx py ny pz nz".to_owned(),
        ),
        ("'none_*.png'", "samplerCube", "no face of \"none_*.png\" found; looked for ".into()),
        ("'b_*.png'", "samplerCube", "b_1.png has 2 x 3 pixels, and ".into()),
        ("'c_*.png'", "samplerCube", "c_0.png has 2 x 3 pixels; expected a square face".into()),
        ("'b_*.png'", "sampler2DArray", "b_1.png has 2 x 3 pixels, and ".into()),
        ("'none_*.png'", "sampler3D", "no file matches \"none_*.png\"; looked for ".into()),
        ("'a_*.png'", "sampler2D", "`t` has a `*`, but it is declared as sampler2D".into()),
        ("'a_*_*.png'", "samplerCube", "\"a_*_*.png\": expected one `*`, in the name of the file".into()),
        ("'*/a.png'", "samplerCube", "\"*/a.png\": expected one `*`, in the name of the file".into()),
        ("'square.png'", "samplerCube", "square.png has 4 x 4 pixels; expected six squares (6:1 or 1:6)".into()),
        ("'square.png'", "sampler2DArray", "but nothing says how many layers it has".into()),
        (
            "'square.png'",
            "sampler3D",
            "square.png has 4 x 4 pixels, from which the number of slices does not follow".into(),
        ),
        (
            "'odd.png' layers=3",
            "sampler3D",
            "odd.png has 5 x 7 pixels, which layers=3 divides neither across nor down".into(),
        ),
        ("'twelve.png' layers=4", "sampler2DArray", "3 x 8 side by side or 12 x 2 one above the other".into()),
        ("'odd.png' layers=7", "sampler2D", "`t` has layers=7, but it is declared as sampler2D".into()),
        ("'odd.png' layers=6", "samplerCube", "`t` has layers=6, but it is declared as samplerCube".into()),
        ("'a_*.png' layers=5", "sampler3D", "`t` has layers= and a `*`".into()),
        ("'table.cube'", "samplerCube", "`t` is declared as samplerCube, but a .cube file is a table of colors".into()),
        ("'table.cube'", "sampler3D", "table.cube has 0 colors; LUT_3D_SIZE 2 needs 8".into()),
        ("'table.cube' layers=2", "sampler3D", "but a .cube file has a size of its own".into()),
        ("'gone.png'", "sampler3D", "\"gone.png\" not found; looked for ".into()),
        ("'../../sky_*.png'", "samplerCube", "leaves the shader tree".into()),
        ("'wide.hdr'", "samplerCube", format!("pixels in a face of a cube map; this device has at most {side} a side")),
        (
            &format!("'layers.png' layers={}", layers + 1),
            "sampler2DArray",
            format!("layers.png has {} layers; this device has at most {layers}", layers + 1),
        ),
        (
            &format!("'slices.png' layers={}", slices + 1),
            "sampler3D",
            format!("slices.png has {} slices; this device has at most {slices}", slices + 1),
        ),
    ];
    for (file, glsl, expected) in cases {
        let annotation = format!("//@texture t {}", file.replace('\'', "\""));
        let coordinates = if glsl == "sampler2D" { "vec2(0.5)" } else { "vec3(0.5)" };
        let uniforms = format!("{annotation}\nuniform {glsl} t;");
        let text = columns(&uniforms, &[format!("texture(t, {coordinates})")]);
        let told = lines(failed(&session.save("passes/show.frag", &text)));
        // The caret stands under the file's name or the option, behind the texture's name.
        let is_here = |line: &str| line.contains("show.frag:4:") && !line.contains("show.frag:4:1: ");
        let found = told.iter().any(|line| is_here(line) && line.contains(&expected));
        assert!(found, "{uniforms}\nsays\n{}\nnot\n{expected}", told.join("\n"));
        assert_same(&before, &session.render(), &expected);
    }
    for (uniforms, value, expected) in [
        (
            "uniform samplerCube glow;",
            "texture(glow, vec3(1.0))",
            "4:21: error: `glow` is drawn, so it is no samplerCube",
        ),
        (
            "uniform sampler3D depth;",
            "texture(depth, vec3(1.0))",
            "4:19: error: `depth` is drawn, so it is no sampler3D",
        ),
        ("uniform samplerCube sly;", "texture(sly, vec3(1.0))", "4:21: error: no texture is named `sly`."),
        ("uniform isampler2D t;", "vec4(texture(t, vec2(1.0)))", "4:20: error: a pass cannot have isampler2D `t`"),
        ("uniform usampler3D t;", "vec4(texture(t, vec3(1.0)))", "4:20: error: a pass cannot have usampler3D `t`"),
        (
            "uniform sampler2DShadow t;",
            "vec4(texture(t, vec3(1.0)))",
            "4:25: error: a pass cannot have sampler2DShadow `t`",
        ),
        (
            "uniform samplerCubeShadow t;",
            "vec4(texture(t, vec4(1.0)))",
            "4:27: error: a pass cannot have samplerCubeShadow `t`",
        ),
        ("uniform sampler2DMS t;", "texelFetch(t, ivec2(0), 0)", "4:21: error: a pass cannot have sampler2DMS `t`"),
        ("uniform samplerCube t[2];", "texture(t[0], vec3(1.0))", "4:21: error: a pass cannot have samplerCube[2] `t`"),
        ("//@texture t \"a.png\" layers=0", "vec4(1.0)", "4:29: error: expected layers=1 to layers=65536, found `0`"),
        (
            "//@texture t \"a.png\" cube",
            "vec4(1.0)",
            "4:22: error: expected srgb, linear, repeat, clamp, mirror, min=, mag=, mips, flip or layers=",
        ),
    ] {
        let text = columns(uniforms, &[value.to_owned()]);
        let told = lines(failed(&session.save("passes/show.frag", &text)));
        assert!(told.iter().any(|line| line.contains(expected)), "{text}\nsays\n{}\nnot\n{expected}", told.join("\n"));
        assert_same(&before, &session.render(), expected);
    }
    std::fs::remove_file(session.tree.path("passes/show.frag")).unwrap();
    session.changed(&["passes/show.frag"]);
    let declared = "uniform isampler3D t;\nint used() { return texture(t, vec3(0.0)).x; }\nvoid user_surface(";
    let told = lines(failed(&session.edit("user.glsl", "void user_surface(", declared)));
    let expected = "a pass cannot have isampler3D `t`";
    assert!(told.iter().any(|line| line.contains("user.glsl:") && line.contains(expected)), "{told:#?}");
}
