//! Splines of rotations, scales and weights, and samplers whose values are integers or sparse, against a reference in doubles.

use glam::{DMat3, DQuat, DVec3, DVec4, Mat3, Vec3};

use super::*;
use crate::scene::Places;
use crate::scene::motion::{Playing, Pose};

const TIMES: [f32; 3] = [0.25, 0.75, 2.0];

/// Gives the node 0 a clip that moves the property `path` by the values of an accessor.
fn play(builder: &mut Builder, path: &str, interpolation: &str, output: usize) -> Model {
    let input = builder.accessor("SCALAR", F32, TIMES.len(), bytemuck::cast_slice(&TIMES));
    builder.json["animations"] = json!([{
        "samplers": [{ "input": input, "output": output, "interpolation": interpolation }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }],
    }]);
    let model = builder.model();
    assert!(model.warnings.is_empty(), "{:?}", model.warnings);
    model
}

/// The pose at a time.
fn pose(model: &Model, time_s: f64) -> Pose {
    model.pose_at(&[Playing { clip: 0, weight: 1.0, time_s }], &Places::default())
}

/// Moments before, between, at and after the keys.
fn moments() -> impl Iterator<Item = f64> {
    (0..25).map(|tenth| f64::from(tenth) * 0.1)
}

/// The key before a moment, the part of the way to the next, and their distance.
fn segment(time_s: f64) -> (usize, f64, f64) {
    let key = usize::from(time_s >= 0.75);
    let length_s = f64::from(TIMES[key + 1] - TIMES[key]);
    (key, ((time_s - f64::from(TIMES[key])) / length_s).clamp(0.0, 1.0), length_s)
}

/// glTF 2.0, appendix C.5: `values` has the entering tangent, the value and the leaving tangent of each key, `width` numbers each.
fn spline(values: &[f32], width: usize, time_s: f64) -> Vec<f64> {
    let (key, t, length_s) = segment(time_s);
    let part = |part: usize, number: usize| f64::from(values[(3 * key + part) * width + number]);
    let (t2, t3) = (t * t, t * t * t);
    let number = |number| {
        part(1, number) * (2.0 * t3 - 3.0 * t2 + 1.0)
            + part(2, number) * length_s * (t3 - 2.0 * t2 + t)
            + part(4, number) * (3.0 * t2 - 2.0 * t3)
            + part(3, number) * length_s * (t3 - t2)
    };
    (0..width).map(number).collect()
}

/// Numbers between -1 and 1 that no symmetry relates.
fn numbers(count: usize) -> Vec<f32> {
    (0..count).map(|index| ((index * 37 + 11) % 41) as f32 / 20.0 - 1.0).collect()
}

/// A square with two morph targets.
fn morphed() -> Builder {
    let mut builder = Builder::square();
    let target = builder.accessor("VEC3", F32, 4, bytemuck::cast_slice(&[0.5_f32; 12]));
    builder.primitive()["targets"] = json!([{ "POSITION": target }, { "POSITION": target }]);
    builder
}

#[track_caller]
fn near(found: &[f64], expected: &[f64], what: impl std::fmt::Display) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-6, "{what}: {found:?}, expected {expected:?}");
    }
}

/// The linear part of the first instance's matrix.
fn linear(pose: &Pose) -> Vec<f64> {
    let columns = Mat3::from_mat4(pose.instances[0]).to_cols_array();
    columns.map(f64::from).to_vec()
}

#[test]
fn rotations_follow_splines() {
    let mut values = numbers(36);
    // The tangents are small against the rotations, as exporters write them.
    values.iter_mut().enumerate().for_each(|(at, value)| *value *= if at / 4 % 3 == 1 { 1.0 } else { 0.3 });
    let mut builder = Builder::triangle();
    let output = builder.accessor("VEC4", F32, 9, bytemuck::cast_slice(&values));
    let model = play(&mut builder, "rotation", "CUBICSPLINE", output);
    for time_s in moments() {
        let rotation = DQuat::from_vec4(DVec4::from_slice(&spline(&values, 4, time_s)).normalize());
        near(&linear(&pose(&model, time_s)), &DMat3::from_quat(rotation).to_cols_array(), time_s);
    }
}

#[test]
fn scales_follow_splines() {
    let values = numbers(27);
    let mut builder = Builder::triangle();
    let output = builder.accessor("VEC3", F32, 9, bytemuck::cast_slice(&values));
    let model = play(&mut builder, "scale", "CUBICSPLINE", output);
    for time_s in moments() {
        let scale = DVec3::from_slice(&spline(&values, 3, time_s));
        near(&linear(&pose(&model, time_s)), &DMat3::from_diagonal(scale).to_cols_array(), time_s);
    }
}

#[test]
fn weights_follow_splines() {
    let values = numbers(18);
    let mut builder = morphed();
    let output = builder.accessor("SCALAR", F32, 18, bytemuck::cast_slice(&values));
    let model = play(&mut builder, "weights", "CUBICSPLINE", output);
    for time_s in moments() {
        let found: Vec<f64> = pose(&model, time_s).weights.iter().map(|weight| f64::from(*weight)).collect();
        near(&found, &spline(&values, 2, time_s), time_s);
    }
}

/// Six integers of a component type, and the largest of it. Of signed ones, the two lowest are both -1.
fn integers(component: u32) -> ([f64; 6], f64) {
    match component {
        I8 => ([-128.0, -127.0, -60.0, 0.0, 101.0, 127.0], 127.0),
        U8 => ([255.0, 0.0, 1.0, 254.0, 128.0, 51.0], 255.0),
        I16 => ([-32768.0, -32767.0, 9.0, 0.0, 32767.0, -123.0], 32767.0),
        _ => ([65535.0, 0.0, 1.0, 65534.0, 32768.0, 257.0], 65535.0),
    }
}

#[test]
fn weights_and_rotations_may_be_normalized_integers() {
    for component in [I8, U8, I16, U16] {
        let (values, largest) = integers(component);
        let bytes: Vec<u8> = values.iter().flat_map(|value| encode(component, *value)).collect();
        let real = values.map(|value| (value / largest).max(-1.0));
        let mut builder = morphed();
        let output = builder.accessor("SCALAR", component, 6, &bytes);
        builder.json["accessors"][output]["normalized"] = json!(true);
        let model = play(&mut builder, "weights", "LINEAR", output);
        for time_s in moments() {
            let (key, t, _) = segment(time_s);
            let expected = [0, 1].map(|target| real[2 * key + target] * (1.0 - t) + real[2 * key + 2 + target] * t);
            let found: Vec<f64> = pose(&model, time_s).weights.iter().map(|weight| f64::from(*weight)).collect();
            near(&found, &expected, format!("{component} at {time_s}"));
        }
        // Rotations around Z, one number each and the other the rest to a unit quaternion as the type can hold it.
        let turns =
            [0.0_f64, 0.5, 1.0].map(|angle| [0.0, 0.0, angle.sin(), angle.cos()].map(|x| (x * largest).round()));
        let bytes: Vec<u8> = turns.as_flattened().iter().flat_map(|x| encode(component, *x)).collect();
        let mut builder = Builder::triangle();
        let output = builder.accessor("VEC4", component, 3, &bytes);
        builder.json["accessors"][output]["normalized"] = json!(true);
        let model = play(&mut builder, "rotation", "STEP", output);
        for time_s in moments() {
            let (key, t, _) = segment(time_s);
            let at = if t < 1.0 { key } else { key + 1 };
            let rotation = DQuat::from_vec4(DVec4::from_array(turns[at]).normalize());
            let expected = DMat3::from_quat(rotation).to_cols_array();
            near(&linear(&pose(&model, time_s)), &expected, format!("{component} at {time_s}"));
        }
    }
}

/// The bytes of a whole number in a component type.
fn encode(component: u32, value: f64) -> Vec<u8> {
    match component {
        I8 => (value as i8).to_le_bytes().into(),
        U8 => (value as u8).to_le_bytes().into(),
        I16 => (value as i16).to_le_bytes().into(),
        _ => (value as u16).to_le_bytes().into(),
    }
}

#[test]
fn values_may_be_sparse_with_and_without_a_view() {
    let base = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
    let middle = [-1.0_f32, 0.5, 0.25];
    for has_view in [true, false] {
        let mut builder = Builder::triangle();
        let indices = builder.view(&[1]);
        let values = builder.view(bytemuck::cast_slice(&middle));
        let output = match has_view {
            true => builder.accessor("VEC3", F32, 3, bytemuck::cast_slice(&base)),
            false => builder.push("accessors", json!({ "componentType": F32, "type": "VEC3", "count": 3 })),
        };
        builder.json["accessors"][output]["sparse"] = json!({
            "count": 1,
            "indices": { "bufferView": indices, "componentType": U8 },
            "values": { "bufferView": values },
        });
        let model = play(&mut builder, "translation", "LINEAR", output);
        let rest = if has_view { base } else { [0.0; 9] };
        let keys = [&rest[..3], &middle, &rest[6..]].map(|key| Vec3::from_slice(key).as_dvec3());
        for time_s in moments() {
            let (key, t, _) = segment(time_s);
            let expected = keys[key] * (1.0 - t) + keys[key + 1] * t;
            let found = pose(&model, time_s).instances[0].w_axis.truncate().as_dvec3();
            near(&found.to_array(), &expected.to_array(), format!("{has_view} at {time_s}"));
        }
    }
}
