//! Answers commands once they are done. A command that changes the picture is answered when the picture is final
//! ([`is_settled`](crate::app::frames::progress::is_settled)), one that writes a file when the file is written.

mod answers;
mod captures;
mod files;
mod text;

pub(super) use answers::{answer, answer_found, answer_when, has_unanswered, take_shots, tell_when, wants_window};
pub(super) use captures::begin_capture;
pub(super) use files::{write_shot, write_window_shot};
pub(super) use text::{path_text, short};
