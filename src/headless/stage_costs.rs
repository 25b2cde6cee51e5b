//! Costs of the functions of a stage, for readers and programs.

use serde_json::{Value, json};

use crate::pipeline::Figure;
use crate::shader::costs::{Calls, Lack, NamedFunction};
use crate::statistics::{Difference, Verdict};

/// Cost of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionCost {
    /// The function.
    pub function: NamedFunction,
    /// How often it is called in the frame.
    pub calls: Calls,
    /// The difference that it makes to leave it out: a negative one is what it costs.
    pub difference: Difference,
    /// The numbers of the stage without it, each with its value with it: words, instructions and registers, as far as the driver tells.
    pub figures: Vec<Figure>,
}

impl FunctionCost {
    /// Its cost, milliseconds of the frame.
    pub fn ms(&self) -> f64 {
        -self.difference.change_ms
    }

    /// Whether leaving it out makes a difference that is significant.
    pub fn is_significant(&self) -> bool {
        self.difference.verdict != Verdict::Same
    }

    /// The cost for a reader, as `0.42 ms ± 0.03` or `< 0.02 ms`.
    pub fn text(&self) -> String {
        let margin = self.difference.margin_ms;
        match self.is_significant() {
            true => format!("{:.3} ms ± {margin:.3}", self.ms()),
            false => format!("< {:.3} ms", self.ms().max(0.0) + margin),
        }
    }
}

/// Costs of the functions of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct StageCosts {
    /// The stage.
    pub stage: String,
    /// Device time of the passes that it draws, in milliseconds.
    pub stage_ms: f64,
    /// Device time of the whole frame, in milliseconds.
    pub frame_ms: f64,
    /// Its invocations in a frame.
    pub invocations: u32,
    /// The functions that were measured, the dearest first.
    pub functions: Vec<FunctionCost>,
    /// The others, each with the reason.
    pub left_out: Vec<(NamedFunction, Lack)>,
}

impl StageCosts {
    /// The costs for programs.
    pub fn json(&self) -> Value {
        let named = |of: &NamedFunction| json!({ "name": of.signature, "file": of.file, "line": of.line });
        let functions = self.functions.iter().map(|cost| {
            let mut json = named(&cost.function);
            let figures = cost.figures.iter().map(|figure| {
                let of = json!({ "without": figure.value, "with": figure.before });
                (figure.name.clone(), of)
            });
            json["ms"] = json!(cost.ms());
            json["margin_ms"] = json!(cost.difference.margin_ms);
            json["confidence"] = json!(cost.difference.confidence);
            json["significant"] = json!(cost.is_significant());
            json["share"] = json!(cost.ms() / self.frame_ms);
            json["pairs"] = json!(cost.difference.pairs);
            json["calls"] = json!(cost.calls.calls);
            json["calls_per_invocation"] = json!(f64::from(cost.calls.calls) / f64::from(self.invocations.max(1)));
            json["figures"] = Value::Object(figures.collect());
            json
        });
        let left_out = self.left_out.iter().map(|(function, lack)| {
            let mut json = named(function);
            json["reason"] = json!(lack.to_string());
            json
        });
        json!({ "stage": self.stage, "stage_ms": self.stage_ms, "frame_ms": self.frame_ms, "invocations": self.invocations,
            "functions": functions.collect::<Vec<_>>(), "not_measured": left_out.collect::<Vec<_>>() })
    }
}
