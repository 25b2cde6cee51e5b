//! Completion, hover, signatures, definitions, references and symbols.

use serde_json::{Value, json};

use super::client::{Opened, place, uri};

fn has_all(labels: &[String], expected: &[&str]) -> bool {
    expected.iter().all(|expected| labels.iter().any(|label| label == expected))
}

#[test]
fn completion_knows_scopes_members_and_the_contract() {
    let mut opened = Opened::new("user.glsl");
    let hook = "    s.roughness = saturate";
    opened.edit(
        hook,
        "    float own = 1.0;\n    s.\n    frame.\n    frame.eye_ws.\n    s.dfg.\n    f.\n    s.roughness = saturate",
    );
    let members = opened.labels("    s.\n", 6);
    assert!(
        has_all(&members, &["base_color", "n", "clearcoat_roughness"]) && !has_all(&members, &["own"]),
        "{members:?}"
    );
    assert!(has_all(&opened.labels("frame.\n", 6), &["exposure", "time_s", "eye_ws"]));
    assert_eq!(opened.labels("frame.eye_ws.", 13)[..3], ["x", "y", "z"]);
    assert!(has_all(&opened.labels("f.\n", 2), &["uv0", "color"]));
    let dfg = opened.labels("s.dfg.", 6);
    assert!(!dfg.is_empty() && !has_all(&dfg, &["base_color"]), "{dfg:?}");
    let names = opened.labels("s.roughness = saturate(", 17);
    let expected = [
        "own",
        "s",
        "f",
        "v",
        "saturate",
        "roughness_scale",
        "frame",
        "luminance",
        "TOON_BANDS",
        "Surface",
        "mix",
        "return",
    ];
    assert!(has_all(&names, &expected), "{names:?}");
    // Not those of another function.
    assert!(!has_all(&names, &["radiance"]));
    opened.client.quit();
}

#[test]
fn completion_knows_annotations_and_includes() {
    let mut opened = Opened::new("user.glsl");
    opened.edit(
        "#include \"common/color.glsl\"",
        "#include \"brdf/\n//@\n//@pass own \n//@pass own draw=\n//@mode m \"M d\" \n#\n// @\nfloat a; //@ui when=",
    );
    assert!(has_all(&opened.labels("brdf/\n", 5), &["brdf/ndf.glsl", "common/math.glsl"]));
    assert_eq!(opened.labels("//@\n", 3), ["ui", "mode", "pass", "texture"]);
    assert!(has_all(&opened.labels("//@pass own \n", 12), &["draw=", "blend", "to="]));
    assert_eq!(opened.labels("draw=\n", 5), ["model", "quads", "background"]);
    let options = opened.labels("\"M d\" ", 6);
    assert!(has_all(&options, &["encode=", "tonemap"]) && !has_all(&options, &["blend"]));
    assert!(opened.labels("\"M d\" ", 2).is_empty(), "inside of a text");
    assert!(has_all(&opened.labels("#\n", 1), &["include", "ifdef"]));
    assert!(opened.labels("// @", 4).is_empty(), "in a comment");
    assert!(has_all(&opened.labels("when=", 5), &["BLOOM", "NDF"]));
    opened.client.quit();
}

#[test]
fn hover_explains_names_by_their_comments() {
    let mut opened = Opened::new("brdf/evaluate.glsl");
    let mut hover = |what: &str, plus: usize| {
        let hover = opened.ask("hover", what, plus);
        hover["contents"]["value"].as_str().unwrap_or_default().to_owned()
    };
    let text = hover("d_specular_anisotropic(", 3);
    assert!(
        text.contains("float d_specular_anisotropic(vec3 h_ts, vec2 alpha)") && text.contains("`brdf/ndf.glsl:"),
        "{text}"
    );
    let text = hover("s.clearcoat_roughness", 4);
    assert!(
        text.contains("float clearcoat_roughness") && text.contains("perceptual") && text.contains("// Surface"),
        "{text}"
    );
    assert!(hover("dot(", 1).contains("float dot(genType a, genType b)"));
    assert!(hover("// ", 1).is_empty());
    opened.client.quit();
}

#[test]
fn signatures_follow_the_arguments() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    let help = opened.ask("signatureHelp", "d_beckmann(n_dot_h, sin2_h, alpha) :", 20);
    assert_eq!(
        (&help["activeParameter"], &help["signatures"][0]["label"]),
        (&json!(1), &json!("float d_beckmann(float n_dot_h, float sin2_h, float alpha)"))
    );
    assert_eq!(help["signatures"][0]["parameters"][1]["label"], "float sin2_h");
    // Two forms: the one with three parameters is chosen by the third argument.
    let help = opened.ask("signatureHelp", "d_specular(n_dot_h, 1.0 - n_dot_h * n_dot_h, alpha)", 48);
    let active = help["activeSignature"].as_u64().unwrap() as usize;
    assert_eq!(help["signatures"].as_array().unwrap().len(), 2);
    assert_eq!(help["signatures"][active]["parameters"].as_array().unwrap().len(), 3);
    let help = opened.ask("signatureHelp", "dot(stretched, ", 15);
    assert_eq!(
        (&help["signatures"][0]["label"], &help["activeParameter"]),
        (&json!("float dot(genType a, genType b)"), &json!(1))
    );
    opened.client.quit();
}

#[test]
fn definitions_and_references_cross_files() {
    let mut opened = Opened::new("brdf/evaluate.glsl");
    let ndf = opened.tree.path("brdf/ndf.glsl");
    let text = opened.tree.read("brdf/ndf.glsl");
    let found = opened.ask("definition", "#include \"brdf/ndf.glsl\"", 14);
    assert_eq!(
        found,
        json!([{ "uri": uri(&ndf), "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } } }])
    );
    let found = opened.ask("definition", "d_specular_anisotropic(", 3);
    assert_eq!(
        (&found[0]["uri"], &found[0]["range"]["start"]),
        (&json!(uri(&ndf)), &place(&text, "d_specular_anisotropic(", 0))
    );
    let found = opened.ask("definition", "s.clearcoat_roughness", 4);
    let surface = opened.tree.read("brdf/surface.glsl");
    assert_eq!(found[0]["range"]["start"], place(&surface, "clearcoat_roughness; //", 0));

    // `alpha` of d_ggx is not that of its neighbors.
    opened.client.open(&ndf, &text);
    let mut params = super::client::at(&ndf, &text, "float alpha) {", 6);
    params["context"] = json!({ "includeDeclaration": true });
    let uses = opened.client.ask("textDocument/references", params.clone());
    assert_eq!(uses.as_array().unwrap().len(), 3, "{uses:#}");
    params["context"]["includeDeclaration"] = json!(false);
    assert_eq!(opened.client.ask("textDocument/references", params).as_array().unwrap().len(), 2);
    let mut params = super::client::at(&ndf, &text, "d_specular_anisotropic(", 2);
    params["context"] = json!({ "includeDeclaration": true });
    let uses = opened.client.ask("textDocument/references", params);
    let files: Vec<&str> = uses.as_array().unwrap().iter().map(|of| of["uri"].as_str().unwrap()).collect();
    assert!(
        files.iter().any(|file| file.ends_with("brdf/evaluate.glsl"))
            && files.iter().any(|file| file.ends_with("brdf/ndf.glsl"))
    );
    opened.client.quit();
}

#[test]
fn symbols_folding_and_colors() {
    let mut opened = Opened::new("user/params.glsl");
    let document = json!({ "textDocument": { "uri": uri(&opened.path) } });
    let symbols = opened.client.ask("textDocument/documentSymbol", document.clone());
    let names: Vec<&str> = symbols.as_array().unwrap().iter().map(|symbol| symbol["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"Params") && names.contains(&"rim_color"), "{names:?}");
    let folds = opened.client.ask("textDocument/foldingRange", document.clone());
    let lines: Vec<u64> = folds.as_array().unwrap().iter().map(|fold| fold["startLine"].as_u64().unwrap()).collect();
    assert!(lines.contains(&u64::from(opened.line("uniform Params"))) && lines.contains(&0), "{folds:#}");
    let colors = opened.client.ask("textDocument/documentColor", document);
    let [color] = colors.as_array().unwrap().as_slice() else { panic!("{colors:#}") };
    assert_eq!(color["range"]["start"], place(&opened.text, "1 0.8 0.6", 0));
    let params = json!({ "textDocument": { "uri": uri(&opened.path) }, "range": color["range"], "color": { "red": 1, "green": 1, "blue": 0, "alpha": 1 } });
    let written = opened.client.ask("textDocument/colorPresentation", params);
    assert_eq!(written[0]["textEdit"]["newText"], "1 1 0");
    let found = opened.client.ask("workspace/symbol", json!({ "query": "dggxan" }));
    let names: Vec<&Value> = found.as_array().unwrap().iter().map(|symbol| &symbol["name"]).collect();
    assert_eq!(names, ["d_ggx_anisotropic"]);
    opened.client.quit();
}
