//! Arbitrary bytes as the stream of a client.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    opennck_fuzz::conversation::judge(input);
});
