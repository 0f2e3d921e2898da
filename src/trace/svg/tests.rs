//! Tests of parts of the drawing against literal text.

use super::*;

#[test]
fn tenths_are_pixels_with_one_decimal() {
    assert_eq!((px(0), px(-5), px(1234), px(1230)), ("0".into(), "-0.5".into(), "123.4".into(), "123".into()));
}

#[test]
fn texts_cannot_break_out_of_the_file() {
    assert_eq!(escaped("a < b && \"c\"\n\u{1}>"), "a &lt; b &amp;&amp; &quot;c&quot; \u{FFFD}&gt;");
}

#[test]
fn long_texts_are_wrapped_between_words() {
    assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
    assert_eq!(wrapped("indivisible", 4), ["indivisible"]);
}
