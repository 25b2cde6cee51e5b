//! Pictures as NumPy arrays: the format .npy, version 1.0, as numpy.lib.format describes it. Arrays have the shape (height, width, 4) in C
//! order, with rows from the top.

/// Bytes to a multiple of which the data begins.
const ALIGNMENT: usize = 64;
/// Magic string and version 1.0.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

/// An array of RGBA bytes.
pub(super) fn of_bytes(size: (u32, u32), rgba8: &[u8]) -> Vec<u8> {
    let mut bytes = header("|u1", size, rgba8.len());
    bytes.extend_from_slice(rgba8);
    bytes
}

/// An array of RGBA floats.
pub(super) fn of_floats(size: (u32, u32), pixels: &[[f32; 4]]) -> Vec<u8> {
    let mut bytes = header("<f4", size, size_of_val(pixels));
    bytes.extend(pixels.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

/// The header of an array, with room for so many bytes of data.
fn header(kind: &str, (width, height): (u32, u32), data: usize) -> Vec<u8> {
    let description = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({height}, {width}, 4), }}");
    // The length, the description, spaces, and a line break. It is far below the 64 KiB of its length's field.
    let whole = (MAGIC.len() + 2 + description.len() + 1).next_multiple_of(ALIGNMENT);
    let length = whole - MAGIC.len() - 2;
    let mut bytes = Vec::with_capacity(whole + data);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&(length as u16).to_le_bytes());
    bytes.extend_from_slice(description.as_bytes());
    bytes.resize(whole - 1, b' ');
    bytes.push(b'\n');
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_begins_at_a_multiple_of_64_bytes() {
        for size in [(1, 1), (640, 360), (16384, 16384)] {
            let head = header("<f4", size, 0);
            assert_eq!(head.len() % ALIGNMENT, 0);
            assert_eq!(usize::from(u16::from_le_bytes([head[8], head[9]])) + 10, head.len());
            let text = std::str::from_utf8(&head[10..]).unwrap();
            let shape = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, 4), }}", size.1, size.0);
            assert_eq!(text.trim_end(), shape);
            assert!(text.ends_with('\n'));
        }
    }

    #[test]
    fn data_follows_as_it_is() {
        assert!(of_bytes((2, 1), &[1, 2, 3, 4, 5, 6, 7, 8]).ends_with(b"\n\x01\x02\x03\x04\x05\x06\x07\x08"));
        let floats = of_floats((1, 1), &[[1.0, -2.0, f32::INFINITY, 0.5]]);
        assert_eq!(floats[floats.len() - 16..], [1.0f32, -2.0, f32::INFINITY, 0.5].map(f32::to_le_bytes).concat());
    }
}
