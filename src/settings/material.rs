//! The material override.

use serde::de::{Deserializer, Error as _};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use super::Range;
use super::list::names;
use crate::message::did_you_mean;

/// A channel of the material override.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MaterialChannel {
    /// Base color, without its texture and vertex colors.
    BaseColor,
    /// Metallic, without its texture.
    Metallic,
    /// Roughness, without its texture.
    Roughness,
    /// Strength and direction of the anisotropy, without its texture.
    Anisotropy,
}

impl MaterialChannel {
    /// All of them, in the order of their rows.
    pub const ALL: [Self; 4] = [Self::BaseColor, Self::Metallic, Self::Roughness, Self::Anisotropy];

    /// Its name in settings.
    pub fn name(self) -> &'static str {
        match self {
            Self::BaseColor => "base_color",
            Self::Metallic => "metallic",
            Self::Roughness => "roughness",
            Self::Anisotropy => "anisotropy",
        }
    }
}

/// A set of channels; a list of names in files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaterialChannels(u8);

impl MaterialChannels {
    /// Whether the set has this channel.
    pub fn has(self, channel: MaterialChannel) -> bool {
        self.0 & (1 << channel as u8) != 0
    }

    /// Adds or removes a channel.
    pub fn set(&mut self, channel: MaterialChannel, on: bool) {
        let bit = 1 << channel as u8;
        self.0 = if on { self.0 | bit } else { self.0 & !bit };
    }

    /// Whether the set has no channel.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The names of its channels.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        MaterialChannel::ALL.into_iter().filter(move |channel| self.has(*channel)).map(MaterialChannel::name)
    }
}

impl Serialize for MaterialChannels {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.names())
    }
}

impl<'de> Deserialize<'de> for MaterialChannels {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut channels = Self::default();
        for name in names(deserializer)? {
            let found = MaterialChannel::ALL.into_iter().find(|channel| channel.name() == name);
            let channel = found.ok_or_else(|| {
                let known = MaterialChannel::ALL.map(MaterialChannel::name);
                let hint = did_you_mean(&name, known);
                D::Error::custom(format!("unknown channel `{name}`.{hint} It can be {}", known.join(", ")))
            })?;
            channels.set(channel, true);
        }
        Ok(channels)
    }
}

/// A material without textures that replaces all materials of the model while it is enabled, to inspect shapes and the
/// BRDF itself; or single channels of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialOverride {
    /// Whether it replaces the model's materials.
    pub enabled: bool,
    /// The channels that it replaces while it is not enabled. All else stays as the model's materials have it.
    #[serde(rename = "override")]
    pub channels: MaterialChannels,
    /// Linear RGB.
    pub base_color: [f32; 3],
    /// 0 dielectric .. 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0..1.
    pub roughness: f32,
    /// Anisotropy strength, 0..1. Needs meshes with tangents or texture coordinates.
    pub anisotropy: f32,
    /// Degrees from the tangent towards the bitangent.
    pub anisotropy_rotation: f32,
}

impl Default for MaterialOverride {
    fn default() -> Self {
        Self {
            enabled: false,
            channels: MaterialChannels::default(),
            base_color: [0.8; 3],
            metallic: 0.0,
            roughness: 0.5,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
        }
    }
}

impl MaterialOverride {
    /// Whether a channel of the model's materials is replaced.
    pub fn replaces(&self, channel: MaterialChannel) -> bool {
        self.enabled || self.channels.has(channel)
    }

    /// All numbers with their paths and limits.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = Range::all("material.base_color", &self.base_color, 0.0..=1.0);
        ranges.extend([
            Range::new("material.metallic", self.metallic, 0.0..=1.0),
            Range::new("material.roughness", self.roughness, 0.0..=1.0),
            Range::new("material.anisotropy", self.anisotropy, 0.0..=1.0),
            Range::new("material.anisotropy_rotation", self.anisotropy_rotation, -1e6..=1e6),
        ]);
        ranges
    }
}
