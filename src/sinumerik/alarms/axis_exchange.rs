//! Alarms of the exchange of axes between programs, channels and the PLC.

use crate::sinumerik::alarms::{Cancel, Reaction, alarms};
use crate::variables::AlarmNumber;

alarms! {
    /// The alarms of axis exchange, ascending by number.
    AXIS_EXCHANGE:
    /// A block moves an axis that the PLC has.
    CONTROLLED_BY_PLC 14790 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart
        "channel %1 block %2 axis %3 currently controlled by the PLC";
    /// The PLC asks for more axes than it may have.
    TOO_MANY_PLC_AXES 26070 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 cannot be controlled by the PLC: too many PLC axes";
    /// The PLC cannot have this axis, or not give it to this channel.
    NO_PLC_AXIS 26072 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 cannot be controlled by the PLC";
    /// A block moves an axis that only the PLC moves (MD30460 bit 4).
    EXCLUSIVE_PLC_AXIS 26075 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset
        "channel %1 axis %2 not available for the NC program, only the PLC controls it";
    /// A block moves an axis that is always a PLC axis (MD30460 bit 5).
    PERMANENT_PLC_AXIS 26076 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset
        "channel %1 axis %2 not available for the NC program, permanently a PLC axis";
}
