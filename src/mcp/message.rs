//! Messages of JSON-RPC 2.0.

use serde_json::{Map, Value, json};

/// The text is no JSON.
pub const PARSE_ERROR: i32 = -32700;
/// The JSON is no message.
pub const INVALID_REQUEST: i32 = -32600;
/// There is no such method.
pub const METHOD_NOT_FOUND: i32 = -32601;
/// The parameters do not fit the method.
pub const INVALID_PARAMS: i32 = -32602;
/// The server failed.
pub const INTERNAL_ERROR: i32 = -32603;
/// There is no such resource (Model Context Protocol).
pub const RESOURCE_NOT_FOUND: i32 = -32002;

/// A message of the client.
#[derive(Debug, PartialEq)]
pub enum Incoming {
    Request {
        /// Text or a whole number.
        id: Value,
        method: String,
        params: Map<String, Value>,
    },
    Notification {
        method: String,
        params: Map<String, Value>,
    },
    /// An answer. This server asks nothing, so nothing waits for it.
    Response,
    /// The answer to a line that is no message.
    Wrong(Value),
}

/// Reads one message.
pub fn parse(value: Value) -> Incoming {
    let Value::Object(mut fields) = value else {
        return wrong(Value::Null, "expected an object of JSON-RPC 2.0");
    };
    let is_id = |id: &Value| id.is_string() || id.is_i64() || id.is_u64();
    let id = fields.remove("id");
    let known = id.clone().filter(is_id).unwrap_or_default();
    if fields.get("jsonrpc") != Some(&json!("2.0")) {
        return wrong(known, "expected `\"jsonrpc\": \"2.0\"`");
    }
    let Some(Value::String(method)) = fields.remove("method") else {
        let is_response = fields.contains_key("result") || fields.contains_key("error");
        return if is_response { Incoming::Response } else { wrong(known, "`method` is missing: expected its name") };
    };
    let params = match fields.remove("params") {
        None => Map::new(),
        Some(Value::Object(params)) => params,
        Some(_) => return wrong(known, "expected an object as `params`"),
    };
    match id {
        None => Incoming::Notification { method, params },
        Some(id) if is_id(&id) => Incoming::Request { id, method, params },
        Some(_) => wrong(Value::Null, "expected text or a whole number as `id`"),
    }
}

fn wrong(id: Value, why: &str) -> Incoming {
    Incoming::Wrong(error(id, INVALID_REQUEST, why))
}

/// The answer to a request.
pub fn answer(id: Value, result: Result<Value, Refused>) -> Value {
    match result {
        Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
        Err(Refused { code, message }) => error(id, code, &message),
    }
}

/// An error as the answer to a request.
pub fn error(id: Value, code: i32, message: &str) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": message } })
}

/// A request that is answered with an error of the protocol.
#[derive(Debug)]
pub struct Refused {
    /// One of the codes above.
    pub code: i32,
    /// The reason.
    pub message: String,
}

impl Refused {
    /// Parameters that do not fit.
    pub fn params(message: impl Into<String>) -> Self {
        Self { code: INVALID_PARAMS, message: message.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_told_apart() {
        let request = parse(json!({"jsonrpc": "2.0", "id": "a", "method": "ping"}));
        assert_eq!(request, Incoming::Request { id: json!("a"), method: "ping".into(), params: Map::new() });
        assert_eq!(parse(json!({"jsonrpc": "2.0", "id": 1, "result": {}})), Incoming::Response);
        let notification = parse(json!({"jsonrpc": "2.0", "method": "x", "params": {"a": 1}}));
        assert!(matches!(notification, Incoming::Notification { params, .. } if params["a"] == 1));
    }

    #[test]
    fn what_is_no_message_is_answered_with_its_id() {
        for (value, id) in [
            (json!([1]), Value::Null),
            (json!({"jsonrpc": "1.0", "id": 3, "method": "ping"}), json!(3)),
            (json!({"jsonrpc": "2.0", "id": 4}), json!(4)),
            (json!({"jsonrpc": "2.0", "id": 5, "method": "ping", "params": [1]}), json!(5)),
            (json!({"jsonrpc": "2.0", "id": null, "method": "ping"}), Value::Null),
            (json!({"jsonrpc": "2.0", "id": 1.5, "method": "ping"}), Value::Null),
        ] {
            let Incoming::Wrong(answer) = parse(value.clone()) else { panic!("{value} is taken") };
            assert_eq!((&answer["id"], &answer["error"]["code"]), (&id, &json!(INVALID_REQUEST)), "{value}");
        }
    }
}
