//! The printed examples of both manuals, as they are printed (isg.md 3.6, E-25). The TwinCAT manual prints the same text but for a capital
//! letter and an ellipsis.

use super::{Channel, program};
use crate::isg::language::{
    AxisReference, AxisRequest, Block, Command, Conflicts, End, Form, GantryTargets, Interpreter, Link, LinkOff, Pair,
    check,
};

const SOFT_GANTRY: &str = include_str!("printed/soft_gantry.nc");
const FACTORS: &str = include_str!("printed/factors.nc");
const FACTORS_BY_NUMBER: &str = include_str!("printed/factors_by_number.nc");
const TOOL_CHANGE: [&str; 2] = [include_str!("printed/tool_change.nc"), include_str!("printed/tool_change_twincat.nc")];
const REQUEST_SLAVES: &str = include_str!("printed/request_slaves.nc");
const RESTORE: [&str; 2] = [include_str!("printed/restore.nc"), include_str!("printed/restore_twincat.nc")];

fn lenient(text: &str) -> Vec<Block> {
    Channel::new(&[("part.nc", text)]).run(true).unwrap()
}

/// The first slip: its name, line and column, and what the text begins with.
fn first_slip(text: &str) -> (String, u32, u32, String) {
    let found = check(&program("part.nc", text), &[], false);
    let first = &found.iter().find(|finding| !finding.is_warning).unwrap().fault;
    (first.code.to_string(), first.line, first.column, first.text.clone())
}

fn pair(slave: &str, master: &str, form: Form) -> Pair {
    Pair { slave: AxisReference::Name(slave.to_owned()), master: AxisReference::Name(master.to_owned()), form }
}

fn numbers(slave: u32, master: u32, form: Form) -> Pair {
    Pair { slave: AxisReference::Number(slave), master: AxisReference::Number(master), form }
}

fn link(group: i64, pairs: Vec<Pair>) -> Command {
    Command::Link(Link { group, pairs })
}

/// SG-01, SG-02, SG-19, SG-26, B40
#[test]
fn the_soft_gantry_example_defines_its_groups() {
    let blocks = lenient(SOFT_GANTRY);
    let commands: Vec<_> = blocks.iter().filter_map(|block| block.command.clone()).collect();
    let limits = Form::Gantry { limits: Some([0.01, 0.25]) };
    let from_list = Form::Gantry { limits: None };
    let wanted = [
        link(1, vec![pair("Y2", "Y1", limits)]),
        link(2, vec![pair("Y2", "Y1", from_list)]),
        link(3, vec![pair("Y2", "Y1", Form::Standard)]),
        link(1, vec![pair("Y2", "Y1", limits)]),
        link(2, vec![numbers(8, 2, from_list)]),
    ];
    assert_eq!(commands, wanted);
    assert_eq!(check(&program("part.nc", SOFT_GANTRY), &[], true), []);
    let (code, line, column, text) = first_slip(SOFT_GANTRY);
    assert_eq!((code.as_str(), line, column), ("nc-syntax", 2, 1));
    assert_eq!(text, "`:` alone is no block; a manual writes it for blocks that it leaves out");
}

/// SG-26, B41: `:` is the first slip of the example as a whole; without it, the first line with text behind its command.
#[test]
fn strict_reading_names_the_first_slip_of_the_factor_example() {
    assert_eq!(first_slip(FACTORS).1, 2);
    let (code, line, column, text) = first_slip(&FACTORS.replace("\n:\n", "\n\n"));
    assert_eq!((code.as_str(), line, column), ("nc-syntax", 3, 37));
    assert_eq!(
        text,
        "expected the end of the line behind the command, found `Mirror`; a comment stands in ( … ) or behind `;`"
    );
    let fault = Channel::new(&[("part.nc", &FACTORS.replace("\n:\n", "\n\n"))]).run(false).unwrap_err();
    assert_eq!((fault.block, fault.line, fault.column), (Some(10), 3, 37));
    let (code, line, column, _) = first_slip(FACTORS_BY_NUMBER);
    assert_eq!((code.as_str(), line, column), ("nc-syntax", 2, 32));
}

/// SG-05, SG-26, B01 to B12: each line of the example gives what stands behind it.
#[test]
fn each_line_of_the_factor_example_gives_its_result() {
    let printed = FACTORS.lines().filter(|line| line.starts_with('N'));
    let by_number = FACTORS_BY_NUMBER.lines().filter(|line| line.starts_with('N'));
    let mut count = 0;
    for line in printed.chain(by_number) {
        count += 1;
        let result = Channel::new(&[("part.nc", line)]).run(true);
        if line.ends_with("Error message, program is aborted") {
            let code = result.unwrap_err().code.to_string();
            assert_eq!(code, if line.contains(",0,1]") { "21077" } else { "link-denominator" }, "{line}");
            continue;
        }
        let block = result.unwrap().remove(0);
        let Some(Command::Link(Link { group: 1, pairs })) = &block.command else { panic!("{line}") };
        let form = pairs[0].form;
        let warnings: Vec<_> = block.warnings.iter().map(|warning| warning.code.to_string()).collect();
        let is_warned = line.contains("Warning");
        assert_eq!(
            (warnings.join(" "), form.is_scaled()),
            (if is_warned { "21111" } else { "" }.to_owned(), is_warned),
            "{line}"
        );
        assert_eq!(
            (form.factor(), form.is_monitored()),
            (if line.contains("Mirror") { -1 } else { 1 }, false),
            "{line}"
        );
    }
    assert_eq!(count, 14);
}

/// SG-05, B06: the example as a whole ends at its first error.
#[test]
fn the_factor_example_as_a_program_is_aborted_at_n60() {
    let mut channel = Channel::new(&[("part.nc", FACTORS)]);
    let mut interpreter = Interpreter::new("PART.NC", true);
    for number in [10, 20, 30, 40, 50] {
        let Ok(crate::isg::language::Prepared::Block(block)) = interpreter.next(&mut channel) else { panic!() };
        assert_eq!((block.origin.number, block.warnings.len()), (Some(number), 0));
    }
    let fault = interpreter.next(&mut channel).unwrap_err();
    assert_eq!((fault.code.to_string().as_str(), fault.block, fault.line, fault.column), ("21077", Some(60), 8, 30));
    assert!(interpreter.has_ended());
    let found: Vec<_> = check(&program("part.nc", FACTORS), &[], true)
        .iter()
        .map(|finding| (finding.fault.line, finding.fault.code.to_string(), finding.is_warning))
        .collect();
    let row = |line, code: &str, is_warning| (line, code.to_owned(), is_warning);
    let warnings = (10..=14).map(|line| row(line, "21111", true));
    let wanted: Vec<_> =
        [row(8, "21077", false), row(9, "link-denominator", false)].into_iter().chain(warnings).collect();
    assert_eq!(found, wanted);
}

/// SG-13, SG-26, B38, B40: the blocks in their order, with the trace's values.
#[test]
fn the_tool_change_example_runs_to_m30() {
    for text in TOOL_CHANGE {
        let blocks = lenient(text);
        let order: Vec<_> = blocks.iter().map(|block| block.origin.block()).collect();
        let wanted = [300, 310, 150, 160, 30, 40, 50, 80, 90, 110, 180, 190, 200, 400, 410];
        assert_eq!(order, wanted);
        let axes = |index: usize| {
            blocks[index].axes.iter().map(|(name, value)| format!("{name}{value}")).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(axes(0), "X20 Y20 Z40 C50 Y_S20 Z_S40 C_S50");
        assert_eq!(axes(2), "X10 Y10 Z-20 C90");
        assert_eq!(
            (axes(3).as_str(), &blocks[3].g, blocks[3].centre),
            ("X20 Y20", &vec![2], [Some(10.0), Some(10.0), None])
        );
        assert_eq!(axes(5), "Y1000 Z100 C0 Y_S1000 Z_S100 C_S0");
        assert_eq!((blocks[6].tool, blocks[6].tool_data), (Some(10.0), Some(10.0)));
        let command = |index: usize| blocks[index].command.as_ref();
        assert_eq!(command(1), Some(&Command::LinkOn(Some(1))));
        assert_eq!(command(4), Some(&Command::LinkOff(LinkOff::Last)));
        assert_eq!(command(8), Some(&Command::LinkOn(Some(1))));
        assert_eq!(command(13), Some(&Command::LinkOff(LinkOff::Last)));
        let ends = blocks.iter().filter_map(|block| block.end).collect::<Vec<_>>();
        assert_eq!(ends, [End::Subroutine, End::Subroutine, End::Program]);
        assert_eq!(check(&program("part.nc", text), &[], true), []);
    }
}

/// SG-26, B14, B40: `N20 M17` behind the comment that is never closed is executed, so the initialisation subroutine can be called.
#[test]
fn the_initialisation_subroutine_defines_the_group_and_returns() {
    for text in TOOL_CHANGE {
        let text = text.replace("(Start synchronous operation)", "LL UP_INIT_ACHS_KOPPL");
        let blocks = lenient(&text);
        let order: Vec<_> = blocks.iter().take(4).map(|block| block.origin.block()).collect();
        assert_eq!(order, [300, 10, 20, 310]);
        let pairs = [("Y_S", "Y"), ("Z_S", "Z"), ("C_S", "C")].map(|(slave, master)| pair(slave, master, Form::Bare));
        assert_eq!(blocks[1].command, Some(link(1, pairs.into())));
        assert_eq!(blocks[2].end, Some(End::Subroutine));
    }
}

/// SG-26: strict reading does not take the second line of a comment for one, nor lines behind the last M17 for the main program.
#[test]
fn strict_reading_names_the_slips_of_the_tool_change_example() {
    for text in TOOL_CHANGE {
        let found: Vec<_> = check(&program("part.nc", text), &[], false)
            .into_iter()
            .map(|finding| (finding.fault.line, finding.fault.column, finding.fault.code.to_string()))
            .collect();
        let syntax = |line, column| (line, column, "nc-syntax".to_owned());
        // `master and …`, `calculation.) )`, `:` twice, `defined by …`, the main program, `:`
        let mut wanted = [14, 15, 17, 19, 21, 37, 41].map(|line| syntax(line, 1)).to_vec();
        // A warning: to strict reading M30 belongs to the last subroutine.
        wanted.push((43, 6, "nc-call".to_owned()));
        assert_eq!(found, wanted);
        let fault = Channel::new(&[("part.nc", text)]).run(false).unwrap_err();
        assert_eq!((fault.code.to_string().as_str(), fault.block, fault.column), ("nc-syntax", Some(300), 1));
        assert!(fault.text.starts_with("the file has no main program"), "{}", fault.text);
    }
}

/// HG-14, HG-15, HG-16, B65, B66, B67: these examples have no slip; strict reading runs them, too.
#[test]
fn the_gantry_examples_run_in_both_ways_of_reading() {
    let request = |name: &str, number, index| Command::CallAxis {
        is_fast: false,
        conflicts: Conflicts::default(),
        requests: vec![AxisRequest { name: name.to_owned(), number, index, options: Vec::new() }],
    };
    let gantry = |is_on| {
        let targets = GantryTargets::Masters(vec![AxisReference::Name("X".to_owned())]);
        Command::Gantry { is_on, targets }
    };
    for is_lenient in [false, true] {
        for (text, is_restored) in [(REQUEST_SLAVES, false), (RESTORE[0], true), (RESTORE[1], true)] {
            let blocks = Channel::new(&[("part.nc", text)]).run(is_lenient).unwrap();
            let commands: Vec<_> = blocks.iter().filter_map(|block| block.command.clone()).collect();
            let mut wanted = vec![gantry(false), request("Axis_X1", 5, 4), request("Axis_X2", 6, 5)];
            wanted.extend(is_restored.then(|| gantry(true)));
            assert_eq!(commands, wanted);
            let moves: Vec<_> =
                blocks.iter().flat_map(|block| &block.axes).map(|(name, to)| format!("{name}={to}")).collect();
            let last = if is_restored { " X=65" } else { "" };
            assert_eq!(moves.join(" "), format!("X=47 Axis_X1=11 Axis_X2=12{last}"));
            assert_eq!(blocks.last().unwrap().end, Some(End::Program));
            assert_eq!(check(&program("part.nc", text), &[], is_lenient), []);
        }
    }
}
