//! Finds a line again after an edit of its file.

/// The number, from 1, of the line of `new` that was the line `number` of `old`. A line that was itself edited keeps its place
/// among its neighbors.
pub fn follow(old: &str, new: &str, number: u32) -> u32 {
    let (old, new): (Vec<&str>, Vec<&str>) = (old.lines().collect(), new.lines().collect());
    let index = number.saturating_sub(1) as usize;
    let before = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
    let most = old.len().min(new.len()) - before;
    let after = old.iter().rev().zip(new.iter().rev()).take(most).take_while(|(a, b)| a == b).count();
    let found = if index < before {
        index
    } else if index + after >= old.len() {
        (index + new.len()).saturating_sub(old.len())
    } else {
        // Within the edit, the nearest line with the same text.
        let edited = before..new.len() - after;
        let same = edited.clone().filter(|at| old.get(index).is_some_and(|line| new[*at].trim() == line.trim()));
        let last = edited.end.saturating_sub(1).max(before);
        same.min_by_key(|at| at.abs_diff(index)).unwrap_or(index.min(last))
    };
    u32::try_from(found + 1).unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

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
            ("a\ne\n", 2),
        ] {
            assert_eq!(follow(old, new, 3), expected, "{new:?}");
        }
    }
}
