//! `specula brdf normalization`: checks that the integral of D NoH is 1, as for every distribution of microfacets.

use serde_json::json;
use specula::measure::Grid;
use specula::report::{Lines, Series};

use super::options::{Opened, Options};
use crate::commands::{Failure, print_json};

const MOST: f64 = 0.005;
const GRID: Grid = Grid { rows: 20, roughness: (0.05, 1.0), columns: 1, theta: (0.0, 0.0), samples: 4096 };

/// Options of `brdf normalization`.
#[derive(clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: Options,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let opened = Opened::new(&args.options)?;
    let integrals: Vec<f64> = opened.meter.normalization(GRID)?.into_iter().map(f64::from).collect();
    let rows: Vec<(f64, f64)> = (0..).map(|row| GRID.roughness_of(row)).zip(integrals).collect();
    let off = |(_, integral): &(f64, f64)| if integral.is_nan() { f64::INFINITY } else { (integral - 1.0).abs() };
    let worst = rows.iter().copied().max_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_default();
    let holds = off(&worst) <= MOST;
    if args.json {
        let list: Vec<_> = rows.iter().map(|(r, integral)| json!({ "roughness": r, "integral": integral })).collect();
        let largest = json!({ "roughness": worst.0, "error": off(&worst) });
        print_json(&json!({ "rows": list, "worst": largest, "limit": MOST, "normalized": holds }));
    } else {
        out!("roughness  integral of D NoH");
        for (roughness, integral) in &rows {
            out!("{roughness:9.2}  {integral:.5}");
        }
        let verdict = if holds { "D is normalized" } else { "D is not normalized" };
        out!("\n{verdict}: largest error {:.3} %, at roughness {}", off(&worst) * 100.0, worst.0);
    }
    let verdict = if holds { "D is normalized" } else { "D is not normalized" };
    let verdict = format!("{verdict}: largest error {:.3} %, at roughness {}.", off(&worst) * 100.0, worst.0);
    opened.report(&args.options, "Normalization of D", |report| {
        report.verdict(holds, &verdict);
        report.note("The integral of D NoH over the hemisphere is 1 for every distribution of microfacets.");
        report.lines(&Lines {
            title: "Integral of D NoH over roughness".to_owned(),
            x: "roughness".to_owned(),
            y: "integral".to_owned(),
            series: vec![Series { name: "D NoH".to_owned(), points: rows.clone() }],
            least: 0.1,
        });
        let row = |(roughness, integral): &(f64, f64)| vec![format!("{roughness:.2}"), format!("{integral:.5}")];
        report.table("Values", &["roughness", "integral"], &rows.iter().map(row).collect::<Vec<_>>());
    })?;
    opened.close()?;
    if !holds {
        let (roughness, integral) = worst;
        return Err(Failure::Input(format!(
            "normalization: the integral of D NoH is {integral:.4} at roughness {roughness}, expected 1 within {} %. Check D in brdf/ndf.glsl",
            MOST * 100.0
        )));
    }
    Ok(())
}
