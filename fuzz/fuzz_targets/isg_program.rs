//! Any bytes as NC programs of the ISG kernel.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    opennck_fuzz::isg_program::judge(input);
});
