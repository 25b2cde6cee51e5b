//! Which clips play, by the settings.

use crate::message::did_you_mean;
use crate::scene::model::Model;
use crate::scene::motion::Playing;
use crate::settings::AnimationSettings;

/// All clips.
const ALL: &str = "all";
/// No clip: the model as it is in the file.
const NONE: &str = "none";

impl Model {
    /// The clips that play when the clock is at `clock_s` seconds. Names that the model does not have are left out: see
    /// [`Model::unknown_clip`].
    pub fn playing(&self, settings: &AnimationSettings, clock_s: f32) -> Vec<Playing> {
        let clips = &self.motion.clips;
        let chosen: Vec<(usize, f32)> = match settings.clips.as_slice() {
            [] => self.first_clips().map(|clip| (clip, 1.0)).collect(),
            names => names.iter().flat_map(|name| self.chosen(name).unwrap_or_default()).collect(),
        };
        let passed_s = f64::from(settings.time) + f64::from(settings.speed) * f64::from(clock_s);
        let playing = |(clip, weight): (usize, f32)| {
            let duration_s = f64::from(clips[clip].duration_s);
            let time_s = match settings.looped && duration_s > 0.0 {
                true => passed_s.rem_euclid(duration_s),
                false => passed_s.clamp(0.0, duration_s),
            };
            Playing { clip, weight, time_s }
        };
        chosen.into_iter().map(playing).collect()
    }

    /// The first clip, of each model if several are shown together.
    fn first_clips(&self) -> impl Iterator<Item = usize> {
        let single = self.members.is_empty() && !self.motion.clips.is_empty();
        let of_members = self.members.iter().filter_map(|member| member.clips.clone().next());
        single.then_some(0).into_iter().chain(of_members)
    }

    /// Whether the pose that these clips give depends on the clock.
    pub fn is_animated(&self, settings: &AnimationSettings, playing: &[Playing]) -> bool {
        let moves = |playing: &Playing| playing.weight > 0.0 && self.motion.clips[playing.clip].duration_s > 0.0;
        settings.speed != 0.0 && playing.iter().any(moves)
    }

    /// Whether the pose that these clips give changes as the clock goes on.
    pub fn is_playing(&self, settings: &AnimationSettings, playing: &[Playing]) -> bool {
        let ends = |playing: &&Playing| {
            let end_s = if settings.speed > 0.0 { self.motion.clips[playing.clip].duration_s } else { 0.0 };
            !settings.looped && playing.time_s == f64::from(end_s)
        };
        let left: Vec<Playing> = playing.iter().filter(|playing| !ends(playing)).copied().collect();
        self.is_animated(settings, &left)
    }

    /// The name by which settings refer to a clip: its own if it is the first of that name, or its number.
    pub fn clip_key(&self, index: usize) -> String {
        let name = self.motion.clips.get(index).map_or("", |clip| clip.name.as_str());
        if self.clips(name) == Some(vec![index]) { name.to_owned() } else { index.to_string() }
    }

    /// A sentence about a name in `settings` that is of no clip.
    pub fn unknown_clip(&self, settings: &AnimationSettings) -> Option<String> {
        let name = settings.clips.iter().find(|name| self.chosen(name).is_none())?;
        let names = || self.motion.clips.iter().map(|clip| clip.name.as_str()).filter(|name| !name.is_empty());
        let hint = did_you_mean(name, names());
        let known = match (self.motion.clips.len(), names().collect::<Vec<_>>().join(", ")) {
            (0, _) => "it has none".to_owned(),
            (1, known) if known.is_empty() => "it has one without a name, 0".to_owned(),
            (count, known) if known.is_empty() => format!("it has {count} without names, 0 to {}", count - 1),
            (_, known) => format!("it has {known}"),
        };
        Some(format!("the model has no animation '{name}': {known}.{hint}"))
    }

    /// The clips that a name of the settings stands for, with their weight; `None` for one of no clip.
    fn chosen(&self, name: &str) -> Option<Vec<(usize, f32)>> {
        let weight = |text: &str| text.parse::<f32>().ok().filter(|weight| (0.0..=1.0).contains(weight));
        let weighted = || name.rsplit_once(':').and_then(|(name, text)| Some((self.clips(name)?, weight(text)?)));
        let (clips, weight) = self.clips(name).map(|clips| (clips, 1.0)).or_else(weighted)?;
        Some(clips.into_iter().map(|clip| (clip, weight)).collect())
    }

    fn clips(&self, name: &str) -> Option<Vec<usize>> {
        let clips = &self.motion.clips;
        if let Some(clip) = clips.iter().position(|clip| !name.is_empty() && clip.name == name) {
            return Some(vec![clip]);
        }
        match name {
            ALL => Some((0..clips.len()).collect()),
            NONE => Some(Vec::new()),
            _ => {
                let number = name.strip_prefix('#').unwrap_or(name).parse::<usize>().ok();
                number.filter(|number| *number < clips.len()).map(|number| vec![number])
            }
        }
    }
}
