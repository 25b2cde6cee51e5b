//! Odd input never ends the server.

use serde_json::{Value, json};

use super::client::{Client, Opened, at, uri};
use crate::support::Tree;
use crate::support::process::run;

#[test]
fn malformed_and_unknown_messages_are_answered() {
    let tree = Tree::new();
    let mut client = Client::spawn(&tree.root(), &["--stdio"]);
    let code = |message: &Value, code: i64| message["error"]["code"] == code;
    assert!(client.refused("textDocument/hover", json!({})).contains("`initialize` comes first"));
    client.write(b"Content-Length: 5\r\n\r\n{nope");
    client.until("an error of parsing", |message| code(message, -32700) && message["id"].is_null());
    client.write(b"Content-Length: 99999999999999999999\r\n\r\nContent-Length: x\r\n\r\nnonsense\r\n\r\n");
    (0..3).for_each(|_| drop(client.until("an error of a head", |message| code(message, -32700))));
    client.write(b"Content-Length: 2\r\nContent-Type: x\r\n\r\n[]Content-Length: 3\r\n\r\n\xff\xfe\xfd");
    client.until("an error of the request", |message| code(message, -32600));
    client.until("an error of encoding", |message| code(message, -32700));
    client.ask("initialize", json!({ "capabilities": {} }));
    assert!(client.refused("initialize", json!({ "capabilities": {} })).contains("comes once"));
    assert!(client.refused("textDocument/no_such", json!({})).contains("no method"));
    assert!(client.refused("textDocument/hover", json!({ "textDocument": 7 })).contains("expected struct"));
    client.notify("textDocument/didOpen", json!([1, 2]));
    client.notify("$/unknown", json!(null));
    client.send(&json!({ "jsonrpc": "2.0", "id": 99, "result": null }));
    let nowhere =
        json!({ "textDocument": { "uri": "file:///no/such/file.glsl" }, "position": { "line": 0, "character": 0 } });
    assert!(client.refused("textDocument/hover", nowhere).contains("neither open"));
    assert_eq!(client.ask("shutdown", Value::Null), Value::Null);
    assert!(client.refused("textDocument/hover", json!({})).contains("shut down"));
    client.notify("exit", Value::Null);
    assert_eq!(client.code(), Some(0));
}

#[test]
fn the_server_ends_with_its_input_and_leaves_nothing() {
    let tree = Tree::new();
    let before = files(&tree);
    let mut client = Client::start(&tree.root(), &[]);
    client.open(&tree.path("user.glsl"), "nonsense");
    // In the middle of a compilation.
    assert_eq!(client.end(), Some(1));
    let mut client = Client::start(&tree.root(), &[]);
    client.write(b"Content-Length: 1000\r\n\r\n{");
    assert_eq!(client.end(), Some(1));
    let mut client = Client::start(&tree.root(), &[]);
    client.notify("exit", Value::Null);
    assert_eq!(client.code(), Some(1));
    assert_eq!(files(&tree), before);
    run(&tree.root(), &["lsp", "--size", "0x0"]).expect(2, &["--size"]);
}

#[test]
fn the_server_ends_while_it_compiles() {
    for round in 0..8 {
        let mut opened = Opened::new("brdf/ndf.glsl");
        // A text that no cache knows, with an error at a later place in each round.
        let wrong = format!("float a2 = alpha * alpha * {round}.5;\n{} nonsense", "\n".repeat(round));
        opened.edit("float a2 = alpha * alpha;", &wrong);
        // Later rounds end later: at once, after an answer, after the first diagnostics.
        if round % 3 > 0 {
            opened.ask("hover", "alpha", 1);
        }
        if round % 3 > 1 {
            let path = opened.path.clone();
            opened.client.diagnostics(&path, |all| !all.is_empty());
            opened.edit("nonsense", "no_sense");
        }
        // No thread may crash the process at its end.
        opened.client.quit();
    }
}

fn files(tree: &Tree) -> Vec<std::path::PathBuf> {
    let source = specula::shader::Source::disk(tree.root());
    source.list().iter().map(|path| tree.path(path.as_str())).collect()
}

#[test]
fn requests_that_wait_can_be_canceled() {
    let mut opened = Opened::new("brdf/evaluate.glsl");
    let (path, text) = (opened.path.clone(), opened.text.clone());
    let mut params = at(&path, &text, "dot(", 1);
    params["context"] = json!({ "includeDeclaration": true });
    let asked = (0..200).map(|_| opened.client.request("textDocument/completion", params.clone()));
    let (ids, requests): (Vec<i64>, Vec<Value>) = asked.unzip();
    let cancel = |id: &i64| json!({ "jsonrpc": "2.0", "method": "$/cancelRequest", "params": { "id": id } });
    // At once, so that all are there long before the last is answered.
    let all: Vec<Value> = requests.into_iter().chain(ids.iter().chain([&12345]).map(cancel)).collect();
    opened.client.send_all(&all);
    // Each is answered once, with a result or that it is canceled.
    let mut canceled = 0;
    for id in ids {
        let answer = opened.client.answer(id);
        let is_canceled = answer["error"]["code"] == -32800;
        assert!(is_canceled || answer["result"].is_array(), "{answer}");
        canceled += i32::from(is_canceled);
    }
    assert!(canceled > 0, "all requests were answered");
    opened.client.quit();
}

#[test]
fn texts_of_every_kind_are_compiled_and_asked_about() {
    let mut opened = Opened::new("user.glsl");
    let (path, shipped) = (opened.path.clone(), opened.text.clone());
    let wrong = shipped.replace("saturate(s.roughness", "/* 𝄞 */ satrate(s.roughness");
    let crlf = wrong.replace('\n', "\r\n");
    let with_error = [crlf.clone(), format!("\u{feff}{crlf}")];
    let odd = [
        String::new(),
        "\u{feff}".to_owned(),
        "\0".to_owned(),
        "{".repeat(3000),
        "\"\"\"//@ui /* \\\r\n #include \"".to_owned(),
        format!("{shipped}{}", "// a line of text\n".repeat(300_000)),
    ];
    let right = [format!("\u{feff}{}", shipped.replace('\n', "\r\n")), shipped.replace('\n', "\r"), shipped.clone()];
    let texts: Vec<&String> = with_error.iter().chain(&odd).chain(&right).collect();
    for text in texts {
        opened.client.forget();
        opened.client.change(&path, text);
        for method in ["documentSymbol", "foldingRange", "documentColor"] {
            opened.client.ask(&format!("textDocument/{method}"), json!({ "textDocument": { "uri": uri(&path) } }));
        }
        for (line, character) in [(0, 0), (0, 1), (3, 7), (40, 9000), (4_000_000_000_u32, 4_000_000_000_u32)] {
            let place =
                json!({ "textDocument": { "uri": uri(&path) }, "position": { "line": line, "character": character } });
            for method in ["completion", "hover", "signatureHelp", "definition"] {
                opened.client.ask(&format!("textDocument/{method}"), place.clone());
            }
        }
        match odd.contains(text) {
            // Its error may be in a file that includes it.
            true => drop(
                opened.client.until("diagnostics", |message| message["method"] == "textDocument/publishDiagnostics"),
            ),
            false => drop(opened.client.diagnostics(&path, |all| all.is_empty() == right.contains(text))),
        }
        if text.contains("satrate") {
            let found = super::client::place(&text.replace('\u{feff}', ""), "satrate", 0);
            let diagnostics = opened.client.ask(
                "textDocument/codeAction",
                json!({ "textDocument": { "uri": uri(&path) },
                "range": { "start": found, "end": found }, "context": { "diagnostics": [] } }),
            );
            assert_eq!(diagnostics[0]["edit"]["changes"][uri(&path)][0]["range"]["start"], found, "{diagnostics:#}");
        }
    }
    opened.client.quit();
}

#[test]
fn incremental_changes_count_as_the_editor_counts() {
    let mut opened = Opened::new("user.glsl");
    let path = opened.path.clone();
    let line = opened.line("    s.roughness = saturate");
    let mut change = |from: (u32, u32), to: (u32, u32), text: &str| {
        let range =
            json!({ "start": { "line": from.0, "character": from.1 }, "end": { "line": to.0, "character": to.1 } });
        let document = json!({ "uri": uri(&path), "version": 2 });
        let changes = json!([{ "range": range, "text": text }]);
        opened.client.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }));
    };
    change((line, 4), (line, 4), "/* 𝄞 */ float 𝄞x = 1.0; ");
    change((line, 19), (line, 21), "clef_");
    change((line, 4), (line, 13), "");
    let hover = opened.client.ask(
        "textDocument/hover",
        json!({ "textDocument": { "uri": uri(&path) }, "position": { "line": line, "character": 12 } }),
    );
    assert!(hover["contents"]["value"].as_str().unwrap().contains("float clef_x"), "{hover:#}");
    opened.client.diagnostics(&path, <[_]>::is_empty);
    opened.client.quit();
}

#[test]
fn files_outside_of_trees_and_trees_that_go_away() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("lib.glsl"), "float half_of(float x) { return 0.5 * x; }\n").unwrap();
    let mut client = Client::start(folder.path(), &[]);
    let path = folder.path().join("alone.glsl");
    let text = "#include \"lib.glsl\"\nfloat f(float own) { return half_of(own); }\n";
    client.open(&path, text);
    let found = client.ask("textDocument/definition", at(&path, text, "half_of", 2));
    assert_eq!(found[0]["uri"], uri(&folder.path().join("lib.glsl")));
    let items = client.ask("textDocument/completion", at(&path, text, "return half", 11));
    assert!(items.as_array().unwrap().iter().any(|item| item["label"] == "own"));
    let untitled = json!({ "uri": "untitled:Untitled-1", "languageId": "glsl", "version": 1, "text": text });
    client.notify("textDocument/didOpen", json!({ "textDocument": untitled }));
    let symbols =
        client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": "untitled:Untitled-1" } }));
    assert_eq!(symbols[0]["name"], "f");

    // A tree appears, and goes away under the editor.
    let tree = folder.path().join("tree");
    specula::shader::embedded::write_to(&tree, None).unwrap();
    let user = tree.join("user.glsl");
    let text = std::fs::read_to_string(&user).unwrap();
    client.open(&user, &text);
    client.diagnostics(&user, <[_]>::is_empty);
    let moved = folder.path().join("moved");
    std::fs::rename(&tree, &moved).unwrap();
    client.diagnostics(&tree, |all| all.iter().any(|one| one["message"].as_str().unwrap().contains("is gone")));
    client.ask("textDocument/hover", at(&user, &text, "user_surface", 2));
    std::fs::rename(&moved, &tree).unwrap();
    client.diagnostics(&tree, <[_]>::is_empty);
    client.quit();
}
