//! The samples of a pixel: which fragments they show, and the color that they have together.

use super::{Fragment, Trace};
use crate::message::grouped;

/// The share of the light behind a fragment that it hides.
pub(super) fn coverage(fragment: &Fragment) -> f32 {
    fragment.color.map_or(0.0, |[.., alpha]| f32::from_bits(alpha))
}

impl Trace {
    /// All samples of the pixel, as bits.
    pub(super) fn all_samples(&self) -> u32 {
        u32::MAX >> (32 - self.samples.clamp(1, 32))
    }

    /// The samples that a fragment covers, as bits. One of which they are not known covers the pixel.
    pub(super) fn samples_of(&self, fragment: &Fragment) -> u32 {
        fragment.samples.map_or(self.all_samples(), |samples| samples & self.all_samples())
    }

    /// The fragments in front of one, in those of its samples that they cover, too. `visible`: the one that was drawn last among those of the
    /// same depth.
    pub(super) fn before(&self, index: usize, visible: Option<usize>) -> impl Iterator<Item = (usize, &Fragment)> {
        let own = self.fragments.get(index);
        self.fragments.iter().enumerate().filter(move |(at, other)| {
            own.is_some_and(|own| {
                let is_last = other.depth.to_bits() == own.depth.to_bits() && *at != index && visible == Some(*at);
                let shares = self.samples_of(other) & self.samples_of(own) != 0;
                other.color.is_some() && shares && (other.depth > own.depth || is_last)
            })
        })
    }

    /// The samples of a fragment that no opaque one hides, as bits.
    pub(super) fn seen_samples(&self, index: usize, visible: Option<usize>) -> u32 {
        let opaque = self.before(index, visible).filter(|(_, other)| coverage(other) >= 1.0);
        let hidden = opaque.fold(0, |hidden, (_, other)| hidden | self.samples_of(other));
        self.fragments.get(index).map_or(0, |own| self.samples_of(own) & !hidden)
    }

    /// The mean of the samples of the pixel in which these fragments, the nearest first, are blended; with the rounding that is nearest to the
    /// picture.
    pub(super) fn mean_of(&self, parts: &[usize]) -> Option<[u32; 4]> {
        let parts: Vec<(u32, [u32; 4])> = parts
            .iter()
            .filter_map(|part| self.fragments.get(*part))
            .filter_map(|part| Some((self.samples_of(part), part.color?)))
            .collect();
        // A device may round once or twice where it blends.
        let over = |above: f32, below: f32, rest: f32| [below.mul_add(rest, above), above + below * rest];
        let sample = |sample: u32, way: usize| {
            let colors = parts.iter().rev().filter(|(samples, _)| samples >> sample & 1 == 1);
            colors.fold([0.0; 4], |below: [f32; 4], (_, above)| {
                let above = above.map(f32::from_bits);
                std::array::from_fn(|at| over(above[at], below[at], 1.0 - above[3])[way])
            })
        };
        // And it may add the samples in a row or in pairs.
        let mean = |(way, in_pairs): (usize, bool)| {
            let mut sums: Vec<[f32; 4]> = (0..self.samples).map(|number| sample(number, way)).collect();
            let add = |a: &[f32; 4], b: &[f32; 4]| std::array::from_fn(|at| a[at] + b[at]);
            while in_pairs && sums.len() > 1 {
                sums = sums.chunks(2).map(|pair| pair[1..].iter().fold(pair[0], |a, b| add(&a, b))).collect();
            }
            let sum = sums.iter().skip(1).fold(sums.first().copied().unwrap_or_default(), |a, b| add(&a, b));
            sum.map(|channel| (channel / self.samples as f32).to_bits())
        };
        let all = [(0, false), (0, true), (1, false), (1, true)].map(mean);
        all.into_iter().min_by_key(|color| ulps(*color, self.picture))
    }

    /// The samples of a fragment, as `covers samples 0, 2 of 4`, and its primitive; empty if nothing is known of them.
    pub fn coverage_text(&self, fragment: usize) -> String {
        let Some(of) = self.fragments.get(fragment) else { return String::new() };
        let samples = of.samples.filter(|_| self.samples > 1).map(|samples| match samples & self.all_samples() {
            all if all == self.all_samples() => format!("covers all {} samples", self.samples),
            few => {
                let numbers: Vec<String> = numbers(few).map(|number| number.to_string()).collect();
                let noun = if numbers.len() == 1 { "sample" } else { "samples" };
                format!("covers {noun} {} of {}", numbers.join(", "), self.samples)
            }
        });
        let primitive = of.primitive.map(|number| format!("primitive {}", grouped(f64::from(number))));
        samples.into_iter().chain(primitive).collect::<Vec<_>>().join(" · ")
    }
}

/// The largest distance of two numbers in steps of floats.
pub(super) fn ulps(a: [u32; 4], b: [u32; 4]) -> u64 {
    let place = |bits: u32| {
        let magnitude = i64::from(bits & 0x7fff_ffff);
        if bits >> 31 == 0 { magnitude } else { -magnitude }
    };
    a.iter().zip(b).map(|(a, b)| place(*a).abs_diff(place(b))).max().unwrap_or(0)
}

/// The numbers of samples that are given as bits.
pub(super) fn numbers(samples: u32) -> impl Iterator<Item = u32> {
    (0..32).filter(move |number| samples >> number & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::super::sample::trace;
    use super::super::{Fragment, FragmentState, Trace};

    /// A trace with these depths, samples and colors.
    fn of(fragments: &[(f32, u32, [f32; 4])], picture: [f32; 4]) -> Trace {
        let one = trace(Vec::new(), &[]);
        let fragment = |(depth, samples, color): &(f32, u32, [f32; 4])| Fragment {
            depth: *depth,
            samples: Some(*samples),
            primitive: Some(1234),
            color: Some(color.map(f32::to_bits)),
            ..one.fragments[0].clone()
        };
        let fragments = fragments.iter().map(fragment).collect();
        let picture = picture.map(f32::to_bits);
        Trace { fragments, picture, redrawn: picture, samples: 4, ..one }
    }

    const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
    const BLUE: [f32; 4] = [0.0, 0.0, 1.0, 1.0];

    #[test]
    fn a_pixel_is_the_mean_of_what_its_samples_show() {
        use FragmentState::{Blended, Covered, Seen, Shares};
        let states = |trace: &Trace| (0..trace.fragments.len()).map(|at| trace.state(at).unwrap()).collect::<Vec<_>>();
        // An edge before a surface: the nearer one hides a sample of the other, and all of the last.
        let edge = of(&[(0.9, 0b0001, RED), (0.5, 0b1111, BLUE), (0.4, 0b0001, RED)], [0.25, 0.0, 0.75, 1.0]);
        assert_eq!(states(&edge), [Shares, Shares, Covered(0)]);
        assert_eq!(
            (edge.visible(), edge.is_proven(0), edge.is_proven(1), edge.is_proven(2)),
            (Some(1), true, true, false)
        );
        assert_eq!(edge.proof_text(1), "equal to the picture by 4 samples");
        let texts = [edge.coverage_text(0), edge.coverage_text(1)];
        assert_eq!(texts, ["covers sample 0 of 4 · primitive 1,234", "covers all 4 samples · primitive 1,234"]);
        assert_eq!(of(&[(0.9, 0b0101, RED)], RED).coverage_text(0), "covers samples 0, 2 of 4 · primitive 1,234");
        // A silhouette before nothing.
        let alone = of(&[(0.9, 0b0110, RED)], [0.5, 0.0, 0.0, 0.5]);
        assert_eq!((states(&alone), alone.is_proven(0)), (vec![Shares], true));
        // Two triangles of a surface meet: samples that neither covers would be missing in the sum.
        let meet = of(&[(0.9, 0b0011, RED), (0.9, 0b1100, BLUE)], [0.5, 0.0, 0.5, 1.0]);
        assert_eq!((states(&meet), meet.is_proven(0), meet.visible()), (vec![Shares, Shares], true, Some(0)));
        let wrong = of(&[(0.9, 0b0011, RED), (0.9, 0b0100, BLUE)], [0.5, 0.0, 0.5, 1.0]);
        assert!(!wrong.is_proven(0) && wrong.proof_text(0).contains("ulp from the picture"), "{}", wrong.proof_text(0));
        // Blended in a part of the pixel.
        let blended = of(&[(0.9, 0b0011, [0.0, 0.5, 0.0, 0.5]), (0.5, 0b1111, RED)], [0.75, 0.25, 0.0, 1.0]);
        assert_eq!((states(&blended)[0], blended.is_proven(0), blended.is_proven(1)), (Blended, true, true));
        // One that covers all samples is compared alone.
        let whole = of(&[(0.9, 0b1111, RED)], RED);
        assert_eq!((states(&whole), whole.proof_text(0).as_str()), (vec![Seen], "equal to the picture"));
    }
}
