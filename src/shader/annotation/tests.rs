//! Annotations read from compiled shaders.

use super::*;
use crate::interface;
use crate::shader::compile::Compiler;
use crate::shader::source::Source;

fn read_text(text: &str) -> Result<Annotations, Vec<Diagnostic>> {
    let interface = interface::glsl();
    let text = format!("#version 460\n#include \"interface.glsl\"\n{text}\nvoid main() {{}}\n");
    let source = Source::memory([("m.frag", text.as_str()), ("interface.glsl", &interface)]);
    let snapshot = Snapshot::new(&source);
    let compiled = Compiler::new().unwrap().compile(&snapshot, &"m.frag".into());
    let reflection = Reflection::of(&compiled.result.unwrap());
    read(&snapshot, &compiled.dependencies, &[&reflection], true)
}

#[track_caller]
fn refused(text: &str, expected: &str) {
    let errors: Vec<String> = read_text(text).unwrap_err().iter().map(Diagnostic::one_line).collect();
    assert_eq!(errors, [expected]);
}

const PARAMS: &str = "layout(set = SET_FRAME, binding = BINDING_PARAMS, scalar) uniform Params {";

#[test]
fn modes_in_the_order_of_their_ids() {
    let modes = read_text(
        "//@mode d \"Normal distribution D\" group=\"BRDF terms\" encode=data doc=\"GGX: eq. 33\"\n\
         const uint MODE_BRDF_D = 120u;\n\
         const uint MODE_FINAL = 0u; //@mode final \"Final\" encode=color tonemap accumulate key=p\n\
         // not one: //@mode nonsense\n/*\n//@mode nonsense\n*/",
    )
    .unwrap()
    .modes;
    let rows: Vec<_> =
        modes.iter().map(|mode| (mode.id, mode.slug.as_str(), mode.line, mode.tonemap, mode.key)).collect();
    assert_eq!(rows, [(0, "final", 5, true, Some('p')), (120, "d", 3, false, None)]);
    assert_eq!((modes[0].accumulate, modes[1].accumulate), (true, false));
    assert_eq!(
        (modes[1].group.as_str(), modes[1].encode, modes[1].doc.as_str()),
        ("BRDF terms", Encode::Data, "GGX: eq. 33")
    );
}

#[test]
fn units_and_components_of_modes() {
    let modes = read_text(
        "const uint MODE_A = 1u; //@mode a \"A\" unit=\"cd/m^2\"\n\
         const uint MODE_B = 2u; //@mode b \"B\" components=1 unit=m",
    )
    .unwrap()
    .modes;
    let rows: Vec<_> = modes.iter().map(|mode| (mode.components, mode.unit.as_str())).collect();
    assert_eq!(rows, [(3, "cd/m^2"), (1, "m")]);
    // External programs rely on the fields of the JSON.
    let json = serde_json::to_value(&modes[0]).unwrap();
    assert!(json.get("unit").is_none() && json.get("components").is_none(), "{json}");
    refused(
        "const uint MODE_A = 1u; //@mode a \"A\" components=4",
        "m.frag:3:50: error: expected components=1, components=2 or components=3, found `4`",
    );
}

#[test]
fn modes_have_words_for_searches() {
    let found = read_text("const uint MODE_A = 1u; //@mode a \"A\" words=\"facing culling\" doc=\"B\"").unwrap();
    assert_eq!((&*found.modes[0].words, &*found.modes[0].doc), ("facing culling", "B"));
}

#[test]
fn numbers_of_modes_have_a_meaning() {
    let numbers = |text: &str| {
        let found = read_text(&format!("const uint MODE_A = 1u; //@mode a \"A\" {text}")).unwrap();
        found.modes[0].numbers.clone()
    };
    assert_eq!(numbers(""), None);
    assert_eq!(numbers("numbers=index"), Some(Numbers::Index));
    let names = ["front", "far back"].map(str::to_owned).to_vec();
    assert_eq!(numbers("numbers=\"front|far back\""), Some(Numbers::Names(names)));
    for wrong in ["front", "front|"] {
        refused(
            &format!("const uint MODE_A = 1u; //@mode a \"A\" numbers={wrong}"),
            &format!("m.frag:3:47: error: expected numbers=index or names as numbers=\"front|back\", found `{wrong}`"),
        );
    }
}

#[test]
fn named_numbers_have_colors() {
    let text = |options: &str| format!("const uint MODE_A = 1u; //@mode a \"A\" {options}");
    let found = read_text(&text("numbers=\"front|back\" colors=\"#3fbc59|-\"")).unwrap();
    assert_eq!(found.modes[0].number_colors, [Some([0x3f, 0xbc, 0x59]), None]);
    let expected = "expected a color for each name of the numbers= before it, as numbers=\"front|back\" \
                    colors=\"#3fbc59|-\"";
    for (options, column, value) in [
        ("colors=\"#3fbc59\"", 46, "#3fbc59"),
        ("numbers=index colors=\"-\"", 60, "-"),
        ("numbers=\"a|b\" colors=\"-\"", 60, "-"),
        ("numbers=\"a|b\" colors=\"-|red\"", 60, "-|red"),
    ] {
        refused(&text(options), &format!("m.frag:3:{column}: error: {expected}, found `{value}`"));
    }
}

/// The author sees the line that works, with her values.
#[test]
fn a_wrong_order_is_shown_in_order() {
    for (note, message, sorted) in [
        ("0..1 \"Rim\" = 0.2", "expected the label before all else, found `\"Rim\"` here", "\"Rim\" 0..1 = 0.2"),
        ("\"Rim\" = 0.2 0..1", "expected a number, since the default comes last, found `0..1`", "\"Rim\" 0..1 = 0.2"),
    ] {
        let errors = read_text(&format!("{PARAMS}\nfloat a; //@ui {note}\n}};")).unwrap_err();
        assert!(errors[0].message.ends_with(message), "{errors:?}");
        let help = format!("the label comes first and the default last: `//@ui {sorted}`");
        assert_eq!(errors[0].help.as_deref(), Some(help.as_str()));
        read_text(&format!("{PARAMS}\nfloat a; //@ui {sorted}\n}};")).unwrap();
    }
}

#[test]
fn constants_and_parameters() {
    let found = read_text(&format!(
        "layout(constant_id = USER_CONSTANTS + 1) const uint NDF_MODEL = 1u; //@ui \"NDF\" choice GGX=0 Beckmann=1\n\
         layout(constant_id = USER_CONSTANTS + 0) const bool WRAP_DIFFUSE = true; //@ui\n\
         {PARAMS}\n float rim; //@ui \"Rim\" 0..1 = 0.2\n vec3 rim_color; //@ui color = 1 0.8 0.6\n float hidden;\n\
         //@ui -1.5..2\n int steps_taken;\n bool on; //@ui = true\n}};"
    ))
    .unwrap();
    let constants: Vec<_> = found.constants.iter().map(|c| (c.id, c.label.as_str(), c.default)).collect();
    assert_eq!(constants, [(32, "Wrap diffuse", 1), (33, "NDF", 1)]);
    assert_eq!(found.constants[1].choices, [("GGX".to_owned(), 0), ("Beckmann".to_owned(), 1)]);
    let rows: Vec<_> = found
        .parameters
        .iter()
        .map(|p| (p.name.as_str(), p.label.as_str(), p.offset.unwrap(), p.default.clone()))
        .collect();
    let expected = [
        ("rim", "Rim", 0, vec![0.2]),
        ("rim_color", "Rim color", 4, vec![1.0, 0.8, 0.6]),
        ("steps_taken", "Steps taken", 20, vec![0.0]),
        ("on", "On", 24, vec![1.0]),
    ];
    assert_eq!(rows, expected);
    assert!(found.parameters[1].color);
    assert_eq!(found.parameters[2].range, Some((-1.5, 2.0)));
}

#[test]
fn words_for_people_stand_anywhere_before_the_default() {
    let found = read_text(&format!(
        "layout(constant_id = 40) const uint C = 0u; //@ui doc=\"One = first.\" choice A=0 B=1 group=Mine\n\
         {PARAMS}\n float far; //@ui \"Far\" group=\"My lens\" 0..9 unit=m doc=\"0..9 = near\" = 2\n float near; //@ui\n}};"
    ))
    .unwrap();
    let constant = &found.constants[0];
    assert_eq!((constant.doc.as_str(), constant.group.as_str(), constant.unit.as_str()), ("One = first.", "Mine", ""));
    let words: Vec<_> = found.parameters.iter().map(|p| [&*p.group, &*p.doc, &*p.unit]).collect();
    assert_eq!(words, [["My lens", "0..9 = near", "m"], ["", "", ""]]);
    assert_eq!((found.parameters[0].range, &*found.parameters[0].default), (Some((0.0, 9.0)), &[2.0][..]));
    refused(
        "layout(constant_id = 40) const uint C = 0u; //@ui doc=",
        "m.frag:3:55: error: expected a value after `doc=`, found the end of the line",
    );
}

#[test]
fn claims_name_choices() {
    let constant = |ui: &str| format!("layout(constant_id = 40) const uint C = 0u; //@ui choice A=0 B=1 {ui}");
    let claims = |ui: &str| {
        let found = read_text(&constant(ui)).unwrap().constants.remove(0);
        (found.conserves, found.reciprocal)
    };
    let names = |names: &[&str]| Some(names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>());
    assert_eq!(claims(""), (None, None));
    assert_eq!(claims("conserves=\"A B\""), (names(&["A", "B"]), None));
    // An empty claim is not the same as no claim.
    assert_eq!(claims("reciprocal=B conserves=\"\""), (names(&[]), names(&["B"])));
    let unknown = "m.frag:3:76: error: expected names of the choices before `conserves=`, found `C`";
    refused(&constant("conserves=\"A C\""), unknown);
    let unknown = "m.frag:3:77: error: expected names of the choices before `reciprocal=`, found `a`";
    refused(&constant("reciprocal=a"), unknown);
    // Without choices, no name can be claimed.
    let unknown = "m.frag:3:61: error: expected names of the choices before `conserves=`, found `A`";
    refused("layout(constant_id = 40) const uint C = 0u; //@ui conserves=A", unknown);
}

#[test]
fn what_does_not_parse_says_what_was_expected() {
    refused(
        "//@mod d \"D\"\nint a;",
        "m.frag:3:1: error: expected `//@mode`, `//@ui`, `//@pass` or `//@texture`, found `//@mod`. Did you mean `//@mode`?",
    );
    refused(
        "//@mode D \"D\"\nconst uint M = 1u;",
        "m.frag:3:9: error: expected the mode's slug in a-z, 0-9 and `-`, found `D`",
    );
    refused("//@mode d D\nconst uint M = 1u;", "m.frag:3:11: error: expected the mode's name in quotes, found `D`");
    refused("//@mode d \"D\nconst uint M = 1u;", "m.frag:3:11: error: expected a closing quote");
    refused(
        "//@mode d \"D\"\nint a;",
        "m.frag:3:1: error: expected `const uint NAME = NUMBER;` with the mode, found `int a;`",
    );
    refused(
        "const uint M = 1u; //@mode d \"D\" encode=rgb",
        "m.frag:3:41: error: expected encode=color, encode=data or encode=vector, found `rgb`",
    );
    refused(
        "const uint M = 1u; //@mode d \"D\" colour=1",
        "m.frag:3:34: error: expected group=, encode=, components=, unit=, stage=, tonemap, accumulate, traces, through, draw=, \
         needs=, range=, colormap=, numbers=, colors=, key=, words= or doc=, found `colour`",
    );
    let errors = read_text("const uint M = 1u; //@mode d \"D\" needs=sheen,clearcot").unwrap_err();
    let needs =
        "expected features of materials after needs=, found `clearcot`. Did you mean `clearcoat`? They are unlit, ";
    assert!(errors[0].message.starts_with(needs), "{}", errors[0].message);
    refused(
        "const uint M = 1u; //@mode d \"D\" accumulate accumulate",
        "m.frag:3:45: error: `accumulate` is given twice",
    );
    refused(
        &format!("{PARAMS}\nfloat a; //@ui 1..0\n}};"),
        "m.frag:4:16: error: expected a range lo..hi with lo < hi, found `1..0`",
    );
    refused(
        &format!("{PARAMS}\nvec3 a; //@ui = 1 2\n}};"),
        "m.frag:4:16: error: expected 3 number(s) after `=`, found 2",
    );
    refused(
        &format!("{PARAMS}\nfloat a; //@ui = x\n}};"),
        "m.frag:4:18: error: expected a number, since the default comes last, found `x`",
    );
    refused(
        &format!("{PARAMS}\nmat4 a; //@ui\n}};"),
        "m.frag:4:1: error: expected float, int, uint, bool, vec2, vec3 or vec4 before the name, found `mat4`",
    );
    refused(
        "float a; //@ui",
        "m.frag:3:7: error: `a` is no member of the block at SET_FRAME, BINDING_PARAMS in any compiled stage",
    );
    let ui = "layout(constant_id = 40) const uint C = 0u; //@ui";
    refused(&format!("{ui} choice A"), "m.frag:3:58: error: expected NAME=NUMBER after `choice`, found `A`");
    refused(
        &format!("{ui} = 1"),
        "m.frag:3:51: error: a constant's default stands in its declaration, not after //@ui",
    );
}

#[test]
fn values_must_fit_their_types_and_choices() {
    let constant = |kind: &str, ui: &str| format!("layout(constant_id = 40) const {kind} C = {kind}(0); //@ui {ui}");
    let refused_constant = |kind: &str, ui: &str, found: &str| refused(&constant(kind, ui), found);
    refused_constant(
        "uint",
        "choice A=-1",
        "m.frag:3:63: error: expected a value of the type uint, 0 to 4294967295, found -1",
    );
    refused_constant(
        "int",
        "choice A=0 B=3000000000",
        "m.frag:3:65: error: expected a value of the type int, -2147483648 to 2147483647, found 3000000000",
    );
    refused_constant(
        "uint",
        "-1..4",
        "m.frag:3:56: error: expected a value of the type uint, 0 to 4294967295, found -1",
    );
    refused_constant("bool", "0..1", "m.frag:3:56: error: a bool has no range");
    refused_constant("float", "choice A=1", "m.frag:3:58: error: a choice must be int or uint");
    refused_constant(
        "uint",
        "choice A=1 B=2",
        "m.frag:3:56: error: expected a default among the choices A=1 B=2, found 0",
    );
    let negative = "layout(constant_id = 40) const int C = -1; //@ui choice A=-1 B=2";
    assert_eq!(read_text(negative).unwrap().constants[0].choices[0].1, -1);

    let member = |text: &str| format!("{PARAMS}\n{text}\n}};");
    refused(
        &member("uint a; //@ui choice A=1 B=2 = 3"),
        "m.frag:4:31: error: expected a default among the choices A=1 B=2, found 3",
    );
    refused(
        &member("int a; //@ui = 1e10"),
        "m.frag:4:16: error: expected a value of the type int, -2147483648 to 2147483647, found 10000000000",
    );
    refused(&member("bool a; //@ui = 2"), "m.frag:4:17: error: expected a value of the type bool, 0 to 1, found 2");
    refused(&member("int a; //@ui = 0.5"), "m.frag:4:15: error: expected a whole number after `=`");
    assert!(read_text(&member("float a; //@ui = 1e39")).unwrap_err()[0].message.contains("of the type float"));
    let found = read_text(&member("uint a; //@ui choice A=1 B=2\nuint b; //@ui choice A=1 B=0")).unwrap();
    assert_eq!((&found.parameters[0].default, &found.parameters[1].default), (&vec![1.0], &vec![0.0]));
}

#[test]
fn keys_of_the_window_are_refused() {
    let errors = |key: &str| {
        let text = format!("const uint A = 1u; //@mode a \"A\" key={key}");
        read_text(&text).map_err(|errors| errors[0].one_line())
    };
    for key in ["h", "r", "l", "q", "0", "7", "[", "]"] {
        let error = errors(key).unwrap_err();
        assert!(error.starts_with("m.frag:3:38: error: expected a key that the window does not use itself"), "{error}");
    }
    assert_eq!(errors("D").unwrap_err(), "m.frag:3:38: error: expected a lowercase letter after key=, found `D`");
    assert_eq!(errors("?").unwrap_err(), "m.frag:3:38: error: expected a letter a-z after key=, found `?`");
    assert_eq!(errors("d").unwrap().modes[0].key, Some('d'));
}

#[test]
fn what_is_given_twice_names_both_places() {
    let text = "const uint A = 1u; //@mode a \"A\"\nconst uint B = 2u; //@mode a \"B\"";
    let errors = read_text(text).unwrap_err();
    assert_eq!(errors[0].one_line(), "m.frag:4:28: error: mode slug `a` is given twice");
    assert_eq!(errors[0].notes, ["the other is at m.frag:3"]);
    let text = "const uint A = 1u; //@mode a \"A\"\n//@mode b \"B\"\nconst uint B = 0x1;";
    let errors = read_text(text).unwrap_err();
    assert_eq!(errors[0].one_line(), "m.frag:5:16: error: mode id `1` is given twice");
    assert_eq!((errors[0].length, &*errors[0].notes), (3, &["the other is at m.frag:3".to_owned()][..]));
}

#[test]
fn damaged_annotations_cause_no_panic() {
    let files = ["user/params.glsl", "debug/modes.glsl", "passes/film.frag", "brdf/models.glsl"];
    let files = files.map(|file| embedded::read(None, &file.into()).unwrap());
    let of_textures = b"//@texture noise \"maps/noise_*.png\" linear repeat mips layers=8\nuniform sampler2D noise;\n";
    crate::damaged::each(300, &[files[0], files[1], files[2], files[3], of_textures], |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let source = Source::memory([("passes/a.frag", &*text)]);
        let snapshot = Snapshot::new(&source);
        drop(read(&snapshot, &["passes/a.frag".into()], &[], false));
    });
}
