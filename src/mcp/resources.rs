//! The files of the shader tree as resources.

use std::sync::Arc;

use serde_json::{Value, json};

use super::message::{RESOURCE_NOT_FOUND, Refused};
use super::program::{Call, Failure};
use super::shared::Shared;

/// The URI of a file is this and its path.
const SCHEME: &str = "specula://shaders/";
const MIME_TYPE: &str = "text/x-glsl";

/// How URIs are formed.
pub fn template() -> Value {
    json!({ "uriTemplate": format!("{SCHEME}{{+file}}"), "name": "shader", "title": "File of the shader tree",
        "description": "GLSL text, such as specula://shaders/brdf/ndf.glsl", "mimeType": MIME_TYPE })
}

/// All files.
pub fn list(shared: &Shared, call: &Arc<Call>) -> Option<Result<Value, Refused>> {
    let files = match shared.program.ask(call, "files", &json!({})) {
        Ok(found) => found["files"].as_array().cloned().unwrap_or_default(),
        Err(failure) => return refused(failure, super::message::INVALID_REQUEST),
    };
    let resource = |file: &str| json!({ "uri": format!("{SCHEME}{file}"), "name": file, "mimeType": MIME_TYPE });
    let resources: Vec<Value> = files.iter().filter_map(Value::as_str).map(resource).collect();
    Some(Ok(json!({ "resources": resources })))
}

/// The text of a file.
pub fn read(uri: &str, shared: &Shared, call: &Arc<Call>) -> Option<Result<Value, Refused>> {
    let Some(file) = uri.strip_prefix(SCHEME).filter(|file| !file.is_empty()) else {
        return Some(Err(Refused::params(format!("`uri` is `{uri}`; expected {SCHEME} and a path"))));
    };
    match shared.program.ask(call, "file", &json!({ "file": file })) {
        Ok(found) => {
            let contents = json!({ "uri": uri, "mimeType": MIME_TYPE, "text": found["text"] });
            Some(Ok(json!({ "contents": [contents] })))
        }
        Err(failure) => refused(failure, RESOURCE_NOT_FOUND),
    }
}

fn refused(failure: Failure, code: i32) -> Option<Result<Value, Refused>> {
    match failure {
        Failure::Refused { message, .. } => Some(Err(Refused { code, message })),
        Failure::Canceled => None,
    }
}
