//! The committed `shaders/interface.glsl` is what Rust prints.

use specula::interface;

/// Run with `SPECULA_BLESS=1` to write the file anew after a change of `src/interface.rs`.
#[test]
fn interface_glsl_is_current() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/interface.glsl");
    if std::env::var_os("SPECULA_BLESS").is_some() {
        std::fs::write(path, interface::glsl()).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap();
    assert!(
        committed == interface::glsl(),
        "shaders/interface.glsl is stale; write it anew with: SPECULA_BLESS=1 cargo test --release --test suite interface"
    );
}
