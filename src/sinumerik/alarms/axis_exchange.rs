//! Alarms of the exchange of axes between programs, channels and the PLC, and of axes that are positioned alone.

use crate::sinumerik::alarms::{Cancel, Reaction, alarms};
use crate::variables::AlarmNumber;

alarms! {
    /// The alarms of axis exchange, ascending by number.
    AXIS_EXCHANGE:
    /// A block moves an axis that the PLC has.
    CONTROLLED_BY_PLC 14790 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart
        "channel %1 block %2 axis %3 currently controlled by the PLC";
    /// The target of a positioning axis of the PLC, or of a command axis, is behind a software limit switch.
    BEHIND_SOFTWARE_LIMIT 20070 [DISPLAY] ByItself
        "channel %1 axis %2 programmed end position is behind software limit switch %3";
    /// The same, behind the working area limit.
    BEHIND_WORKING_AREA 20071 [DISPLAY] ByItself
        "channel %1 axis %2 programmed end position is behind working area limit %3";
    /// FC 18 with function 4: the axis is no indexing axis.
    NO_INDEXING_AXIS 20072 [DISPLAY] ByItself
        "channel %1 axis %2 is not an indexing axis";
    /// A spindle function of FC 18 cannot be started.
    SPINDLE_START_REFUSED 22297 [START_DISABLED INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 spindle %2 start by FC 18 refused, code %3";
    /// The PLC asks for more axes than it may have.
    TOO_MANY_PLC_AXES 26070 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 cannot be controlled by the PLC: too many PLC axes";
    /// The PLC cannot have this axis, or not give it to this channel.
    NO_PLC_AXIS 26072 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 cannot be controlled by the PLC";
    /// 28.7 = 0 while an alarm of the axis is pending.
    NOT_GIVEN_BACK 26074 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 control by the PLC cannot be given back in the present state";
    /// A block moves an axis that only the PLC moves (MD30460 bit 4).
    EXCLUSIVE_PLC_AXIS 26075 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset
        "channel %1 axis %2 not available for the NC program, only the PLC controls it";
    /// A block moves an axis that is always a PLC axis (MD30460 bit 5).
    PERMANENT_PLC_AXIS 26076 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset
        "channel %1 axis %2 not available for the NC program, permanently a PLC axis";
}
