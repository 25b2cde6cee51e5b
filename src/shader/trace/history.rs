//! The fragments of a pixel: which is seen, and how its color compares with the picture's.

use super::samples::{coverage, ulps};
use super::{Target, Trace};
use crate::shader::StageKind;

/// Steps of floats by which blending may differ from the sum that is computed here.
const MOST_ULP: u64 = 4;

/// Its part in the pixel of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FragmentState {
    /// Discarded.
    Discarded,
    /// Nothing is in front of it, and it covers the pixel.
    Seen,
    /// It is seen in some samples of the pixel. The others show other fragments or the background.
    Shares,
    /// It is blended with what is behind it.
    Blended,
    /// It covers its samples, and those in front of it are blended with it.
    BlendedOver,
    /// The fragment with this index, or several, are in front of it in all of its samples.
    Covered(usize),
}

impl FragmentState {
    /// Its name for programs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discarded => "discarded",
            Self::Seen => "seen",
            Self::Shares => "shares",
            Self::Blended => "blended",
            Self::BlendedOver => "blended-over",
            Self::Covered(_) => "covered",
        }
    }

    /// The fragment that covers it.
    pub fn covered_by(self) -> Option<usize> {
        match self {
            Self::Covered(by) => Some(by),
            _ => None,
        }
    }
}

impl Trace {
    /// The part of a fragment in the picture; `None` in other images, whose alpha is not known to be a coverage.
    pub fn state(&self, index: usize) -> Option<FragmentState> {
        let fragment = self.fragments.get(index)?;
        if !self.has_color() || self.target != Target::Picture {
            return None;
        }
        if fragment.color.is_none() {
            return Some(FragmentState::Discarded);
        }
        let visible = self.visible();
        let before = || self.before(index, visible);
        let seen = match self.seen_samples(index, visible) {
            0 if visible == Some(index) => self.samples_of(fragment),
            seen => seen,
        };
        let covering = before().find(|(_, other)| coverage(other) >= 1.0);
        Some(match covering {
            Some((by, _)) if seen == 0 => FragmentState::Covered(by),
            _ if coverage(fragment) < 1.0 => FragmentState::Blended,
            _ if seen != self.all_samples() => FragmentState::Shares,
            _ if covering.is_none() && before().next().is_some() => FragmentState::BlendedOver,
            _ => FragmentState::Seen,
        })
    }

    /// The color of all fragments that share the pixel or are blended there, if one is among them, unless it is alone in the whole pixel.
    pub(super) fn together(&self, fragment: usize) -> Option<[u32; 4]> {
        use FragmentState::{Blended, BlendedOver, Seen, Shares};
        let is_part = |index: &usize| matches!(self.state(*index), Some(Seen | Shares | Blended | BlendedOver));
        let parts: Vec<usize> = (0..self.fragments.len()).filter(is_part).collect();
        let is_alone = parts.len() < 2 && self.samples_of(self.fragments.get(fragment)?) == self.all_samples();
        if is_alone || !parts.contains(&fragment) {
            return None;
        }
        self.mean_of(&parts)
    }

    /// Whether a fragment ends with the color of the picture, bit by bit, alone or together with others. Of a vertex or a compute invocation,
    /// whether its stage draws the same picture.
    pub fn is_proven(&self, fragment: usize) -> bool {
        match self.has_color() {
            _ if self.begins_anew => false,
            true => {
                self.fragments.get(fragment).is_some_and(|fragment| self.is_shown(fragment))
                    || self.together(fragment) == Some(self.picture)
            }
            false => self.redrawn == self.picture,
        }
    }

    /// How the color of a fragment compares with the picture's, in words that begin with the result.
    pub fn proof_text(&self, fragment: usize) -> String {
        let compared = self.compared(fragment);
        match self.begins_anew {
            true => format!("not proven: earlier frames on screen cannot be drawn again. Without them, {compared}"),
            false => compared,
        }
    }

    fn compared(&self, fragment: usize) -> String {
        let with = self.target.name();
        if !self.has_color() {
            return match self.redrawn == self.picture {
                true => "equal picture with the traced stage".to_owned(),
                false => format!(
                    "{} ulp from {with} with the traced stage: passes read earlier frames, or the driver computes in another order",
                    ulps(self.redrawn, self.picture)
                ),
            };
        }
        let found = self.fragments.get(fragment);
        let Some((found, color)) = found.and_then(|found| Some((found, found.color?))) else {
            return "discarded".to_owned();
        };
        if self.is_shown(found) {
            return format!("equal to {with}{}", self.target.precision());
        }
        if color.iter().any(|bits| !f32::from_bits(*bits).is_finite()) && self.visible() == Some(fragment) {
            return format!("NaN or infinity, for which {with} has another number");
        }
        let is = match self.state(fragment) {
            Some(FragmentState::Covered(by)) => return format!("covered by fragment {by}"),
            Some(FragmentState::Blended) => "blended with what is behind it",
            Some(FragmentState::BlendedOver) => "blended over",
            Some(FragmentState::Shares) => "shares the pixel",
            _ => "hidden, or blended over",
        };
        if let Some(ulp) = self.together(fragment).map(|color| ulps(color, self.picture)).filter(|ulp| *ulp <= MOST_ULP)
        {
            let by = if self.samples > 1 { format!(" by {} samples", self.samples) } else { String::new() };
            let part = match self.state(fragment) {
                // The samples tell.
                Some(FragmentState::Shares) => String::new(),
                _ => format!(", {is}"),
            };
            return match ulp {
                0 => format!("equal to {with}{by}{part}"),
                _ => format!("{ulp} ulp from {with}{by}{part}: the device rounds where it blends"),
            };
        }
        if self.visible() != Some(fragment) {
            return is.to_owned();
        }
        let why = match self.redrawn == self.picture {
            // The log ends with the color before the mark.
            true if self.endless_loop.is_some() => return format!("a loop was cut short, so {with} is magenta there"),
            true => "a later pass changes it, or surfaces or a background that were not traced are in the pixel, too",
            false => "the driver computes the traced stage in another order, or passes read earlier frames",
        };
        format!("{} ulp from {with}: {why}", ulps(color, self.picture))
    }

    /// The name of an invocation in a list of all.
    pub fn name_of(&self, fragment: usize) -> String {
        let Some(of) = self.fragments.get(fragment) else { return String::new() };
        match (self.kind, of.vertex) {
            (_, Some(vertex)) => {
                let same = self.fragments[..fragment].iter().filter(|other| other.vertex == of.vertex).count();
                let again = if same > 0 { format!(", draw {}", same + 1) } else { String::new() };
                format!("Vertex {vertex}{again}")
            }
            (StageKind::Compute, None) => match self.fragments.len() {
                1 => "Invocation".to_owned(),
                _ => format!("Run {}", fragment + 1),
            },
            _ => {
                let is = match (self.state(fragment), of.color, self.visible() == Some(fragment)) {
                    (Some(FragmentState::Covered(by)), ..) => format!("covered by {by}"),
                    (Some(FragmentState::BlendedOver), ..) => "blended over".to_owned(),
                    (Some(FragmentState::Shares), ..) => "shares the pixel".to_owned(),
                    (Some(state), ..) => state.name().to_owned(),
                    (None, None, _) => "discarded".to_owned(),
                    (None, Some(_), true) => "seen".to_owned(),
                    (None, Some(_), false) => "hidden or blended".to_owned(),
                };
                let coverage = self.coverage_text(fragment);
                let separator = if coverage.is_empty() { "" } else { " · " };
                format!("Fragment {fragment}: {is}, depth {:.4}{separator}{coverage}", of.depth)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Fragment;
    use super::super::sample::trace;
    use super::*;

    #[test]
    fn the_proof_counts_steps_of_floats() {
        let mut trace = trace(Vec::new(), &[]);
        assert_eq!((trace.is_proven(0), trace.proof_text(0).as_str()), (true, "equal to the picture"));
        trace.picture = [1.0, 0.0, 0.0, 1.0].map(f32::to_bits);
        trace.fragments[0].color = Some([1.0 + f32::EPSILON * 2.0, 0.0, -0.0, 1.0].map(f32::to_bits));
        assert!(!trace.is_proven(0) && trace.proof_text(0).starts_with("2 ulp from the picture"));
        assert_eq!(ulps([0x8000_0001; 4], [1; 4]), 2);
    }

    /// A trace of fragments with these depths and colors.
    fn of(fragments: &[(f32, Option<[f32; 4]>)], picture: [f32; 4]) -> Trace {
        let one = trace(Vec::new(), &[]);
        let fragment = |(depth, color): &(f32, Option<[f32; 4]>)| Fragment {
            depth: *depth,
            color: color.map(|color| color.map(f32::to_bits)),
            ..one.fragments[0].clone()
        };
        let fragments = fragments.iter().map(fragment).collect();
        let picture = picture.map(f32::to_bits);
        Trace { fragments, picture, redrawn: picture, ..one }
    }

    #[test]
    fn each_fragment_is_seen_blended_covered_or_discarded() {
        use FragmentState::{Blended, BlendedOver, Covered, Discarded, Seen};
        let red = Some([1.0, 0.0, 0.0, 1.0]);
        let half = Some([0.0, 0.5, 0.0, 0.5]);
        let states = |trace: &Trace| (0..trace.fragments.len()).map(|at| trace.state(at).unwrap()).collect::<Vec<_>>();
        let all =
            of(&[(0.9, None), (0.8, half), (0.6, half), (0.5, red), (0.4, half), (0.3, red)], [0.25, 0.75, 0.0, 1.0]);
        assert_eq!(states(&all), [Discarded, Blended, Blended, BlendedOver, Covered(3), Covered(3)]);
        assert_eq!(all.visible(), Some(1));
        let texts: Vec<String> = (0..6).map(|at| all.proof_text(at)).collect();
        let together = "equal to the picture, blended with what is behind it";
        assert_eq!(texts[..2], ["discarded", together]);
        assert_eq!(texts[3..5], ["equal to the picture, blended over", "covered by fragment 3"]);
        assert!((1..4).all(|at| all.is_proven(at)) && !all.is_proven(4));
        assert_eq!(all.name_of(4), "Fragment 4: covered by 3, depth 0.4000");
        // The picture on screen has earlier frames, too, so nothing is proven of it.
        let anew = Trace { begins_anew: true, ..all.clone() };
        assert!(
            !anew.is_proven(1)
                && anew.proof_text(1).starts_with("not proven: ")
                && anew.proof_text(1).ends_with(together)
        );
        // Another device rounds.
        let other = of(&[(0.8, half), (0.5, red)], [0.5 + f32::EPSILON, 0.5, 0.0, 1.0]);
        assert_eq!(other.proof_text(1), "2 ulp from the picture, blended over: the device rounds where it blends");
        // Nothing is known of the picture behind all of them.
        let none = of(&[(0.8, half), (0.5, half)], [0.1, 0.75, 0.9, 1.0]);
        assert_eq!((states(&none), none.is_proven(0)), (vec![Blended, Blended], false));
        assert!(none.proof_text(0).contains("ulp from the picture: a later pass changes it"), "{}", none.proof_text(0));
        // Of two at the same depth, the one that is seen covers the other.
        let same = of(&[(0.5, half.map(|_| [0.0, 1.0, 0.0, 1.0])), (0.5, red)], [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(states(&same), [Covered(1), Seen]);
    }
}
