//! The values of a file's statements at the pixels around one.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::{Value, json};

use super::calls::is_related;
use super::{Act, Trace, TracedValue};

/// Most pixels in a row and in a column.
pub const SIDE: u32 = 8;

/// A statement of a file: its line, from 1, what it does, and the variable.
type Statement = (u32, Act, String);

/// The values of a statement in order, each with the calls that led to it and its time, from 1.
type Values = Vec<(Arc<str>, u32, TracedValue)>;

/// Which value counts of a statement that runs more than once.
#[derive(Clone, Copy, Debug, Default)]
pub struct Which<'a> {
    /// Only values of this call, of those that led to it, and of those that it makes.
    pub call: Option<&'a str>,
    /// The time, from 1; the last one without it.
    pub time: Option<usize>,
}

/// The values of a file's statements at the fragments that are seen at a square of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighborhood {
    /// The upper left pixel of the square.
    pub first: (u32, u32),
    /// Pixels in a row, and rows.
    pub size: (u32, u32),
    /// The values by pixels, row by row.
    pixels: Vec<BTreeMap<Statement, Values>>,
}

impl Neighborhood {
    /// The square around a pixel of a picture of this size. `trace`: what happens at a pixel; `None` where the stage draws nothing.
    ///
    /// # Errors
    /// Those of `trace`.
    pub fn new<E>(
        at: (u32, u32),
        picture: (u32, u32),
        file: &str,
        mut trace: impl FnMut((u32, u32)) -> Result<Option<Trace>, E>,
    ) -> Result<Self, E> {
        let size = (picture.0.min(SIDE), picture.1.min(SIDE));
        let begin = |at: u32, size: u32, picture: u32| at.saturating_sub(size / 2).min(picture - size);
        let first = (begin(at.0, size.0, picture.0), begin(at.1, size.1, picture.1));
        let places = (0..size.1).flat_map(|y| (0..size.0).map(move |x| (first.0 + x, first.1 + y)));
        let pixels = places.map(|at| Ok(trace(at)?.map(|trace| values(&trace, file)).unwrap_or_default()));
        Ok(Self { first, size, pixels: pixels.collect::<Result<_, E>>()? })
    }

    /// The values of a statement, row by row; `None` where it does not run.
    pub fn values(&self, line: u32, act: Act, name: &str, which: Which<'_>) -> Vec<Option<TracedValue>> {
        let statement = (line, act, name.to_owned());
        let chosen = |values: &Values| {
            let of_call =
                |(calls, ..): &&(Arc<str>, u32, TracedValue)| which.call.is_none_or(|call| is_related(calls, call));
            let mut values = values.iter().filter(of_call);
            let (_, first, _) = values.clone().next()?;
            let found = match which.time {
                Some(chosen) => values.find(|(_, time, _)| (time - first + 1) as usize == chosen.max(1)),
                None => values.next_back(),
            };
            found.map(|(.., value)| *value)
        };
        self.pixels.iter().map(|pixel| pixel.get(&statement).and_then(chosen)).collect()
    }

    /// All of it for programs: the last `values` of each statement, row by row.
    pub fn json(&self) -> Value {
        let statements: BTreeMap<&Statement, ()> =
            self.pixels.iter().flat_map(|pixel| pixel.keys().map(|statement| (statement, ()))).collect();
        let statement = |(line, act, name): &Statement| {
            let values = self
                .values(*line, *act, name, Which::default())
                .into_iter()
                .map(|value| value.map(|value| value.json()));
            json!({ "line": line, "act": act, "name": name, "values": values.collect::<Vec<_>>() })
        };
        let first = [self.first.0, self.first.1];
        json!({ "first": first, "size": [self.size.0, self.size.1],
            "statements": statements.keys().map(|of| statement(of)).collect::<Vec<_>>() })
    }
}

/// The values of each statement of a file at the fragment that is seen.
fn values(trace: &Trace, file: &str) -> BTreeMap<Statement, Values> {
    let mut all: BTreeMap<Statement, Values> = BTreeMap::new();
    let fragment = trace.visible().map(|fragment| &trace.fragments[fragment]);
    for event in fragment.into_iter().flat_map(|fragment| &fragment.events) {
        let doing = &event.doing;
        if let (Some(value), true) = (event.value, doing.file == file) {
            let statement = (doing.line, doing.act, doing.name.clone());
            all.entry(statement).or_default().push((event.calls.clone(), event.time, value));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::super::sample::{event, trace};
    use super::*;

    #[test]
    fn a_square_has_the_last_values_around_a_pixel_and_stays_in_the_picture() {
        let of = |at: (u32, u32)| -> Result<Option<Trace>, Infallible> {
            let number = (100 * at.1 + at.0) as f32;
            let events = vec![event(3, Act::Store, "i", &[0.0]), event(3, Act::Store, "i", &[number])];
            Ok((at.0 != 63).then(|| trace(events, &[3])))
        };
        let inner = Neighborhood::new((20, 30), (64, 48), "a.glsl", of).unwrap();
        assert_eq!((inner.first, inner.size), ((16, 26), (8, 8)));
        let values = inner.values(3, Act::Store, "i", Which::default());
        assert_eq!(values[4 * 8 + 4], Some(TracedValue::float(3020.0)), "the pixel itself");
        assert_eq!(values[0], Some(TracedValue::float(2616.0)));
        let first = inner.values(3, Act::Store, "i", Which { call: None, time: Some(1) });
        assert_eq!(first[0], Some(TracedValue::float(0.0)));
        let other = inner.values(3, Act::Store, "i", Which { call: Some("g"), time: None });
        assert!(other.iter().all(Option::is_none), "the values are of the call f");
        assert!(inner.values(3, Act::Return, "i", Which::default()).iter().all(Option::is_none));
        let corner = Neighborhood::new((63, 0), (64, 48), "a.glsl", of).unwrap();
        assert_eq!(corner.first, (56, 0));
        let values = corner.values(3, Act::Store, "i", Which::default());
        assert_eq!((values[7], values[6]), (None, Some(TracedValue::float(62.0))));
        let json = corner.json();
        assert_eq!((&json["statements"][0]["line"], &json["statements"][0]["values"][6]), (&json!(3), &json!(62.0)));
        let small = Neighborhood::new((1, 1), (3, 2), "a.glsl", of).unwrap();
        assert_eq!(
            (small.first, small.size, small.values(3, Act::Store, "i", Which::default()).len()),
            ((0, 0), (3, 2), 6)
        );
    }
}
