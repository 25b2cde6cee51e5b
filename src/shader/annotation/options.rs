//! The options of annotations with what they mean, for editors. The parsers decide what is valid; tests compare both.

/// An annotation.
#[derive(Clone, Copy, Debug)]
pub struct Described {
    /// The word behind `//@`.
    pub keyword: &'static str,
    /// The thing that it declares.
    pub doc: &'static str,
    /// The text that an editor inserts behind the keyword.
    pub example: &'static str,
    /// Its options.
    pub options: &'static [DescribedOption],
}

/// An option of an annotation.
#[derive(Clone, Copy, Debug)]
pub struct DescribedOption {
    /// Its name, with `=` at the end if a value follows.
    pub name: &'static str,
    /// The values that it can have; an example for others, in quotes for text.
    pub values: &'static [&'static str],
    /// Its meaning.
    pub doc: &'static str,
}

const fn option(name: &'static str, values: &'static [&'static str], doc: &'static str) -> DescribedOption {
    DescribedOption { name, values, doc }
}

/// The annotation with this keyword.
pub fn described(keyword: &str) -> Option<&'static Described> {
    ANNOTATIONS.iter().find(|known| known.keyword == keyword)
}

/// All annotations.
#[rustfmt::skip]
pub const ANNOTATIONS: &[Described] = &[
    Described {
        keyword: "ui",
        doc: "A slider, list, switch or color for the declaration on this line or the next: a member of Params, or a constant_id. The label comes first, then range, choices and options, and the default last.",
        example: "\"Label\" 0..1 = 0.5",
        options: &[
            option("choice", &["A=0 B=1"], "Names of the values of an int or uint, each with its number and perhaps a sentence in quotes."),
            option("color", &[], "A color picker for a vec3 or vec4, linear RGB."),
            option("group=", &["\"Material\""], "The heading under which the panel shows it."),
            option("doc=", &["\"\""], "A sentence for people."),
            option("unit=", &["\"m\""], "The unit of the value."),
            option("when=", &["BLOOM"], "A constant with //@ui: the slider is shown while that is on."),
            option("conserves=", &["\"A\""], "The choices that guarantee that no energy is gained."),
            option("reciprocal=", &["\"A\""], "The choices that guarantee the same value for both directions."),
        ],
    },
    Described {
        keyword: "mode",
        doc: "A debug mode with the number of the constant on the next line.",
        example: "name \"Name\" group=\"Mine\" encode=data components=1 doc=\"\"",
        options: &[
            option("group=", &["\"Mine\""], "The heading in lists."),
            option("encode=", &["color", "data", "vector"], "How the picture stores the value: with the sRGB curve, unchanged, or as v * 0.5 + 0.5."),
            option("components=", &["1", "2", "3"], "Components of a value."),
            option("unit=", &["\"m\""], "The unit of the value, before exposure."),
            option("stage=", &["debug", "paths", "pbr"], "The stage that computes the value."),
            option("range=", &["0..1"], "The values that the picture shows as 0 and 1."),
            option("colormap=", &["viridis", "magma", "turbo", "coolwarm", "heat"], "Colors that stand for a number."),
            option("numbers=", &["index", "\"front|back\""], "The meaning of the numbers that `number_or_color` shows as colors."),
            option("colors=", &["\"#3fbc59|-\""], "sRGB colors of the names in numbers=, for the legend."),
            option("tonemap", &[], "The value is light: exposure and tone map apply."),
            option("accumulate", &[], "The value is an estimate; frames are averaged."),
            option("traces", &[], "Rays can be traced through the model, in paths.frag."),
            option("through", &[], "Transmissive surfaces show the final picture behind them."),
            option("draw=", &["surfaces", "lines", "layers"], "Surfaces, edges of triangles, or the sum of all fragments."),
            option("needs=", &["clearcoat", "sheen,volume"], "Features of materials or light without which there is nothing to see."),
            option("key=", &["d"], "The letter key that selects it."),
            option("words=", &["\"\""], "More words by which a search finds it."),
            option("doc=", &["\"\""], "A sentence for people."),
        ],
    },
    Described {
        keyword: "pass",
        doc: "A step of the picture: this file draws it. Stands in a .frag or .comp.",
        example: "name \"Label\" to=picture",
        options: &[
            option("to=", &["picture", "peel", "resolve", "mean", "display"], "What it draws to, in place of an image with its own name."),
            option("after=", &["tonemap"], "A pass that comes before it."),
            option("size=", &["1/2", "512", "512x256"], "The size of its image: a part of the frame's, or pixels."),
            option("format=", &["rgba16f", "rgba32f", "rgba8", "rg16f", "rg32f", "r16f", "r32f"], "The format of its image."),
            option("also=", &["normals:rgba16f"], "Further images, for the outputs at locations 1 and up."),
            option("draw=", &["model", "quads", "background"], "What it draws, in place of one triangle over its image."),
            option("instances=", &["8", "lights"], "How often it draws the model."),
            option("cull=", &["none", "front", "back"], "The faces that it leaves out."),
            option("blend", &[], "Its colors, premultiplied by alpha, are blended with the picture."),
            option("instead=", &["model"], "The pass that it replaces in the modes that name its stage."),
            option("dispatch=", &["size", "64", "8x8x1"], "The workgroups of a compute pass."),
            option("when=", &["BLOOM"], "The constant that switches it on."),
            option("mips", &[], "Its image has mip levels."),
            option("keep", &[], "Its image of the previous frame is kept, as before_NAME."),
            option("off", &[], "It is off until the user switches it on."),
            option("doc=", &["\"\""], "A sentence for people."),
        ],
    },
    Described {
        keyword: "texture",
        doc: "An image file of the tree, which shaders read by this name: `uniform sampler2D NAME;`.",
        example: "name \"file.png\" srgb repeat mips",
        options: &[
            option("srgb", &[], "Its colors are sRGB-encoded; shaders read linear light."),
            option("linear", &[], "Its numbers are read as they are."),
            option("repeat", &[], "It repeats beyond its edges."),
            option("clamp", &[], "The texels at its edges are repeated."),
            option("mirror", &[], "It repeats, every other time as its mirror image."),
            option("min=", &["nearest", "linear"], "The filter where it is made smaller."),
            option("mag=", &["nearest", "linear"], "The filter where it is made larger."),
            option("mips", &[], "It has mip levels."),
            option("flip", &[], "The first row is at the bottom, as in OpenGL."),
            option("layers=", &["8"], "The number of layers or slices in one image."),
        ],
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::annotation::parse::parse_file;

    /// A text in which an option has this value.
    fn text(keyword: &str, option: &str) -> String {
        let before = match option.split(['=', ' ']).next().unwrap() {
            "conserves" | "reciprocal" => "choice A=0 ",
            "colors" => "numbers=\"a|b\" ",
            "traces" => "stage=paths ",
            _ => "",
        };
        let is_constant = before.starts_with("choice");
        match keyword {
            "ui" if is_constant => format!("layout(constant_id = 40) const uint A = 0u; //@ui {before}{option}\n"),
            "ui" if option == "color" => "vec3 tint; //@ui color\n".to_owned(),
            "ui" if option.starts_with("choice") => format!("int kind; //@ui {option}\n"),
            "ui" => format!("float rim; //@ui {option}\n"),
            "mode" => format!("//@mode own \"Own\" {before}{option}\nconst uint MODE_OWN = 1000u;\n"),
            "pass" => format!("//@pass own {option}\n"),
            _ => format!("//@texture own \"own.png\" {option}\n"),
        }
    }

    #[test]
    fn the_parsers_take_every_option_with_its_values() {
        for known in ANNOTATIONS {
            for option in known.options {
                let separator = if option.name.ends_with('=') { "" } else { " " };
                let with_values = option.values.iter().map(|value| format!("{}{separator}{value}", option.name));
                let all: Vec<String> =
                    if option.values.is_empty() { vec![option.name.to_owned()] } else { with_values.collect() };
                for option in all {
                    let (found, errors) = parse_file("a.frag", &text(known.keyword, &option));
                    assert!(errors.is_empty() && found.len() == 1, "{} {option}: {errors:#?}", known.keyword);
                }
            }
            let declared = if known.keyword == "ui" { "float rim; " } else { "" };
            let example = format!("{declared}//@{} {}\nconst uint MODE_OWN = 1000u;\n", known.keyword, known.example);
            let (found, errors) = parse_file("a.frag", &example);
            assert!(errors.is_empty() && found.len() == 1, "{example}: {errors:#?}");
        }
    }

    /// The messages about unknown options list all that the parsers know.
    #[test]
    fn every_option_of_the_parsers_is_described() {
        for known in ANNOTATIONS {
            let (_, errors) = parse_file("a.frag", &text(known.keyword, "no_such_option"));
            let listed = errors[0].message.split(", found").next().unwrap().to_owned();
            let words = listed.split([',', ' ']).filter(|word| {
                let name =
                    word.trim_end_matches(|c: char| !c.is_ascii_lowercase()).split('=').next().unwrap_or_default();
                !name.is_empty()
                    && name.chars().all(|c| c.is_ascii_lowercase())
                    && !["expected", "or", "lo..hi", "default"].contains(&name)
            });
            for word in words {
                let name = word.split('=').next().unwrap();
                let is_described = known.options.iter().any(|option| option.name.trim_end_matches('=') == name);
                assert!(is_described, "//@{}: `{name}` of `{listed}` is not described", known.keyword);
            }
        }
    }
}
