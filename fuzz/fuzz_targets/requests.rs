//! Any bytes as choices of a grammar, so that nearly every request is understood.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    opennck_fuzz::conversation::judge(&opennck_fuzz::grammar::stream(input));
});
