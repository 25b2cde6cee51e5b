//! Every choice of models under light from all directions, and an edit of each of their functions, against one-bounce random
//! paths, which call the functions directly.
//!
//! The fixed part covers each row in one environment, and those rows with sampled reflections that the split sum gets most
//! wrong. `SPECULA_LONG=1` runs all rows in every built-in environment at every roughness, by split sum and by samples, and
//! prints the worst of each.

use crate::support::{Session, assert_validated, glb, is_long, load, ready, settings};
use specula::render::Capture;

const METAL: f64 = 1.0;
const DIELECTRIC: f64 = 0.0;

/// Each choice, the material that shows it with the roughness of the fixed part, and an edit of its function: the file
/// in `brdf/`, a part of its text, and the replacement.
const TABLE: &str = "\
NDF=GGX | metal 0.4 | ndf | return a2 / (PI | return 0.5 * a2 / (PI
NDF=GGX | metal 0.3 | ndf | float a2 = alpha * alpha; | float a2 = alpha;
NDF=Beckmann | metal 0.5 | ndf | return exp(-dot(slope | return 0.5 * exp(-dot(slope
MASKING_SHADOWING=HeightCorrelated | metal 0.8 | visibility | return 0.5 / (n_dot_v | return 0.25 / (n_dot_v
MASKING_SHADOWING=Separable | metal 0.8 | visibility | return 1.0 / ((n_dot_l | return 0.5 / ((n_dot_l
MASKING_SHADOWING=Schlick | metal 0.8 | visibility | return 0.25 / ((n_dot_l | return 0.125 / ((n_dot_l
FRESNEL_METAL=Schlick | metal 0.3 | fresnel | return f0 + (f90 - f0) * | return 0.5 * f0 + 0.5 * (f90 - f0) *
FRESNEL_METAL=Conductor | metal 0.4 | fresnel | return saturate(0.5 * f_s | return saturate(0.25 * f_s
FRESNEL_METAL=F82 | metal 0.4 | fresnel | return saturate(f_schlick(f0 | return 0.5 * saturate(f_schlick(f0
FRESNEL_DIELECTRIC=Schlick | dielectric 0.3 | fresnel | (f90 - f0) * pow5(1.0 - c); | (f90 - f0) * (1.0 - c);
FRESNEL_DIELECTRIC=Exact | dielectric 0.3 | fresnel | return 0.5 * root_s | return root_s
DIFFUSE=Lambert | dielectric 0.5 | diffuse | return albedo / PI; } | return 0.5 * albedo / PI; }
DIFFUSE=Burley | dielectric 1.0 | diffuse | return (1.0 + rise * pow5 | return 0.5 * (1.0 + rise * pow5
DIFFUSE=RenormalizedBurley | dielectric 1.0 | diffuse | return scale * (1.0 + rise | return 0.5 * scale * (1.0 + rise
DIFFUSE=OrenNayar | dielectric 1.0 | diffuse | return (single + multi) / PI; | return 0.5 * (single + multi) / PI;
DIFFUSE=CallOfDuty | dielectric 1.0 | diffuse | return (lobe + bump) / PI; | return 0.5 * (lobe + bump) / PI;";

/// A line of the table.
struct Row {
    choice: &'static str,
    metallic: f64,
    /// Roughness in the fixed part.
    roughness: f64,
    file: &'static str,
    from: &'static str,
    to: &'static str,
}

impl Row {
    fn parse(line: &'static str) -> Self {
        let cells: Vec<&str> = line.split(" | ").collect();
        let [choice, material, file, from, to] = cells[..] else { panic!("five cells, not `{line}`") };
        let (material, roughness) = material.split_once(' ').unwrap();
        let metallic = if material == "metal" { METAL } else { DIELECTRIC };
        Self { choice, metallic, roughness: roughness.parse().unwrap(), file, from, to }
    }
}

/// Side of the squares in which light is compared, pixels: the noise of the paths is small in their sums.
const SQUARE: usize = 8;

/// The light of the pixels on the model, summed over squares of the picture.
fn squares(capture: &Capture) -> Vec<f64> {
    let columns = (capture.width as usize).div_ceil(SQUARE);
    let mut sums = vec![0.0; columns * (capture.height as usize).div_ceil(SQUARE)];
    for (i, pixel) in capture.raw.iter().enumerate().filter(|(_, pixel)| pixel[3] == 1.0) {
        let (x, y) = (i % capture.width as usize, i / capture.width as usize);
        sums[y / SQUARE * columns + x / SQUARE] += pixel[..3].iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    }
    sums
}

/// The sum of the differences' sizes.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The picture and the paths.
type Both = [Vec<f64>; 2];

impl Row {
    /// The picture and the paths under each environment, at its roughness.
    fn light(&self, session: &mut Session, places: &[(&str, f64)]) -> Vec<Both> {
        let (constant, _) = self.choice.split_once('=').unwrap();
        session.set(self.choice);
        session.set(&format!("material.metallic={}", self.metallic));
        // A dielectric's Fresnel term is seen best without a diffuse lobe.
        let is_black = self.metallic == DIELECTRIC && self.file == "fresnel";
        session.set(&format!("material.base_color={}", if is_black { "[0, 0, 0]" } else { "[0.7, 0.7, 0.7]" }));
        let light = |(environment, roughness): &(&str, f64)| {
            session.set(&format!("environment.name={environment}"));
            session.set(&format!("material.roughness={roughness}"));
            ["final", "monte-carlo"].map(|mode| squares(&session.mode(mode)))
        };
        let all = places.iter().map(light).collect();
        session.headless.settings_mut().shader.remove(constant);
        all
    }
}

/// The largest error of a choice, as a part of the light, and of an edit, as a part of the change in the paths.
const MOST: [f64; 2] = [0.04, 0.15];
/// The same at every roughness under a studio or a sun, where the split sum is off: it takes D, V and F for v = n. Most for V and
/// for the width of D at roughness 0.5, and for the F of a black dielectric from there on. In a furnace it is exact.
const SPLIT_SUM: [f64; 2] = [0.17, 0.28];

/// The same for sampled reflections, at every roughness. Of the choices, Oren-Nayar is furthest off: its diffuse lobe stays a
/// product of albedo and irradiance.
const SAMPLED: [f64; 2] = [0.05, 0.15];

/// The largest of some errors, with its place.
struct Worst {
    error: f64,
    place: String,
}

impl Worst {
    fn take(&mut self, error: f64, place: String) {
        if error.abs() > self.error.abs() {
            *self = Self { error, place };
        }
    }
}

/// Every built-in environment at every roughness.
fn all_places() -> Vec<(&'static str, f64)> {
    let all = ["studio", "sky", "furnace"].map(|name| [0.2, 0.5, 1.0].map(|r| (name, r)));
    all.into_iter().flatten().collect()
}

/// Compares rows of the table, each in some places, for a choice of reflections. `most`: the largest errors of a choice and of an
/// edit in an environment.
fn compare(reflections: &str, rows: &[(Row, Vec<(&str, f64)>)], most: impl Fn(&str) -> [f64; 2]) {
    let fixed = ["lights.source=none", "view.msaa=1", "view.background=none", "material.enabled=true"];
    let model = load(&glb::model(&glb::sphere(32, 64), &glb::gray()));
    let mut session = Session::new(model, settings(&fixed));
    session.set("view.frames=24");
    session.set(&format!("REFLECTION_SAMPLES={reflections}"));
    let mut failures = Vec::new();
    let unedited: Vec<_> = rows.iter().map(|(row, places)| row.light(&mut session, places)).collect();
    let mut edited: Option<(String, String)> = None;
    for ((row, places), before) in rows.iter().zip(unedited) {
        // One reload takes the last edit back and makes the next.
        if let Some((file, text)) = edited.take() {
            session.tree.write(&file, &text);
            edited = Some((file, String::new()));
        }
        let file = format!("brdf/{}.glsl", row.file);
        let text = session.tree.read(&file);
        session.tree.write(&file, &session.tree.edited(&file, row.from, row.to));
        let last = edited.map_or_else(|| file.clone(), |(last, _)| last);
        ready(&session.changed(&[&file, &last]));
        edited = Some((file, text));
        let after = row.light(&mut session, places);

        let mut of_choice = Worst { error: 0.0, place: String::new() };
        let mut of_edit = Worst { error: 0.0, place: String::new() };
        let (mut count, mut is_within) = (0, true);
        for (((name, roughness), before), after) in places.iter().zip(before).zip(after) {
            let place = format!("{name}, roughness {roughness}");
            let light: f64 = before[1].iter().sum();
            let choice = before[0].iter().sum::<f64>() / light - 1.0;
            let [picture, paths] = [0, 1].map(|i| difference(&after[i], &before[i]));
            let size: f64 = paths.iter().map(|x| x.abs()).sum();
            let edit = distance(&picture, &paths) / size;
            let is_told = size > 0.05 * light;
            let change = 100.0 * size / light;
            println!(
                "{reflections}: {} -> {}: {place}: choice {:.1} %, edit changes {change:.1} %, {:.1} % of that wrong",
                row.choice,
                row.to,
                choice * 100.0,
                edit * 100.0
            );
            of_choice.take(choice, place.clone());
            if is_told {
                of_edit.take(edit, place);
                count += 1;
            }
            let [most_of_choice, most_of_edit] = most(name);
            is_within = is_within && choice.abs() <= most_of_choice && (!is_told || edit <= most_of_edit);
        }
        let [choice, edit] =
            [&of_choice, &of_edit].map(|worst| format!("{:.1} % ({})", worst.error * 100.0, worst.place));
        println!("ROW {reflections} {} | {choice} | {edit}, {count} of {} told", row.choice, places.len());
        if !is_within || count == 0 {
            failures.push(format!("{} -> {}: choice {choice}, edit {edit}, {count} told", row.choice, row.to));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert_validated();
}

#[test]
fn every_choice_and_every_edit_reaches_the_environment() {
    let rows: Vec<_> = TABLE
        .lines()
        .map(Row::parse)
        .map(|row| {
            let places = if is_long() { all_places() } else { vec![("studio", row.roughness)] };
            (row, places)
        })
        .collect();
    compare("Prefiltered", &rows, |name| if is_long() && name != "furnace" { SPLIT_SUM } else { MOST });
}

/// Rows that were most wrong under a sun when the split sum took its lobe for v = n.
const WORST_UNDER_A_SUN: [(&str, f64); 4] = [
    ("float a2 = alpha;", 0.5),
    ("return 0.25 / (n_dot_v", 0.2),
    ("return 0.25 / (n_dot_v", 0.5),
    ("(f90 - f0) * (1.0 - c);", 1.0),
];

#[test]
fn every_edit_reaches_the_sun() {
    let places_of = |row: &Row| -> Vec<_> {
        WORST_UNDER_A_SUN.iter().filter(|(to, _)| *to == row.to).map(|(_, roughness)| ("sky", *roughness)).collect()
    };
    let rows = TABLE.lines().map(Row::parse).map(|row| {
        let places = places_of(&row);
        (row, places)
    });
    let rows: Vec<_> = rows.filter(|(_, places)| !places.is_empty()).collect();
    assert_eq!(rows.len(), 3);
    compare("Prefiltered", &rows, |_| MOST);
}

/// The part of the table that the split sum gets most wrong, by its edits: the width of D, V, and F of a black dielectric.
const WORST_OF_SPLIT_SUM: [(&str, (&str, f64)); 3] = [
    ("float a2 = alpha;", ("sky", 0.5)),
    ("return 0.25 / (n_dot_v", ("studio", 0.5)),
    ("(f90 - f0) * (1.0 - c);", ("sky", 1.0)),
];

#[test]
fn every_edit_reaches_sampled_reflections() {
    let places_of = |row: &Row| {
        let worst = WORST_OF_SPLIT_SUM.iter().find(|(to, _)| *to == row.to);
        if is_long() { Some(all_places()) } else { worst.map(|(_, place)| vec![*place]) }
    };
    let rows = TABLE.lines().map(Row::parse);
    let rows: Vec<_> = rows.filter_map(|row| places_of(&row).map(|places| (row, places))).collect();
    assert!(rows.len() >= WORST_OF_SPLIT_SUM.len());
    compare("Sampled128", &rows, |_| SAMPLED);
}
