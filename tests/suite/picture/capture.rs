//! `specula render --sheet` and `--turntable`: many pictures in one file.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::support::open_image;
use crate::support::process::{Finished, run};
use crate::support::video::Video;
use image::codecs::gif::GifDecoder;
use image::codecs::webp::WebPDecoder;
use image::imageops::thumbnail;
use image::{AnimationDecoder as _, DynamicImage, GenericImageView as _, RgbaImage};

/// Arguments of a `render` that is fast.
const QUICK: [&str; 8] = ["render", "sphere-grid", "--env", "none", "--lights", "orbit", "--set", "view.msaa=1"];

fn render(directory: &Path, args: &[&str]) -> Finished {
    run(directory, &[&QUICK[..], args].concat())
}

fn reader(path: &Path) -> BufReader<File> {
    BufReader::new(File::open(path).unwrap())
}

/// The mean difference of a channel.
fn distance(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

/// The upper left 64x46 pixels, at half the size: a video has one color for two by two pixels, so only their mean is near.
fn halved(image: &DynamicImage) -> RgbaImage {
    thumbnail(&image.crop_imm(0, 0, 64, 46).into_rgba8(), 32, 23)
}

#[test]
fn a_sheet_shows_each_mode_as_render_does() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    render(path, &["--sheet", "metallic,roughness,d", "--tile", "64x48", "--out", "sheet.png"]).expect(0, &[]);
    let sheet = open_image(&path.join("sheet.png"));
    // Pictures stand in one row, 8 pixels apart, in the order of the tree.
    let modes = run(path, &["modes", "--json"]).json();
    let slugs =
        modes["modes"].as_array().or(modes.as_array()).unwrap().iter().map(|mode| mode["slug"].as_str().unwrap());
    let order: Vec<&str> = slugs.filter(|slug| ["metallic", "roughness", "d"].contains(slug)).collect();
    assert_eq!(order.len(), 3);
    for (index, slug) in order.iter().enumerate() {
        let file = format!("{slug}.png");
        let range = ["--set", "view.range=auto"];
        render(path, &[&["--mode", slug, "--size", "64x48", "--out", &file][..], &range].concat()).expect(0, &[]);
        let alone = open_image(&path.join(&file)).into_rgba8();
        let columns = (sheet.width() - 8) / 72;
        let (column, row) = (index as u32 % columns, index as u32 / columns);
        let tile = sheet.view(8 + column * 72, 8 + row * (48 + 22 + 8), 64, 48).to_image();
        assert!(tile == alone, "{slug} differs in the sheet");
    }
}

#[test]
fn a_turntable_is_a_full_turn() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let camera = ["--eye", "0,1,4", "--target", "0,0,0", "--size", "64x48"];
    let turn =
        |out: &str| render(path, &[&camera[..], &["--turntable", "4", "--out", out]].concat()).expect(0, &[]).code;
    turn("spin.webp");
    let frames = WebPDecoder::new(reader(&path.join("spin.webp"))).unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 4);
    assert_eq!(frames[0].delay().numer_denom_ms(), (40, 1), "25 frames a second");
    render(path, &[&camera[..], &["--out", "first.png"]].concat()).expect(0, &[]);
    let first = open_image(&path.join("first.png")).into_rgba8();
    turn("spin.png");
    let plain = [1, 2, 3, 4].map(|number| open_image(&path.join(format!("spin.{number:04}.png"))).into_rgba8());
    assert!(plain[0] == first, "the first frame is the picture");
    // A WebP loses some color: 2.4 of 255 at this small size.
    for (frame, plain) in frames.iter().zip(&plain) {
        let apart = distance(&halved(&frame.buffer().clone().into()), &halved(&plain.clone().into()));
        assert!(apart < 4.0, "the WebP differs by {apart}");
    }
    // The third is seen from behind.
    render(path, &["--eye", "0,1,-4", "--target", "0,0,0", "--size", "64x48", "--out", "third.png"]).expect(0, &[]);
    let third = open_image(&path.join("third.png")).into_rgba8();
    assert!(distance(&plain[2], &third) < 0.5 && distance(&first, &third) > 0.5);

    turn("spin.gif");
    let decoder = GifDecoder::new(reader(&path.join("spin.gif"))).unwrap();
    let gif = decoder.into_frames().collect_frames().unwrap();
    assert_eq!(gif.len(), 4);
    assert!(distance(gif[0].buffer(), &first) < 8.0, "{}", distance(gif[0].buffer(), &first));

    turn("spin.mp4");
    let video = Video::read(&std::fs::read(path.join("spin.mp4")).unwrap());
    assert_eq!(video.frames.len(), 4);
    for (frame, plain) in video.frames.iter().zip(&plain) {
        let apart = distance(&halved(&DynamicImage::from(frame.clone())), &halved(&plain.clone().into()));
        assert!(apart < 2.0, "the video differs from the pictures by {apart}");
    }
}

#[test]
fn a_turntable_has_one_range_for_all_frames() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    // The camera turns around a place beside the model, so it is 10, 7, 10 and 13 meters away from it, or the other way round.
    let camera = ["--eye", "3,0,10", "--target", "3,0,0", "--fovy", "60", "--size", "64x48", "--background", "none"];
    let depth = ["render", "shader-ball", "--mode", "depth", "--set", "view.range=auto", "--set", "view.msaa=1"];
    run(path, &[&depth[..], &camera[..], &["--turntable", "4", "--out", "spin.png"]].concat()).expect(0, &[]);
    let mut brightness = [1, 2, 3, 4].map(|number| {
        let frame = open_image(&path.join(format!("spin.{number:04}.png"))).into_rgba8();
        let covered: Vec<f64> =
            frame.pixels().filter(|pixel| pixel[3] == 255).map(|pixel| f64::from(pixel[0])).collect();
        assert!(covered.len() > 20, "the model covers {} pixels in frame {number}", covered.len());
        covered.iter().sum::<f64>() / covered.len() as f64
    });
    brightness.sort_by(f64::total_cmp);
    let [near, middle, _, far] = brightness;
    assert!(near + 40.0 < middle && middle + 40.0 < far, "{brightness:?}");
}

#[test]
fn a_video_has_the_size_and_the_times_that_were_asked_for() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let args = ["--turntable", "7", "--fps", "2.5", "--size", "65x47"];
    render(path, &[&args[..], &["--out", "spin.mp4"]].concat()).expect(0, &[]);
    render(path, &["--turntable", "7", "--size", "65x47", "--out", "spin.png"]).expect(0, &[]);
    let video = Video::read(&std::fs::read(path.join("spin.mp4")).unwrap());
    // 4:2:0 needs even sides: the last column and row are there twice.
    assert_eq!(video.size, (66, 48));
    assert_eq!(video.times, [0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4]);
    assert!((video.duration - 2.8).abs() < 1e-6, "{} s", video.duration);
    assert_eq!(video.keyframes, [true, false, false, false, false, true, false], "every two seconds");
    assert!(video.starts_fast, "a browser shows it while it loads");
    // ITU-T H.273: primaries of BT.709, transfer of sRGB, matrix of BT.709, limited range.
    assert_eq!(video.colors, *b"nclx\0\x01\0\x0d\0\x01\0");
    for (index, frame) in video.frames.iter().enumerate() {
        let picture = open_image(&path.join(format!("spin.{:04}.png", index + 1)));
        let apart = distance(&halved(&DynamicImage::from(frame.clone())), &halved(&picture));
        assert!(apart < 2.0, "frame {index} differs by {apart}");
        for (outer, inner) in [((65, 20), (64, 20)), ((20, 47), (20, 46))] {
            let luma = |(x, y)| DynamicImage::from(frame.clone()).into_luma8().get_pixel(x, y)[0];
            let (last, before) = (luma(outer), luma(inner));
            assert!(last.abs_diff(before) < 8, "{last} beside {before}");
        }
    }
    // What the video replaces is gone whole, and nothing else is left.
    std::fs::write(path.join("spin.mp4"), "old").unwrap();
    render(path, &["--turntable", "2", "--size", "12x12", "--out", "spin.mp4"])
        .expect(1, &["cannot write spin.mp4: an MP4 has 16 to 3840 pixels a side, and at most 2160 on the shorter"]);
    assert_eq!(std::fs::read(path.join("spin.mp4")).unwrap(), b"old");
    assert_eq!(std::fs::read_dir(path).unwrap().count(), 8);
}

#[test]
fn a_sheet_shows_each_value_of_settings_and_parameters() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    let sweeps = ["--sweep", "NDF=GGX,Beckmann", "--sweep", "material.roughness=0.2..0.8/3", "--tile", "64x48"];
    render(path, &[&sweeps[..], &["--page", "light", "--out", "sheet.png"]].concat()).expect(0, &[]);
    let sheet = open_image(&path.join("sheet.png"));
    let mut legends = Vec::new();
    // A row for each distribution, a column for each roughness.
    assert_eq!((sheet.width(), sheet.height()), (8 + 3 * 72, 8 + 2 * (48 + 22 + 8)));
    assert_eq!(sheet.get_pixel(2, 2).0, [255; 4]);
    for (row, ndf) in ["GGX", "Beckmann"].into_iter().enumerate() {
        for (column, roughness) in ["0.2", "0.5", "0.8"].into_iter().enumerate() {
            let (ndf, roughness) = (format!("NDF={ndf}"), format!("material.roughness={roughness}"));
            let sets = ["--set", &ndf, "--set", "material.override=roughness", "--set", &roughness];
            render(path, &[&sets[..], &["--size", "64x48", "--out", "one.png"]].concat()).expect(0, &[]);
            let (x, y) = (8 + column as u32 * 72, 8 + row as u32 * 78);
            let tile = sheet.view(x, y, 64, 48).to_image();
            assert!(tile == open_image(&path.join("one.png")).into_rgba8(), "{ndf} {roughness} differs in the sheet");
            // The legend, dark on the light page. Though the pictures are narrow, each tells its values.
            let legend = sheet.view(x, y + 48, 64, 22).to_image();
            assert!(legend.pixels().any(|pixel| pixel[0] < 100));
            assert!(!legends.contains(&legend), "{ndf} {roughness} has the legend of another picture");
            legends.push(legend);
        }
    }
    render(path, &["--sweep", "view.tonmap=aces", "--out", "a.png"]).expect(2, &["Did you mean `view.tonemap`?"]);
    render(path, &["--sweep", "NDF=GGX,Bekmann", "--out", "a.png"]).expect(2, &["Did you mean `Beckmann`?"]);
    render(path, &["--sweep", "camera.eye", "--out", "a.png"]).expect(2, &["camera.eye needs values"]);
    assert!(!path.join("a.png").exists());
}

#[test]
fn what_cannot_be_written_is_told_before_any_work() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    render(path, &["--turntable", "4", "--out", "a.webm"])
        .expect(2, &["a video must end in .mp4", "ffmpeg -i a.%04d.png a.webm"]);
    render(path, &["--turntable", "0", "--out", "a.gif"]).expect(2, &["0"]);
    render(path, &["--sheet", "all", "--out", "a.exr"]).expect(2, &["must end in .png"]);
    render(path, &["--sheet", "metalic", "--out", "a.png"]).expect(2, &["Did you mean `metallic`?"]);
    // Options that would change nothing.
    for of_sheet in [["--sheet", "d"], ["--sweep", "NDF"]] {
        render(path, &[&of_sheet[..], &["--size", "64x48", "--out", "a.png"]].concat())
            .expect(2, &["--tile is the size of each picture"]);
    }
    render(path, &["--tile", "64x48", "--out", "a.png"]).expect(2, &["--size is that of a single one"]);
    render(path, &["--page", "light", "--out", "a.png"]).expect(2, &["--page is for the page of --sheet"]);
    render(path, &["--turn", "light", "--out", "a.gif"]).expect(2, &["--turntable <N>"]);
    assert_eq!(std::fs::read_dir(path).unwrap().count(), 0);
}
