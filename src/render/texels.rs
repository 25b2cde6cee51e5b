//! The texels of a material's textures at a pixel: found by a ray on the CPU, read back from the device.
//!
//! Changes by pre-rasterization stages to vertices and texture coordinates are ignored.

use std::sync::Arc;

use glam::Vec2;
use serde_json::{Value, json};

use super::Resources;
use crate::frame::FrameState;
use crate::gpu::{Buffer, Encoder, Frames, Gpu, GpuError, Image, ImageDesc, Memory, Use, vk};
use crate::scene::mips::encode_srgb;
use crate::scene::{Model, TexelForm, TextureSource, Wrap, pick, slot_name};
use crate::settings::linear_from_srgb;

/// Where a pixel reads a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelPlace {
    /// `interface::TEXTURE_*`.
    pub slot: usize,
    /// The texture on the device.
    pub source: TextureSource,
    /// The form of its texels on the device.
    pub form: TexelForm,
    /// Name of the image.
    pub name: String,
    /// Width and height of the image, pixels.
    pub size: [u32; 2],
    /// TEXCOORD set, 0 or 1.
    pub uv_set: u32,
    /// Coordinates of the mesh at the middle of the pixel.
    pub mesh_uv: [f32; 2],
    /// The same after KHR_texture_transform and wrapping, 0..1.
    pub uv: [f32; 2],
    /// The texel of level 0 that holds `uv`, from the upper left corner of the image.
    pub texel: [u32; 2],
}

/// A texel and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Texel {
    /// The place.
    pub place: TexelPlace,
    /// RGBA in the encoding of the image: 0..255, 0..65535 of RGBA16.
    pub stored: [u16; 4],
    /// RGBA as the shader reads it: colors of sRGB images are linear.
    pub linear: [f32; 4],
}

impl TexelPlace {
    /// The name of the slot, as `metallic roughness`.
    pub fn slot_name(&self) -> String {
        slot_name(self.slot)
    }
}

impl Texel {
    /// A texel of RGBA8.
    pub fn of_bytes(place: TexelPlace, stored: [u8; 4]) -> Self {
        let numbers = stored.map(|byte| f32::from(byte) / 255.0);
        let [r, g, b] = [numbers[0], numbers[1], numbers[2]]
            .map(|encoded| if place.source.is_srgb() { linear_from_srgb(encoded) } else { encoded });
        Self { place, stored: stored.map(u16::from), linear: [r, g, b, numbers[3]] }
    }

    /// A texel of another form, which the device has decoded.
    fn of_floats(place: TexelPlace, linear: [f32; 4]) -> Self {
        let mut texel = Self { place, stored: [0; 4], linear };
        let most = texel.most();
        let encode = |channel: usize| match texel.place.source.is_srgb() && channel < 3 {
            true => encode_srgb(linear[channel].max(0.0)),
            false => linear[channel],
        };
        texel.stored = std::array::from_fn(|channel| (encode(channel).clamp(0.0, 1.0) * most).round() as u16);
        texel
    }

    /// Its color with 8 bits a channel, in the encoding of the image.
    pub fn color(&self) -> [u8; 3] {
        let most = self.most();
        std::array::from_fn(|channel| (f32::from(self.stored[channel]) / most * 255.0).round() as u8)
    }

    /// The value of 1 in `stored`.
    fn most(&self) -> f32 {
        if self.place.form == TexelForm::Rgba16 { 65535.0 } else { 255.0 }
    }

    /// The texel in JSON.
    pub fn json(&self) -> Value {
        let TexelPlace { name, form, size, uv_set, mesh_uv, uv, texel, source, .. } = &self.place;
        json!({
            "texture": self.place.slot_name(),
            "image": name,
            "form": form.to_string(),
            "size": size,
            "uv_set": uv_set,
            "mesh_uv": mesh_uv,
            "uv": uv,
            "texel": texel,
            "stored": self.stored,
            "srgb": source.is_srgb(),
            "linear": self.linear,
        })
    }

    /// The texel on one line, without the slot.
    pub fn text(&self) -> String {
        let TexelPlace { name, size: [width, height], uv: [u, v], texel: [x, y], .. } = &self.place;
        let stored = self.stored.map(|number| format!("{number:>3}")).join(" ");
        let linear = self.linear.map(|number| format!("{number:.4}")).join(" ");
        format!("uv {u:.4} {v:.4}  texel {x} {y} of {width}x{height}  stored {stored}  linear {linear}  {name}")
    }
}

/// Where the nearest surface of the model under a pixel reads its textures. A surface that a mask or alpha makes invisible counts
/// too. Pre-rasterization stages that move vertices or coordinates are ignored.
pub fn texel_places(state: &FrameState, at: (u32, u32)) -> Vec<TexelPlace> {
    let Some(scene) = state.scene.as_ref().filter(|scene| scene.replacement().is_none()) else { return Vec::new() };
    let model = scene.model();
    let Some(hit) = pick(model, &state.camera, state.size, at, |instance| scene.sides(instance)) else {
        return Vec::new();
    };
    let Some(instance) = model.instances.get(hit.instance) else { return Vec::new() };
    let material = scene.material(scene.material_of(instance));
    let vertices = &model.primitives[instance.primitive].vertices;
    let mesh_uv = |set: u32| -> Vec2 {
        let of = |index: u32| {
            vertices.get(index as usize).map_or(Vec2::ZERO, |v| if set == 0 { v.uv0 } else { v.uv1 }.into())
        };
        hit.triangle.iter().zip(hit.weights).map(|(index, weight)| of(*index) * weight).sum()
    };
    let place = |slot: usize| {
        let used = material.textures[slot]?;
        let texture = model.textures.get(used.texture)?;
        let image = model.images.get(texture.image)?;
        let mesh_uv = mesh_uv(used.uv_set);
        let uv = used.uv_from_mesh.transform_point2(mesh_uv);
        let uv = [wrapped(uv.x, texture.sampler.wrap_u), wrapped(uv.y, texture.sampler.wrap_v)];
        let size = [image.width, image.height];
        let source = TextureSource::of(model, material, slot);
        Some(TexelPlace {
            slot,
            source,
            form: source.form(model),
            name: name_of(model, texture.image),
            size,
            uv_set: used.uv_set,
            mesh_uv: mesh_uv.into(),
            uv,
            texel: [0, 1].map(|axis| ((uv[axis] * size[axis] as f32) as u32).min(size[axis].saturating_sub(1))),
        })
    };
    (0..material.textures.len()).filter_map(place).collect()
}

fn name_of(model: &Model, image: usize) -> String {
    let name = &model.images[image].name;
    if name.is_empty() { format!("image {image}") } else { name.clone() }
}

/// A texture coordinate after wrapping, 0..1.
fn wrapped(coordinate: f32, wrap: Wrap) -> f32 {
    match wrap {
        Wrap::Repeat => coordinate - coordinate.floor(),
        Wrap::Mirror => 1.0 - (coordinate.rem_euclid(2.0) - 1.0).abs(),
        Wrap::Clamp => coordinate.clamp(0.0, 1.0),
    }
}

/// Recorded copies of texels: RGBA8 as it is, other forms as floats.
pub struct TexelReadback(Vec<(TexelPlace, Arc<Buffer>)>);

impl TexelReadback {
    /// Records the copies. A place whose texture is not on the device is left out.
    ///
    /// # Errors
    /// Out of memory.
    pub fn record(
        gpu: &Arc<Gpu>,
        encoder: &mut Encoder,
        resources: &Resources,
        places: Vec<TexelPlace>,
    ) -> Result<Self, GpuError> {
        let mut copies = Vec::new();
        for place in places {
            let Some(image) = resources.texture(&place.source) else { continue };
            let bytes = if place.form == TexelForm::Rgba8 { 4 } else { 16 };
            let buffer = Buffer::new(gpu, "texel", bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback)?;
            let [x, y] = place.texel;
            if x >= image.desc().width || y >= image.desc().height {
                continue;
            }
            encoder.transition(image, Use::Sampled, Use::CopyFrom);
            if place.form == TexelForm::Rgba8 {
                encoder.copy_pixel(image, (x, y), &buffer);
            } else {
                // The view that every image has needs one that shaders use.
                let usage = vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::TRANSFER_SRC
                    | vk::ImageUsageFlags::TRANSFER_DST;
                let one = Image::new(gpu, "texel", ImageDesc::new(1, 1, vk::Format::R32G32B32A32_SFLOAT, usage))?;
                encoder.transition(&one, Use::Undefined, Use::CopyTo);
                encoder.pick_texel(image, (x, y), &one);
                encoder.transition(&one, Use::CopyTo, Use::CopyFrom);
                encoder.copy_pixel(&one, (0, 0), &buffer);
            }
            encoder.transition(image, Use::CopyFrom, Use::Sampled);
            copies.push((place, buffer));
        }
        if !copies.is_empty() {
            encoder.copies_done();
        }
        Ok(Self(copies))
    }

    /// The texels. SYNC: after the fence of the submission.
    pub fn finish(self) -> Vec<Texel> {
        let texel = |(place, buffer): (TexelPlace, Arc<Buffer>)| {
            let bytes = buffer.read();
            match place.form {
                TexelForm::Rgba8 => Some(Texel::of_bytes(place, *bytes.first_chunk()?)),
                _ => {
                    let channels: &[[u8; 4]; 4] = bytes.as_chunks().0.first_chunk()?;
                    Some(Texel::of_floats(place, channels.map(f32::from_le_bytes)))
                }
            }
        };
        self.0.into_iter().filter_map(texel).collect()
    }
}

/// Reads the texels of these places on this thread.
///
/// # Errors
/// A device error.
pub fn read_texels(
    gpu: &Arc<Gpu>,
    resources: &Resources,
    frames: &mut Frames,
    places: Vec<TexelPlace>,
) -> Result<Vec<Texel>, GpuError> {
    if places.is_empty() {
        return Ok(Vec::new());
    }
    let mut encoder = frames.begin()?;
    let readback = TexelReadback::record(gpu, &mut encoder, resources, places)?;
    frames.submit(encoder, Default::default())?;
    // SYNC: the CPU reads the texels.
    frames.wait()?;
    Ok(readback.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_wrap_as_their_sampler_says() {
        for (coordinate, repeat, mirror, clamp) in
            [(0.25, 0.25, 0.25, 0.25), (1.25, 0.25, 0.75, 1.0), (-0.25, 0.75, 0.25, 0.0), (2.5, 0.5, 0.5, 1.0)]
        {
            let of = |wrap| wrapped(coordinate, wrap);
            assert_eq!([of(Wrap::Repeat), of(Wrap::Mirror), of(Wrap::Clamp)], [repeat, mirror, clamp], "{coordinate}");
        }
    }
}
