//! How the numbers of a stage have changed since an earlier version of it.

use super::StageReport;
use crate::gpu::{Executable, Statistic};
use crate::message::grouped;

/// A number of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its unit, as in "96 registers", or the driver's name for it.
    pub name: String,
    /// Meaning of the number.
    pub meaning: String,
    /// Its value.
    pub value: f64,
    /// The value in the earlier version, if it has one.
    pub before: Option<f64>,
}

impl Figure {
    /// The difference from the earlier version; `None` if there is none.
    pub fn change(&self) -> Option<f64> {
        self.before.map(|before| self.value - before).filter(|change| *change != 0.0)
    }

    /// The value with its name, as `4,469 words`.
    pub fn text(&self) -> String {
        format!("{} {}", grouped(self.value), self.name)
    }

    /// The change with its sign, as `-212`.
    pub fn change_text(&self) -> Option<String> {
        let sign = |change: f64| if change < 0.0 { '-' } else { '+' };
        self.change().map(|change| format!("{}{}", sign(change), grouped(change.abs())))
    }
}

/// The statistics of a stage in a line: words that the driver got, and its registers, instructions, spills and code size, as far
/// as reported. Spills are left out while there are none.
pub fn figures(now: &StageReport, before: Option<&StageReport>) -> Vec<Figure> {
    let of = |report: Option<&StageReport>| report.and_then(|report| report.largest.clone());
    let before = of(before);
    let Some(now) = of(Some(now)) else {
        let meaning = "Words of SPIR-V as compiled. The picture has no pipeline of this stage".to_owned();
        let value = now.compiled as f64;
        return vec![Figure { name: "words compiled".to_owned(), meaning, value, before: None }];
    };
    let meaning =
        "Words of SPIR-V (4 bytes each) that the driver gets: the stage with the values of its constants, optimized"
            .to_owned();
    let words = Figure {
        name: "words".to_owned(),
        meaning,
        value: now.words as f64,
        before: before.as_ref().map(|before| before.words as f64),
    };
    let earlier = before.and_then(|before| before.executables);
    let told = StatisticKind::ALL.into_iter().filter_map(|kind| {
        let (statistic, value) = kind.of(now.executables.as_deref()?)?;
        let before = earlier.as_deref().and_then(|earlier| kind.of(earlier)).map(|(_, value)| value);
        let is_shown = kind != StatisticKind::Spills || value > 0.0 || before.is_some_and(|before| before > 0.0);
        let meaning = match statistic.meaning.as_str() {
            "" => format!("{}, as the driver tells it", statistic.name),
            meaning => format!("{}, as the driver tells it: {meaning}", statistic.name),
        };
        is_shown.then(|| Figure { name: kind.unit().to_owned(), meaning, value, before })
    });
    std::iter::once(words).chain(told).collect()
}

/// All statistics of a stage, each with its previous value.
pub fn all_statistics(now: &StageReport, before: Option<&StageReport>) -> Vec<(String, Vec<Figure>)> {
    let executables = |report: &StageReport| {
        report.largest.as_ref().and_then(|largest| largest.executables.clone()).unwrap_or_default()
    };
    let earlier = before.map(executables).unwrap_or_default();
    let of = |executable: Executable| {
        let same = earlier.iter().find(|other| other.name == executable.name);
        let figure = |statistic: Statistic| {
            let same = same.and_then(|other| other.statistics.iter().find(|other| other.name == statistic.name));
            let Statistic { name, meaning, value } = statistic;
            Figure { name, meaning, value, before: same.map(|other| other.value) }
        };
        (executable.name, executable.statistics.into_iter().map(figure).collect())
    };
    executables(now).into_iter().map(of).collect()
}

/// Kind of a pipeline statistic, derived from the driver's name for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StatisticKind {
    Registers,
    Instructions,
    Spills,
    Code,
}

impl StatisticKind {
    const ALL: [Self; 4] = [Self::Registers, Self::Instructions, Self::Spills, Self::Code];

    fn unit(self) -> &'static str {
        match self {
            Self::Registers => "registers",
            Self::Instructions => "instructions",
            Self::Spills => "spills",
            Self::Code => "bytes of code",
        }
    }

    /// The driver's names, in lower case, the best first. NVIDIA says "Register Count" and "Binary Size"; Mesa's drivers say
    /// "VGPRs", "Instruction Count", "Spill Count" and "Code size".
    fn names(self) -> &'static [&'static str] {
        match self {
            Self::Registers => &["register count", "registers", "vgprs", "max live registers", "full registers"],
            Self::Instructions => &["instruction count", "instructions", "instrs"],
            Self::Spills => &["spill count", "spilled vgprs", "spills", "local memory size", "scratch size"],
            Self::Code => &["code size", "binary size", "codesize"],
        }
    }

    /// The statistic of this kind: the largest, where a driver has compiled a stage several times.
    fn of(self, executables: &[Executable]) -> Option<(&Statistic, f64)> {
        let named = |name: &&str| {
            let all = executables.iter().flat_map(|executable| &executable.statistics);
            all.filter(|statistic| statistic.name.eq_ignore_ascii_case(name)).max_by(|a, b| a.value.total_cmp(&b.value))
        };
        self.names().iter().find_map(named).map(|statistic| (statistic, statistic.value))
    }
}

#[cfg(test)]
mod tests {
    use super::super::InPipeline;
    use super::*;

    fn statistic(name: &str, value: f64) -> Statistic {
        Statistic { name: name.to_owned(), meaning: String::new(), value }
    }

    fn report(words: usize, statistics: Option<&[(&str, f64)]>) -> StageReport {
        let executable = |statistics: &[(&str, f64)]| Executable {
            name: "Fragment".to_owned(),
            statistics: statistics.iter().map(|(name, value)| statistic(name, *value)).collect(),
            ..Executable::default()
        };
        let executables = statistics.map(|statistics| vec![executable(statistics)]);
        let largest = Some(InPipeline { words_before: words * 2, words, executables, ..InPipeline::default() });
        StageReport { compiled: words * 4, pipelines: 1, largest }
    }

    fn texts(figures: &[Figure]) -> Vec<String> {
        let text = |figure: &Figure| {
            figure.change_text().map_or_else(|| figure.text(), |change| format!("{} {change}", figure.text()))
        };
        figures.iter().map(text).collect()
    }

    #[test]
    fn a_stage_tells_its_words_and_registers_with_their_changes() {
        let before = report(4681, Some(&[("Register Count", 104.0), ("Binary Size", 9216.0)]));
        let now = report(4469, Some(&[("Register Count", 96.0), ("Binary Size", 9216.0)]));
        let expected = ["4,469 words -212", "96 registers -8", "9,216 bytes of code"];
        assert_eq!(texts(&figures(&now, Some(&before))), expected);
        // Nothing to compare with, or the driver has not been queried.
        assert_eq!(texts(&figures(&now, None)), ["4,469 words", "96 registers", "9,216 bytes of code"]);
        assert_eq!(texts(&figures(&report(4469, None), Some(&before))), ["4,469 words -212"]);
        // A stage without a pipeline.
        let idle = StageReport { compiled: 29_000, ..StageReport::default() };
        assert_eq!(texts(&figures(&idle, Some(&before))), ["29,000 words compiled"]);
    }

    #[test]
    fn spills_are_told_once_there_are_any() {
        let none = report(10, Some(&[("VGPRs", 24.0), ("Spilled VGPRs", 0.0), ("SGPRs", 40.0)]));
        let some = report(12, Some(&[("VGPRs", 24.0), ("Spilled VGPRs", 6.0), ("SGPRs", 40.0)]));
        assert_eq!(texts(&figures(&none, None)), ["10 words", "24 registers"]);
        assert_eq!(texts(&figures(&some, Some(&none))), ["12 words +2", "24 registers", "6 spills +6"]);
        assert_eq!(texts(&figures(&none, Some(&some))), ["10 words -2", "24 registers", "0 spills -6"]);
    }

    #[test]
    fn all_that_a_driver_tells_keeps_its_names() {
        let before = report(10, Some(&[("SGPRs", 40.0)]));
        let now = report(10, Some(&[("SGPRs", 48.0), ("Occupancy", 0.75)]));
        let all = all_statistics(&now, Some(&before));
        assert_eq!(all.len(), 1);
        assert_eq!(
            (all[0].0.as_str(), texts(&all[0].1)),
            ("Fragment", vec!["48 SGPRs +8".into(), "0.75 Occupancy".into()])
        );
    }
}
