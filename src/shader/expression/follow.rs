//! Finds a line again after an edit of its file.

use std::ops::Range;

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

/// For each line of `new`, the line of `old`, from 1, that it was before the edit; `None` for a line that was added. Among lines that
/// changed together, those correspond that have most words in common.
pub fn lines_before(old: &str, new: &str) -> Vec<Option<u32>> {
    let (old_lines, new_lines): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    // A text that nobody has edited needs no comparison, which takes milliseconds for a long file.
    if old == new {
        return (1..).map(Some).take(new_lines.len()).collect();
    }
    let mut before = vec![None; new_lines.len()];
    for operation in changes(old, new) {
        let (from, to) = (operation.old_range(), operation.new_range());
        let pairs = match from.len() == to.len() || from.len() * to.len() > MOST_PAIRS {
            true => from.zip(to).collect(),
            false => pairs(&old_lines, &new_lines, (from, to)),
        };
        pairs.into_iter().for_each(|(old, new)| before[new] = u32::try_from(old + 1).ok());
    }
    before
}

/// Pairs of lines that are compared at most; larger edits correspond by their places.
const MOST_PAIRS: usize = 10_000;

/// The lines of an edit that correspond, in order, so that they have as much in common as they can.
fn pairs(old: &[&str], new: &[&str], (from, to): (Range<usize>, Range<usize>)) -> Vec<(usize, usize)> {
    let width = to.len() + 1;
    // The best sum of the lines from each pair on.
    let mut best = vec![0; (from.len() + 1) * width];
    let paired = |best: &[u32], a: usize, b: usize| {
        likeness(old[from.start + a], new[to.start + b]) + best[(a + 1) * width + b + 1]
    };
    for a in (0..from.len()).rev() {
        for b in (0..to.len()).rev() {
            let apart = best[(a + 1) * width + b].max(best[a * width + b + 1]);
            best[a * width + b] = paired(&best, a, b).max(apart);
        }
    }
    let (mut a, mut b, mut found) = (0, 0, Vec::new());
    while a < from.len() && b < to.len() {
        let here = best[a * width + b];
        if here == best[a * width + b + 1] {
            b += 1;
        } else if here == best[(a + 1) * width + b] {
            a += 1;
        } else {
            found.push((from.start + a, to.start + b));
            (a, b) = (a + 1, b + 1);
        }
    }
    found
}

/// How much two lines have in common: 1 for nothing, more for each part of a hundred of their words.
fn likeness(a: &str, b: &str) -> u32 {
    let words = |line: &'_ str| -> Vec<String> {
        line.split(|c: char| !c.is_alphanumeric() && c != '_')
            .filter(|word| !word.is_empty())
            .map(str::to_owned)
            .collect()
    };
    let (a, mut b) = (words(a), words(b));
    let most = a.len().max(b.len()).max(1);
    let mut common = 0;
    for word in &a {
        if let Some(at) = b.iter().position(|other| other == word) {
            b.swap_remove(at);
            common += 1;
        }
    }
    1 + u32::try_from(100 * common / most).unwrap_or(0)
}

/// The differences between lines, which may be indented anew.
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
        assert_eq!(lines_before("a\nb\n", "a\nb\n"), [Some(1), Some(2)]);
        let (old, new) = ("{\n  float a = x * 2.0;\n}\n", "{\n\n  float b = 1.0;\n  float a = x * 4.0;\n}\n");
        assert_eq!(lines_before(old, new), [Some(1), None, None, Some(2), Some(3)]);
        assert_eq!(lines_before(new, old), [Some(1), Some(4), Some(5)]);
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
