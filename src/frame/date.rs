//! The date and time of the day that shaders read.

use std::str::FromStr;

const SECONDS_OF_DAY: f64 = 86_400.0;
/// Days from January 1 of year 1 to January 1, 1970.
const DAYS_TO_1970: i64 = 719_162;

/// A date with the time of the day, in whatever time zone: seconds since the beginning of 1970 there.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Date(f64);

/// January 1, 2000.
impl Default for Date {
    fn default() -> Self {
        Self(946_684_800.0)
    }
}

impl Date {
    /// The date this many seconds after the beginning of 1970.
    pub fn from_seconds(seconds: f64) -> Self {
        Self(seconds)
    }

    /// The date `seconds` later.
    #[must_use]
    pub fn after(self, seconds: f32) -> Self {
        Self(self.0 + f64::from(seconds))
    }

    /// Year, month from 0, day from 1, and seconds of the day, as Shadertoy's `iDate`.
    pub fn parts(self) -> [f32; 4] {
        let days = (self.0 / SECONDS_OF_DAY).floor();
        let seconds = self.0 - days * SECONDS_OF_DAY;
        let mut left = days as i64 + DAYS_TO_1970;
        // 400 years have 146,097 days. The estimate is the year or the one after.
        let mut year = left * 400 / 146_097 + 1;
        while days_before(year) > left {
            year -= 1;
        }
        while days_before(year + 1) <= left {
            year += 1;
        }
        left -= days_before(year);
        let mut month = 0;
        while left >= days_of(year, month) {
            left -= days_of(year, month);
            month += 1;
        }
        [year as f32, month as f32, left as f32 + 1.0, seconds as f32]
    }
}

/// Parses `2026-11-23T16:00:00`. Seconds, or all of the time, may be left out.
impl FromStr for Date {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        parse(text).ok_or_else(|| "expected a date of the years 1 to 9999, as 2026-11-23T16:00:00".to_owned())
    }
}

fn parse(text: &str) -> Option<Date> {
    let (date, time) = text.split_once('T').unwrap_or((text, "0:0"));
    let number = |text: &str| text.parse::<u32>().ok().map(i64::from);
    let [year, month, day] = <[&str; 3]>::try_from(date.split('-').collect::<Vec<_>>()).ok()?.map(number);
    let (year, month, day) = (year?, month? - 1, day?);
    let time: Option<Vec<i64>> = time.split(':').map(number).collect();
    let (hour, minute, second) = match *time? {
        [hour, minute] => (hour, minute, 0),
        [hour, minute, second] => (hour, minute, second),
        _ => return None,
    };
    let is_date = (1..=9999).contains(&year) && (0..12).contains(&month) && (1..=days_of(year, month)).contains(&day);
    if !is_date || hour > 23 || minute > 59 || second > 59 {
        return None;
    }
    let days = days_before(year) + (0..month).map(|month| days_of(year, month)).sum::<i64>() + day - 1 - DAYS_TO_1970;
    Some(Date(days as f64 * SECONDS_OF_DAY + (hour * 3600 + minute * 60 + second) as f64))
}

/// Days from January 1 of year 1 to January 1 of this year, in the Gregorian calendar.
fn days_before(year: i64) -> i64 {
    let years = year - 1;
    365 * years + years / 4 - years / 100 + years / 400
}

/// Days of a month, counted from 0.
fn days_of(year: i64, month: i64) -> i64 {
    match month {
        1 => days_before(year + 1) - days_before(year) - 337,
        3 | 5 | 8 | 10 => 30,
        _ => 31,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str) -> [f32; 4] {
        text.parse::<Date>().unwrap().parts()
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(Date::default().parts(), [2000.0, 0.0, 1.0, 0.0]);
        assert_eq!(Date::from_seconds(0.0).parts(), [1970.0, 0.0, 1.0, 0.0]);
        assert_eq!(Date::from_seconds(1_709_251_199.0).parts(), [2024.0, 1.0, 29.0, 86_399.0]);
        assert_eq!(Date::from_seconds(-1.0).parts(), [1969.0, 11.0, 31.0, 86_399.0]);
        assert_eq!(parts("2026-11-23T16:00:00"), [2026.0, 10.0, 23.0, 57_600.0]);
        assert_eq!(parts("2026-11-23T16:30"), [2026.0, 10.0, 23.0, 59_400.0]);
        assert_eq!(parts("0001-01-01"), [1.0, 0.0, 1.0, 0.0]);
        assert_eq!("2026-12-31T23:59:59".parse::<Date>().unwrap().after(2.5).parts(), [2027.0, 0.0, 1.0, 1.5]);
    }

    #[test]
    fn each_day_follows_the_one_before() {
        let first: Date = "1899-12-31".parse().unwrap();
        let mut before = first.parts();
        for day in 1..=80_000 {
            let [year, month, day, _] = Date(first.0 + f64::from(day) * SECONDS_OF_DAY).parts();
            let text = format!("{year:04}-{:02}-{day:02}", month + 1.0);
            assert_eq!(parts(&text), [year, month, day, 0.0], "{text}");
            assert!([year, month, day] > [before[0], before[1], before[2]], "{text}");
            before = [year, month, day, 0.0];
        }
    }

    #[test]
    fn what_is_no_date_is_refused() {
        for text in ["", "2026", "2026-13-01", "2026-02-29", "2026-01-01T24:00", "2026-01-01T1", "x-1-1", "0-1-1"] {
            assert!(text.parse::<Date>().is_err(), "{text}");
        }
    }
}
