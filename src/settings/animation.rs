//! The animations of the model that play, and how.

use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::list::names;

settings! {
    /// The clips of the model that play, and their time. They follow the clock that animated shaders read.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct AnimationSettings {
        /// Clips of the model that play: names, or numbers from 0; all, or none. Each replaces the pose that those before it give, and
        /// NAME:0.5 half of it. Empty: the first clip.
        #[serde(deserialize_with = "names")]
        clips: Vec<String>, row("Clips") title("Animations");
        /// Weights of morph targets in place of those of the file and its clips: NAME:0.5 for each, where NAME is that of the target, or its
        /// number in its mesh, from 0. Targets of equal name move together.
        #[serde(deserialize_with = "names")]
        weights: Vec<String>, row("Morph weights");
        /// Time in the clips when the clock is at 0.
        time: f32, limits(-1e6, 1e6) unit(SECONDS) row("Start") title("Start of the animation") slider(0.0, 10.0, 2);
        /// Speed of the clips; below 0 they play backwards.
        speed: f32 = 1.0, limits(-100.0, 100.0) unit(FACTOR) row("Speed") title("Speed of the animation") slider(-2.0, 2.0, 2);
        /// Clips begin again at their end. Otherwise they stay there.
        looped as "loop": bool = true, row("Loop") title("Loop the animation");
    }
}
