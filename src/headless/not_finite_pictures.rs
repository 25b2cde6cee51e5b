//! Counts the pixels with NaN or infinity in the pictures that are read back: the readback knows each.

use crate::render::Capture;

/// The pixels with NaN or infinity in several pictures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NotFinitePictures {
    /// How many pictures there are.
    pub of: usize,
    /// How many of them have such pixels.
    pub pictures: usize,
    /// Those of the first of these.
    pub first: Option<NotFinitePicture>,
}

/// The pixels with NaN or infinity in a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotFinitePicture {
    /// The mode that it shows.
    pub mode: String,
    /// Width and height.
    pub size: (u32, u32),
    /// How many pixels there are.
    pub count: usize,
    /// One of them, from the upper left corner: the middle one in the order of rows.
    pub at: (u32, u32),
}

impl NotFinitePictures {
    /// Looks at a picture of a mode.
    pub(super) fn add(&mut self, capture: &Capture, mode: &str) {
        self.of += 1;
        let count = capture.not_finite.iter().filter(|is| **is).count();
        if count == 0 {
            return;
        }
        self.pictures += 1;
        if self.first.is_some() {
            return;
        }
        let mut bad = (0..).zip(&capture.not_finite).filter(|(_, is)| **is).map(|(index, _): (u32, _)| index);
        let middle = bad.nth(count / 2).unwrap_or_default();
        let at = (middle % capture.width.max(1), middle / capture.width.max(1));
        self.first = Some(NotFinitePicture { mode: mode.to_owned(), size: (capture.width, capture.height), count, at });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_and_pixels_are_counted() {
        let picture = |bad: &[usize]| {
            let not_finite = (0..6).map(|index| bad.contains(&index)).collect();
            Capture { width: 3, height: 2, not_finite, ..Capture::default() }
        };
        let mut found = NotFinitePictures::default();
        found.add(&picture(&[]), "final");
        assert_eq!((found.of, found.pictures, &found.first), (1, 0, &None));
        found.add(&picture(&[1, 4, 5]), "depth");
        found.add(&picture(&[0]), "final");
        let first = NotFinitePicture { mode: "depth".into(), size: (3, 2), count: 3, at: (1, 1) };
        assert_eq!(found, NotFinitePictures { of: 3, pictures: 2, first: Some(first) });
    }
}
