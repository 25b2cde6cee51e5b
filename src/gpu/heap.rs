//! The process's heap, most of which drivers, decoders and compilers fill and free.

/// Returns freed memory to the system. glibc keeps what each thread has freed in an arena of that thread, where other
/// threads cannot use it: 40 MB after a model with five images was decoded and its shaders compiled. Takes about a
/// millisecond, so it is for the end of a load and not for a frame. Does nothing with other C libraries.
pub fn return_freed_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            fn malloc_trim(pad: usize) -> std::ffi::c_int;
        }
        // SAFETY: malloc_trim(3) may be called at any time from any thread, and leaves allocated memory alone.
        unsafe { malloc_trim(0) };
    }
}
