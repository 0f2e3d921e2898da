//! `machine_control_panel`: operates a machine with the keys of a machine control panel. The keys are inputs I0.0 to I7.7, the lamps of
//! the keys are the outputs with the same numbers. The program enables every axis like `enable_all`.
//!
//! The layout belongs to this project. It groups the keys like the panels of such controls (modes, increments, program keys, override
//! switch, axes, directions), but does not copy a particular panel:
//!
//! ```text
#![doc = include_str!("machine_control_panel.txt")]
//! ```
//!
//! ACK is E-STOP ACK, CHAIN is the emergency stop chain, OVR is the override switch, KEY is the key-operated switch. The lamp of a key has
//! the same position as the key. `ref'd` are the referenced axes, `stop` is the emergency stop (106.1), `ready` is NC ready (108.7).
//!
//! * A key is 1 while it is pressed. A mode key requests its mode (DB11.DBX0.0 to 0.2) while it is pressed.
//! * REF requests JOG, and also the machine function REF (DB11.DBX1.2) until a mode key is pressed or JOG is no longer active.
//! * An increment key selects its increment (DB11.DBB2, with DB10.DBX57.0) until JOG or REF is pressed, which select continuous (2.6).
//! * An axis key selects its axis if the machine has it; of several keys, the lowest wins. No axis is selected after power on.
//! * The direction keys (I5.0 minus, I5.2 plus, I5.1 rapid traverse) act on the selected axis (DBX4.6, 4.7, 4.5); these signals are 0 on
//!   all other axes. Both directions at once are passed on; the control treats them as no direction.
//! * The override switch gives its position in Gray code, I3.0 is the lowest bit. MD12000 and MD12020 must be set to Gray, which is their
//!   default. The position is written to every axis (DBB0 with 1.7) and to channel 1 (DB21.DBB4 with 6.7). All 0 is position 1, 0 %.
//! * RESET acts on mode group 1 (DB11.DBX0.7) and on channel 1 (DB21.DBX7.7). START, STOP (of the NC) and SINGLE (block) are
//!   DB21.DBX7.1, 7.3 and 0.4. The key-operated switch is DB10.DBX56.4 to 56.7.
//! * The emergency stop chain is a closed circuit: I7.0 = 0 is an emergency stop (DB10.DBX56.1), so a panel without inputs keeps the
//!   machine stopped. E-STOP ACK, pressed while the chain is closed, holds 56.2 and mode group RESET of both mode groups (DB11.DBX0.7 and
//!   20.7) until the control has left the emergency stop (106.1 = 0) or the chain opens.

use serde::{Deserialize, Serialize};

use crate::plc::basic_program::select_increment;
use crate::plc::{ClosureProgram, PlcIo, RisingEdge, program};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

use super::enable_all::enable;

/// The assignment of the bits, as shown in the docs of `machine_control_panel`.
pub const MACHINE_CONTROL_PANEL_LAYOUT: &str = include_str!("machine_control_panel.txt");

/// The number of axes that have keys.
const AXIS_KEYS: u8 = 8;

/// The state of the keys.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct MachineControlPanel {
    reference: bool,
    /// The selected bit of DB11.DBB2.
    increment: Option<u8>,
    selected: Option<AxisNumber>,
    acknowledge: RisingEdge,
    /// Whether acknowledge and RESET are held until the emergency stop is left.
    acknowledging: bool,
}

/// Enables every axis; keys at I0.0 to I7.1, lamps at Q0.0 to Q7.3.
#[must_use]
pub fn machine_control_panel() -> ClosureProgram<MachineControlPanel> {
    program("machine_control_panel", MachineControlPanel::default(), |panel, io| {
        enable(io);
        panel.choose_mode(io);
        panel.stop_and_reset(io);
        run_programs(io);
        panel.traverse(io);
        panel.light(io);
    })
}

impl MachineControlPanel {
    fn choose_mode(&mut self, io: &mut PlcIo<'_>) {
        let inputs = io.inputs;
        let (automatic, mda, jog) = (inputs.bit(0, 0), inputs.bit(0, 1), inputs.bit(0, 3));
        let reference = inputs.bit(1, 6);
        let in_jog = io.from_nck.mode_group(ModeGroupNumber::FIRST).active_mode_jog();
        self.reference = reference || (self.reference && in_jog && !(automatic || mda || jog));
        if jog || reference {
            self.increment = None;
        } else if let Some(key) = (0..6).find(|&key| inputs.bit(1, key)) {
            self.increment = Some(key);
        }
        let group = io.to_nck.mode_group(ModeGroupNumber::FIRST);
        group.set_mode_automatic(automatic);
        group.set_mode_mdi(mda);
        group.set_mode_jog(jog || reference);
        group.set_machine_function_ref(self.reference);
        select_increment(group, self.increment);
        io.to_nck.nck().set_increment_inputs_active_in_mode_group_area(true);
    }

    fn stop_and_reset(&mut self, io: &mut PlcIo<'_>) {
        let (closed, key) = (io.inputs.bit(7, 0), io.inputs.bit(7, 1));
        let stopped = io.from_nck.nck().emergency_stop_active();
        let pressed = self.acknowledge.scan(key);
        let acknowledged = self.acknowledging;
        self.acknowledging = closed && stopped && (pressed || acknowledged);
        let reset = io.inputs.bit(3, 7);
        let nck = io.to_nck.nck();
        nck.set_emergency_stop(!closed);
        nck.set_acknowledge_emergency_stop(self.acknowledging);
        nck.set_key_operated_switch_position_0(io.inputs.bit(2, 4));
        nck.set_key_operated_switch_position_1(io.inputs.bit(2, 5));
        nck.set_key_operated_switch_position_2(io.inputs.bit(2, 6));
        nck.set_key_operated_switch_position_3(io.inputs.bit(2, 7));
        io.to_nck.mode_group(ModeGroupNumber::FIRST).set_mode_group_reset(reset || self.acknowledging);
        io.to_nck.channel(ChannelNumber::FIRST).set_channel_reset(reset);
        // The panel does not RESET other mode groups, except for the acknowledgement, which requires the RESET of all mode groups.
        if self.acknowledging || acknowledged {
            for group in ModeGroupNumber::all().filter(|group| *group != ModeGroupNumber::FIRST) {
                io.to_nck.mode_group(group).set_mode_group_reset(self.acknowledging);
            }
        }
    }

    fn traverse(&mut self, io: &mut PlcIo<'_>) {
        let keyed = |axis: AxisNumber| axis.number() <= AXIS_KEYS && io.inputs.bit(4, axis.number() - 1);
        if let Some(axis) = io.axes().find(|&axis| keyed(axis)) {
            self.selected = Some(axis);
        }
        for number in io.axes() {
            let selected = self.selected == Some(number);
            let axis = io.to_nck.axis(number);
            axis.set_feed_override(io.inputs.byte(3) & 0x1F);
            axis.set_override_active(true);
            axis.set_traversing_key_minus(selected && io.inputs.bit(5, 0));
            axis.set_rapid_traverse_override(selected && io.inputs.bit(5, 1));
            axis.set_traversing_key_plus(selected && io.inputs.bit(5, 2));
        }
    }

    fn light(&self, io: &mut PlcIo<'_>) {
        let (nck, group) = (io.from_nck.nck(), io.from_nck.mode_group(ModeGroupNumber::FIRST));
        let channel = io.from_nck.channel(ChannelNumber::FIRST);
        let stopped = nck.emergency_stop_active();
        let selected = self.selected.map(|axis| io.from_nck.axis(axis));
        let lamps = [
            (0, 0, group.active_mode_automatic()),
            (0, 1, group.active_mode_mdi()),
            (0, 3, group.active_mode_jog()),
            (1, 0, group.active_machine_function_increment_1()),
            (1, 1, group.active_machine_function_increment_10()),
            (1, 2, group.active_machine_function_increment_100()),
            (1, 3, group.active_machine_function_increment_1000()),
            (1, 4, group.active_machine_function_increment_10000()),
            (1, 5, group.active_machine_function_increment_variable()),
            (1, 6, group.active_machine_function_ref()),
            (2, 0, channel.program_state_stopped()),
            (2, 1, channel.program_state_running()),
            (3, 5, io.inputs.bit(3, 5)),
            (3, 7, channel.channel_state_reset()),
            (5, 0, selected.is_some_and(|axis| axis.traverse_command_minus())),
            (5, 1, io.inputs.bit(5, 1)),
            (5, 2, selected.is_some_and(|axis| axis.traverse_command_plus())),
            (7, 0, stopped),
            (7, 1, stopped && io.inputs.bit(7, 0)),
            (7, 2, nck.nc_ready()),
            (7, 3, nck.nc_alarm_active()),
        ];
        for (byte, bit, on) in lamps {
            io.outputs.set_bit(byte, bit, on);
        }
        for number in io.axes().filter(|axis| axis.number() <= AXIS_KEYS) {
            let axis = io.from_nck.axis(number);
            let referenced = axis.referenced_synchronized_1() || axis.referenced_synchronized_2();
            io.outputs.set_bit(4, number.number() - 1, self.selected == Some(number));
            io.outputs.set_bit(6, number.number() - 1, referenced);
        }
    }
}

/// NC start and stop, single block, and the override of channel 1.
fn run_programs(io: &mut PlcIo<'_>) {
    let channel = io.to_nck.channel(ChannelNumber::FIRST);
    channel.set_nc_stop(io.inputs.bit(2, 0));
    channel.set_nc_start(io.inputs.bit(2, 1));
    channel.set_activate_single_block(io.inputs.bit(3, 5));
    channel.set_feed_override(io.inputs.byte(3) & 0x1F);
    channel.set_feed_override_active(true);
}

#[cfg(test)]
mod tests {
    use super::{MACHINE_CONTROL_PANEL_LAYOUT, machine_control_panel};
    use crate::plc::ClosureProgram;
    use crate::plc::bench::Bench;

    /// Presses a key for one scan and releases it for the next.
    fn press<S>(bench: &mut Bench, program: &mut ClosureProgram<S>, key: &str)
    where
        ClosureProgram<S>: crate::plc::PlcProgram,
    {
        bench.set(key, 1);
        bench.scan(program).unwrap();
        bench.set(key, 0);
        bench.scan(program).unwrap();
    }

    #[test]
    fn every_key_has_one_input_and_writes_its_signal_while_it_is_pressed() {
        let keys = [
            ("I0.0", "DB11.DBX0.0"),
            ("I0.1", "DB11.DBX0.1"),
            ("I0.3", "DB11.DBX0.2"),
            ("I2.0", "DB21.DBX7.3"),
            ("I2.1", "DB21.DBX7.1"),
            ("I2.4", "DB10.DBX56.4"),
            ("I2.5", "DB10.DBX56.5"),
            ("I2.6", "DB10.DBX56.6"),
            ("I2.7", "DB10.DBX56.7"),
            ("I3.5", "DB21.DBX0.4"),
            ("I3.7", "DB21.DBX7.7"),
            ("I3.7", "DB11.DBX0.7"),
        ];
        for (key, signal) in keys {
            let mut bench = Bench::with_axes(&["X"]);
            let mut program = machine_control_panel();
            bench.scan(&mut program).unwrap();
            assert_eq!(bench.get(signal), 0, "{key}");
            bench.set(key, 1);
            bench.scan(&mut program).unwrap();
            assert_eq!(bench.get(signal), 1, "{key}");
            bench.set(key, 0);
            bench.scan(&mut program).unwrap();
            assert_eq!(bench.get(signal), 0, "{key}");
        }
    }

    #[test]
    fn ref_stays_until_a_mode_key_or_until_jog_is_left() {
        let mut bench = Bench::with_axes(&["X"]);
        let mut program = machine_control_panel();
        bench.set("DB11.DBX6.2", 1); // JOG is active
        press(&mut bench, &mut program, "I1.6");
        assert_eq!(bench.get("DB11.DBX1.2"), 1);
        press(&mut bench, &mut program, "I0.3");
        assert_eq!(bench.get("DB11.DBX1.2"), 0);
        press(&mut bench, &mut program, "I1.6");
        bench.set("DB11.DBX6.2", 0);
        bench.scan(&mut program).unwrap();
        assert_eq!(bench.get("DB11.DBX1.2"), 0);
    }

    #[test]
    fn an_increment_stays_until_jog_selects_continuous() {
        let mut bench = Bench::with_axes(&["X"]);
        let mut program = machine_control_panel();
        bench.scan(&mut program).unwrap();
        assert_eq!((bench.get("DB11.DBB2"), bench.get("DB10.DBX57.0")), (0b0100_0000, 1));
        for (key, bits) in [("I1.0", 1), ("I1.1", 2), ("I1.2", 4), ("I1.3", 8), ("I1.4", 16), ("I1.5", 32)] {
            press(&mut bench, &mut program, key);
            assert_eq!(bench.get("DB11.DBB2"), bits, "{key}");
        }
        press(&mut bench, &mut program, "I0.3");
        assert_eq!(bench.get("DB11.DBB2"), 0b0100_0000);
    }

    #[test]
    fn the_direction_keys_act_on_the_selected_axis() {
        let mut bench = Bench::with_axes(&["X", "Y"]);
        let mut program = machine_control_panel();
        let keys = |bench: &Bench| [bench.get("DB31.DBB4"), bench.get("DB32.DBB4")];
        bench.set("I5.2", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(keys(&bench), [0, 0], "nothing is selected after power on");
        press(&mut bench, &mut program, "I4.1");
        assert_eq!(keys(&bench), [0, 0b1000_0000]);
        press(&mut bench, &mut program, "I4.2");
        assert_eq!(keys(&bench), [0, 0b1000_0000], "the machine has no third axis");
        press(&mut bench, &mut program, "I4.0");
        bench.set("IB5", 0b011);
        bench.scan(&mut program).unwrap();
        assert_eq!(keys(&bench), [0b0110_0000, 0], "minus and rapid traverse");
        assert_eq!(bench.get("QB4"), 1);
    }

    #[test]
    fn the_override_goes_to_every_axis_and_to_the_channel() {
        let mut bench = Bench::with_axes(&["X", "Y"]);
        bench.set("IB3", 0b0001_1010);
        bench.scan(&mut machine_control_panel()).unwrap();
        for (byte, active) in [("DB31.DBB0", "DB31.DBX1.7"), ("DB32.DBB0", "DB32.DBX1.7"), ("DB21.DBB4", "DB21.DBX6.7")]
        {
            assert_eq!((bench.get(byte), bench.get(active)), (0b11010, 1), "{byte}");
        }
    }

    #[test]
    fn an_open_chain_stops_and_the_acknowledgement_is_held_until_the_stop_is_left() {
        let mut bench = Bench::with_axes(&["X"]);
        let mut program = machine_control_panel();
        let bits =
            |bench: &Bench| ["DB10.DBX56.1", "DB10.DBX56.2", "DB11.DBX0.7", "DB11.DBX20.7"].map(|bit| bench.get(bit));
        bench.scan(&mut program).unwrap();
        assert_eq!(bits(&bench), [1, 0, 0, 0]);
        bench.set("DB10.DBX106.1", 1);
        press(&mut bench, &mut program, "I7.1");
        assert_eq!(bits(&bench), [1, 0, 0, 0], "the chain is open");
        bench.set("I7.0", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(bits(&bench), [0, 0, 0, 0]);
        press(&mut bench, &mut program, "I7.1");
        assert_eq!(bits(&bench), [0, 1, 1, 1], "held although the key is released");
        bench.set("DB10.DBX106.1", 0);
        bench.scan(&mut program).unwrap();
        assert_eq!(bits(&bench), [0, 0, 0, 0]);
    }

    #[test]
    fn the_layout_has_a_row_for_each_byte_and_eight_bits_in_each() {
        let rows: Vec<_> = MACHINE_CONTROL_PANEL_LAYOUT.lines().collect();
        assert_eq!(rows.len(), 18);
        for (index, row) in rows.iter().enumerate().filter(|(index, _)| index % 9 > 0) {
            assert!(row.starts_with(&format!("{}B{} ", ["I", "Q"][index / 9], index % 9 - 1)), "{row}");
            let cells = (0..8).map(|cell| row.as_bytes().get(5 + 9 * cell));
            assert!(cells.into_iter().all(|cell| cell.is_some_and(|first| *first != b' ')), "{row}");
        }
    }
}
