//! The rules of the control, each with the place where it is documented.
//!
//! Every transition of a state machine and every signal edge names one of these rules as its cause. To add a rule, add a row
//! here. It is printed as `id: text, inputs`; the text is empty if the inputs are sufficient.

use crate::variables::{Rule as Text, RuleNumber};

/// Makes the enum and its table, so that every number has a text.
macro_rules! rules {
    ($($name:ident $id:literal $text:literal;)*) => {
        /// A rule that allowed a change.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u16)]
        pub enum Rule {
            $(#[doc = concat!($id, ": ", $text)] $name,)*
        }

        impl Rule {
            /// The texts of all rules, in the order of their numbers.
            pub const ALL: &[Text] = &[$(Text { id: $id, text: $text }),*];
        }
    };
}

rules! {
    // Start-up and enabling.
    PowerOn "power on" "power was switched on";
    SetActive "O-23" "set machine data active";
    DataActive "O-23" "machine data became active";
    DataActiveAtPowerOn "DEF-09" "machine data became active";
    FaultBegins "fault" "a fault begins";
    FaultEnds "fault" "a fault ends";
    AsAfterPowerOn "power on" "as after power on";
    RunUp "O-20" "start-up of control and drives";
    DrivesReady "O-20" "all drives are ready";
    DrivesNotReady "O-20" "a drive is not ready";
    DriveReady "O-20" "the drive has started up";
    DriveLost "drive" "the drive is not ready";
    PulsesEnabled "O-20" "pulses enabled";
    PulsesDisabled "O-25" "pulses disabled";
    ControllerOn "O-20" "controller enable";
    ControllerOff "SIG-01" "controller enable missing in the unit";
    PulsesMissing "O-25" "no pulses on an axis of the unit";
    UnitParked "SIG-08" "an axis of the unit is parked";
    SwitchingOffGoesOn "O-25" "what has begun to switch off does so to its end";
    FollowUp "SIG-02" "follow-up mode without controller enable";
    FollowUpByAlarm "SYN-01" "alarm with the reaction follow-up";
    FollowUpByEmergencyStop "E-06" "follow-up in emergency stop";
    MeasuringSystem "REF-33" "measuring system selected";
    Parking "SYN-01" "both measuring systems off";
    FollowUpByParking "SYN-01" "follow-up of a parked axis";
    BrakeOpens "K-20" "the holding brake is to open";
    BrakeCloses "K-20" "the holding brake is to close";
    BrakeIsOpen "K-20" "the holding brake is open";
    BrakeLeavesOpen "K-20" "the holding brake begins to close";
    ParameterSet "SIG-05" "parameter set selected by 9.0 to 9.2";
    ParameterSetRefused "25200" "9.0 to 9.2 select a parameter set that does not exist";
    ParameterSetJumps "26050" "the parameter set selected by 9.0 to 9.2 has another load gear: the actual value would jump";
    DriveDataSet "SIG-05" "drive data set selected by 21.0 to 21.4";
    SystemOfUnits "MD10240" "basic system of units";
    ChannelAxisGap "4000" "MD20070 has a gap, which MD11640 does not allow";
    NoMasterChannel "4001" "several channels name the axis, and MD30550 names none of them";
    ScalingChanged "4070" "a scaling machine datum was changed";
    CycleCorrected "4110" "not a multiple of MD10060: the next multiple acts";
    // Emergency stop.
    EmergencyStop "E-06" "emergency stop";
    EmergencyStopAcknowledged "E-06" "emergency stop acknowledged";
    // Limits.
    HardwareLimitSwitch "MON-14" "hardware limit switch";
    SoftwareLimit "MON-13" "on the software limit switch";
    WorkingArea "MON-12" "on the limit of the working area";
    // What stops and holds movements.
    DatumNotAllowed "O-30" "the axis cannot move with this value";
    StoppedByAlarm "ALARM" "an alarm stops the movement";
    StoppedByReset "RESET" "RESET is pressed: no movement";
    StoppedByEmergencyStop "E-06" "emergency stop: no movement";
    HeldByFeedStop "SIG-06" "feed stop holds the movement";
    HeldByOverride "O-03" "an override of 0 % holds the movement";
    HeldByZeroSetting "O-21" "the zero setting of the override switch holds the movement, also while the override is not active";
    FeedReleased "SIG-06" "feed stop no longer holds the movement";
    OverrideReleased "O-03" "the override no longer holds the movement";
    CommandOfLeadingAxis "SIG-09" "the traverse command of the leading axis is also displayed here";
    WithoutCommand "SIG-09" "follows a synchronous axis without a traverse command";
    AllStationary "channel" "all axes of the channel are stationary";
    NotAllStationary "channel" "an axis of the channel is not stationary";
    ChannelReferenced "channel" "all axes of the channel that need their reference point are referenced";
    ChannelNotReferenced "channel" "an axis of the channel that needs its reference point is not referenced";
    ChannelActive "channel" "an axis of the channel moves or is to move";
    ChannelAtRest "channel" "no axis of the channel moves or is to move";
    // Modes.
    ModeSelected "O-19" "mode";
    ModeRefused "16913" "mode change while a program runs or is stopped";
    MachineFunction "O-19" "machine function";
    KeysWithoutJog "O-19" "traversing keys have no effect in this mode or machine function";
    StrobeOwnedByHmi "E-01" "DB11.DBB5 was written from outside and belongs to the HMI from now on";
    ResetDone "RESET" "RESET";
    StartRefused "10203" "NC start without reference point";
    Preset "SYN-10" "another actual value was set: the reference is lost";
    GeneratorSet "MIS-09" "the function generator has a signal for the axis";
    GeneratorSynchronous "MIS-09" "NC start in JOG: a synchronous axis has no function generator";
    GeneratorRefused "MIS-09" "NC start in JOG: the function generator cannot move the axis";
    GeneratorStarted "MIS-09" "NC start in JOG: the function generator asks for travel";
    GeneratorMoves "MIS-09" "the PLC allows the travel of the function generator";
    GeneratorStops "MIS-09" "the function generator stops";
    GeneratorOver "MIS-09" "the time of the function generator is over";
    GeneratorRests "MIS-09" "the function generator has ended, its signal is 0";
    PresetByOperator "SYN-10" "PRESET by the operator";
    // Programs.
    StartHinderedByAlarm "16919" "NC start while an alarm with NC start disabled is pending";
    StartAlreadyActive "16920" "NC start while the program runs";
    NoProgramSelected "14014" "NC start, and the selected program does not exist";
    ProgramSelected "program" "a program is selected";
    BlocksEntered "program" "blocks are entered for MDA";
    ProgramStarted "program" "NC start: the program begins";
    ProgramGoesOn "program" "NC start: the program goes on";
    ProgramStopped "program" "the program is stopped, its axes are at rest";
    ProgramAborted "RESET" "RESET has ended the program, its axes are at rest";
    ProgramEnded "program" "end of the program";
    NcStop "program" "NC stop";
    ModeLeft "program" "the mode of the program was left";
    InterruptionInJog "program" "a program is stopped, and JOG is selected or left";
    ProgrammedStop "M0" "programmed stop";
    StopAtBlockEnd "program" "NC stop at the block limit";
    SingleBlock "program" "single block: stop after the block";
    ProgramTest "program test" "selected or deselected while no program runs";
    LevelAborted "program" "program level abort: back to the caller";
    StartedByProgram "program" "START of another channel: the program begins";
    WaitBegins "program" "waits for another channel";
    WaitEnds "program" "the other channels are there: the program goes on";
    ActionRefused "synchronised" "a synchronised action cannot act";
    SearchStarted "search" "block search begins";
    SearchFound "search" "block found";
    SearchMissed "search" "the program has ended before the block";
    SearchCalculates "search" "block calculated";
    SearchActed "search" "action blocks are output: the PLC has to complete its action";
    SearchActions "search" "action blocks output what the search has collected";
    SearchReady "10208" "the search is over: NC start goes on";
    ApproachEnds "search" "the axes are where the program goes on";
    BlockBegins "block" "begins";
    BlockMoves "block" "moves the axis";
    BlockMotionEnds "block" "motion of the axis has ended";
    Returns "P-77" "the axis returns to where the program was interrupted";
    IsBack "P-77" "the axis is back where the program was interrupted";
    BlockWaitsForControl "O-27" "the movement of a block waits: no position control";
    BlockNotExecutable "block" "cannot be executed";
    AuxiliaryOutput "auxiliary" "output of auxiliary functions";
    AuxiliaryAcknowledged "auxiliary" "one PLC cycle has passed";
    // Compensations.
    CompensationMoves "SIG-10" "sag or temperature compensation moves the axis";
    CompensationRests "SIG-10" "sag and temperature compensation no longer move the axis";
    SagTooManyTables "20120" "more than 5 tables of sag compensation have this output axis";
    SagTableWrong "20121" "MAX is below MIN, or STEP is not above 0: the table is not evaluated";
    SagAxesMissing "20122" "the table has no input axis or no output axis: it is not evaluated";
    SagProduct "20123" "the tables of a product have different output axes: they are not evaluated";
    SagLimited "20124" "the sag compensation value is above its limit";
    SagTooFast "20125" "the sag compensation value changes faster than its limit";
    SagFollows "20125" "the sag compensation value follows its tables again";
    DrfSelected "MIS-02" "DRF: the handwheel of the axis is selected or deselected";
    DrfMoves "MIS-02" "DRF: a handwheel moves the axis beside its program";
    DrfRests "MIS-02" "DRF: the offset does not change";
    DrfWhileReferencing "20053" "DRF: a handwheel is turned while the axis is referenced; its pulses are lost";
    HandwheelOverrides "MIS-02" "handwheel override: the handwheel of the axis changes the velocity, or moves the axis";
    HandwheelMissing "20080" "handwheel override: the axis has no handwheel";
    HandwheelOverrideEnds "MIS-02" "handwheel override: its block or its order has ended";
    // Axis exchange.
    ExchangeRequested "DBB8" "the PLC asks for an exchange of the axis";
    ExchangeRefused "DBB8" "the exchange of the axis is refused";
    ExchangeDone "DBB8" "the axis is already what is asked for";
    ReleasedByProgram "RELEASE" "a program releases the axis";
    TakenByProgram "GET" "a program takes the axis";
    TakenByPlc "DBB8" "the PLC takes the axis";
    GivenToChannel "DBB8" "the PLC gives the axis to a channel";
    TakenByAction "command axis" "a synchronised action takes the axis";
    ReturnedToChannel "MD30450" "a neutral axis returns to its channel";
    NeutralAfterReset "MD30450" "the axis becomes neutral";
    ExchangePossible "DBB68" "nothing uses the axis";
    ExchangeNotPossible "DBB68" "a block uses the axis, or it is positioned alone";
    WaitsForAxis "GET" "the program waits for an axis";
    HasItsAxes "GET" "the program has its axes";
    // Axes that are positioned alone.
    OrderStarted "FC18" "the PLC starts a positioning axis";
    OrderRefused "FC18" "the positioning axis cannot be started";
    OrderMoves "FC18" "moves to the target";
    OrderWaitsForControl "X-12" "the positioning waits: no position control yet";
    OrderTargetReached "FC18" "the setpoint has reached the target";
    OrderReached "FC18" "in position, with exact stop fine";
    OrderEnds "FC18" "the axis has come to rest before its target";
    ActionStarts "command axis" "a synchronised action positions the axis";
    ActionMoves "command axis" "moves to the target";
    ActionTargetReached "command axis" "the setpoint has reached the target";
    ActionReached "command axis" "in position, with exact stop fine";
    ActionEnds "command axis" "the axis has come to rest before its target";
    OrderWithdrawn "FC18" "Start is 0";
    OrderDropped "FC18" "the rest of the way is dropped";
    SpindleOrder "FC18" "the PLC starts a function of the spindle";
    SpindleOrderReached "FC18" "the function of the spindle has reached its position or its speed, or oscillates; or no longer";
    SpindleOrderStopped "FC18" "Stop: the spindle brakes";
    SpindleOrderEnds "FC18" "something else has ended the function of the spindle";
    SpindleOrderRefused "FC18" "the function of the spindle cannot be started";
    NoSpindle "FC18" "a function for spindles, and the axis is no spindle";
    PlcControls "28.7" "the PLC controls the axis";
    PlcStops "28.6" "the PLC stops the axis along its braking ramp";
    PlcResumes "28.2" "the PLC lets the axis go on";
    PlcResets "28.1" "reset of the axis by the PLC";
    PlcControlsNoMore "28.7" "the channel controls the axis again";
    ControlNotGivenBack "28.7" "the PLC keeps the axis while it has an alarm";
    Positioning "76.5" "the axis is positioned";
    PositioningEnds "76.5" "the axis is no longer positioned";
    // Spindles.
    SpindleFunction "spindle" "the function of a program acts after its acknowledgement";
    SpindleStop "spindle" "spindle stop, or NC stop axes plus spindles";
    SpindleWithoutEnable "S-05" "without its enable the spindle does not turn";
    SpindleReleased "spindle" "nothing holds the spindle";
    SpindleInverted "spindle" "the PLC inverts M3 and M4";
    SpindlePositioned "spindle" "a program positions the spindle";
    GearStageChanged "spindle" "the gear stage is changed";
    GearStageDiffers "22010" "the actual gear stage is not the wanted one";
    GearChangeStops "spindle" "the spindle stops for the change of its gear stage";
    GearChangeAwaited "spindle" "motion waits for the change of the gear stage";
    GearChangeTooLong "16938" "RESET has waited for a gear change as long as MD10192 permits";
    Oscillation "spindle" "oscillation";
    OscillationTurns "spindle" "direction of oscillation";
    SpindleClosesLoop "spindle" "the position is known, and the speed is low enough: position control";
    SpindleWithoutEncoder "22050" "a spindle without an active encoder cannot be positioned";
    SpindleMarkMissing "22051" "no zero mark in two revolutions";
    SpindleTargetReached "spindle" "the setpoint has reached the target";
    SpindleInPosition "spindle" "the spindle is in position";
    SpindleIsAxis "spindle" "the spindle stands and is an axis";
    SpindleReset "spindle" "spindle reset";
    SpeedDeleted "spindle" "the S value was deleted";
    SpeedLimited "spindle" "the programmed speed is above the limit";
    SpeedRaised "spindle" "the programmed speed is below the limit";
    SpeedWithinLimits "spindle" "the programmed speed is within the limits";
    SpeedExceeded "spindle" "the actual speed against the largest speed and its tolerance";
    SpeedReached "spindle" "the actual speed against the commanded one, with its tolerance";
    SpindleHeld "S-10" "a spindle with a commanded speed is held, so it does not have this speed";
    SpindleDirection "spindle" "the actual direction";
    SpindleSynchronised "spindle" "the spindle has passed its zero mark";
    SpindleAcknowledgementAwaited "spindle" "the path waits for the acknowledgement of the functions of its spindles";
    SpindleSpeedAwaited "spindle" "the path waits for the speed of the spindle";
    ChuckSpeedExceeded "22100" "the actual speed is more than 10 % above MD35100";
    // Jogging.
    TraversingKey "JOG" "key";
    KeyReleased "JOG" "no key";
    MotionBlocked "JOG" "motion blocked";
    EnableLost "O-26" "lost enable: the movement ends, and the key must be pressed again";
    IncrementSelected "INC" "machine function of JOG";
    IncrementStarted "INC" "one increment";
    EndReached "JOG" "target of the movement reached";
    HandwheelActivated "HANDWHEEL" "handwheel assigned";
    HandwheelTurned "HANDWHEEL" "handwheel turned";
    HandwheelDropped "HANDWHEEL" "remaining distance of the handwheel dropped";
    // Axis signals.
    AxisDisable "SIG-03" "axis disable";
    DistanceDeleted "SIG-04" "distance-to-go deleted";
    FastStop "SIG-07" "ramp-function generator fast stop in the unit";
    // Reference point approach.
    KeyStartsApproach "REF-02" "approach started";
    NoApproachInOpenGrouping "E-15" "a synchronous axis of an open grouping is not referenced by itself";
    ApproachStarted "REF-31" "reference point approach begins";
    ApproachWaits "O-27" "reference point approach requested; it waits";
    ChannelReferencingEnds "REF-23" "channel-specific referencing ended";
    ApproachStartedByChannel "REF-23" "channel-specific referencing";
    ApproachStartedByProgram "G74" "reference point approach by a program";
    ApproachStartedInGrouping "REF-04" "synchronous axis referenced after the leading axis";
    ApproachTargetReached "REF-31" "the setpoint has reached the target";
    OnCamAtStart "REF-31" "on the cam at the start";
    WithoutCam "REF-31" "MD34000 = 0: no cam, zero mark search starts at once";
    CamReached "REF-31" "cam reached";
    StoppedOnCam "REF-31" "at rest on the cam";
    LeaveCamFirst "REF-31" "MD34050 = 1: leave the cam first";
    CamLeft "REF-31" "cam left";
    StoppedOffCam "REF-31" "at rest off the cam";
    CamEdge "REF-31" "cam edge";
    CamShiftPassed "REF-31" "distance of MD34092 passed after the cam edge";
    CreepVelocityMissed "20006" "creep velocity not reached at the cam edge: phase 1 is repeated";
    ZeroMark "REF-31" "zero mark";
    ReferencePointReached "REF-31" "at the reference point";
    Referenced "REF-03" "reference point reached";
    MarksSearched "REF-25" "distance-coded marks are searched from here on";
    MarksSearchedOffCam "REF-25" "on the cam: distance-coded marks are searched in the direction away from it";
    CamAhead "REF-25" "cam reached: distance-coded marks are searched in the other direction";
    FirstMark "REF-25" "first of two distance-coded marks";
    MarksPassed "REF-25" "two distance-coded marks give the position: it moves to its reference point";
    StopAfterMarks "REF-25" "two distance-coded marks give the position: it stops";
    MarksTooFarApart "20003" "distance of the two marks above 2 x MD34300: second attempt in the other direction at half the velocity";
    AbsoluteTravels "REF-26" "the position is known: it moves to its reference point";
    AbsoluteStays "REF-26" "the position is known: nothing moves";
    EncoderAdjusted "REF-26" "the absolute encoder is adjusted: nothing moves";
    NotAdjusted "25022" "the absolute encoder is not adjusted";
    AbsolutePosition "REF-26" "the absolute encoder is adjusted, and is read";
    AdjustmentLost "26030" "these data of an adjusted absolute encoder were changed";
    EncoderNotAbsolute "26020" "the encoder has no absolute position";
    PositionTakenOver "C-73" "the position at power off is taken over";
    PositionRestored "C-73" "the position at power off is restored, without a reference";
    EncoderDataStored "C-73" "the control stores what it knows of the position of an encoder";
    StandsReferenced "C-73" "referenced and at rest in exact stop fine: power off keeps the position";
    LeavesStandstill "C-73" "not at rest in exact stop fine, or not referenced: power off loses the position";
    ApproachAborted "REF-12" "reference point approach aborted";
    ApproachCannotStart "C-46" "the approach of an axis that has its turn cannot start";
    NewApproach "REF-32" "a new approach of this measuring system began";
    // Gantry.
    GroupingDefined "DEF-10" "MD37100 defines the grouping";
    LeadingAxisApproach "REF-02" "section 1: the leading axis is referenced";
    LeadingAxisReferenced "REF-04" "section 2: the synchronous axis is referenced, the leading axis follows";
    NextSynchronousAxis "REF-05" "section 2: the next synchronous axis is referenced";
    AllReferenced "REF-06" "section 3: all axes are referenced, positions are compared";
    AutomaticStart "REF-07" "every difference below the warning limit";
    WaitWarningLimitZero "REF-11" "";
    WaitDifference "REF-11" "difference not below the warning limit";
    WaitLocked "REF-11" "";
    StartByPlc "REF-14" "start";
    SynchronisationAborted "REF-13" "synchronisation interrupted, all axes referenced";
    ReferencingAborted "REF-12" "referencing interrupted";
    SynchronisingMotion "REF-09" "moves to the common position";
    SynchronisingTargetReached "REF-09" "the setpoint has reached the common position";
    Synchronised "REF-10" "all axes at their target";
    SynchronismRestored "SYN-06" "back in position control within the standstill tolerance";
    SynchronismLostFollowUp "SYN-05" "follow-up";
    SynchronismLostReference "SYN-01" "reference lost";
    ReadyAgain "O-09" "all axes referenced, not synchronised";
    ReadyNoMore "E-13" "no longer ready for synchronisation";
    Opened "BRK-01" "grouping opened";
    Closed "BRK-05" "grouping closed";
    ClosingRefused "BRK-05" "the grouping stays open: a movement of the axis is pending";
    ClosingInOtherChannel "BRK-05" "the grouping stays open: the axis is in another channel than the leading axis";
    ClosingInOtherState "BRK-05" "the grouping stays open: the axis is in another state than the leading axis";
    ConcurrentAxisIgnored "DEF-11" "ignored on a synchronous axis, the value of the leading axis applies";
    UnequalData "DYN-03" "differs from the value of the leading axis";
    Overloaded "DYN-02" "the leading axis demands more than the synchronous axis can do";
    NotMonitored "BRK-02" "not monitored while the grouping is open or in follow-up";
    WarningLimit "MON-02" "above the warning limit";
    WarningLimitBeyondBase "MON-08" "further from the base than the warning limit";
    TripLimitBeyondBase "MON-08" "further from the base than the trip limit";
    TripLimitExtended "MON-09" "above the trip limit in extended monitoring";
    SwitchedOffTripped "MON-11" "switched off with a stored difference in extended monitoring";
    DifferenceStored "MON-11" "the difference that tripped in extended monitoring is stored";
    WarningGone "MON-02" "not above the warning limit";
    TripLimitSynchronised "MON-04" "above the trip limit";
    TripLimitNotSynchronised "MON-05" "above the trip limit";
    TripGone "MON-04" "within the trip limit";
    // Alarms and states that follow from values.
    EnableLostInMotion "21612" "enable reset during motion";
    PlcStopped "PLC" "the PLC program does not run";
    PlcMissing "2000" "no sign of life from the PLC program";
    StandstillMonitoring "25040" "actual position outside the standstill tolerance";
    ClampingMonitoring "26000" "actual position outside the clamping tolerance";
    PositioningMonitoring "25080" "exact stop fine not reached within MD36020";
    ContourMonitoring "25050" "actual position deviates from the axis model";
    VelocityMonitoring "25030" "actual velocity above the velocity limit";
    SpeedSetpointMonitoring "25060" "speed setpoint above its limit (MD36210) for longer than MD36220";
    FrequencyExceeded "21610" "encoder frequency limit exceeded";
    FrequencyNormal "21610" "encoder frequency below its limit again";
    EncoderFault "25000" "no encoder signal";
    EncoderPollution "25010" "no encoder signal, reported as pollution because MD36310 is above 100";
    ZeroMarkMonitoring "25020" "zero mark not at the expected count";
    EncodersDiffer "25105" "the measuring systems differ";
    SwitchOverImpossible "25100" "the other measuring system has no signal or differs too much";
    EncoderMissing "25110" "measuring system 2 is selected, but the axis does not have one";
    FollowUpInMotion "21615" "the drive lost its power during motion";
    DriveFault "25201" "the drive reports a fault";
    DriveReadyAgain "25201" "the drive is ready again";
    DriveNotReady "25202" "the drive does not start up";
    AlarmPending "ALARM" "an alarm is pending";
    ConditionHolds "ALARM" "the condition of the alarm holds";
    AlarmDropped "ALARM" "an alarm found no place in the alarm list";
    OnSoftwareLimit "10621" "at rest on the software limit switch or beyond it";
    OffSoftwareLimit "10621" "no longer at rest on the software limit switch or beyond it";
    OnWorkingArea "10631" "at rest on the limit of the working area or beyond it";
    OffWorkingArea "10631" "no longer at rest on the limit of the working area or beyond it";
    KeyMeetsHandwheel "20050" "a traversing key is pressed while a handwheel moves the axis";
    KeyMeetsNoHandwheel "20050" "no traversing key is pressed while a handwheel moves the axis";
    HandwheelMeetsKey "20051" "a handwheel is turned while a traversing key moves the axis";
    KeyMovementEnded "20051" "no traversing key moves the axis";
    NoLongerJogging "JOG" "the axis is not jogged in this mode, machine function or grouping";
    MessageSuppressed "REF-08" "the message of the grouping is suppressed";
    SwitchOverReported "21613" "the switch-over is reported for one cycle";
    CancelKey "ALARM" "alarm-cancel key";
    AlarmCancelled "ALARM" "alarm cancelled";
    ExactStop "exact stop" "";
    ExactStopInMotion "exact stop" "the axis moves or is to move";
    ExactStopWithoutControl "exact stop" "no position control";
    Standstill "standstill" "";
    SetpointsOutput "O-29" "new setpoints are output";
    PlcMessage "DB2" "the PLC program shows a message";
    PlcMessageEnds "DB2" "the PLC program shows the message no longer";
    // Only on the 828D.
    UserAlarm "DB1600" "the PLC sets a user alarm";
    UserAlarmEnds "DB1600" "the PLC resets a user alarm";
    UserAlarmAcknowledged "DB1600" "the PLC resets a user alarm and acknowledges it";
    ValueRequested "DB5700" "the PLC requests this value";
}

impl From<Rule> for RuleNumber {
    fn from(rule: Rule) -> Self {
        rule.number()
    }
}

impl Rule {
    /// Its number in an event.
    #[must_use]
    pub const fn number(self) -> RuleNumber {
        RuleNumber(self as u16)
    }
}
