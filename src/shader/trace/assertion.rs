//! Conditions that the values of a line must fulfill.

use std::collections::HashMap;

use super::{Act, Doing, Event, Fragment, TracedValue};

/// A condition about the values at a line: `FILE:LINE NAME > NUMBER`. `NAME` may end in a component, as `n.x`, or be `return` or
/// `condition`.
#[derive(Clone, Debug, PartialEq)]
pub struct Assertion {
    text: String,
    /// The file that it is about.
    pub file: String,
    line: u32,
    name: String,
    comparison: Comparison,
    limit: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

impl Comparison {
    const ALL: [(&str, Self); 6] = [
        ("<", Self::Less),
        ("<=", Self::LessOrEqual),
        (">", Self::Greater),
        (">=", Self::GreaterOrEqual),
        ("==", Self::Equal),
        ("!=", Self::NotEqual),
    ];

    fn holds(self, number: f64, limit: f64) -> bool {
        match self {
            Self::Less => number < limit,
            Self::LessOrEqual => number <= limit,
            Self::Greater => number > limit,
            Self::GreaterOrEqual => number >= limit,
            Self::Equal => number == limit,
            Self::NotEqual => number != limit,
        }
    }
}

impl Assertion {
    /// Reads an assertion.
    ///
    /// # Errors
    /// A message with the form that was expected.
    pub fn parse(text: &str) -> Result<Self, String> {
        let expected = || "expected FILE:LINE NAME > NUMBER, as 'brdf/ndf.glsl:21 spread > 0'".to_owned();
        let words: Vec<&str> = text.split_whitespace().collect();
        let [place, name, comparison, limit] = words.as_slice() else { return Err(expected()) };
        let (file, line) = place.rsplit_once(':').ok_or_else(expected)?;
        let comparison = Comparison::ALL.iter().find(|(sign, _)| sign == comparison).ok_or_else(expected)?.1;
        let number = match *limit {
            "true" => Ok(1.0),
            "false" => Ok(0.0),
            limit => limit.parse(),
        };
        Ok(Self {
            text: words.join(" "),
            file: file.to_owned(),
            line: line.parse().map_err(|_| expected())?,
            name: (*name).to_owned(),
            comparison,
            limit: number.map_err(|_| expected())?,
        })
    }

    /// Why a text has no such line.
    pub fn lacks_line(&self, text: &str) -> Option<String> {
        let count = text.lines().count();
        let has = self.line > 0 && self.line as usize <= count;
        (!has).then(|| format!("{}: {} has {count} lines", self.text, self.file))
    }

    /// Whether this is the place, and the name of its value or of a vector with the component. Returns that component.
    fn finds(&self, doing: &Doing) -> Option<Option<usize>> {
        let name = match doing.act {
            Act::Return => format!("return{}", doing.name),
            Act::Condition => "condition".to_owned(),
            Act::Store | Act::Argument | Act::Discard | Act::Leave => doing.name.clone(),
        };
        if (doing.file.as_str(), doing.line) != (&*self.file, self.line) {
            return None;
        }
        if name == self.name {
            return Some(None);
        }
        let component = self.name.strip_prefix(&name)?.strip_prefix('.')?;
        let index = ["xyzw", "rgba"].iter().find_map(|letters| letters.find(component));
        index.filter(|_| component.len() == 1).map(Some)
    }

    /// Checks the values of all times. NaN fulfills nothing but `!=`.
    ///
    /// # Errors
    /// The first value that does not fulfill it, or that no value was computed there, or that not all were logged.
    pub fn check(&self, fragment: &Fragment) -> Result<(), String> {
        let named = || fragment.events.iter().filter_map(|event| Some((event, self.finds(&event.doing)?)));
        let value = |(event, component): (&Event, Option<usize>)| match component {
            Some(at) => event.value?.component(at),
            None => event.value,
        };
        let values: Vec<TracedValue> = named().filter_map(value).collect();
        let fails = |value: &&TracedValue| !value.numbers().all(|number| self.comparison.holds(number, self.limit));
        let failed: Vec<&TracedValue> = values.iter().filter(fails).collect();
        let last: HashMap<&Doing, u32> = named().map(|(event, _)| (&*event.doing, event.time)).collect();
        let not_logged = (last.values().sum::<u32>() as usize).saturating_sub(named().count());
        match (failed.first(), not_logged) {
            (Some(first), _) => Err(format!(
                "{}: failed for {} of {} values; the first is {}",
                self.text,
                failed.len(),
                values.len(),
                first.text()
            )),
            (None, 0) if values.is_empty() => Err(self.nothing(fragment)),
            (None, 0) => Ok(()),
            (None, count) => Err(format!(
                "{}: holds for the first and the last of {} values, but {count} between them were not logged",
                self.text,
                values.len() + count
            )),
        }
    }

    fn nothing(&self, fragment: &Fragment) -> String {
        let here = fragment.events.iter().map(|event| &event.doing);
        let here = here.filter(|doing| (doing.file.as_str(), doing.line) == (&*self.file, self.line));
        let mut names: Vec<&str> = Vec::new();
        for doing in here {
            let name = match doing.act {
                Act::Return => "return",
                Act::Condition => "condition",
                Act::Store | Act::Argument | Act::Discard | Act::Leave => doing.name.as_str(),
            };
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let known = match names.as_slice() {
            [] => "the line was not reached".to_owned(),
            names => format!("the line has {}", names.join(", ")),
        };
        format!("{}: no value of `{}` was computed at this pixel; {known}", self.text, self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample::{event, trace};
    use super::*;

    #[test]
    fn assertions_name_what_fails() {
        let mut events = vec![
            event(3, Act::Store, "n", &[0.0, 1.0]),
            event(4, Act::Store, "d", &[0.5]),
            event(4, Act::Store, "d", &[-1.0]),
            event(5, Act::Return, "", &[f32::NAN]),
        ];
        // The middle of a long loop counts, too.
        events.extend((0..99).map(|round| event(6, Act::Store, "i", &[if round == 50 { -3.0 } else { 1.0 }])));
        events.extend([1, 2, 5].map(|time| Event { time, ..event(8, Act::Store, "j", &[1.0]) }));
        let trace = trace(events, &[]);
        let check = |text: &str| Assertion::parse(text).unwrap().check(&trace.fragments[0]);
        for text in
            ["a.glsl:3 n >= 0", "a.glsl:3 n.y > 0.5", "a.glsl:3 n.r == 0", "a.glsl:4 d < 1", "a.glsl:5 return != 0"]
        {
            assert_eq!(check(text), Ok(()));
        }
        for (text, words) in [
            ("a.glsl:3 n > 0", "failed for 1 of 1 values; the first is (0, 1)"),
            ("a.glsl:3 n.x > 0", "failed for 1 of 1 values; the first is 0"),
            ("a.glsl:3 n.z > 0", "no value of `n.z` was computed at this pixel; the line has n"),
            ("a.glsl:4 d > 0", "failed for 1 of 2 values; the first is -1"),
            ("a.glsl:5 return >= 0", "the first is NaN"),
            ("a.glsl:6 i > 0", "failed for 1 of 99 values; the first is -3"),
            ("a.glsl:4 e > 0", "no value of `e` was computed at this pixel; the line has d"),
            ("a.glsl:7 e > 0", "the line was not reached"),
            ("a.glsl:8 j > 0", "the first and the last of 5 values, but 2 between them were not logged"),
            ("a.glsl:8 j < 0", "failed for 3 of 3 values"),
        ] {
            let error = check(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
        }
        for text in ["a.glsl:3 n", "a.glsl n > 0", "a.glsl:x n > 0", "a.glsl:3 n ~ 0", "a.glsl:3 n > much", ""] {
            assert!(Assertion::parse(text).unwrap_err().contains("expected FILE:LINE NAME > NUMBER"), "{text}");
        }
    }
}
