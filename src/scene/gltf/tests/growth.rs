//! Loading takes time in proportion to what is in the file, and placing a primitive costs next to nothing.

use std::time::{Duration, Instant};

use super::*;

/// The shortest of a few loads: other work on this machine can only add time.
fn load_time(bytes: &[u8], primitives: usize, instances: usize) -> Duration {
    let load = || {
        let begin = Instant::now();
        let model = load_bytes("many", bytes).unwrap();
        assert_eq!((model.primitives.len(), model.instances.len()), (primitives, instances));
        begin.elapsed()
    };
    (0..3).map(|_| load()).min().unwrap()
}

/// A triangle that many nodes place side by side.
fn nodes(count: usize) -> Vec<u8> {
    let mut builder = Builder::triangle();
    let node = |x: usize| json!({ "mesh": 0, "name": format!("node {x}"), "translation": [x, 0, 0] });
    builder.json["nodes"] = (0..count).map(node).collect::<Vec<_>>().into();
    builder.json["scenes"][0]["nodes"] = (0..count).collect::<Vec<_>>().into();
    builder.glb()
}

/// A mesh of many primitives.
fn primitives(count: usize) -> Vec<u8> {
    let mut builder = Builder::triangle();
    let primitive = builder.primitive().clone();
    builder.json["meshes"][0]["primitives"] = vec![primitive; count].into();
    builder.glb()
}

/// 1 where time grows as size does; sorting or hashing may add a little, and noise a little more.
fn assert_linear(what: &str, small: Duration, large: Duration, times: u32) {
    assert!(large < small * times * 3, "{what}: {times} times as many take {large:?} after {small:?}");
}

#[test]
fn time_grows_with_nodes_and_primitives_and_no_faster() {
    let small = load_time(&nodes(2_500), 1, 2_500);
    assert_linear("nodes", small, load_time(&nodes(10_000), 1, 10_000), 4);
    let small = load_time(&primitives(2_500), 2_500, 2_500);
    assert_linear("primitives", small, load_time(&primitives(10_000), 10_000, 10_000), 4);
}

#[test]
fn placing_a_primitive_costs_no_more_than_reading_its_node() {
    // Below and above the number of instances from which boxes stand for primitives.
    for count in [1_500, 6_000] {
        let bytes = nodes(count);
        let read = || {
            let begin = Instant::now();
            let value: Value = serde_json::from_slice(&bytes[20..][..json_length(&bytes)]).unwrap();
            assert_eq!(value["nodes"].as_array().unwrap().len(), count);
            begin.elapsed()
        };
        let read = (0..3).map(|_| read()).min().unwrap();
        let load = load_time(&bytes, 1, count);
        assert!(load < read * 25, "{count} nodes: {load:?} to load, {read:?} to parse their JSON");
    }
}

fn json_length(glb: &[u8]) -> usize {
    u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize
}
