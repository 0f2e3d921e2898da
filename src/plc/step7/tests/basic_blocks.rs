//! The panel, NC variables, services and tools of the basic program, called by AWL.

use super::basic_program::{blocks, start, started};
use crate::plc::bench::Bench;
use crate::plc::{NcOrder, NcVariable};
use crate::units::ChannelNumber;

const PANEL: &str =
    "CALL FC 19 ( BAGNo := B#16#1, ChanNo := B#16#1, SpindleIFNo := B#16#2, FeedHold := M 0.0, SpindleHold := M 0.1 );";

/// The stop keys of bytes 2 are not pressed: 1.
const RELEASED: u64 = 0b0001_0101;

fn panel(cyclic: &str) -> (Bench, crate::plc::step7::LoadedProgram) {
    let startup = "CALL FB 1, DB 7 ( MCP1In := P#I 20.0, MCP1Out := P#Q 20.0 );";
    let (mut bench, program) = started(&blocks(startup, cyclic));
    bench.set("IB22", RELEASED);
    (bench, program)
}

/// P-135: the keys of the modes and increments; the last one counts.
#[test]
fn fc19_selects_modes_and_increments_by_the_edge_of_a_key() {
    let (mut bench, mut program) = panel(PANEL);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB11.DBB0"), bench.get("DB11.DBB2")), (0, 0x40), "no mode, continuous");
    bench.set("I20.3", 1);
    bench.set("I21.2", 1);
    bench.scan(&mut program).unwrap();
    bench.set("I20.3", 0);
    bench.set("I21.2", 0);
    bench.scan(&mut program).unwrap();
    // JOG (0.2) and INC 100 (2.2), with DB10.DBX57.0.
    assert_eq!((bench.get("DB11.DBB0"), bench.get("DB11.DBB2"), bench.get("DB10.DBX57.0")), (4, 4, 1));
    bench.set("I21.6", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB11.DBB1"), bench.get("DB11.DBB2")), (4, 0x40), "REF, with continuous");
    // A strobe of the HMI counts like a key.
    bench.set("DB11.DBX4.0", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB11.DBB0"), bench.get("DB11.DBB1")), (1, 0));
}

#[test]
fn fc19_moves_the_axis_that_was_selected_last() {
    let (mut bench, mut program) = panel(PANEL);
    bench.set("I25.7", 1); // Y
    bench.set("I24.7", 1); // plus
    bench.set("I24.5", 1); // rapid traverse
    bench.set("IB23", 0b0010_1010); // single block, and position 01010
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB31.DBB4"), bench.get("DB32.DBB4") & 0xE0), (0, 0xA0));
    assert_eq!((bench.get("DB31.DBB0"), bench.get("DB21.DBB4"), bench.get("DB21.DBX0.4")), (10, 10, 1));
    // DB10.DBB9 gives key Y another axis.
    bench.set("DB10.DBB9", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB31.DBB4") & 0xE0, bench.get("DB32.DBB4") & 0xE0), (0xA0, 0));
    // In the workpiece coordinate system the keys are of the geometry axes: DB21.DBX16.7 and 16.5.
    bench.set("I25.4", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB31.DBB4") & 0xE0, bench.get("DB21.DBB16"), bench.get("DB19.DBX0.7")), (0, 0xA0, 1));
}

#[test]
fn fc19_holds_feed_and_spindle_until_their_start_keys() {
    let (mut bench, mut program) = panel(PANEL);
    bench.set("IB22", RELEASED & !0b0001_0100);
    bench.scan(&mut program).unwrap();
    bench.set("IB22", RELEASED);
    bench.scan(&mut program).unwrap();
    let found = ["M0.0", "M0.1", "DB21.DBX6.0", "DB32.DBX4.3", "Q21.6", "Q21.7"].map(|address| bench.get(address));
    assert_eq!(found, [1, 1, 1, 1, 1, 0], "holds, signals, lamps of feed stop and feed start");
    bench.set("IB22", RELEASED | 0b0010_1000);
    bench.scan(&mut program).unwrap();
    let found = ["M0.0", "M0.1", "DB21.DBX6.0", "DB32.DBX4.3", "Q21.6", "Q21.7"].map(|address| bench.get(address));
    assert_eq!(found, [0, 0, 0, 0, 0, 1]);
}

/// P-135: a turning panel has a key for each direction: R2 is +X.
#[test]
fn fc25_has_keys_of_directions() {
    let (mut bench, mut program) = panel(&PANEL.replace("FC 19", "FC 25"));
    bench.set("I25.7", 1);
    bench.set("I25.5", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("DB31.DBB4") & 0xE0, 0xA0, "plus, with rapid traverse");
    bench.set("I25.7", 0);
    bench.set("I25.1", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("DB31.DBB4") & 0xE0, 0x60, "minus");
}

/// R5 of channel 1: area 2 and unit 1 are 41h, column 1, line 6, module 15h.
const ADDRESS: &str = "DATA_BLOCK DB 120\nSTRUCT\na : ARRAY [0 .. 9] OF BYTE := B#16#82, B#16#41, B#16#0, B#16#1, B#16#0, B#16#6, B#16#15, B#16#1, B#16#F, B#16#8;\nvalue : REAL := 7.5;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";

fn r5(line: u16) -> NcVariable {
    NcVariable { area: 2, unit: 1, column: 1, line, module: 0x15 }
}

/// P-136: the answer comes in the first call after the next FC2, for one call.
#[test]
fn fb2_reads_a_variable_after_the_next_fc2() {
    let cyclic = "CALL FC 2; CALL FB 2, DB 130 ( Req := M 0.0, NumVar := 1, Addr1 := P#DB120.DBX 0.0 BYTE 10, Line1 := MW 20, \
                  Error := M 1.0, NDR := M 1.1, State := MW 2, RD1 := P#DB120.DBX 10.0 REAL 1 );";
    let run = |startup: &str, line: u64, values: Vec<(NcVariable, f64)>| {
        let mut bench = Bench::with_axes(&["X"]);
        bench.nc.values = values;
        let mut program = start(&mut bench, &format!("{ADDRESS}{}", blocks(startup, cyclic)));
        bench.set("MW20", line);
        bench.set("M0.0", 1);
        let mut found = Vec::new();
        for _ in 0..3 {
            bench.scan(&mut program).unwrap();
            found.push(bench.get("MB1"));
        }
        (found, bench.get("MW2"), bench.get("DB120.DBD10"))
    };
    let with = "CALL FB 1, DB 7 ( NCKomm := TRUE );";
    let real = |value: f32| u64::from(value.to_bits());
    assert_eq!(run(with, 0, vec![(r5(6), 1.25)]), (vec![0, 2, 0], 0, real(1.25)));
    assert_eq!(
        run(with, 9, vec![(r5(9), -3.0)]),
        (vec![0, 2, 0], 0, real(-3.0)),
        "Line1 replaces the line of the address"
    );
    assert_eq!(run(with, 0, vec![]), (vec![0, 1, 0], 0x0101, real(7.5)), "variable 1 does not exist");
    assert_eq!(run("", 0, vec![(r5(6), 1.25)]), (vec![0, 1, 0], 7, real(7.5)), "NCKomm is 0");
}

/// P-136: State 5: the value is a REAL, and RD1 has 2 bytes, or a type without a number.
#[test]
fn fb2_reports_a_format_that_does_not_fit() {
    for target in ["P#DB120.DBX 10.0 BYTE 2", "P#DB120.DBX 10.0 CHAR 4"] {
        let cyclic = format!(
            "CALL FC 2; CALL FB 2, DB 130 ( Req := M 0.0, NumVar := 1, Addr1 := P#DB120.DBX 0.0 BYTE 10, \
             Error := M 1.0, NDR := M 1.1, State := MW 2, RD1 := {target} );"
        );
        let mut bench = Bench::with_axes(&["X"]);
        bench.nc.values = vec![(r5(6), 1.25)];
        let startup = "CALL FB 1, DB 7 ( NCKomm := TRUE );";
        let mut program = start(&mut bench, &format!("{ADDRESS}{}", blocks(startup, &cyclic)));
        bench.set("M0.0", 1);
        bench.scan(&mut program).unwrap();
        bench.scan(&mut program).unwrap();
        // The high byte is the number of the variable.
        assert_eq!((bench.get("MB1"), bench.get("MW2")), (1, 0x0105), "{target}");
    }
}

#[test]
fn fb3_orders_that_a_variable_is_written() {
    let cyclic = "CALL FC 2; CALL FB 3, DB 130 ( Req := M 0.0, NumVar := MW 4, Addr1 := P#DB120.DBX 0.0 BYTE 10, \
                  Error := M 1.0, Done := M 1.1, State := MW 2, SD1 := P#DB120.DBX 10.0 REAL 1 );";
    for (count, refuses, wanted) in [(1, false, (2, 0, 1)), (1, true, (1, 0x0103, 0)), (0, false, (1, 12, 0))] {
        let mut bench = Bench::with_axes(&["X"]);
        bench.nc.values = vec![(r5(6), 0.0)];
        bench.nc.refuses = refuses;
        let startup = "CALL FB 1, DB 7 ( NCKomm := TRUE );";
        let mut program = start(&mut bench, &format!("{ADDRESS}{}", blocks(startup, cyclic)));
        bench.set("MW4", count);
        bench.set("M0.0", 1);
        bench.scan(&mut program).unwrap();
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("MB1"), bench.get("MW2"), bench.nc.orders.len()), wanted);
        assert!(bench.nc.orders.iter().all(|order| *order == NcOrder::Write(r5(6), 7.5)));
    }
}

/// P-137: the name of the service is a text, of DB16 or of the program.
#[test]
fn fb4_selects_a_program() {
    let texts = "DATA_BLOCK DB 120\nSTRUCT\npath : STRING [20] := '/_N_MPF_DIR';\nname : STRING [20] := '_N_PART_MPF';\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";
    let cyclic = "CALL FC 2; CALL FB 4, DB 130 ( Req := M 0.0, PIService := DB16.SELECT, Unit := 1, Addr1 := DB120.path, Addr2 := DB120.name, \
                  Error := M 1.0, Done := M 1.1, State := MW 2 );";
    let mut bench = Bench::with_axes(&["X"]);
    let mut program = start(&mut bench, &format!("{texts}{}", blocks("CALL FB 1, DB 7 ( NCKomm := TRUE );", cyclic)));
    bench.set("M0.0", 1);
    bench.scan(&mut program).unwrap();
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("MB1"), 2);
    let first = NcOrder::SelectProgram(ChannelNumber::FIRST, "/_N_MPF_DIR/PART.MPF".to_owned());
    assert_eq!(bench.nc.orders, [first], "the first path that the control knows");
}

/// P-137: without a service, and with an empty text, State is 11.
#[test]
fn fb4_without_a_service_is_an_error() {
    let text = "DATA_BLOCK DB 120\nSTRUCT\nempty : STRING [8];\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";
    for service in ["", "PIService := DB120.empty,"] {
        let cyclic = format!(
            "CALL FC 2; CALL FB 4, DB 130 ( Req := M 0.0, {service} Unit := 1, Error := M 1.0, Done := M 1.1, State := MW 2 );"
        );
        let mut bench = Bench::with_axes(&["X"]);
        let startup = "CALL FB 1, DB 7 ( NCKomm := TRUE );";
        let mut program = start(&mut bench, &format!("{text}{}", blocks(startup, &cyclic)));
        bench.set("M0.0", 1);
        bench.scan(&mut program).unwrap();
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("MB1"), bench.get("MW2")), (1, 11), "{service}");
    }
}

/// P-138: a report ends the task of its interface; a second one without a task is an error.
#[test]
fn fc8_ends_the_task_of_a_load_point() {
    let cyclic = "CALL FC 8 ( Start := M 0.0, TaskIdent := B#16#1, TaskIdentNo := B#16#2, NewToolMag := 1, NewToolLoc := 5, OldToolMag := 0, \
                  OldToolLoc := 0, Status := MW 4, Ready := M 1.0, Error := MW 2 );";
    let (mut bench, mut program) = started(&blocks("", cyclic));
    let mut scan = |tasks: Option<u64>, start: u64, status: u64| {
        if let Some(tasks) = tasks {
            bench.set("DB71.DBB0", tasks);
        }
        bench.set("M0.0", start);
        bench.set("MW4", status);
        bench.scan(&mut program).unwrap();
        (bench.get("M1.0"), bench.get("MW2"), bench.get("DB71.DBB0"))
    };
    assert_eq!(scan(None, 1, 1), (0, 2, 0), "no task is active");
    assert_eq!(scan(Some(0b11), 0, 1), (0, 0, 0b11));
    assert_eq!(scan(None, 1, 105), (1, 0, 0b11), "an intermediate step does not end it");
    assert_eq!(scan(None, 1, 1), (1, 0, 0b01), "load point 2 is done");
    assert_eq!(scan(None, 1, 1), (1, 0, 0b01));
    assert_eq!(scan(None, 1, 0), (0, 3, 0b01), "0 is no status");
}

/// P-138: 10 locations; from 9 to 2 it is 3 forwards, 7 backwards.
#[test]
fn fc22_finds_the_shorter_way() {
    let cyclic = "CALL FC 22 ( MagNo := 1, ReqPos := MW 10, ActPos := MW 12, Offset := B#16#0, Start := TRUE, Cw := M 1.0, Ccw := M 1.1, \
                  InPos := M 1.2, Diff := MW 2, Error := M 1.3 );";
    let (mut bench, mut program) = started(&blocks("", cyclic));
    bench.set("DB74.DBW2", 10);
    for (wanted, actual, found) in [(2, 9, (1, 3)), (9, 2, (2, 3)), (4, 4, (4, 0)), (11, 4, (8, 0))] {
        bench.set("MW10", wanted);
        bench.set("MW12", actual);
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("MB1"), bench.get("MW2")), found, "{actual} to {wanted}");
    }
}

/// P-139: FC 9 refuses each start; FC 15 is FC 18 with the function 5.
#[test]
fn fc9_refuses_and_fc15_positions() {
    let cyclic = "CALL FC 9 ( Start := M 0.0, ChanNo := 1, IntNo := 1, Active := M 1.0, Done := M 1.1, Error := M 1.2, StartErr := M 1.3, Ref := MW 8 );\
                  CALL FC 15 ( Start := M 0.0, AxisNo := B#16#1, IC := FALSE, Inch := FALSE, HWheelOv := FALSE, Pos := 10.0, FRate := 100.0, \
                  InPos := M 2.0, Activ := M 2.1, StartErr := M 2.2, Error := M 2.3 );\
                  CALL FC 16 ( Start := M 0.0, AxisNo := B#16#2, IC := FALSE, DC := TRUE, Minus := FALSE, Plus := FALSE, Pos := 3, FRate := 100.0, \
                  InPos := M 3.0, Activ := M 3.1, StartErr := M 3.2, Error := M 3.3 );";
    let (mut bench, mut program) = started(&blocks("", cyclic));
    bench.set("DB31.DBX68.7", 1);
    bench.set("DB32.DBX68.7", 1);
    bench.set("M0.0", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("MB1"), bench.get("DB19.DBX45.3")), (8, 1));
    assert_eq!((bench.get("DB31.DBB32"), bench.get("DB31.DBD36")), (0x80, u64::from(10.0_f32.to_bits())));
    // DBX34.1 is the shortest way, DBX35.7 an indexing position.
    assert_eq!((bench.get("DB32.DBB34"), bench.get("DB32.DBX35.7")), (2, 1));
    bench.set("DB31.DBB104", 0x80);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("MB2"), 2);
}

/// P-140: OB40 runs after FC2 if a channel has output an auxiliary function, and FB1 wants it.
#[test]
fn ob40_runs_after_fc2_with_an_auxiliary_function() {
    let interrupt = "ORGANIZATION_BLOCK OB 40\nBEGIN\nCALL FC 3; L MW 10; + 1; T MW 10;\nEND_ORGANIZATION_BLOCK\n";
    for (startup, wanted) in [("CALL FB 1, DB 7 ( UserIR := TRUE );", 1), ("", 0)] {
        let (mut bench, mut program) = started(&format!("{interrupt}{}", blocks(startup, "CALL FC 2;")));
        bench.scan(&mut program).unwrap();
        bench.set("DB21.DBX58.0", 1);
        bench.scan(&mut program).unwrap();
        bench.set("DB21.DBX58.0", 0);
        bench.scan(&mut program).unwrap();
        assert_eq!(bench.get("MW10"), wanted);
    }
}

/// FC2 calls FC12 of the sources for the channel that has output an auxiliary function.
#[test]
fn fc12_of_the_user_is_called_by_fc2() {
    let own = "FUNCTION FC 12 : VOID\nVAR_INPUT\nChan : BYTE;\nEND_VAR\nBEGIN\nL #Chan; T MB 12; L MW 10; + 1; T MW 10;\nEND_FUNCTION\n";
    let (mut bench, mut program) = started(&format!("{own}{}", blocks("", "CALL FC 2; L MW 14; + 1; T MW 14;")));
    bench.scan(&mut program).unwrap();
    bench.set("DB22.DBX60.0", 1);
    bench.scan(&mut program).unwrap();
    bench.set("DB22.DBX60.0", 0);
    bench.scan(&mut program).unwrap();
    assert_eq!(["MB12", "MW10", "MW14"].map(|address| bench.get(address)), [2, 1, 3]);
}
