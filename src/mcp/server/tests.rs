//! The protocol, with a line of the shell as the program.

use std::ffi::OsString;
use std::sync::mpsc::{Sender, channel};

use serde_json::{Value, json};

use super::*;
use crate::mcp::program::Start;

/// Takes what the server writes, a line at a time.
struct Lines(Sender<String>, Vec<u8>);

impl Write for Lines {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for byte in bytes {
            match byte {
                b'\n' => drop(self.0.send(String::from_utf8(std::mem::take(&mut self.1)).unwrap())),
                byte => self.1.push(*byte),
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The answers to some lines, by a server whose program is this line of the shell.
fn answers(script: &str, lines: &[String]) -> Vec<Value> {
    let arguments = ["-c", script].map(OsString::from).to_vec();
    let connection = Connection::Start(Start { program: "sh".into(), arguments });
    let (sender, written) = channel();
    let input = lines.join("\n") + "\n";
    serve(Config { connection, out: None }, input.as_bytes(), Lines(sender, Vec::new())).unwrap();
    written.iter().map(|line| serde_json::from_str(&line).unwrap()).collect()
}

fn request(id: u32, method: &str, params: Value) -> String {
    json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }).to_string()
}

/// Answers each command with its fields.
const ECHO: &str = r#"while read -r line; do
    id=${line#*\"id\":}; id=${id%%[,\}]*}
    printf '{"event": "done", "id": %s, "result": {"eye": %s, "modes": {"d": [1]}, "size": [2, 3]}}\n' "$id" "$line"
done"#;

#[test]
fn a_client_and_the_server_agree_on_a_revision() {
    for (asked, agreed) in [("2024-11-05", "2024-11-05"), ("2025-06-18", "2025-06-18"), ("1999-01-01", VERSIONS[3])] {
        let line = request(1, "initialize", json!({"protocolVersion": asked, "capabilities": {}, "clientInfo": {}}));
        let answer = &answers("cat >/dev/null", &[line])[0];
        assert_eq!(answer["result"]["protocolVersion"], agreed);
        assert_eq!(answer["result"]["serverInfo"]["name"], "specula");
    }
}

#[test]
fn mistakes_get_their_codes() {
    let lines = [
        "no json".to_owned(),
        json!({"id": 1}).to_string(),
        request(2, "server/discover", json!({})),
        request(3, "tools/call", json!({"name": "rendr"})),
        request(4, "initialize", json!({})),
        request(5, "resources/read", json!({"uri": "file:///etc/passwd"})),
        request(6, "ping", json!({})),
    ];
    let mut found = answers("cat >/dev/null", &lines);
    found.sort_by_key(|answer| answer["id"].as_u64());
    let codes: Vec<Value> = found.iter().map(|answer| answer["error"]["code"].clone()).collect();
    assert_eq!(
        codes,
        [json!(-32700), json!(-32600), json!(-32601), json!(-32602), json!(-32602), json!(-32602), Value::Null]
    );
    assert!(found[3]["error"]["message"].as_str().unwrap().contains("Did you mean `render`?"));
}

#[test]
fn calls_are_answered_whatever_the_order() {
    let lines: Vec<String> =
        (0..8).map(|id| request(id, "tools/call", json!({"name": "probe", "arguments": {"x": id, "y": 1}}))).collect();
    let mut found = answers(ECHO, &lines);
    found.sort_by_key(|answer| answer["id"].as_u64());
    assert_eq!(found.len(), 8);
    for (id, answer) in found.iter().enumerate() {
        assert_eq!(answer["result"]["isError"], false);
        let text = answer["result"]["content"][0]["text"].as_str().unwrap();
        assert!(text.starts_with(&format!("pixel {id} 1 of 2 x 3\nd [1]")), "{text}");
    }
}

#[test]
fn wrong_arguments_are_results_that_the_agent_sees() {
    for (arguments, part) in [
        (json!({"x": 1}), "missing field `y`"),
        (json!({"x": "a", "y": 1}), "`x`: invalid type"),
        (json!({"x": 1, "y": 1, "z": 1}), "unknown field `z`"),
    ] {
        let answer = &answers(ECHO, &[request(1, "tools/call", json!({"name": "probe", "arguments": arguments}))])[0];
        assert_eq!(answer["result"]["isError"], true);
        assert!(answer["result"]["content"][0]["text"].as_str().unwrap().contains(part), "{answer}");
    }
}

#[test]
fn a_batch_is_answered_as_one() {
    let initialize = request(1, "initialize", json!({"protocolVersion": "2025-03-26"}));
    let batch = format!("[{}, {}]", request(2, "ping", json!({})), request(3, "tools/call", json!({"name": "camera"})));
    let found = answers(ECHO, &[initialize, batch.clone()]);
    assert_eq!(found[1].as_array().map(Vec::len), Some(2), "{found:?}");
    let later = request(1, "initialize", json!({"protocolVersion": "2025-06-18"}));
    assert_eq!(answers(ECHO, &[later, batch])[1]["error"]["code"], INVALID_REQUEST);
}

#[test]
fn a_canceled_call_has_no_answer() {
    // The program answers nothing, so only the cancellation lets the call end.
    let cancel = json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 1}}).to_string();
    let found = answers(
        "cat >/dev/null",
        &[request(1, "tools/call", json!({"name": "furnace"})), cancel, request(2, "ping", json!({}))],
    );
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["id"], 2);
}

#[test]
fn the_schema_of_every_tool_names_its_arguments() {
    for tool in tools::list() {
        let schema = &tool["inputSchema"];
        for name in schema["required"].as_array().unwrap() {
            assert!(schema["properties"][name.as_str().unwrap()].is_object(), "{tool}");
        }
        for (name, property) in schema["properties"].as_object().unwrap() {
            assert!(property["description"].is_string(), "{}: {name}", tool["name"]);
        }
    }
}
