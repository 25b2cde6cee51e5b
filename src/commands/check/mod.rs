//! `specula check`: compiles every stage, and every library alone, and builds the pipelines of every declared choice. For CI.

mod args;
mod drawn;

use std::collections::BTreeSet;
use std::sync::Arc;

use specula::events::{Event, emit};
use specula::frame::{MaterialVariant, PipelineRequest, TargetFormat};
use specula::gpu::{PrimitiveClass, SetLayouts};
use specula::interface::{self, ALPHA_BLEND, ALPHA_MASK, ALPHA_OPAQUE};
use specula::message::tell;
use specula::pipeline::{PassTextures, PipelineSet, beyond_limits};
use specula::render::beyond_memory;
use specula::settings::{Settings, ShaderValue};
use specula::shader::spirv::reflect::Scalar;
use specula::shader::{Diagnostic, Library, Severity, ShaderSet, check};

use super::common::{check_validation, compiler};
use super::progress::Progress;
use super::{Failure, print_diagnostics, print_json};
pub use args::Args;

/// Runs the command. Compiling needs no device. If there is a device, this also builds the pipelines of every mode and choice.
pub fn run(mut args: Args) -> Result<(), Failure> {
    if args.undefined || args.models.model.is_some() {
        return drawn::run(&mut args);
    }
    let args = &args;
    let source = args.common.source()?;
    let mut library = Library::new(source, compiler()?, &specula::frame::stages::all_stages());
    let start = std::time::Instant::now();
    let progress = Progress::new(!args.common.emits());
    progress.say("compiling every file");
    let mut diagnostics = check::check(&mut library);
    let built = match library.set().cloned() {
        Some(shaders) if diagnostics.iter().all(|d| d.severity != Severity::Error) => {
            build_choices(args, &shaders, &mut diagnostics, &progress)?
        }
        _ => None,
    };
    drop(progress);
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    for diagnostic in &diagnostics {
        emit(args.common.emits(), &Event::Diagnostic(diagnostic));
    }
    if args.json {
        print_json(&diagnostics);
    }
    print_diagnostics(&diagnostics);
    if errors > 0 {
        tell(format_args!("{errors} error{}", if errors == 1 { "" } else { "s" }));
        return Err(Failure::Printed);
    }
    if !args.json && !args.common.emits() {
        let files = library.source().list().len();
        let modes = library.set().map_or(0, |set| set.modes.len());
        let built =
            built.map_or("no pipelines, since there is no device".to_owned(), |n| format!("{n} pipelines built"));
        let seconds = start.elapsed().as_secs_f64();
        out!("checked {files} files, {modes} modes, {built}: no errors ({seconds:.1} s)");
    }
    Ok(())
}

/// Builds the pipelines of every mode, and of the final picture with every declared choice, since a shader that compiles may
/// still fail for one value of a specialization constant. Returns the number of pipelines, or `None` without a device.
fn build_choices(
    args: &Args,
    shaders: &Arc<ShaderSet>,
    diagnostics: &mut Vec<Diagnostic>,
    progress: &Progress,
) -> Result<Option<usize>, Failure> {
    let gpu = match args.common.gpu_without_pipelines() {
        Ok(gpu) => gpu,
        Err(_) if args.common.device.is_none() => return Ok(None),
        Err(failure) => return Err(failure),
    };
    let layouts = SetLayouts::new(&gpu)?;
    let settings = args.common.settings()?;
    let materials =
        BTreeSet::from([MaterialVariant { features: interface::FEATURE_NORMAL_TEXTURE, ..Default::default() }]);
    // Each feature alone, including the features of a whole frame.
    let features = std::iter::once(0).chain((0..=interface::LAST_FEATURE).map(|bit| 1 << bit));
    let all_materials: BTreeSet<_> =
        [ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND]
            .into_iter()
            .flat_map(|alpha| features.clone().map(move |features| (alpha, features)))
            .flat_map(|(alpha, features)| {
                [PrimitiveClass::Points, PrimitiveClass::Lines, PrimitiveClass::Triangles]
                    .map(|class| MaterialVariant { alpha, features, class })
            })
            .collect();
    let request = |settings: &Settings| {
        let request = PipelineRequest::new(settings, shaders, None, TargetFormat::half(1));
        PipelineRequest { materials: materials.clone(), ..request }
    };
    let plain = request(&settings);
    let source = args.common.source()?;
    let mut problems = beyond_limits(&gpu, shaders, &source);
    let textures = PassTextures::load(&gpu, &shaders.graph, None).unwrap_or_else(|errors| {
        problems.extend(errors.into_iter().map(|error| source.explained(error)));
        Arc::default()
    });
    problems.extend(beyond_memory_when_on(shaders, &settings, args.common.size(), request));
    if !problems.is_empty() {
        diagnostics.extend(problems);
        return Ok(None);
    }
    let set = match PipelineSet::new(&gpu, &layouts, shaders.clone(), textures, &plain, None) {
        Ok((set, _)) => set,
        Err(error) => {
            diagnostics.push(Diagnostic::error(args.common.source()?.name(), error.to_string()));
            return Ok(None);
        }
    };
    let mut count = 1;
    let mut build = |request: &PipelineRequest, file: &str, line: u32, what: String| {
        count += request.materials.len();
        progress.say(&format!("building the pipelines of {what}"));
        if let Err(error) = set.build(request) {
            diagnostics.push(
                Diagnostic::error(file, format!("the pipeline of {what} cannot be built: {error}")).on_line(line, None),
            );
        }
    };
    // With a light count from the frame's uniforms, and a sun. All other requests have a fixed number of lights.
    let target = TargetFormat::half(4);
    let every_material =
        PipelineRequest { materials: all_materials, target, light_count: 0, sun_count: 1, ..plain.clone() };
    build(&every_material, &args.common.source()?.name(), 1, "some kind of material".to_owned());
    let lit_by_many = PipelineRequest { many_lights: true, light_count: 0, ..plain.clone() };
    build(&lit_by_many, &args.common.source()?.name(), 1, "a scene with many lights".to_owned());
    for mode in &shaders.modes {
        let of_mode = request(&Settings { mode: mode.slug.clone(), ..settings.clone() });
        build(&of_mode, &mode.file, mode.line, format!("mode {}", mode.slug));
    }
    for constant in &shaders.constants {
        let named = constant.choices.iter().map(|(name, value)| (name.clone(), ShaderValue::Int(*value)));
        let bools = [true, false].map(|on| (on.to_string(), ShaderValue::Bool(on)));
        let bools = bools.into_iter().filter(|_| constant.scalar == Scalar::Bool);
        for (name, value) in named.chain(bools) {
            let mut chosen = settings.clone();
            chosen.shader.insert(constant.name.clone(), value);
            build(&request(&chosen), &constant.file, constant.line, format!("{} = {name}", constant.name));
        }
    }
    drop(set);
    check_validation(&gpu)?;
    Ok(Some(count))
}

/// Errors of passes that take more memory than the settings allow, for a frame of this size: with the current settings, with each
/// pass that is off, and with what each constant switches on.
fn beyond_memory_when_on(
    shaders: &ShaderSet,
    settings: &Settings,
    size: (u32, u32),
    request: impl Fn(&Settings) -> PipelineRequest,
) -> Vec<Diagnostic> {
    let passes = &shaders.graph.passes;
    let constants: BTreeSet<&String> = passes.iter().filter_map(|pass| pass.desc.when.as_ref()).collect();
    let switched = constants.into_iter().map(|name| {
        let constant = shaders.constants.iter().find(|constant| constant.name == *name);
        let last = constant.and_then(|constant| constant.choices.last());
        let mut chosen = settings.clone();
        chosen.shader.insert(name.clone(), last.map_or(ShaderValue::Bool(true), |(_, value)| ShaderValue::Int(*value)));
        chosen
    });
    let off = passes.iter().filter(|pass| !pass.desc.on).map(|pass| {
        let mut chosen = settings.clone();
        chosen.passes.insert(pass.name().to_owned(), true);
        chosen
    });
    let limit = u64::from(settings.view.pass_memory) << 20;
    let mut errors: Vec<Diagnostic> = Vec::new();
    for chosen in std::iter::once(settings.clone()).chain(off).chain(switched) {
        let error = beyond_memory(&request(&chosen), size, limit);
        errors.extend(error.filter(|error| !errors.contains(error)));
    }
    errors
}
