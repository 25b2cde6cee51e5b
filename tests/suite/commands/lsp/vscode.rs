//! The extension for VS Code fits the program.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;
use specula::shader::StageKind;

#[test]
fn the_extension_knows_all_kinds_of_files_and_has_all_its_commands() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/editors/vscode");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let package: Value = serde_json::from_str(&read("package.json")).unwrap();
    let contributes = &package["contributes"];
    let texts = |list: &Value| -> BTreeSet<String> {
        list.as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned()).collect()
    };
    let stages = StageKind::PRE_RASTERIZATION.into_iter().chain([StageKind::Fragment, StageKind::Compute]);
    let mut expected: BTreeSet<String> = stages.map(|kind| format!(".{}", kind.extension())).collect();
    expected.insert(".glsl".to_owned());
    assert_eq!(texts(&contributes["languages"][0]["extensions"]), expected);
    let code = read("extension.js");
    for command in contributes["commands"].as_array().unwrap() {
        let name = command["command"].as_str().unwrap();
        assert!(code.contains(&format!("register('{name}'")), "{name} is not registered");
    }
    for setting in contributes["configuration"]["properties"].as_object().unwrap().keys() {
        let name = setting.strip_prefix("specula.").unwrap();
        assert!(code.contains(&format!("settings.get('{name}')")), "{setting} is not read");
    }
    assert_eq!(package["dependencies"].as_object().unwrap().keys().collect::<Vec<_>>(), ["vscode-languageclient"]);
}
