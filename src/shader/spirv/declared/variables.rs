//! Variables in the memory of each invocation.

use super::{Declarations, Id, Op, Type};
use crate::shader::spirv::enums::storage;

impl Declarations<'_> {
    /// The variables of each invocation that have more than `most` bytes, with their sizes in bytes. Each is a variable of a function or of
    /// the file.
    pub(super) fn variables_beyond(&self, most: u64) -> Vec<(String, u64)> {
        let functions = self.module.functions.iter().flat_map(|function| &function.blocks);
        let local = functions.flat_map(|block| &block.body);
        let all = self.module.globals.iter().chain(local).filter(|i| i.op == Op::Variable);
        let own = all.filter(|i| matches!(self.module[**i][3], storage::PRIVATE | storage::FUNCTION));
        let sized = own.filter_map(|i| {
            let (_, to) = self.module.pointer(self.module[*i][1])?;
            Some((self.name(self.module[*i][2]), self.own_bytes(to)))
        });
        sized.filter(|(_, bytes)| *bytes > most).collect()
    }

    /// Bytes of a value that is packed without gaps.
    fn own_bytes(&self, id: Id) -> u64 {
        match self.get_type(id) {
            Some(Type::Struct { members }) => {
                members.iter().fold(0, |sum: u64, member| sum.saturating_add(self.own_bytes(*member)))
            }
            Some(Type::Array { of, length }) => {
                self.own_bytes(of).saturating_mul(self.length(length).unwrap_or(0).into())
            }
            _ => self.size(id, None).into(),
        }
    }
}
