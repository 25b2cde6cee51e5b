//! Errors of saved and unsaved texts, in all files that they reach.

use serde_json::{Value, json};

use super::client::{Client, Opened, uri};
use crate::support::Tree;

const SQUARED: &str = "float a2 = alpha * alpha;";

fn messages(diagnostics: &[Value]) -> Vec<&str> {
    diagnostics.iter().map(|diagnostic| diagnostic["message"].as_str().unwrap()).collect()
}

#[test]
fn an_unsaved_error_is_shown_under_its_word_and_cleared_when_mended() {
    let mut opened = Opened::new("brdf/ndf.glsl");
    let path = opened.path.clone();
    opened.client.diagnostics(&path, <[_]>::is_empty);
    opened.edit(SQUARED, "float a2 = /* 𝄞é */ alpah * alpha;");
    let found = opened.client.diagnostics(&path, |all| !all.is_empty());
    assert_eq!(messages(&found), ["'alpah' : undeclared identifier\nhelp: did you mean `alpha`?"]);
    let line = opened.line("alpah");
    let expected = json!({ "start": { "line": line, "character": 25 }, "end": { "line": line, "character": 30 } });
    assert_eq!((&found[0]["range"], &found[0]["severity"]), (&expected, &json!(1)));
    // Nothing was written.
    assert!(opened.tree.read("brdf/ndf.glsl").contains(SQUARED));
    opened.edit("alpah", "alpha");
    opened.client.diagnostics(&path, <[_]>::is_empty);
    opened.client.quit();
}

#[test]
fn an_error_is_shown_in_the_file_that_it_is_in_open_or_not() {
    let tree = Tree::new();
    let mut client = Client::start(&tree.root(), &[]);
    let (library, user) = (tree.path("common/math.glsl"), tree.path("brdf/ndf.glsl"));
    let text = tree.read("common/math.glsl");
    client.open(&library, &text);
    client.diagnostics(&library, <[_]>::is_empty);
    // A file that is not open uses the name.
    client.change(&library, &text.replace("PI ", "PIE "));
    let found = client.diagnostics(&user, |all| !all.is_empty());
    assert!(messages(&found).iter().any(|message| message.contains("'PI' : undeclared")), "{found:#?}");
    client.change(&library, &text);
    client.diagnostics(&user, <[_]>::is_empty);
    client.quit();
}

#[test]
fn a_double_name_tells_where_the_other_is() {
    let mut opened = Opened::new("debug/modes.glsl");
    let path = opened.path.clone();
    opened.client.diagnostics(&path, <[_]>::is_empty);
    opened.edit("//@mode clay \"Clay\"", "//@mode final \"Clay\"");
    let found = opened.client.diagnostics(&path, |all| !all.is_empty());
    let related = &found[0]["relatedInformation"][0];
    assert!(messages(&found)[0].contains("mode slug `final` is given twice"), "{found:#?}");
    assert_eq!(
        (&related["location"]["uri"], &related["location"]["range"]["start"]["line"]),
        (&json!(uri(&path)), &json!(opened.line("//@mode final \"Final\"")))
    );
    opened.client.quit();
}

#[test]
fn files_that_no_stage_includes_and_files_that_are_not_there_yet_are_compiled() {
    let tree = Tree::new();
    let mut client = Client::start(&tree.root(), &[]);
    let (own, user) = (tree.path("user/own.glsl"), tree.path("user.glsl"));
    client.open(&own, "float own(float x) { return y; }\n");
    let found = client.diagnostics(&own, |all| !all.is_empty());
    assert!(messages(&found)[0].starts_with("'y' : undeclared identifier"), "{found:#?}");
    // Only the editor has the file that another one includes.
    client.change(&own, "float own(float x) { return x; }\n");
    client.diagnostics(&own, <[_]>::is_empty);
    let text = tree.read("user.glsl");
    let with =
        text.replace("#include \"user/params.glsl\"", "#include \"user/params.glsl\"\n#include \"user/own.glsl\"");
    client.open(&user, &with);
    client.diagnostics(&user, <[_]>::is_empty);
    client.change(&user, &with.replace("user/own.glsl", "user/owm.glsl"));
    let found = client.diagnostics(&user, |all| !all.is_empty());
    assert!(messages(&found)[0].contains("\"user/owm.glsl\" not found"), "{found:#?}");
    client.quit();
}

#[test]
fn changes_on_disk_are_seen_and_an_editor_wins_over_them() {
    let mut opened = Opened::new("user.glsl");
    let (path, other) = (opened.path.clone(), opened.tree.path("brdf/ndf.glsl"));
    opened.client.diagnostics(&path, <[_]>::is_empty);
    let wrong = opened.tree.edited("brdf/ndf.glsl", SQUARED, "float a2 = nothing;");
    opened.tree.write("brdf/ndf.glsl", &wrong);
    opened.client.diagnostics(&other, |all| !all.is_empty());
    // The editor has the right text, though the file is wrong.
    opened.client.open(&other, &wrong.replace("nothing", "alpha"));
    opened.client.diagnostics(&other, <[_]>::is_empty);
    opened.client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri(&other) } }));
    opened.client.diagnostics(&other, |all| !all.is_empty());
    std::fs::remove_file(&other).unwrap();
    // One error, with the other files that include it.
    opened.client.until("the missing file", |message| {
        let first = &message["params"]["diagnostics"][0];
        let is_it = first["message"].as_str().is_some_and(|text| text.contains("\"brdf/ndf.glsl\" not found"));
        is_it && first["relatedInformation"].as_array().is_some_and(|others| others.len() > 2)
    });
    opened.client.quit();
}

#[test]
fn several_trees_have_diagnostics_of_their_own() {
    let (first, second) = (Tree::new(), Tree::new());
    let mut client = Client::start(&first.root(), &[]);
    let paths = [first.path("user.glsl"), second.path("user.glsl")];
    let text = first.read("user.glsl");
    client.open(&paths[0], &text);
    client.open(&paths[1], &text.replace("saturate(s.roughness", "satrate(s.roughness"));
    client.diagnostics(&paths[0], <[_]>::is_empty);
    let found = client.diagnostics(&paths[1], |all| !all.is_empty());
    assert!(messages(&found)[0].contains("did you mean `saturate`?"), "{found:#?}");
    client.quit();
}
