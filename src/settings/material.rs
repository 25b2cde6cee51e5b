//! The material override.

use serde::de::{Deserializer, Error as _};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

use super::declare::settings;
use super::entry::When;
use super::list::names;
use super::part::SettingType;
use super::value::Value;
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

impl SettingType for MaterialChannels {
    const TAKES: &'static str = Vec::<String>::TAKES;

    fn value(&self) -> Value {
        Value::Names(self.names().map(str::to_owned).collect())
    }

    fn set(&mut self, value: &Value) {
        if let Value::Names(names) = value {
            *self = Self::default();
            let is_named = |channel: &MaterialChannel| names.iter().any(|name| name == channel.name());
            MaterialChannel::ALL.into_iter().filter(is_named).for_each(|channel| Self::set(self, channel, true));
        }
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

/// Whole materials are replaced, not only single channels.
const WHOLE: When = When::Is("material.enabled", "true");
const METALLIC: When = When::Any(&[WHOLE, When::Is("material.override", "metallic")]);
const ROUGHNESS: When = When::Any(&[WHOLE, When::Is("material.override", "roughness")]);
const ANISOTROPY: When = When::Any(&[WHOLE, When::Is("material.override", "anisotropy")]);

settings! {
    /// A material without textures that replaces all materials of the model while it is enabled, to inspect shapes and the
    /// BRDF itself; or single channels of all of them.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct MaterialOverride {
        /// Replace all materials of the model with this one, which has no textures and no extensions.
        enabled: bool, row("Whole") title("One material for all");
        /// Channels that are replaced in all materials, each with its texture: base_color, metallic, roughness, anisotropy.
        channels as "override": MaterialChannels;
        /// Reflectance of the diffuse lobe, or of a metal: 0.5 is half the light, which a picture stores as 188 of 255.
        base_color: [f32; 3] = [0.8; 3], limits(0.0, 1.0) unit(LINEAR_RGB) row("Base color");
        /// 0 is a dielectric, 1 a metal.
        metallic: f32 = 0.0, limits(0.0, 1.0) row("Metallic") slider(0.0, 1.0, 2) when(METALLIC);
        /// Perceptual roughness.
        roughness: f32 = 0.5, limits(0.0, 1.0) row("Roughness") slider(0.0, 1.0, 2) when(ROUGHNESS);
        /// Strength of the anisotropy: 0 is isotropic. It needs meshes with tangents or texture coordinates.
        anisotropy: f32 = 0.0, limits(0.0, 1.0) row("Anisotropy") slider(0.0, 1.0, 2) when(ANISOTROPY);
        /// Direction of the anisotropy: angle from the tangent towards the bitangent.
        anisotropy_rotation: f32 = 0.0, limits(-1e6, 1e6) unit(DEGREES) row("Direction") slider(-90.0, 90.0, 0)
            when(All(&[ANISOTROPY, Not("material.anisotropy", "0")]));
    }
}

impl MaterialOverride {
    /// Whether a channel of the model's materials is replaced.
    pub fn replaces(&self, channel: MaterialChannel) -> bool {
        self.enabled || self.channels.has(channel)
    }
}
