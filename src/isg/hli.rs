//! The high level interface (HLI) between CNC and PLC, as bytes by writer.
//!
//! Channel *n* is DB(800 + *n*), the axis in place *n* is DB(900 + *n*), most significant byte first. On the control the HLI is a structure in
//! shared memory; these addresses are a convention of this project, so that clients, closures and traces have one way to it.
//!
//! A control unit has four elements: `enable_w` (the PLC takes over), `command_w` (its value), `request_r` (what the CNC wants without the
//! PLC) and `state_r` (what acts). With `enable_w` = 0 the request acts. The name of a unit alone stands for all of it: writing
//! `ax5.gantry_on` writes `enable_w` = 1 and `command_w`, reading it reads `state_r`.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::image::{
    Block, BlockTable, ByteRange, Interface, Layout, Numbering, Part, Tables, UnitElements, ValueTerms, Window,
};
use crate::signals;
use crate::units::{PerAxis, PerChannel};

signals! {
    /// DB801 and following, bytes 0 to 3: commands of the PLC to a channel.
    pub struct ChannelToCnc, channel_to_cnc: Channel, Plc, 0 to 3;

    /// NC start: a rising edge starts the selected program.
    bool, start, set_start: 0, 0;
    /// NC reset: a rising edge ends program and movements and clears the errors that a reset clears.
    bool, reset, set_reset: 0, 1;
    /// Feed hold: 1 = the path stops.
    bool, feed_hold, set_feed_hold: 0, 2;
    /// Single block: 1 = the program is held after each block.
    bool, single_block, set_single_block: 0, 3;
    /// Feed override, enable: 1 = the PLC gives the override.
    bool, feed_override_enable as "feed_override.enable_w", set_feed_override_enable: 0, 4;
    /// Skip mode, enable: 1 = the PLC gives the skip levels.
    bool, program_block_ignore_enable as "program_block_ignore.enable_w", set_program_block_ignore_enable: 0, 5;

    numbers {
        /// Feed override, command, in 0.1 %: 1000 = 100 %.
        u16, feed_override_command as "feed_override.command_w", set_feed_override_command: 2;
    }
}

signals! {
    /// DB801 and following, bytes 4 to 13: state of a channel.
    pub struct ChannelFromCnc, channel_from_cnc: Channel, Nck, 4 to 13;

    /// Program active: 1 = a program runs or is held.
    bool, program_active, set_program_active: 4, 0;
    /// Program completed: 1 = the last program reached its end (signal of this project).
    bool, program_completed, set_program_completed: 4, 1;
    /// Error: 1 = the channel is in the error state until a reset or a restart.
    bool, error, set_error: 4, 2;
    /// State of the channel: 2 selected, 3 ready, 4 active, 5 hold, 6 error.
    u8, state, set_state: 5, 7 to 0;

    numbers {
        /// Feed override, request, in 0.1 %: the CNC wants 1000 = 100 %.
        u16, feed_override_request as "feed_override.request_r", set_feed_override_request: 6;
        /// Feed override that acts, in 0.1 %.
        u16, feed_override_state as "feed_override.state_r", set_feed_override_state: 8;
        /// The block that runs: its N number, without one its line; 0 = none.
        u32, block, set_block: 10;
    }
}

signals! {
    /// DB801 and following, bytes 14 to 17: skip levels of a channel.
    pub struct ChannelSkipToCnc, channel_skip_to_cnc: Channel, Plc, 14 to 17;

    numbers {
        /// Skip mode, command: a bit for each level that is skipped, 0x1 for `/` and `/1`, 0x200 for `/10`.
        u32, program_block_ignore_command as "program_block_ignore.command_w", set_program_block_ignore_command: 14;
    }
}

signals! {
    /// DB801 and following, bytes 18 to 25: skip levels of a channel.
    pub struct ChannelSkipFromCnc, channel_skip_from_cnc: Channel, Nck, 18 to 25;

    numbers {
        /// Skip mode, request: the levels that the CNC wants to skip without the PLC; always 0.
        u32, program_block_ignore_request as "program_block_ignore.request_r", set_program_block_ignore_request: 18;
        /// Skip levels that act.
        u32, program_block_ignore_state as "program_block_ignore.state_r", set_program_block_ignore_state: 22;
    }
}

signals! {
    /// DB901 and following, byte 0: commands of the PLC to an axis.
    pub struct AxisToCnc, axis_to_cnc: Axis, Plc, 0 to 0;

    /// Drive on, torque and position control, enable: 1 = the PLC gives the enable of the drive.
    bool, drive_enable_enable as "drive_enable.enable_w", set_drive_enable_enable: 0, 0;
    /// Drive on, torque and position control, command: 1 = on.
    bool, drive_enable_command as "drive_enable.command_w", set_drive_enable_command: 0, 1;
    /// Feed enable, enable: 1 = the PLC gives the feed enable.
    bool, feed_enable_enable as "feed_enable.enable_w", set_feed_enable_enable: 0, 2;
    /// Feed enable, command: 1 = the axis may move.
    bool, feed_enable_command as "feed_enable.command_w", set_feed_enable_command: 0, 3;
    /// Clearing of the gantry difference, enable: 1 = the PLC gives the command.
    bool, gantry_on_enable as "gantry_on.enable_w", set_gantry_on_enable: 0, 4;
    /// Clearing of the gantry difference, command: 1 = clear it.
    bool, gantry_on_command as "gantry_on.command_w", set_gantry_on_command: 0, 5;
}

signals! {
    /// DB901 and following, bytes 2 to 9: state of an axis.
    pub struct AxisFromCnc, axis_from_cnc: Axis, Nck, 2 to 9;

    /// Drive enable, request: 1 = the CNC wants it.
    bool, drive_enable_request as "drive_enable.request_r", set_drive_enable_request: 2, 0;
    /// Drive enable that acts: 1 = enabled.
    bool, drive_enable_state as "drive_enable.state_r", set_drive_enable_state: 2, 1;
    /// Feed enable, request: 1 = the CNC wants it.
    bool, feed_enable_request as "feed_enable.request_r", set_feed_enable_request: 2, 2;
    /// Feed enable that acts: 1 = enabled.
    bool, feed_enable_state as "feed_enable.state_r", set_feed_enable_state: 2, 3;
    /// Clearing of the gantry difference, request: 1 = the CNC wants it; always 0.
    bool, gantry_on_request as "gantry_on.request_r", set_gantry_on_request: 2, 4;
    /// Clearing of the gantry difference that acts: 1 = commanded.
    bool, gantry_on_state as "gantry_on.state_r", set_gantry_on_state: 2, 5;
    /// Drive ready: 1 = the drive has started up and has no fault.
    bool, drive_ready, set_drive_ready: 3, 0;
    /// Homed: 1 = the position refers to the zero point of the machine.
    bool, homed, set_homed: 3, 1;
    /// Homing: 1 = the homing run of this axis goes on; an axis that another one drags along has 0 (signal of this project).
    bool, homing, set_homing: 3, 2;
    /// In position: 1 = the axis stands at its setpoint.
    bool, in_position, set_in_position: 3, 3;
    /// Axis error: 1 = pending.
    bool, error, set_error: 3, 4;
    /// Axis error that no reset clears: 1 = pending.
    bool, error_not_resettable, set_error_not_resettable: 3, 5;
    /// Gantry master: 1 = the parameter lists make it one (signal of this project).
    bool, gantry_master, set_gantry_master: 4, 0;
    /// Gantry slave: 1 = the parameter lists make it one (signal of this project).
    bool, gantry_slave, set_gantry_slave: 4, 1;
    /// Gantry coupled: 1 = the axis is coupled at this moment (signal of this project).
    bool, gantry_coupled, set_gantry_coupled: 4, 2;
    /// Axis state: 1 ready, 3 active, 5 hold, 7 error.
    u8, axis_state, set_axis_state: 5, 7 to 0;

    numbers {
        /// Logical axis number (P-AXIS-00016).
        u16, log_ax_n_r, set_log_ax_n_r: 6;
        /// Axis type (P-AXIS-00018): 1 linear, 2 rotary, 4 spindle.
        u16, axis_type_r, set_axis_type_r: 8;
    }
}

/// The bytes that the PLC writes.
#[derive(Clone, Debug, Default, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct ToCnc {
    /// DB801 to DB810.
    pub channels: PerChannel<ChannelToCnc>,
    /// DB801 to DB810, from byte 14.
    pub skips: PerChannel<ChannelSkipToCnc>,
    /// DB901 to DB932.
    pub axes: PerAxis<AxisToCnc>,
    /// Byte 1 of each axis.
    pub plain: PerAxis<u8>,
}

/// The bytes that the CNC writes.
#[derive(Clone, Debug, Default, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct FromCnc {
    /// DB801 to DB810.
    pub channels: PerChannel<ChannelFromCnc>,
    /// DB801 to DB810, from byte 18.
    pub skips: PerChannel<ChannelSkipFromCnc>,
    /// DB901 to DB932.
    pub axes: PerAxis<AxisFromCnc>,
}

/// The HLI of a control of the ISG kernel.
pub static HLI: Interface = Interface::new(Tables {
    name: "isg",
    blocks: &[
        BlockTable {
            block: Block::Channel,
            count: 10,
            names: &[],
            called: "channel",
            apart: None,
            ranges: &[
                ByteRange::signals(0, 3, Part::ToNck, 0, size_of::<ChannelToCnc>()),
                ByteRange::signals(4, 13, Part::FromNck, 0, size_of::<ChannelFromCnc>()),
                ByteRange::signals(
                    14,
                    17,
                    Part::ToNck,
                    std::mem::offset_of!(ToCnc, skips),
                    size_of::<ChannelSkipToCnc>(),
                ),
                ByteRange::signals(
                    18,
                    25,
                    Part::FromNck,
                    std::mem::offset_of!(FromCnc, skips),
                    size_of::<ChannelSkipFromCnc>(),
                ),
            ],
        },
        BlockTable {
            block: Block::Axis,
            count: 32,
            names: &[],
            called: "axis",
            apart: None,
            ranges: &[
                ByteRange::signals(0, 0, Part::ToNck, std::mem::offset_of!(ToCnc, axes), size_of::<AxisToCnc>()),
                ByteRange::plain(1, 1, std::mem::offset_of!(ToCnc, plain), 1),
                ByteRange::signals(2, 9, Part::FromNck, std::mem::offset_of!(FromCnc, axes), size_of::<AxisFromCnc>()),
            ],
        },
    ],
    signals: &[
        ChannelToCnc::SIGNALS,
        ChannelFromCnc::SIGNALS,
        ChannelSkipToCnc::SIGNALS,
        ChannelSkipFromCnc::SIGNALS,
        AxisToCnc::SIGNALS,
        AxisFromCnc::SIGNALS,
    ],
    to_nck: size_of::<ToCnc>(),
    from_nck: size_of::<FromCnc>(),
    hmi: 0,
    numberings: &[Numbering {
        name: "isg",
        title: "the ISG kernel",
        number: 2,
        windows: &[Window::new(801, 0, 25, Block::Channel, 0, 10), Window::new(901, 0, 9, Block::Axis, 0, 32)],
        blocks: "DB801 to DB810, DB901 to DB932",
        axes: "DB 900 + logical number of the axis",
    }],
    standard_blocks: &[],
    overrides: &[],
    switches: None,
    units: Some(UnitElements { enable: ".enable_w", command: ".command_w", state: ".state_r" }),
    named_in: "kopf.achs_nr, kopf.log_achs_name and gruppe[0].achse[i].bezeichnung in the parameter lists",
    example: "ax1.homed",
    values: ValueTerms {
        difference: "gantry_difference",
        difference_meaning: "Actual value of a slave minus that of its master minus the offset, in mm or degrees.",
        velocity_meaning: "Actual velocity, in mm/min or degrees/min, as F.",
        rotary_velocity: "\u{b0}/min",
        rotary_velocity_degrees: 1.0,
    },
});

/// The layout of the parts: the structures above.
#[derive(Debug)]
pub struct Isg;

impl Layout for Isg {
    type ToNck = ToCnc;
    type FromNck = FromCnc;
    type Hmi = [u8];

    fn is_of(interface: &Interface) -> bool {
        *interface == HLI
    }
}
