//! Merges two texts that were made from the same one, line by line.

use std::ops::Range;

use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Lines of the common text, and what one of the two has in their place.
struct Hunk<'a> {
    base: Range<usize>,
    new: Vec<&'a str>,
}

/// The text with the changes of both. What both have changed in the same way counts once.
///
/// # Errors
/// The line of the common text, from 1, that both have changed in different ways.
pub(super) fn merge(base: &str, theirs: &str, ours: &str) -> Result<String, usize> {
    if base == theirs || theirs == ours {
        return Ok(ours.to_owned());
    }
    let lines = |text: &'_ str| -> Vec<String> { text.split_inclusive('\n').map(str::to_owned).collect() };
    let (base, theirs, ours) = (lines(base), lines(theirs), lines(ours));
    let (theirs, ours) = (hunks(&base, &theirs), hunks(&base, &ours));
    let (mut theirs, mut ours) = (theirs.into_iter().peekable(), ours.into_iter().peekable());
    let (mut merged, mut at) = (String::new(), 0);
    loop {
        let next = match (theirs.peek(), ours.peek()) {
            (None, None) => break,
            (Some(a), Some(b)) if touches(a, b) => {
                if a.base != b.base || a.new != b.new {
                    return Err(a.base.start.max(b.base.start) + 1);
                }
                theirs.next();
                ours.next()
            }
            (Some(a), Some(b)) if a.base.start < b.base.start => theirs.next(),
            (Some(_), None) => theirs.next(),
            _ => ours.next(),
        };
        let Some(next) = next else { break };
        merged.extend(base[at..next.base.start].iter().map(String::as_str));
        merged.extend(next.new);
        at = next.base.end;
    }
    merged.extend(base[at..].iter().map(String::as_str));
    Ok(merged)
}

/// Whether two hunks change the same lines, or insert at the same place.
fn touches(a: &Hunk<'_>, b: &Hunk<'_>) -> bool {
    let is_inside = |place: usize, of: &Range<usize>| of.start <= place && place <= of.end;
    match (a.base.is_empty(), b.base.is_empty()) {
        (true, _) => is_inside(a.base.start, &b.base),
        (_, true) => is_inside(b.base.start, &a.base),
        _ => a.base.start < b.base.end && b.base.start < a.base.end,
    }
}

/// The parts of `new` that differ.
fn hunks<'a>(base: &[String], new: &'a [String]) -> Vec<Hunk<'a>> {
    let changes = capture_diff_slices(Algorithm::Myers, base, new);
    let hunk = |change: &DiffOp| Hunk {
        base: change.old_range(),
        new: new[change.new_range()].iter().map(String::as_str).collect(),
    };
    let mut hunks: Vec<Hunk<'_>> = Vec::new();
    for change in changes.iter().filter(|change| !matches!(change, DiffOp::Equal { .. })) {
        let next = hunk(change);
        match hunks.last_mut().filter(|last| last.base.end == next.base.start) {
            Some(last) => {
                last.base.end = next.base.end;
                last.new.extend(next.new);
            }
            None => hunks.push(next),
        }
    }
    hunks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_of_both_are_kept_and_a_conflict_is_told() {
        let base = "a\nb\nc\nd\n";
        for (theirs, ours, merged) in [
            (base, "a\nB\nc\nd\n", Ok("a\nB\nc\nd\n")),
            ("a\nB\nc\nd\n", base, Ok("a\nB\nc\nd\n")),
            ("a\nb\nc\nD\n", "A\nb\nc\nd\n", Ok("A\nb\nc\nD\n")),
            ("x\na\nb\nc\nd\n", "a\nb\nd\n", Ok("x\na\nb\nd\n")),
            ("a\nX\nc\nd\n", "a\nX\nc\nD\n", Ok("a\nX\nc\nD\n")),
            ("a\nX\nc\nd\n", "a\nY\nc\nd\n", Err(2)),
            ("a\nb\nx\nc\nd\n", "a\nb\ny\nc\nd\n", Err(3)),
            ("a\nb\nc\nd\nx\n", "a\nb\nc\nd\n", Ok("a\nb\nc\nd\nx\n")),
            ("", "A\nb\nc\nd\n", Err(1)),
        ] {
            assert_eq!(merge(base, theirs, ours), merged.map(str::to_owned), "{theirs:?} {ours:?}");
        }
    }
}
