//! The page of `specula brdf furnace --report`.

use specula::measure::{Furnace, Surface};
use specula::report::{Heat, Lines, Report, Series};

use super::options::{listed, title};

/// Rows of the grid from one line of the chart to the next.
const STEP: usize = 4;

/// Adds what was found.
pub(super) fn fill(report: &mut Report, found: &Furnace<'_>, surface: Surface) {
    let (min, max) = (found.min, found.max);
    let verdict = match (found.without.as_slice(), found.conserves()) {
        ([], true) => format!("Conserves energy: no albedo is above {}.", Furnace::MOST),
        ([], false) => format!("Claims to conserve energy, but reflects up to {max:.4} of the light that arrives."),
        (without, _) => format!("Does not claim to conserve energy ({}): {min:.4} to {max:.4}.", listed(without)),
    };
    report.verdict(found.conserves() || !found.without.is_empty(), &verdict);
    report.note(&format!(
        "{}. Directional albedo, the largest channel: the part of white light from everywhere that the surface reflects. 1 loses nothing.",
        title(surface)
    ));
    let largest: Vec<f64> = found.albedo.iter().map(|[r, g, b]| r.max(*g).max(*b)).collect();
    report.lines(&lines(&largest));
    report.heat(&heat(largest));
}

/// Albedo over the angle for a few rows.
fn lines(albedo: &[f64]) -> Lines {
    let grid = Furnace::GRID;
    let rows = (0..grid.rows).step_by(STEP).chain([grid.rows - 1]);
    let series = |row: u32| {
        let first = (row * grid.columns) as usize;
        let cells = (0..grid.columns).zip(&albedo[first..first + grid.columns as usize]);
        let points = cells.map(|(column, value)| (grid.theta_of(column), *value)).collect();
        Series { name: format!("roughness {:.2}", grid.roughness_of(row)), points }
    };
    Lines {
        title: "Albedo over the angle".to_owned(),
        x: "angle to the normal, degrees".to_owned(),
        y: "albedo".to_owned(),
        series: rows.map(series).collect(),
        least: 0.1,
    }
}

fn heat(albedo: Vec<f64>) -> Heat {
    let grid = Furnace::GRID;
    Heat {
        title: "Albedo by roughness and angle: blue loses light, red adds some".to_owned(),
        axes: ["roughness".to_owned(), "degrees".to_owned()],
        rows: (0..grid.rows).map(|row| format!("{:.2}", grid.roughness_of(row))).collect(),
        columns: (0..grid.columns).map(|column| format!("{:.0}", grid.theta_of(column))).collect(),
        values: albedo,
        middle: 1.0,
        span: 0.2,
    }
}
