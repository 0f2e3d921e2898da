//! The interface of the SINUMERIK 840D sl and 828D: its tables of signals, and their positions in the parts by writer.

mod db10;
mod db11;
mod db21;
mod db21_auxiliary;
mod db21_program;
mod db31;
mod interface;
mod machine_functions;
mod own_828d;
mod parts;
mod places;
mod profiles;

pub use db10::{NckFromNck, NckHmi, NckToNck, nck_from_nck, nck_hmi, nck_to_nck};
pub use db11::{
    ModeGroupFromNck, ModeGroupHmi, ModeGroupToNck, mode_group_from_nck, mode_group_hmi, mode_group_to_nck,
};
pub use db21::{ChannelFromNck, ChannelHmi, ChannelToNck, channel_from_nck, channel_hmi, channel_to_nck};
pub use db21_auxiliary::{ChannelAuxiliary, channel_auxiliary};
pub use db21_program::{
    ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, channel_jump_to_nck, channel_program_to_nck,
    channel_search_from_nck,
};
pub use db31::{AxisFromNck, AxisToNck, axis_from_nck, axis_to_nck};
pub use interface::{SINUMERIK, Sinumerik};
pub use own_828d::{
    ACKNOWLEDGE_USER_ALARMS, Axis828d, ChannelAuxiliary828d, USER_ALARMS, UserAlarmsToNck, UserFromNck, axis_828d,
    channel_auxiliary_828d, user_alarm,
};
pub use parts::{FromNck, Hmi, Plain, ToNck};
