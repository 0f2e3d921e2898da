//! Arbitrary bytes as choices of a grammar, so that almost every request is valid.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    opennck_fuzz::conversation::judge(&opennck_fuzz::grammar::stream(input));
});
