//! Several models side by side.

use glam::{Mat4, Vec3};

use super::*;
use crate::frame::Scene;
use crate::interface::Vertex;
use crate::scene::built_in;
use crate::scene::model::Instance;
use crate::scene::together::side_by_side;
use crate::settings::{AddedModel, ModelSettings, SceneSettings, Settings};

fn of(name: &str) -> Model {
    built_in(name).unwrap().unwrap()
}

fn together(models: &[Model]) -> Model {
    let named = |(index, model): (usize, &Model)| {
        (if index == 0 { String::new() } else { format!("{index}.glb") }, model.clone())
    };
    let all = side_by_side(models.iter().enumerate().map(named).collect());
    assert_sound(&all);
    all
}

/// Settings with these places of the models beside the first.
fn settings(places: &[ModelSettings]) -> Settings {
    let added =
        |(index, place): (usize, &ModelSettings)| AddedModel { file: format!("{}.glb", index + 1), place: *place };
    Settings { added: places.iter().enumerate().map(added).collect(), ..Settings::default() }
}

/// World positions of all vertices of the instances of a member.
fn positions(model: &Model, instances: &[Instance]) -> Vec<Vec3> {
    let place = |instance: &Instance| {
        let world = instance.world_from_object;
        let point = move |vertex: &Vertex| world.transform_point3(vertex.position.into());
        model.vertices(instance).iter().map(point).collect::<Vec<_>>()
    };
    instances.iter().flat_map(place).collect()
}

#[track_caller]
fn same(found: &[Vec3], expected: impl Iterator<Item = Vec3>) {
    let expected: Vec<Vec3> = expected.collect();
    assert_eq!(found.len(), expected.len());
    let far = found.iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(far < 1e-4, "{far} m");
}

#[test]
fn models_stand_in_a_row_with_all_that_is_theirs() {
    let models = ["shader-ball", "many-lights", "variants"].map(of);
    let all = together(&models);
    assert_eq!(&*all.name, "shader-ball + many-lights + variants");
    let (mut first, mut end, mut material) = (0, f32::NEG_INFINITY, 0);
    for (model, member) in models.iter().zip(all.members.iter()) {
        let instances = &all.instances[first..first + model.instances.len()];
        let origin = member.origin.as_vec3();
        same(&positions(&all, instances), positions(model, &model.instances).into_iter().map(|point| point + origin));
        assert!(model.bounds.min.x + origin.x > end, "{} stands in another", member.name);
        end = model.bounds.max.x + origin.x;
        for (instance, own) in instances.iter().zip(&model.instances) {
            let (merged, own) = (&all.primitives[instance.primitive], &model.primitives[own.primitive]);
            let names = |model: &Model, index: usize| model.materials[index].name.clone();
            assert_eq!(names(&all, merged.material), names(model, own.material));
            for variant in 0..model.variants.len() {
                let in_all = all.variants.iter().position(|name| *name == model.variants[variant]);
                assert_eq!(names(&all, merged.material_in(in_all)), names(model, own.material_in(Some(variant))));
            }
        }
        for (index, own) in model.materials.iter().enumerate().skip(1) {
            let merged = &all.materials[index + material];
            for (used, own) in merged.textures.iter().zip(&own.textures) {
                let image = |model: &Model, texture: usize| model.images[model.textures[texture].image].name.clone();
                assert_eq!(used.map(|used| image(&all, used.texture)), own.map(|used| image(model, used.texture)));
            }
        }
        (first, material) = (first + model.instances.len(), material + model.materials.len() - 1);
    }
    assert_eq!(all.lights.len(), models.iter().map(|model| model.lights.len()).sum::<usize>());
    assert_eq!(all.bounds.max.x, end);
    // The parts of the first model keep their names in settings.
    let keys = all.node_keys();
    assert_eq!(keys[1..=models[0].nodes.len()], models[0].node_keys());
    let hidden =
        all.visible(&SceneSettings { hidden: vec!["many-lights".into()], ..SceneSettings::default() }).unwrap();
    let count = models[1].instances.len();
    assert_eq!(hidden.iter().filter(|is_visible| !**is_visible).count(), count, "{keys:?}");
}

#[test]
fn the_settings_move_each_model_with_its_lights_and_cameras() {
    let models = ["shader-ball", "many-lights"].map(of);
    let all = std::sync::Arc::new(together(&models));
    let place = ModelSettings { rotation: [0.0, 90.0, 0.0], scale: 0.5, translation: [0.0, 2.0, 0.0] };
    let scene = Scene::new(&all, &settings(&[place]));
    let (count, moved) = (models[0].instances.len(), scene.model());
    same(&positions(moved, &moved.instances[..count]), positions(&models[0], &models[0].instances).into_iter());
    let transform = Mat4::from_translation(all.members[1].origin.as_vec3()) * place.transform().unwrap();
    let expected = || positions(&models[1], &models[1].instances).into_iter().map(|p| transform.transform_point3(p));
    same(&positions(moved, &moved.instances[count..]), expected());
    let lights: Vec<Vec3> = moved.lights[models[0].lights.len()..].iter().map(|light| light.position).collect();
    same(&lights, models[1].lights.iter().map(|light| transform.transform_point3(light.position)));
    let directions: Vec<Vec3> = moved.lights[models[0].lights.len()..].iter().map(|light| light.direction).collect();
    let turned = |direction: Vec3| transform.transform_vector3(direction).normalize();
    same(&directions, models[1].lights.iter().map(|light| turned(light.direction)));
    let top = expected().map(|point| point.y).fold(f32::NEG_INFINITY, f32::max);
    assert!((moved.bounds.max.y - top.max(models[0].bounds.max.y)).abs() < 1e-3, "{:?}", moved.bounds);
    // The first is moved by the settings of the model, and a place for another file is of no model.
    let mut settings = settings(&[place]);
    settings.added[0].file = "other.glb".into();
    settings.model.translation = [0.0, 0.0, 3.0];
    let scene = Scene::new(&all, &settings);
    let moved = scene.model();
    let shifted = positions(&models[0], &models[0].instances).into_iter().map(|point| point + Vec3::Z * 3.0);
    same(&positions(moved, &moved.instances[..count]), shifted);
    same(&positions(moved, &moved.instances[count..]), positions(&all, &all.instances[count..]).into_iter());
}

#[test]
fn each_model_plays_its_first_clip_where_it_stands() {
    let animated = motion::swinging();
    let all = std::sync::Arc::new(together(&[animated.clone(), of("sphere-grid"), animated.clone()]));
    let names: Vec<&str> = all.members.iter().map(|member| &*member.name).collect();
    assert_eq!(names, ["test", "sphere-grid", "test 2"]);
    let place = ModelSettings { scale: 2.0, ..ModelSettings::default() };
    let mut settings = settings(&[ModelSettings::default(), place]);
    for time in [0.0, 0.6] {
        settings.animation.time = time;
        let (own, scene) = (Scene::new(&std::sync::Arc::new(animated.clone()), &settings), Scene::new(&all, &settings));
        let (own, model) = (own.model(), scene.model());
        let expected = positions(own, &own.instances);
        assert_ne!(expected, positions(&animated, &animated.instances), "no clip plays");
        let count = own.instances.len();
        same(&positions(model, &model.instances[..count]), expected.iter().copied());
        let origin = all.members[2].origin.as_vec3();
        let last = &model.instances[model.instances.len() - count..];
        same(&positions(model, last), expected.iter().map(|point| *point * 2.0 + origin));
    }
}
