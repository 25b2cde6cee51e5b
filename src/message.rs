//! Shared by all messages: control characters of foreign names are escaped before a terminal sees them, and a name
//! that does not exist is answered with the nearest one that does.
//!
//! All output of the program goes through this file, because `println!` and `eprintln!` panic when nobody reads them or the disk is full.

use std::any::Any;
use std::cell::Cell;
use std::fmt::{Arguments, Display, Write as _};
use std::io::{ErrorKind, Write as _, stderr, stdout};
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::{Mutex, MutexGuard, Once, OnceLock, PoisonError};

/// Fewest letters of a typed word that can stand for a longer name with this word in it, or with the same begin.
const LEAST_PART: usize = 4;
/// Longest name that is compared with others, in bytes: the time grows with the square of the length.
const LONGEST_NAME: usize = 64;

/// One line of text without control characters: each, line breaks and tabs too, becomes an escape such as `\u{1b}`. For
/// names from files.
pub fn escape(text: &str) -> String {
    escape_but(text, &[])
}

/// Text of several lines without control characters: line breaks and tabs stay, and all others become escapes such as
/// `\u{1b}`. For whole messages.
pub fn escape_lines(text: &str) -> String {
    escape_but(text, &['\n', '\t'])
}

/// The message of a panic that `catch_unwind` or a joined thread returns.
pub(crate) fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// Runs `work`, such as a decoder of foreign files. A panic in it becomes its message, and prints nothing.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    thread_local! {
        static IS_CAUGHT: Cell<bool> = const { Cell::new(false) };
    }
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let report = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_CAUGHT.get() {
                report(panic);
            }
        }));
    });
    let before = IS_CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    IS_CAUGHT.set(before);
    result.map_err(|panic| panic_text(&*panic).to_owned())
}

fn escape_but(text: &str, kept: &[char]) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' if !kept.contains(&c) => out.push_str("\\n"),
            c if c.is_control() && !kept.contains(&c) => {
                let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out
}

/// Whether a status line is in the terminal.
static STATUS: Mutex<bool> = Mutex::new(false);

/// Shows a line on stderr, a terminal, in place of the one before: `specula: TEXT`. What is printed next takes its place.
pub fn show_status(text: &str) {
    let mut is_shown = STATUS.lock().unwrap_or_else(PoisonError::into_inner);
    // Without wrapping: only one row can be overwritten.
    write_error(format_args!("\r\u{1b}[?7lspecula: {}\u{1b}[K\u{1b}[?7h", escape(text)));
    *is_shown = true;
}

/// Removes the status line, so that other text can be printed.
pub fn clear_status() {
    drop(without_status());
}

/// Removes the status line. None is shown while the guard lives.
pub fn without_status() -> MutexGuard<'static, bool> {
    let mut is_shown = STATUS.lock().unwrap_or_else(PoisonError::into_inner);
    if std::mem::take(&mut *is_shown) {
        write_error(format_args!("\r\u{1b}[K"));
    }
    is_shown
}

/// Writes to stderr. If nobody reads it or its disk is full, there is nobody to tell.
fn write_error(text: Arguments<'_>) {
    let _ = stderr().write_fmt(text);
}

/// The first reason why stdout did not take a line.
static LOST_OUTPUT: OnceLock<String> = OnceLock::new();

/// Prints text to stdout as it is, with a line break. A reader that has gone away, as `head` does, is ignored; another failure is kept
/// for [`lost_output`].
pub fn print_output(text: &str) {
    let _guard = without_status();
    keep_loss(writeln!(stdout().lock(), "{text}"));
}

/// Writes what stdout has buffered. A failure is kept for [`lost_output`].
pub fn flush_output() {
    keep_loss(stdout().flush());
}

fn keep_loss(result: std::io::Result<()>) {
    if let Err(error) = result
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _ = LOST_OUTPUT.set(error.to_string());
    }
}

/// Why stdout lacks text that was printed; `None` if it took all.
pub fn lost_output() -> Option<&'static str> {
    LOST_OUTPUT.get().map(String::as_str)
}

/// Prints a line, or several, to stderr as they are.
pub fn print_error(text: impl Display) {
    let _guard = without_status();
    write_error(format_args!("{text}\n"));
}

/// Prints a message to stderr: `specula: MESSAGE`, with its control characters escaped.
pub fn tell(message: impl Display) {
    print_error(format_args!("specula: {}", escape_lines(&message.to_string())));
}

/// Prints a warning to stderr: `specula: warning: MESSAGE`, with its control characters escaped.
pub fn warn(message: impl Display) {
    print_error(format_args!("specula: warning: {}", escape_lines(&message.to_string())));
}

/// A number with commas between thousands. Whole numbers have no decimals, others two.
pub fn grouped(value: f64) -> String {
    if value.fract() != 0.0 && value.abs() < 1e4 {
        return format!("{value:.2}");
    }
    let digits = format!("{:.0}", value.abs());
    let mut out = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    if value < 0.0 { format!("-{out}") } else { out }
}

/// The candidate most similar to what was typed, ignoring case; the first of several equally similar ones. `None` if none is
/// similar enough.
pub fn nearest<'a>(typed: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |candidate: &'a str| (likeness(typed, candidate), candidate);
    best(candidates.into_iter().map(likeness))
}

/// The similarity of a typed name and a known one, 0..1; 1 if they differ only in case. 0 if the known one is not near enough to be meant:
/// more letters differ than [`most_typos`], the typed word is no part of it, and not half of the word is its begin.
pub(crate) fn likeness(typed: &str, known: &str) -> f64 {
    if typed.len().max(known.len()) > LONGEST_NAME {
        return 0.0;
    }
    let (typed, known) = (typed.to_lowercase(), known.to_lowercase());
    let (letters, most) = (typed.chars().count(), typed.chars().count().max(known.chars().count()));
    let distance = strsim::damerau_levenshtein(&typed, &known);
    let begin = typed.chars().zip(known.chars()).take_while(|(a, b)| a == b).count();
    let is_part = letters >= LEAST_PART && known.contains(&typed) || begin >= LEAST_PART.max(letters.div_ceil(2));
    if distance > most_typos(letters) && !is_part { 0.0 } else { 1.0 - distance as f64 / most.max(1) as f64 }
}

/// How many letters of a typed word may differ from the name that is meant: a third, and two of a word with four or five.
pub(crate) fn most_typos(letters: usize) -> usize {
    match letters {
        0 | 1 => 0,
        2 | 3 => 1,
        letters => (letters / 3).max(2),
    }
}

/// The first candidate with the greatest similarity, unless that is 0.
pub(crate) fn best<'a>(candidates: impl Iterator<Item = (f64, &'a str)>) -> Option<&'a str> {
    let (likeness, best) = candidates.reduce(|best, next| if next.0 > best.0 { next } else { best })?;
    (likeness > 0.0).then_some(best)
}

/// The question at the end of a message about an unknown name, as `` Did you mean `studio`? `` with a leading space; empty if no
/// candidate is similar.
pub fn did_you_mean<'a>(typed: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(typed, candidates).map(|name| format!(" Did you mean `{name}`?")).unwrap_or_default()
}

/// A list in words: `A, B or C`.
pub fn either<T: Display>(items: &[T]) -> String {
    match items {
        [] => "nothing".to_owned(),
        [one] => one.to_string(),
        [all @ .., last] => format!("{} or {last}", all.iter().map(T::to_string).collect::<Vec<_>>().join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_grouped() {
        let numbers = [0.0, 999.0, 1000.0, -1_234_567.0, 2.5];
        assert_eq!(numbers.map(grouped), ["0", "999", "1,000", "-1,234,567", "2.50"]);
    }

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(escape("a\u{1b}[31m\tb\nc\r\u{7f}\u{9b}ä"), "a\\u{1b}[31m\\u{9}b\\nc\\u{d}\\u{7f}\\u{9b}ä");
        assert_eq!(escape_lines("a\u{1b}\tb\nc"), "a\\u{1b}\tb\nc");
    }

    #[test]
    fn the_nearest_name_is_found_whatever_its_case() {
        let names = ["GGX", "ndf", "studio", "sky"];
        for (typed, expected) in [("NDF", Some("ndf")), ("nfd", Some("ndf")), ("studo", Some("studio")), ("qqqq", None)]
        {
            assert_eq!(nearest(typed, names), expected, "{typed}");
        }
        assert_eq!(nearest("x", []), None);
        for (typed, known) in [("foo", "fovy"), ("metal", "petals"), ("gold", "model"), ("x", "y"), ("sun", "sky")] {
            assert_eq!(nearest(typed, [known]).is_some(), typed == "metal", "{typed} {known}");
        }
        assert_eq!(nearest("helmet", ["Boots", "DamagedHelmet"]), Some("DamagedHelmet"), "a part of a name");
        assert_eq!(nearest("metal-ness", ["normal", "metallic"]), Some("metallic"), "the same begin");
        assert_eq!(did_you_mean("sly", names), " Did you mean `sky`?");
    }

    #[test]
    fn words_longer_than_names_are_not_compared() {
        let word = "A".repeat(200_000_000);
        let start = std::time::Instant::now();
        assert_eq!(nearest(&word, [&*word, "studio"]), None);
        // Two words of 100,000 letters take seconds.
        assert!(start.elapsed().as_secs() < 1);
        assert_eq!(nearest(&"A".repeat(LONGEST_NAME), [&*"a".repeat(LONGEST_NAME)]), Some(&*"a".repeat(LONGEST_NAME)));
    }

    #[test]
    fn a_caught_panic_is_its_message() {
        assert_eq!(catch_panic(|| 7), Ok(7));
        assert_eq!(catch_panic(|| -> u8 { panic!("damaged {}", 3) }), Err("damaged 3".to_owned()));
        assert_eq!(catch_panic(|| catch_panic(|| -> u8 { panic!("inner") })), Ok(Err("inner".to_owned())));
    }

    #[test]
    fn lists_are_told_in_words() {
        assert_eq!(either(&["GGX"]), "GGX");
        assert_eq!(either(&[0, 1, 2]), "0, 1 or 2");
    }
}
