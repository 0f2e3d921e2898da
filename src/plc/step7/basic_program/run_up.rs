//! FB1 (RUN_UP) in OB100, FC2 (GP_HP) first in OB1, FC5 (GP_DIAG).
//!
//! FB1 keeps what other blocks ask of its inputs, sets its outputs, and fills DB20 with the machine data for the PLC. FC2 passes the selections of
//! the HMI on to the interface; the bytes of the NCK are there without it, as late as `from_nck_delay` says.

use crate::plc::step7::engine::{Areas, Cpu, Fault};
use crate::plc::step7::instruction::{BlockKind, Width};
use crate::plc::step7::text::types::Layout;
use crate::plc::{Link, NcVariable};
use crate::units::ChannelNumber;

/// The machine data MD14510, MD14512 and MD14514 in DB20, each with its count in MD14504, MD14506 or MD14508 and its bytes.
const USER_DATA: [(u16, u16, usize); 3] = [(14_504, 14_510, 2), (14_506, 14_512, 1), (14_508, 14_514, 4)];

/// DB20.
const MACHINE_DATA_BLOCK: u16 = 20;

impl Cpu {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a machine has few groups, channels and axes"
    )]
    pub(super) fn run_up<A: Areas>(&mut self, areas: &mut A, layout: &Layout) -> Result<(), Fault> {
        for (panel, names) in [["MCP1In", "MCP1Out"], ["MCP2In", "MCP2Out"]].into_iter().enumerate() {
            let [input, output] = names.map(|name| self.variable(areas, layout, name));
            let state = [self.read_pointer(areas, input?)?, self.read_pointer(areas, output?)?];
            self.state.basic.panel_inputs[panel] = state[0];
            self.state.basic.panel_outputs[panel] = state[1];
        }
        let flags = ["ExtendAlMsg", "NCKomm", "MMCToIF", "UserIR"];
        let [extended, communication, selections, interrupt] =
            flags.map(|name| self.value(areas, layout, name, Width::Bit));
        let users = self.value(areas, layout, "MsgUser", Width::Word)?;
        let basic = &mut self.state.basic;
        basic.extended_messages = extended? != 0;
        basic.has_nc_communication = communication? != 0;
        basic.takes_hmi_selections = selections? != 0;
        basic.has_interrupt = interrupt? != 0;
        basic.user_areas = u8::try_from(users.min(32)).unwrap_or(32);
        let Some(mut link) = areas.link() else { return Ok(()) };
        let counts = fill_machine_data(&mut link);
        // MD10010: the mode group of a channel, 0 for one that does not exist.
        let group = |channel: ChannelNumber| {
            let line = channel.number().into();
            link.nc.read(NcVariable { module: 0x1A, column: 10_010, line, ..Default::default() }).unwrap_or(0.0)
        };
        let groups = ChannelNumber::all().map(group).fold(1.0, f64::max);
        let channels: Vec<_> =
            ChannelNumber::all().map(|channel| channel == ChannelNumber::FIRST || group(channel) > 0.0).collect();
        let axes: Vec<_> = link.names.axes.iter().map(|(_, name)| name.is_some()).collect();
        let highest = |there: &[bool]| there.iter().rposition(|there| *there).map_or(0, |index| index as u32 + 1);
        let [integers, bytes, reals] = counts;
        let outputs = [
            ("MaxBAG", groups as u32),
            ("MaxChan", highest(&channels)),
            ("MaxAxis", highest(&axes)),
            ("UDInt", integers),
            ("UDHex", bytes),
            ("UDReal", reals),
        ];
        for (name, value) in outputs {
            self.set_value(areas, layout, name, Width::Word, value)?;
        }
        for (name, there) in [("ActivChan", &channels[..channels.len().min(10)]), ("ActivAxis", &axes)] {
            let first = self.variable(areas, layout, name)?;
            for (bit, there) in (0..31).zip(there.iter()) {
                let spot = crate::plc::step7::engine::Spot { bit: first.bit + bit, ..first };
                self.write(areas, spot, Width::Bit, (*there).into())?;
            }
        }
        Ok(())
    }

    /// FC2.
    pub(super) fn general<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        self.state.basic.general_calls = self.state.basic.general_calls.wrapping_add(1);
        let basic = &mut self.state.basic;
        if basic.takes_hmi_selections
            && let Some(mut link) = areas.link()
        {
            pass_selections(&mut link, &mut basic.selections);
        }
        let mut has_signals = false;
        // The data block of a channel that the machine does not have can be one of the program.
        let has_machine = areas.link().is_some();
        for channel in 1..=10 {
            if has_auxiliary_functions(areas, channel, has_machine) {
                has_signals = true;
                self.call_auxiliary(areas, channel)?;
            }
        }
        if has_signals && self.state.basic.has_interrupt {
            return self.process_interrupt(areas);
        }
        Ok(())
    }

    /// FC12 (AUXFU) of the user, if the sources have it: FC2 calls it when a channel has output auxiliary functions.
    fn call_auxiliary<A: Areas>(&mut self, areas: &mut A, channel: u8) -> Result<(), Fault> {
        match self.program.find(BlockKind::Fc, 12) {
            Some(index) if self.program.blocks[usize::from(index)].parameters == 1 => {
                self.call_user(areas, index, channel)
            }
            _ => Ok(()),
        }
    }

    /// FC5: no rack and no slave fails here, so there is nothing to go on from.
    pub(super) fn diagnosis<A: Areas>(&mut self, areas: &A) -> Result<(), Fault> {
        if self.is_on(areas, 0)? { Err(Fault::StopCalled) } else { Ok(()) }
    }
}

/// Whether a channel has output an auxiliary function: a change bit of DB21.DBB58, or of 60 to 65.
/// The data block of a channel that the machine does not have can be one of the program.
fn has_auxiliary_functions<A: Areas>(areas: &A, channel: u8, has_machine: bool) -> bool {
    let block = areas.block(20 + u16::from(channel)).filter(|block| !has_machine || areas.is_interface(*block));
    let bytes = block.and_then(|block| areas.read::<8>(block, 58));
    // DBB59 says which M functions are not decoded, which is no change.
    bytes.is_some_and(|bytes| bytes.iter().enumerate().any(|(index, byte)| index != 1 && *byte != 0))
}

/// The program control that the HMI has selected, in the channels of the machine: where a selection changes, its signal follows (P-132).
fn pass_selections(link: &mut Link<'_>, before: &mut [u8; 10]) {
    let names = link.names;
    for (channel, before) in ChannelNumber::all().zip(before) {
        if channel != ChannelNumber::FIRST && names.channels[channel].is_none() {
            continue;
        }
        let (hmi, signals) = (link.hmi.channel(channel), link.to_nck.channel(channel));
        let selected = [
            hmi.drf_selected(),
            hmi.m01_selected(),
            hmi.dry_run_feedrate_selected(),
            hmi.feed_override_for_rapid_traverse_selected(),
        ];
        let now = selected.iter().fold(0, |bits, bit| bits << 1 | u8::from(*bit));
        let changed = now ^ std::mem::replace(before, now);
        for (index, value) in selected.into_iter().enumerate().filter(|(index, _)| changed >> (3 - index) & 1 == 1) {
            match index {
                0 => signals.set_activate_drf(value),
                1 => signals.set_activate_m01(value),
                2 => signals.set_activate_dry_run_feedrate(value),
                _ => signals.set_rapid_traverse_override_active(value),
            }
        }
    }
}

/// Fills DB20, and returns the numbers of integers, bytes and REALs.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the control keeps the ranges of these machine data"
)]
fn fill_machine_data(link: &mut Link<'_>) -> [u32; 3] {
    let mut at = 0;
    USER_DATA.map(|(count, data, size)| {
        let read =
            |column, line| link.nc.read(NcVariable { module: 0x1A, column, line, ..Default::default() }).unwrap_or(0.0);
        let count = read(count, 1) as u16;
        for line in 1..=count {
            let value = read(data, line);
            let bytes = match size {
                2 => u32::from((value as i16).cast_unsigned()) << 16,
                1 => u32::from(value as u8) << 24,
                _ => (value as f32).to_bits(),
            };
            let bytes = bytes.to_be_bytes();
            if let Some(place) = link.blocks.get_mut(MACHINE_DATA_BLOCK).and_then(|block| block.get_mut(at..at + size))
            {
                place.copy_from_slice(&bytes[..size]);
            }
            at += size;
        }
        // The next data begin at an even byte.
        at = at.next_multiple_of(2);
        count.into()
    })
}
