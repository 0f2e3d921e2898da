//! Tests of PLC images.

use crate::image::{Memory, OverrideCoding, Preset, SINUMERIK, override_code};

use super::{SL, names, names_828d};

fn memory(text: &str) -> Result<Memory, crate::source::Problem> {
    Memory::from_preset(&Preset::parse(text, "p.toml")?, &names(), OverrideCoding::of(&SINUMERIK))
}

fn refused(text: &str) -> String {
    memory(text).unwrap_err().to_string()
}

fn raw(memory: &Memory, text: &str) -> u64 {
    memory.read(names().resolve(memory, text).unwrap())
}

const EXAMPLE: &str = r#"
[areas]
M = 512
T = 8
[[db]]
number = 1000
size = 2048
name = "recipes"
values = { "DBX0.3" = 1, "DBW2" = 250, "DBD4:REAL" = 1.5, "DBW8:INT" = -7, "DBB10" = "2#1010_0001", "DBX11.0" = true }
[[db]]
number = 1001
fill = "8C 00 FF"
size = 8
[[db]]
number = 2
size = 10
[interface]
"X.feed_override" = "100%"
"CHAN1.rapid_traverse_override" = "0%"
"DB33.DBX12.7" = true
"mode_group_1.ref_selected" = 1
"M300.1" = 1
"#;

#[test]
fn an_image_declares_areas_blocks_and_starting_values() {
    let memory = memory(EXAMPLE).unwrap();
    assert_eq!((memory.flags.len(), memory.inputs.len(), memory.timers.len()), (512, 128, 8));
    let block = memory.blocks.get(1000).unwrap();
    assert_eq!(block.len(), 2048);
    assert_eq!(block[..12], [0b1000, 0, 0, 250, 0x3F, 0xC0, 0, 0, 0xFF, 0xF9, 0xA1, 1]);
    assert_eq!(memory.blocks.get(1001).unwrap()[..], [0x8C, 0, 0xFF, 0x8C, 0, 0xFF, 0x8C, 0]);
    assert_eq!(memory.blocks.get(2).unwrap().len(), 10, "a declared block replaces the standard one");
    assert_eq!(memory.blocks.get(4).unwrap().len(), 256);
    assert_eq!(memory.blocks.iter().find(|b| b.number == 1000).unwrap().name.as_deref(), Some("recipes"));
    assert_eq!(raw(&memory, "DB31.DBB0"), 0b11010, "position 19 of the switch in Gray code");
    assert_eq!(raw(&memory, "DB21.DBB5"), 1);
    assert_eq!(raw(&memory, "XF.deceleration_reference_point_approach"), 1);
    assert_eq!(raw(&memory, "DB11.DBX5.2"), 1);
    assert!(memory.flags.bit(300, 1));
}

#[test]
fn an_empty_image_is_the_memory_without_an_image() {
    let empty = Memory::after_power_on(&names(), OverrideCoding::of(&SINUMERIK));
    assert_eq!(memory("").unwrap(), empty);
}

#[test]
fn the_profile_decides_which_numbers_are_interface_blocks() {
    let text = "[[db]]\nnumber = 3900\nsize = 4\n[interface]\n\"X.pulse_enable\" = 1\n";
    assert!(memory(text).is_ok());
    let preset = Preset::parse(text, "p.toml").unwrap();
    let problem = Memory::from_preset(&preset, &names_828d(), OverrideCoding::of(&SINUMERIK)).unwrap_err().to_string();
    assert!(problem.starts_with("p.toml:2:") && problem.contains("DB3900, an interface block"), "{problem}");
    let on_828d = Preset::parse("[interface]\n\"DB3800.DBX4001.7\" = 1\n", "p.toml").unwrap();
    let memory = Memory::from_preset(&on_828d, &names_828d(), OverrideCoding::of(&SINUMERIK)).unwrap();
    assert_eq!(memory.read(memory.locate(&"DB31.DBX21.7".parse().unwrap(), SL).unwrap()), 1);
}

#[test]
fn every_mistake_is_reported_with_file_and_line() {
    for (text, line, what) in [
        ("\n[[db]]\nnumber = 31\nsize = 4", 3, "DB31, an interface block"),
        ("[[db]]\nnumber = 10\nsize = 4", 2, "DB10, an interface block"),
        ("[[db]]\nnumber = 0\nsize = 4", 2, "from 1 to 65535"),
        ("[[db]]\nnumber = 70000\nsize = 4", 2, "from 1 to 65535"),
        ("[[db]]\nnumber = 5000\nsize = 65536", 3, "65535"),
        ("[[db]]\nnumber = 5000\nsize = 0", 3, "from 1"),
        ("[[db]]\nnumber = 5000\nsize = -1", 3, "from 1"),
        ("[[db]]\nnumber = 5000", 1, "`size`"),
        ("[[db]]\nsize = 5", 1, "`number`"),
        ("[[db]]\nnumber = \"5\"\nsize = 5", 2, "the text"),
        ("[[db]]\nnumber = 1000\nsize = 4\n[[db]]\nnumber = 1000\nsize = 4", 5, "DB1000 again"),
        ("[[db]]\nnumber = 1000\nsize = 4\nsise = 4", 4, "`sise`"),
        ("[[db]]\nnumber = 1000\nsize = 4\nfill = \"8C0\"", 4, "hexadecimal"),
        ("[[db]]\nnumber = 1000\nsize = 4\nfill = \"\"", 4, "hexadecimal"),
        ("[[db]]\nnumber = 1000\nsize = 4\nfill = \"+1\"", 4, "hexadecimal"),
        ("[[db]]\nnumber = 1000\nsize = 1\nfill = \"00 01\"", 4, "at most 1 bytes"),
        ("[[db]]\nnumber = 1000\nsize = 4\nname = 7", 4, "a name"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBW3\" = 1 }", 4, "4 bytes of DB1000"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBX0.8\" = 1 }", 4, "0 to 7"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"X0.1\" = 1 }", 4, "an address in the block"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBW0\" = 1, \"DBB1\" = 1 }", 4, "overlaps `DB1000.DBW0`"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBB0\" = 256 }", 4, "from -128 to 255"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBW0:INT\" = 32768 }", 4, "from -32768 to 32767"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBX0.0\" = 2 }", 4, "from 0 to 1"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBX0.0\" = -1 }", 4, "from 0 to 1"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBB0\" = true }", 4, "found true"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBD0\" = 1.5 }", 4, "a whole number"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBD0:REAL\" = 1e39 }", 4, "fits a REAL"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBB0\" = \"x\" }", 4, "the text \"x\""),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBB0\" = [1] }", 4, "one value"),
        ("[[db]]\nnumber = 1000\nsize = 4\nvalues = { \"DBB0\" = \"50%\" }", 4, "a plain number"),
        ("[areas]\nM = 65536", 2, "65535"),
        ("[areas]\nN = 1", 2, "`N`"),
        ("[area]\nM = 1", 1, "`area`"),
        ("[interface]\n\"X.controler_enable\" = 1", 2, "`X.controller_enable`"),
        ("[interface]\n\"DB31.DBX148.0\" = 1", 2, "148 bytes"),
        ("[interface]\n\"X.gantry_axis\" = 1", 2, "which the NCK writes"),
        ("[interface]\n\"DB31.DBB101\" = 1", 2, "which the NCK writes"),
        ("[interface]\nX.controller_enable = 1", 2, "put the key in quotes"),
        ("[interface]\n\"X.feed_override\" = \"55%\"", 2, "a percentage of the override switch"),
        ("[interface]\n\"X.pulse_enable\" = \"100%\"", 2, "a plain number"),
        ("[interface]\n\"X.pulse_enable\" = 1\n\"DB31.DBX21.7\" = 1", 3, "overlaps `X.pulse_enable`"),
        ("[interface]\n\"DB21.DBW31\" = 1", 2, "two writers"),
        ("interface = 1", 1, "the integer 1"),
    ] {
        let problem = refused(text);
        assert!(problem.starts_with(&format!("p.toml:{line}: ")), "{text}\n=> {problem}");
        assert!(problem.contains(what), "{text}\n=> {problem}");
    }
}

#[test]
fn an_override_is_a_position_in_gray_code_or_per_cent_in_binary() {
    let gray = [
        (0, 0b00001),
        (1, 0b00011),
        (2, 0b00010),
        (4, 0b00110),
        (10, 0b00100),
        (50, 0b01110),
        (100, 0b11010),
        (120, 0b11100),
    ];
    for (percent, code) in gray {
        assert_eq!(override_code(percent, true), Some(code), "{percent} %");
    }
    assert_eq!(override_code(55, true), None);
    assert_eq!(override_code(55, false), Some(55));
    assert_eq!(
        (override_code(200, false), override_code(201, false), override_code(300, true)),
        (Some(200), None, None)
    );
    let binary = OverrideCoding { axis_is_gray: false, ..OverrideCoding::of(&SINUMERIK) };
    let preset =
        Preset::parse("[interface]\n\"X.feed_override\" = \"55%\"\n\"CHAN1.feed_override\" = \"100%\"", "p").unwrap();
    let memory = Memory::from_preset(&preset, &names(), binary).unwrap();
    assert_eq!((raw(&memory, "DB31.DBB0"), raw(&memory, "DB21.DBB4")), (55, 0b11010));
    // MD12070 begins with 50 %; code 0 stays at power on (S-04).
    assert_eq!(raw(&memory, "DB31.DBB19"), 0);
    for (text, code) in [("50%", 0b0001), ("100%", 0b1110), ("120%", 0b1000)] {
        let preset = format!("[interface]\n\"X.spindle_override\" = \"{text}\"");
        let memory = Memory::from_preset(&Preset::parse(&preset, "p").unwrap(), &names(), binary).unwrap();
        assert_eq!(raw(&memory, "DB31.DBB19"), code, "{text}");
    }
}
