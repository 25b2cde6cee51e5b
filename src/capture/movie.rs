//! The frames of a sequence as a video or an animation.

use std::path::Path;

use super::{Animation, CaptureError, Tell, image_of, tell};
use crate::headless::{Headless, Sequence};

/// Writes every frame of a sequence. Passes keep their images from one frame to the next, and random paths begin anew in each.
///
/// # Errors
/// A picture that cannot be drawn, a file that cannot be written.
pub fn write_movie(
    headless: &mut Headless,
    sequence: Sequence,
    path: &Path,
    progress: Tell<'_>,
) -> Result<(), CaptureError> {
    let all = sequence.frames as usize;
    let mut animation = Animation::new(path, sequence.fps, all)?;
    let begins_anew = headless.paths_per_pixel()?.is_some();
    for index in 0..sequence.frames {
        tell(progress, index as usize, all)?;
        let capture = if index == 0 || begins_anew {
            let start_s = sequence.start_s + index as f32 / sequence.fps;
            headless.set_sequence(Sequence { frames: 1, start_s, ..sequence });
            headless.render()?
        } else {
            headless.render_next()?
        };
        animation.add(image_of(capture)?)?;
    }
    headless.set_sequence(sequence);
    tell(progress, all, all)?;
    animation.finish()
}
