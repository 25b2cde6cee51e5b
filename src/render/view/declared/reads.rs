//! Finds the resources that a stage reads by name.

use std::sync::Arc;

use super::{DeclaredPasses, PassContext};
use crate::gpu::{GpuError, Image, PassLayout, PassResource};
use crate::shader::graph::{Input, Inputs};

/// The inputs of a stage, and their sources.
pub(super) struct Reads<'a> {
    /// Name of the pass, or path of the stage.
    pub(super) name: &'a str,
    pub(super) inputs: &'a Inputs,
    pub(super) images: &'a FrameImages<'a>,
    /// The place of the pass in `PipelineRequest::passes`.
    pub(super) index: Option<usize>,
}

/// The images that a stage reads besides those of passes.
#[derive(Default)]
pub(in crate::render::view) struct FrameImages<'a> {
    /// The HDR target so far.
    pub(in crate::render::view) picture: Option<&'a Arc<Image>>,
    /// Its samples, before they are resolved.
    pub(in crate::render::view) samples: Option<&'a Arc<Image>>,
    /// The depth of the last layer of blended surfaces.
    pub(in crate::render::view) peeled: Option<&'a Arc<Image>>,
    /// The opaque scene color, with mip levels.
    pub(in crate::render::view) opaque_scene: Option<&'a Arc<Image>>,
    /// The model's depth.
    pub(in crate::render::view) depth: Option<&'a Arc<Image>>,
    /// The image that a compute pass writes.
    pub(in crate::render::view) target: Option<&'a Arc<Image>>,
}

impl DeclaredPasses {
    /// The resources of a layout, in the order of its bindings.
    pub(super) fn resources<'a>(
        &'a self,
        layout: &PassLayout,
        context: &'a PassContext<'_>,
        reads: &'a Reads<'_>,
    ) -> Result<Vec<PassResource<'a>>, GpuError> {
        let textures = context.frame.pipelines.textures();
        let images = reads.images;
        // The graph has a buffer and a block for each of these inputs.
        let missing = || GpuError::NoStage(reads.name.to_owned());
        let resource = |binding: u32| {
            Ok(match reads.inputs.get(&binding).ok_or_else(missing)? {
                Input::Picture => self.sampled(images.picture.unwrap_or(&self.blank)),
                Input::Samples => PassResource::Texture(images.samples.ok_or_else(missing)?, &self.nearest),
                Input::Peeled => PassResource::Texture(images.peeled.ok_or_else(missing)?, &self.nearest),
                Input::OpaqueScene => PassResource::Texture(images.opaque_scene.unwrap_or(&self.blank), &self.linear),
                Input::Depth => PassResource::Texture(images.depth.unwrap_or(&self.blank), &self.nearest),
                Input::Image(name) => self.sampled(self.images.current(name).unwrap_or(&self.blank)),
                Input::Before(name) => self.sampled(self.images.before(name).unwrap_or(&self.blank)),
                Input::Texture(name, kind) => {
                    let (image, sampler) = textures.get(name, *kind).unwrap_or((&self.blanks[kind], &self.linear));
                    PassResource::Texture(image, sampler)
                }
                Input::Output => PassResource::Storage(images.target.ok_or_else(missing)?),
                Input::Buffer(name, ..) => PassResource::Buffer(self.images.buffer(name).ok_or_else(missing)?),
                Input::Parameters(..) | Input::Pass(..) => {
                    let block = reads.index.and_then(|index| context.blocks.get(index, binding));
                    PassResource::Buffer(block.ok_or_else(missing)?)
                }
            })
        };
        layout.bindings().map(resource).collect()
    }

    /// An image as passes read it: filtered, if the device can filter its format.
    fn sampled<'a>(&'a self, image: &'a Arc<Image>) -> PassResource<'a> {
        let blends = self.gpu.blends_texels(image.desc().format);
        PassResource::Texture(image, if blends { &self.linear } else { &self.nearest })
    }
}
