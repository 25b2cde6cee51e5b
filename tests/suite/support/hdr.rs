//! Environment images made in code.

/// Columns and rows of the images: twice as wide as high, as an equirectangular one should be.
pub const SIZE: (usize, usize) = (32, 16);

/// A Radiance HDR image of flat pixels; `rgbe` of a column and a row counted from the upper left. [128, 0, 0, 129] is
/// red of radiance 1 (Ward 1991, "Real Pixels": mantissa 2^(exponent - 136)).
pub fn image(rgbe: impl Fn(usize, usize) -> [u8; 4]) -> Vec<u8> {
    let (width, height) = SIZE;
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    bytes.extend((0..width * height).flat_map(|i| rgbe(i % width, i / width)));
    bytes
}

/// The same radiance from everywhere.
pub fn uniform(rgbe: [u8; 4]) -> Vec<u8> {
    image(|_, _| rgbe)
}

/// Red from the left half, the -X side; blue from the right.
pub fn red_and_blue() -> Vec<u8> {
    image(|x, _| if x < SIZE.0 / 2 { [128, 0, 0, 129] } else { [0, 0, 128, 129] })
}
