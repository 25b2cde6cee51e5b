#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| specula::fuzz::archive(data));
