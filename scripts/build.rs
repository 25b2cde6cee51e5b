//! Tells cargo that the program embeds `shaders/` and `assets/`, so that a new file there is a reason to build again.

fn main() {
    println!("cargo:rerun-if-changed=shaders");
    println!("cargo:rerun-if-changed=assets");
}
