//! What a failure says, and the parts of the language that go beyond one verb at one time.

use super::{held, missed};

#[test]
fn a_failed_expect_names_every_false_item_and_only_those() {
    let text = missed("[[step]]\nset = { MB0 = 5 }\n[[step]]\nexpect = [\n\"MB0 == 5\",\n\"MB0 > 5\",\n\"MB1 == 1\"]");
    for line in [
        "s.toml:8: 2 of 3 expectations are false (at 0.000 s)",
        "  line 8: `MB0 > 5` is false\n    MB0 = 5\n",
        "  line 9: `MB1 == 1` is false\n    MB1 = 0\n",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(!text.contains("MB0 == 5"), "{text}");
    let one = missed("[[step]]\nexpect = [\"1\", \"MB1 == 1\"]");
    assert!(one.starts_with("s.toml:4: expected `MB1 == 1`, but it is false (at 0.000 s)\n  MB1 = 0"), "{one}");
}

#[test]
fn a_failed_image_names_every_other_byte() {
    let text = missed("[[step]]\nimage = { MB0 = 0, MB1 = 1, MB2 = \"2#10\" }");
    assert!(text.starts_with("s.toml:4: expected MB1 = 2#00000001, found 2#00000000 (at 0.000 s)\n"), "{text}");
    assert!(text.contains("line 4: expected MB2 = 2#00000010, found 2#00000000"), "{text}");
}

#[test]
fn a_channel_that_stored_data_create_can_be_written_after_power_on() {
    let step = "[[step]]\nmachine_data = { \"10010[1]\" = 1 }\n[[step]]\npower_on = true\n[[step]]\nset = { \"DB22.DBX7.1\" = 1 }";
    held(step);
}
