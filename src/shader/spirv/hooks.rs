//! Reads from a module what the author's hooks change: members of the surface, and vertices.
//!
//! The features of a hook's extensions count for every lit material (`PipelineRequest::hook_features`). If
//! `user_vertex` moves vertices, a mode that traces tells the user (`PipelineRequest::limit`).

use foldhash::{HashMap, HashSet, HashSetExt};

use super::opcode as op;
use super::operands::text;
use super::specialize::{Id, first_function, instructions, opcode};
use crate::interface::{
    FEATURE_ANISOTROPY, FEATURE_CLEARCOAT, FEATURE_CLEARCOAT_NORMAL, FEATURE_CONDUCTOR, FEATURE_DIFFUSE_TRANSMISSION,
    FEATURE_DISPERSION, FEATURE_IRIDESCENCE, FEATURE_SHEEN, FEATURE_TRANSMISSION, FEATURE_VOLUME,
};

/// glslang's names of the hooks begin like this.
const SURFACE_HOOK: &str = "user_surface(";
const VERTEX_HOOK: &str = "user_vertex(";

/// Members of `Surface` that bring an extension into the picture, and its feature. Other members of an extension change nothing
/// while these are neutral. Neutral is 0, except for a conductor and for the normal of the clear coat.
const FEATURES: [(&str, u32); 11] = [
    ("anisotropy", FEATURE_ANISOTROPY),
    ("conductor_n", FEATURE_CONDUCTOR),
    ("conductor_k", FEATURE_CONDUCTOR),
    ("clearcoat", FEATURE_CLEARCOAT),
    ("clearcoat_n", FEATURE_CLEARCOAT_NORMAL),
    ("sheen_color", FEATURE_SHEEN),
    ("iridescence", FEATURE_IRIDESCENCE),
    ("transmission", FEATURE_TRANSMISSION),
    ("thickness", FEATURE_VOLUME),
    ("dispersion", FEATURE_DISPERSION),
    ("diffuse_transmission", FEATURE_DIFFUSE_TRANSMISSION),
];

/// OpFunctionParameter, OpFMul, OpVectorTimesScalar
const PARAMETER: u32 = 55;
const PRODUCTS: [u32; 2] = [133, 142];

/// Effects of the hooks of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hooks {
    /// `FEATURE_*` bits of the extensions whose members `user_surface` sets.
    pub features: u32,
    /// Whether `user_vertex` changes a vertex.
    pub moves_vertices: bool,
}

impl Hooks {
    /// Reads an unoptimized module. Code that a constant switches off counts too.
    pub fn of(spirv: &[u32]) -> Self {
        let surface = stores(spirv, SURFACE_HOOK, "Surface");
        let set = surface.iter().filter(|(_, keeps_zero)| !keeps_zero);
        Self {
            features: set.fold(0, |all, (member, _)| {
                all | FEATURES.iter().filter(|(name, _)| name == member).fold(0, |bits, (_, bit)| bits | bit)
            }),
            moves_vertices: !stores(spirv, VERTEX_HOOK, "Vertex").is_empty(),
        }
    }
}

/// The members of a struct that a function, or one that it calls, stores to, and whether a store leaves 0 at 0: of a product with the old
/// value, or of the number 0. A member with stores of both kinds is there twice.
fn stores(spirv: &[u32], function: &str, structure: &str) -> Vec<(String, bool)> {
    found(spirv, function, structure).unwrap_or_default()
}

fn found(spirv: &[u32], function: &str, structure: &str) -> Option<Vec<(String, bool)>> {
    let all = instructions(spirv)?;
    let (globals, code) = all.split_at(first_function(&all));
    let names = || globals.iter().filter(|i| opcode(i) == op::NAME);
    let hook = names().find(|i| text(&i[2..]).starts_with(function))?[1];
    let named: HashSet<Id> = names().filter(|i| text(&i[2..]) == structure).map(|i| i[1]).collect();
    let types: HashSet<Id> =
        globals.iter().filter(|i| opcode(i) == op::TYPE_STRUCT && named.contains(&i[1])).map(|i| i[1]).collect();
    let pointers: HashSet<Id> =
        globals.iter().filter(|i| opcode(i) == op::TYPE_POINTER && types.contains(&i[3])).map(|i| i[1]).collect();
    let constants: HashMap<Id, u32> =
        globals.iter().filter(|i| opcode(i) == op::CONSTANT).map(|i| (i[2], i[3])).collect();
    let bodies: HashMap<Id, &[&[u32]]> = code
        .split_inclusive(|i| opcode(i) == op::FUNCTION_END)
        .filter_map(|body| Some((*body.first()?.get(2)?, body)))
        .collect();

    let mut members: HashSet<(u32, bool)> = HashSet::new();
    let (mut seen, mut open) = (HashSet::from_iter([hook]), vec![hook]);
    while let Some(id) = open.pop() {
        let body = bodies.get(&id).copied().unwrap_or_default();
        let called = body.iter().filter(|i| opcode(i) == op::FUNCTION_CALL).filter_map(|i| i.get(3).copied());
        open.extend(called.filter(|id| seen.insert(*id)).collect::<Vec<_>>());
        members.extend(stored_in(body, &pointers, &constants));
    }
    let names = globals.iter().filter(|i| opcode(i) == op::MEMBER_NAME && types.contains(&i[1]));
    let is_stored = |(i, keeps_zero): &(&&[u32], bool)| members.contains(&(i[2], *keeps_zero));
    let both = names.flat_map(|i| [(i, false), (i, true)]);
    Some(both.filter(is_stored).map(|(i, keeps_zero)| (text(&i[3..]), keeps_zero)).collect())
}

/// The numbers of the members that the body of a function stores to, and whether the store leaves 0 at 0.
fn stored_in(body: &[&[u32]], pointers: &HashSet<Id>, constants: &HashMap<Id, u32>) -> HashSet<(u32, bool)> {
    let mut structures: HashSet<Id> = HashSet::new();
    // Pointers to members, loaded members, and products of them, by their ids.
    let (mut places, mut values): (HashMap<Id, u32>, HashMap<Id, u32>) = (HashMap::default(), HashMap::default());
    let mut stored = HashSet::new();
    for i in body.iter().filter(|i| i.len() > 2) {
        match opcode(i) {
            PARAMETER | op::VARIABLE if pointers.contains(&i[1]) => {
                structures.insert(i[2]);
            }
            op::ACCESS_CHAIN | op::IN_BOUNDS_ACCESS_CHAIN if structures.contains(&i[3]) => {
                if let Some(member) = i.get(4).and_then(|index| constants.get(index)) {
                    places.insert(i[2], *member);
                }
            }
            op::LOAD => {
                if let Some(member) = places.get(&i[3]) {
                    values.insert(i[2], *member);
                }
            }
            product if PRODUCTS.contains(&product) => {
                let factor = i[3..].iter().find_map(|id| values.get(id)).copied();
                values.extend(factor.map(|member| (i[2], member)));
            }
            op::STORE => {
                let Some(member) = places.get(&i[1]) else { continue };
                let is_zero = constants.get(&i[2]) == Some(&0);
                stored.insert((*member, is_zero || values.get(&i[2]) == Some(member)));
            }
            _ => {}
        }
    }
    stored
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;

    fn hooks(code: &str) -> Hooks {
        let text = format!(
            "#version 460
             struct Surface {{ vec3 base_color; float clearcoat; vec3 sheen_color; float transmission; vec3 clearcoat_n; }};
             layout(location = 0) in vec4 uv;\nlayout(location = 0) out vec4 color;\n{code}
             void main() {{ Surface s; s.base_color = vec3(0.5); s.clearcoat = 1.0; user_surface(s); color = vec4(s.base_color, s.clearcoat); }}"
        );
        let source = Source::memory([("m.frag", text.as_str())]);
        Hooks::of(&Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.frag".into()).result.unwrap())
    }

    #[test]
    fn members_that_the_hook_sets_have_their_features() {
        for (body, features) in [
            ("", 0),
            ("s.base_color *= 0.5;", 0),
            ("s.clearcoat = 1.0;", FEATURE_CLEARCOAT),
            ("if (uv.x > 0.5) s.sheen_color.g = uv.y;", FEATURE_SHEEN),
            ("s.clearcoat = mix(s.clearcoat, 1.0, uv.x);", FEATURE_CLEARCOAT),
            ("s.clearcoat_n = uv.xyz;", FEATURE_CLEARCOAT_NORMAL),
            // A product of 0 stays 0.
            ("s.transmission *= uv.x; s.sheen_color *= uv.x; s.clearcoat = 0.0;", 0),
        ] {
            assert_eq!(hooks(&format!("void user_surface(inout Surface s) {{ {body} }}")).features, features, "{body}");
        }
    }

    #[test]
    fn helpers_of_the_hook_count_and_other_functions_do_not() {
        let helpers = "void coat(inout Surface s) { s.clearcoat = uv.x; }
            Surface velvet(Surface s) { s.sheen_color = uv.xyz; return s; }
            void glass(inout Surface s) { s.transmission = 1.0; }";
        let hook = "void user_surface(inout Surface s) { coat(s); s = velvet(s); }";
        let features = hooks(&format!("{helpers}\n{hook}")).features;
        assert_eq!(features, FEATURE_CLEARCOAT | FEATURE_SHEEN);
    }

    #[test]
    fn any_store_moves_a_vertex() {
        let moves = |body: &str| {
            let text = format!(
                "#version 460\nstruct Vertex {{ vec3 position; vec2 uv0; }};\nvoid user_vertex(inout Vertex vertex) {{ {body} }}
                 void main() {{ Vertex v; v.position = vec3(gl_VertexIndex); v.uv0 = vec2(0.0); user_vertex(v); gl_Position = v.position.xyzz; }}"
            );
            let source = Source::memory([("m.vert", text.as_str())]);
            let words = Compiler::new().unwrap().compile(&Snapshot::new(&source), &"m.vert".into()).result.unwrap();
            Hooks::of(&words).moves_vertices
        };
        assert!(!moves(""));
        assert!(moves("vertex.position.y *= 0.5;"));
        assert!(moves("vertex.position.x = 0.0;"));
        assert!(moves("vertex.uv0 += 1.0;"));
    }

    #[test]
    fn words_that_are_no_module_change_nothing() {
        assert_eq!(Hooks::of(&[1, 2, 3]), Hooks::default());
        assert_eq!(Hooks::of(&[]), Hooks::default());
    }
}
