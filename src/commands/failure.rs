//! Why a command ends early, and the exit code.

use specula::gpu::GpuError;
use specula::headless::HeadlessError;
use specula::message::tell;
use specula::render::UploadError;
use specula::shader::Diagnostic;

use super::output::print_diagnostics;

/// Why a command ends early. `end` prints it.
#[derive(Debug)]
pub enum Failure {
    /// A file is wrong, or a check failed: exit code 1.
    Input(String),
    /// A name or value on the command line or in a look file is wrong: exit code 2.
    Usage(String),
    /// The user's shaders are wrong: exit code 1.
    Shaders(Vec<Diagnostic>),
    /// The command printed the reason already: exit code 1.
    Printed,
    /// There is no usable device or display: exit code 3.
    Device(String),
    /// The window's process has ended with this exit code, and printed the reason already.
    Window(u8),
}

impl Failure {
    /// The exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Shaders(_) | Self::Printed => 1,
            Self::Usage(_) => 2,
            Self::Device(_) => 3,
            Self::Window(code) => *code,
        }
    }

    /// Prints the reason, unless it is printed already.
    pub fn tell(&self) {
        match self {
            Self::Input(message) | Self::Usage(message) | Self::Device(message) => tell(message),
            Self::Shaders(diagnostics) => print_diagnostics(diagnostics),
            Self::Printed | Self::Window(_) => {}
        }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::EndlessLoop(_) => Self::Input(error.to_string()),
            _ => Self::Device(error.to_string()),
        }
    }
}

impl From<HeadlessError> for Failure {
    fn from(error: HeadlessError) -> Self {
        match error {
            HeadlessError::Shaders(diagnostics) => Self::Shaders(diagnostics),
            HeadlessError::Settings(message) => Self::Usage(message),
            HeadlessError::Gpu(error) | HeadlessError::Upload(UploadError::Gpu(error)) => error.into(),
            other => Self::Input(other.to_string()),
        }
    }
}
