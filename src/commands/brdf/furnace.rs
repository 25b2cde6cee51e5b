//! `specula brdf furnace`: the directional albedo of a surface by roughness and angle.

use serde_json::json;
use specula::measure::{Claim, Grid, Surface};
use specula::report::{Heat, Lines, Series};
use specula::settings::ShaderValue;
use specula::shader::Constant;

use super::options::{Opened, Options, SurfaceOptions, listed, short, title};
use crate::commands::{Failure, print_json};

/// Largest albedo that counts as energy-conserving: the estimate has an error of up to 0.005.
const MOST: f64 = 1.005;
const GRID: Grid = Grid { rows: 20, roughness: (0.05, 1.0), columns: 18, theta: (0.0, 85.0), samples: 2048 };
/// A coarse grid, just fine enough to detect whether a choice changes the albedo.
const COARSE: Grid = Grid { rows: 4, roughness: (0.1, 1.0), columns: 4, theta: (0.0, 84.0), samples: 64 };

/// Options of `brdf furnace`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    surface: SurfaceOptions,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Options,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let opened = Opened::new(&args.options)?;
    let surface = Surface { base_color: args.surface.base_color, metallic: args.surface.metallic.unwrap_or(1.0) };
    let albedo: Vec<[f64; 3]> = opened.meter.furnace(surface, GRID)?.into_iter().map(|a| a.map(f64::from)).collect();
    let mut without = Vec::new();
    for (constant, chosen) in opened.unclaimed(Claim::Conserves) {
        if has_part(&opened, constant, surface)? {
            without.push((constant, chosen));
        }
    }
    let (min, max) = extremes(&albedo);
    let conserves = max <= MOST;
    if args.json {
        print_rows(&albedo, min, max, without.is_empty());
    } else {
        print_table(&albedo, surface);
        out!("\nmin {min:.4}  max {max:.4}");
        match (without.as_slice(), conserves) {
            ([], true) => out!("claims to conserve energy, and does: no albedo is above {MOST}"),
            ([], false) => out!("claims to conserve energy, but does not"),
            (without, true) => {
                out!("does not claim to conserve energy ({}), but does for this surface", listed(without))
            }
            (without, false) => out!("does not claim to conserve energy ({}), and does not", listed(without)),
        }
    }
    let broken = without.is_empty() && !conserves;
    let verdict = match (without.as_slice(), conserves) {
        ([], true) => format!("Conserves energy: no albedo is above {MOST}."),
        ([], false) => format!("Claims to conserve energy, but reflects up to {max:.4} of the light that arrives."),
        (without, _) => format!("Does not claim to conserve energy ({}): {min:.4} to {max:.4}.", listed(without)),
    };
    opened.report(&args.options, "White furnace", |report| {
        report.verdict(!broken, &verdict);
        report.note(&format!(
            "{}. Directional albedo, the largest channel: the part of white light from everywhere that the surface reflects. 1 loses nothing.",
            title(surface)
        ));
        report.lines(&lines(&albedo));
        report.heat(&heat(&albedo));
    })?;
    opened.close()?;
    if broken {
        let found = if max.is_nan() { "a value that is not a number".to_owned() } else { format!("up to {max:.4}") };
        return Err(Failure::Input(format!(
            "furnace: this combination claims to conserve energy, but its largest albedo is {found}; at most {MOST} is \
             expected. Correct the formula, or remove the choice from `conserves=` in brdf/models.glsl"
        )));
    }
    Ok(())
}

/// Whether an unclaimed choice changes the albedo of this surface. The diffuse model, for example, does not change that of
/// a metal.
fn has_part(opened: &Opened, constant: &Constant, surface: Surface) -> Result<bool, Failure> {
    let Some(other) = Claim::Conserves.of(constant).and_then(|names| names.first()) else { return Ok(true) };
    let mut settings = opened.settings.clone();
    settings.shader.insert(constant.name.clone(), ShaderValue::Name(other.clone()));
    let chosen = opened.meter.furnace(surface, COARSE)?;
    let claiming = opened.meter.with(&settings)?.furnace(surface, COARSE)?;
    // Drivers may reorder sums when other code changes. 1e-4 is far above the rounding errors of that.
    let differs = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-4 || a.is_nan() != b.is_nan();
    Ok(chosen.as_flattened().iter().zip(claiming.as_flattened()).any(differs))
}

/// Smallest and largest value; NaN when any value is NaN.
pub fn extremes(albedo: &[[f64; 3]]) -> (f64, f64) {
    let values = || albedo.as_flattened().iter().copied();
    let with = |pick: fn(f64, f64) -> f64| {
        values().reduce(|a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { pick(a, b) }).unwrap_or(f64::NAN)
    };
    (with(f64::min), with(f64::max))
}

/// The largest channels, row by row.
fn largest(albedo: &[[f64; 3]]) -> Vec<f64> {
    albedo.iter().map(|[r, g, b]| r.max(*g).max(*b)).collect()
}

/// Albedo over the angle for a few rows.
fn lines(albedo: &[[f64; 3]]) -> Lines {
    let values = largest(albedo);
    let rows = (0..GRID.rows).step_by(4).chain([GRID.rows - 1]);
    let series = |row: u32| {
        let first = (row * GRID.columns) as usize;
        let cells = (0..GRID.columns).zip(&values[first..first + GRID.columns as usize]);
        let points = cells.map(|(column, value)| (GRID.theta_of(column), *value)).collect();
        Series { name: format!("roughness {:.2}", GRID.roughness_of(row)), points }
    };
    Lines {
        title: "Albedo over the angle".to_owned(),
        x: "angle to the normal, degrees".to_owned(),
        y: "albedo".to_owned(),
        series: rows.map(series).collect(),
        least: 0.1,
    }
}

fn heat(albedo: &[[f64; 3]]) -> Heat {
    Heat {
        title: "Albedo by roughness and angle: blue loses light, red adds some".to_owned(),
        axes: ["roughness".to_owned(), "degrees".to_owned()],
        rows: (0..GRID.rows).map(|row| format!("{:.2}", GRID.roughness_of(row))).collect(),
        columns: (0..GRID.columns).map(|column| format!("{:.0}", GRID.theta_of(column))).collect(),
        values: largest(albedo),
        middle: 1.0,
        span: 0.2,
    }
}

fn print_rows(albedo: &[[f64; 3]], min: f64, max: f64, claims: bool) {
    let cells = (0..GRID.rows).flat_map(|row| (0..GRID.columns).map(move |column| (row, column)));
    let row = |((row, column), albedo): ((u32, u32), &[f64; 3])| {
        json!({ "roughness": GRID.roughness_of(row), "cos_theta": GRID.theta_of(column).to_radians().cos(),
            "albedo": albedo })
    };
    let rows: Vec<_> = cells.zip(albedo).map(row).collect();
    print_json(&json!({ "rows": rows, "min": min, "max": max, "claims_conservation": claims }));
}

fn print_table(albedo: &[[f64; 3]], surface: Surface) {
    let base_color = short(surface.base_color).map(|c| c.to_string()).join(" ");
    out!("Albedo (largest channel) of base color {base_color}, metallic {}", surface.metallic);
    out!("Rows: roughness. Columns: angle to the normal in degrees\n");
    let angles = (0..GRID.columns).map(|column| format!("{:>6}", GRID.theta_of(column))).collect::<String>();
    out!("     {angles}");
    for (row, cells) in (0..).zip(albedo.chunks(GRID.columns as usize)) {
        let largest = cells.iter().map(|[r, g, b]| format!(" {:.3}", r.max(*g).max(*b)));
        out!("{:.2} {}", GRID.roughness_of(row), largest.collect::<String>());
    }
}
