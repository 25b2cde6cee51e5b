//! Reads from a module what the author's hooks change: members of the surface, lights, and vertices.
//!
//! The features of a hook's extensions count for every lit material (`PipelineRequest::hook_features`). If
//! `user_vertex` moves vertices, a mode that traces tells the user (`PipelineRequest::limit`). If `user_light` changes more than the
//! intensity of a light, no grid can tell which points the light reaches (`scene::light_grid`).

use foldhash::{HashMap, HashSet};

use super::module::{Function, Id, Module};
use super::op::{Op, text};
use crate::interface::{
    FEATURE_ANISOTROPY, FEATURE_CLEARCOAT, FEATURE_CLEARCOAT_NORMAL, FEATURE_CONDUCTOR, FEATURE_DIFFUSE_TRANSMISSION,
    FEATURE_DISPERSION, FEATURE_IRIDESCENCE, FEATURE_SHEEN, FEATURE_TRANSMISSION, FEATURE_VOLUME,
};

/// glslang's names of the hooks begin like this.
const SURFACE_HOOK: &str = "user_surface(";
const LIGHT_HOOK: &str = "user_light(";
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

/// Effects of the hooks of a stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hooks {
    /// `FEATURE_*` bits of the extensions whose members `user_surface` sets.
    pub features: u32,
    /// Whether `user_vertex` changes a vertex.
    pub moves_vertices: bool,
    /// Whether `user_light` changes the place, direction, range or cone of a light.
    pub moves_lights: bool,
}

impl Hooks {
    /// Reads an unoptimized module. Code that a constant switches off counts too.
    pub fn of(spirv: &[u32]) -> Self {
        let Some(module) = Module::parse(spirv) else { return Self::default() };
        let surface = stores(&module, SURFACE_HOOK, "Surface\0");
        let set = surface.iter().filter(|(_, keeps_zero)| !keeps_zero);
        Self {
            features: set.fold(0, |all, (member, _)| {
                all | FEATURES.iter().filter(|(name, _)| name == member).fold(0, |bits, (_, bit)| bits | bit)
            }),
            moves_vertices: !stores(&module, VERTEX_HOOK, "Vertex\0").is_empty(),
            moves_lights: stores(&module, LIGHT_HOOK, "Light\0").iter().any(|(member, _)| member != "intensity")
                || replaces(&module, LIGHT_HOOK, "Light\0"),
        }
    }
}

/// The members of a struct that a function, or one that it calls, stores to, and whether a store leaves 0 at 0: of a product with the old
/// value, or of the number 0. A member with stores of both kinds is there twice.
fn stores(module: &Module, function: &str, structure: &str) -> Vec<(String, bool)> {
    let hook = module.named(function).next();
    let functions = hook.and_then(|hook| module.callees_first(hook)).unwrap_or_default();
    let types: HashSet<Id> = module.named(structure).filter(|id| is_struct(module, *id)).collect();
    let members: HashSet<(u32, bool)> =
        functions.into_iter().flat_map(|place| stored_in(module, &module.functions[place], &types)).collect();
    let names = module.debug.iter().filter(|i| i.op == Op::MemberName).map(|i| &module[*i]);
    let both = names.filter(|words| types.contains(&words[1])).flat_map(|words| [(words, false), (words, true)]);
    let stored = both.filter(|(words, keeps_zero)| members.contains(&(words[2], *keeps_zero)));
    stored.map(|(words, keeps_zero)| (text(&words[3..]), keeps_zero)).collect()
}

/// Whether a function, or one that it calls, stores a whole struct of this type through a parameter.
fn replaces(module: &Module, function: &str, structure: &str) -> bool {
    let hook = module.named(function).next();
    let functions = hook.and_then(|hook| module.callees_first(hook)).unwrap_or_default();
    let types: HashSet<Id> = module.named(structure).filter(|id| is_struct(module, *id)).collect();
    let is_parameter = |id: Id| {
        let parameter = module.definition(id).filter(|i| i.op == Op::FunctionParameter);
        parameter.and_then(|i| module.pointer(module[i][1])).is_some_and(|(_, to)| types.contains(&to))
    };
    let bodies = functions.into_iter().flat_map(|place| module.functions[place].body());
    let mut stores = bodies.filter(|i| i.op == Op::Store);
    stores.any(|i| module[i].get(1).is_some_and(|to| is_parameter(*to)))
}

fn is_struct(module: &Module, id: Id) -> bool {
    module.defined(Op::TypeStruct, id).is_some()
}

/// The numbers of the members of structs with these types that a function stores to, and whether the store leaves 0 at 0.
fn stored_in(module: &Module, function: &Function, types: &HashSet<Id>) -> HashSet<(u32, bool)> {
    let is_structure = |id: Id| {
        let i = module.definition(id).filter(|i| matches!(i.op, Op::FunctionParameter | Op::Variable));
        i.and_then(|i| module.pointer(module[i][1])).is_some_and(|(_, to)| types.contains(&to))
    };
    // Pointers to members, loaded members, and products of them, by their ids.
    let (mut places, mut values): (HashMap<Id, u32>, HashMap<Id, u32>) = (HashMap::default(), HashMap::default());
    let mut stored = HashSet::default();
    for i in function.body() {
        match (i.op, &module[i]) {
            (Op::AccessChain | Op::InBoundsAccessChain, [_, _, id, base, index, ..]) if is_structure(*base) => {
                places.extend(module.number(*index).map(|member| (*id, member)));
            }
            (Op::Load, [_, _, id, from, ..]) => values.extend(places.get(from).map(|member| (*id, *member))),
            (Op::FMul | Op::VectorTimesScalar, [_, _, id, factors @ ..]) => {
                let factor = factors.iter().find_map(|id| values.get(id)).copied();
                values.extend(factor.map(|member| (*id, member)));
            }
            (Op::Store, [_, to, value, ..]) => {
                let Some(member) = places.get(to) else { continue };
                let keeps_zero = module.number(*value) == Some(0) || values.get(value) == Some(member);
                stored.insert((*member, keeps_zero));
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
