//! The parts of a `//@ui` in the order in which they are read, with the author's values.

/// The parts of an annotation, by their kind.
#[derive(Default)]
struct Parts<'a> {
    label: Option<&'a str>,
    range: Option<&'a str>,
    /// `choice` with its names, numbers and sentences.
    choices: Vec<&'a str>,
    claims: Vec<&'a str>,
    color: Option<&'a str>,
    options: Vec<&'a str>,
    default: Vec<&'a str>,
}

/// The text behind `//@ui` in the order that it needs. `None` if it has that order, or has a part that is not known.
pub(super) fn in_order(text: &str) -> Option<String> {
    let words = words(text);
    let mut parts = Parts::default();
    let mut at = 0;
    while let Some(word) = words.get(at) {
        at += 1;
        match *word {
            "choice" => {
                let end = words[at..].iter().position(|word| !is_choice(word) && !word.starts_with('"'));
                let end = end.map_or(words.len(), |end| at + end);
                parts.choices.extend(["choice"].iter().chain(&words[at..end]));
                at = end;
            }
            "color" => parts.color = Some(word),
            "=" => {
                let end = words[at..].iter().position(|word| !is_number(word)).map_or(words.len(), |end| at + end);
                parts.default.extend(["="].iter().chain(&words[at..end]));
                at = end;
            }
            word if word.starts_with('"') => parts.label = Some(word),
            word if word.starts_with("conserves=") || word.starts_with("reciprocal=") => parts.claims.push(word),
            word if ["when=", "group=", "unit=", "doc="].iter().any(|key| word.starts_with(key)) => {
                parts.options.push(word);
            }
            word if word.contains("..") => parts.range = Some(word),
            _ => return None,
        }
    }
    let Parts { label, range, choices, claims, color, options, default } = parts;
    let sorted: Vec<&str> = [label, range].into_iter().flatten().chain(choices).chain(claims).chain(color).collect();
    let sorted = [sorted, options, default].concat();
    // Equal words in another order.
    (sorted != words && sorted.len() == words.len()).then(|| sorted.join(" "))
}

/// The words of a text. Spaces in quotes split none, and `=` before a default is a word of its own.
fn words(text: &str) -> Vec<&str> {
    let (mut out, mut rest) = (Vec::new(), text.trim());
    while !rest.is_empty() {
        let mut is_quoted = false;
        let end = rest.char_indices().find(|(at, c)| {
            is_quoted ^= *c == '"';
            (*at > 0 && !is_quoted && c.is_whitespace()) || (*at == 1 && rest.starts_with('='))
        });
        let (word, after) = rest.split_at(end.map_or(rest.len(), |(at, _)| at));
        out.push(word);
        rest = after.trim_start();
    }
    out
}

fn is_choice(word: &str) -> bool {
    word.split_once('=').is_some_and(|(name, number)| !name.is_empty() && number.parse::<i64>().is_ok())
}

fn is_number(word: &str) -> bool {
    matches!(word, "true" | "false") || word.parse::<f64>().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_put_in_order_with_their_values() {
        for (text, expected) in [
            ("0..1 \"Rim\" = 0.2", "\"Rim\" 0..1 = 0.2"),
            ("\"Rim\" =0.2 0..1", "\"Rim\" 0..1 = 0.2"),
            ("= 1 0.8 0.6 color \"Tint of it\" group=\"A b\"", "\"Tint of it\" color group=\"A b\" = 1 0.8 0.6"),
            ("choice A=0 \"first\" B=1 0..1", "0..1 choice A=0 \"first\" B=1"),
            ("conserves=\"A\" choice A=0", "choice A=0 conserves=\"A\""),
        ] {
            assert_eq!(in_order(text).as_deref(), Some(expected), "{text}");
        }
        for text in ["", "\"Rim\" 0..1 doc=\"a = b\" = 0.2", "\"A\" \"B\" 0..1", "0..1 colour \"A\"", "= x \"A\""] {
            assert_eq!(in_order(text), None, "{text}");
        }
    }
}
