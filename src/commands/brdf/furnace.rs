//! `specula brdf furnace`: the directional albedo of a surface by roughness and angle.

use specula::measure::{Furnace, Surface};

use super::furnace_page::fill;
use super::options::{Opened, Options, SurfaceOptions, listed, short};
use crate::commands::{Failure, print_json};

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
    let found = Furnace::measure(&opened.meter, (&*opened.shaders, &opened.settings), surface)?;
    let (max, conserves, claims) = (found.max, found.conserves(), found.without.is_empty());
    if args.json {
        print_json(&found.json());
    } else {
        print_table(&found.albedo, surface);
        out!("\nmin {:.4}  max {max:.4}", found.min);
        match (found.without.as_slice(), conserves) {
            ([], true) => out!("claims to conserve energy, and does: no albedo is above {}", Furnace::MOST),
            ([], false) => out!("claims to conserve energy, but does not"),
            (without, true) => {
                out!("does not claim to conserve energy ({}), but does for this surface", listed(without))
            }
            (without, false) => out!("does not claim to conserve energy ({}), and does not", listed(without)),
        }
    }
    let broken = claims && !conserves;
    opened.report(&args.options, "White furnace", |report| fill(report, &found, surface))?;
    drop(found);
    opened.close()?;
    if broken {
        let found = if max.is_nan() { "a value that is not a number".to_owned() } else { format!("up to {max:.4}") };
        return Err(Failure::Input(format!(
            "furnace: this combination claims to conserve energy, but its largest albedo is {found}; at most {} is \
             expected. Correct the formula, or remove the choice from `conserves=` in brdf/models.glsl",
            Furnace::MOST
        )));
    }
    Ok(())
}

fn print_table(albedo: &[[f64; 3]], surface: Surface) {
    let base_color = short(surface.base_color).map(|c| c.to_string()).join(" ");
    out!("Albedo (largest channel) of base color {base_color}, metallic {}", surface.metallic);
    out!("Rows: roughness. Columns: angle to the normal in degrees\n");
    let angles =
        (0..Furnace::GRID.columns).map(|column| format!("{:>6}", Furnace::GRID.theta_of(column))).collect::<String>();
    out!("     {angles}");
    for (row, cells) in (0..).zip(albedo.chunks(Furnace::GRID.columns as usize)) {
        let largest = cells.iter().map(|[r, g, b]| format!(" {:.3}", r.max(*g).max(*b)));
        out!("{:.2} {}", Furnace::GRID.roughness_of(row), largest.collect::<String>());
    }
}
