//! What a tree adds to a picture: declared passes, their images and textures, single files of other playgrounds, examples.

mod declared;
mod examples;
mod kept;
mod keys;
mod model;
mod textures;
mod toys;
mod web;
