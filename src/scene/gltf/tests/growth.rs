//! Loading takes time in proportion to what is in the file, and placing a primitive costs next to nothing.

use std::time::{Duration, Instant};

use super::*;

/// How often two times are taken before one of them counts as too long. Other work on the machine can only add time, so
/// the shortest time of each is compared, and the first good comparison ends the test.
const TRIES: usize = 12;

/// Fails unless `long` takes less than `most` times as long as `short`.
#[track_caller]
fn assert_within(what: &str, most: u32, mut short: impl FnMut(), mut long: impl FnMut()) {
    let timed = |work: &mut dyn FnMut()| {
        let begin = Instant::now();
        work();
        begin.elapsed()
    };
    let (mut shortest, mut longest) = (Duration::MAX, Duration::MAX);
    for _ in 0..TRIES {
        shortest = shortest.min(timed(&mut short));
        longest = longest.min(timed(&mut long));
        if longest < shortest * most {
            return;
        }
    }
    panic!("{what}: {longest:?} is more than {most} times {shortest:?}");
}

fn open_many(bytes: &[u8], primitives: usize, instances: usize) {
    let model = load_bytes("many", bytes).unwrap();
    assert_eq!((model.primitives.len(), model.instances.len()), (primitives, instances));
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

#[test]
fn time_grows_with_nodes_and_primitives_and_no_faster() {
    // Eight times as much would take 64 times as long if time grew with the square.
    let (few, many) = (nodes(2_500), nodes(20_000));
    assert_within("nodes", 32, || open_many(&few, 1, 2_500), || open_many(&many, 1, 20_000));
    let (few, many) = (primitives(2_500), primitives(20_000));
    assert_within("primitives", 32, || open_many(&few, 2_500, 2_500), || open_many(&many, 20_000, 20_000));
}

#[test]
fn placing_a_primitive_costs_no_more_than_reading_its_node() {
    // Below and above the number of instances from which boxes stand for primitives.
    for count in [1_500, 6_000] {
        let bytes = nodes(count);
        let parse = || {
            let value: Value = serde_json::from_slice(&bytes[20..][..json_length(&bytes)]).unwrap();
            assert_eq!(value["nodes"].as_array().unwrap().len(), count);
        };
        assert_within("loading, by the time to parse the JSON", 25, parse, || open_many(&bytes, 1, count));
    }
}

fn json_length(glb: &[u8]) -> usize {
    u32::from_le_bytes(glb[12..16].try_into().unwrap()) as usize
}
