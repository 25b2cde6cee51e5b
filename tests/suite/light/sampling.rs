//! The shaders' random numbers, against the paper's hash in Rust.

use crate::support::{Session, glb, load, ready, settings};

/// pcg3d (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering"): x, y and z are updated one after the other.
fn pcg3d(seed: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = seed.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let round = |x: &mut u32, y: &mut u32, z: &mut u32| {
        *x = x.wrapping_add(y.wrapping_mul(*z));
        *y = y.wrapping_add(z.wrapping_mul(*x));
        *z = z.wrapping_add(x.wrapping_mul(*y));
    };
    round(&mut x, &mut y, &mut z);
    [x, y, z] = [x, y, z].map(|word| word ^ (word >> 16));
    round(&mut x, &mut y, &mut z);
    [x, y, z]
}

/// A mode that shows random_numbers of a seed that contains the pixel's column and row, and the value that Rust expects.
fn assert_random(seed: &str, words: fn(u32, u32) -> [u32; 3]) {
    let mut session = Session::new(
        load(&glb::model(&glb::quad(1.0), &glb::gray())),
        settings(&["view.msaa=1", "view.background=none", "environment.name=none"]),
    );
    let mode = format!(
        "#include \"common/sampling.glsl\"\n\
         //@mode random \"Random\" group=\"Mine\" encode=data doc=\"Random numbers.\"\n\
         const uint MODE_RANDOM = 1000u;\n\
         bool your_mode(Fragment f, Surface s, vec3 v, out vec3 value) {{\n\
             uvec2 p = uvec2(gl_FragCoord.xy);\n\
             value = random_numbers({seed});\n\
             return MODE == MODE_RANDOM;\n}}\n#endif\n"
    );
    let modes = session.tree.read("debug/modes.glsl");
    let at = modes.find("bool your_mode(").unwrap();
    ready(&session.save("debug/modes.glsl", &format!("{}{mode}", &modes[..at])));
    let picture = session.mode("random");
    let mut count = 0;
    for (i, value) in picture.raw.iter().enumerate().filter(|(_, value)| value[3] == 1.0) {
        let (x, y) = (i as u32 % picture.width, i as u32 / picture.width);
        // 24 bits of each word are exact in a float.
        let expected = pcg3d(words(x, y)).map(|word| (word >> 8) as f32 / 16_777_216.0);
        assert_eq!(value[..3], expected, "{seed} at {x}, {y}");
        count += 1;
    }
    assert!(count > 300, "the model covers {count} pixels only");
}

#[test]
fn random_numbers_of_pixel_and_sample_are_pcg3d() {
    assert_random("uvec3(p, 7u)", |x, y| [x, y, 7]);
}

#[test]
fn equal_seeds_give_three_different_numbers() {
    assert_random("uvec3(p.x)", |x, _| [x; 3]);
    assert!((0..96).all(|x| pcg3d([x; 3])[0] != pcg3d([x; 3])[1]));
}
