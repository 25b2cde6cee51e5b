//! Pages of HTML about results, in a browser.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage, Rgba, Rgba32FImage, RgbaImage};
use serde_json::json;

use crate::support::browser::Browser;
use crate::support::process::run;

/// The key Shift in the WebDriver protocol.
const SHIFT: &str = "\u{e008}";
const ESCAPE: &str = "\u{e00c}";

/// Whether a page has loaded nothing but what is in its file, and its scripts have no error.
pub(super) fn is_self_contained(browser: &Browser) -> bool {
    let script = "return performance.getEntriesByType('resource').map(entry => entry.name).filter(name => !name.startsWith('data:'));";
    browser.run(script) == json!([]) && browser.log() == json!([])
}

#[test]
fn the_border_between_two_pictures_moves_with_the_mouse() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (name, color) in [("a.png", [0, 0, 255, 255]), ("b.png", [255, 0, 0, 255])] {
        RgbaImage::from_pixel(64, 40, Rgba(color)).save(here.join(name)).unwrap();
    }
    run(here, &["diff", "a.png", "b.png", "--report", "page.html"]).expect(1, &[]);
    let browser = Browser::open(&here.join("page.html"), (1200, 900));
    let [left, top, width, height] = browser.area("#view");
    assert!(width > 300.0, "the picture is enlarged: {width}");
    let middle = top + height / 2.0;
    let at = |part: f64| [left + width * part, middle];
    let color = |picture: &RgbaImage, part: f64| {
        let [x, y] = at(part);
        picture.get_pixel(x as u32, y as u32 - 20).0
    };
    let (blue, red) = ([0, 0, 255, 255], [255, 0, 0, 255]);
    let picture = browser.picture();
    assert_eq!([0.1, 0.4, 0.6, 0.9].map(|part| color(&picture, part)), [blue, blue, red, red]);
    browser.drag(at(0.5), at(0.25));
    let picture = browser.picture();
    assert_eq!([0.1, 0.4, 0.6, 0.9].map(|part| color(&picture, part)), [blue, red, red, red]);
    assert!(is_self_contained(&browser));
}

/// Two pictures of 64x40 pixels, and the page that compares them: they are alike in the left half, differ a little in the right one, and most
/// at [`WORST`].
fn pair_with_a_worst_pixel(here: &Path) -> Browser {
    let colors = |left: [u8; 3], right: [u8; 3], worst: [u8; 3]| {
        RgbImage::from_fn(64, 40, |x, y| {
            Rgb(if [x, y] == WORST {
                worst
            } else if x < 32 {
                left
            } else {
                right
            })
        })
    };
    colors(LEFT, [90, 60, 30], [20, 40, 60]).save(here.join("a.png")).unwrap();
    colors(LEFT, [80, 64, 30], [30, 240, 55]).save(here.join("b.png")).unwrap();
    run(here, &["diff", "a.png", "b.png", "--out", "map.png", "--report", "page.html"]).expect(1, &[]);
    Browser::open(&here.join("page.html"), (1200, 900))
}

const WORST: [u32; 2] = [50, 10];
const LEFT: [u8; 3] = [10, 100, 200];

/// The color of a pixel of the pictures on the screen.
fn color_of(browser: &Browser, screen: &RgbaImage, [x, y]: [u32; 2]) -> [u8; 3] {
    let [left, top, width, height] = browser.area("#view");
    let at =
        |pixel: u32, start: f64, length: f64, pixels: f64| (start + (f64::from(pixel) + 0.5) * length / pixels) as u32;
    let [r, g, b, _] = screen.get_pixel(at(x, left, width, 64.0), at(y, top, height, 40.0)).0;
    [r, g, b]
}

#[test]
fn each_view_of_a_pair_shows_its_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let browser = pair_with_a_worst_pixel(folder.path());
    let picture = |name: &str| image::open(folder.path().join(name)).unwrap().to_rgb8();
    let (a, b, map) = (picture("a.png"), picture("b.png"), picture("map.png"));
    let places = [[10, 20], [40, 20], [60, 35], WORST];
    let shown = || {
        let screen = browser.picture();
        places.map(|at| color_of(&browser, &screen, at))
    };
    let of = |picture: &RgbImage| places.map(|[x, y]| picture.get_pixel(x, y).0);
    let difference = |at: usize| [0, 1, 2].map(|channel| of(&a)[at][channel].abs_diff(of(&b)[at][channel]));
    let differences = [0, 1, 2, 3].map(difference);
    let [left, top, width, height] = browser.area("#modes button[data-mode=a]");
    browser.click([left + width / 2.0, top + height / 2.0], None);
    assert_eq!(shown(), of(&a), "A");
    browser.press(" ");
    assert_eq!(shown(), of(&a), "the space bar presses the button that has the focus");
    browser.run("document.activeElement.blur();");
    for expected in [&b, &a, &b] {
        browser.press(" ");
        assert_eq!(shown(), of(expected), "flip");
    }
    for (key, expected) in [("2", of(&a)), ("3", of(&b)), ("4", differences), ("5", of(&map))] {
        browser.press(key);
        assert_eq!(shown(), expected, "view {key}");
    }
    browser.press("6");
    let largest = differences.map(|channels| [*channels.iter().max().unwrap(); 3]);
    assert_eq!(shown(), largest, "the largest channel");
    assert_eq!(largest, [[0; 3], [10; 3], [10; 3], [200; 3]]);
    // The gain brightens both views of differences, and no other.
    let [left, top, width, height] = browser.area("#gain");
    browser.click([left + width / 4.0, top + height / 2.0], None);
    assert_eq!(browser.run("return document.querySelector('#gain-text').textContent;"), json!("×4"));
    let brighter = |colors: [[u8; 3]; 4]| colors.map(|color| color.map(|value| value.saturating_mul(4)));
    assert_eq!(shown(), brighter(largest), "gain");
    browser.press("4");
    assert_eq!(shown(), brighter(differences), "gain");
    browser.press("5");
    assert_eq!(shown(), of(&map), "FLIP has no gain");
    browser.press("1");
    assert_eq!(shown(), [LEFT, of(&b)[1], of(&b)[2], of(&b)[3]], "wipe");
    assert!(is_self_contained(&browser));
}

#[test]
fn the_worst_pixel_is_found_and_framed() {
    let folder = tempfile::tempdir().unwrap();
    let browser = pair_with_a_worst_pixel(folder.path());
    let text = || browser.run("return document.querySelector('#pixel').textContent;");
    let before = browser.area("#view");
    browser.press("z");
    let [left, top, width, height] = browser.area("#stage");
    let frame = browser.area("#worst");
    assert_eq!([frame[2], frame[3]], [24.0; 2], "a pixel is 24 of the screen wide");
    let (center, middle) = (left + width / 2.0, top + height / 2.0);
    let is_centered = (frame[0] + 12.0 - center).abs() <= 1.5 && (frame[1] + 12.0 - middle).abs() <= 1.5;
    assert!(is_centered, "{frame:?} on a stage around {center}, {middle}");
    // The values of both, of 0 to 1, as in the files.
    let values = |color: [u8; 3]| color.map(|value| f64::from(value) / 255.0);
    let told = text().as_str().unwrap().to_owned();
    let (place, both) = told.split_once(": A ").unwrap();
    assert_eq!(place, format!("{}, {}", WORST[0], WORST[1]));
    let (of_a, of_b) = both.split_once(" · B ").unwrap();
    for (told, expected) in [(of_a, [20, 40, 60]), (of_b, [30, 240, 55])] {
        let told: Vec<f64> = told.split(' ').map(|value| value.parse().unwrap()).collect();
        let is_near = |(told, expected): (&f64, f64)| (told - expected).abs() < 1e-4;
        assert!(told.len() == 4 && told.iter().zip(values(expected)).all(is_near) && told[3] == 1.0, "{told:?}");
    }
    for (key, worst, beside) in [("2", [20, 40, 60], [90, 60, 30]), ("3", [30, 240, 55], [80, 64, 30])] {
        browser.press(key);
        let screen = browser.picture();
        assert_eq!(browser.area("#worst"), frame, "another view moves the pictures");
        let [x, y] = WORST;
        assert_eq!(color_of(&browser, &screen, WORST), worst);
        // Each pixel is sharp up to its frame.
        let corner = screen.get_pixel(frame[0] as u32 + 2, frame[1] as u32 + 2).0;
        assert_eq!(corner[..3], worst);
        for beside_it in [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]] {
            assert_eq!(color_of(&browser, &screen, beside_it), beside);
        }
        let edge = screen.get_pixel(frame[0] as u32 - 1, middle as u32).0;
        assert_eq!(edge, [255, 0, 255, 255], "its frame");
    }
    browser.press("0");
    let after = browser.area("#view");
    let is_whole = after[0] >= left && after[1] >= top && after[2] <= width && after[3] <= height;
    assert!(is_whole && after[2] > before[2] * 0.8, "{after:?}, and {before:?} before");
    assert!(is_self_contained(&browser));
}

/// NaN and infinity, which JSON does not know, are values like others: their pixel is the worst one.
#[test]
fn the_worst_pixel_may_have_no_number() {
    for (value, name) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (f32::NEG_INFINITY, "-inf")] {
        let folder = tempfile::tempdir().unwrap();
        let here = folder.path();
        for (file, red) in [("a.exr", 0.5), ("b.exr", value)] {
            let color = |x, y| Rgba([if [x, y] == WORST { red } else { 2.0 }, 1.0, 0.25, 1.0]);
            Rgba32FImage::from_fn(64, 40, color).save(here.join(file)).unwrap();
        }
        run(here, &["diff", "a.exr", "b.exr", "--report", "page.html"]).expect(1, &[]);
        let browser = Browser::open(&here.join("page.html"), (1200, 900));
        browser.press("z");
        let told = browser.run("return document.querySelector('#pixel').textContent;");
        assert_eq!(told, json!(format!("50, 10: A 0.5 1 0.25 1 · B {name} 1 0.25 1")));
        let ([left, _, width, _], [at, _, pixel, _]) = (browser.area("#stage"), browser.area("#worst"));
        let center = left + width / 2.0;
        assert!(pixel == 24.0 && (at + 12.0 - center).abs() <= 1.5, "{name}: {pixel} at {at}, around {center}");
        let numbers = browser.run("return document.querySelector('#numbers').textContent;");
        assert!(numbers.as_str().unwrap().starts_with("RMSE ∞ · largest difference of a channel ∞"), "{numbers}");
        assert!(is_self_contained(&browser));
    }
}

/// A pair that fails a limit stands above one that passes, however large its mean is. Of those that fail, the one that is farthest beyond a
/// limit comes first, as FLIP and RMSE have no other common measure.
#[test]
fn pairs_that_fail_come_first_the_farthest_beyond_a_limit_at_the_top() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    ["a", "b"].iter().for_each(|side| fs::create_dir(here.join(side)).unwrap());
    let png = |name: &str, differs: &dyn Fn(u32, u32) -> u8| {
        for (side, scale) in [("a", 0), ("b", 1)] {
            let color = |x, y| Rgb([100 + scale * differs(x, y), 100, 100]);
            RgbImage::from_fn(64, 40, color).save(here.join(side).join(name)).unwrap();
        }
    };
    png("even.png", &|_, _| 20);
    png("spot.png", &|x, y| if [x, y] == WORST { 130 } else { 0 });
    png("same.png", &|_, _| 0);
    RgbImage::new(4, 4).save(here.join("a/lone.png")).unwrap();
    let flip = |name: &str| {
        let [a, b] = ["a", "b"].map(|side| format!("{side}/{name}"));
        run(here, &["diff", &a, &b, "--json"]).json()["pictures"][0]["error"].as_f64().unwrap()
    };
    let even = flip("even.png");
    assert!(even > 2.0 * flip("spot.png"), "{even}");
    // An RMSE of half as much again; alpha does not differ.
    let step = (1.5 * even / 0.75_f64.sqrt()) as f32;
    for (side, value) in [("a", 0.5), ("b", 0.5 + step)] {
        let image = Rgba32FImage::from_pixel(64, 40, Rgba([value, value, value, 1.0]));
        image.save(here.join(side).join("raw.exr")).unwrap();
    }
    let order = |limits: &[&str]| {
        let told = run(here, &[&["diff", "a", "b", "--report", "page.html"], limits].concat());
        told.expect(1, &[]);
        let browser = Browser::open(&here.join("page.html"), (1200, 900));
        let names = "return [...document.querySelectorAll('#pairs b')].map(name => name.textContent);";
        let names: Vec<String> = serde_json::from_value(browser.run(names)).unwrap();
        let printed = told.stdout.lines().filter_map(|line| line.split_whitespace().nth(1));
        assert_eq!(printed.collect::<Vec<_>>(), names, "the lines have another order than the page");
        names
    };
    let limits = ["--max", &(1.2 * even).to_string(), "--max-channel", "0.2"];
    assert_eq!(order(&limits), ["lone.png", "spot.png", "raw.exr", "even.png", "same.png"]);
    // A limit of 0 has no multiples.
    assert_eq!(order(&[]), ["lone.png", "even.png", "spot.png", "raw.exr", "same.png"]);
}

/// The table of a page has the settings in which two pictures of Specula differ, and no others.
#[test]
fn pictures_of_specula_bring_their_settings() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let scene = ["render", "sphere-grid", "--env", "none", "--size", "64x36"];
    let looks = [["--set", "view.ev=1", "--set", "NDF=GGX"], ["--set", "view.ev=2", "--set", "NDF=Beckmann"]];
    for (name, look) in [("a.png", looks[0]), ("b.png", looks[1]), ("again.png", looks[0])] {
        run(here, &[&scene[..], &look[..], &["--out", name]].concat()).expect(0, &[]);
    }
    run(here, &["diff", "a.png", "b.png", "--report", "page.html"]).expect(1, &[]);
    let browser = Browser::open(&here.join("page.html"), (1200, 900));
    let rows = "return [...document.querySelectorAll('#settings tr')].map(row => [...row.children].map(cell => cell.textContent));";
    let expected = json!([["setting", "A", "B"], ["shader.NDF", "\"GGX\"", "\"Beckmann\""], ["view.ev", "1.0", "2.0"]]);
    assert_eq!(browser.run(rows), expected);
    let texts = browser.run("return [...document.querySelectorAll('#settings pre')].map(text => text.textContent);");
    let texts: [String; 2] = serde_json::from_value(texts).unwrap();
    for (text, ev) in texts.iter().zip(["ev = 1.0", "ev = 2.0"]) {
        assert!(text.contains(ev), "{text}");
    }
    assert!(is_self_contained(&browser));
    run(here, &["diff", "a.png", "again.png", "--report", "same.html"]).expect(0, &[]);
    let browser = Browser::open(&here.join("same.html"), (1200, 900));
    let told = browser.run("return document.querySelector('#settings > p').textContent;");
    assert_eq!((told, browser.run(rows)), (json!("Both pictures have the same settings."), json!([])));
}

/// Where pictures of different sizes cannot be compared, views of their differences are not offered, and nothing of the pair before stays.
#[test]
fn a_pair_without_a_comparison_offers_no_maps() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let save = |name: &str, size: u32, color: [u8; 3]| {
        fs::create_dir_all(here.join(name).parent().unwrap()).unwrap();
        RgbImage::from_pixel(size, 40, Rgb(color)).save(here.join(name)).unwrap();
    };
    save("a/one.png", 64, [0, 0, 255]);
    save("b/one.png", 64, [255, 0, 0]);
    save("a/two.png", 64, [0, 0, 255]);
    save("b/two.png", 32, [255, 0, 0]);
    run(here, &["diff", "a", "b", "--report", "page.html"]).expect(1, &[]);
    let browser = Browser::open(&here.join("page.html"), (1200, 900));
    let state = || {
        browser.run(
            "const pressed = document.querySelector('#modes [aria-pressed=true]'); \
            const disabled = [...document.querySelectorAll('#modes button, #to-worst')].filter(button => button.disabled); \
            return [document.querySelector('#name').textContent, pressed.dataset.mode, disabled.length, \
                document.querySelector('#pixel').textContent !== ''];",
        )
    };
    assert_eq!(state(), json!(["two.png", "wipe", 3, false]));
    browser.press("6");
    assert_eq!(state(), json!(["two.png", "wipe", 3, false]));
    browser.press("\u{e015}"); // down
    browser.press("z");
    browser.press("6");
    assert_eq!(state(), json!(["one.png", "channel", 0, true]));
    browser.press("\u{e013}"); // up
    assert_eq!(state(), json!(["two.png", "wipe", 3, false]));
    assert!(is_self_contained(&browser));
}

#[test]
fn two_pictures_of_a_sheet_are_compared_with_a_border() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let args =
        ["sphere-grid", "--env", "none", "--sheet", "base-color,roughness", "--tile", "96x64", "--out", "sheet.png"];
    run(here, &[&["render"], &args[..], &["--report", "sheet.html"]].concat()).expect(0, &[]);
    let browser = Browser::open(&here.join("sheet.html"), (1200, 900));
    assert_eq!(
        browser.run("return [...document.querySelectorAll('figcaption')].map(of => of.firstChild.data.trim());"),
        json!(["Base color", "Roughness"])
    );
    // The same pixels as on the sheet.
    let sheet = image::open(here.join("sheet.png")).unwrap().to_rgba8();
    let script = "const image = document.querySelectorAll('.gallery img')[1], canvas = document.createElement('canvas'); \
        [canvas.width, canvas.height] = [96, 64]; const of = canvas.getContext('2d'); of.drawImage(image, 0, 0); \
        return [...of.getImageData(48, 32, 1, 1).data].slice(0, 3);";
    let second = sheet.get_pixel(8 + 96 + 8 + 48, 8 + 32).0;
    assert_eq!(browser.run(script), json!(second[..3]));
    let center = |index: usize| {
        let [left, top, width, height] = browser.area(&format!(".gallery figure:nth-child({index}) button"));
        [left + width / 2.0, top + height / 2.0]
    };
    browser.click(center(1), Some(SHIFT));
    browser.click(center(2), None);
    assert_eq!(browser.run("return document.querySelector('dialog').open;"), json!(true));
    assert_eq!(browser.run("return document.querySelector('#names').textContent;"), json!("Base color  |  Roughness"));
    let [left, top, width, height] = browser.area("#stage");
    let middle = top + height / 2.0;
    browser.drag([left + width / 2.0, middle], [left + width * 0.75, middle]);
    let border = browser.run("return Number(document.querySelector('#wipe').value);").as_f64().unwrap();
    assert!((border - 75.0).abs() <= 1.0, "{border}");
    let clip = browser.run("return document.querySelector('#b').style.clipPath;");
    assert!(clip.as_str().unwrap().contains("75") || clip.as_str().unwrap().contains("74."), "{clip}");
    browser.press(ESCAPE);
    assert_eq!(browser.run("return document.querySelector('dialog').open;"), json!(false));
    assert!(is_self_contained(&browser));
    run(here, &["render", "--report", "page.html"]).expect(2, &["--sheet"]);
}
