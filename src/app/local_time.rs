//! The date and time of the day in the time zone of the system.

use std::time::SystemTime;

use crate::frame::Date;

/// The local date and time now.
pub(super) fn now() -> Date {
    let since_1970 = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    Date::from_seconds(since_1970.as_secs_f64() + offset_s(since_1970.as_secs()))
}

/// How many seconds local time is ahead of UTC, this many seconds after the beginning of 1970.
#[cfg(unix)]
fn offset_s(since_1970: u64) -> f64 {
    let time = libc::time_t::try_from(since_1970).unwrap_or_default();
    // SAFETY: `tm` is plain data, for which zeros are valid.
    let mut local: libc::tm = unsafe { std::mem::zeroed() };
    // SAFETY: both pointers are valid for the call, which keeps neither. No thread changes the environment meanwhile.
    let is_known = !unsafe { libc::localtime_r(&raw const time, &raw mut local) }.is_null();
    if is_known { local.tm_gmtoff as f64 } else { 0.0 }
}

/// The offset is not known here, so that dates are those of UTC.
#[cfg(not(unix))]
fn offset_s(_: u64) -> f64 {
    0.0
}
