//! A number or vector that a statement computed.

use serde_json::{Value, json};

use crate::shader::spirv::trace::NumberKind;

/// Up to four numbers of one type, as their bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TracedValue {
    kind: NumberKind,
    count: usize,
    bits: [u32; 4],
}

impl TracedValue {
    /// At most four numbers count.
    pub(in crate::shader) fn new(kind: NumberKind, bits: &[u32]) -> Self {
        let mut all = [0; 4];
        all.iter_mut().zip(bits).for_each(|(all, bits)| *all = *bits);
        Self { kind, count: bits.len().min(4), bits: all }
    }

    /// A float.
    pub fn float(number: f32) -> Self {
        Self::new(NumberKind::Float, &[number.to_bits()])
    }

    /// A vector of floats.
    #[cfg(test)]
    pub(super) fn floats(numbers: &[f32]) -> Self {
        Self::new(NumberKind::Float, &numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>())
    }

    /// Whether it is true or false, or several of these.
    pub fn is_truth(&self) -> bool {
        matches!(self.kind, NumberKind::Bool)
    }

    /// Its type in GLSL.
    pub fn type_name(&self) -> String {
        let (scalar, vector) = match self.kind {
            NumberKind::Float => ("float", "vec"),
            NumberKind::Int => ("int", "ivec"),
            NumberKind::Uint => ("uint", "uvec"),
            NumberKind::Bool => ("bool", "bvec"),
        };
        if self.count == 1 { scalar.to_owned() } else { format!("{vector}{}", self.count) }
    }

    /// The numbers; a bool is 0 or 1.
    pub fn numbers(&self) -> impl Iterator<Item = f64> {
        let kind = self.kind;
        self.bits[..self.count].iter().map(move |bits| match kind {
            NumberKind::Float => f64::from(f32::from_bits(*bits)),
            NumberKind::Int => f64::from(bits.cast_signed()),
            NumberKind::Uint | NumberKind::Bool => f64::from(*bits),
        })
    }

    /// Whether no number is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        self.numbers().all(f64::is_finite)
    }

    /// The bits of the floats in hexadecimal, as `3f800000`; empty for other numbers.
    pub fn float_bits(&self) -> String {
        let of_float = self.bits[..self.count].iter().filter(|_| matches!(self.kind, NumberKind::Float));
        of_float.map(|bits| format!("{bits:08x}")).collect::<Vec<_>>().join(" ")
    }

    /// One of the numbers, from 0.
    pub(super) fn component(&self, index: usize) -> Option<Self> {
        self.bits[..self.count].get(index).map(|bits| Self::new(self.kind, &[*bits]))
    }

    /// The numbers as text, as GLSL writes them: `0.0625`, `(1, 0.5, 0)`, `true`.
    pub fn text(&self) -> String {
        let texts: Vec<String> = self.bits[..self.count].iter().map(|bits| self.number_text(*bits)).collect();
        if self.count == 1 { texts.concat() } else { format!("({})", texts.join(", ")) }
    }

    fn number_text(&self, bits: u32) -> String {
        match self.kind {
            NumberKind::Float => short(f32::from_bits(bits)),
            NumberKind::Int => bits.cast_signed().to_string(),
            NumberKind::Uint => bits.to_string(),
            NumberKind::Bool => (bits != 0).to_string(),
        }
    }

    /// A number, a list of numbers, or true or false. NaN and infinity are text.
    pub fn json(&self) -> Value {
        let one = |bits: u32| match self.kind {
            NumberKind::Float if !f32::from_bits(bits).is_finite() => json!(short(f32::from_bits(bits))),
            NumberKind::Float => json!(f32::from_bits(bits)),
            NumberKind::Int => json!(bits.cast_signed()),
            NumberKind::Uint => json!(bits),
            NumberKind::Bool => json!(bits != 0),
        };
        if self.count == 1 {
            one(self.bits[0])
        } else {
            self.bits[..self.count].iter().map(|bits| one(*bits)).collect()
        }
    }
}

/// A float with six digits.
fn short(number: f32) -> String {
    match number {
        n if n.is_nan() => "NaN".to_owned(),
        n if n.is_infinite() => (if n > 0.0 { "Inf" } else { "-Inf" }).to_owned(),
        n if n != 0.0 && !(1e-4..1e7).contains(&n.abs()) => format!("{n:.5e}"),
        n => {
            let digits = if n == 0.0 { 0 } else { (5 - n.abs().log10().floor() as i32).clamp(0, 9) as usize };
            let text = format!("{n:.digits$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_as_glsl_writes_them() {
        let float = TracedValue::floats;
        for (value, text) in [
            (float(&[0.0625]), "0.0625"),
            (float(&[1.0, 0.5, 0.0]), "(1, 0.5, 0)"),
            (float(&[f32::NAN, f32::NEG_INFINITY]), "(NaN, -Inf)"),
            (float(&[123_456.79]), "123457"),
            (float(&[1.0 / 3.0]), "0.333333"),
            (float(&[1.5e-7]), "1.50000e-7"),
            (float(&[-200.0]), "-200"),
            (TracedValue::new(NumberKind::Bool, &[1]), "true"),
            (TracedValue::new(NumberKind::Int, &[u32::MAX, 3]), "(-1, 3)"),
            (TracedValue::new(NumberKind::Uint, &[u32::MAX]), "4294967295"),
        ] {
            assert_eq!(value.text(), text);
        }
        assert_eq!(float(&[0.1, f32::NAN]).json(), json!([0.1_f32, "NaN"]));
        assert_eq!(float(&[1.0, -0.0]).float_bits(), "3f800000 80000000");
        assert_eq!(TracedValue::new(NumberKind::Int, &[3]).float_bits(), "");
        assert_eq!(float(&[1.0, 2.0]).type_name() + &TracedValue::new(NumberKind::Bool, &[0]).type_name(), "vec2bool");
    }
}
