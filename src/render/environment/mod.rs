//! Image-based light: environments baked on the device.
//!
//! ```text
//! name or file -> bytes and their hash -> decoded -> cube map -> mip levels -> irradiance
//!   -> samples of the specular lobe -> specular levels;  sheen levels          each part is looked up on disk first
//! ```
//!
//! | stage in `ibl/` | makes | size |
//! |---|---|---|
//! | `cube.comp`, `downsample.comp` | radiance from every direction | 512 x 512 x 6, all levels |
//! | `irradiance.comp` | what a white surface returns, summed over the cube's level 5; an octahedral map | 68 x 68 |
//! | `lobe.comp` | directions and weights for the levels below, from D and V | up to 400 for each two levels |
//! | `prefilter.comp` | radiance filtered by the specular lobe: 17 levels of roughness, octahedral maps side by side in one image (`maps/levels.glsl`); two levels share their samples | 640 x 640 (the mirror), 320 x 320 to 43 x 43 |
//! | `prefilter_sheen.comp` | the same for sheen | 32 x 32 x 6, all levels |
//! | `dfg.comp` | moments of the specular lobe by sqrt(NoV) and roughness, their means, and what D is (`brdf/energy/dfg.glsl`) | 128 x 128, 5 slices |
//! | `diffuse_albedo.comp` | the albedo of the diffuse lobe | 64 x 64, 2 slices |
//! | `sheen_albedo.comp` | the albedo of sheen | 64 x 64 |
//!
//! An environment has three parts: cube and irradiance, specular levels, sheen levels. The BRDF lookup tables
//! (`render/brdf/tables.rs`) are a resource of their own. Each part has a key (`frame/baked.rs`): its stages with the
//! author's constants, as the module that the driver gets, and the values of the parameters that the module reads. So
//! an edit of D, or a step of a slider in it, bakes the specular levels and one table, from the cube map that is there;
//! an edit of the diffuse model bakes only a table; an edit of a comment or of a punctual light bakes nothing. While
//! the baker works, an edit or a step of a slider shows with the previous light, and the status bar says "baking
//! light"; a new choice of models or another map waits for its light. A bake is canceled when a newer one is requested,
//! except by the next step of the same slider: while it is dragged, each bake ends and shows. A part whose stages read
//! parameters is not cached on disk. Images are half floats: a map with a brighter sun is scaled down, and
//! `Frame::environment_intensity` scales back.
//!
//! Irradiance and prefiltered mips, which every pixel reads, are in octahedral maps (`ibl/maps/octahedral.glsl`) instead
//! of cube maps, with three mantissas and one exponent in 32 bits a texel (`ibl/maps/shared_exponent.glsl`): lavapipe
//! reads that in two thirds of the time. A shader cannot write this format, so it writes words to a buffer, which the
//! device copies to the image; the CPU reads them back only for the cache. A tile has a border of one texel, which
//! holds what lies beyond its edges. While a map is decoded on a thread of its own (rows of an HDR file in parallel),
//! the baker creates the pipelines of the parts that are not in the cache.
//!
//! **Suns and small lights.** Sources that are smaller than any lobe are taken out of the mip levels and listed
//! (`ibl/small_lights/list.glsl`); the bake adds them exactly. The suns among them (`find.glsl` says what a sun is) are
//! left out of irradiance, specular levels and sheen: lighting adds them as directional lights with the D and V of the
//! material's roughness. The bake leaves their list in `Radiance::suns`. The setting `environment.suns` is part of the
//! key of a bake, and no bake stands in for one with the other value: pipelines for fewer suns would miss some. How
//! many suns a map has is known once it is baked (`Revisions::suns`). Pipelines are specialized for their number
//! (`SUN_COUNT`), so that a map without suns costs nothing and the loop over suns is unrolled. `Resources` binds no
//! frame to a map with more suns: the last frame stays while its pipelines are built. The built-in `sky` has the code
//! from the start.
//!
//! Values that are not valid densities (NaN, infinite, negative, huge) count as 0 in a bake, a warning names their
//! function, and nothing is cached.
//!
//! Limits: a map has at most four suns, and a list of 192 texels of small lights, so several sources that each cover a
//! hundred texels are not cut out whole. The disk of a sun widens its lobe by its variance; below a roughness of 0.1
//! the highlight is off by up to 7 %. Prefiltered levels are interpolated between the roughness values that they hold,
//! by about a geometric mean: off by up to 3 % where a small light is narrower than the lobe. Texels are wider than the
//! smoothest lobes, so a small source that is no sun has too flat a highlight below a roughness of 0.2. Octahedral maps
//! stretch texels along the diagonals of their octants, by up to 1.7, which shows in the mirror image of a sun.

pub(super) mod bake;
pub(super) mod maps;
mod passes;
mod transfer;
