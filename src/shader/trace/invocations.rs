//! Which invocations of a stage are logged, and what their result is compared with.

use serde::Serialize;

use crate::shader::StageKind;
use crate::shader::annotation::pass::PassFormat;
use crate::shader::library::Stage;

/// The invocations of a stage that are logged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Invocations {
    /// The fragments at a pixel of the image that the stage draws, counted from its upper left corner.
    Pixel(u32, u32),
    /// The vertices of a triangle, by `gl_VertexIndex`.
    Triangle([u32; 3]),
    /// The vertices of a quad, by `gl_InstanceIndex`.
    Quad(u32),
    /// One of a compute stage, by `gl_GlobalInvocationID`.
    Compute([u32; 3]),
}

impl Invocations {
    /// The numbers that the log has of them.
    pub(super) fn words(self) -> [u32; 3] {
        match self {
            Self::Pixel(x, y) => [x, y, 0],
            Self::Quad(quad) => [quad, 0, 0],
            Self::Triangle(words) | Self::Compute(words) => words,
        }
    }
}

/// Which image holds the result of a traced fragment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// The picture, before the tone map: full floats, with flags in alpha.
    Picture,
    /// An image of a pass, by the name of the pass.
    Image(String, PassFormat),
    /// The display: four bytes.
    Display,
    /// None that can be read: it is not known whether the result is right.
    Unknown,
}

impl Target {
    /// Its name in a sentence.
    pub fn name(&self) -> String {
        match self {
            Self::Picture | Self::Unknown => "the picture".to_owned(),
            Self::Image(name, _) => format!("the image {name}"),
            Self::Display => "the display".to_owned(),
        }
    }

    /// Whether the value that a stage has written is the one that is read, both as bits of floats. Formats of less than 32 bits round.
    pub(super) fn holds(&self, written: [u32; 4], read: [u32; 4]) -> bool {
        let each = |is_same: &dyn Fn(f32, f32) -> bool| {
            written.iter().zip(read).all(|(a, b)| is_same(f32::from_bits(*a), f32::from_bits(b)))
        };
        match self {
            Self::Image(_, PassFormat::Rgba16f) => each(&|a, b| {
                // A device may round in either direction.
                let [a, b] = [a, b].map(|number| half::f16::from_f32(number).to_bits());
                a.abs_diff(b) <= 1
            }),
            Self::Display => each(&|a, b| (a.clamp(0.0, 1.0) - b).abs() <= 0.5 / 255.0 + 1e-5),
            Self::Picture | Self::Image(..) | Self::Unknown => written == read,
        }
    }

    /// How exactly it holds a value, for a reader; empty for full floats.
    pub(super) fn precision(&self) -> &'static str {
        match self {
            Self::Image(_, PassFormat::Rgba16f) => ", as half floats",
            Self::Display => ", in 8 bits",
            Self::Picture | Self::Image(..) | Self::Unknown => "",
        }
    }
}

/// A stage that can be traced.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct TraceableStage {
    /// Its path.
    pub path: String,
    /// Its name for people: [`ShaderSet::name_of`](crate::shader::ShaderSet::name_of).
    pub name: String,
    /// Its purpose, for a list.
    pub label: String,
}

/// The name of the `vec4` that a fragment stage writes: that at location 0, or the first.
pub(super) fn color_of(stage: &Stage) -> Option<&str> {
    let colors = || stage.reflection.outputs.iter().filter(|output| output.type_name == "vec4");
    let color = colors().find(|output| output.location == 0).or_else(|| colors().next());
    color.filter(|_| stage.kind == StageKind::Fragment).map(|output| output.name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_round_what_is_written() {
        let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        let (written, half) = (bits([0.1, 2.0, -3.3, 1.0]), bits([0.099_975_586, 2.0, -3.300_781_2, 1.0]));
        let image = |format| Target::Image("blur".into(), format);
        assert!(image(PassFormat::Rgba16f).holds(written, half));
        assert!(!image(PassFormat::Rgba32f).holds(written, half) && !Target::Picture.holds(written, half));
        assert!(!image(PassFormat::Rgba16f).holds(written, bits([0.1001, 2.0, -3.3, 1.0])));
        let written = bits([0.3, 2.0, -3.3, 1.0]);
        let shown = bits([77.0 / 255.0, 1.0, 0.0, 1.0]);
        assert!(Target::Display.holds(written, shown));
        assert!(!Target::Display.holds(written, bits([75.0 / 255.0, 1.0, 0.0, 1.0])));
    }
}
