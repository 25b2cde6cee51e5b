//! `specula bench trace`: the time from a click on a pixel to the values of a file in the panel Source.

use std::time::Instant;

use serde_json::{Value, json};
use specula::headless::{Headless, HeadlessError, TraceRequest};
use specula::pipeline::Outcome;
use specula::shader::{Mode, Source};

use super::context::Bench;
use super::edited::{edited, finish};
use super::folder::{TempFolder, copy_tree};
use super::samples::{ms, summary};
use crate::commands::Failure;
use crate::commands::common::check_mode;

/// Edits the stage that draws the mode before each measurement, so that nothing of its trace is compiled, and times clicks on a file: the first
/// one, one after the preparation that the panel does in the background, and the next one on another pixel.
pub(super) fn trace(bench: &Bench<'_>) -> Result<Value, Failure> {
    let args = bench.args;
    let folder = TempFolder::new()?;
    copy_tree(&args.common.source()?, &folder.0)?;
    let (model, mut settings) = (bench.model()?, args.common.settings()?);
    args.common.fit(&model, &mut settings)?;
    let slug = settings.mode.clone();
    let mut headless = bench.renderer(Source::disk(folder.0.clone()), settings, model)?;
    check_mode(&headless.shaders(), &slug)?;
    let mode = headless.shaders().modes.iter().find(|mode| mode.slug == slug).cloned();
    let mode = mode.ok_or_else(|| Failure::Usage(format!("the shaders have no mode {slug}")))?;
    headless.draw()?;
    let pixels = headless.pixels_of_model()?;
    let (Some(first), Some(other)) = (pixels.first(), pixels.get(1).or(pixels.first())) else {
        return Err(Failure::Input("the model covers no pixel that could be clicked".into()));
    };
    let file = args.file.clone().unwrap_or_else(|| mode.stage.clone());
    let mut clicks = Clicks { headless, folder, mode, file };
    let names = ["cold_ms", "prepare_ms", "prepared_ms", "warm_ms"];
    let mut samples: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    // A driver may keep what an earlier run compiled.
    let run = std::process::id() % 4000 * 2000;
    for sample in bench.samples() {
        clicks.edit(run + 2 * sample + 1)?;
        let cold = clicks.click(*first)?;
        clicks.edit(run + 2 * sample + 2)?;
        let values = [cold, clicks.prepare(*first)?, clicks.click(*first)?, clicks.click(*other)?];
        samples.iter_mut().zip(values).for_each(|(list, value)| list.push(value));
    }
    let table = names.iter().zip(samples).map(|(name, list)| ((*name).to_owned(), summary(list)));
    let mut result = Value::Object(table.collect());
    result["file"] = json!(clicks.file);
    (result["size"], result["mode"]) = (json!([args.common.size().0, args.common.size().1]), json!(slug));
    Ok(result)
}

/// The session whose picture is clicked, and the file that is shown.
struct Clicks {
    headless: Headless,
    folder: TempFolder,
    mode: Mode,
    file: String,
}

impl Clicks {
    /// Saves the stage with another number, and draws the picture.
    fn edit(&mut self, number: u32) -> Result<(), Failure> {
        let path = self.folder.0.join(&self.mode.stage);
        let text = self.headless.reloader().library().source().read(&self.mode.stage.as_str().into());
        let text = text.map_err(|error| Failure::Input(error.to_string()))?;
        let bare: Vec<&str> = text.lines().filter(|line| !line.contains("if (gl_FragCoord.x < -")).collect();
        std::fs::write(&path, edited(&bare.join("\n"), number)).map_err(|error| Failure::Input(error.to_string()))?;
        let change = self.headless.reloader().library().change_of([&path]);
        match self.headless.update(change).outcome {
            Outcome::Ready(_) => {}
            Outcome::Failed(diagnostics) => return Err(Failure::Shaders(diagnostics)),
            Outcome::Unchanged { .. } => {
                return Err(Failure::Input(format!("{} has no `void main() {{` to edit", self.mode.stage)));
            }
        }
        finish(&mut self.headless)?;
        Ok(self.headless.draw()?)
    }

    /// Milliseconds for what is asked about the file at a pixel.
    fn time<T>(
        &mut self,
        at: (u32, u32),
        ask: impl FnOnce(&mut Headless, &TraceRequest<'_>) -> Result<T, HeadlessError>,
    ) -> Result<f64, Failure> {
        let files = [self.file.as_str()];
        let request =
            TraceRequest { at, mode: &self.mode, stage: None, invocation: None, files: &files, is_interactive: true };
        let begin = Instant::now();
        ask(&mut self.headless, &request)?;
        Ok(ms(begin))
    }

    /// Milliseconds until the values of a pixel are known.
    fn click(&mut self, at: (u32, u32)) -> Result<f64, Failure> {
        self.time(at, Headless::trace)
    }

    /// Milliseconds until a click finds what it needs.
    fn prepare(&mut self, at: (u32, u32)) -> Result<f64, Failure> {
        self.time(at, |headless, request| headless.prepare_trace(request, usize::MAX))
    }
}
