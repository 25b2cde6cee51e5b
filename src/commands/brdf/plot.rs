//! `specula brdf plot`: plots the lobes of the chosen models, and the albedo over the angle.

use std::path::PathBuf;

use specula::measure::{BrdfMeter, Claim, Grid, Lobe, Surface, choices, extremes};
use specula::report::{Lines, Series, Tile};

use super::canvas::{Anchor, Canvas, Ink, pen};
use super::options::{Opened, Options, SurfaceOptions, title, unit};
use super::plot_axes::{Chart, HalfDisk, TEXT, draw_legend};
use crate::commands::Failure;
use crate::commands::common::check_out;
use crate::commands::common::parse::number;

const WIDTH: f32 = 1600.0;
const MARGIN: f32 = 56.0;
const HEADER: f32 = 184.0;
const CHART: f32 = 340.0;

const DIFFUSE: Ink = Ink(224, 108, 32, 255);
const SPECULAR: Ink = Ink(36, 104, 214, 255);
const MULTIPLE: Ink = Ink(34, 150, 92, 255);
const SUM: Ink = Ink(40, 44, 52, 255);
const SUM_FILL: Ink = Ink(40, 44, 52, 22);

/// One column per eighth of a degree, since the lobe at the smallest roughness is half a degree wide.
const LOBE_COLUMNS: u32 = 1441;
const ALBEDO_COLUMNS: u32 = 90;
const ALBEDO_SAMPLES: u32 = 1024;

/// Options of `brdf plot`.
#[derive(clap::Args)]
#[command(after_help = "Without --metallic, a dielectric and a metal are drawn.")]
pub struct Args {
    /// PNG to write
    #[arg(long, short, value_name = "FILE.png", default_value = "lobes.png")]
    out: PathBuf,
    /// Angle of the light in degrees from the normal, 0 to 89
    #[arg(long, value_name = "DEG", default_value = "45", allow_negative_numbers = true, value_parser = |t: &str| number(t, 0.0, 89.0))]
    angle: f32,
    /// One to six values of roughness, 0 to 1
    #[arg(long, value_name = "R,R,..", value_delimiter = ',', default_value = "0.2,0.4,0.6,0.8", allow_hyphen_values = true, value_parser = unit)]
    roughness: Vec<f32>,
    #[command(flatten)]
    surface: SurfaceOptions,
    #[command(flatten)]
    options: Options,
}

/// The measured lobes and albedo of one surface.
struct MeasuredLobes {
    surface: Surface,
    /// For each roughness, [`LOBE_COLUMNS`] lobes.
    lobes: Vec<Vec<Lobe>>,
    /// For each roughness, the albedo's largest channel over the angle.
    albedo: Vec<Vec<f32>>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    if args.out.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        let message = format!("cannot write {}: the file of a plot must end in .png", args.out.display());
        return Err(Failure::Usage(message));
    }
    check_out(&args.out)?;
    if args.roughness.len() > 6 {
        let found = args.roughness.len();
        return Err(Failure::Usage(format!("--roughness takes at most 6 values; found {found}")));
    }
    let opened = Opened::new(&args.options)?;
    let surfaces = args.surface.surfaces(&[0.0, 1.0]);
    let measured = surfaces.into_iter().map(|s| measure(&opened.meter, s, args)).collect::<Result<Vec<_>, _>>()?;
    let canvas = draw(&opened, args, &measured).map_err(Failure::Input)?;
    canvas.save(&args.out).map_err(Failure::Input)?;
    let picture = Tile { name: "Lobes and albedo".to_owned(), note: String::new(), image: canvas.image() };
    let mut drawn = Ok(());
    opened.report(&args.options, "Lobes and albedo", |report| {
        drawn = report.gallery(&[picture], Some(1));
        measured.iter().for_each(|measured| report.lines(&albedo_lines(&args.roughness, measured)));
    })?;
    drawn.map_err(Failure::Input)?;
    opened.close()
}

/// The albedo over the angle, a line for each roughness.
fn albedo_lines(roughness: &[f32], measured: &MeasuredLobes) -> Lines {
    let step = 89.0 / f64::from(ALBEDO_COLUMNS - 1);
    let points = |albedo: &[f32]| (0..).zip(albedo).map(|(i, a)| (step * f64::from(i), f64::from(*a))).collect();
    let series = |(roughness, albedo): (&f32, &Vec<f32>)| Series {
        name: format!("roughness {roughness}"),
        points: points(albedo),
    };
    Lines {
        title: format!("Albedo of the {}", lower(&title(measured.surface))),
        x: "angle to the normal, degrees".to_owned(),
        y: "albedo, largest channel".to_owned(),
        series: roughness.iter().zip(&measured.albedo).map(series).collect(),
        least: 0.1,
    }
}

fn measure(meter: &BrdfMeter, surface: Surface, args: &Args) -> Result<MeasuredLobes, Failure> {
    let mut measured = MeasuredLobes { surface, lobes: Vec::new(), albedo: Vec::new() };
    for roughness in &args.roughness {
        let roughness = (*roughness, *roughness);
        let lobes = Grid { rows: 1, roughness, columns: LOBE_COLUMNS, theta: (args.angle, 0.0), samples: 1 };
        measured.lobes.push(meter.lobes(surface, lobes)?);
        let albedo = Grid { columns: ALBEDO_COLUMNS, theta: (0.0, 89.0), samples: ALBEDO_SAMPLES, ..lobes };
        measured.albedo.push(meter.furnace(surface, albedo)?.into_iter().map(largest).collect());
    }
    Ok(measured)
}

fn largest([r, g, b]: [f32; 3]) -> f32 {
    r.max(g).max(b)
}

fn sum(lobe: &Lobe) -> [f32; 3] {
    std::array::from_fn(|c| lobe.diffuse[c] + lobe.specular[c] + lobe.multiple[c])
}

fn draw(opened: &Opened, args: &Args, measured: &[MeasuredLobes]) -> Result<Canvas, String> {
    let panels = args.roughness.len() as f32;
    let panel = (WIDTH - 2.0 * MARGIN) / panels;
    let radius = (panel * 0.5 - 26.0).min(240.0);
    let row = radius + 142.0;
    let height = HEADER + row * measured.len() as f32 + CHART + 150.0;
    let mut canvas = Canvas::new(WIDTH as u32, height as u32)?;
    draw_header(&mut canvas, opened, args);

    let all = measured.iter().flat_map(|m| m.lobes.iter().flatten()).map(|lobe| largest(sum(lobe)));
    let most = all.filter(|value| value.is_finite()).fold(1.0, f32::max);
    let most = most * 1.15;
    for (index, measured) in measured.iter().enumerate() {
        let top = HEADER + row * index as f32;
        canvas.text((MARGIN, top + 22.0), 21.0, Anchor::Left, TEXT, &title(measured.surface));
        for (column, (roughness, lobes)) in args.roughness.iter().zip(&measured.lobes).enumerate() {
            let center = (MARGIN + panel * (column as f32 + 0.5), top + 72.0 + radius);
            let disk = HalfDisk { center, radius, most };
            draw_lobes(&mut canvas, disk, lobes, args.angle);
            let label = format!("roughness {roughness}");
            canvas.text((center.0, center.1 + 38.0), 16.0, Anchor::Center, TEXT, &label);
        }
    }
    let top = HEADER + row * measured.len() as f32 + 30.0;
    let each = (WIDTH - 2.0 * MARGIN) / measured.len() as f32;
    for (index, measured) in measured.iter().enumerate() {
        let left = MARGIN + each * index as f32;
        draw_albedo(&mut canvas, (left, top), each - 60.0, &args.roughness, measured);
    }
    Ok(canvas)
}

fn draw_header(canvas: &mut Canvas, opened: &Opened, args: &Args) {
    let heading = format!("Light from {}°, reflected into all directions of its plane", args.angle);
    canvas.text((MARGIN, 54.0), 30.0, Anchor::Left, TEXT, &heading);
    let is_model = |claim: Claim, constant| claim.of(constant).is_some();
    let models = choices(&opened.settings, &opened.shaders).into_iter();
    let models = models.filter(|(c, _)| is_model(Claim::Conserves, c) || is_model(Claim::Reciprocal, c));
    let mut at = (MARGIN, 86.0);
    for (constant, chosen) in models {
        let text = format!("{}: {chosen}", constant.label);
        let width = canvas.width_of(&text, 16.0);
        if at.0 + width > WIDTH - MARGIN {
            at = (MARGIN, at.1 + 23.0);
        }
        canvas.text(at, 16.0, Anchor::Left, TEXT, &text);
        at.0 += width + 26.0;
    }
    let entries = [("diffuse", DIFFUSE), ("specular", SPECULAR), ("multiple scattering", MULTIPLE), ("sum", SUM)];
    draw_legend(canvas, (MARGIN, 148.0), &entries);
    let scale = format!("f cos in 1/sr; rings at powers of ten, linear below {}", HalfDisk::BEND);
    canvas.text((WIDTH - MARGIN, 148.0), 16.0, Anchor::Right, TEXT, &scale);
}

fn draw_lobes(canvas: &mut Canvas, disk: HalfDisk, lobes: &[Lobe], angle_deg: f32) {
    disk.draw_axes(canvas);
    let count = lobes.len() as f32;
    let outline = |value: &dyn Fn(&Lobe) -> [f32; 3]| -> Vec<(f32, f32)> {
        let angle = |index: usize| std::f32::consts::PI * ((index as f32 + 0.5) / count - 0.5);
        let rim = lobes.iter().enumerate().map(|(index, lobe)| disk.at(angle(index), largest(value(lobe))));
        [disk.center].into_iter().chain(rim).chain([disk.center]).collect()
    };
    let whole = outline(&sum);
    canvas.area(&whole, SUM_FILL);
    canvas.line(&whole, pen(SUM, 1.4));
    canvas.line(&outline(&|lobe| lobe.diffuse), pen(DIFFUSE, 2.2));
    canvas.line(&outline(&|lobe| lobe.multiple), pen(MULTIPLE, 2.2));
    canvas.line(&outline(&|lobe| lobe.specular), pen(SPECULAR, 2.2));
    disk.draw_light(canvas, angle_deg);
}

fn draw_albedo(canvas: &mut Canvas, (left, top): (f32, f32), width: f32, roughness: &[f32], measured: &MeasuredLobes) {
    canvas.text((left, top), 21.0, Anchor::Left, TEXT, &format!("Albedo of the {}", lower(&title(measured.surface))));
    let values: Vec<[f64; 3]> = measured.albedo.iter().flatten().map(|a| [f64::from(*a); 3]).collect();
    let (_, max) = extremes(&values);
    let chart = Chart {
        origin: (left + 40.0, top + 22.0),
        size: (width - 40.0 - 150.0, CHART),
        most: if max.is_finite() { (max as f32 * 1.02).max(1.1) } else { 1.1 },
    };
    chart.draw_axes(canvas);
    let count = roughness.len().max(2) - 1;
    for (index, (roughness, albedo)) in roughness.iter().zip(&measured.albedo).enumerate() {
        let ink = ramp(index as f32 / count as f32);
        let step = 89.0 / (ALBEDO_COLUMNS - 1) as f32;
        let points: Vec<_> = albedo.iter().enumerate().map(|(i, a)| chart.at(i as f32 * step, *a)).collect();
        canvas.line(&points, pen(ink, 2.2));
        let x = chart.origin.0 + chart.size.0 + 16.0;
        let y = chart.origin.1 + 20.0 + 26.0 * index as f32;
        canvas.line(&[(x, y - 5.0), (x + 24.0, y - 5.0)], pen(ink, 3.5));
        canvas.text((x + 32.0, y), 16.0, Anchor::Left, TEXT, &format!("roughness {roughness}"));
    }
}

fn lower(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// A color ramp from dark blue through red to amber.
fn ramp(part: f32) -> Ink {
    let stops = [(46.0, 44.0, 130.0), (176.0, 50.0, 110.0), (236.0, 150.0, 30.0)];
    let at = part.clamp(0.0, 1.0) * 2.0;
    let (from, to) = if at < 1.0 { (stops[0], stops[1]) } else { (stops[1], stops[2]) };
    let t = if at < 1.0 { at } else { at - 1.0 };
    let mix = |a: f32, b: f32| (a + (b - a) * t) as u8;
    Ink(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2), 255)
}
