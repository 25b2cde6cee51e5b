//! Finds the parameters of functions that number a light of the frame: those by which a function, or one that it calls, reads the arrays of
//! lights.

use foldhash::{HashMap, HashMapExt};

use crate::interface::{BINDING_FEW_LIGHTS, BINDING_LIGHTS, SET_FRAME};
use crate::shader::spirv::enums::decoration::{BINDING, DESCRIPTOR_SET};
use crate::shader::spirv::module::{Id, Instruction, Module};
use crate::shader::spirv::op::{Op, text};

/// The member of the frame constants with the number of lights, behind which the suns are.
const LIGHT_COUNT: &str = "light_count";
/// Copies between a parameter and its use that are followed.
const MOST_COPIES: usize = 8;

/// The lights that a number counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightList {
    /// All lights of the frame.
    Lights,
    /// The suns of the environment, which follow the lights.
    Suns,
}

/// The parameter of each function that numbers a light.
pub(super) struct LightParameters(HashMap<Id, (Id, LightList)>);

impl LightParameters {
    pub(super) fn new(module: &Module) -> Self {
        let values = Values::new(module);
        let mut found = HashMap::new();
        let order = module.entry_function().and_then(|entry| module.callees_first(entry)).unwrap_or_default();
        for function in order.into_iter().map(|place| &module.functions[place]) {
            let numbered = function.body().find_map(|i| values.numbered(i, &found));
            numbered.into_iter().for_each(|parameter| _ = found.insert(function.id, parameter));
        }
        Self(found.into_iter().map(|(function, (_, parameter, list))| (function, (parameter, list))).collect())
    }

    /// The parameter of a function.
    pub(super) fn of(&self, function: Id) -> Option<(Id, LightList)> {
        self.0.get(&function).copied()
    }
}

/// The parameters that were found so far, with their places.
type Found = HashMap<Id, (usize, Id, LightList)>;

/// Where the values of a module come from.
struct Values<'a> {
    module: &'a Module,
    /// The arrays of lights.
    lights: Vec<Id>,
    /// The parameters, with their places.
    parameters: HashMap<Id, usize>,
    /// The values of variables that are stored to once.
    stored: HashMap<Id, Option<Id>>,
    /// The places of the members that count the lights, by their structs.
    counts: HashMap<Id, u32>,
}

impl<'a> Values<'a> {
    fn new(module: &'a Module) -> Self {
        let is_of_lights = |id: &Id| {
            module.decoration(*id, DESCRIPTOR_SET) == Some(SET_FRAME)
                && module.decoration(*id, BINDING).is_some_and(|at| [BINDING_LIGHTS, BINDING_FEW_LIGHTS].contains(&at))
        };
        let heads = module.functions.iter().flat_map(|function| {
            let parameters = function.head.iter().filter(|i| i.op == Op::FunctionParameter);
            parameters.enumerate().map(|(place, i)| (module[*i][2], place))
        });
        let mut stored = HashMap::new();
        for words in module.code().filter(|i| i.op == Op::Store).map(|i| &module[i]) {
            stored.entry(words[1]).and_modify(|value| *value = None).or_insert(Some(words[2]));
        }
        let members = module.debug.iter().filter(|i| i.op == Op::MemberName).map(|i| &module[*i]);
        let counts = members.filter(|words| text(&words[3..]) == LIGHT_COUNT).map(|words| (words[1], words[2]));
        Self {
            module,
            lights: module.decorated(BINDING).filter(is_of_lights).collect(),
            parameters: heads.collect(),
            stored,
            counts: counts.collect(),
        }
    }

    /// The parameter that an instruction uses as the number of a light, if it reads a light or calls a function of `found`.
    fn numbered(&self, i: Instruction, found: &Found) -> Option<(usize, Id, LightList)> {
        let words = &self.module[i];
        let (number, list) = match i.op {
            Op::AccessChain | Op::InBoundsAccessChain if self.lights.contains(&words[3]) => {
                (*words.get(5)?, LightList::Lights)
            }
            Op::FunctionCall => {
                let (place, _, list) = found.get(&words[3])?;
                (*words.get(4 + place)?, *list)
            }
            _ => return None,
        };
        let (parameter, behind_lights) = self.origin(number, MOST_COPIES)?;
        let list = match (list, behind_lights) {
            (list, false) => list,
            (LightList::Lights, true) => LightList::Suns,
            (LightList::Suns, true) => return None,
        };
        Some((*self.parameters.get(&parameter)?, parameter, list))
    }

    /// The parameter that a value or a pointer copies, and whether the number of lights is added to it.
    fn origin(&self, value: Id, most: usize) -> Option<(Id, bool)> {
        let (most, i) = (most.checked_sub(1)?, self.module.definition(value)?);
        match (i.op, &self.module[i][3..]) {
            (Op::FunctionParameter, _) => Some((value, false)),
            (Op::Load | Op::CopyObject | Op::Bitcast, [from, ..]) => self.origin(*from, most),
            (Op::Variable, _) => self.origin((*self.stored.get(&value)?)?, most),
            (Op::IAdd, [a, b]) => {
                let [a, b] = if self.is_light_count(*a) { [b, a] } else { [a, b] };
                let (parameter, behind_lights) = self.origin(*a, most)?;
                (self.is_light_count(*b) && !behind_lights).then_some((parameter, true))
            }
            _ => None,
        }
    }

    /// Whether a value is the number of lights of the frame.
    fn is_light_count(&self, value: Id) -> bool {
        let chain = self.module.defined(Op::Load, value).and_then(|words| self.module.definition(words[3]));
        let Some((words, member)) = chain.map(|i| &self.module[i]).and_then(|words| Some((words, *words.get(4)?)))
        else {
            return false;
        };
        let of = self.module.pointer(self.module.type_of(words[3])).map(|(_, to)| to);
        of.and_then(|of| self.counts.get(&of)).is_some_and(|place| self.module.number(member) == Some(*place))
    }
}
