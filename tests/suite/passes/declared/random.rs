//! Random graphs of passes.

use super::{pass, sequence, sphere};
use crate::support::{SIZE, assert_same, assert_validated, is_long, lines, ready};

/// A small generator of pseudo-random numbers: xorshift32 (Marsaglia 2003, "Xorshift RNGs").
struct Random(u32);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 % end
    }
}

/// The passes of a random graph: each reads up to three images of those before it, of any of them one frame ago, the picture and
/// depth. What is drawn with the model reads images of the frame before alone, since the others may need the model.
fn random_graph(random: &mut Random) -> Vec<(String, String)> {
    let count = 1 + random.below(6);
    let (mut kept, mut with_image): (Vec<String>, Vec<String>) = Default::default();
    let mut files = Vec::new();
    for index in 0..count {
        let name = format!("p{index}");
        let to_picture = random.below(3) == 0;
        let is_compute = !to_picture && random.below(4) == 0;
        let draws_model = !is_compute && random.below(4) == 0;
        let with_model = draws_model && to_picture;
        let mut annotation = name.clone();
        // Every device can write the first four formats from a compute shader.
        let formats = ["rgba16f", "rgba32f", "rgba8", "r32f", "rg16f", "r16f", "rg32f"];
        let format = formats[random.below(if is_compute { 4 } else { 7 }) as usize];
        if to_picture {
            annotation += " to=picture";
            if !draws_model {
                annotation += ["", " after=tonemap"][random.below(2) as usize];
            }
        } else {
            let sizes = ["1", "1/2", "1/7", "16x16", "1x1", "33x9"];
            annotation += &format!(" size={} format={format}", sizes[random.below(6) as usize]);
            if random.below(2) == 0 {
                annotation += " keep";
                kept.push(name.clone());
            } else if !is_compute && random.below(2) == 0 {
                annotation += " mips";
            }
        }
        if draws_model {
            annotation += [" draw=model", " instances=2", " draw=model instances=lights"][random.below(3) as usize];
        }
        let mut also = None;
        if !to_picture && !is_compute && random.below(3) == 0 {
            also = Some(format!("{name}_also"));
            kept.extend(also.clone().filter(|_| annotation.contains(" keep")));
            annotation += &format!(" also={name}_also:{}", formats[random.below(7) as usize]);
        }
        if with_model {
            annotation += ["", " blend", " cull=front", " cull=none blend"][random.below(4) as usize];
        }
        annotation += ["", "", " off"][random.below(3) as usize];
        let mut reads: Vec<String> = Vec::new();
        for _ in 0..random.below(4) {
            let other = random.below(index + 1);
            reads.push(match random.below(4) {
                0 | 1 if with_model => continue,
                0 => "picture".into(),
                1 => "depth".into(),
                2 if !kept.is_empty() => format!("before_{}", kept[random.below(kept.len() as u32) as usize]),
                _ if !with_image.is_empty() && !with_model => with_image[other as usize % with_image.len()].clone(),
                _ => continue,
            });
        }
        reads.sort();
        reads.dedup();
        let uniforms: String = reads.iter().map(|name| format!("uniform sampler2D {name};\n")).collect();
        let sum: String = reads.iter().map(|name| format!(" + 0.3 * textureLod({name}, at, 0.0)")).collect();
        if !to_picture {
            with_image.push(name.clone());
            with_image.extend(also.clone());
        }
        let (declared, written) = match &also {
            Some(also) => (format!("layout(location = 1) out vec4 {also};\n"), format!(" {also} = color.bgra;")),
            None => Default::default(),
        };
        if is_compute {
            let head = "#version 460\n#include \"interface.glsl\"\nlayout(local_size_x = 8, local_size_y = 4) in;";
            let text = format!(
                "//@pass {annotation}\n{head}\nlayout({format}) uniform writeonly image2D {name};\n{uniforms}\
                 void main() {{\n    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);\n    \
                 if (any(greaterThanEqual(texel, imageSize({name})))) return;\n    \
                 vec2 at = (vec2(texel) + 0.5) / vec2(imageSize({name}));\n    \
                 imageStore({name}, texel, vec4(0.1){sum});\n}}\n"
            );
            files.push((format!("passes/{name}.comp"), text));
        } else if draws_model {
            let text = format!(
                "//@pass {annotation}\n#version 460\nlayout(location = 0) out vec4 color;\n{declared}{uniforms}\
                 void main() {{\n    vec2 at = gl_FragCoord.xy / 64.0;\n    color = vec4(0.1){sum};{written}\n}}\n"
            );
            files.push((format!("passes/{name}.frag"), text));
        } else {
            let body = format!("    vec2 at = uv;\n    color = vec4(0.1){sum};{written}");
            files.push((format!("passes/{name}.frag"), pass(&annotation, &(declared + &uniforms), &body)));
        }
    }
    files
}

/// Random graphs with switches, edits and other sizes between frames: no good graph is refused, and the validation layers stay silent.
#[test]
fn random_graphs_are_drawn_without_a_message() {
    let mut random = Random(0x9e37_79b9);
    let mut session = sphere(&[]);
    let mut drawn = 0;
    let graphs = if is_long() { 300 } else { 24 };
    for graph in 0..graphs {
        session.set(["view.msaa=1", "view.msaa=4"][random.below(2) as usize]);
        let files = random_graph(&mut random);
        for (file, text) in &files {
            session.tree.write(file, text);
        }
        let names: Vec<&str> = files.iter().map(|(file, _)| file.as_str()).collect();
        let reload = session.changed(&names);
        if let specula::pipeline::Outcome::Failed(diagnostics) = &reload.outcome {
            panic!("graph {graph}: {}\n{files:#?}", lines(diagnostics).join("\n"));
        }
        for _ in 0..2 {
            for (file, _) in &files {
                let name = file.trim_start_matches("passes/").split('.').next().unwrap();
                session.set(&format!("passes.{name}={}", random.below(3) != 0));
            }
            session.headless.set_size([SIZE, (33, 70), (7, 5), (1, 1)][random.below(4) as usize]).unwrap();
            let first = sequence(&mut session, 3);
            assert_same(&first, &sequence(&mut session, 3), &format!("graph {graph}: {files:#?}"));
            // The same with no image that passes share: those that are kept are each pass's own.
            for (file, text) in &files {
                let is_kept = text.lines().next().is_some_and(|line| line.contains(" keep"));
                let text = if is_kept { text.clone() } else { text.replacen(" format=", " keep format=", 1) };
                session.tree.write(file, &text);
            }
            session.changed(&names);
            assert_same(&first, &sequence(&mut session, 3), &format!("graph {graph}, each image kept: {files:#?}"));
            files.iter().for_each(|(file, text)| session.tree.write(file, text));
            session.changed(&names);
            drawn += 1;
        }
        session.headless.settings_mut().passes.clear();
        for name in &names {
            std::fs::remove_file(session.tree.path(name)).unwrap();
        }
        ready(&session.changed(&names));
    }
    assert_eq!(drawn, 2 * graphs);
    assert_validated();
}
