//! `specula info --stages`: the stages of the picture, with their words, times and what the driver tells of them.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use specula::headless::{Headless, HeadlessError};
use specula::message::escape;
use specula::pipeline::{Outcome, StageReport, all_statistics, figures};
use specula::scene::Model;
use specula::shader::Change;

use crate::commands::Failure;
use crate::commands::common::{Common, check_validation, compiler};

/// The picture's size does not matter: nothing is drawn.
const SIZE: (u32, u32) = (64, 64);

/// Reports on the shader stages.
pub(super) struct Stages {
    reports: BTreeMap<String, StageReport>,
    /// The names of the stages for people.
    names: BTreeMap<String, String>,
    /// Stages of the picture.
    on_screen: BTreeSet<String>,
    /// Time to compile each stage, milliseconds.
    compile_ms: BTreeMap<String, f64>,
    /// Time of all pipelines, milliseconds.
    pipeline_ms: f64,
    /// Whether the driver reports statistics, and how long the query took in milliseconds.
    tells: bool,
    ask_ms: f64,
}

impl Stages {
    /// Compiles the tree, and builds the frame's pipelines without those of earlier runs.
    pub(super) fn new(common: &Common, model: Model) -> Result<Self, Failure> {
        let (settings, source) = (common.settings()?, common.source()?);
        let gpu = common.gpu_without_pipelines()?;
        let mut headless = Headless::open(&gpu, &compiler()?, source, model, settings, SIZE)?;
        let reload = headless.update(Change::All);
        if let Outcome::Failed(diagnostics) = reload.outcome {
            return Err(HeadlessError::Shaders(diagnostics).into());
        }
        headless.check_settings()?;
        let ask_ms = headless.ask_driver()?;
        let shaders = headless.shaders();
        let names = shaders.stages.keys().map(|stage| (stage.clone(), shaders.name_of(stage).to_owned())).collect();
        let stages = Self {
            reports: headless.stages()?,
            names,
            on_screen: headless.frame_state()?.pipelines.stages(),
            compile_ms: reload.report.stages.into_iter().collect(),
            pipeline_ms: reload.pipeline_ms,
            tells: gpu.tells_statistics(),
            ask_ms,
        };
        drop(headless);
        check_validation(&gpu)?;
        Ok(stages)
    }

    /// The JSON report. The driver's statistics are null where it reports none.
    pub(super) fn json(&self) -> Value {
        let of = |(stage, report): (&String, &StageReport)| {
            json!({
                "stage": stage,
                "on_screen": self.on_screen.contains(stage),
                "compile_ms": self.compile_ms.get(stage),
                "compiled_words": report.compiled,
                "pipelines": report.pipelines,
                "largest": report.largest,
            })
        };
        json!({
            "stages": self.reports.iter().map(of).collect::<Vec<_>>(),
            "pipeline_ms": self.pipeline_ms,
            "driver_tells": self.tells,
            "ask_ms": self.tells.then_some(self.ask_ms),
        })
    }

    /// The table: the stages of the frame, and below it the number of other stages.
    pub(super) fn print(&self) {
        out!("\nStages of the picture");
        let shown = || self.reports.iter().filter(|(stage, _)| self.on_screen.contains(*stage));
        let name = |stage: &String| self.names.get(stage).map_or("", String::as_str);
        let width = shown().map(|(stage, _)| name(stage).len()).max().unwrap_or_default();
        for (stage, report) in shown() {
            let numbers: Vec<String> = figures(report, None).iter().map(|figure| figure.text()).collect();
            let compile = self.compile_ms.get(stage).map(|ms| format!("compiled in {ms:.0} ms"));
            let driver = report.largest.as_ref().map(|largest| match largest.driver_ms {
                Some(ms) => format!("driver {ms:.0} ms"),
                None => format!("pipeline {:.0} ms", largest.pipeline_ms),
            });
            let all: Vec<String> = numbers.into_iter().chain(compile).chain(driver).collect();
            out!("  {:width$}  {}", name(stage), escape(&all.join(", ")));
            for (name, figures) in all_statistics(report, None) {
                let figures: Vec<String> = figures.iter().map(|figure| figure.text()).collect();
                out!("  {:width$}    {}: {}", "", escape(&name), escape(&figures.join(", ")));
            }
        }
        out!("  and {} stages that this picture does not use", self.reports.len() - shown().count());
        match self.tells {
            true => out!("  pipelines in {:.0} ms; asking the driver took {:.0} ms", self.pipeline_ms, self.ask_ms),
            false => out!(
                "  pipelines in {:.0} ms; this driver tells nothing of its machine code (no \
                 VK_KHR_pipeline_executable_properties)",
                self.pipeline_ms
            ),
        }
    }
}
