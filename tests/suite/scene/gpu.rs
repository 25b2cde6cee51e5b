//! The device layer from outside: names in validation messages, times of passes, finished frames, out of memory.

use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use crate::support::process::{PATIENCE, finish, specula};
use crate::support::{assert_validated, gpu};
use specula::gpu::{
    Attachments, Buffer, DescriptorSet, Encoder, Frames, Gpu, GpuError, GpuOptions, Image, ImageDesc, Memory,
    PassBindings, PassLayout, Pipeline, PipelineDesc, PrimitiveClass, Raster, Rect, ResourceUsage, Sampler,
    SamplerDesc, SetLayouts, SetWriter, ShaderModule, Submission, Use, fault, one_shot, vk,
};
use specula::interface::SET_FRAME;

const SIDE: u32 = 8;
const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;
const MIB: u64 = 1 << 20;

fn image(gpu: &Arc<Gpu>, name: &str, usage: vk::ImageUsageFlags) -> Arc<Image> {
    Image::new(gpu, name, ImageDesc::new(SIDE, SIDE, FORMAT, usage)).unwrap()
}

fn readback(gpu: &Arc<Gpu>, name: &str) -> Arc<Buffer> {
    let bytes = u64::from(SIDE * SIDE * 4);
    Buffer::new(gpu, name, bytes, vk::BufferUsageFlags::TRANSFER_DST, Memory::Readback).unwrap()
}

fn clear(encoder: &mut Encoder, image: &Arc<Image>, color: [f32; 4]) {
    let area = Rect { x: 0, y: 0, width: SIDE, height: SIDE };
    encoder.transition(image, Use::Undefined, Use::Color);
    encoder.begin_rendering(&Attachments { clear: Some(color), area, ..Attachments::of(image) });
    encoder.end_rendering();
}

/// A device of its own, since this test provokes validation messages.
fn validated_gpu() -> Arc<Gpu> {
    Gpu::new(&GpuOptions { validation: true, ..GpuOptions::default() }).unwrap()
}

/// Records commands that are wrong, and never submits them.
fn record(gpu: &Arc<Gpu>, commands: impl FnOnce(&mut Encoder)) {
    let never_submitted = one_shot(gpu, |encoder| -> Result<(), GpuError> {
        commands(encoder);
        Err(GpuError::NoStage("of a test".into()))
    });
    assert!(never_submitted.is_err());
}

/// Fails unless one message of the validation layers has all of `parts`.
#[track_caller]
fn assert_message(gpu: &Gpu, parts: &[&str]) {
    let messages = gpu.validation_messages();
    let found = messages.iter().any(|message| parts.iter().all(|part| message.contains(part)));
    assert!(found, "no message has all of {parts:?}:\n{}", messages.join("\n"));
}

#[test]
fn validation_messages_name_images_and_passes() {
    let gpu = validated_gpu();
    let (from, to) = (image(&gpu, "unreadable", vk::ImageUsageFlags::COLOR_ATTACHMENT), readback(&gpu, "pixels"));
    record(&gpu, |encoder| {
        encoder.pass("outer", |encoder| encoder.pass("wrong copy", |encoder| encoder.copy_from_image(&from, &to)));
    });
    assert_message(&gpu, &["unreadable", "one-shot commands", "`outer`", "`wrong copy`"]);
}

#[test]
fn validation_messages_name_buffers() {
    let gpu = validated_gpu();
    let from = Buffer::new(&gpu, "unreadable", 16, vk::BufferUsageFlags::TRANSFER_DST, Memory::Upload).unwrap();
    let to = readback(&gpu, "copied");
    record(&gpu, |encoder| encoder.copy_buffer(&from, 0, &to, 0, 16));
    assert_message(&gpu, &["unreadable"]);
}

#[test]
fn validation_messages_name_descriptor_sets() {
    let gpu = validated_gpu();
    let layouts = SetLayouts::new(&gpu).unwrap();
    let unsampled = image(&gpu, "unsampled", vk::ImageUsageFlags::COLOR_ATTACHMENT);
    let sampler = Sampler::new(&gpu, &SamplerDesc::NEAREST).unwrap();
    let writer = || SetWriter::default().texture(7, &unsampled, &sampler);
    DescriptorSet::new(&layouts, SET_FRAME, writer()).unwrap();
    assert_message(&gpu, &["frame set"]);
    DescriptorSet::new(&layouts, SET_FRAME, writer().named("wrong set")).unwrap();
    assert_message(&gpu, &["wrong set"]);
}

#[test]
fn validation_messages_name_pipelines_after_their_stages() {
    let gpu = validated_gpu();
    let layouts = SetLayouts::new(&gpu).unwrap();
    let compiler = shaderc::Compiler::new().unwrap();
    let module = |name: &str, kind, glsl: &str| {
        let spirv = compiler.compile_into_spirv(glsl, kind, name, "main", None).unwrap();
        ShaderModule::new(&gpu, name, spirv.as_binary(), false, ResourceUsage::default()).unwrap()
    };
    let vertex =
        module("one.vert", shaderc::ShaderKind::Vertex, "#version 450\nvoid main() { gl_Position = vec4(1); }");
    let fragment = "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1); }";
    let fragment = module("two.frag", shaderc::ShaderKind::Fragment, fragment);
    let desc = PipelineDesc {
        draws_by_index: false,
        pre_rasterization: &[(vk::ShaderStageFlags::VERTEX, &vertex)],
        fragment: &fragment,
        colors: &[vk::Format::R16G16B16A16_SFLOAT],
        depth: true,
        raster: Raster::Solid,
        samples: 1,
        class: PrimitiveClass::Triangles,
        layout: PassLayout::new(&gpu, &layouts, PassBindings::new(), false).unwrap(),
    };
    let pipeline = Pipeline::new(&gpu, &layouts, &desc).unwrap();
    let target = image(&gpu, "target", vk::ImageUsageFlags::COLOR_ATTACHMENT);
    record(&gpu, |encoder| {
        encoder.transition(&target, Use::Undefined, Use::Color);
        encoder.begin_rendering(&Attachments::of(&target));
        encoder.bind_pipeline(&pipeline);
        encoder.draw(3);
        encoder.end_rendering();
    });
    assert_message(&gpu, &["one.vert + two.frag (Solid Triangles)"]);
}

#[test]
fn passes_are_timed_in_the_order_in_which_they_begin() {
    let gpu = gpu();
    let mut frames = Frames::new(gpu, 2).unwrap();
    assert!(frames.pass_times().is_empty());
    let target = image(gpu, "target", vk::ImageUsageFlags::COLOR_ATTACHMENT);
    let begin = Instant::now();
    let mut encoder = frames.begin().unwrap();
    encoder.pass("clear", |encoder| clear(encoder, &target, [0.0; 4]));
    encoder.pass("outer", |encoder| {
        encoder.pass("clear", |encoder| clear(encoder, &target, [1.0; 4]));
        encoder.pass("empty", |_| ());
    });
    frames.submit(encoder, Submission::default()).unwrap();
    frames.wait().unwrap();
    let wall_ms = begin.elapsed().as_secs_f64() * 1e3;
    assert_validated();
    if gpu.timestamp_period().is_none() {
        return assert!(frames.pass_times().is_empty());
    }
    let names: Vec<_> = frames.pass_times().iter().map(|pass| pass.name.as_str()).collect();
    assert_eq!(names, ["clear", "outer", "clear", "empty"]);
    let ms: Vec<_> = frames.pass_times().iter().map(|pass| pass.ms).collect();
    let whole = frames.last_device_ms().unwrap();
    // Timestamps have a resolution, in nanoseconds, that a difference can be off by.
    let tick = f64::from(gpu.timestamp_period().unwrap()) * 1e-6;
    assert!(ms.iter().all(|ms| *ms >= 0.0), "{ms:?}");
    assert!(ms[2] + ms[3] <= ms[1] + 2.0 * tick, "nested passes are part of the outer one: {ms:?}");
    assert!(ms[0] + ms[1] <= whole + 2.0 * tick, "passes are part of the frame: {ms:?} of {whole}");
    assert!(whole > 0.0 && whole <= wall_ms, "{whole} ms on the device, {wall_ms} ms in all");
    let json = serde_json::to_value(&frames.pass_times()[0]).unwrap();
    assert_eq!(json["name"], "clear");
    assert!(json["ms"].is_f64());
}

/// A software device runs copies at once, and drawing when it is flushed: the times must tell them apart all the same.
#[test]
fn a_large_copy_takes_longer_than_the_pass_before_it() {
    let gpu = gpu();
    if gpu.timestamp_period().is_none() {
        return;
    }
    let mut frames = Frames::new(gpu, 1).unwrap();
    let target = image(gpu, "target", vk::ImageUsageFlags::COLOR_ATTACHMENT);
    let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let bulk = [0, 1].map(|_| Buffer::new(gpu, "bulk", 32 * MIB, usage, Memory::Device).unwrap());
    // The smallest of several frames, so that other processes do not matter.
    let mut least = [f64::MAX; 2];
    for _ in 0..10 {
        let mut encoder = frames.begin().unwrap();
        encoder.pass("clear", |encoder| clear(encoder, &target, [0.0; 4]));
        encoder.pass("copy", |encoder| encoder.copy_buffer(&bulk[0], 0, &bulk[1], 0, 32 * MIB));
        encoder.copies_done();
        frames.submit(encoder, Submission::default()).unwrap();
        frames.wait().unwrap();
        for (least, pass) in least.iter_mut().zip(frames.pass_times()) {
            *least = least.min(pass.ms);
        }
    }
    assert_validated();
    assert!(least[1] > least[0], "clearing 64 pixels took {} ms, copying 32 MiB {} ms", least[0], least[1]);
}

#[test]
fn pass_times_are_those_of_the_newest_finished_frame() {
    let gpu = gpu();
    if gpu.timestamp_period().is_none() {
        return;
    }
    let mut frames = Frames::new(gpu, 2).unwrap();
    for name in ["first", "second"] {
        let mut encoder = frames.begin().unwrap();
        encoder.pass(name, |_| ());
        frames.submit(encoder, Submission::default()).unwrap();
    }
    frames.wait().unwrap();
    assert_eq!(frames.pass_times()[0].name, "second");
    // This waits for the older frame, whose times must not replace the newer frame's.
    let encoder = frames.begin().unwrap();
    assert_eq!(frames.pass_times()[0].name, "second");
    drop(encoder);
    // A frame that was never submitted leaves everything as it was.
    frames.wait_all().unwrap();
    assert_eq!(frames.pass_times()[0].name, "second");
    assert_validated();
}

#[test]
fn more_passes_than_there_are_timestamps_for_are_no_error() {
    let gpu = gpu();
    let mut frames = Frames::new(gpu, 1).unwrap();
    for _ in 0..2 {
        let mut encoder = frames.begin().unwrap();
        let sum: usize = (0..100).map(|pass| encoder.pass(&format!("pass {pass}"), |_| pass)).sum();
        assert_eq!(sum, 4950);
        frames.submit(encoder, Submission::default()).unwrap();
        frames.wait().unwrap();
        assert_validated();
        if gpu.timestamp_period().is_some() {
            assert_eq!(frames.pass_times().len(), 64);
            assert_eq!(frames.pass_times()[63].name, "pass 63");
        }
    }
}

#[test]
fn a_finished_frame_can_be_read_without_a_wait() {
    let gpu = gpu();
    let mut frames = Frames::new(gpu, 2).unwrap();
    assert_eq!(frames.slots(), 2);
    assert!((0..2).all(|slot| frames.is_finished(slot)), "no slot was used yet");
    let target = image(gpu, "target", vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
    let pixels = readback(gpu, "pixels");
    // Enough work before the copy that a slot which is finished too early shows in the pixels.
    let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let bulk = [0, 1].map(|_| Buffer::new(gpu, "bulk", 32 * MIB, usage, Memory::Device).unwrap());
    let mut encoder = frames.begin().unwrap();
    for _ in 0..4 {
        encoder.copy_buffer(&bulk[0], 0, &bulk[1], 0, 32 * MIB);
        encoder.copies_done();
    }
    clear(&mut encoder, &target, [1.0, 0.0, 1.0, 1.0]);
    encoder.transition(&target, Use::Color, Use::CopyFrom);
    encoder.copy_pixel(&target, (3, 3), &pixels);
    encoder.copies_done();
    let slot = frames.current();
    frames.submit(encoder, Submission::default()).unwrap();
    let begin = Instant::now();
    while !frames.is_finished(slot) {
        assert!(begin.elapsed() < PATIENCE, "the frame is never finished");
        std::thread::yield_now();
    }
    assert_eq!(pixels.read()[..4], [255, 0, 255, 255]);
    assert!(frames.is_finished(slot), "a finished frame stays finished");
    assert_validated();
}

/// Without validation: the layers reject an image this large on a small device.
#[test]
fn an_image_larger_than_the_device_is_out_of_memory() {
    let gpu = Gpu::new(&GpuOptions::default()).unwrap();
    let side = gpu.max_image_size();
    let desc = ImageDesc::new(side, side, vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::SAMPLED);
    match Image::new(&gpu, "larger than the device", desc) {
        // Some devices have room for it.
        Ok(_) => {}
        Err(GpuError::OutOfMemory(message)) => assert!(message.contains("larger than the device"), "{message}"),
        Err(other) => panic!("{other:?}"),
    }
}

/// A process reads the faults once, so this test runs itself again as a process with the variable set.
#[test]
fn injected_faults_refuse_images_and_buffers() {
    if std::env::var_os(fault::VARIABLE).is_none() {
        let mut command = Command::new(std::env::current_exe().unwrap());
        let (_, module) = module_path!().split_once("::").unwrap();
        command.args(["--exact", &format!("{module}::injected_faults_refuse_images_and_buffers"), "--nocapture"]);
        let end = finish(command.env(fault::VARIABLE, "image-bytes:100000,buffer-bytes:200000,other:7"));
        assert!(end.code == Some(0) && end.stdout.contains("1 passed"), "{end:#?}");
        return;
    }
    assert_eq!(fault::value("other"), Some(7));
    assert_eq!(fault::value("unknown"), None);
    let gpu = gpu();
    let sized = |side| ImageDesc::new(side, side, FORMAT, vk::ImageUsageFlags::SAMPLED);
    let refused = Image::new(gpu, "large", sized(512)).err();
    assert!(matches!(&refused, Some(GpuError::OutOfMemory(what)) if what.contains("`large`")), "{refused:?}");
    Image::new(gpu, "small", sized(32)).unwrap();
    let buffer = |bytes| Buffer::new(gpu, "data", bytes, vk::BufferUsageFlags::TRANSFER_SRC, Memory::Upload);
    let refused = buffer(MIB).err();
    assert!(matches!(&refused, Some(GpuError::OutOfMemory(what)) if what.contains("`data`")), "{refused:?}");
    buffer(1000).unwrap();
    assert_validated();
}

#[test]
fn a_picture_that_needs_too_much_memory_is_an_error_and_leaks_nothing() {
    let here = tempfile::tempdir().unwrap();
    let mut command = specula(here.path());
    command.args(["render", "--env", "none", "--size", "1024x1024", "--validate", "--out", "large.png"]);
    let end = finish(command.env(fault::VARIABLE, "image-bytes:10000000"));
    end.expect(3, &["out of graphics memory while creating the image", "view.msaa"]);
    assert!(!end.stderr.contains("VUID"), "the layers report objects that are left at the end: {end:#?}");
    assert!(!here.path().join("large.png").exists());
}
