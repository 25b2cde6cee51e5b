//! Finds a line again after an edit of its file.

use similar::{Algorithm, DiffOp, capture_diff_slices};

/// The line of `new`, from 1, that corresponds to line `number` of `old`. A line that was itself edited keeps its place among its
/// neighbors.
pub fn follow(old: &str, new: &str, number: u32) -> u32 {
    let index = number.saturating_sub(1) as usize;
    let operations = changes(old, new);
    let holds = |operation: &&DiffOp| operation.old_range().contains(&index);
    let found = operations.iter().find(holds).map_or(index, |operation| {
        let (before, after) = (operation.old_range(), operation.new_range());
        // If several lines were replaced by fewer, the last ones share a place.
        (after.start + index - before.start).min(after.end.saturating_sub(1).max(after.start))
    });
    u32::try_from(found + 1).unwrap_or(number)
}

/// For each line of `new`, the line of `old`, from 1, that it was before the edit; `None` for a line that was added. Lines that were
/// edited correspond by their place among those that changed together.
pub fn lines_before(old: &str, new: &str) -> Vec<Option<u32>> {
    let mut before = vec![None; new.lines().count()];
    for operation in changes(old, new) {
        for (old, new) in operation.old_range().zip(operation.new_range()) {
            before[new] = u32::try_from(old + 1).ok();
        }
    }
    before
}

/// What became of the lines, which may be indented anew.
fn changes(old: &str, new: &str) -> Vec<DiffOp> {
    let trimmed = |text: &str| -> Vec<String> { text.lines().map(|line| line.trim().to_owned()).collect() };
    capture_diff_slices(Algorithm::Myers, &trimmed(old), &trimmed(new))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_knows_its_line_before() {
        assert_eq!(lines_before("a\nb\nc\n", "a\nx\n  b\nC\n"), [Some(1), None, Some(2), Some(3)]);
        assert_eq!(lines_before("a\nb\nc\n", "c\n"), [Some(3)]);
        assert_eq!(lines_before("", "a\n"), [None]);
    }

    #[test]
    fn a_line_is_found_after_edits() {
        let old = "a\nb\nc\nd\ne\n";
        for (new, expected) in [
            (old, 3),
            ("x\ny\na\nb\nc\nd\ne\n", 5),
            ("b\nc\nd\ne\n", 2),
            ("a\nb\nC\nd\ne\n", 3),
            ("A\nb\nc\nd\nE\n", 3),
            ("A\nx\nb\n  c\nd\nE\n", 4),
            ("x\na\nb\nC\nd\ne\n", 4),
            ("a\ne\n", 2),
        ] {
            assert_eq!(follow(old, new, 3), expected, "{new:?}");
        }
    }
}
