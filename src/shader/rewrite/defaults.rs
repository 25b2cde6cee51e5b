//! The values of the settings as the new defaults of parameters and constants.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::Edit;
use super::literals::float;
use crate::message::did_you_mean;
use crate::settings::ShaderValue;
use crate::shader::glsl::{Line, Token, is_name, is_word, lines};
use crate::shader::source::TreePath;
use crate::shader::spirv::reflect::Scalar;
use crate::shader::values::{constant_number, misfits, parameter_numbers};
use crate::shader::{Constant, Parameter, ShaderSet};

/// The edits that make `values` the defaults of the constants and parameters that they name, or of `only` one of them. `display`
/// gives the path of a file as annotations know it. Values that are the defaults already give none.
///
/// # Errors
/// A message if `only` is no name, if a value does not fit, or if a declaration has a form that cannot be rewritten.
pub fn defaults(
    shaders: &ShaderSet,
    values: &BTreeMap<String, ShaderValue>,
    only: Option<&str>,
    display: impl Fn(&TreePath) -> String,
) -> Result<Vec<Edit>, String> {
    let parameters = shaders.parameters.iter().map(|parameter| parameter.name.as_str());
    let names = parameters.chain(shaders.constants.iter().map(|constant| constant.name.as_str()));
    if let Some(only) = only.filter(|only| names.clone().all(|name| name != *only)) {
        return Err(format!("there is no parameter `{only}`.{}", did_you_mean(only, names)));
    }
    let wanted: BTreeMap<String, ShaderValue> = values
        .iter()
        .filter(|(name, _)| only.is_none_or(|only| only == *name))
        .map(|(n, v)| (n.clone(), v.clone()))
        .collect();
    if let Some(misfit) = misfits(&wanted, shaders).into_iter().next() {
        return Err(misfit);
    }
    let text_of = |file: &str| -> Result<(&TreePath, &Arc<str>), String> {
        let found = shaders.texts.iter().find(|(path, _)| display(path) == file);
        found.ok_or_else(|| format!("{file} is no file of this tree"))
    };
    let mut edits = Vec::new();
    for (name, value) in &wanted {
        if let Some(parameter) = shaders.parameters.iter().find(|parameter| parameter.name == *name) {
            edits.extend(of_parameter(parameter, value, text_of(&parameter.file)?)?);
        } else if let Some(constant) = shaders.constants.iter().find(|constant| constant.name == *name) {
            edits.extend(of_constant(constant, value, text_of(&constant.file)?)?);
        }
    }
    edits.sort_by(|a, b| (&a.path, a.line, a.bytes.start).cmp(&(&b.path, b.line, b.bytes.start)));
    Ok(edits)
}

fn of_parameter(
    parameter: &Parameter,
    value: &ShaderValue,
    (path, text): (&TreePath, &Arc<str>),
) -> Result<Option<Edit>, String> {
    let numbers = parameter_numbers(parameter, Some(value))?;
    let written = |number: &f64| match parameter.kind.scalar() {
        Scalar::Bool => (*number != 0.0).to_string(),
        Scalar::Float => (*number as f32).to_string(),
        Scalar::Int | Scalar::Uint => (*number as i64).to_string(),
    };
    let new = numbers.iter().map(written).collect::<Vec<_>>().join(" ");
    let all = lines(text);
    let line = all.get((parameter.line as usize).wrapping_sub(1));
    let found = line.and_then(|line| Some((line, line.annotation?)));
    let (line, start) = found.ok_or_else(|| lost(&parameter.name, path, parameter.line))?;
    let end = line.raw.trim_end().len();
    let (bytes, new) = match default_at(&line.raw[..end], start) {
        Some(at) => (at..end, new),
        None => (end..end, format!(" = {new}")),
    };
    let is_same = parameter.default.iter().map(|n| *n as f32).eq(numbers.iter().map(|n| *n as f32));
    Ok((!is_same).then(|| edit(path, &parameter.name, line, bytes, new)))
}

/// The first byte of the default in an annotation: behind a `=` that begins a word outside of quotes.
fn default_at(raw: &str, start: usize) -> Option<usize> {
    let mut is_quoted = false;
    let mut before = ' ';
    for (at, c) in raw[start..].char_indices() {
        if c == '"' {
            is_quoted = !is_quoted;
        }
        if c == '=' && !is_quoted && before.is_whitespace() {
            let at = start + at + 1;
            return Some(at + (raw[at..].len() - raw[at..].trim_start().len()));
        }
        before = c;
    }
    None
}

fn of_constant(
    constant: &Constant,
    value: &ShaderValue,
    (path, text): (&TreePath, &Arc<str>),
) -> Result<Option<Edit>, String> {
    let number = constant_number(constant, value)?;
    let all = lines(text);
    let first = (constant.line as usize).saturating_sub(1);
    // The declaration stands on the line of its annotation or follows it.
    let declared = all.iter().skip(first).find(|line| !line.is_blank());
    let line = declared.ok_or_else(|| lost(&constant.name, path, constant.line))?;
    let bytes = initializer(line, &constant.name).ok_or_else(|| lost(&constant.name, path, line.number))?;
    let default = match constant.scalar {
        Scalar::Float => f64::from(f32::from_bits(constant.default)),
        Scalar::Int => f64::from(constant.default.cast_signed()),
        Scalar::Uint | Scalar::Bool => f64::from(constant.default),
    };
    if default as f32 == number as f32 && (constant.scalar == Scalar::Float || default == number) {
        return Ok(None);
    }
    let literal = match constant.scalar {
        Scalar::Bool => (number != 0.0).to_string(),
        Scalar::Float => float(number),
        Scalar::Int => (number as i64).to_string(),
        Scalar::Uint => format!("{}u", number as i64),
    };
    let new = sibling(&all, &line.code[bytes.clone()], &literal).unwrap_or(literal);
    Ok(Some(edit(path, &constant.name, line, bytes, new)))
}

/// The bytes of the initializer in `... NAME = INITIALIZER;`.
fn initializer(line: &Line<'_>, name: &str) -> Option<Range<usize>> {
    let tokens = line.tokens();
    let assigns = |three: &[Token<'_>]| three[0].text == name && three[1].text == "=" && three[2].text != "=";
    let start = tokens.windows(3).position(assigns)? + 2;
    let end = start + tokens[start..].iter().position(|token| token.text == ";")?;
    let value = &tokens[start..end];
    Some(value.first()?.bytes.start..value.last()?.bytes.end)
}

/// The name of the new value, if the old one is a name: a constant beside the one of that name, in an unbroken list of constants.
fn sibling(all: &[Line<'_>], old: &str, new: &str) -> Option<String> {
    if !is_name(old) || !old.chars().all(is_word) {
        return None;
    }
    let plain = |line: &Line<'_>| -> Option<(String, String)> {
        match line.tokens().iter().map(|token| token.text).collect::<Vec<_>>().as_slice() {
            ["const", _, name, "=", value, ";"] => Some(((*name).to_owned(), (*value).to_owned())),
            _ => None,
        }
    };
    let at = all.iter().position(|line| plain(line).is_some_and(|(name, _)| name == old))?;
    let before = all[..at].iter().rev().map_while(plain);
    let mut list = before.chain(all[at..].iter().map_while(plain));
    list.find(|(_, value)| value == new).map(|(name, _)| name)
}

fn edit(path: &TreePath, name: &str, line: &Line<'_>, bytes: Range<usize>, new: String) -> Edit {
    Edit { path: path.clone(), name: name.to_owned(), line: line.number, bytes, before: line.raw.to_owned(), new }
}

fn lost(name: &str, path: &TreePath, line: u32) -> String {
    format!("{path}:{line}: the default of `{name}` has a form that cannot be rewritten; change it in the file")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::rewrite::applied;
    use crate::shader::{Change, Compiler, Library, Source, Update};

    const PARAMS: &str = "#version 460\n#extension GL_EXT_scalar_block_layout : require\r\n\
        const uint GGX = 0u;\nconst uint BECKMANN = 1u;\n\
        //@ui \"NDF\" choice GGX=0 Beckmann=1 doc=\"a = b\"\nlayout(constant_id = 100) const uint NDF = GGX; // NDF = 7;\n\
        layout(constant_id = 101) const bool ON = false;  //@ui \"On\"\r\n\
        layout(constant_id = 102) const float SCALE = 1.0; //@ui 0..9\n\
        layout(set = 0, binding = 2, scalar) uniform Params {\n\
        \tfloat rim;   //@ui \"Rim = 1\" 0..1 group=\"M = x\" = 0.2  \r\n\
        \tvec3 tint;   //@ui color=1 2 3\n    vec3 sky; //@ui color\n    bool lit; //@ui\r\n    int kind; //@ui choice A=0 B=2 =0\n};\n\
        layout(location = 0) out vec4 color;\nvoid main() { color = vec4(rim * SCALE * tint + sky, float(kind) + float(NDF)); \
        if (ON && lit) color *= 2.0; }\n";

    fn shaders() -> Arc<ShaderSet> {
        let text = PARAMS.replace("//@ui color=1 2 3", "//@ui color = 1 2 3");
        let source = Source::memory([("main.frag", text.as_str())]);
        let mut library = Library::new(source, Arc::new(Compiler::new().unwrap()), &["main.frag"]);
        match library.update(&Change::All) {
            Update::Ready(set, _) => set,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn values_become_defaults_and_nothing_else_changes() {
        let shaders = shaders();
        let values = BTreeMap::from([
            ("NDF".to_owned(), ShaderValue::Name("Beckmann".to_owned())),
            ("ON".to_owned(), ShaderValue::Bool(true)),
            ("SCALE".to_owned(), ShaderValue::Float(3.0)),
            ("rim".to_owned(), ShaderValue::Float(f64::from(0.35_f32))),
            ("tint".to_owned(), ShaderValue::Vector(vec![1.0, 0.5, 3.0])),
            ("sky".to_owned(), ShaderValue::Vector(vec![0.0, 0.25, 1.0])),
            ("lit".to_owned(), ShaderValue::Bool(true)),
            ("kind".to_owned(), ShaderValue::Int(2)),
        ]);
        let display = |path: &TreePath| path.to_string();
        let edits = defaults(&shaders, &values, None, display).unwrap();
        let text = shaders.texts.get(&TreePath::from("main.frag")).unwrap();
        let new = String::from_utf8(applied(text.as_bytes(), &edits).unwrap()).unwrap();
        let mut expected = text.to_string();
        for (old, new) in [
            ("NDF = GGX; // NDF", "NDF = BECKMANN; // NDF"),
            ("ON = false;", "ON = true;"),
            ("SCALE = 1.0;", "SCALE = 3.0;"),
            ("\"M = x\" = 0.2  \r\n", "\"M = x\" = 0.35  \r\n"),
            ("color = 1 2 3\n", "color = 1 0.5 3\n"),
            ("sky; //@ui color\n", "sky; //@ui color = 0 0.25 1\n"),
            ("lit; //@ui\r\n", "lit; //@ui = true\r\n"),
            ("B=2 =0\n", "B=2 =2\n"),
        ] {
            assert!(expected.contains(old), "{old}");
            expected = expected.replacen(old, new, 1);
        }
        assert_eq!(new, expected);
        let one = defaults(&shaders, &values, Some("rim"), display).unwrap();
        assert_eq!(one.iter().map(|edit| (edit.old(), edit.new.as_str())).collect::<Vec<_>>(), [("0.2", "0.35")]);
    }

    #[test]
    fn a_default_is_not_written_again_and_a_misfit_never() {
        let shaders = shaders();
        let of = |value| {
            let values = BTreeMap::from([("rim".to_owned(), value)]);
            defaults(&shaders, &values, None, |path| path.to_string())
        };
        assert_eq!(of(ShaderValue::Float(0.2)), Ok(Vec::new()));
        assert!(of(ShaderValue::Float(7.0)).unwrap_err().contains("it can be 0 to 1"));
    }
}
