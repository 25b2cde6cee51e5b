//! Parses the file: the GLB container, the JSON, the version, the extensions.

use std::collections::BTreeSet;

use gltf::json;

use crate::scene::error::Problem;
use crate::scene::extensions::EXTENSIONS;
use crate::scene::gltf::motion::pointers;
use crate::scene::gltf::motion::raw::Raw;
use crate::scene::gltf::{compression, environment, instancing, nodes};

/// Extensions that a model may require, beside those of `scene::extensions`.
const SUPPORTED: &[&str] = &[
    environment::EXTENSION,
    instancing::EXTENSION,
    "EXT_texture_webp",
    pointers::EXTENSION,
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    nodes::VISIBILITY,
    "KHR_texture_basisu",
    "KHR_texture_transform",
];

/// Extensions that a model may use without loss, or with a known one: what Specula does instead.
const IGNORED: &[(&str, &str)] = &[
    ("AGI_articulations", "the model looks the same without it"),
    ("EXT_mesh_features", "the model looks the same without it"),
    ("EXT_structural_metadata", "the model looks the same without it"),
    ("EXT_texture_avif", "the PNG, JPEG, WebP or KTX2 image of each texture is shown, if it has one"),
    ("KHR_audio_emitter", "the model is silent"),
    ("KHR_xmp", "the model looks the same without it"),
    ("KHR_xmp_json_ld", "the model looks the same without it"),
    ("MSFT_lod", "the finest level of detail is shown at every distance"),
    ("MSFT_packing_normalRoughnessMetallic", "the textures of core glTF are shown"),
    ("MSFT_packing_occlusionRoughnessMetallic", "the textures of core glTF are shown"),
    ("MSFT_texture_dds", "the PNG, JPEG, WebP or KTX2 image of each texture is shown, if it has one"),
];

/// All extensions that a model may require.
fn supported() -> BTreeSet<&'static str> {
    SUPPORTED.iter().copied().chain(compression::EXTENSIONS).chain(EXTENSIONS.iter().map(|e| e.name)).collect()
}

const MAGIC: &[u8; 4] = b"glTF";
const HEADER_SIZE: usize = 12;
const CHUNK_HEADER_SIZE: usize = 8;
const CHUNK_JSON: u32 = 0x4e4f_534a;
const CHUNK_BIN: u32 = 0x004e_4942;

/// A parsed file. Its content has not been checked.
pub struct Document<'a> {
    /// The JSON.
    pub root: json::Root,
    /// Its parts about motion.
    pub raw: Raw,
    /// The GLB's binary chunk.
    pub bin: Option<&'a [u8]>,
    /// Warnings, one sentence each.
    pub warnings: Vec<String>,
}

/// Parses a `.gltf` or `.glb` file. The content decides which of the two it is.
pub fn parse(bytes: &[u8]) -> Result<Document<'_>, Problem> {
    if bytes.is_empty() {
        return Err(Problem::Empty);
    }
    let (text, bin) = if bytes.starts_with(MAGIC) { split_glb(bytes)? } else { (bytes, None) };
    let text = json_text(text)?;
    let root = parse_json(text)?;
    check_version(&root.asset)?;
    let warnings = check_extensions(&root)?;
    Ok(Document { root, raw: Raw::parse(text), bin, warnings })
}

/// Splits a GLB into its JSON and binary chunks. Skips unknown chunks, as the specification requires.
fn split_glb(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Problem> {
    let broken = |expected: String, found: String| Err(Problem::Container { expected, found });
    if bytes.len() < HEADER_SIZE {
        return broken(format!("a header of {HEADER_SIZE} bytes"), format!("a file of {} bytes", bytes.len()));
    }
    let version = u32_at(bytes, 4);
    if version != 2 {
        return Err(Problem::Version { found: format!("{version} (in the GLB header)") });
    }
    let length = u32_at(bytes, 8) as usize;
    if length < HEADER_SIZE + CHUNK_HEADER_SIZE {
        return broken("a length in the header that holds at least one chunk".into(), format!("{length} bytes"));
    }
    let Some(mut rest) = bytes.get(HEADER_SIZE..length) else {
        return broken(format!("{length} bytes as its header says"), format!("a file of {} bytes", bytes.len()));
    };
    let mut chunks = Vec::new();
    // Up to three bytes of padding may follow the last chunk.
    while rest.len() >= CHUNK_HEADER_SIZE {
        let (size, kind) = (u32_at(rest, 0) as usize, u32_at(rest, 4));
        let body = &rest[CHUNK_HEADER_SIZE..];
        if size > body.len() {
            return broken(format!("a chunk of {size} bytes as its header says"), format!("{} bytes", body.len()));
        }
        let (chunk, after) = body.split_at(size);
        chunks.push((kind, chunk));
        rest = after;
    }
    match chunks.as_slice() {
        [(CHUNK_JSON, text), (CHUNK_BIN, bin), ..] => Ok((text, Some(bin))),
        [(CHUNK_JSON, text), ..] => Ok((text, None)),
        _ => broken("a JSON chunk first".into(), "none".into()),
    }
}

fn u32_at(bytes: &[u8], offset: usize) -> u32 {
    u32::from_le_bytes([bytes[offset], bytes[offset + 1], bytes[offset + 2], bytes[offset + 3]])
}

/// Refuses content that cannot be JSON, with a better message than a parser's "line 1 column 1".
fn json_text(bytes: &[u8]) -> Result<&[u8], Problem> {
    // A byte order mark is forbidden by glTF and common in practice.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match text.iter().find(|byte| !byte.is_ascii_whitespace()) {
        Some(b'{') => Ok(text),
        None => Err(Problem::NotGltf { found: "only white space".into() }),
        Some(0xfe | 0xff) => Err(Problem::NotGltf { found: "text that is not UTF-8 (perhaps UTF-16)".into() }),
        // A look may name any file, whose bytes a message must not print.
        Some(_) => Err(Problem::NotGltf { found: format!("{} bytes of something else", bytes.len()) }),
    }
}

fn parse_json(text: &[u8]) -> Result<json::Root, Problem> {
    json::deserialize::from_slice(text).or_else(|error| {
        let Ok(mut value) = json::deserialize::from_slice::<json::Value>(text) else {
            return Err(Problem::Json(error));
        };
        if let Some(found) = other_version(&value) {
            return Err(Problem::Version { found });
        }
        // The first error has a line, but if it is repaired, it is another one that counts.
        let is_repaired = repair(&mut value);
        json::deserialize::from_value(value).map_err(|left| Problem::Json(if is_repaired { left } else { error }))
    })
}

/// The version of a file that is not glTF 2. In glTF 1.0, the lists are objects.
fn other_version(file: &json::Value) -> Option<String> {
    let version = &file["asset"]["version"];
    let text = version.as_str().map_or_else(|| version.to_string(), str::to_owned);
    if !version.is_null() && !text.starts_with('2') {
        return Some(format!("`{}`", text.escape_default()));
    }
    let has_objects = ["meshes", "nodes", "accessors"].iter().any(|list| file[list].is_object());
    has_objects.then(|| "1.0 (its lists are objects)".to_owned())
}

/// Makes what is valid, although the parser refuses it, into what the parser accepts: scenes without `nodes`, and channels of animations
/// whose target has no `node`. Returns whether there was any.
fn repair(file: &mut json::Value) -> bool {
    let mut is_repaired = false;
    // `get_mut`, since an index would add a missing member.
    let scenes = file.get_mut("scenes").and_then(json::Value::as_array_mut);
    for scene in scenes.into_iter().flatten().filter_map(json::Value::as_object_mut) {
        is_repaired |= !scene.contains_key("nodes");
        scene.entry("nodes").or_insert_with(|| json::Value::Array(Vec::new()));
    }
    let animations = file.get_mut("animations").and_then(json::Value::as_array_mut);
    let channels_of = |animation| json::Value::get_mut(animation, "channels").and_then(json::Value::as_array_mut);
    for channels in animations.into_iter().flatten().filter_map(channels_of) {
        let before = channels.len();
        channels.retain(|channel| !channel["target"].is_object() || channel["target"].get("node").is_some());
        is_repaired |= channels.len() < before;
    }
    is_repaired
}

/// Accepts version 2.x. `minVersion`, if present, must be a version that this loader implements.
fn check_version(asset: &json::Asset) -> Result<(), Problem> {
    let number = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
    };
    let accepted = match &asset.min_version {
        Some(minimum) => number(minimum) == Some((2, 0)),
        None => matches!(number(&asset.version), Some((2, _))),
    };
    let named = asset.min_version.as_ref().unwrap_or(&asset.version);
    if accepted { Ok(()) } else { Err(Problem::Version { found: format!("`{}`", named.escape_default()) }) }
}

/// An unsupported extension is an error if the file requires it, otherwise a warning.
fn check_extensions(root: &json::Root) -> Result<Vec<String>, Problem> {
    let supported = supported();
    let missing = |names: &[String]| {
        let mut names: Vec<String> = names.iter().filter(|n| !supported.contains(n.as_str())).cloned().collect();
        names.sort();
        names.dedup();
        names
    };
    let required = missing(&root.extensions_required);
    if !required.is_empty() {
        return Err(Problem::Extensions {
            names: required.join(", "),
            pronoun: if required.len() == 1 { "it" } else { "them" },
            supported: Vec::from_iter(supported.iter().copied()).join(", "),
        });
    }
    let ignored = |name: String| match IGNORED.iter().find(|(known, _)| *known == name) {
        Some((_, instead)) => format!("The extension {name} is ignored: {instead}."),
        None => {
            format!("The extension {name} is ignored: Specula does not support it, so the model may look different.")
        }
    };
    Ok(missing(&root.extensions_used).into_iter().map(ignored).collect())
}
