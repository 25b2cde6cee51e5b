use super::*;

const TEXT: &str = "#define HALF_PI 1.57 // half a turn\n#define F(x) \\\n  (x)\nstruct Hit { vec3 normal_ws, point; float roughness[2]; };\n\
    layout(set = 0) uniform Frame { float time; /* s */ vec2 size; } frame;\nlayout(set = 1) uniform Params {\n    float sparkle; //@ui \"Sparkle\" 0..1\n};\n\
    layout(buffer_reference) readonly buffer Hits { Hit at[]; };\n// The gain.\nconst float GAIN = 2.0, OFFSET = f(1, 2);\nfloat later(vec3 v);\n\n\
    // Luminance.\n//   Y = ...\nfloat luminance(const in vec3 radiance, inout float[2] more) {\n    float weight = 1.0, scale;\n    \
    for (int i = 0, n = 2; i < n; i++) { vec2 corner = vec2(i, 0.0); }\n    if (weight > 0.0) { float inner = weight; } else scale = 1.0;\n    \
    Hit hit;\n    return weight;\n}\n//@pass glow \"Glow\"\nvoid main() { Hit hit[3]; float exposure = GAIN; }\n";

fn named<'a>(symbols: &'a Symbols, name: &str) -> &'a Symbol {
    symbols.all.iter().find(|symbol| symbol.name == name).unwrap_or_else(|| panic!("no {name} in {symbols:#?}"))
}

fn names(symbols: &Symbols, place: &str) -> String {
    let at = TEXT.find(place).unwrap();
    symbols.locals(at).map(|symbol| symbol.name.as_str()).collect::<Vec<_>>().join(" ")
}

#[test]
fn declarations_are_found_with_kind_and_type() {
    let symbols = Symbols::of(TEXT);
    let shown: Vec<String> = symbols
        .all
        .iter()
        .map(|s| {
            format!("{:?} {}{}{} {}", s.kind, s.owner, if s.owner.is_empty() { "" } else { "." }, s.name, s.type_name)
        })
        .map(|line| line.trim_end().to_owned())
        .collect();
    let expected = [
        "Macro HALF_PI",
        "Macro F",
        "Struct Hit",
        "Member Hit.normal_ws vec3",
        "Member Hit.point vec3",
        "Member Hit.roughness float",
        "Block Frame",
        "Member Frame.time float",
        "Member Frame.size vec2",
        "Variable frame Frame",
        "Block Params",
        "Variable sparkle float",
        "Struct Hits",
        "Member Hits.at Hit",
        "Constant GAIN float",
        "Constant OFFSET float",
        "Function later float",
        "Parameter v vec3",
        "Function luminance float",
        "Parameter radiance vec3",
        "Parameter more float",
        "Variable weight float",
        "Variable scale float",
        "Variable i int",
        "Variable n int",
        "Variable corner vec2",
        "Variable inner float",
        "Variable hit Hit",
        "Pass glow",
        "Function main void",
        "Variable hit Hit",
        "Variable exposure float",
    ];
    assert_eq!(shown, expected);
    let dimensions = ["at", "roughness", "more", "hit"].map(|name| named(&symbols, name).dimensions);
    assert_eq!(dimensions, [1, 1, 1, 0]);
    assert!(symbols.all.iter().all(|symbol| TEXT[symbol.bytes.clone()] == symbol.name));
}

#[test]
fn scopes_end_with_their_blocks() {
    let symbols = Symbols::of(TEXT);
    assert_eq!(names(&symbols, "1.0, scale"), "more radiance");
    assert_eq!(names(&symbols, "0.0); }"), "n i scale weight more radiance");
    assert_eq!(names(&symbols, "else scale"), "scale weight more radiance");
    assert_eq!(names(&symbols, "return weight"), "hit scale weight more radiance");
    assert_eq!(names(&symbols, "GAIN; }"), "hit");
    assert_eq!(names(&symbols, "GAIN = 2.0"), "");
}

#[test]
fn comments_and_signatures_are_those_of_the_author() {
    let symbols = Symbols::of(TEXT);
    let comment = |name: &str| comment_of(TEXT, named(&symbols, name));
    assert_eq!(comment("luminance").as_deref(), Some("Luminance.\n  Y = ..."));
    assert_eq!(comment("GAIN").as_deref(), Some("The gain."));
    assert_eq!(comment("HALF_PI").as_deref(), Some("half a turn"));
    assert_eq!(comment("sparkle").as_deref(), Some("@ui \"Sparkle\" 0..1"));
    assert_eq!(comment("later"), None);
    let signature = |name: &str| &TEXT[named(&symbols, name).signature.clone()];
    assert_eq!(signature("luminance"), "float luminance(const in vec3 radiance, inout float[2] more)");
    assert_eq!(signature("weight"), "float weight");
    let function = named(&symbols, "luminance");
    let parameters: Vec<&str> = function.parameters.iter().map(|bytes| &TEXT[bytes.clone()]).collect();
    assert_eq!(parameters, ["const in vec3 radiance", "inout float[2] more"]);
    assert!(TEXT[function.whole.clone()].ends_with("return weight;\n}"));
}

#[test]
fn text_that_is_being_typed_keeps_its_names() {
    let text = "float f(float x) {\n    float a = 1.0;\n    s.\n    float b = a;\n    g(a,\n    float c = b;\n    if (c > 0.0) {\n    \
        return c;\n}\n\nfloat h(float y) { float d = y; return d; }\n";
    let symbols = Symbols::of(text);
    let names: Vec<&str> = symbols.all.iter().map(|symbol| symbol.name.as_str()).collect();
    assert_eq!(names, ["f", "x", "a", "b", "c", "h", "y", "d"]);
    for cut in 0..TEXT.len() {
        Symbols::of(&TEXT[..cut]);
        Symbols::of(&TEXT[cut..]);
    }
}

#[test]
fn nothing_is_too_deep_or_too_odd() {
    for text in
        ["{", "(", "[", "if (", "for (", "float f() { if (x) ", "struct S {", "#define ", "//@pass ", "}", "layout("]
    {
        Symbols::of(&text.repeat(20_000));
    }
    assert_eq!(Symbols::of(""), Symbols::default());
}
