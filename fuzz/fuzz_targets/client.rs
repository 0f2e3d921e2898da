//! Arbitrary bytes as a server's answers to a client.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    let _ = opennck_fuzz::client::judge(input);
});
