//! Pages of HTML about measurements of the BRDF, in a browser: they say what is printed.

use std::fs;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::json;
use tempfile::TempDir;

use super::report::is_self_contained;
use crate::support::browser::Browser;
use crate::support::open_image;
use crate::support::process::run;

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
}

/// Measures, and opens the page about it. Returns what was printed, too.
fn measured(folder: &TempDir, args: &[&str]) -> (String, Browser) {
    let here = folder.path();
    let told = run(here, &[&["brdf"], args, &["--report", "page.html"]].concat());
    told.expect(0, &[]);
    (told.stdout, Browser::open(&here.join("page.html"), (1000, 800)))
}

/// The cells of a table, row by row, without its head.
fn rows_of(browser: &Browser, caption: &str) -> Vec<Vec<String>> {
    let script = format!(
        "const of = [...document.querySelectorAll('table')].find(table => table.caption.textContent === {}); \
        return [...of.tBodies[0].rows].map(row => [...row.cells].map(cell => cell.textContent));",
        json!(caption)
    );
    serde_json::from_value(browser.run(&script)).unwrap()
}

#[test]
fn the_page_about_reciprocity_has_the_worst_pair() {
    let folder = tempfile::tempdir().unwrap();
    let (printed, browser) = measured(&folder, &["reciprocity", "--set", "NDF=Beckmann"]);
    let rows = rows_of(&browser, "The worst pair of directions");
    let value = |name: &str| rows.iter().find(|row| row[0] == name).unwrap()[1].clone();
    let largest = value("largest difference, of the mean");
    assert!(printed.contains(&format!("f(v, l): {largest} of their mean")), "{printed}\n{rows:?}");
    assert!(printed.contains(&format!("at roughness {}, metallic {}\n", value("roughness"), value("metallic"))));
    let directions = ["l", "v"].map(|name| format!("  {name}  {}\n", value(name)));
    assert!(directions.iter().all(|line| printed.contains(line)), "{printed}\n{rows:?}");
    let verdict = browser.run("return document.querySelector('.verdict.good').textContent;");
    assert!(verdict.as_str().unwrap().starts_with("Reciprocal: "), "{verdict}");
    let choices = rows_of(&browser, "Choices of the shader tree");
    assert!(choices.iter().any(|row| row[1] == "Beckmann"), "{choices:?}");
    assert!(is_self_contained(&browser));
}

#[test]
fn the_page_about_the_split_sum_has_its_error_by_roughness() {
    let folder = tempfile::tempdir().unwrap();
    let (printed, browser) = measured(&folder, &["split-sum", "--frames", "2"]);
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let lines: Vec<_> = printed.lines().map(words).filter(|line| line.len() == 5 && line[2] == "%").collect();
    assert_eq!(lines.len(), 10, "{printed}");
    let rows = rows_of(&browser, "Values");
    assert_eq!(rows.iter().map(|row| words(&row.join(" "))).collect::<Vec<_>>(), lines);
    let lines = browser.run("return document.querySelectorAll('svg path.line').length;");
    assert_eq!(lines, json!(4), "bias and rms, and their legend");
    assert!(is_self_contained(&browser));
}

#[test]
fn the_page_about_lobes_has_the_plot_and_a_chart() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["plot", "--roughness", "0.3,0.7", "--metallic", "1", "--out", "lobes.png"];
    let (_, browser) = measured(&folder, &args);
    let uri = browser.run("return document.querySelector('.gallery img').src;");
    let bytes = BASE64_STANDARD.decode(uri.as_str().unwrap().split_once(',').unwrap().1).unwrap();
    let shown = image::load_from_memory(&bytes).unwrap().into_rgba8();
    assert!(shown == open_image(&folder.path().join("lobes.png")).into_rgba8(), "the page has another picture");
    let charts = browser.run("return [...document.querySelectorAll('svg')].map(chart => chart.textContent);");
    let charts: Vec<String> = serde_json::from_value(charts).unwrap();
    assert_eq!(charts.len(), 1, "a chart for each surface");
    assert!(["roughness 0.3", "roughness 0.7"].iter().all(|name| charts[0].contains(name)), "{charts:?}");
    assert!(is_self_contained(&browser));
}
