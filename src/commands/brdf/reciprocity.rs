//! `specula brdf reciprocity`: checks that f(l, v) = f(v, l).

use serde_json::json;
use specula::measure::{Claim, Grid, Surface, Worst};

use super::options::{Opened, Options, SurfaceOptions, direction, listed};
use crate::commands::{Failure, print_json};

/// Largest relative difference that rounding explains.
const MOST: f32 = 1e-4;
const GRID: Grid = Grid { rows: 20, roughness: (0.05, 1.0), columns: 16, theta: (0.0, 85.0), samples: 1024 };

/// Options of `brdf reciprocity`.
#[derive(clap::Args)]
#[command(after_help = "Without --metallic, a dielectric and a metal are measured.")]
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
    let mut worst = (Worst::default(), 0, 0.0);
    for surface in args.surface.surfaces(&[0.0, 1.0]) {
        let found = worst_of(&opened, surface)?;
        if found.0.error >= worst.0.error {
            worst = found;
        }
    }
    let (pair, row, metallic) = worst;
    let roughness = GRID.roughness_of(row);
    let without = opened.unclaimed(Claim::Reciprocal);
    let claims = without.is_empty();
    let holds = pair.error < MOST;
    if args.json {
        print_json(
            &json!({ "error": pair.error, "roughness": roughness, "metallic": metallic, "l": pair.l, "v": pair.v,
                "limit": MOST, "claims_reciprocity": claims, "reciprocal": holds }),
        );
    } else {
        out!("largest difference of f(l, v) and f(v, l): {:.3e} of their mean", pair.error);
        out!("at roughness {roughness}, metallic {metallic}");
        out!("  l  {}\n  v  {}", direction(pair.l), direction(pair.v));
        match (claims, holds) {
            (true, true) => out!("claims to be reciprocal, and is: less than {MOST:e}"),
            (true, false) => out!("claims to be reciprocal, but is not: at least {MOST:e}"),
            (false, true) => out!("does not claim to be reciprocal ({}), but is for these surfaces", listed(&without)),
            (false, false) => out!("does not claim to be reciprocal ({}), and is not", listed(&without)),
        }
    }
    let verdict = match (claims, holds) {
        (_, true) => "Reciprocal: f(l, v) = f(v, l), as far as floats tell.".to_owned(),
        (true, false) => "Claims to be reciprocal, but is not.".to_owned(),
        (false, false) => format!("Does not claim to be reciprocal ({}), and is not.", listed(&without)),
    };
    opened.report(&args.options, "Reciprocity", |report| {
        report.verdict(holds || !claims, &verdict);
        let rows = [
            ("largest difference, of the mean", format!("{:.3e}", pair.error)),
            ("allowed", format!("{MOST:e}")),
            ("roughness", roughness.to_string()),
            ("metallic", metallic.to_string()),
            ("l", direction(pair.l)),
            ("v", direction(pair.v)),
        ];
        let rows: Vec<Vec<String>> = rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
        report.table("The worst pair of directions", &["", "value"], &rows);
    })?;
    opened.close()?;
    if claims && !holds {
        let message = format!(
            "reciprocity: this combination claims f(l, v) = f(v, l), but they differ by {:.3e} of their mean at \
             roughness {roughness}; expected less than {MOST:e}. Correct the formula, or remove the choice from \
             `reciprocal=` in brdf/models.glsl",
            pair.error
        );
        return Err(Failure::Input(message));
    }
    Ok(())
}

/// The pair of directions with the largest difference, its row in the grid, and the metallic of the surface.
fn worst_of(opened: &Opened, surface: Surface) -> Result<(Worst, u32, f32), Failure> {
    let cells = opened.meter.reciprocity(surface, GRID)?;
    let rows = (0..).flat_map(|row: u32| std::iter::repeat_n(row, GRID.columns as usize));
    let worst = cells.into_iter().zip(rows).max_by(|(a, _), (b, _)| a.error.total_cmp(&b.error));
    let (worst, row) = worst.unwrap_or_default();
    Ok((worst, row, surface.metallic))
}
