//! The inspector's side of the viewer: pins pixels, takes their values, and has the curves of their materials measured.

use crate::app::engine::Engine;
use crate::app::state::State;
use crate::app::state::inspection::anchor::Anchor;
use crate::app::state::inspection::{Asked, NotFiniteSearch, Page, Reading, SearchOf, Shown};
use crate::app::state::workspace::Sight;
use crate::events::{Event, emit};
use crate::frame::FrameState;
use crate::identity::Identity;
use crate::render::Texel;
use crate::scene::pick;
use crate::shader::PixelValue;
use crate::shader::not_finite::NotFinite;
use crate::threads::MeasuredCurves;
use crate::threads::finder::FindRequest;
use crate::threads::measurer::CurvesRequest;

/// A click within this many pixels of the pinned one unpins it: the radius of its marker.
const MARKER: u32 = 6;

/// Pins a pixel, or unpins it if it is the pinned one and its marker is in sight.
pub(in crate::app) fn inspect(state: &mut State, at: [u32; 2]) {
    let inspector = &mut state.inspection;
    let Sight { inspector: has_inspector, source: has_source, .. } = state.workspace.sight;
    // The panel reads the pixel once it is open.
    if !has_inspector && !has_source {
        // A click is the shader's own input there.
        if state.shader.is_single_file {
            return;
        }
        inspector.pin = Some(at);
        if !std::mem::replace(&mut inspector.was_mentioned, true) {
            state.say("The panel Inspector reads the values of the pixel that you click");
        }
        return;
    }
    let is_near = |pin: [u32; 2]| pin[0].abs_diff(at[0]) <= MARKER && pin[1].abs_diff(at[1]) <= MARKER;
    match inspector.pin.is_some_and(is_near) {
        true => inspector.unpin(),
        false => inspector.pin = Some(at),
    }
}

/// Moves the pin to the pixel that shows its surface in the next picture, which may be of another size.
pub(in crate::app) fn follow_pin(state: &mut State, next: &FrameState) {
    let Some((at, before)) = state.inspection.pin.zip(state.shown()) else { return };
    if before.size == next.size {
        return;
    }
    let known = state.inspection.anchor.as_ref().filter(|anchor| anchor.is_of(at, before)).cloned();
    let moved = known.unwrap_or_else(|| Anchor::new(at, before)).moved(next.size, next.camera);
    match moved {
        Some((at, anchor)) => (state.inspection.pin, state.inspection.anchor) = (Some(at), Some(anchor)),
        None => {
            state.inspection.unpin();
            state.say("The picture no longer shows the pinned place, so it was unpinned");
        }
    }
}

/// Begins to read the values of a pixel: picture number `picture`, which `state` draws. Earlier values stay until newer ones come.
pub(in crate::app) fn begin_values(
    state: &mut State,
    engine: &mut Engine,
    picture: u64,
    at: [u32; 2],
    frame_state: &FrameState,
) {
    let inspector = &mut state.inspection;
    let settings = &state.session.settings;
    let of = || SearchOf::new(at, frame_state.shaders.generation, settings);
    if inspector.search_not_finite.is_some() && inspector.searched != Some(of()) {
        inspector.search_not_finite = None;
        engine.threads.finder.cancel();
    }
    let before = inspector.reading.take().map(|reading| reading.values).unwrap_or_default();
    let is_known = |slug: &str| frame_state.shaders.modes.iter().any(|mode| mode.slug == slug);
    let values = before.into_iter().filter(|(slug, _)| is_known(slug)).collect();
    inspector.reading = Some(Reading {
        at,
        values,
        picture,
        is_complete: false,
        is_of_toy: false,
        exposure: frame_state.exposure(),
        camera: frame_state.camera,
        lights: frame_state.lights.clone(),
        names: names(frame_state, at),
        texels: Vec::new(),
    });
}

/// Takes the texels at the pixel of picture number `picture`.
pub(in crate::app) fn take_texels(state: &mut State, picture: u64, texels: Vec<Texel>) {
    if let Some(reading) = state.inspection.reading.as_mut().filter(|reading| reading.picture == picture) {
        reading.texels = texels;
    }
}

/// Takes values of picture number `picture`.
pub(in crate::app) fn take_values(state: &mut State, picture: u64, values: impl Iterator<Item = (String, PixelValue)>) {
    let Some(reading) = state.inspection.reading.as_mut().filter(|reading| reading.picture == picture) else {
        return;
    };
    reading.values.extend(values.map(|(slug, value)| (slug, (value, picture))));
}

/// Learns that all values of picture number `picture` were taken. Returns whether that is new.
pub(in crate::app) fn values_complete(state: &mut State, engine: &mut Engine, picture: u64) -> bool {
    let mut is_new = false;
    if let Some(reading) = state.inspection.reading.as_mut().filter(|reading| reading.picture == picture)
        && !std::mem::replace(&mut reading.is_complete, true)
    {
        is_new = true;
        reading.values.retain(|_, (_, of)| *of == picture);
        let hit = reading.is_hit();
        if !hit {
            (reading.names, reading.texels) = (None, Vec::new());
        }
        let [node, material] = match &reading.names {
            Some(names) => names.each_ref().map(|name| Some(name.as_str())),
            None => [None; 2],
        };
        let shaders = state.session.shaders.clone().unwrap_or_default();
        let modes = reading.json(&shaders.modes).collect();
        let generation = shaders.generation;
        let textures = reading.texels.iter().map(Texel::json).collect();
        let event = Event::Inspected { pixel: reading.at, generation, hit, node, material, modes, textures };
        emit(&state.events, &event);
    }
    search_not_finite(state, engine);
    request_curves(state, engine);
    is_new
}

/// Has the first statement found that makes NaN or infinity at the pinned pixel, if there is any: in the mode on screen, else in the
/// final picture, else in the first mode that has one.
fn search_not_finite(state: &mut State, engine: &mut Engine) {
    let inspector = &state.inspection;
    let is_wanted = inspector.is_pinned() && inspector.search_not_finite.is_none() && !state.is_cut_short();
    let Some(reading) = inspector.reading.as_ref().filter(|reading| is_wanted && reading.is_complete) else {
        return;
    };
    let Some((shaders, frame_state)) = state.session.shaders.clone().zip(state.shown()) else { return };
    let values = || shaders.modes.iter().filter_map(|mode| Some((mode, &reading.values.get(&mode.slug)?.0)));
    let current = values().filter(|(mode, _)| mode.slug == state.session.settings.mode);
    let Some(mode) = NotFinite::mode_of(current).or_else(|| NotFinite::mode_of(values())) else { return };
    let (size, at) = (frame_state.size, (reading.at[0], reading.at[1]));
    let request = FindRequest {
        compiler: engine.compiler.clone(),
        settings: state.session.settings.clone(),
        scene: state.session.scene(),
        revisions: state.session.revisions,
        resources: engine.resources.clone(),
        size,
        at,
        mode: mode.clone(),
        source: state.source.clone(),
        shaders: shaders.clone(),
    };
    let mode = mode.slug.clone();
    state.inspection.searched = Some(SearchOf::new(reading.at, shaders.generation, &state.session.settings));
    let number = engine.threads.finder.find(request);
    state.inspection.search_not_finite = Some(NotFiniteSearch { number, mode, found: None });
}

/// Takes the result of the newest search.
pub(in crate::app) fn on_not_finite(state: &mut State, number: u64, found: NotFinite) {
    let search = state.inspection.search_not_finite.as_mut().filter(|search| search.number == number);
    let Some(search) = search else { return };
    let generation = state.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    emit(&state.events, &Event::NotFinite { generation, not_finite: found.json() });
    search.found = Some(found);
}

/// Has the curves of the inspected material measured, while the page that shows them is in sight. Values are complete then, so the
/// newest edit is on screen.
fn request_curves(state: &mut State, engine: &mut Engine) {
    let inspector = &state.inspection;
    if inspector.page != Page::Lobe || state.is_cut_short() {
        return;
    }
    let chosen = state.session.settings.lights.chosen;
    let material = inspector.reading.as_ref().filter(|reading| reading.is_hit()).and_then(|of| of.material(chosen));
    let (Some(material), Some(newest)) = (material, state.session.shaders.clone()) else { return };
    let before = state.versions.last_before(newest.generation).map(|version| version.shaders.clone());
    let shaders = [Identity::of(&newest), Identity::of_any(before.as_ref())];
    let settings = format!("{:?}", state.session.settings.shader);
    let is_asked = |asked: &Asked| (asked.material, &asked.shaders, &asked.settings) == (material, &shaders, &settings);
    if inspector.asked.as_ref().is_some_and(is_asked) {
        return;
    }
    let request = CurvesRequest {
        shaders: [Some(newest), before],
        tree: state.source.clone(),
        settings: state.session.settings.clone(),
        material,
    };
    let number = engine.threads.measurer.measure(&engine.compiler, request);
    state.inspection.asked = Some(Asked { number, material, shaders, settings });
}

/// Takes curves, if they are those that were asked for last.
pub(in crate::app) fn on_curves(state: &mut State, measured: MeasuredCurves) {
    let inspector = &mut state.inspection;
    let Some(asked) = inspector.asked.as_ref().filter(|asked| asked.number == measured.number) else { return };
    let MeasuredCurves { now, before, ms, .. } = measured;
    let generation = state.session.shaders.as_ref().map_or(0, |shaders| shaders.generation);
    let albedo = now.as_ref().ok().and_then(|curves| curves.albedo.first().copied());
    emit(&state.events, &Event::Curves { generation, before: before.is_some(), albedo, ms });
    inspector.curves = Some(Shown { of: asked.material, now, before });
}

/// Names of the node and of the material at a pixel.
fn names(state: &FrameState, at: [u32; 2]) -> Option<[String; 2]> {
    let scene = state.scene.as_ref()?;
    let model = scene.model();
    let hit = pick(model, &state.camera, state.size, (at[0], at[1]), |instance| scene.sides(instance))?;
    let instance = model.instances.get(hit.instance)?;
    let material = match scene.replacement() {
        Some(_) => "material override".to_owned(),
        None => model.materials.get(scene.material_of(instance))?.name.clone(),
    };
    let named = |name: &str, instead: &str| if name.is_empty() { instead.to_owned() } else { name.to_owned() };
    let primitive = model.primitives.get(instance.primitive)?;
    Some([named(&instance.node_name, &primitive.name), named(&material, "unnamed material")])
}
