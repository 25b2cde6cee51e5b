//! Finds entries by words of their names, also by words with a typing error.

use std::collections::HashMap;
use std::ops::Range;

use super::entry::{Action, Entry};

/// An entry that matches the query.
#[derive(Debug)]
pub(super) struct Found<'a> {
    pub(super) entry: &'a Entry,
    /// The matched bytes of the title.
    pub(super) marks: Vec<Range<usize>>,
    /// The value that the query gives to a number.
    pub(super) typed: Option<&'a str>,
}

/// Fewest letters of a word that may have a typing error, and of the beginning of a word that may have one.
const TYPO: usize = 4;
const TYPO_IN_PREFIX: usize = 5;

/// How an entry matches. The first is the best.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Class {
    Name,
    /// The title begins with its whole words.
    FirstWords,
    Prefix,
    Title,
    Words,
    TypoInTitle,
    Typo,
}

/// The rank of an entry in the list: whether the query gives it a value, whether only typing errors match, whether it is an inner
/// part of an effect that is not named as a whole, its class, and whether it `is_minor`.
type Rank = (bool, bool, bool, Class, bool);

/// The entries that have all words of the query, the best first. Those that `is_minor` come last, with the entries of one pass
/// together, unless the query is their whole name.
pub(super) fn find<'a>(entries: impl IntoIterator<Item = &'a Entry>, query: &'a str) -> Vec<Found<'a>> {
    let whole = query.trim();
    let mut found: Vec<(Rank, Found<'a>)> = Vec::new();
    let rank = |has_value, class, entry: &Entry| {
        let is_inner = entry.is_minor && class != Class::Name;
        (has_value, class >= Class::TypoInTitle, is_inner, class, entry.is_minor)
    };
    for entry in entries {
        if let Some((class, marks)) = compare(entry, whole) {
            found.push((rank(false, class, entry), Found { entry, marks, typed: None }));
        } else if let (Action::Number(_), Some((name, value))) = (&entry.action, value(whole))
            && let Some((class, marks)) = compare(entry, name)
        {
            found.push((rank(true, class, entry), Found { entry, marks, typed: Some(value) }));
        }
    }
    found.sort_by_key(|(rank, _)| *rank);
    group_inner(found)
}

/// Moves the inner entries of one pass, its switch and its images, together: to the first of them.
fn group_inner<'a>(found: Vec<(Rank, Found<'a>)>) -> Vec<Found<'a>> {
    let mut firsts: HashMap<(Rank, String), usize> = HashMap::new();
    let keys: Vec<usize> = found
        .iter()
        .enumerate()
        .map(|(at, (rank, found))| match rank.2 {
            true => *firsts.entry((*rank, name(&found.entry.title).to_owned())).or_insert(at),
            false => at,
        })
        .collect();
    let mut found: Vec<(usize, Found<'a>)> = keys.into_iter().zip(found.into_iter().map(|(_, found)| found)).collect();
    found.sort_by_key(|(key, _)| *key);
    found.into_iter().map(|(_, found)| found).collect()
}

/// Splits `exposure 1.5 EV` into the words and the value.
fn value(query: &str) -> Option<(&str, &str)> {
    let starts = query.char_indices().zip(query.chars().skip(1)).filter(|((_, space), _)| space.is_whitespace());
    let is_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    let at = starts.filter(|(_, next)| is_number(*next)).map(|((at, _), _)| at).last()?;
    let (name, value) = query.split_at(at);
    Some((name.trim(), value.trim())).filter(|(name, _)| !name.is_empty())
}

/// How an entry matches the query, and the matched bytes of its title.
fn compare(entry: &Entry, query: &str) -> Option<(Class, Vec<Range<usize>>)> {
    let query = query.to_ascii_lowercase();
    let title = entry.title.to_ascii_lowercase();
    // The value of a number is no word of its name.
    let key = if matches!(entry.action, Action::Number(_)) { "" } else { &entry.key };
    let rest = format!("{} {} {key}", entry.group, entry.words).to_ascii_lowercase();
    let words: Vec<&str> = query.split_whitespace().collect();
    let in_title: Vec<_> = words.iter().map(|word| place(&title, word)).collect();
    let is_exact = |(word, place): (&&str, &Option<Range<usize>>)| place.is_some() || rest.contains(*word);
    if words.iter().zip(&in_title).all(is_exact) {
        let class = match title.as_str() {
            title if name(title) == query => Class::Name,
            title if begins_with_words(title, &query) => Class::FirstWords,
            title if title.starts_with(&query) => Class::Prefix,
            _ if in_title.iter().all(Option::is_some) => Class::Title,
            _ => Class::Words,
        };
        return Some((class, in_title.into_iter().flatten().collect()));
    }
    let near_title = |(word, place): (&&str, Option<Range<usize>>)| place.or_else(|| near(&title, word));
    let in_title: Vec<_> = words.iter().zip(in_title).map(near_title).collect();
    let is_near = |(word, place): (&&str, &Option<Range<usize>>)| {
        place.is_some() || rest.contains(*word) || near(&rest, word).is_some()
    };
    let class = if in_title.iter().all(Option::is_some) { Class::TypoInTitle } else { Class::Typo };
    let all = words.iter().zip(&in_title).all(is_near);
    all.then(|| (class, in_title.into_iter().flatten().collect()))
}

/// Whether a title begins with the whole words of a query: "face" begins "face orientation", but not "facet normal".
fn begins_with_words(title: &str, query: &str) -> bool {
    title.strip_prefix(query).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// The title of a switch without its action, and of a panel without that word.
fn name(title: &str) -> &str {
    let title = title.strip_prefix("panel: ").unwrap_or(title);
    title.strip_suffix(": turn on").or_else(|| title.strip_suffix(": turn off")).unwrap_or(title)
}

/// The first place of a word in a text, if possible at the beginning of a word.
fn place(text: &str, word: &str) -> Option<Range<usize>> {
    let is_start = |at: &usize| !text[..*at].ends_with(char::is_alphanumeric);
    let mut places = text.match_indices(word).map(|(at, _)| at);
    let at = places.clone().find(is_start).or_else(|| places.next())?;
    Some(at..at + word.len())
}

/// The first word of a text that is the given one, or begins with it, apart from one letter that is missing, wrong, too much or
/// exchanged with its neighbor.
fn near(text: &str, word: &str) -> Option<Range<usize>> {
    let letters = word.chars().count();
    if letters < TYPO {
        return None;
    }
    let is_near = |other: &str| strsim::osa_distance(word, other) <= 1;
    tokens(text).find(|range| {
        let token = &text[range.clone()];
        let ends = token.char_indices().map(|(at, _)| at).chain([token.len()]);
        let prefixes = ends.skip(letters - 1).take(3).map(|end| &token[..end]);
        is_near(token) || (letters >= TYPO_IN_PREFIX && prefixes.into_iter().any(is_near))
    })
}

/// The words of a text.
fn tokens(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut rest = text.char_indices().chain([(text.len(), ' ')]);
    std::iter::from_fn(move || {
        let (start, _) = rest.find(|(_, c)| c.is_alphanumeric())?;
        let (end, _) = rest.find(|(_, c)| !c.is_alphanumeric())?;
        Some(start..end)
    })
}

#[cfg(test)]
mod tests {
    use super::super::entries::{of_command, of_layout};
    use super::super::entry::Ask;
    use super::*;
    use crate::app::command::layout::KEYS;
    use crate::app::command::registry::REGISTRY;
    use crate::app::numbers::Number;
    use crate::settings::{Settings, setting};

    fn entry(title: &str, is_minor: bool) -> Entry {
        Entry { is_minor, ..Entry::new("Test", title, KEYS.with(())) }
    }

    fn titles(entries: &[Entry], query: &str) -> Vec<String> {
        find(entries, query).into_iter().map(|found| found.entry.title.clone()).collect()
    }

    #[test]
    fn words_are_found_in_any_order_and_titles_first() {
        let commands: Vec<Entry> =
            REGISTRY.iter().filter_map(|command| of_command(*command)).chain(of_layout()).collect();
        assert_eq!(titles(&commands, "panel output"), ["Panel: Output"]);
        assert_eq!(titles(&commands, "OUT panel")[0], "Panel: Output", "a title comes before further words");
        assert_eq!(titles(&commands, "undo")[0], "Undo");
        assert_eq!(titles(&commands, "f12"), ["Screenshot"]);
        assert_eq!(titles(&commands, "camera")[0], "Panel: Camera", "a title comes before a word of another entry");
        let named = [entry("Inspector of something", false), Entry::new("Panel", "Panel: Inspector", KEYS.with(()))];
        assert_eq!(titles(&named, "inspector")[0], "Panel: Inspector");
        assert!(titles(&commands, "no such words").is_empty());
        assert_eq!(titles(&commands, "").len(), commands.len());
    }

    #[test]
    fn typing_errors_come_after_exact_matches() {
        let entries = [entry("Blooom", false), entry("Bloom: turn on", false), entry("Depth of field", false)];
        assert_eq!(titles(&entries, "bloom"), ["Bloom: turn on", "Blooom"]);
        // Missing, wrong, too much, exchanged; in a whole word and in the beginning of one.
        for query in ["dpth", "dapth", "deepth", "detph", "field detph"] {
            assert_eq!(titles(&entries, query), ["Depth of field"], "{query}");
        }
        assert_eq!(titles(&[entry("Environment", false)], "envrion"), ["Environment"]);
        for query in ["dhtp", "deqqh", "dep", "fiedl xx"] {
            assert!(titles(&entries, query).len() == usize::from(query == "dep"), "{query}");
        }
    }

    #[test]
    fn a_switch_comes_before_the_modes_of_its_pass() {
        let entries = [entry("Bloom", true), entry("Bloom: blur", true), entry("Bloom: turn on", false)];
        assert_eq!(titles(&entries, "bloom"), ["Bloom: turn on", "Bloom", "Bloom: blur"]);
        assert_eq!(titles(&entries, "bloom: blur")[0], "Bloom: blur");
    }

    #[test]
    fn inner_entries_come_after_the_others_with_those_of_one_pass_together() {
        let entries = [
            entry("Depth of field: circles: turn on", true),
            entry("Depth of field: light: turn on", true),
            entry("Scene depth", false),
            entry("Depth of field: turn on", false),
            entry("Depth of field: circles", true),
            entry("Depth of field: light", true),
            entry("Depth", false),
        ];
        let expected = [
            "Depth",
            "Depth of field: turn on",
            "Scene depth",
            "Depth of field: circles: turn on",
            "Depth of field: circles",
            "Depth of field: light: turn on",
            "Depth of field: light",
        ];
        assert_eq!(titles(&entries, "depth"), expected);
        assert_eq!(titles(&entries, "Depth of field: light")[..2], expected[5..]);
    }

    #[test]
    fn a_number_takes_the_value_behind_its_name() {
        let paths = ["view.ev", "lights.orbit.0.azimuth", "lights.orbit.1.azimuth"];
        let numbers = paths.into_iter().flat_map(|path| Number::of(setting(path).unwrap()));
        let entries: Vec<Entry> =
            numbers.map(|number| Ask::of_setting(&number, &Settings::default()).entry()).collect();
        let found =
            |query| find(&entries, query).into_iter().map(|f| (f.entry.title.clone(), f.typed)).collect::<Vec<_>>();
        assert_eq!(found("exposure -1.5 EV"), [("Exposure".to_owned(), Some("-1.5 EV"))]);
        assert_eq!(found("expsoure 2"), [("Exposure".to_owned(), Some("2"))]);
        assert_eq!(found("exposure"), [("Exposure".to_owned(), None)]);
        // A number that is part of the name is no value for it.
        let lights = found("light 1");
        assert_eq!(lights[0], ("Light 1: azimuth".to_owned(), None));
        assert_eq!(lights[1], ("Light 2: azimuth".to_owned(), Some("1")));
        assert_eq!(found("light 2 azimuth 30")[0], ("Light 2: azimuth".to_owned(), Some("30")));
        assert!(found("7").is_empty());
    }

    #[test]
    fn the_matched_letters_are_marked() {
        let entries = [entry("Ambient occlusion: turn on", false)];
        let marked = |query| {
            let found = find(&entries, query).into_iter().next().unwrap();
            found.marks.into_iter().map(|mark| found.entry.title[mark].to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(marked("occ amb"), ["occ", "Amb"]);
        assert_eq!(marked("oclusion"), ["occlusion"]);
        assert!(marked("test").is_empty(), "the group has the word, the title has not");
    }
}
