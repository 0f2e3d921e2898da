//! THE TABLE OF PARAMETERS: those of the gantry manuals (ISG FCT-C11 and TwinCAT TF5200, chapter 5), and those that they refer to, from the
//! published axis and channel manuals.
//!
//! `reading` types the entries of lists with it, `start` takes defaults from it, and `docs` and the command line print it.

use super::parameter::{Parameter, Scope, Type};

/// All parameters, those of axes first, ascending.
pub static PARAMETERS: &[Parameter] = &[
    axis(3, "getriebe[i].dynamik.a_emergency", Type::Uns32)
        .unit(ACCELERATION)
        .values("1 … 2 · P-AXIS-00008; 0 = P-AXIS-00008", "0")
        .means("deceleration of an emergency stop"),
    axis(5, "getriebe[i].lslope_profil.a_grenz_stufe_1", Type::Uns32)
        .unit(ACCELERATION)
        .values("1 … P-AXIS-00008", "1000")
        .means("acceleration of G00, step 1"),
    axis(6, "getriebe[i].lslope_profil.a_grenz_stufe_2", Type::Uns32)
        .unit(ACCELERATION)
        .values("1 … P-AXIS-00008", "1000")
        .means("acceleration of G00, step 2"),
    axis(8, "getriebe[i].dynamik.a_max", Type::Uns32)
        .unit(ACCELERATION)
        .values("1 … 100000000", "1000")
        .means("maximum acceleration"),
    axis(15, "kenngr.achs_mode", Type::Uns32)
        .values("0x1 … 0x10000000", "0x1")
        .restart()
        .means("axis mode: 0x1 linear, 0x4 modulo, 0x10000 gantry master, 0x20000 gantry slave"),
    axis(16, "kopf.achs_nr", Type::Uns16).values("1 … 65535", "1").restart().means("logical axis number"),
    axis(18, "kenngr.achs_typ", Type::Uns16)
        .values("1, 2, 4", "1")
        .restart()
        .means("axis type: 1 linear, 2 rotary, 4 spindle"),
    axis(70, "kenngr.gantry_ax_nr", Type::Uns16)
        .values("1 … 65535; 0 = none", "0")
        .restart()
        .means("gantry slave: logical number of its master"),
    axis(71, "kenngr.gantry_max_diff_reset_locked", Type::Uns32)
        .unit(POSITION)
        .values("0 < P-AXIS-00072 < v < 4294967295", "0")
        .means("gantry difference above which an error arises that only a restart clears"),
    axis(72, "kenngr.gantry_max_diff_resetable", Type::Uns32)
        .unit(POSITION)
        .values("0 < v < P-AXIS-00071", "0")
        .means("gantry difference above which motion is aborted; RESET clears the error"),
    axis(73, "kenngr.gantry_offset", Type::Sgn32)
        .unit(POSITION)
        .values("-2147483648 < v < 2147483647", "0")
        .means("position of a gantry slave minus position of its master"),
    axis(74, "kenngr.gantry_slave_no_homing", Type::Boolean)
        .values("0, 1", "0")
        .means("a gantry slave is not homed; it takes its reference position when its master is homed"),
    axis(75, "kenngr.gantry_vb_korr", Type::Uns32)
        .unit(VELOCITY)
        .values("0 < v < P-AXIS-00212", "0")
        .means("velocity at which a gantry difference is cleared"),
    kenngr(84, "kenngr.homing_without_zero_pulse", Type::Boolean)
        .values("0, 1", "0")
        .means("homing without zero pulse"),
    axis(126, "getriebe[i].moduloo", Type::Sgn32)
        .unit(POSITION)
        .values("more than P-AXIS-00127", "3600000")
        .restart()
        .means("upper modulo limit"),
    axis(127, "getriebe[i].modulou", Type::Sgn32)
        .unit(POSITION)
        .values("less than P-AXIS-00126", "0")
        .restart()
        .means("lower modulo limit"),
    axis(152, "getriebe[i].pos_refpkt", Type::Sgn32).unit(POSITION).means("position of the reference point"),
    kenngr(156, "kenngr.ref_ohne_nocken", Type::Boolean).values("0, 1", "0").means("homing without cam"),
    kenngr(157, "kenngr.ref_ohne_rev", Type::Boolean).values("0, 1", "0").means("homing without reversal"),
    axis(158, "kenngr.ref_richt", Type::Boolean)
        .values("0 negative, 1 positive", "0")
        .means("direction of the search for the reference cam"),
    axis(212, "getriebe[i].dynamik.vb_max", Type::Uns32)
        .unit(VELOCITY)
        .values("1 … 2000000000", "200000")
        .means("maximum velocity"),
    axis(218, "getriebe[i].vb_reflow", Type::Uns32)
        .unit(VELOCITY)
        .values("1 … P-AXIS-00219", "16666")
        .means("homing: velocity off the cam and onto it again"),
    axis(219, "getriebe[i].vb_refmax", Type::Uns32)
        .unit(VELOCITY)
        .values("P-AXIS-00218 … P-AXIS-00212", "83333")
        .means("homing: velocity to the cam"),
    axis(249, "kenngr.gantry_diff_check_without_homing", Type::Boolean)
        .values("0, 1", "0")
        .means("gantry difference is monitored before homing, too"),
    axis(253, "kenngr.gantry_synchronous_slave_homing", Type::Boolean)
        .values("0, 1", "0")
        .means("drives that home by themselves begin at the same time"),
    axis(254, "kenngr.cnc_controlled_stop_after_error", Type::Boolean)
        .values("0 by the drive, 1 by the CNC", "0")
        .means("reaction to an error of an axis of a gantry combination"),
    Parameter::new(Scope::Axis, 261, None, Type::Boolean)
        .values("0, 1", "0")
        .means("gantry_on clears a difference only on its rising edge"),
    axis(284, "kenngr.gantry_max_homing_dist", Type::Sgn32)
        .unit(POSITION)
        .values("0 = off", "0")
        .means("travel limit of a gantry slave while it is homed"),
    axis(285, "getriebe[i].a_ref", Type::Uns32)
        .unit(ACCELERATION)
        .values("1 … P-AXIS-00008", "the smaller of P-AXIS-00005 and P-AXIS-00006")
        .means("acceleration of homing"),
    axis(297, "kopf.log_achs_name", Type::String)
        .values("up to 16 characters, the first one of A B C U V W X Y Z Q", "X_Achse")
        .restart()
        .means("default name of the axis"),
    axis(299, "kenngr.homing.homing_type", Type::String)
        .values("CNC_CONTROLLED, DRIVE_CONTROLLED, DISABLED, IGNORE_ABS_POS", "CNC_CONTROLLED")
        .means("how the axis is homed; the default of SERCOS drives is DRIVE_CONTROLLED"),
    Parameter::new(Scope::Axis, 367, None, Type::Uns32).means("delay after an error of the PLC watchdog"),
    kenngr(393, "kenngr.gantry_slave_relative_homing", Type::Boolean)
        .values("0, 1", "0")
        .not_modelled()
        .means("a gantry slave is homed relative to an overflow of its encoder"),
    axis(407, "lr_param.dyn_monitoring_v_err", Type::Uns32)
        .unit(["0.1 %", "0.1 %"])
        .values("", "1000")
        .not_modelled()
        .means("velocity monitoring of the position controller, not for gantry slaves"),
    axis(486, "kenngr.copy_master_gantry_coupling_to_slave", Type::Boolean)
        .values("0, 1", "0")
        .not_modelled()
        .means("couplings that the PLC commands for a master hold for its slaves"),
    axis(704, "kenngr.gantry_on_mode", Type::String)
        .values("DEFAULT, ONLY_CONTROL_UNIT, EDGE_TRIGGERED, CONFIG", "DEFAULT")
        .means("what clears a gantry difference"),
    channel(3, "gruppe[i].achs_anzahl", Type::Uns16).values("0 … 32", "").restart().means("number of channel axes"),
    channel(6, "gruppe[i].achse[j].bezeichnung", Type::String)
        .values("up to 16 characters, the first one of A B C U V W X Y Z Q", "")
        .restart()
        .means("name of the axis in the channel"),
    channel(23, "grp_anzahl", Type::Uns16).values("1", "1").restart().means("number of axis groups"),
    channel(35, "gruppe[i].achse[j].log_achs_nr", Type::Uns16)
        .values("1 … 65535", "0")
        .restart()
        .means("logical number of the axis with channel index j"),
    channel(37, "synchro_data.koppel_gruppe[i].paar[j].log_achs_nr_master", Type::Uns16)
        .values("1 … 65535; 0 = no pair", "0")
        .restart()
        .means("coupling group 0: logical number of the master"),
    channel(38, "synchro_data.koppel_gruppe[i].paar[j].log_achs_nr_slave", Type::Uns16)
        .values("1 … 65535; 0 = no pair", "0")
        .restart()
        .means("coupling group 0: logical number of the slave"),
    channel(61, "synchro_data.koppel_gruppe[i].paar[j].mode", Type::Uns16)
        .values("0 path axes, 1 spindles", "0")
        .restart()
        .means("coupling group 0: what is coupled"),
    channel(99, "prog_start.feedrate", Type::Real64).values("0 or more", "0").means("feed without an F word"),
    channel(104, "synchro_data.restore_coupling_after_reset", Type::Boolean)
        .values("0, 1", "0")
        .means("couplings that RESET ends come back with the next program start"),
    channel(105, "synchro_data.preserve_coupling_after_prog_end", Type::Boolean)
        .values("0, 1", "0")
        .means("couplings that the program end ends come back with the next program start"),
    channel(108, "prog_start.feedrate_factor", Type::Real64)
        .values("0.1, 100", "100")
        .means("unit of F: 100 = mm/min, 0.1 = m/min; −1 is as no entry"),
    channel(253, "use_alias_name_in_ax_list", Type::Boolean)
        .values("0, 1", "0")
        .restart()
        .means("default axis names are A1 … A32"),
    channel(346, "enable_mod_axis_always_shortest_way", Type::Boolean)
        .values("0, 1", "0")
        .means("G90 positions modulo axes on the shortest way always; a sign belongs to the position"),
    channel(460, "retain_last_ax_config", Type::Boolean)
        .values("0, 1", "0")
        .means("axis configuration and couplings outlive the program end, RESET and the next start"),
];

const POSITION: [&str; 2] = ["0.1 µm", "0.0001°"];
const VELOCITY: [&str; 2] = ["1 µm/s", "0.001°/s"];
const ACCELERATION: [&str; 2] = ["mm/s²", "°/s²"];

/// A row of the axis parameters.
const fn axis(digits: u32, name: &'static str, kind: Type) -> Parameter {
    Parameter::new(Scope::Axis, digits, Some(name), kind)
}

/// A row of the axis parameters of which no source gives the structure before the name.
const fn kenngr(digits: u32, name: &'static str, kind: Type) -> Parameter {
    axis(digits, name, kind).assumed()
}

/// A row of the channel parameters.
const fn channel(digits: u32, name: &'static str, kind: Type) -> Parameter {
    Parameter::new(Scope::Channel, digits, Some(name), kind)
}

/// The parameter with a number: `72` is P-AXIS-00072, `100104` P-CHAN-00104.
#[must_use]
pub fn by_number(number: u32) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.number() == number)
}
