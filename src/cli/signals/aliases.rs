//! Everyday words for signals and values, in English and German: a filter finds a signal by them, too.

/// Words, and the names that they mean. A `*` at the end of a name stands for any ending.
const ALIASES: &[(&[&str], &[&str])] = &[
    (&["reference cam", "homing switch", "referenznocken"], &["deceleration_reference_point_approach"]),
    (&["servo enable", "drive enable", "reglerfreigabe"], &["controller_enable"]),
    (&["emergency stop", "e-stop", "estop", "not-aus", "notaus", "not-halt", "nothalt"], &["*emergency_stop*"]),
    (&["impulsfreigabe"], &["pulse_enable", "pulses_enabled"]),
    (&["follow-up", "nachführ", "nachfuehr"], &["follow_up_*"]),
    (&["parking", "parken", "encoder selection", "geber"], &["position_measuring_system_*"]),
    (&["feed hold", "vorschub halt", "vorschubhalt"], &["feed_stop"]),
    (&["feed inhibit", "vorschubsperre"], &["feed_disable"]),
    (&["feed rate override", "vorschubkorrektur", "vorschubschalter"], &["feed_override*", "override_active"]),
    (&["jog key", "direction key", "richtungstaste", "verfahrtaste", "fahrtaste"], &["traversing_key_*"]),
    (&["eilgang", "fast jog"], &["rapid_traverse_override*"]),
    (
        &["homed", "homing", "referenziert"],
        &["referenced_synchronized_*", "all_axes_requiring_reference_point_are_referenced"],
    ),
    (&["in position", "genauhalt"], &["position_reached_exact_stop_*"]),
    (&["standstill", "stillstand", "achse steht"], &["axis_stationary", "all_axes_stationary"]),
    (&["end switch", "endschalter", "limit switch"], &["hardware_limit_switch_*", "second_software_limit_switch_*"]),
    (&["klemm"], &["clamping_in_progress"]),
    (&["betriebsart", "operating mode"], &["mode_automatic", "mode_mdi", "mode_jog", "active_mode_*"]),
    (&["quittier", "acknowledge alarms"], &["channel_reset", "mode_group_reset"]),
    (&["bag bereit", "bag ready"], &["mode_group_ready"]),
    (
        &["referenzpunktfahren", "reference point approach", "zero return"],
        &["machine_function_ref", "active_machine_function_ref", "activate_referencing", "referencing_active"],
    ),
    (&["gantry master", "führungsachse", "fuehrungsachse"], &["gantry_leading_axis"]),
    (
        &["gantry slave", "gleichlaufachse", "gleichlauf"],
        &[
            "gantry_axis",
            "gantry_trip_limit_exceeded",
            "gantry_warning_limit_exceeded",
            "gantry_grouping_is_synchronized",
        ],
    ),
    (&["synchronlauf starten", "start synchronisation", "sync start"], &["start_gantry_synchronization"]),
    (&["antrieb bereit", "drive status"], &["drive_ready"]),
    (&["lageregler", "position control", "closed loop"], &["position_controller_active"]),
    (&["drehzahlregler"], &["speed_controller_active"]),
    (&["stromregler"], &["current_controller_active"]),
    (&["handrad", "mpg"], &["handwheel_*", "activate_handwheel_*"]),
    (&["schrittmaß", "schrittmass"], &["machine_function_increment_*", "active_machine_function_increment_*"]),
    (&["fahrbefehl", "travel command", "motion command", "moving"], &["traverse_command_*"]),
    (&["fahranforderung", "travel request"], &["traverse_request_*"]),
    (&["achssperre", "axis lock"], &["axis_spindle_disable"]),
    (&["restweg", "distance to go"], &["delete_distance_to_go_spindle_reset", "distance_to_go"]),
    (&["istwert", "istposition", "actual value", "actual position"], &["position"]),
    (&["sollwert", "commanded position"], &["setpoint"]),
    (&["geschwindigkeit", "speed of an axis"], &["velocity"]),
    (&["schleppabstand", "schleppfehler", "lag"], &["following_error"]),
];

/// Whether a text, in lower case, is an everyday word for a name.
pub(super) fn means(text: &str, name: &str) -> bool {
    let of_word =
        |words: &[&str]| words.iter().any(|word| *word == text || text.chars().count() > 3 && word.contains(text));
    ALIASES.iter().any(|(words, names)| of_word(words) && names.iter().any(|pattern| fits(pattern, name)))
}

fn fits(pattern: &str, name: &str) -> bool {
    match (pattern.strip_prefix('*'), pattern.strip_suffix('*')) {
        (Some(_), _) => name.contains(pattern.trim_matches('*')),
        (None, Some(start)) => name.starts_with(start),
        (None, None) => name == pattern,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controls;
    use crate::variables::{AxisValue, NamedValue};

    #[test]
    fn every_alias_means_a_signal_or_a_value() {
        let signals = controls::texts().flat_map(|texts| texts.interface().signals().map(|signal| signal.name));
        let values = controls::texts().flat_map(|texts| AxisValue::names(texts.interface()));
        let known: Vec<_> = signals.chain(values).chain(NamedValue::names_of_channel()).collect();
        let names = ALIASES.iter().flat_map(|(_, names)| names.iter());
        let unknown: Vec<_> = names.filter(|pattern| !known.iter().any(|name| fits(pattern, name))).collect();
        assert!(unknown.is_empty(), "{unknown:?}");
        assert!(ALIASES.iter().all(|(words, _)| words.iter().all(|word| word.to_lowercase() == *word)));
    }
}
