//! The declaration of a value: what its author wrote about it, and its unit or space.

use super::definition::symbol_of;
use crate::shader::symbols::{Symbol, SymbolKind, Symbols, comment_of};
use crate::shader::trace::Act;
use crate::shader::{ShaderSet, TreePath};

/// Endings of names in the shipped tree, and the unit or space of such values.
const ENDINGS: [(&str, &str); 9] = [
    ("_ws", "world space"),
    ("_ts", "tangent space"),
    ("_clip", "clip space"),
    ("_per_m", "1/m"),
    ("_px", "pixels"),
    ("_uv", "texture coordinates"),
    ("_rad", "radians"),
    ("_m", "m"),
    ("_s", "s"),
];
/// Names of photometric quantities in the shipped tree, and their units.
const QUANTITIES: [(&str, &str); 5] = [
    ("irradiance", "lx"),
    ("radiance", "cd/m²"),
    ("luminance", "cd/m²"),
    ("illuminance", "lx"),
    ("intensity", "cd, lx or cd/m²"),
];

/// The declaration of a value.
#[derive(Debug, PartialEq)]
pub(super) struct Declared {
    /// The declaration without its initializer.
    pub(super) code: String,
    /// The comment that explains it.
    pub(super) comment: Option<String>,
    pub(super) file: TreePath,
    /// From 1.
    pub(super) line: u32,
    /// The unit or the space, as far as the annotation or the name tells it.
    pub(super) unit: Option<String>,
}

/// The declaration of what a statement in a line computes. `name`: the variable with its members, as `brdf.n_dot_l`.
pub(super) fn declared(shaders: &ShaderSet, (path, line): (&TreePath, u32), act: Act, name: &str) -> Option<Declared> {
    if act == Act::Return {
        let text = shaders.texts.get(path)?;
        let byte = text.split_inclusive('\n').take(line as usize - 1).map(str::len).sum();
        let symbols = Symbols::of(text);
        return Some(Declared::new(text, path, symbols.function_at(byte)?));
    }
    let mut parts = name.split(['.', '[']).filter(|part| !part.ends_with(']'));
    let (mut file, mut symbol) = symbol_of(shaders, (path, line), parts.next()?)?;
    for part in parts {
        // A component of a vector has the declaration of the vector.
        let Some(member) = member(shaders, &symbol.type_name, part) else { break };
        (file, symbol) = member;
    }
    Some(Declared::new(shaders.texts.get(&file)?, &file, &symbol))
}

/// The member of a struct, in whichever file declares it.
fn member(shaders: &ShaderSet, owner: &str, name: &str) -> Option<(TreePath, Symbol)> {
    let declares = |text: &str| text.contains(owner) && text.contains(name);
    shaders.texts.iter().filter(|(_, text)| !owner.is_empty() && declares(text)).find_map(|(path, text)| {
        let symbols = Symbols::of(text);
        let member = symbols.members(owner).find(|member| member.name == name).cloned();
        Some((path.clone(), member?))
    })
}

impl Declared {
    fn new(text: &str, file: &TreePath, symbol: &Symbol) -> Self {
        let code = text.get(symbol.signature.clone()).unwrap_or_default();
        let comment = comment_of(text, symbol);
        let annotated = comment.as_deref().and_then(|comment| comment.split_once("unit=\"")?.1.split('"').next());
        Self {
            code: code.split_whitespace().collect::<Vec<_>>().join(" "),
            unit: annotated.or_else(|| unit_of(symbol)).map(str::to_owned),
            comment,
            file: file.clone(),
            line: text[..symbol.bytes.start].matches('\n').count() as u32 + 1,
        }
    }
}

/// The unit or the space that a name tells.
fn unit_of(symbol: &Symbol) -> Option<&'static str> {
    let is_number =
        symbol.kind == SymbolKind::Function || symbol.type_name == "float" || symbol.type_name.contains("vec");
    let name = symbol.name.as_str();
    let ending = ENDINGS.iter().find(|(ending, _)| name.ends_with(ending));
    let is_quantity = |of: &str| name.strip_suffix(of).is_some_and(|rest| rest.is_empty() || rest.ends_with('_'));
    let quantity = || QUANTITIES.iter().find(|(of, _)| is_quantity(of));
    ending.or_else(quantity).filter(|_| is_number).map(|(_, unit)| *unit)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use super::*;

    #[test]
    fn a_value_has_the_comment_and_the_unit_of_its_declaration() {
        let surface = "// What the light meets.\nstruct Surface {\n    vec3 position_ws;   // where it is\n    float size; \
            //@ui \"Size\" 0..1 unit=\"mm\" = 0.2\n    Inner inner[2];\n};\n";
        let own = "// Half of it.\nfloat half_of(Surface s, float radiance) {\n    float plain = radiance;\n    \
            s.size = plain;\n    return plain;\n}\n";
        let inner = "struct Inner { vec2 at_px; };\n";
        let files = [("own.glsl", own), ("surface.glsl", surface), ("inner.glsl", inner)];
        let texts = files.map(|(path, text)| (TreePath::from(path), Arc::<str>::from(text)));
        let shaders = ShaderSet { texts: BTreeMap::from(texts), ..ShaderSet::default() };
        let of = |line: u32, act: Act, name: &str| {
            let found = declared(&shaders, (&TreePath::from("own.glsl"), line), act, name)?;
            Some((found.code, found.comment, format!("{}:{}", found.file, found.line), found.unit))
        };
        let expected = |code: &str, comment: Option<&str>, place: &str, unit: Option<&str>| {
            Some((code.to_owned(), comment.map(str::to_owned), place.to_owned(), unit.map(str::to_owned)))
        };
        assert_eq!(
            of(4, Act::Store, "s.position_ws.x"),
            expected("vec3 position_ws", Some("where it is"), "surface.glsl:3", Some("world space"))
        );
        let annotation = "@ui \"Size\" 0..1 unit=\"mm\" = 0.2";
        assert_eq!(of(4, Act::Store, "s.size"), expected("float size", Some(annotation), "surface.glsl:4", Some("mm")));
        assert_eq!(of(4, Act::Store, "s.inner[1].at_px"), expected("vec2 at_px", None, "inner.glsl:1", Some("pixels")));
        assert_eq!(of(3, Act::Store, "plain"), expected("float plain", None, "own.glsl:3", None));
        assert_eq!(of(2, Act::Argument, "radiance"), expected("float radiance", None, "own.glsl:2", Some("cd/m²")));
        let head = "float half_of(Surface s, float radiance)";
        assert_eq!(of(5, Act::Return, ""), expected(head, Some("Half of it."), "own.glsl:2", None));
        assert_eq!(of(5, Act::Store, "unknown"), None);
    }
}
