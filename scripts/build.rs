//! Makes cargo rebuild when a file in `shaders/` or `assets/`, which the program embeds, is added or changed.

fn main() {
    println!("cargo:rerun-if-changed=shaders");
    println!("cargo:rerun-if-changed=assets");
}
