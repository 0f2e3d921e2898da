//! DB21 to DB30, bytes 28 to 31, 318, 319 and 384: program control, block search and jumps to the start of the program.

use crate::image::table::signals;

signals! {
    /// DB21 bytes 28 to 31: program control from the PLC to the channel.
    pub struct ChannelProgramToNck, channel_program_to_nck: Channel, Plc, 28 to 31;

    /// Activate associated M0/M1: 1 = the M functions of MD22254 and MD22256 act as M0 and M1.
    bool, activate_associated_m0_m1, set_activate_associated_m0_m1: 30, 5;
    /// Skip block level 8: 1 = blocks with /8 are skipped.
    bool, skip_block_level_8, set_skip_block_level_8: 31, 6;
    /// Skip block level 9: 1 = blocks with /9 are skipped.
    bool, skip_block_level_9, set_skip_block_level_9: 31, 7;
}

signals! {
    /// DB21 byte 384: jumps to the start of the program.
    pub struct ChannelJumpToNck, channel_jump_to_nck: Channel, Plc, 384 to 384;

    /// Enable GOTOS: 1 = GOTOS jumps to the start of the program.
    bool, enable_gotos, set_enable_gotos: 384, 0;
}

signals! {
    /// DB21 bytes 318 and 319: search and associated stops, from the channel to the PLC.
    pub struct ChannelSearchFromNck, channel_search_from_nck: Channel, Nck, 318 to 319;

    /// Block search with program test (SERUPRO) active: 1 = yes.
    bool, search_by_program_test_active, set_search_by_program_test_active: 318, 1;
    /// Associated M0/M1 active: 1 = the program waits at an M function that acts as M0 or M1.
    bool, associated_m0_m1_active, set_associated_m0_m1_active: 318, 5;
}
