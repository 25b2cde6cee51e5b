//! The measures of the rows.

/// The measures of the rows.
pub(super) struct Look {
    /// Width of a letter, points.
    pub(super) letter: f32,
    /// Width of the numbers with their marks, points.
    pub(super) gutter: f32,
}

impl Look {
    pub(super) fn new(letter: f32, lines: usize) -> Self {
        let digits = lines.max(100).to_string().len() as f32;
        Self { letter, gutter: letter * digits + 36.0 }
    }

    /// The width of a line with this many letters, and of its number.
    pub(super) fn width(&self, letters: usize) -> f32 {
        self.gutter + self.letter * letters as f32 + 40.0
    }
}
