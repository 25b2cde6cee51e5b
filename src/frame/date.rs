//! The date and time of the day that shaders read.

use std::str::FromStr;

use chrono::{Datelike as _, Local, NaiveDate, NaiveDateTime, NaiveTime, TimeDelta, Timelike as _};

/// A date with the time of the day, in whatever time zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Date(NaiveDateTime);

/// January 1, 2000.
impl Default for Date {
    fn default() -> Self {
        Self(NaiveDate::from_ymd_opt(2000, 1, 1).unwrap_or_default().and_time(NaiveTime::MIN))
    }
}

impl Date {
    /// Now, in the time zone of the system.
    pub fn now() -> Self {
        Self(Local::now().naive_local())
    }

    /// The date `seconds` later. Beyond the end of the calendar it stays.
    #[must_use]
    pub fn after(self, seconds: f32) -> Self {
        let delta = TimeDelta::microseconds((f64::from(seconds) * 1e6) as i64);
        Self(self.0.checked_add_signed(delta).unwrap_or(self.0))
    }

    /// Year, month from 0, day from 1, and seconds of the day, as Shadertoy's `iDate`.
    pub fn parts(self) -> [f32; 4] {
        let seconds = f64::from(self.0.num_seconds_from_midnight()) + f64::from(self.0.nanosecond()) * 1e-9;
        [self.0.year() as f32, self.0.month0() as f32, self.0.day() as f32, seconds as f32]
    }
}

/// Parses `2026-11-23T16:00:00`. Seconds, or all of the time, may be left out.
impl FromStr for Date {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let time = |format| NaiveDateTime::parse_from_str(text, format).ok();
        let day = || NaiveDate::parse_from_str(text, "%Y-%m-%d").ok().map(|day| day.and_time(NaiveTime::MIN));
        let found = time("%Y-%m-%dT%H:%M:%S").or_else(|| time("%Y-%m-%dT%H:%M")).or_else(day);
        let is_known = |date: &NaiveDateTime| (1..=9999).contains(&date.year());
        let message = || "expected a date of the years 1 to 9999, as 2026-11-23T16:00:00".to_owned();
        found.filter(is_known).map(Self).ok_or_else(message)
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
        assert_eq!(parts("2026-11-23T16:00:00"), [2026.0, 10.0, 23.0, 57_600.0]);
        assert_eq!(parts("2026-11-23T16:30"), [2026.0, 10.0, 23.0, 59_400.0]);
        assert_eq!(parts("2024-02-29T23:59:59"), [2024.0, 1.0, 29.0, 86_399.0]);
        assert_eq!(parts("0001-01-01"), [1.0, 0.0, 1.0, 0.0]);
        assert_eq!("2026-12-31T23:59:59".parse::<Date>().unwrap().after(2.5).parts(), [2027.0, 0.0, 1.0, 1.5]);
    }

    #[test]
    fn what_is_no_date_is_refused() {
        for text in ["", "2026", "2026-13-01", "2026-02-29", "2026-01-01T24:00", "2026-01-01T1", "x-1-1", "0-1-1"] {
            assert!(text.parse::<Date>().is_err(), "{text}");
        }
    }
}
