//! Times that are measured in turn: by how much two of them differ, and how certain that is.
//!
//! Each pair has a time of either side, drawn one after the other, so what changes slowly (clocks, heat, other programs) is in both. The
//! differences of the pairs are summarized by their trimmed mean, since other work only ever adds time, now and then a lot of it:
//! Tukey and McLaughlin 1963, "Less vulnerable confidence and significance procedures for location based on a single sample". Its
//! interval is that of Student's t (Student 1908, "The probable error of a mean") with the winsorized variance.
//!
//! A test that is repeated until it succeeds would succeed by chance. So there are few looks at the pairs, each after twice as many as
//! the one before, and each spends half of what is left of the error that is allowed in all (Lan and DeMets 1983, "Discrete sequential
//! boundaries for clinical trials", with the bound of Bonferroni).

use serde::Serialize;

/// How often a difference is told where there is none, over all looks.
const ERROR: f64 = 0.01;
/// Pairs before the first look.
const FIRST_LOOK: usize = 8;
/// The part of the differences that is left out at either end.
const TRIMMED: f64 = 0.2;
/// A difference below this part of the time is told as none, however certain it is: where code lies in memory may make as much.
const LEAST: f64 = 0.005;
/// A margin is small enough if it is this part of the difference, or, of sides that do not differ, this part of the time.
const PRECISE: f64 = 0.2;
const PRECISE_SAME: f64 = 0.01;

/// Knowledge of the difference of two times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The second side takes longer.
    Slower,
    /// The second side takes less time.
    Faster,
    /// No difference was found.
    Same,
}

/// The difference of two times that were measured in turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The time of the first side: the trimmed mean, in milliseconds.
    pub base_ms: f64,
    /// By how much the second side takes longer, in milliseconds.
    pub change_ms: f64,
    /// Half the width of the interval in which the difference is, in milliseconds.
    pub margin_ms: f64,
    /// How certain the interval is, 0..1. Over all looks it is 0.99.
    pub confidence: f64,
    /// How many pairs were measured.
    pub pairs: usize,
    /// The conclusion.
    pub verdict: Verdict,
}

impl Difference {
    /// The difference as a part of the first side.
    pub fn share(&self) -> f64 {
        self.change_ms / self.base_ms
    }

    /// Half the width of the interval as a part of the first side.
    pub fn margin_share(&self) -> f64 {
        self.margin_ms / self.base_ms
    }

    /// The difference of the second side for a reader, as `4.1 % ± 0.3 slower` or `no difference in time (0.1 % ± 0.4)`.
    pub fn text(&self) -> String {
        let [share, margin] = [self.share(), self.margin_share()].map(|part| 100.0 * part);
        let digits = if margin < 0.1 { 2 } else { 1 };
        match self.verdict {
            Verdict::Slower => format!("{share:.digits$} % ± {margin:.digits$} slower"),
            Verdict::Faster => format!("{:.digits$} % ± {margin:.digits$} faster", -share),
            Verdict::Same => format!("no difference in time ({share:+.digits$} % ± {margin:.digits$})"),
        }
    }
}

/// Times of two sides, measured in turn.
#[derive(Clone, Debug, Default)]
pub struct PairedTimes {
    sides: [Vec<f64>; 2],
}

impl PairedTimes {
    /// Adds a pair, in milliseconds.
    pub fn push(&mut self, base: f64, other: f64) {
        self.sides[0].push(base);
        self.sides[1].push(other);
    }

    /// How many pairs there are.
    pub fn len(&self) -> usize {
        self.sides[0].len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The difference, once it is known well enough, or after `most` pairs. `None` before that: more pairs are needed.
    pub fn difference(&self, most: usize) -> Option<Difference> {
        let count = self.len();
        let is_last = count >= most.max(3);
        let look = (0..32_u32).find(|look| FIRST_LOOK << look == count);
        // The last look comes at any number of pairs, after all that were before it.
        let look =
            look.or_else(|| is_last.then(|| (0..32_u32).take_while(|look| FIRST_LOOK << look < count).count() as u32))?;
        let error = ERROR / f64::from(1_u32 << (look + 1).min(30));
        let differences: Vec<f64> =
            self.sides[1].iter().zip(&self.sides[0]).map(|(other, base)| other - base).collect();
        let (change_ms, margin_ms) = trimmed_mean(&differences, error)?;
        let (base_ms, _) = trimmed_mean(&self.sides[0], error)?;
        let is_significant = change_ms.abs() > margin_ms && change_ms.abs() >= LEAST * base_ms;
        let verdict = match is_significant {
            true if change_ms > 0.0 => Verdict::Slower,
            true => Verdict::Faster,
            false => Verdict::Same,
        };
        let is_precise = match verdict {
            Verdict::Same => margin_ms <= PRECISE_SAME * base_ms,
            _ => margin_ms <= PRECISE * change_ms.abs(),
        };
        let found = Difference { base_ms, change_ms, margin_ms, confidence: 1.0 - error, pairs: count, verdict };
        (is_last || is_precise).then_some(found)
    }
}

/// The mean of the values without the largest and smallest ones, and half the width of its interval, which misses the true one with this
/// probability. `None` for too few values.
fn trimmed_mean(values: &[f64], error: f64) -> Option<(f64, f64)> {
    let count = values.len();
    let cut = (TRIMMED * count as f64) as usize;
    let kept = count - 2 * cut;
    if kept < 2 {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mean = sorted[cut..count - cut].iter().sum::<f64>() / kept as f64;
    let (low, high) = (sorted[cut], sorted[count - 1 - cut]);
    let winsorized = || sorted.iter().map(|value| value.clamp(low, high));
    let middle = winsorized().sum::<f64>() / count as f64;
    let squares: f64 = winsorized().map(|value| (value - middle).powi(2)).sum();
    let freedom = kept as f64 - 1.0;
    let standard_error = (squares / (kept as f64 * freedom)).sqrt();
    Some((mean, t_quantile(1.0 - error / 2.0, freedom) * standard_error))
}

/// The number that Student's t with this many degrees of freedom does not exceed with this probability, above a half.
pub fn t_quantile(probability: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    while t_tail(high, freedom) > 1.0 - probability && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if t_tail(middle, freedom) > 1.0 - probability { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The probability that Student's t exceeds `t`, which is not negative (NIST Digital Library of Mathematical Functions, section 8.17).
fn t_tail(t: f64, freedom: f64) -> f64 {
    0.5 * incomplete_beta(freedom / (freedom + t * t), 0.5 * freedom, 0.5)
}

/// The regularized incomplete beta function, by its continued fraction (DLMF 8.17.22) and the method of Lentz 1976.
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    // The fraction converges fast on this side; the other one follows from the symmetry.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(1.0 - x, b, a);
    }
    const TINY: f64 = 1e-300;
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (1.0 - x).ln()).exp() / a;
    let (mut fraction, mut c, mut d) = (1.0_f64, 1.0_f64, 0.0_f64);
    for step in 0..300 {
        let m = f64::from(step / 2);
        let term = match step {
            0 => 1.0,
            _ if step % 2 == 0 => m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
            _ => -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)),
        };
        let not_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
        d = 1.0 / not_zero(1.0 + term * d);
        c = not_zero(1.0 + term / c);
        fraction *= c * d;
        if (c * d - 1.0).abs() < 1e-14 {
            break;
        }
    }
    front * (fraction - 1.0)
}

/// The logarithm of the gamma function of a positive number (Lanczos 1964, with the coefficients for g = 5).
fn ln_gamma(x: f64) -> f64 {
    const COEFFICIENTS: [f64; 6] = [
        76.180_091_729_471_46,
        -86.505_320_329_416_77,
        24.014_098_240_830_91,
        -1.231_739_572_450_155,
        0.120_865_097_386_617_9e-2,
        -0.539_523_938_495_3e-5,
    ];
    let sum = (1..).zip(COEFFICIENTS).fold(1.000_000_000_190_015, |sum, (at, c)| sum + c / (x + f64::from(at)));
    let base = x + 5.5;
    (x + 0.5) * base.ln() - base + (2.506_628_274_631_000_5 * sum / x).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look random, around 0, of a deterministic generator.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        move || {
            let mut uniform = || {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            // Sums of uniform numbers are nearly normal.
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        }
    }

    /// The difference of two times with noise of this size, measured until it is known.
    fn measured(seed: u64, base: f64, other: f64, size: f64, most: usize) -> Difference {
        let (mut times, mut noise) = (PairedTimes::default(), noise(seed));
        loop {
            // Both sides drift alike, and now and then another program takes time.
            let drift = 0.3 * (times.len() as f64 / 7.0).sin();
            let hiccup = |at: usize| if (times.len() + at).is_multiple_of(9) { 5.0 } else { 0.0 };
            let pair = [base + hiccup(0), other + hiccup(4)].map(|time| time + drift + size * noise());
            times.push(pair[0], pair[1]);
            if let Some(found) = times.difference(most) {
                return found;
            }
        }
    }

    /// Percentage points of tables (Fisher and Yates; NIST handbook, section 1.3.6.7.2).
    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (probability, freedom, t) in [
            (0.975, 1.0, 12.706),
            (0.975, 5.0, 2.571),
            (0.995, 5.0, 4.032),
            (0.95, 10.0, 1.812),
            (0.999, 30.0, 3.385),
            (0.975, 100.0, 1.984),
            (0.975, 1e6, 1.960),
        ] {
            assert!((t_quantile(probability, freedom) - t).abs() < 1e-3, "{probability} {freedom}");
        }
    }

    #[test]
    fn a_difference_is_told_with_its_size() {
        let found = measured(3, 20.0, 21.0, 0.2, 1 << 12);
        assert_eq!(found.verdict, Verdict::Slower);
        assert!(
            (found.change_ms - 1.0).abs() <= found.margin_ms && found.margin_ms <= 0.2 * found.change_ms,
            "{found:?}"
        );
        let text = found.text();
        assert!(text.contains(" % ± ") && text.ends_with(" slower"), "{text}");
        let found = measured(4, 20.0, 10.0, 0.2, 1 << 12);
        assert!(found.verdict == Verdict::Faster && found.pairs == FIRST_LOOK && found.text().ends_with("faster"));
    }

    #[test]
    fn equal_times_have_no_difference() {
        let told = (1..=300).filter(|seed| measured(*seed, 20.0, 20.0, 0.2, 1 << 10).verdict != Verdict::Same).count();
        assert!(told <= 6, "{told} of 300 tell a difference where there is none");
        let found = measured(9, 20.0, 20.0, 0.2, 1 << 12);
        assert!(
            found.margin_share() <= PRECISE_SAME && found.text().starts_with("no difference in time ("),
            "{found:?}"
        );
    }

    #[test]
    fn looks_are_few() {
        let mut times = PairedTimes::default();
        // Never precise: both sides are all over the place.
        let mut noise = noise(5);
        let mut looks = Vec::new();
        for count in 1..=50 {
            times.push(10.0 + 9.0 * noise(), 10.0 + 9.0 * noise());
            looks.extend(times.difference(50).map(|found| (count, found.pairs)));
        }
        assert_eq!(looks, [(50, 50)]);
        assert_eq!(PairedTimes::default().difference(0), None);
    }

    #[test]
    fn a_slow_frame_now_and_then_does_not_count() {
        let values: Vec<f64> = (0..20).map(|at| if at % 7 == 3 { 900.0 } else { 5.0 + 0.01 * f64::from(at) }).collect();
        let (mean, margin) = trimmed_mean(&values, 0.01).unwrap();
        assert!((mean - 5.1).abs() < 0.05 && margin < 0.2, "{mean} {margin}");
    }
}
