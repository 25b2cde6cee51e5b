//! Reads the block of the draw from a buffer instead of the push constants, so that one command can draw many meshes.
//!
//! Shaders name the block `draw` either way. A rewritten vertex stage takes the number of the draw from `gl_BaseInstance`,
//! which the command sets, and hands it to the fragment stage, which has no such input. `gl_InstanceIndex` counts from the
//! base instance, so it is reduced by it: users' stages count their instances from 0 as before. The push constants hold the
//! address of the draws alone.

use foldhash::{HashSet, HashSetExt};

use super::enums::{built_in, decoration, model, storage};
use super::module::{Function, Id, Instruction, Module, Type};
use super::op::Op;
use crate::interface::Draw;

/// The location that carries the number of the draw: the last that every device has.
const LOCATION: u32 = 15;
/// Bytes of a device address, and of all other scalars of the block.
const ADDRESS: u32 = 8;
const SCALAR: u32 = 4;
/// The bit of memory operands behind which an alignment stands.
const ALIGNED: u32 = 2;
/// Capabilities: stages with this one use the base instance themselves.
const DRAW_PARAMETERS: u32 = 4427;

/// Whether a module, and with it each of its specializations, can be rewritten: it is a vertex or a fragment stage that reads members
/// of its push constants alone, and uses neither `LOCATION` nor `gl_BaseInstance`.
pub fn can_index_draws(words: &[u32]) -> bool {
    let Some(module) = Module::parse(words) else { return false };
    let Some(model) = module.model().filter(|of| matches!(*of, model::VERTEX | model::FRAGMENT)) else { return false };
    let class = if model == model::VERTEX { storage::OUTPUT } else { storage::INPUT };
    let is_free = module.globals.iter().filter(|i| i.op == Op::Variable && module[**i][3] == class).all(|i| {
        let locations = module.pointer(module[*i][1]).map_or(0, |(_, to)| locations(&module, to));
        module.decoration(module[*i][2], decoration::LOCATION).is_none_or(|first| first + locations <= LOCATION)
    });
    let is_free = is_free
        && !module.decorations.iter().any(|i| i.op == Op::MemberDecorate && module[*i][3] == decoration::LOCATION);
    let has_capability = module.head.iter().any(|i| i.op == Op::Capability && module[*i][1] == DRAW_PARAMETERS);
    is_free && !has_capability && pushed(&module).is_none_or(|block| reads_members_alone(&module, block))
}

/// Rewrites a specialization of a module that [`can_index_draws`]. Other modules stay as they are.
pub(super) fn index_draws(module: &mut Module) {
    let is_vertex = match module.model() {
        Some(model::VERTEX) => true,
        Some(model::FRAGMENT) => false,
        _ => return,
    };
    let block = pushed(module).filter(|block| reads_members_alone(module, *block));
    let instance = is_vertex.then(|| instance_index(module)).flatten();
    if !is_vertex && block.is_none() {
        return;
    }
    let rewriter = Rewriter::declare(module, is_vertex, block);
    let mut functions = std::mem::take(&mut module.functions);
    for function in &mut functions {
        rewriter.function(module, function, block, instance);
    }
    if let (Some(output), Some(main)) = (rewriter.output, module.entry_function())
        && let Some(first) = functions.iter_mut().find(|f| f.id == main).and_then(|f| f.blocks.first_mut())
    {
        let variables = first.body.iter().take_while(|i| i.op == Op::Variable).count();
        let mut code = Vec::new();
        let number = module.emit(&mut code, Op::Load, rewriter.int, &[rewriter.number]);
        code.push(module.make(Op::Store, &[output, number]));
        first.body.splice(variables..variables, code);
    }
    module.functions = functions;
}

/// The variable with the push constants.
fn pushed(module: &Module) -> Option<Id> {
    let found = module.globals.iter().find(|i| i.op == Op::Variable && module[**i][3] == storage::PUSH_CONSTANT);
    found.map(|i| module[*i][2])
}

/// Whether nothing is done with a block but loading its members.
fn reads_members_alone(module: &Module, block: Id) -> bool {
    let mut places = HashSet::new();
    module.code().all(|i| match (i.op, &module[i]) {
        (Op::AccessChain | Op::InBoundsAccessChain, [_, _, id, base, ..]) => {
            if *base == block || places.contains(base) {
                places.insert(*id);
            }
            true
        }
        (Op::Load, [_, _, _, from, ..]) => *from != block,
        _ if !i.op.is_known() => !module[i][1..].contains(&block),
        _ => !module.ids_of(i).any(|id| id == block || places.contains(&id)),
    })
}

/// The variable `gl_InstanceIndex`.
fn instance_index(module: &Module) -> Option<Id> {
    let is_it = |id: &Id| module.decoration(*id, decoration::BUILT_IN) == Some(built_in::INSTANCE_INDEX);
    module.decorated(decoration::BUILT_IN).find(is_it)
}

/// The number of locations that a value of this type takes; one with arrays of unknown length takes all.
fn locations(module: &Module, kind: Id) -> u32 {
    match module.get_type(kind) {
        Some(Type::Matrix { count, .. }) => count,
        Some(Type::Array { of, length }) => {
            module.number(length).unwrap_or(LOCATION).saturating_mul(locations(module, of))
        }
        Some(Type::Struct { members }) => members.iter().map(|member| locations(module, *member)).sum(),
        _ => 1,
    }
}

/// The ids of what a rewritten module declares.
struct Rewriter {
    int: Id,
    /// The variable with the number of the draw.
    number: Id,
    /// The output that hands it on.
    output: Option<Id>,
    draws: Option<Draws>,
}

/// The buffer of draws.
#[derive(Clone, Copy)]
struct Draws {
    /// The push constants, and the type of a pointer to their only member.
    pushed: Id,
    to_address: Id,
    /// The type of the address of the draws.
    address: Id,
    zero: Id,
}

impl Rewriter {
    fn declare(module: &mut Module, is_vertex: bool, block: Option<Id>) -> Self {
        let int = module.declare(Op::TypeInt, &[32, 1]);
        let input = module.declare(Op::TypePointer, &[storage::INPUT, int]);
        let number = module.variable(input, storage::INPUT);
        let output = is_vertex.then(|| {
            let pointer = module.declare(Op::TypePointer, &[storage::OUTPUT, int]);
            let output = module.variable(pointer, storage::OUTPUT);
            module.decorate(&[output, decoration::LOCATION, LOCATION]);
            module.decorate(&[output, decoration::FLAT]);
            output
        });
        if is_vertex {
            module.decorate(&[number, decoration::BUILT_IN, built_in::BASE_INSTANCE]);
            let capability = module.make(Op::Capability, &[DRAW_PARAMETERS]);
            module.head.insert(0, capability);
        } else {
            module.decorate(&[number, decoration::LOCATION, LOCATION]);
            module.decorate(&[number, decoration::FLAT]);
        }
        let draws = block.and_then(|block| Draws::declare(module, block, int));
        let pushed = draws.map(|draws| draws.pushed).filter(|_| module.version() >= 0x0001_0400);
        let variables: Vec<Id> = [Some(number), output, pushed].into_iter().flatten().collect();
        if let Some(block) = block.filter(|_| draws.is_some()) {
            module.leave_interface(&HashSet::from_iter([block]));
        }
        module.join_interface(&variables);
        Self { int, number, output, draws }
    }

    fn function(&self, module: &mut Module, function: &mut Function, block: Option<Id>, instance: Option<Id>) {
        let mut places = HashSet::new();
        for body in function.blocks.iter_mut().map(|block| &mut block.body) {
            let mut out = Vec::with_capacity(body.len());
            for i in std::mem::take(body) {
                match (i.op, &module[i]) {
                    (Op::AccessChain | Op::InBoundsAccessChain, [_, _, id, base, ..])
                        if Some(*base) == block || places.contains(base) =>
                    {
                        places.insert(*id);
                        let is_first = Some(*base) == block;
                        self.chain(module, i, is_first, &mut out);
                    }
                    (Op::Load, [_, _, _, from, ..]) if places.contains(from) => out.push(aligned(module, i)),
                    (Op::Load, [_, kind, id, from, ..]) if Some(*from) == instance => {
                        let (kind, id) = (*kind, *id);
                        let pointer = [instance.unwrap_or_default()];
                        let all = module.emit(&mut out, Op::Load, kind, &pointer);
                        let base = module.emit(&mut out, Op::Load, self.int, &[self.number]);
                        out.push(module.make(Op::ISub, &[kind, id, all, base]));
                    }
                    _ => out.push(i),
                }
            }
            *body = out;
        }
    }

    /// Appends what points to a member of the draw in the buffer. `is_first`: the chain begins at the block.
    fn chain(&self, module: &mut Module, i: Instruction, is_first: bool, out: &mut Vec<Instruction>) {
        let Some(Draws { pushed, to_address, address, zero }) = self.draws else { return out.push(i) };
        let words = module[i].to_vec();
        let to = module.pointer(words[1]).map_or(0, |(_, to)| to);
        let pointer = module.declare(Op::TypePointer, &[storage::PHYSICAL_STORAGE_BUFFER, to]);
        if !is_first {
            out.push(module.make(i.op, &[&[pointer], &words[2..]].concat()));
            return;
        }
        let place = module.emit(out, Op::AccessChain, to_address, &[pushed, zero]);
        let draws = module.emit(out, Op::Load, address, &[place]);
        let number = module.emit(out, Op::Load, self.int, &[self.number]);
        let operands = [&[pointer, words[2], draws, zero, number], &words[4..]].concat();
        out.push(module.make(Op::AccessChain, &operands));
    }
}

impl Draws {
    /// Declares `buffer_reference buffer { Draw draws[]; }` and push constants with its address. `block`: the old push constants.
    fn declare(module: &mut Module, block: Id, int: Id) -> Option<Self> {
        let (_, old) = module.pointer(module.type_of(block))?;
        let members = module.defined(Op::TypeStruct, old)?[2..].to_vec();
        // A block cannot be a member, so the draw is another struct like it.
        let draw = module.declare_another(Op::TypeStruct, &members);
        for place in 0..module.decorations.len() {
            let i = module.decorations[place];
            if i.op == Op::MemberDecorate && module[i][1] == old {
                let copy = module.about(i, draw);
                module.decorations.push(copy);
            }
        }
        let array = module.declare_another(Op::TypeRuntimeArray, &[draw]);
        module.decorate(&[array, decoration::ARRAY_STRIDE, size_of::<Draw>() as u32]);
        let buffer = block_of(module, array);
        let read_only = module.make(Op::MemberDecorate, &[buffer, 0, decoration::NON_WRITABLE]);
        module.decorations.push(read_only);
        let address = module.declare(Op::TypePointer, &[storage::PHYSICAL_STORAGE_BUFFER, buffer]);
        let constants = block_of(module, address);
        let to_constants = module.declare(Op::TypePointer, &[storage::PUSH_CONSTANT, constants]);
        let to_address = module.declare(Op::TypePointer, &[storage::PUSH_CONSTANT, address]);
        let pushed = module.variable(to_constants, storage::PUSH_CONSTANT);
        let zero = module.constant(int, 0);
        Some(Self { pushed, to_address, address, zero })
    }
}

/// A block with one member.
fn block_of(module: &mut Module, member: Id) -> Id {
    let block = module.declare_another(Op::TypeStruct, &[member]);
    module.decorate(&[block, decoration::BLOCK]);
    let offset = module.make(Op::MemberDecorate, &[block, 0, decoration::OFFSET, 0]);
    module.decorations.push(offset);
    block
}

/// A load from a buffer, which needs an alignment.
fn aligned(module: &mut Module, i: Instruction) -> Instruction {
    let kind = module[i][1];
    let alignment = if module.pointer(kind).is_some() { ADDRESS } else { SCALAR };
    let operands = [&module[i][1..4], &[ALIGNED, alignment]].concat();
    module.make(Op::Load, &operands)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compile::Compiler;
    use crate::shader::source::Source;
    use crate::shader::source::snapshot::Snapshot;
    use crate::shader::spirv::{optimize, specialize, validate};

    fn compiled(path: &str, source: &Source) -> Vec<u32> {
        Compiler::new().unwrap().compile(&Snapshot::new(source), &path.into()).result.unwrap()
    }

    /// The module of a stage that reads its draw from a buffer.
    fn indexed(words: &[u32]) -> Vec<u32> {
        let mut module = Module::parse(&specialize(words, &[])).unwrap();
        index_draws(&mut module);
        module.write()
    }

    fn small(path: &str, body: &str) -> Vec<u32> {
        let extension = "#extension GL_ARB_shader_draw_parameters : enable\n";
        let text = format!("#version 460\n{extension}#include \"interface.glsl\"\n{body}");
        let interface = crate::interface::glsl();
        compiled(path, &Source::memory([(path, text.as_str()), ("interface.glsl", interface.as_str())]))
    }

    #[test]
    fn stages_of_the_tree_stay_valid() {
        let source = Source::embedded();
        for path in ["pbr.vert", "pbr.frag", "debug.frag", "paths.frag", "passes/shadows/shadow_map.vert"] {
            let words = compiled(path, &source);
            assert!(can_index_draws(&words), "{path}");
            let words = indexed(&words);
            assert_eq!(validate(&words), Ok(()), "{path}");
            assert_eq!(validate(&optimize(words)), Ok(()), "{path}, optimized");
        }
    }

    #[test]
    fn instances_count_from_the_base_instance() {
        let words = small("m.vert", "void main() { gl_Position = vec4(gl_InstanceIndex, draw.node_id, 0.0, 1.0); }");
        let words = indexed(&words);
        assert_eq!(validate(&words), Ok(()));
        let module = Module::parse(&words).unwrap();
        assert_eq!(module.code().filter(|i| i.op == Op::ISub).count(), 1);
        let is_base = |id: &Id| module.decoration(*id, decoration::BUILT_IN) == Some(built_in::BASE_INSTANCE);
        assert!(module.decorated(decoration::BUILT_IN).any(|id| is_base(&id)));
    }

    #[test]
    fn stages_that_use_what_the_index_needs_are_left_alone() {
        let base = small("m.vert", "void main() { gl_Position = vec4(gl_BaseInstanceARB); }");
        assert!(!can_index_draws(&base));
        let taken = |first: u32| {
            let main = "void main() { a[0] = a[1] = vec4(draw.node_id); gl_Position = a[0]; }";
            can_index_draws(&small("m.vert", &format!("layout(location = {first}) out vec4 a[2];\n{main}")))
        };
        assert_eq!([taken(13), taken(14)], [true, false]);
        let geometry = "layout(triangles) in; layout(triangle_strip, max_vertices = 3) out;\nvoid main() {}";
        assert!(!can_index_draws(&small("m.geom", geometry)));
    }
}
