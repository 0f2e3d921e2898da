//! Any bytes as NC programs.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    opennck_fuzz::nc_program::judge(input);
});
