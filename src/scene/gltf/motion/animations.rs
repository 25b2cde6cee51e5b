//! Reads animations. A channel that cannot be read costs that channel, with a warning, and not the model.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DQuat;
use gltf::json;
use json::accessor::{ComponentType as C, Type};
use serde::Deserialize;

use super::pointers::{self, Pointed};
use crate::scene::error::Problem;
use crate::scene::gltf::geometry::accessor::{Format, Normalized as N, Reader};
use crate::scene::gltf::left_out::{LeftOut, Part};
use crate::scene::gltf::place::{out_of_range, place};
use crate::scene::motion::{Channel, Clip, Curve, Interpolation, Rig, Target, Values};

const TIMES: Format = Format { types: &[Type::Scalar], components: &[(C::F32, N::No)] };
const VALUES: Format = Format {
    types: &[Type::Scalar, Type::Vec2, Type::Vec3, Type::Vec4],
    components: &[(C::F32, N::No), (C::I8, N::Either), (C::U8, N::Either), (C::I16, N::Either), (C::U16, N::Either)],
};

/// Most numbers in all curves of a file.
const MOST_NUMBERS: usize = 1 << 26;

#[derive(Deserialize)]
struct RawAnimation {
    name: Option<String>,
    #[serde(default)]
    channels: Vec<RawChannel>,
    #[serde(default)]
    samplers: Vec<RawSampler>,
}

#[derive(Deserialize)]
struct RawChannel {
    sampler: usize,
    target: RawTarget,
}

#[derive(Deserialize)]
struct RawTarget {
    node: Option<usize>,
    path: String,
    #[serde(default)]
    extensions: json::Value,
}

#[derive(Deserialize)]
struct RawSampler {
    input: usize,
    output: usize,
    interpolation: Option<String>,
}

/// Reads the clips, and the values of the file that they move.
pub fn read(
    (reader, scene): (Reader<'_>, usize),
    animations: &[json::Value],
    rig: &Rig,
    left_out: &mut LeftOut,
) -> (Vec<Clip>, Vec<Values>) {
    if animations.is_empty() {
        return Default::default();
    }
    let (nodes, times, curves, values) = (HashMap::new(), HashMap::new(), HashMap::new(), Vec::new());
    let mut clips = Clips { reader, scene, rig, nodes, times, curves, values, numbers: 0 };
    for (at, node) in rig.nodes.iter().enumerate() {
        clips.nodes.entry(node.index).or_default().push(at);
    }
    let read = |(index, value): (usize, &json::Value)| clips.read(index, value, left_out);
    let read = animations.iter().enumerate().map(read).collect();
    (read, clips.values)
}

struct Clips<'a> {
    reader: Reader<'a>,
    /// The scene that is shown.
    scene: usize,
    rig: &'a Rig,
    /// The nodes of the rig with an index in the file.
    nodes: HashMap<usize, Vec<usize>>,
    times: HashMap<usize, Arc<[f32]>>,
    /// By the accessors of times and values.
    curves: HashMap<(usize, usize, Interpolation), Arc<Curve>>,
    /// The properties that pointers name.
    values: Vec<Values>,
    /// Numbers that were read so far.
    numbers: usize,
}

impl Clips<'_> {
    fn read(&mut self, index: usize, value: &json::Value, left_out: &mut LeftOut) -> Clip {
        let name = value.get("name").and_then(json::Value::as_str);
        let place = place("animations", index, name);
        let animation: RawAnimation = match json::deserialize::from_value(value.clone()) {
            Ok(animation) => animation,
            Err(error) => {
                left_out.add(Part::CHANNEL, &place, Problem::invalid(&place, "an animation", error.to_string()));
                return Clip { name: name.unwrap_or_default().to_owned(), ..Clip::default() };
            }
        };
        let mut clip = Clip { name: animation.name.clone().unwrap_or_default(), ..Clip::default() };
        for (number, channel) in animation.channels.iter().enumerate() {
            let channels = self.channels(&animation, channel, &format!("{place}.channels[{number}]"));
            // The place is the animation's, so that equal faults of its channels are one warning.
            clip.channels.extend(left_out.unless(Part::CHANNEL, &place, channels).into_iter().flatten());
        }
        clip.duration_s = clip.channels.iter().map(|channel| channel.curve.end_s()).fold(0.0, f32::max);
        clip
    }

    /// The channels that a channel of the file becomes: one for each time that the scene shows its node.
    fn channels(
        &mut self,
        animation: &RawAnimation,
        channel: &RawChannel,
        place: &str,
    ) -> Result<Vec<Channel>, Problem> {
        let RawTarget { node, path, extensions } = &channel.target;
        let pointer = extensions.get(pointers::EXTENSION).and_then(|extension| extension.get("pointer")?.as_str());
        let sampler = (animation, channel.sampler);
        match (pointer.filter(|_| path == "pointer"), node) {
            (None, Some(node)) => self.nodes(sampler, (&[*node], path), place),
            // A channel without a node is for nobody (glTF 2.0, section 3.11).
            (None, None) => Ok(Vec::new()),
            (Some(pointer), _) => match pointers::resolve(pointer, (self.reader.root, self.scene), self.rig) {
                Some(Pointed::Nodes(nodes, path)) => self.nodes(sampler, (&nodes, &path), place),
                Some(Pointed::Visible(node)) => self.visible(sampler, node, place),
                Some(Pointed::Weight(nodes, target)) => self.weight(sampler, (&nodes, target), place),
                Some(Pointed::Values(values, first, width)) => {
                    let curve = self.curve(sampler, width, place)?;
                    if let Some(from) = values.iter().find_map(Values::rotation) {
                        turns_around_y(&curve, from, place)?;
                    }
                    let channel = |values| {
                        let target = Target::Values(self.index_of(values), first);
                        Channel { target, curve: curve.clone() }
                    };
                    Ok(values.into_iter().map(channel).collect())
                }
                Some(Pointed::Unused) => Ok(Vec::new()),
                None => {
                    let place = place.split_once(".channels").map_or(place, |(animation, _)| animation);
                    let expected = "a pointer to what Specula can move";
                    Err(Problem::invalid(place, expected, pointer.escape_debug().to_string()))
                }
            },
        }
    }

    /// The channels of a property of nodes of the file.
    fn nodes(
        &mut self,
        sampler: (&RawAnimation, usize),
        (nodes, path): (&[usize], &str),
        place: &str,
    ) -> Result<Vec<Channel>, Problem> {
        let mut channels = Vec::new();
        for at in self.shown(nodes, place)? {
            let weights = self.rig.nodes[at].weights.clone();
            let (target, width) = match path {
                "translation" => (Target::Translation(at), 3),
                "rotation" => (Target::Rotation(at), 4),
                "scale" => (Target::Scale(at), 3),
                "weights" => (Target::Weights(weights.start), weights.len()),
                other => {
                    let expected = "the path translation, rotation, scale or weights";
                    return Err(Problem::invalid(place, expected, other.escape_debug().to_string()));
                }
            };
            channels.push(Channel { target, curve: self.curve(sampler, width, place)? });
        }
        Ok(channels)
    }

    /// The channels of the visibility of a node of the file.
    fn visible(&mut self, sampler: (&RawAnimation, usize), node: usize, place: &str) -> Result<Vec<Channel>, Problem> {
        let nodes = self.shown(&[node], place)?;
        let curve = self.curve(sampler, 1, place)?;
        if curve.interpolation() != Interpolation::Step {
            let found = format!("{:?}", curve.interpolation()).to_uppercase();
            return Err(Problem::invalid(place, "the interpolation STEP, since a node is visible or not", found));
        }
        Ok(nodes.into_iter().map(|at| Channel { target: Target::Visible(at), curve: curve.clone() }).collect())
    }

    /// The channels of one morph weight of nodes of the file.
    fn weight(
        &mut self,
        sampler: (&RawAnimation, usize),
        (nodes, target): (&[usize], usize),
        place: &str,
    ) -> Result<Vec<Channel>, Problem> {
        let mut channels = Vec::new();
        for at in self.shown(nodes, place)? {
            let weights = self.rig.nodes[at].weights.clone();
            if target >= weights.len() {
                return Err(out_of_range(place, "weights", target, weights.len()));
            }
            let target = Target::Weights(weights.start + target);
            channels.push(Channel { target, curve: self.curve(sampler, 1, place)? });
        }
        Ok(channels)
    }

    /// The nodes of the rig that show these nodes of the file.
    fn shown(&self, nodes: &[usize], place: &str) -> Result<Vec<usize>, Problem> {
        let all = self.reader.root.nodes.len();
        if let Some(node) = nodes.iter().find(|node| **node >= all) {
            return Err(out_of_range(place, "nodes", *node, all));
        }
        Ok(nodes.iter().filter_map(|node| self.nodes.get(node)).flatten().copied().collect())
    }

    /// The index of values among those that pointers name.
    fn index_of(&mut self, values: Values) -> usize {
        let known = self.values.iter().position(|known| known.property == values.property);
        known.unwrap_or_else(|| {
            self.values.push(values);
            self.values.len() - 1
        })
    }

    /// The curve of a sampler, with values of `width` numbers.
    fn curve(
        &mut self,
        (animation, sampler): (&RawAnimation, usize),
        width: usize,
        place: &str,
    ) -> Result<Arc<Curve>, Problem> {
        let Some(sampler) = animation.samplers.get(sampler) else {
            return Err(out_of_range(place, "samplers", sampler, animation.samplers.len()));
        };
        let curve = self.sampled(sampler, place)?;
        if curve.width() == width {
            return Ok(curve);
        }
        Err(Problem::invalid(place, format!("values of {width} numbers"), curve.width().to_string()))
    }

    fn sampled(&mut self, sampler: &RawSampler, place: &str) -> Result<Arc<Curve>, Problem> {
        let interpolation = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(other) => {
                let found = other.escape_debug().to_string();
                return Err(Problem::invalid(place, "the interpolation LINEAR, STEP or CUBICSPLINE", found));
            }
        };
        let key = (sampler.input, sampler.output, interpolation);
        if let Some(known) = self.curves.get(&key) {
            return Ok(known.clone());
        }
        let times = match self.times.get(&sampler.input) {
            Some(known) => known.clone(),
            None => {
                let times: Arc<[f32]> = self.numbers(sampler.input, &TIMES, &format!("{place}, times"))?.into();
                self.times.insert(sampler.input, times.clone());
                times
            }
        };
        let values = self.numbers(sampler.output, &VALUES, &format!("{place}, values"))?;
        let found = format!("{} times and {} numbers", times.len(), values.len());
        let curve = Curve::new(times, values.into(), interpolation).map(Arc::new).ok_or_else(|| {
            Problem::invalid(place, "finite ascending times, and as many finite values as they need", found)
        })?;
        self.curves.insert(key, curve.clone());
        Ok(curve)
    }

    fn numbers(&mut self, accessor: usize, format: &Format, place: &str) -> Result<Vec<f32>, Problem> {
        let accessors = &self.reader.root.accessors;
        let elements = accessors.get(accessor).map_or(0, |accessor| accessor.count.0 as usize);
        self.numbers = self.numbers.saturating_add(elements.saturating_mul(4));
        if self.numbers > MOST_NUMBERS {
            return Err(Problem::invalid(place, format!("at most {MOST_NUMBERS} numbers in all animations"), "more"));
        }
        self.reader.numbers(json::Index::new(accessor as u32), format, place)
    }
}

/// Refuses rotations that are not `from` turned around +Y: frames turn the environment around that axis alone.
fn turns_around_y(curve: &Curve, from: DQuat, place: &str) -> Result<(), Problem> {
    let turns = curve.times().iter().filter_map(|time| Some(curve.rotation(f64::from(*time))? * from.inverse()));
    match turns.map(|turn| turn.x.hypot(turn.z)).find(|tilt| *tilt > 1e-3) {
        Some(tilt) => {
            let degrees = (2.0 * tilt.min(1.0).asin()).to_degrees();
            let expected = "rotations of the environment around +Y, from that of the file";
            Err(Problem::invalid(place, expected, format!("one that tilts it by {degrees:.0} degrees")))
        }
        None => Ok(()),
    }
}
