//! The BRDF and all that lights a model by it, against closed forms, sums and the specifications.

mod baked;
mod brdf;
mod edits;
mod environment;
mod ltc;
mod many;
mod matrix;
mod paths;
mod physics;
mod reference;
mod sampling;
mod seams;
mod shading;
mod sheen;
