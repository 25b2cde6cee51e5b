//! Collects the declarations of a SPIR-V module: types, names, decorations, variables.

mod locations;
mod variables;

use std::collections::BTreeMap;

use foldhash::{HashMap, HashMapExt};

use crate::interface::{self, BindingKind};

use super::conditions::without_value;
use super::enums::{decoration, storage};
use super::module::{Id, Instruction, Module, Type};
use super::op::{Op, after_text, text};
use super::primitive;
use super::reach::{Used, reached};
use super::reflect::{Block, Descriptor, Location, Member, Reflection, Scalar, SpecConstant};
use super::uses::used_bytes;

/// SPIR-V's execution modes LocalSize, OutputVertices and OutputPrimitivesEXT.
const LOCAL_SIZE: u32 = 17;
const OUTPUT_VERTICES: u32 = 26;
const OUTPUT_PRIMITIVES: u32 = 5270;

/// SPIR-V's value of the image format Rgba16f.
const RGBA16F: u32 = 2;

impl Reflection {
    /// Reflects a module. Words that are not SPIR-V declare nothing.
    pub fn of(spirv: &[u32]) -> Self {
        let Some(module) = Module::parse(spirv) else { return Self::default() };
        let reached = reached(&module);
        let reads_params = reached.contains(&Used::Descriptor(interface::SET_FRAME, interface::BINDING_PARAMS));
        let params_read = match reads_params {
            true => used_bytes(&module, interface::SET_FRAME, interface::BINDING_PARAMS),
            false => Vec::new(),
        };
        Self { reached, params_read, ..Declarations::of(&module).reflect() }
    }
}

/// The declarations of one module, with names and decorations by id.
struct Declarations<'a> {
    module: &'a Module,
    names: HashMap<Id, Instruction>,
    member_names: HashMap<(Id, u32), Instruction>,
    decorations: HashMap<(Id, u32), u32>,
    member_decorations: HashMap<(Id, u32, u32), u32>,
    interface: &'a [Id],
}

impl<'a> Declarations<'a> {
    fn of(module: &'a Module) -> Self {
        let entry = module.entry().map_or(&[][..], |entry| &module[entry]);
        let mut this = Self {
            module,
            names: HashMap::new(),
            member_names: HashMap::new(),
            decorations: HashMap::new(),
            member_decorations: HashMap::new(),
            interface: entry.get(3..).map_or(&[], |_| &entry[after_text(entry, 3)..]),
        };
        for i in &module.debug {
            match (i.op, &module[*i]) {
                (Op::Name, [_, id, ..]) => _ = this.names.insert(*id, *i),
                (Op::MemberName, [_, id, member, ..]) => _ = this.member_names.insert((*id, *member), *i),
                _ => {}
            }
        }
        for i in &module.decorations {
            match (i.op, &module[*i]) {
                (Op::Decorate, [_, id, kind, rest @ ..]) => {
                    this.decorations.insert((*id, *kind), rest.first().copied().unwrap_or(0));
                }
                (Op::MemberDecorate, [_, id, member, kind, rest @ ..]) => {
                    this.member_decorations.insert((*id, *member, *kind), rest.first().copied().unwrap_or(0));
                }
                _ => {}
            }
        }
        this
    }

    /// The literals of an execution mode.
    fn mode(&self, mode: u32) -> Option<&'a [u32]> {
        let mut modes = self.module.head.iter().filter(|i| i.op == Op::ExecutionMode).map(|i| &self.module[*i]);
        modes.find(|words| words[2] == mode).map(|words| &words[3..])
    }

    /// Collects all declarations.
    fn reflect(&self) -> Reflection {
        let module = self.module;
        let operands = |op: Op, at: usize| module.head.iter().filter(move |i| i.op == op).map(move |i| module[*i][at]);
        let (model, modes) = (module.model().unwrap_or(0), operands(Op::ExecutionMode, 2).collect::<Vec<_>>());
        let largest = |mode: u32| self.mode(mode).and_then(|literals| literals.first()).copied().unwrap_or(0);
        let mut out = Reflection {
            capabilities: operands(Op::Capability, 1).collect(),
            local_size: self.mode(LOCAL_SIZE).and_then(|size| size.first_chunk()).copied().unwrap_or_default(),
            mesh_outputs: [largest(OUTPUT_VERTICES), largest(OUTPUT_PRIMITIVES)],
            takes: primitive::taken(model, &modes),
            gives: primitive::given(model, &modes),
            ..Reflection::default()
        };
        for i in module.globals.iter().filter(|i| i.op == Op::Variable) {
            let (variable, class) = (module[*i][2], module[*i][3]);
            let Some((_, to)) = module.pointer(module[*i][1]) else { continue };
            match class {
                storage::UNIFORM_CONSTANT | storage::UNIFORM | storage::STORAGE_BUFFER => {
                    out.descriptors.extend(self.descriptor(variable, to, class));
                }
                storage::TASK_PAYLOAD => out.has_payload |= self.interface.contains(&variable),
                storage::PUSH_CONSTANT => out.push_constants = self.block(to),
                storage::INPUT if self.interface.contains(&variable) => {
                    out.reads_primitive_id |= self.is_primitive_id(variable, to);
                    self.locations(variable, to, primitive::has_arrays_of_inputs(model), &mut out.inputs);
                }
                storage::OUTPUT if self.interface.contains(&variable) => {
                    out.writes_primitive_id |= self.is_primitive_id(variable, to);
                    self.locations(variable, to, primitive::has_arrays_of_outputs(model), &mut out.outputs);
                }
                _ => {}
            }
        }
        out.without_value = without_value(module).into_iter().map(|id| self.name(id)).collect();
        out.large_variables = self.variables_beyond(interface::LARGEST_VARIABLE);
        out.constants = module.globals.iter().filter_map(|i| self.constant(*i)).collect();
        out.structs = self.structs();
        out.descriptors.sort_by_key(|descriptor| (descriptor.set, descriptor.binding));
        out.constants.sort_by_key(|constant| constant.id);
        out.inputs.sort_by_key(|location| location.location);
        out.outputs.sort_by_key(|location| location.location);
        out
    }

    fn name(&self, id: Id) -> String {
        self.names.get(&id).map(|i| text(&self.module[*i][2..])).unwrap_or_default()
    }

    fn member_name(&self, id: Id, index: u32) -> String {
        self.member_names.get(&(id, index)).map(|i| text(&self.module[*i][3..])).unwrap_or_default()
    }

    fn decoration(&self, id: Id, decoration: u32) -> Option<u32> {
        self.decorations.get(&(id, decoration)).copied()
    }

    fn descriptor(&self, variable: Id, to: Id, class: u32) -> Option<Descriptor> {
        let declared = self.get_type(to)?;
        let is_block = matches!(declared, Type::Struct { .. });
        let storage = class == storage::STORAGE_BUFFER || self.decoration(to, decoration::BUFFER_BLOCK).is_some();
        let glsl = self.type_name(to);
        let (kind, glsl) = match declared {
            Type::Struct { .. } if storage => (Some(BindingKind::StorageBuffer), "buffer block".to_owned()),
            Type::Struct { .. } => (Some(BindingKind::UniformBuffer), "uniform block".to_owned()),
            _ if glsl == "sampler2D" => (Some(BindingKind::Sampler2D), glsl),
            _ if glsl == "sampler2DArray" => (Some(BindingKind::Sampler2DArray), glsl),
            _ if glsl == "samplerCube" => (Some(BindingKind::SamplerCube), glsl),
            _ if glsl == BindingKind::StorageImage.glsl() => (Some(BindingKind::StorageImage), glsl),
            _ => (None, glsl),
        };
        Some(Descriptor {
            set: self.decoration(variable, decoration::DESCRIPTOR_SET).unwrap_or(0),
            binding: self.decoration(variable, decoration::BINDING)?,
            kind,
            glsl,
            name: self.name(if is_block { to } else { variable }),
            block: if is_block { self.block(to) } else { None },
            is_written: is_block && storage && !self.is_read_only(variable, to),
            image_format: if let Type::Image { format, .. } = declared { format } else { 0 },
        })
    }

    /// Whether a storage buffer is declared `readonly`, which glslang writes to each member.
    fn is_read_only(&self, variable: Id, to: Id) -> bool {
        let Some(Type::Struct { members }) = self.get_type(to) else { return false };
        let mut members = (0..).zip(members).map(|(index, _)| (to, index, decoration::NON_WRITABLE));
        self.decoration(variable, decoration::NON_WRITABLE).is_some()
            || members.all(|member| self.member_decorations.contains_key(&member))
    }

    fn block(&self, id: Id) -> Option<Block> {
        let Type::Struct { members } = self.get_type(id)? else { return None };
        let mut block = Block { name: self.name(id), ..Block::default() };
        for (index, member) in (0..).zip(members) {
            let offset = *self.member_decorations.get(&(id, index, decoration::OFFSET))?;
            let matrix_stride = self.member_decorations.get(&(id, index, decoration::MATRIX_STRIDE)).copied();
            block.size = block.size.max(offset.saturating_add(self.size(*member, matrix_stride)));
            block.members.push(Member {
                name: self.member_name(id, index),
                offset,
                type_name: self.type_name(*member),
                stride: self.decoration(*member, decoration::ARRAY_STRIDE).unwrap_or(0),
            });
        }
        Some(block)
    }

    /// The default that an instruction declares for a specialization constant.
    fn default(&self, i: Instruction) -> Option<u32> {
        match i.op {
            Op::SpecConstantTrue => Some(1),
            Op::SpecConstantFalse => Some(0),
            Op::SpecConstant => Some(self.module[i][3]),
            _ => None,
        }
    }

    /// The number of an array's elements. A specialization constant may size it; the size then is the default.
    fn length(&self, id: Id) -> Option<u32> {
        self.module.number(id).or_else(|| self.default(self.module.definition(id)?))
    }

    fn get_type(&self, id: Id) -> Option<Type<'a>> {
        self.module.get_type(id)
    }

    /// Size in bytes. Matrices in arrays share the member's matrix stride.
    fn size(&self, id: Id, matrix_stride: Option<u32>) -> u32 {
        match self.get_type(id) {
            Some(Type::Bool) => 4,
            Some(Type::Int { bits, .. } | Type::Float { bits }) => bits / 8,
            Some(Type::Vector { of, count }) => self.size(of, None).saturating_mul(count),
            Some(Type::Matrix { column, count }) => {
                matrix_stride.unwrap_or_else(|| self.size(column, None)).saturating_mul(count)
            }
            Some(Type::Array { of, length }) => {
                let stride = self.decoration(id, decoration::ARRAY_STRIDE).unwrap_or_else(|| self.size(of, None));
                stride.saturating_mul(self.length(length).unwrap_or(0))
            }
            Some(Type::Struct { .. }) => self.block(id).map_or(0, |block| block.size),
            // The only pointers stored in memory are buffer references, which are 64-bit addresses.
            Some(Type::Pointer { .. }) => 8,
            _ => 0,
        }
    }

    fn structs(&self) -> BTreeMap<String, Block> {
        let ids = self.module.globals.iter().filter(|i| i.op == Op::TypeStruct).map(|i| self.module[*i][1]);
        let blocks = ids.filter_map(|id| self.block(id));
        blocks.filter(|block| !block.members.is_empty()).map(|block| (block.name.clone(), block)).collect()
    }

    fn constant(&self, i: Instruction) -> Option<SpecConstant> {
        let default = self.default(i)?;
        let (of, id) = (self.module[i][1], self.module[i][2]);
        let scalar = match self.get_type(of)? {
            Type::Bool => Scalar::Bool,
            Type::Int { bits: 32, signed: true } => Scalar::Int,
            Type::Int { bits: 32, signed: false } => Scalar::Uint,
            Type::Float { bits: 32 } => Scalar::Float,
            _ => return None,
        };
        Some(SpecConstant { id: self.decoration(id, decoration::SPEC_ID)?, name: self.name(id), scalar, default })
    }

    /// The type as GLSL spells it.
    fn type_name(&self, id: Id) -> String {
        let Some(declared) = self.get_type(id) else { return "?".to_owned() };
        match declared {
            Type::Bool => "bool".to_owned(),
            Type::Int { bits, signed } => match (bits, signed) {
                (32, true) => "int".to_owned(),
                (32, false) => "uint".to_owned(),
                (bits, true) => format!("int{bits}_t"),
                (bits, false) => format!("uint{bits}_t"),
            },
            Type::Float { bits: 32 } => "float".to_owned(),
            Type::Float { bits: 64 } => "double".to_owned(),
            Type::Float { bits } => format!("float{bits}_t"),
            Type::Vector { of, count } => format!("{}vec{count}", self.prefix(of)),
            Type::Matrix { column, count } => match self.get_type(column) {
                Some(Type::Vector { of, count: rows }) if rows == count => format!("{}mat{count}", self.prefix(of)),
                Some(Type::Vector { of, count: rows }) => format!("{}mat{count}x{rows}", self.prefix(of)),
                _ => "?".to_owned(),
            },
            Type::Image { sampled, dim, depth, arrayed, multi, storage, format } => {
                let dimension = match dim {
                    0 => "1D",
                    1 => "2D",
                    2 => "3D",
                    3 => "Cube",
                    5 => "Buffer",
                    _ => "?",
                };
                let kind = if storage { "image" } else { "texture" };
                // Only storage images have a format; the contract uses rgba16f only.
                let format = if format == RGBA16F { "rgba16f " } else { "" };
                let suffixes = [(multi, "MS"), (arrayed, "Array"), (depth, "Shadow")];
                let suffix: String = suffixes.iter().filter(|(is, _)| *is).map(|(_, suffix)| *suffix).collect();
                format!("{format}{}{kind}{dimension}{suffix}", self.prefix(sampled))
            }
            Type::Sampler => "sampler".to_owned(),
            Type::SampledImage { image } => self.type_name(image).replacen("texture", "sampler", 1),
            Type::Array { of, length } => {
                let length = self.length(length).map_or_else(|| "?".to_owned(), |length| length.to_string());
                format!("{}[{length}]", self.type_name(of))
            }
            Type::RuntimeArray { of } => format!("{}[]", self.type_name(of)),
            Type::Struct { .. } => self.name(id),
            Type::Pointer { to, .. } => self.name(to),
        }
    }

    /// The prefix of `vec`, `mat` and `sampler` in GLSL.
    fn prefix(&self, scalar: Id) -> &'static str {
        match self.get_type(scalar) {
            Some(Type::Int { signed: true, .. }) => "i",
            Some(Type::Int { signed: false, .. }) => "u",
            Some(Type::Bool) => "b",
            Some(Type::Float { bits: 64 }) => "d",
            _ => "",
        }
    }
}
