//! The rules that causes name, with their IDs in the requirements or in the decisions.

use crate::variables::{Rule, RuleNumber};

/// Generates the enumeration and the table from one list.
macro_rules! rules {
    ($($name:ident: $id:literal, $text:literal;)*) => {
        /// Why something happened.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Why {
            $(#[doc = $text] $name,)*
        }

        /// The rules, in the order of [`Why`].
        pub(super) static RULES: &[Rule] = &[$(Rule { id: $id, text: $text },)*];
    };
}

rules! {
    PowerOn: "HG-02", "the controller starts: parameter lists take effect";
    AsAfterStart: "HG-02", "as after the start of the controller";
    FaultBegins: "fault", "a fault begins";
    FaultEnds: "fault", "a fault ends";
    Request: "HLI", "the request of the CNC acts, because enable_w is 0";
    Commanded: "HLI", "the command of the PLC acts, because enable_w is 1";
    DriveStarted: "HLI", "the drive has started up and has no fault";
    DriveFault: "HG-13", "the drive reports a fault";
    DriveNotReady: "HLI", "the drive is not ready";
    DriveNotEnabled: "HLI", "the drive is not enabled";
    AbsoluteEncoder: "HG-29", "the encoder is absolute: the axis is homed without a homing run";
    ReferenceLost: "HG-29", "G74 names the combination: no axis of it counts as homed until its own homing has ended";
    HomingBegins: "HG-30", "G74 begins the homing run of this axis";
    HomingInTurn: "HG-09", "the homing run of this axis begins: the axis before it is homed";
    HomingAtOnce: "HG-10", "the drives home by themselves: all axes of the combination begin in the same cycle";
    AwayFromCam: "HOMING", "the axis is not on its reference cam";
    WithoutCam: "HOMING", "the axis has no cam (P-AXIS-00156): the next zero pulse gives the reference";
    WithoutSwitch: "HOMING", "without cam and zero pulse the present position is the reference";
    Reverses: "HOMING", "the axis stands on the cam and reverses";
    WithoutReversal: "HOMING", "the axis stands on the cam and does not reverse (P-AXIS-00157)";
    OnCam: "HOMING", "the axis is on its reference cam";
    OffCam: "HOMING", "the axis has left its reference cam";
    ZeroPulse: "HOMING", "the zero pulse after the cam gives the reference";
    CamEdge: "HOMING", "the rising edge of the cam gives the reference, without a zero pulse";
    Homed: "HG-09", "the homing run has found the reference position";
    AllHomed: "HG-08", "all axes are homed: the difference counts from P-AXIS-00073";
    HomedWithMaster: "HG-11", "the slave takes the position of its own list when its master is homed";
    HomingAborted: "HG-09", "the homing run ends without a reference";
    StageOne: "HG-07", "the gantry difference exceeds the resettable limit (P-AXIS-00072)";
    StageTwo: "HG-07", "the gantry difference exceeds the limit that no reset clears (P-AXIS-00071)";
    SoftStageOne: "SG-04", "the difference of a coupled axis exceeds limit_1";
    SoftStageTwo: "SG-04", "the difference of a coupled axis exceeds limit_2";
    Cleared: "HG-07", "a reset clears the error: no difference is beyond a limit, or it is being cleared";
    FaultCleared: "HG-13", "a reset clears the error: no drive of the coupled axes reports a fault";
    ErrorCleared: "NC", "a reset ends the error state of the channel: no axis of it has an error";
    ClearedUnhomed: "HG-08", "the error or the difference is cleared, and not all axes are homed";
    ClosedUnhomed: "HG-16", "#GANTRY ON closes the combination as the lists say, and not all axes are homed";
    ClearingBegins: "HG-12", "the gantry difference is cleared: the slave moves at P-AXIS-00075";
    ClearingEnds: "HG-12", "the distance of slave and master is the offset again";
    CombinationStops: "HG-13", "an error of one axis stops the whole combination at a_emergency";
    CombinationOff: "HG-14", "#GANTRY OFF opens the combination";
    CombinationOn: "HG-16", "#GANTRY ON closes the combination as the lists say";
    CoupledByList: "HG-01", "the parameter lists couple master and slave";
    GroupOn: "SG-07", "a coupling group is switched on";
    GroupOff: "SG-07", "a coupling group is switched off";
    GroupEnds: "SG-09", "program end or reset ends a coupling";
    GroupRestored: "SG-09", "the program start switches a coupling on again (P-CHAN-00104, P-CHAN-00105)";
    ProgramStarts: "NC", "a rising edge of NC start starts the selected program";
    GoesOn: "NC", "a rising edge of NC start continues the program that stands after a block";
    ProgramEnds: "NC", "the program has reached its end";
    ProgramAborted: "NC", "a message ends the program";
    ProgramStops: "NC", "the axes stand: the program that was ended is over";
    ProgramSelected: "NC", "a program is selected";
    ProgramReady: "NC", "no program runs, and one is selected";
    ProgramMissing: "NC", "no program runs, and none is selected";
    ProgramStands: "NC", "the program stands until NC start: single block, or M00";
    ProgramRuns: "NC", "the program runs, and nothing holds it";
    ChannelInError: "NC", "the channel is in the error state";
    ResetEnds: "NC", "a rising edge of NC reset ends the program";
    ResetClears: "NC", "the axes stand: the reset clears";
    Held: "NC", "feed hold, override 0, or a missing feed enable holds the movement";
    Moves: "NC", "the axis moves";
    Stands: "NC", "the axis stands at its setpoint";
    Rests: "NC", "no movement of the axis is commanded";
    LeavesPosition: "NC", "the actual value is away from the setpoint";
    BlockRuns: "NC", "the next block of the program runs";
    PlcMissing: "NC", "the PLC program has stopped";
    StartUpCheck: "HG-04", "a check at the start of the controller";
    UpdateCheck: "HG-06", "a check of the lists after an update at run time";
    PairCheck: "HG-06", "a pair without printed limits is monitored: a check of the list of its slave";
    Raised: "NC", "a block of the program raises the message";
    ListUpdated: "HG-02", "an entry of a parameter list is updated";
}

impl From<Why> for RuleNumber {
    fn from(why: Why) -> Self {
        Self(why as u16)
    }
}
