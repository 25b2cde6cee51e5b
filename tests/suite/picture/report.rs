//! Pages of HTML about results, in a browser.

use std::fs;

use image::{Rgba, RgbaImage};
use serde_json::json;

use crate::support::browser::Browser;
use crate::support::process::run;

/// The key Shift in the WebDriver protocol.
const SHIFT: &str = "\u{e008}";
const ESCAPE: &str = "\u{e00c}";

/// Whether a page has loaded nothing but what is in its file, and its scripts have no error.
fn is_self_contained(browser: &Browser) -> bool {
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
    // The view of the largest channel is that of the difference: both channels differ by all there is.
    browser.press("6");
    assert_eq!(color(&browser.picture(), 0.5), [255; 4]);
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
}

#[test]
fn measurements_of_the_brdf_have_pages() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    run(here, &["brdf", "normalization", "--report", "d.html"]).expect(0, &[]);
    let browser = Browser::open(&here.join("d.html"), (1000, 800));
    assert_eq!(
        browser.run("return document.querySelectorAll('svg path.line').length;"),
        json!(2),
        "a line and its legend"
    );
    assert_eq!(browser.run("return document.querySelectorAll('tbody tr').length > 20;"), json!(true));
    let verdict = browser.run("return document.querySelector('.verdict.good').textContent;");
    assert!(verdict.as_str().unwrap().starts_with("D is normalized"), "{verdict}");
    assert!(is_self_contained(&browser));
    run(here, &["brdf", "furnace", "--set", "NDF=GGX", "--report", "furnace.html"]).expect(0, &[]);
    let page = fs::read_to_string(here.join("furnace.html")).unwrap();
    assert_eq!(page.matches("<td style=\"background:rgba(").count(), 20 * 18);
    run(here, &["brdf", "furnace", "--report", "furnace.png"]).expect(2, &["must end in .html"]);
    run(here, &["render", "--report", "page.html"]).expect(2, &["--sheet"]);
}
