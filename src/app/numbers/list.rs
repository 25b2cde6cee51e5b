//! The numbers of the settings, panel by panel.

use super::Number;
use crate::settings::{LightSource, MaterialChannel, Settings};

const TURN: (f64, f64) = (-180.0, 180.0);
const WHOLE: (f64, f64) = (0.0, 1.0);
/// Unit of lengths around the model.
const RADII: &str = " R";

pub(in crate::app) static EXPOSURE: Number = Number::new(
    ("view.ev", "Exposure"),
    ((-16.0, 16.0), 1, " EV"),
    "Exposure compensation in stops: +1 is twice as bright. It is -EV100, so `--ev` and `--set view.ev` take it with the other sign: light \
     in cd/m² is multiplied by 1 / (1.2 × 2^EV100)",
    |settings, _| &mut settings.view.ev,
)
.negated();

pub(in crate::app) static FIELD_OF_VIEW: Number =
    Number::new(("camera.fovy", "Field of view"), ((5.0, 120.0), 0, "°"), "Vertical field of view", |settings, _| {
        &mut settings.camera.fovy
    });

pub(in crate::app) static ROTATION: Number = Number::new(
    ("environment.rotation", "Rotation"),
    (TURN, 0, "°"),
    "Rotation of the environment around +Y (Alt+drag)",
    |settings, _| &mut settings.environment.rotation,
)
.when(|settings| settings.environment.is_lit());
pub(in crate::app) static INTENSITY: Number = Number::new(
    ("environment.intensity", "Intensity"),
    ((0.0, 8.0), 2, "×"),
    "Multiplies the map, whose values are in cd/m²",
    |settings, _| &mut settings.environment.intensity,
)
.when(|settings| settings.environment.is_lit());
pub(in crate::app) static BLUR: Number = Number::new(
    ("environment.blur", "Blur"),
    (WHOLE, 2, ""),
    "Blur of the map behind the model, as a roughness: 0 is sharp",
    |settings, _| &mut settings.environment.blur,
)
.squared()
.when(|settings| settings.environment.is_shown(&settings.view));

pub(in crate::app) static SPIN: Number = Number::new(
    ("lights.spin", "Orbit speed"),
    ((-90.0, 90.0), 0, "°/s"),
    "Speed of the orbiting lights around the model; 0 stops them (L)",
    |settings, _| &mut settings.lights.spin,
)
.when(has_orbit);
pub(in crate::app) static ORBIT: [Number; 4] = [
    Number::new(
        ("lights.orbit.*.strength", "Illuminance"),
        ((0.0, 60.0), 1, " lx"),
        "Illuminance at a distance of one model radius",
        |settings, light| &mut settings.lights.orbit[light].strength,
    )
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.distance", "Distance"),
        ((0.5, 10.0), 2, RADII),
        "Distance from the model's center, in radii of the model",
        |settings, light| &mut settings.lights.orbit[light].distance,
    )
    .logarithmic()
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.azimuth", "Azimuth"),
        ((-180.0, 360.0), 0, "°"),
        "Angle around +Y, from +Z towards +X",
        |settings, light| &mut settings.lights.orbit[light].azimuth,
    )
    .when(has_orbit),
    Number::new(
        ("lights.orbit.*.polar", "Polar angle"),
        ((0.0, 180.0), 0, "°"),
        "Angle from +Y",
        |settings, light| &mut settings.lights.orbit[light].polar,
    )
    .when(has_orbit),
];
pub(in crate::app) static RECTANGLE: [Number; 6] = [
    Number::new(
        ("lights.rect.strength", "Luminance"),
        ((0.0, 60.0), 1, " cd/m²"),
        "Luminance of a white rectangle, independent of its size",
        |settings, _| &mut settings.lights.rect.strength,
    )
    .when(has_rectangle),
    Number::new(
        ("lights.rect.width", "Width"),
        ((0.01, 20.0), 2, RADII),
        "Length of the horizontal edges, in radii of the model",
        |settings, _| &mut settings.lights.rect.width,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.height", "Height"),
        ((0.01, 20.0), 2, RADII),
        "Length of the other edges, in radii of the model",
        |settings, _| &mut settings.lights.rect.height,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.distance", "Distance"),
        ((0.5, 10.0), 2, RADII),
        "Distance from the model's center, in radii of the model",
        |settings, _| &mut settings.lights.rect.distance,
    )
    .logarithmic()
    .when(has_rectangle),
    Number::new(
        ("lights.rect.azimuth", "Azimuth"),
        ((-180.0, 360.0), 0, "°"),
        "Angle around +Y, from +Z towards +X",
        |settings, _| &mut settings.lights.rect.azimuth,
    )
    .when(has_rectangle),
    Number::new(("lights.rect.polar", "Polar angle"), ((0.0, 180.0), 0, "°"), "Angle from +Y", |settings, _| {
        &mut settings.lights.rect.polar
    })
    .when(has_rectangle),
];
pub(in crate::app) static AMBIENT: Number = Number::new(
    ("lights.ambient_strength", "Luminance"),
    ((0.0, 2.0), 2, " cd/m²"),
    "Luminance from every direction. An environment replaces the ambient light",
    |settings, _| &mut settings.lights.ambient_strength,
)
.when(|settings| !settings.environment.is_lit());

pub(in crate::app) static MATERIAL: [Number; 3] = [
    Number::new(("material.metallic", "Metallic"), (WHOLE, 2, ""), "0 is a dielectric, 1 a metal", |settings, _| {
        &mut settings.material.metallic
    })
    .when(|settings| settings.material.replaces(MaterialChannel::Metallic)),
    Number::new(("material.roughness", "Roughness"), (WHOLE, 2, ""), "Perceptual roughness", |settings, _| {
        &mut settings.material.roughness
    })
    .when(|settings| settings.material.replaces(MaterialChannel::Roughness)),
    Number::new(
        ("material.anisotropy", "Anisotropy"),
        (WHOLE, 2, ""),
        "Strength of the anisotropy: 0 is isotropic",
        |settings, _| &mut settings.material.anisotropy,
    )
    .when(|settings| settings.material.replaces(MaterialChannel::Anisotropy)),
];
pub(in crate::app) static DIRECTION: Number = Number::new(
    ("material.anisotropy_rotation", "Direction"),
    ((-90.0, 90.0), 0, "°"),
    "Direction of the anisotropy: angle from the tangent towards the bitangent",
    |settings, _| &mut settings.material.anisotropy_rotation,
)
.when(|settings| settings.material.replaces(MaterialChannel::Anisotropy) && settings.material.anisotropy > 0.0);

pub(in crate::app) static TRANSFORM: [Number; 7] = [
    Number::new(
        ("model.rotation.0", "Rotation X"),
        (TURN, 0, "°"),
        "Rotation about the model's X axis, applied after Z",
        |settings, _| &mut settings.model.rotation[0],
    ),
    Number::new(
        ("model.rotation.1", "Rotation Y"),
        (TURN, 0, "°"),
        "Rotation about the vertical axis, applied after Z and X",
        |settings, _| &mut settings.model.rotation[1],
    ),
    Number::new(
        ("model.rotation.2", "Rotation Z"),
        (TURN, 0, "°"),
        "Rotation about the model's Z axis, applied first",
        |settings, _| &mut settings.model.rotation[2],
    ),
    Number::new(
        ("model.scale", "Scale"),
        ((0.01, 100.0), 2, "×"),
        "Scales all lengths. The camera frames the model again unless it was moved; lights follow its size",
        |settings, _| &mut settings.model.scale,
    )
    .logarithmic(),
    Number::new(
        ("model.translation.0", "Move X"),
        ((-10.0, 10.0), 2, " m"),
        "Translation along X. The camera follows unless it was moved",
        |settings, _| &mut settings.model.translation[0],
    ),
    Number::new(
        ("model.translation.1", "Move Y"),
        ((-10.0, 10.0), 2, " m"),
        "Translation along Y, up. The camera follows unless it was moved",
        |settings, _| &mut settings.model.translation[1],
    ),
    Number::new(
        ("model.translation.2", "Move Z"),
        ((-10.0, 10.0), 2, " m"),
        "Translation along Z. The camera follows unless it was moved",
        |settings, _| &mut settings.model.translation[2],
    ),
];

fn has_orbit(settings: &Settings) -> bool {
    settings.lights.source == LightSource::Orbit
}

fn has_rectangle(settings: &Settings) -> bool {
    settings.lights.rect.enabled && settings.lights.source != LightSource::None
}

/// All numbers of the settings, in the order of the panels.
pub(in crate::app) fn all(settings: &Settings) -> impl Iterator<Item = Number> {
    let lights = 0..settings.lights.orbit.len();
    let orbit = lights.flat_map(|light| ORBIT.iter().map(move |number| number.of_light(light)));
    let first = [&EXPOSURE, &FIELD_OF_VIEW, &ROTATION, &INTENSITY, &BLUR, &SPIN].into_iter().cloned();
    let last = RECTANGLE.iter().chain([&AMBIENT]).chain(&MATERIAL).chain([&DIRECTION]).chain(&TRANSFORM).cloned();
    first.chain(orbit).chain(last)
}
