//! How a picture's values become colors: range, channels, colormap and dither, from the settings and the mode.
//!
//! The range belongs to the display and not to the rendered frame: `Display::constants` writes it to the last members
//! of `Frame`, so a change of range reruns the tone map only. An automatic range comes from a sample of the frame
//! (`render/view/range_sample.rs`): a nearest-neighbor blit picks up to 16,384 pixels, which are read when the frame
//! has finished, and the next frame uses their 1st and 99th percentile, rounded. Limits stay while at most a tenth of
//! the values is cut off and at most a third of the range is empty, so they do not flicker. A highlight of a few pixels
//! may lie beyond an automatic range. `render` draws, reads the sample and tone maps once more, so files do not depend
//! on what was drawn before.

use crate::interface::Frame;
use crate::settings::{Channels, Colormap, ViewRange, ViewSettings};
use crate::shader::{Encode, Mode, expression};

/// How the display maps the values of a mode to colors. The mapping changes no value, so a change needs no new render.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    range: Range,
    channels: Channels,
    colormap: Colormap,
    dither: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Range {
    /// As the mode stores its values.
    #[default]
    Encoded,
    Fixed(f32, f32),
    /// The range of the values in the frame (automatic range).
    Measured {
        /// Whether 0 lies in the middle.
        is_signed: bool,
        /// Whether values that lie within 0..1 are stored as they are.
        keeps_unit: bool,
    },
}

/// The smallest and the largest value that the display shows.
pub type Limits = (f32, f32);

impl Display {
    /// Returns the display mapping that `view` selects for pictures of `mode`.
    pub(crate) fn new(view: &ViewSettings, mode: Option<&Mode>) -> Self {
        let Some(mode) = mode else { return Self::default() };
        let is_signed = mode.encode == Encode::Vector;
        let own = mode.range.map_or(Range::Encoded, |(low, high)| Range::Fixed(low, high));
        // Vectors without a unit are directions, colors without a unit reflectances: both are bounded.
        let may_leave = mode.encode == Encode::Data || mode.pass.is_some() || !mode.unit.is_empty();
        let range = match view.range {
            ViewRange::Fixed(low, high) => Range::Fixed(low, high),
            ViewRange::Fit => Range::Measured { is_signed, keeps_unit: false },
            ViewRange::Auto if !mode.tonemap && mode.range.is_none() && may_leave => {
                // Most variables of a shader fill only a small part of 0..1.
                let keeps_unit = mode.unit.is_empty() && mode.slug != expression::MODE;
                Range::Measured { is_signed, keeps_unit }
            }
            ViewRange::Auto | ViewRange::Mode => own,
        };
        let is_number = mode.components == 1 || view.channels != Channels::Rgb;
        let colormap = if view.colormap == Colormap::None { mode.colormap } else { view.colormap };
        let colormap = if is_number { colormap } else { Colormap::None };
        Self { range, channels: view.channels, colormap, dither: view.dither }
    }

    /// Whether it maps values by range, channels or colormap, and not as the mode stores them.
    pub(crate) fn maps_values(&self) -> bool {
        self.range != Range::Encoded || self.channels != Channels::Rgb || self.colormap != Colormap::None
    }

    /// Whether the range is automatic: it follows the values of the frame.
    pub fn is_measured(&self) -> bool {
        matches!(self.range, Range::Measured { .. })
    }

    /// The limits for values within 0..1 (directions: -1..1), if the range is automatic.
    pub(crate) fn unit_limits(&self) -> Option<Limits> {
        match self.range {
            Range::Measured { is_signed, .. } => Some((if is_signed { -1.0 } else { 0.0 }, 1.0)),
            Range::Encoded | Range::Fixed(..) => None,
        }
    }

    /// The colors that stand for a number.
    pub fn colormap(&self) -> Colormap {
        self.colormap
    }

    /// The limits for a frame in which all but a hundredth of the values at each end lie in `values`. `before`: the limits of the
    /// last frame, which stay while they fit, so that moving content does not flicker. `None`: values are stored as the mode
    /// says.
    pub fn limits(&self, values: Option<Limits>, before: Option<Limits>) -> Option<Limits> {
        match self.range {
            Range::Encoded => None,
            Range::Fixed(low, high) => Some((low, high)),
            Range::Measured { is_signed, keeps_unit } => {
                let (low, high) = values?;
                if keeps_unit && low >= if is_signed { -1.0 } else { 0.0 } && high <= 1.0 {
                    return None;
                }
                let most = low.abs().max(high.abs());
                let (low, high) = if is_signed { (-most, most) } else { (low, high) };
                before.filter(|before| still_fit(*before, (low, high))).or_else(|| Some(rounded(low, high)))
            }
        }
    }

    /// The same frame constants with these limits.
    pub(crate) fn constants(&self, frame: Frame, limits: Option<Limits>) -> Frame {
        let (low, scale) = limits.map_or((0.0, 0.0), |(low, high)| (low, 1.0 / (high - low).max(f32::MIN_POSITIVE)));
        Frame {
            range_low: low,
            range_scale: scale,
            channels: self.channels.id(),
            has_colormap: u32::from(self.colormap != Colormap::None),
            dither: f32::from(u8::from(self.dither)),
            colormap: self.colormap.colors(),
            ..frame
        }
    }
}

/// The range that a legend names: that of the display, or that of the mode; `None` for light, which exposure and tone map bring there.
pub fn legend_limits(mode: &Mode, displayed: Option<Limits>) -> Option<Limits> {
    displayed.or(match mode.encode {
        _ if mode.tonemap => None,
        Encode::Vector => Some((-1.0, 1.0)),
        Encode::Color | Encode::Data => Some((0.0, 1.0)),
    })
}

/// A number with four significant digits, or fewer.
pub fn short(number: f32) -> String {
    let magnitude = number.abs();
    if magnitude != 0.0 && !(1e-3..1e5).contains(&magnitude) {
        return format!("{number:.1e}");
    }
    let decimals = 3_usize.saturating_sub(magnitude.max(1.0).log10() as usize);
    let text = format!("{number:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Whether the limits suit values from `low` to `high`: at most a tenth is cut off, and at most a third of the range is empty.
fn still_fit((before_low, before_high): Limits, (low, high): Limits) -> bool {
    let span = before_high - before_low;
    let fits = |gap: f32| (-0.1..=0.33).contains(&(gap / span));
    fits(low - before_low) && fits(before_high - high)
}

/// Limits around the values, rounded so that a legend is readable.
fn rounded(low: f32, high: f32) -> Limits {
    let (low, high) = (f64::from(low), f64::from(high));
    let span = (high - low).max(1e-3 * high.abs().max(low.abs())).max(1e-6);
    // Two digits of the span: a step is a hundredth to a tenth of it.
    let step = 10.0_f64.powf(span.log10().floor() - 1.0);
    // A value that is already a round number stays, although it is not exact as a float.
    let (first, last) = ((low / step + 1e-3).floor() * step, (high / step - 1e-3).ceil() * step);
    // Values near 0 begin there.
    let first = if first > 0.0 && first < 0.1 * span { 0.0 } else { first };
    (first as f32, if last > first { last } else { first + step } as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn display(mode: &Mode, range: ViewRange) -> Display {
        Display::new(&ViewSettings { range, ..ViewSettings::default() }, Some(mode))
    }

    fn data(unit: &str) -> Mode {
        Mode { encode: Encode::Data, components: 1, unit: unit.into(), ..Mode::default() }
    }

    #[test]
    fn numbers_of_the_legend_are_short() {
        let numbers = [0.0, 1.0, -0.05, 4.9, 1234.5, 0.000_02, 1e7].map(short);
        assert_eq!(numbers, ["0", "1", "-0.05", "4.9", "1234", "2.0e-5", "1.0e7"]);
    }

    #[test]
    fn auto_leaves_what_fits_as_it_is() {
        let roughness = display(&data(""), ViewRange::Auto);
        assert_eq!(roughness.limits(Some((0.2, 0.9)), None), None);
        assert_eq!(roughness.limits(Some((0.2, 4.0)), None), Some((0.0, 4.0)));
        assert_eq!(roughness.limits(Some((1.2, 4.0)), None), Some((1.2, 4.0)));
        let depth = display(&data("m"), ViewRange::Auto);
        assert_eq!(depth.limits(Some((0.2, 0.9)), None), Some((0.2, 0.9)));
        assert_eq!(depth.limits(None, None), None, "nothing is measured yet");
        let watched = Mode { slug: expression::MODE.into(), ..data("") };
        assert_eq!(display(&watched, ViewRange::Auto).limits(Some((0.2, 0.9)), None), Some((0.2, 0.9)));
        assert_eq!(display(&watched, ViewRange::Mode).limits(Some((0.2, 0.9)), None), None);
        let light = Mode { tonemap: true, unit: "cd/m^2".into(), ..Mode::default() };
        assert_eq!(display(&light, ViewRange::Auto).limits(Some((0.0, 9.0)), None), None);
        assert_eq!(display(&light, ViewRange::Fit).limits(Some((0.0, 9.0)), None), Some((0.0, 9.0)));
        assert_eq!(display(&data("m"), ViewRange::Mode).limits(Some((3.0, 9.0)), None), None);
    }

    #[test]
    fn errors_have_zero_in_the_middle() {
        let error = Mode { encode: Encode::Vector, unit: "cd/m^2".into(), ..Mode::default() };
        assert_eq!(display(&error, ViewRange::Auto).limits(Some((-0.02, 0.05)), None), Some((-0.05, 0.05)));
    }

    #[test]
    fn limits_stay_while_the_values_move_a_little() {
        let depth = display(&data("m"), ViewRange::Auto);
        let first = depth.limits(Some((3.04, 4.91)), None).unwrap();
        assert_eq!(first, (3.0, 5.0));
        for values in [(2.9, 4.8), (3.2, 5.1), (3.1, 4.6)] {
            assert_eq!(depth.limits(Some(values), Some(first)), Some(first), "{values:?}");
        }
        assert_ne!(depth.limits(Some((1.0, 2.0)), Some(first)), Some(first));
        assert_ne!(depth.limits(Some((3.1, 3.3)), Some(first)), Some(first));
    }

    #[test]
    fn equal_values_have_a_range() {
        for value in [0.0, 1.0, -7.5, 1e6, 1e-12] {
            let (low, high) = rounded(value, value);
            assert!(low <= value && value <= high && high > low, "{value}: {low}..{high}");
        }
    }
}
