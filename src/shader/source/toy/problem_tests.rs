use super::problems;

/// The errors of a text in a folder with some files: column, marked text, message and help.
fn found(text: &str) -> Vec<(u32, String, String, String)> {
    let folder = tempfile::tempdir().unwrap();
    for name in ["bricks.png", "blur.glsl", "notes.txt", "sky_px.png"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    std::fs::create_dir(folder.path().join("maps")).unwrap();
    std::fs::write(folder.path().join("maps/wood.jpg"), "").unwrap();
    let place = folder.path().display().to_string();
    let row = |error: crate::shader::Diagnostic| {
        let (column, excerpt) = (error.column.unwrap(), error.excerpt.unwrap());
        let marked = excerpt.chars().skip(column as usize - 1).take(error.length as usize).collect();
        (column, marked, error.message.replace(&place, "FOLDER"), error.help.unwrap_or_default())
    };
    problems("t.glsl", text, folder.path()).into_iter().map(row).collect()
}

/// Fails unless the text has one error, with the caret under `marked`, whose message and help have all `parts`.
#[track_caller]
fn refused(text: &str, marked: &str, parts: &[&str]) {
    let found = found(text);
    let [(_, under, message, help)] = found.as_slice() else { panic!("{text}: {found:#?}") };
    assert_eq!(under, marked, "{found:#?}");
    for part in parts {
        assert!(message.contains(part) || help.contains(part), "no `{part}`: {found:#?}");
    }
}

#[test]
fn a_file_without_code_is_told_to_be_empty() {
    for (text, is_empty) in [("", true), ("// later\n", true), ("float a;\n", false)] {
        let error = super::super::problems::without_entry("t.glsl", text);
        assert_eq!(error.message.starts_with("the file is empty: expected `void mainImage("), is_empty, "{error:#?}");
    }
}

#[test]
fn good_lines_have_no_errors() {
    let good = "#iChannel0 \"file://./bricks.png\" // wood\n  #iChannel1 \"self\"\n#iChannel2\"blur.glsl\"\n\
        #iChannel3 \"sky_{}.png\"\n#iChannel3::Type \"cubemap\"\n#iChannel0::WrapMode \"Clamp\"\n#iKeyboard\n\
        #include \"x.glsl\"\n#if 1\n#ifdef A\n#ifndef A\n#endif\n#endif\n#endif\n\
        // #iChannel9 \"x\"\n/*\n#iChannel9 \"x\"\n*/\n";
    assert_eq!(found(good), []);
    assert_eq!(found("#iChannel0 \"keyboard\"\r\n#iChannel1 \"maps/wood.jpg\"\r\n"), []);
}

#[test]
fn names_have_suggestions() {
    let special = "\"self\", what this file drew one frame ago, and \"keyboard\", its keys";
    refused("#iChannel0 \"keybord\"", "keybord", &["not found in FOLDER. Did you mean \"keyboard\"?", special]);
    refused("#iChannel0 \"Self\"", "Self", &["Did you mean \"self\"?"]);
    refused(
        "#iChannel0 \"brikcs.png\"",
        "brikcs.png",
        &["Did you mean \"bricks.png\"?", "there are \"bricks.png\", \"sky_px.png\", \"blur.glsl\";"],
    );
    refused("#iChannel0 \"file://bricks.jpg\"", "file://bricks.jpg", &["Did you mean \"bricks.png\"?"]);
    refused("#iChannel0 \"blurr.glsl\"", "blurr.glsl", &["Did you mean \"blur.glsl\"?"]);
    refused("#iChannel0 \"maps/woods.jpg\"", "maps/woods.jpg", &["Did you mean \"maps/wood.jpg\"?"]);
    let [(_, _, message, help)] = &found("#iChannel0 \"qqq.png\"")[..] else { panic!("one error") };
    assert!(!message.contains("Did you mean") && !help.contains("notes.txt"), "{message} {help}");
    refused("#iChannel1 \"sea_{}.png\"\n#iChannel1::Type \"CubeMap\"", "sea_{}.png", &["not found"]);
}

#[test]
fn what_is_odd_is_refused_with_its_word() {
    for number in ["7", "-1", "4", "01", "99999999999999999999", "", "x"] {
        let name = format!("iChannel{number}");
        refused(&format!("#{name} \"bricks.png\""), &name, &["a shader has iChannel0 to iChannel3"]);
    }
    refused("#iChannel0 \"\"", "\"\"", &["expected the name of an image"]);
    refused("#iChannel0 bricks.png", "bricks.png", &["expected a name in quotes", "#iChannel0 \"bricks.png\""]);
    refused("#iChannel0", "", &["expected a name in quotes", "found the end of the line"]);
    refused("#iChannel0 \"bricks.png", "\"bricks.png", &["expected a closing quote"]);
    refused("#iChannel0 \"bricks.png\" Clamp", "Clamp", &["expected the end of the line", "found `Clamp`"]);
    refused("#iChannel0 \"https://a.b/c.png\"", "https://a.b/c.png", &["found an address", "save the image beside"]);
    for outside in ["/etc/a.png", "../a.png", "maps/../../a.png"] {
        refused(&format!("#iChannel0 \"{outside}\""), outside, &["lies outside the folder", "copy the file there"]);
    }
    refused("#iChannel0 \"maps\"", "maps", &["is a folder"]);
    refused(
        "#iChannel0 \"bricks.png\"\n#iChannel0 \"self\"",
        "#iChannel0",
        &["line 1 has named the image of iChannel0"],
    );
    refused("  #iChannel0 \"ä\u{1b}.png\"", "ä\u{1b}.png", &["not found"]);
}

#[test]
fn several_files_need_a_type() {
    let helps = ["#iChannel0::Type \"CubeMap\"", "#iChannel0::Type \"Volume\""];
    refused("#iChannel0 \"sky_{}.png\"", "sky_{}.png", &helps);
    refused("#iChannel0 \"sky_*.png\"", "sky_*.png", &helps);
    refused("#iChannel0 \"s{}/sky_{}.png\"\n#iChannel0::Type \"CubeMap\"", "s{}/sky_{}.png", &["expected one `{}`"]);
    let types = "expected \"Texture2D\", \"CubeMap\" or \"Volume\", found \"Cube\". Did you mean `CubeMap`?";
    refused("#iChannel0 \"bricks.png\"\n#iChannel0::Type \"Cube\"", "Cube", &[types]);
    refused(
        "#iChannel0 \"bricks.png\"\n#iChannel0::Type CubeMap",
        "CubeMap",
        &["expected a name in quotes after `::Type`"],
    );
    refused("#iChannel0 \"bricks.png\"\n#iChannel0::Type \"\"", "\"\"", &["expected \"Texture2D\""]);
    refused("#iChannel0::Type \"CubeMap\"", "CubeMap", &["iChannel0 names no image file", "#iChannel0 \"sky_{}.png\""]);
    refused("#iChannel0 \"self\"\n#iChannel0::Type \"Volume\"", "Volume", &["cannot be a Volume"]);
    refused("#iChannel0 \"bricks.png\"\n#iChannel0::Wrap \"Clamp\"", "::Wrap", &["Did you mean `WrapMode`?"]);
    refused("#iChannel0 \"bricks.png\"\n#iChannel0:Type \"CubeMap\"", ":Type", &["expected `::` and Type"]);
}

#[test]
fn directives_of_editors_have_suggestions() {
    refused("#iKeybord", "#iKeybord", &["Did you mean `#iKeyboard`?"]);
    refused("#ichannel0 \"bricks.png\"", "#ichannel0", &["Did you mean `#iChannel0`?"]);
    refused("#iUniform float speed = 1.0", "#iUniform", &["uniform block", "//@ui \"Speed\""]);
}
