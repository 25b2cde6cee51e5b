//! Lookup tables of color in `.cube` files (Adobe 2013, "Cube LUT Specification 1.0"), as images: the slices of equal blue lie
//! side by side, red grows to the right and green downwards.

use image::{DynamicImage, Rgb32FImage};

/// Largest number of entries along an axis that the specification allows for three dimensions.
const LARGEST: u32 = 256;

/// The table as an image of `size * size` times `size` pixels.
///
/// # Errors
/// A fault of the file, with the line if there is one.
pub fn decode(bytes: &[u8]) -> Result<DynamicImage, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "is no text".to_owned())?;
    let (mut size, mut values) = (None, Vec::new());
    for (line, number) in text.lines().zip(1..) {
        let wrong = |what: &str| format!("line {number}: {what}");
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            [] => {}
            [first, ..] if first.starts_with('#') => {}
            ["TITLE", ..] => {}
            ["LUT_3D_SIZE", count] => {
                let count = count.parse().ok().filter(|count| (2..=LARGEST).contains(count));
                size = Some(count.ok_or_else(|| wrong("expected a size of 2 to 256"))?);
            }
            ["LUT_1D_SIZE", ..] => return Err(wrong("a table of one dimension; expected LUT_3D_SIZE")),
            ["DOMAIN_MIN", domain @ ..] if is_all(domain, 0.0) => {}
            ["DOMAIN_MAX", domain @ ..] if is_all(domain, 1.0) => {}
            ["DOMAIN_MIN" | "DOMAIN_MAX", ..] => return Err(wrong("expected a domain of 0 to 1")),
            [red, green, blue] => {
                let color = [red, green, blue].map(|word| word.parse::<f32>().ok().filter(|value| value.is_finite()));
                let [Some(red), Some(green), Some(blue)] = color else { return Err(wrong("expected three numbers")) };
                values.push([red, green, blue]);
            }
            _ => return Err(wrong("expected three numbers")),
        }
    }
    let size: u32 = size.ok_or("has no LUT_3D_SIZE")?;
    let expected = (size * size * size) as usize;
    if values.len() != expected {
        return Err(format!("has {} colors; LUT_3D_SIZE {size} needs {expected}", values.len()));
    }
    // Red changes fastest in the file, then green.
    let at = |x: u32, y: u32| values[(x % size + size * y + size * size * (x / size)) as usize];
    Ok(Rgb32FImage::from_fn(size * size, size, |x, y| image::Rgb(at(x, y))).into())
}

fn is_all(words: &[&str], value: f32) -> bool {
    words.len() == 3 && words.iter().all(|word| word.parse() == Ok(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: &str = "# a comment\nTITLE \"x\"\nLUT_3D_SIZE 2\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1.0 1.0 1.0\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";

    #[test]
    fn slices_of_blue_lie_side_by_side() {
        let image = decode(CORNERS.as_bytes()).unwrap().to_rgb32f();
        assert_eq!((image.width(), image.height()), (4, 2));
        assert_eq!(image.get_pixel(1, 0).0, [1.0, 0.0, 0.0]);
        assert_eq!(image.get_pixel(0, 1).0, [0.0, 1.0, 0.0]);
        assert_eq!(image.get_pixel(2, 0).0, [0.0, 0.0, 1.0]);
        assert_eq!(image.get_pixel(3, 1).0, [1.0, 1.0, 1.0]);
    }

    #[test]
    fn what_is_wrong_has_its_line() {
        let told = |text: &str| decode(text.as_bytes()).unwrap_err();
        assert_eq!(told(&CORNERS.replace("0 1 0", "0 x 0")), "line 8: expected three numbers");
        assert_eq!(told(&CORNERS.replace("MAX 1.0", "MAX 2.0")), "line 5: expected a domain of 0 to 1");
        assert_eq!(told(&CORNERS.replace("3D_SIZE 2", "3D_SIZE 1")), "line 3: expected a size of 2 to 256");
        assert_eq!(told(&CORNERS.replace("0 1 1\n", "")), "has 7 colors; LUT_3D_SIZE 2 needs 8");
        assert_eq!(told("1 1 1\n"), "has no LUT_3D_SIZE");
        assert_eq!(told("LUT_1D_SIZE 4\n"), "line 1: a table of one dimension; expected LUT_3D_SIZE");
    }

    #[test]
    fn damaged_files_cause_no_panic() {
        crate::damaged::each(300, &[CORNERS.as_bytes()], |bytes| drop(decode(bytes)));
    }
}
