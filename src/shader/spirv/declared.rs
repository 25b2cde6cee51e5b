//! Parses the declarations of a SPIR-V module: types, names, decorations, variables. The SPIR-V specification, sections
//! 3.52.2 to 3.52.9, lists the opcodes.

mod locations;

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::interface::BindingKind;

use super::conditions::missing_in_conditions;
use super::opcode as op;
use super::primitive;
use super::reflect::{Block, Descriptor, Location, Member, Reflection, Scalar, SpecConstant};
use super::types::{Type, type_of};

type Id = u32;

mod decoration {
    pub const SPEC_ID: u32 = 1;
    pub const BUFFER_BLOCK: u32 = 3;
    pub const ARRAY_STRIDE: u32 = 6;
    pub const MATRIX_STRIDE: u32 = 7;
    pub const BUILT_IN: u32 = 11;
    pub const PATCH: u32 = 15;
    pub const NON_WRITABLE: u32 = 24;
    pub const LOCATION: u32 = 30;
    pub const BINDING: u32 = 33;
    pub const DESCRIPTOR_SET: u32 = 34;
    pub const OFFSET: u32 = 35;
    pub const PER_PRIMITIVE: u32 = 5271;
}

mod storage {
    pub const UNIFORM_CONSTANT: u32 = 0;
    pub const INPUT: u32 = 1;
    pub const UNIFORM: u32 = 2;
    pub const OUTPUT: u32 = 3;
    pub const PUSH_CONSTANT: u32 = 9;
    pub const STORAGE_BUFFER: u32 = 12;
    pub const TASK_PAYLOAD: u32 = 5402;
}

/// SPIR-V's execution modes LocalSize, OutputVertices and OutputPrimitivesEXT.
const LOCAL_SIZE: u32 = 17;
const OUTPUT_VERTICES: u32 = 26;
const OUTPUT_PRIMITIVES: u32 = 5270;

/// SPIR-V's value of the image format Rgba16f.
const RGBA16F: u32 = 2;

/// The declarations of one module.
#[derive(Debug, Default)]
pub struct Module {
    names: HashMap<Id, String>,
    member_names: HashMap<(Id, u32), String>,
    decorations: HashMap<(Id, u32), u32>,
    member_decorations: HashMap<(Id, u32, u32), u32>,
    types: HashMap<Id, Type>,
    constants: HashMap<Id, u32>,
    specialization: Vec<(Id, Id, u32)>,
    variables: Vec<(Id, Id, u32)>,
    interface: Vec<Id>,
    capabilities: Vec<u32>,
    local_size: [u32; 3],
    mesh_outputs: [u32; 2],
    /// The execution model, and the execution modes.
    model: u32,
    modes: Vec<u32>,
    with_value: HashSet<Id>,
    without_value: Vec<Id>,
}

impl Module {
    /// Parses the words up to the first function. Returns an empty module if they are not SPIR-V.
    pub fn parse(words: &[u32]) -> Self {
        const MAGIC: u32 = 0x0723_0203;
        const HEADER: usize = 5;
        let mut module = Self::default();
        if words.first() != Some(&MAGIC) {
            return module;
        }
        let mut rest = words.get(HEADER..).unwrap_or_default();
        while let Some(first) = rest.first() {
            let (opcode, length) = (first & 0xffff, (first >> 16) as usize);
            let Some(operands) = rest.get(1..length) else { break };
            if opcode == op::FUNCTION || module.instruction(opcode, operands).is_none() {
                break;
            }
            rest = &rest[length..];
        }
        let missing = missing_in_conditions(rest, &module.with_value);
        module.without_value.extend(missing);
        module
    }

    /// Records that a constant has a value, and any operand of a condition that has none.
    fn constant_result(&mut self, opcode: u32, operands: &[u32]) -> Option<()> {
        /// SPIR-V's comparisons and logical operations, whose operands are all ids.
        const CONDITIONS: std::ops::RangeInclusive<u32> = 164..=179;
        let (result, operation) = (*operands.get(1)?, operands.get(2));
        if opcode == op::SPEC_CONSTANT_OP && operation.is_some_and(|operation| CONDITIONS.contains(operation)) {
            let missing = operands.get(3..)?.iter().filter(|id| !self.with_value.contains(id));
            self.without_value.extend(missing);
        }
        self.with_value.insert(result);
        Some(())
    }

    /// Records one declaration; `None` if operands are missing.
    fn instruction(&mut self, opcode: u32, operands: &[u32]) -> Option<()> {
        let at = |index: usize| operands.get(index).copied();
        if (op::CONSTANT_TRUE..=op::SPEC_CONSTANT_OP).contains(&opcode) {
            self.constant_result(opcode, operands)?;
        }
        match opcode {
            op::NAME => {
                self.names.insert(at(0)?, string(operands.get(1..)?).0);
            }
            op::MEMBER_NAME => {
                self.member_names.insert((at(0)?, at(1)?), string(operands.get(2..)?).0);
            }
            op::ENTRY_POINT => {
                let (_, words) = string(operands.get(2..)?);
                self.model = at(0)?;
                self.interface = operands.get(2 + words..)?.to_vec();
            }
            op::EXECUTION_MODE if at(1) == Some(LOCAL_SIZE) => self.local_size = [at(2)?, at(3)?, at(4)?],
            op::EXECUTION_MODE => {
                match at(1)? {
                    OUTPUT_VERTICES => self.mesh_outputs[0] = at(2)?,
                    OUTPUT_PRIMITIVES => self.mesh_outputs[1] = at(2)?,
                    _ => {}
                }
                self.modes.push(at(1)?);
            }
            op::CAPABILITY => self.capabilities.push(at(0)?),
            op::DECORATE => {
                self.decorations.insert((at(0)?, at(1)?), at(2).unwrap_or(0));
            }
            op::MEMBER_DECORATE => {
                self.member_decorations.insert((at(0)?, at(1)?, at(2)?), at(3).unwrap_or(0));
            }
            op::CONSTANT => {
                self.constants.insert(at(1)?, at(2)?);
            }
            op::SPEC_CONSTANT_TRUE => self.specialize(at(0)?, at(1)?, 1),
            op::SPEC_CONSTANT_FALSE => self.specialize(at(0)?, at(1)?, 0),
            op::SPEC_CONSTANT => self.specialize(at(0)?, at(1)?, at(2)?),
            op::VARIABLE => self.variables.push((at(0)?, at(1)?, at(2)?)),
            _ => {
                if let Some(declared) = type_of(opcode, operands)? {
                    self.types.insert(at(0)?, declared);
                }
            }
        }
        Some(())
    }

    fn specialize(&mut self, of: Id, result: Id, default: u32) {
        // It may size an array; the size then is the default.
        self.constants.insert(result, default);
        self.specialization.push((result, of, default));
    }

    /// Collects all declarations.
    pub fn reflect(&self) -> Reflection {
        let mut out = Reflection {
            capabilities: self.capabilities.clone(),
            local_size: self.local_size,
            mesh_outputs: self.mesh_outputs,
            takes: primitive::taken(self.model, &self.modes),
            gives: primitive::given(self.model, &self.modes),
            ..Reflection::default()
        };
        for (pointer, variable, class) in &self.variables {
            let Some(Type::Pointer { to, .. }) = self.types.get(pointer) else { continue };
            match *class {
                storage::UNIFORM_CONSTANT | storage::UNIFORM | storage::STORAGE_BUFFER => {
                    out.descriptors.extend(self.descriptor(*variable, *to, *class));
                }
                storage::TASK_PAYLOAD => out.has_payload |= self.interface.contains(variable),
                storage::PUSH_CONSTANT => out.push_constants = self.block(*to),
                storage::INPUT if self.interface.contains(variable) => {
                    out.reads_primitive_id |= self.is_primitive_id(*variable, *to);
                    self.locations(*variable, *to, primitive::has_arrays_of_inputs(self.model), &mut out.inputs);
                }
                storage::OUTPUT if self.interface.contains(variable) => {
                    out.writes_primitive_id |= self.is_primitive_id(*variable, *to);
                    self.locations(*variable, *to, primitive::has_arrays_of_outputs(self.model), &mut out.outputs);
                }
                _ => {}
            }
        }
        out.without_value = self.without_value.iter().map(|id| self.name(*id)).collect();
        out.constants = self.specialization.iter().filter_map(|constant| self.constant(*constant)).collect();
        out.structs = self.structs();
        out.descriptors.sort_by_key(|descriptor| (descriptor.set, descriptor.binding));
        out.constants.sort_by_key(|constant| constant.id);
        out.inputs.sort_by_key(|location| location.location);
        out.outputs.sort_by_key(|location| location.location);
        out
    }

    fn name(&self, id: Id) -> String {
        self.names.get(&id).cloned().unwrap_or_default()
    }

    fn decoration(&self, id: Id, decoration: u32) -> Option<u32> {
        self.decorations.get(&(id, decoration)).copied()
    }

    fn descriptor(&self, variable: Id, to: Id, class: u32) -> Option<Descriptor> {
        let declared = self.types.get(&to)?;
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
            image_format: if let Type::Image { format, .. } = declared { *format } else { 0 },
        })
    }

    /// Whether a storage buffer is declared `readonly`, which glslang writes to each member.
    fn is_read_only(&self, variable: Id, to: Id) -> bool {
        let Some(Type::Struct { members }) = self.types.get(&to) else { return false };
        let mut members = (0..).zip(members).map(|(index, _)| (to, index, decoration::NON_WRITABLE));
        self.decoration(variable, decoration::NON_WRITABLE).is_some()
            || members.all(|member| self.member_decorations.contains_key(&member))
    }

    fn block(&self, id: Id) -> Option<Block> {
        let Type::Struct { members } = self.types.get(&id)? else { return None };
        let mut block = Block { name: self.name(id), ..Block::default() };
        for (index, member) in (0..).zip(members) {
            let offset = *self.member_decorations.get(&(id, index, decoration::OFFSET))?;
            let matrix_stride = self.member_decorations.get(&(id, index, decoration::MATRIX_STRIDE)).copied();
            block.size = block.size.max(offset.saturating_add(self.size(*member, matrix_stride)));
            block.members.push(Member {
                name: self.member_names.get(&(id, index)).cloned().unwrap_or_default(),
                offset,
                type_name: self.type_name(*member),
                stride: self.decoration(*member, decoration::ARRAY_STRIDE).unwrap_or(0),
            });
        }
        Some(block)
    }

    /// Size in bytes. Matrices in arrays share the member's matrix stride.
    fn size(&self, id: Id, matrix_stride: Option<u32>) -> u32 {
        match self.types.get(&id) {
            Some(Type::Bool) => 4,
            Some(Type::Int { bits, .. } | Type::Float { bits }) => bits / 8,
            Some(Type::Vector { of, count }) => self.size(*of, None).saturating_mul(*count),
            Some(Type::Matrix { column, count }) => {
                matrix_stride.unwrap_or_else(|| self.size(*column, None)).saturating_mul(*count)
            }
            Some(Type::Array { of, length }) => {
                let stride = self.decoration(id, decoration::ARRAY_STRIDE).unwrap_or_else(|| self.size(*of, None));
                stride.saturating_mul(self.constants.get(length).copied().unwrap_or(0))
            }
            Some(Type::Struct { .. }) => self.block(id).map_or(0, |block| block.size),
            // The only pointers stored in memory are buffer references, which are 64-bit addresses.
            Some(Type::Pointer { .. }) => 8,
            _ => 0,
        }
    }

    fn structs(&self) -> BTreeMap<String, Block> {
        let ids = self.types.iter().filter(|(_, declared)| matches!(declared, Type::Struct { .. }));
        let blocks = ids.filter_map(|(id, _)| self.block(*id));
        blocks.filter(|block| !block.members.is_empty()).map(|block| (block.name.clone(), block)).collect()
    }

    fn constant(&self, (id, of, default): (Id, Id, u32)) -> Option<SpecConstant> {
        let scalar = match self.types.get(&of)? {
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
        let Some(declared) = self.types.get(&id) else { return "?".to_owned() };
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
            Type::Vector { of, count } => format!("{}vec{count}", self.prefix(*of)),
            Type::Matrix { column, count } => match self.types.get(column) {
                Some(Type::Vector { of, count: rows }) if rows == count => format!("{}mat{count}", self.prefix(*of)),
                Some(Type::Vector { of, count: rows }) => format!("{}mat{count}x{rows}", self.prefix(*of)),
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
                let kind = if *storage { "image" } else { "texture" };
                // Only storage images have a format; the contract uses rgba16f only.
                let format = if *format == RGBA16F { "rgba16f " } else { "" };
                let suffixes = [(*multi, "MS"), (*arrayed, "Array"), (*depth, "Shadow")];
                let suffix: String = suffixes.iter().filter(|(is, _)| *is).map(|(_, suffix)| *suffix).collect();
                format!("{format}{}{kind}{dimension}{suffix}", self.prefix(*sampled))
            }
            Type::Sampler => "sampler".to_owned(),
            Type::SampledImage { image } => self.type_name(*image).replacen("texture", "sampler", 1),
            Type::Array { of, length } => {
                let length = self.constants.get(length).map_or_else(|| "?".to_owned(), u32::to_string);
                format!("{}[{length}]", self.type_name(*of))
            }
            Type::RuntimeArray { of } => format!("{}[]", self.type_name(*of)),
            Type::Struct { .. } => self.name(id),
            Type::Pointer { to, .. } => self.name(*to),
        }
    }

    /// The prefix of `vec`, `mat` and `sampler` in GLSL.
    fn prefix(&self, scalar: Id) -> &'static str {
        match self.types.get(&scalar) {
            Some(Type::Int { signed: true, .. }) => "i",
            Some(Type::Int { signed: false, .. }) => "u",
            Some(Type::Bool) => "b",
            Some(Type::Float { bits: 64 }) => "d",
            _ => "",
        }
    }
}

/// A literal string and its length in words.
fn string(words: &[u32]) -> (String, usize) {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let length = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    (String::from_utf8_lossy(&bytes[..length]).into_owned(), length / 4 + 1)
}
