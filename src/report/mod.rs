//! A page of HTML about a result: all in one file, without a network. It is plain HTML and SVG, and readable without its script, which
//! enlarges pictures and compares two of them.

mod chart;
mod encode;
mod gallery;

use std::fmt::Write as _;

pub use chart::{Heat, Lines, Series};
use encode::escaped;
pub use encode::{png_uri, uri_of};
pub use gallery::Tile;

/// The page without its contents, and its script.
const PAGE: &str = include_str!("page.html");
const SCRIPT: &str = include_str!("page.js");

/// A page, part by part.
#[derive(Clone, Debug)]
pub struct Report {
    title: String,
    body: String,
}

impl Report {
    /// A page with a heading.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), body: String::new() }
    }

    /// A sentence that says what was found, and whether that is good.
    pub fn verdict(&mut self, is_good: bool, text: &str) {
        let class = if is_good { "good" } else { "bad" };
        self.add(format_args!("<p class=\"verdict {class}\">{}</p>", escaped(text)));
    }

    /// A sentence about how to read what follows.
    pub fn note(&mut self, text: &str) {
        self.add(format_args!("<p class=\"quiet\">{}</p>", escaped(text)));
    }

    /// A table whose first row is its head.
    pub fn table(&mut self, caption: &str, head: &[&str], rows: &[Vec<String>]) {
        let cells = |tag: &str, row: &mut dyn Iterator<Item = &str>| -> String {
            row.map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
        };
        let head = cells("th", &mut head.iter().copied());
        let row = |row: &Vec<String>| format!("<tr>{}</tr>", cells("td", &mut row.iter().map(String::as_str)));
        let rows: String = rows.iter().map(row).collect();
        let caption = escaped(caption);
        self.add(format_args!(
            "<table><caption>{caption}</caption><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        ));
    }

    /// A table of numbers in colors.
    pub fn heat(&mut self, heat: &Heat) {
        self.add(format_args!("{}", heat.html()));
    }

    /// A chart of lines.
    pub fn lines(&mut self, lines: &Lines) {
        self.add(format_args!("{}", lines.html()));
    }

    /// Pictures with their names, of which one can be enlarged and two compared. `columns` in a row, as far as the page has room.
    ///
    /// # Errors
    /// A message if a picture cannot be encoded.
    pub fn gallery(&mut self, tiles: &[Tile], columns: Option<u32>) -> Result<(), String> {
        let html = gallery::html(tiles, columns)?;
        self.add(format_args!("{html}"));
        Ok(())
    }

    /// The page.
    pub fn html(&self) -> String {
        let title = escaped(&self.title);
        let mut page = String::new();
        let mut rest = PAGE;
        for (mark, text) in [("%TITLE%", &*title), ("%TITLE%", &*title), ("%BODY%", &*self.body), ("%SCRIPT%", SCRIPT)]
        {
            let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
            page.extend([before, text]);
            rest = after;
        }
        page + rest
    }

    fn add(&mut self, part: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{part}");
    }
}

#[cfg(test)]
mod tests {
    use image::{Rgba, RgbaImage};

    use super::*;

    #[test]
    fn a_page_holds_all_of_it_and_names_no_place_in_the_network() {
        let mut report = Report::new("Albedo of <b>");
        report.verdict(false, "does not conserve energy & more");
        report.table("Values", &["roughness", "integral"], &[vec!["0.05".into(), "<script>".into()]]);
        report.lines(&Lines {
            title: "Integral".into(),
            x: "roughness".into(),
            y: "1".into(),
            series: vec![Series { name: "D".into(), points: vec![(0.0, 1.0), (0.5, f64::NAN), (1.0, 0.9)] }],
            least: 0.0,
        });
        let image = RgbaImage::from_pixel(4, 2, Rgba([200, 0, 0, 255]));
        let tile = |name: &str| Tile { name: name.into(), note: "0 to 1".into(), image: image.clone() };
        report.gallery(&[tile("one"), tile("two")], Some(2)).unwrap();
        let page = report.html();
        assert!(page.contains("<title>Albedo of &lt;b&gt;</title>") && !page.contains("%BODY%"));
        assert!(page.contains("energy &amp; more") && page.contains("<td>&lt;script&gt;</td>"), "{page}");
        assert_eq!(page.matches("data:image/png;base64,").count(), 2);
        let places: Vec<&str> = page.split("://").skip(1).collect();
        assert!(places.is_empty(), "{places:?}");
        assert_eq!(page.matches("<script").count(), 1, "only its own script");
    }
}
