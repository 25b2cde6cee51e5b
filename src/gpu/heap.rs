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

/// Gives every block of at least 8 MiB pages of its own, so that freeing a decoded image returns its memory at once. glibc
/// starts with a lower limit, but raises it to the size of the largest freed block, up to 32 MiB. With this, the peak of
/// `specula render` no longer depends on how threads interleave. Call it first in `main`. Does nothing with other C libraries.
pub fn return_large_blocks() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        unsafe extern "C" {
            fn mallopt(parameter: std::ffi::c_int, value: std::ffi::c_int) -> std::ffi::c_int;
        }
        const M_MMAP_THRESHOLD: std::ffi::c_int = -3;
        // SAFETY: mallopt(3) with a valid parameter and value. It leaves allocated memory alone.
        unsafe { mallopt(M_MMAP_THRESHOLD, 8 * 1024 * 1024) };
    }
}
