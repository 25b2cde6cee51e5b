//! The locations of inputs and outputs.

use super::{Declarations, Id, Location, Type};
use crate::shader::spirv::enums::{built_in, decoration};

impl Declarations<'_> {
    /// Whether a variable of the type `to` is `gl_PrimitiveID`, or the block of a mesh stage with that member.
    pub(super) fn is_primitive_id(&self, variable: Id, to: Id) -> bool {
        let of = match self.get_type(to) {
            Some(Type::Array { of, .. }) => of,
            _ => to,
        };
        let is_member = |(&(id, _, kind), &value): (&(Id, u32, u32), &u32)| {
            (id, kind, value) == (of, decoration::BUILT_IN, built_in::PRIMITIVE_ID)
        };
        self.decoration(variable, decoration::BUILT_IN) == Some(built_in::PRIMITIVE_ID)
            || self.member_decorations.iter().any(is_member)
    }

    /// Adds a variable's locations: one, or one per member of a block. `has_array`: the variable has an element for each vertex
    /// or primitive, unless it is one of a whole patch.
    pub(super) fn locations(&self, variable: Id, to: Id, has_array: bool, out: &mut Vec<Location>) {
        let of_member = (to, 0, decoration::PATCH);
        let is_patch =
            self.decoration(variable, decoration::PATCH).is_some() || self.member_decorations.contains_key(&of_member);
        let to = match self.get_type(to) {
            Some(Type::Array { of, .. }) if has_array && !is_patch => of,
            _ => to,
        };
        let is_of_primitive = self.decoration(variable, decoration::PER_PRIMITIVE).is_some();
        let prefix = match (is_patch, is_of_primitive) {
            (true, _) => "patch ",
            (_, true) => "perprimitiveEXT ",
            _ => "",
        };
        let Some(Type::Struct { members }) = self.get_type(to) else {
            let Some(location) = self.decoration(variable, decoration::LOCATION) else { return };
            out.push(Location {
                location,
                name: self.name(variable),
                type_name: prefix.to_owned() + &self.type_name(to),
            });
            return;
        };
        let mut next = self.decoration(variable, decoration::LOCATION);
        for (index, member) in (0..).zip(members) {
            if self.member_decorations.contains_key(&(to, index, decoration::BUILT_IN)) {
                return;
            }
            let own = self.member_decorations.get(&(to, index, decoration::LOCATION)).copied();
            let Some(location) = own.or(next) else { return };
            next = Some(location.saturating_add(self.location_count(*member)));
            let member_name = self.member_name(to, index);
            let name = format!("{}.{member_name}", self.name(to));
            out.push(Location { location, name, type_name: prefix.to_owned() + &self.type_name(*member) });
        }
    }

    fn location_count(&self, id: Id) -> u32 {
        match self.get_type(id) {
            Some(Type::Matrix { count, .. }) => count,
            Some(Type::Array { of, length }) => {
                self.length(length).unwrap_or(1).saturating_mul(self.location_count(of))
            }
            _ => 1,
        }
    }
}
