//! Finds `#if` without `#endif`, and the reverse, in single files.
//!
//! glslang counts conditionals across includes. If a file lacks an `#endif`, all files after it are skipped, and glslang reports
//! errors in these. A stray `#else` may even compile, without the rest of the file that includes it. So every file is checked here.

use crate::shader::diagnostic::Diagnostic;
use crate::shader::glsl::{Line, lines};

/// A conditional directive and its line.
struct Directive<'a> {
    keyword: &'a str,
    /// The text after the keyword.
    condition: &'a str,
    line: &'a Line<'a>,
}

impl Directive<'_> {
    fn opens(&self) -> bool {
        matches!(self.keyword, "if" | "ifdef" | "ifndef")
    }

    fn error(&self, file: &str, message: &str) -> Diagnostic {
        Diagnostic::error(file, message).on_line(self.line.number, Some(self.line.raw)).under(self.line.trimmed())
    }
}

/// The first directive of `text` that has no partner in the same file.
pub fn unbalanced(file: &str, text: &str) -> Option<Diagnostic> {
    let lines = lines(text);
    let directives = directives(&lines);
    // In a file with an include guard, the last #endif belongs to the guard, so a missing #endif is missing inside.
    match guarded(&lines, &directives) {
        Some(inside) => check(file, inside).map(|error| {
            let guard = &directives[0];
            let note =
                format!("the last #endif of the file is taken for that of the guard on line {}", guard.line.number);
            error.with_note(note)
        }),
        None => check(file, &directives),
    }
}

/// A quick look, which takes comments for code and does not count `#else`.
pub fn looks_balanced(text: &str) -> bool {
    let mut depth = 0_u32;
    for directive in text.lines().filter_map(|line| line.trim_start().strip_prefix('#')) {
        match directive.trim_start().get(..2) {
            Some("if") => depth += 1,
            Some("en") if depth > 0 => depth -= 1,
            Some("en" | "el") if depth == 0 => return false,
            _ => {}
        }
    }
    depth == 0
}

fn check(file: &str, directives: &[Directive<'_>]) -> Option<Diagnostic> {
    // The open blocks: the directive that opened each, and the line of its #else.
    let mut open: Vec<(&Directive<'_>, Option<u32>)> = Vec::new();
    for directive in directives {
        let keyword = directive.keyword;
        match (keyword, open.last_mut()) {
            _ if directive.opens() => open.push((directive, None)),
            (_, None) => {
                let message = format!("`#{keyword}` has no `#if`, `#ifdef` or `#ifndef` before it in this file");
                let help = format!("remove this `#{keyword}`, or add the missing `#if` in this file");
                return Some(directive.error(file, &message).with_help(help));
            }
            ("endif", Some(_)) => {
                open.pop();
            }
            (_, Some((opener, Some(line)))) => {
                let message =
                    format!("`#{keyword}` follows the `#else` on line {line} of the same `#{}`", opener.keyword);
                let help = format!("add the `#endif` of an inner `#if` before it, or remove this `#{keyword}`");
                return Some(directive.error(file, &message).with_help(help));
            }
            ("else", Some((_, found))) => *found = Some(directive.line.number),
            _ => {}
        }
    }
    let (opener, _) = open.pop()?;
    let written = format!("#{} {}", opener.keyword, opener.condition);
    let message = format!("`{}` has no `#endif` in this file", written.trim_end());
    Some(
        opener.error(file, &message).with_help("add `#endif` where the block ends; each file must close what it opens"),
    )
}

/// The directives between an include guard and its `#endif`, if the file has such a guard and both ends of it.
fn guarded<'a, 'b>(lines: &[Line<'_>], directives: &'b [Directive<'a>]) -> Option<&'b [Directive<'a>]> {
    let [first, inside @ .., last] = directives else { return None };
    let mut code = lines.iter().filter(|line| !line.is_blank());
    let (begin, define, end) = (code.next()?, code.next()?, code.next_back()?);
    let defined = define.tokens();
    let defined: Vec<&str> = defined.iter().map(|token| token.text).collect();
    let is_guard = first.keyword == "ifndef"
        && begin.number == first.line.number
        && defined.starts_with(&["#", "define", first.condition]);
    (is_guard && last.keyword == "endif" && end.number == last.line.number).then_some(inside)
}

fn directives<'a>(lines: &'a [Line<'a>]) -> Vec<Directive<'a>> {
    let directive = |line: &'a Line<'a>| {
        let keyword = line.keyword?;
        let condition = line.code.split_once(keyword)?.1.trim();
        let is_conditional = matches!(keyword, "if" | "ifdef" | "ifndef" | "elif" | "else" | "endif");
        is_conditional.then_some(Directive { keyword, condition, line })
    };
    lines.iter().filter_map(directive).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Option<String> {
        unbalanced("a.glsl", text).map(|error| error.one_line())
    }

    #[test]
    fn balanced_files_have_no_error() {
        for text in [
            "",
            "#ifndef A\n#define A\n#if X\n#elif Y\n#else\n#endif\n#endif\n",
            "  # if 1 // #if\n/* #endif\n#if */\n /* c */ # endif",
            "#define X \\\n#if\n",
            "#if X \\\n  #endif\n#endif",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }

    #[test]
    fn the_opener_without_an_end_is_named() {
        let no_end = "has no `#endif` in this file";
        let cases = [
            ("float a;\n#ifdef X\n", 2, "`#ifdef X`"),
            ("#if A\n#endif\n  #if B > 1 // why\n", 3, "`#if B > 1`"),
            // The guard itself, and a block inside the guard.
            ("// A.\n#ifndef A\n#define A\nfloat a;\n", 2, "`#ifndef A`"),
            ("#ifndef A\n#define A\n#if X\nfloat a;\n#endif\nfloat b;\n", 1, "`#ifndef A`"),
            ("#ifndef A\n#define A\n#if X\nfloat a;\n\n#endif\n", 3, "`#if X`"),
        ];
        for (text, line, opener) in cases {
            let one_line = found(text).unwrap_or_default();
            assert!(one_line.starts_with(&format!("a.glsl:{line}:")), "{text}: {one_line}");
            assert!(one_line.ends_with(&format!("error: {opener} {no_end}")), "{text}: {one_line}");
        }
    }

    #[test]
    fn an_end_without_an_opener_is_named() {
        assert!(found("float a;\n#endif\n").unwrap().starts_with("a.glsl:2:1: error: `#endif` has no `#if`"));
        assert!(found(" #else\n").unwrap().starts_with("a.glsl:1:2: error: `#else` has no `#if`"));
        let extra = "#ifndef A\n#define A\nfloat a;\n#endif\nfloat b;\n#endif\n";
        assert!(found(extra).unwrap().starts_with("a.glsl:4:1: error: `#endif` has no `#if`"));
        let twice = "#if A\n#else\n#elif B\n#endif\n";
        assert!(found(twice).unwrap().contains("a.glsl:3:1: error: `#elif` follows the `#else` on line 2"));
    }
}
