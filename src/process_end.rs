//! The end of the process.

/// Ends the process with this exit code, without destructors of statics. Those of the shader compiler and of the graphics driver would
/// free what other threads still use, which crashes the process at its end. Output that is buffered is lost.
pub fn end_process(code: u8) -> ! {
    #[cfg(unix)]
    signal_hook::low_level::exit(code.into());
    #[cfg(not(unix))]
    std::process::exit(code.into());
}
