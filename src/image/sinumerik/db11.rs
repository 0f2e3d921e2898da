//! DB11: the mode groups. The second group begins 20 bytes after the first. The PLC writes bytes 0 to 2, the HMI bytes 4 and 5, the NCK
//! bytes 6 to 8.
//!
//! G1 calls DBX5.2 "active machine function REF". According to the list manual, 5.2 is the strobe of the HMI and 7.2 is the active
//! function. In this project, 5.2 is in the bytes of the HMI; the control mirrors 7.2 to it until an HMI writes it (E-01).

use crate::image::table::signals;

signals! {
    /// DB11 bytes 0 to 2 (second group 20 to 22): signals from the PLC to the mode group.
    pub struct ModeGroupToNck, mode_group_to_nck: ModeGroup, Plc, 0 to 2;

    /// Mode AUTOMATIC: 1 requests it; JOG has priority over MDI, MDI over AUTOMATIC.
    bool, mode_automatic, set_mode_automatic: 0, 0;
    /// Mode MDI: 1 requests it.
    bool, mode_mdi, set_mode_mdi: 0, 1;
    /// Mode JOG: 1 requests it.
    bool, mode_jog, set_mode_jog: 0, 2;
    /// Mode change inhibit: 1 = the mode cannot be changed.
    bool, mode_change_inhibit, set_mode_change_inhibit: 0, 4;
    /// Mode group stop: 1 stops the axes of all channels of the group.
    bool, mode_group_stop, set_mode_group_stop: 0, 5;
    /// Mode group stop axes plus spindles: 1 also stops the spindles.
    bool, mode_group_stop_axes_plus_spindles, set_mode_group_stop_axes_plus_spindles: 0, 6;
    /// Mode group reset: 1 resets all channels of the group and cancels alarms that RESET clears.
    bool, mode_group_reset, set_mode_group_reset: 0, 7;
    /// Machine function TEACH IN: 1 requests it, in MDI.
    bool, machine_function_teach_in, set_machine_function_teach_in: 1, 0;
    /// Machine function REPOS: 1 requests it, in JOG.
    bool, machine_function_repos, set_machine_function_repos: 1, 1;
    /// Machine function REF: 1 requests reference point approach, in JOG.
    bool, machine_function_ref, set_machine_function_ref: 1, 2;
    /// Single block type B: 1 = single block also stops after blocks that only calculate.
    bool, single_block_type_b, set_single_block_type_b: 1, 6;
    /// Single block type A: 1 = single block stops after blocks that move, output or dwell, as without type B.
    bool, single_block_type_a, set_single_block_type_a: 1, 7;
    /// Machine function INC1: 1 requests it; effective only with DB10.DBX57.0 = 1, like the next six signals.
    bool, machine_function_increment_1, set_machine_function_increment_1: 2, 0;
    /// Machine function INC10: 1 requests it.
    bool, machine_function_increment_10, set_machine_function_increment_10: 2, 1;
    /// Machine function INC100: 1 requests it.
    bool, machine_function_increment_100, set_machine_function_increment_100: 2, 2;
    /// Machine function INC1000: 1 requests it.
    bool, machine_function_increment_1000, set_machine_function_increment_1000: 2, 3;
    /// Machine function INC10000: 1 requests it.
    bool, machine_function_increment_10000, set_machine_function_increment_10000: 2, 4;
    /// Machine function INCvar: 1 requests the increment of the setting data.
    bool, machine_function_increment_variable, set_machine_function_increment_variable: 2, 5;
    /// Continuous traversing: 1 requests it.
    bool, machine_function_continuous, set_machine_function_continuous: 2, 6;
}

signals! {
    /// DB11 bytes 4 and 5 (second group 24 and 25): selections of the operator on the HMI; PLC programs copy them to bytes 0 and 1.
    pub struct ModeGroupHmi, mode_group_hmi: ModeGroup, Hmi, 4 to 5;

    /// AUTOMATIC selected on the HMI: 1 = strobe.
    bool, automatic_selected, set_automatic_selected: 4, 0;
    /// MDI selected on the HMI: 1 = strobe.
    bool, mdi_selected, set_mdi_selected: 4, 1;
    /// JOG selected on the HMI: 1 = strobe.
    bool, jog_selected, set_jog_selected: 4, 2;
    /// TEACH IN selected on the HMI: 1 = strobe.
    bool, teach_in_selected, set_teach_in_selected: 5, 0;
    /// REPOS selected on the HMI: 1 = strobe.
    bool, repos_selected, set_repos_selected: 5, 1;
    /// REF selected on the HMI: 1 = strobe; in G1 "active machine function REF" (E-01).
    bool, ref_selected, set_ref_selected: 5, 2;
}

signals! {
    /// DB11 bytes 6 to 8 (second group 26 to 28): signals from the mode group to the PLC.
    pub struct ModeGroupFromNck, mode_group_from_nck: ModeGroup, Nck, 6 to 8;

    /// Active mode AUTOMATIC: 1 = active.
    bool, active_mode_automatic, set_active_mode_automatic: 6, 0;
    /// Active mode MDI: 1 = active.
    bool, active_mode_mdi, set_active_mode_mdi: 6, 1;
    /// Active mode JOG: 1 = active.
    bool, active_mode_jog, set_active_mode_jog: 6, 2;
    /// Mode group ready: 0 during an emergency stop and with the alarm reaction "mode group not ready".
    bool, mode_group_ready, set_mode_group_ready: 6, 3;
    /// All channels in reset state: 1 = yes.
    bool, all_channels_in_reset_state, set_all_channels_in_reset_state: 6, 7;
    /// Active machine function TEACH IN: 1 = active.
    bool, active_machine_function_teach_in, set_active_machine_function_teach_in: 7, 0;
    /// Active machine function REPOS: 1 = active.
    bool, active_machine_function_repos, set_active_machine_function_repos: 7, 1;
    /// Active machine function REF: 1 = active.
    bool, active_machine_function_ref, set_active_machine_function_ref: 7, 2;
    /// Active machine function INC1: 1 = active.
    bool, active_machine_function_increment_1, set_active_machine_function_increment_1: 8, 0;
    /// Active machine function INC10: 1 = active.
    bool, active_machine_function_increment_10, set_active_machine_function_increment_10: 8, 1;
    /// Active machine function INC100: 1 = active.
    bool, active_machine_function_increment_100, set_active_machine_function_increment_100: 8, 2;
    /// Active machine function INC1000: 1 = active.
    bool, active_machine_function_increment_1000, set_active_machine_function_increment_1000: 8, 3;
    /// Active machine function INC10000: 1 = active.
    bool, active_machine_function_increment_10000, set_active_machine_function_increment_10000: 8, 4;
    /// Active machine function INCvar: 1 = active.
    bool, active_machine_function_increment_variable, set_active_machine_function_increment_variable: 8, 5;
    /// Active machine function continuous traversing: 1 = active.
    bool, active_machine_function_continuous, set_active_machine_function_continuous: 8, 6;
}
