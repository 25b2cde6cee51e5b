//! Reads accessors of any component type, stride and sparseness. All arithmetic is checked, and nothing is allocated before
//! the buffer is known to hold the data.

use gltf::json;
use json::accessor::{Accessor, ComponentType, Type};
use json::validation::Checked;

use crate::scene::error::Problem;
use crate::scene::gltf::file::buffers::Buffers;
use crate::scene::gltf::memory::Memory;
use crate::scene::gltf::place::{out_of_range, place};

/// Maximum number of elements of an accessor without a buffer view, which no data limits.
const MAX_ZEROS: u64 = 1 << 22;

type Index = json::Index<Accessor>;

/// Reads a file's accessors.
#[derive(Clone, Copy)]
pub struct Reader<'a> {
    /// The JSON.
    pub root: &'a json::Root,
    /// Its buffers.
    pub buffers: &'a Buffers<'a>,
    /// Memory for the elements.
    pub memory: &'a Memory,
}

/// The formats in which a semantic may be stored.
#[derive(Clone, Copy)]
pub struct Format {
    /// Allowed types.
    pub types: &'static [Type],
    /// Allowed component types, and for each whether it is normalized.
    pub components: &'static [(ComponentType, Normalized)],
}

/// Whether integers are normalized.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Normalized {
    /// They must be.
    Yes,
    /// They must not be (floats, indices).
    No,
    /// Both are allowed (KHR_mesh_quantization).
    Either,
}

/// An accessor with a checked header.
struct Checkup<'a> {
    accessor: &'a Accessor,
    place: String,
    count: usize,
    kind: Type,
    component: ComponentType,
}

impl<'a> Reader<'a> {
    /// Reads floats, and converts integers as the specification says. `fill` replaces missing components (RGB colors read as
    /// RGBA).
    pub fn floats<const N: usize>(
        &self,
        index: Index,
        format: &Format,
        fill: f32,
        user: &str,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let checked = self.check(index, format, user)?;
        let normalized = checked.accessor.normalized;
        let (component, width) = (checked.component, checked.component.size());
        let components = checked.kind.multiplicity().min(N);
        let decode = |bytes: &[u8]| {
            let mut element = [fill; N];
            for (value, bytes) in element.iter_mut().zip(bytes.chunks_exact(width)).take(components) {
                *value = to_float(component, normalized, bytes);
            }
            element
        };
        let mut zero = [fill; N];
        zero[..components].fill(0.0);
        self.read(&checked, zero, decode)
    }

    /// Reads numbers one after the other, whatever the type of the accessor.
    pub fn numbers(&self, index: Index, format: &Format, user: &str) -> Result<Vec<f32>, Problem> {
        let kind = self.root.accessors.get(index.value()).map(|accessor| accessor.type_);
        Ok(match kind {
            Some(Checked::Valid(Type::Vec2)) => self.floats::<2>(index, format, 0.0, user)?.into_flattened(),
            Some(Checked::Valid(Type::Vec3)) => self.floats::<3>(index, format, 0.0, user)?.into_flattened(),
            Some(Checked::Valid(Type::Vec4)) => self.floats::<4>(index, format, 0.0, user)?.into_flattened(),
            _ => self.floats::<1>(index, format, 0.0, user)?.into_flattened(),
        })
    }

    /// Reads an index buffer.
    pub fn indices(&self, index: Index, user: &str) -> Result<Vec<u32>, Problem> {
        const INDICES: Format = Format {
            types: &[Type::Scalar],
            components: &[
                (ComponentType::U8, Normalized::No),
                (ComponentType::U16, Normalized::No),
                (ComponentType::U32, Normalized::No),
            ],
        };
        let checked = self.check(index, &INDICES, user)?;
        self.read(&checked, 0, |bytes| to_index(checked.component, bytes))
    }

    fn check(&self, index: Index, format: &Format, user: &str) -> Result<Checkup<'a>, Problem> {
        let accessors = &self.root.accessors;
        let Some(accessor) = accessors.get(index.value()) else {
            return Err(out_of_range(user, "accessors", index.value(), accessors.len()));
        };
        let place = format!("{} ({user})", place("accessors", index.value(), accessor.name.as_deref()));
        let (Checked::Valid(kind), Checked::Valid(component)) = (accessor.type_, accessor.component_type) else {
            return Err(Problem::invalid(place, "a type and a componentType that glTF defines", "others"));
        };
        let component = component.0;
        let stored = format.components.iter().find(|(allowed, _)| *allowed == component);
        let normalized = match stored {
            Some((_, Normalized::Yes)) => accessor.normalized,
            Some((_, Normalized::No)) => !accessor.normalized || component == ComponentType::F32,
            Some((_, Normalized::Either)) => true,
            None => false,
        };
        if !format.types.contains(&kind) || !normalized {
            let found = format!("{kind:?} of {}{component:?}", if accessor.normalized { "normalized " } else { "" });
            return Err(Problem::invalid(place, describe(format), found));
        }
        let count = accessor.count.0;
        if count == 0 {
            return Err(Problem::invalid(place, "a count of at least 1", "0"));
        }
        // On a 32-bit system the count may not fit, and no buffer could hold it.
        let count = usize::try_from(count)
            .map_err(|_| Problem::invalid(&place, "a count that fits memory", count.to_string()))?;
        Ok(Checkup { accessor, place, count, kind, component })
    }

    fn read<T: Copy>(&self, checked: &Checkup<'_>, zero: T, decode: impl Fn(&[u8]) -> T) -> Result<Vec<T>, Problem> {
        let Checkup { accessor, place, count, kind, component } = checked;
        let size = kind.multiplicity() * component.size();
        let mut elements = match accessor.buffer_view {
            Some(view) => {
                let bytes = self.buffers.view(self.root, view, place)?;
                // `view` has checked the index.
                let stride = self.root.buffer_views[view.value()].byte_stride.map_or(size, |stride| stride.0);
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                let stored = strided(bytes, offset, *count, size, stride, place)?;
                self.memory.take_of::<T>(*count, place)?;
                stored.map(|bytes| decode(&bytes[..size])).collect()
            }
            None if *count as u64 <= MAX_ZEROS => {
                self.memory.take_of::<T>(*count, place)?;
                vec![zero; *count]
            }
            None => {
                let expected = format!("at most {MAX_ZEROS} elements without a bufferView");
                return Err(Problem::invalid(place, expected, count.to_string()));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            self.substitute(sparse, &mut elements, size, &decode, place)?;
        }
        Ok(elements)
    }

    /// Replaces the elements that a sparse accessor lists.
    fn substitute<T>(
        &self,
        sparse: &json::accessor::sparse::Sparse,
        elements: &mut [T],
        size: usize,
        decode: &impl Fn(&[u8]) -> T,
        place: &str,
    ) -> Result<(), Problem> {
        let place = format!("{place}.sparse");
        let total = elements.len();
        let count = usize::try_from(sparse.count.0).ok().filter(|count| (1..=total).contains(count));
        let Some(count) = count else {
            return Err(Problem::invalid(place, format!("a count of 1 to {total}"), sparse.count.0.to_string()));
        };
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(Problem::invalid(place, "indices of U8, U16 or U32", "another componentType"));
        };
        let width = component.0.size();
        let indices = self.buffers.view(self.root, sparse.indices.buffer_view, &place)?;
        let values = self.buffers.view(self.root, sparse.values.buffer_view, &place)?;
        let indices = strided(indices, sparse.indices.byte_offset.0, count, width, width, &place)?;
        let values = strided(values, sparse.values.byte_offset.0, count, size, size, &place)?;
        for (index, value) in indices.zip(values) {
            let index = to_index(component.0, index) as usize;
            let Some(element) = elements.get_mut(index) else {
                return Err(Problem::invalid(place, format!("indices below the count of {total}"), index.to_string()));
            };
            *element = decode(&value[..size]);
        }
        Ok(())
    }
}

/// The elements of a buffer view, at least `size` bytes each. Checks first that all of them lie inside the view.
fn strided<'b>(
    bytes: &'b [u8],
    offset: u64,
    count: usize,
    size: usize,
    stride: usize,
    place: &str,
) -> Result<std::slice::Chunks<'b, u8>, Problem> {
    if stride < size {
        return Err(Problem::invalid(place, format!("a byteStride of at least {size}"), stride.to_string()));
    }
    let start = usize::try_from(offset).ok();
    let end = start.and_then(|start| (count - 1).checked_mul(stride)?.checked_add(size)?.checked_add(start));
    match start.zip(end).and_then(|(start, end)| bytes.get(start..end)) {
        Some(bytes) => Ok(bytes.chunks(stride)),
        None => {
            let found = format!("{count} elements of {size} bytes every {stride} from byte {offset}");
            Err(Problem::invalid(place, format!("data inside of the bufferView's {} bytes", bytes.len()), found))
        }
    }
}

/// Converts a component to float. Normalized integers become 0..1 or -1..1 (glTF 2.0, section 3.6.2.2).
fn to_float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let (value, largest) = match (component, bytes) {
        (ComponentType::I8, &[a]) => (f32::from(a as i8), f32::from(i8::MAX)),
        (ComponentType::U8, &[a]) => (f32::from(a), f32::from(u8::MAX)),
        (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), f32::from(i16::MAX)),
        (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), f32::from(u16::MAX)),
        (ComponentType::U32, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, u32::MAX as f32),
        (ComponentType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        _ => return 0.0,
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}

fn to_index(component: ComponentType, bytes: &[u8]) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, &[a, ..]) => u32::from(a),
        (ComponentType::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
        (ComponentType::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

fn describe(format: &Format) -> String {
    let types: Vec<String> = format.types.iter().map(|kind| format!("{kind:?}")).collect();
    let components: Vec<String> = format
        .components
        .iter()
        .map(|(component, normalized)| match normalized {
            Normalized::Yes => format!("normalized {component:?}"),
            _ => format!("{component:?}"),
        })
        .collect();
    format!("{} of {}", types.join(" or "), components.join(" or "))
}
