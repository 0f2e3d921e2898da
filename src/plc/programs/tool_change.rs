//! `tool_change`: enables every axis, and changes tools: T selects, M6 turns the magazine while read-in disable holds the program.
//!
//! | signal | what the program does |
//! |---|---|
//! | T function 1 (DBW118 with its change bit DBX61.0) | notes the tool |
//! | M6 (DBX194.6, 1 for one scan) | if another tool than the noted one is in the spindle, the magazine moves for 2 s; read-in disable (DBX6.1) is 1 from this scan until the magazine stands |
//!
//! The acknowledgement of M6 by this scan and read-in disable arrive at the NCK in the same cycle, so the block after M6 does not begin. T and
//! M6 may stand in one block. RESET does not stop the magazine. Flags show the state, 8 bytes for each channel from MB100:
//!
//! | flag of channel 1 | meaning |
//! |---|---|
//! | M100.0 | the magazine moves |
//! | MW102 | the tool that T has selected |
//! | MW104 | the tool in the spindle |
//!
//! The program writes read-in disable in every scan. A machine on which others write it, too, needs its own program.

use serde::{Deserialize, Serialize};

use crate::plc::{ClosureProgram, program};
use crate::units::{ChannelNumber, PerChannel, Time};

use super::enable_all::enable;

/// The first flag byte of channel 1; each channel has 8 bytes.
const FLAGS: usize = 100;

/// How long the magazine moves.
const MAGAZINE_TIME: Time = Time::from_millis(2000);

/// The state: when the magazine of each channel will stand.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ToolChange {
    moves_until: PerChannel<Option<Time>>,
}

/// Enables every axis; T selects a tool and M6 changes it, with read-in disable until the magazine has moved.
#[must_use]
pub fn tool_change() -> ClosureProgram<ToolChange> {
    program("tool_change", ToolChange::default(), |state, io| {
        enable(io);
        for channel in ChannelNumber::all() {
            let moving = FLAGS + 8 * usize::from(channel.number() - 1);
            let (selected, in_spindle) = (moving + 2, moving + 4);
            let functions = io.from_nck.auxiliary(channel);
            if functions.t_function_1_change() {
                io.flags.set_word(selected, functions.t_function_1());
            }
            let until = &mut state.moves_until[channel];
            let is_another = io.flags.word(selected) != io.flags.word(in_spindle);
            if functions.decoded_m_function_6() && is_another && until.is_none() {
                *until = Some(io.time + MAGAZINE_TIME);
            }
            if until.is_some_and(|until| io.time >= until) {
                *until = None;
                io.flags.set_word(in_spindle, io.flags.word(selected));
            }
            io.flags.set_bit(moving, 0, until.is_some());
            io.to_nck.channel(channel).set_read_in_disable(until.is_some());
        }
    })
}

#[cfg(test)]
mod tests {
    use super::tool_change;
    use crate::plc::bench::Bench;

    /// A scan of the bench takes 10 ms: the magazine moves in 200 scans.
    #[test]
    fn read_in_disable_is_1_from_the_scan_of_m6_until_the_magazine_stands() {
        let mut bench = Bench::with_axes(&["X"]);
        let mut program = tool_change();
        bench.set("DB21.DBX61.0", 1);
        bench.set("DB21.DBW118", 5);
        bench.scan(&mut program).unwrap();
        bench.set("DB21.DBX61.0", 0);
        assert_eq!(
            (bench.get("MW102"), bench.get("MW104"), bench.get("DB21.DBX6.1")),
            (5, 0, 0),
            "T alone moves nothing"
        );
        bench.set("DB21.DBX194.6", 1);
        bench.scan(&mut program).unwrap();
        bench.set("DB21.DBX194.6", 0);
        for _ in 0..200 {
            assert_eq!((bench.get("DB21.DBX6.1"), bench.get("M100.0"), bench.get("MW104")), (1, 1, 0));
            bench.scan(&mut program).unwrap();
        }
        assert_eq!((bench.get("DB21.DBX6.1"), bench.get("M100.0"), bench.get("MW104")), (0, 0, 5));
        assert_eq!(bench.get("DB31.DBX2.1"), 1, "it enables the axes as well");
    }

    #[test]
    fn m6_with_the_tool_in_the_spindle_does_nothing() {
        let mut bench = Bench::with_axes(&["X"]);
        bench.set("DB21.DBX194.6", 1);
        bench.scan(&mut tool_change()).unwrap();
        assert_eq!(bench.get("DB21.DBX6.1"), 0);
    }
}
