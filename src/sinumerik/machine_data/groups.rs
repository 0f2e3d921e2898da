//! The functions to which data without effect belong, by number and name: a report shows one line per function, not one per datum.
//!
//! The ranges are those in which the list manual arranges machine data.

/// The function of a datum that is not modelled. `identifier` has its prefix.
pub(super) fn group(number: Option<u32>, identifier: &str) -> &'static str {
    let name = identifier.to_ascii_uppercase();
    if let Some(group) = by_name(&name) {
        return group;
    }
    let Some(number) = number else {
        return if name.starts_with('$') { "other system variables" } else { "variables of the user" };
    };
    let above = RANGES.partition_point(|(first, _)| *first <= number);
    above.checked_sub(1).and_then(|row| RANGES.get(row)).map_or("other system variables", |(_, group)| *group)
}

/// Whether a name belongs to another list of the control, of which nothing is in the catalogue: tools, frames, options, operating software,
/// compensation tables.
pub(super) fn is_of_another_list(identifier: &str) -> bool {
    let name = identifier.to_ascii_uppercase();
    let lists = ["$TC_", "$P_", "$ON_", "$OC_", "$OA_", "$MNS_", "$MCS_", "$MAS_", "$SNS_", "$SCS_", "$SAS_"];
    lists.iter().chain(&["$AA_", "$AN_", "$AC_", "$A_"]).any(|prefix| name.starts_with(prefix))
}

fn by_name(name: &str) -> Option<&'static str> {
    let prefix = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    if name.contains("SAFE") && !name.starts_with("$TC_") {
        Some("Safety Integrated")
    } else if prefix(&["$TC_"]) {
        Some("tools, magazines and tool carriers")
    } else if prefix(&["$P_"]) {
        Some("frames and zero offsets")
    } else if prefix(&["$ON_", "$OC_", "$OA_"]) {
        Some("options and licences")
    } else if prefix(&["$MNS_", "$MCS_", "$MAS_", "$SNS_", "$SCS_", "$SAS_"]) {
        Some("operating software and cycles")
    } else if prefix(&["$AA_", "$AN_", "$AC_", "$A_"]) {
        Some("compensation tables and system variables")
    } else if prefix(&["$MA_SPIND", "$MA_GEAR_STEP", "$SA_SPIND", "$MC_SPIND"]) {
        Some("spindles")
    } else {
        None
    }
}

/// The first number of each range, and its function.
const RANGES: &[(u32, &str)] = &[
    (0, "other system variables"),
    (10_000, "cycles of the control"),
    (10_100, "basic PLC program"),
    (10_190, "basic system of units"),
    (10_300, "fast inputs and outputs"),
    (10_400, "compile cycles"),
    (10_500, "fast inputs and outputs"),
    (10_600, "frames and zero offsets"),
    (10_700, "NC programs"),
    (10_900, "indexing axes"),
    (11_100, "auxiliary functions"),
    (11_200, "saving and protecting data"),
    (11_290, "JOG and handwheels"),
    (11_400, "alarms and diagnosis"),
    (11_450, "NC programs"),
    (11_640, "axes and channels of other control units"),
    (12_000, "override switches"),
    (12_200, "JOG and handwheels"),
    (12_300, "lubrication"),
    (12_700, "axes and channels of other control units"),
    (13_000, "drives and bus"),
    (13_200, "measuring"),
    (13_300, "Safety Integrated"),
    (14_000, "data of the user for the PLC"),
    (15_000, "NC programs"),
    (16_800, "operating software and cycles"),
    (17_000, "saving and protecting data"),
    (17_500, "tools, magazines and tool carriers"),
    (17_600, "saving and protecting data"),
    (17_700, "operating software and cycles"),
    (17_900, "basic PLC program"),
    (17_950, "memory"),
    (19_000, "options and licences"),
    (20_000, "axes and channels"),
    (20_100, "NC programs"),
    (20_270, "tools, magazines and tool carriers"),
    (20_400, "path velocity and look-ahead"),
    (20_700, "NC programs"),
    (20_900, "couplings"),
    (21_000, "geometry of the path"),
    (21_100, "orientation and transformations"),
    (21_200, "NC programs"),
    (21_300, "couplings"),
    (21_500, "geometry of the path"),
    (22_000, "auxiliary functions"),
    (22_550, "tools, magazines and tool carriers"),
    (22_600, "NC programs"),
    (24_000, "frames and zero offsets"),
    (24_100, "orientation and transformations"),
    (26_000, "punching and nibbling"),
    (27_000, "operating software and cycles"),
    (27_900, "memory"),
    (29_000, "options and licences"),
    (30_000, "axes, setpoint and actual value channels"),
    (30_500, "indexing axes and fixed points"),
    (30_800, "working areas and protection zones"),
    (31_000, "encoders and mechanics"),
    (32_000, "JOG and handwheels"),
    (32_100, "position control and feedforward"),
    (32_300, "dynamic limits"),
    (32_440, "position control and feedforward"),
    (32_450, "compensations"),
    (32_600, "position control and feedforward"),
    (32_690, "compensations"),
    (32_800, "position control and feedforward"),
    (33_000, "path velocity and look-ahead"),
    (33_050, "lubrication and maintenance"),
    (33_100, "path velocity and look-ahead"),
    (34_000, "reference point approach"),
    (34_990, "encoders and mechanics"),
    (35_000, "spindles"),
    (36_000, "monitoring"),
    (36_900, "Safety Integrated"),
    (37_000, "travel to fixed stop"),
    (37_100, "couplings"),
    (37_500, "stopping and retracting"),
    (37_600, "drives and bus"),
    (37_700, "axes, setpoint and actual value channels"),
    (37_900, "Safety Integrated"),
    (38_000, "memory"),
    (39_000, "operating software and cycles"),
    (41_000, "JOG setting data"),
    (41_300, "other setting data"),
    (50_000, "operating software and cycles"),
    (60_000, "compile cycles"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_ascend() {
        assert!(RANGES.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_datum_belongs_to_the_function_of_its_name_or_its_number() {
        assert_eq!(group(Some(35_100), "$MA_SPIND_VELO_LIMIT"), "spindles");
        assert_eq!(group(Some(36_901), "$MA_SAFE_FUNCTION_ENABLE"), "Safety Integrated");
        assert_eq!(group(Some(51_000), "$MNS_ANY"), "operating software and cycles");
        assert_eq!(group(Some(18_100), "$MN_MM_NUM_CUTTING_EDGES_IN_TOA"), "memory");
        assert_eq!(group(None, "$TC_DP1"), "tools, magazines and tool carriers");
        assert_eq!(group(None, "$FOREIGN"), "other system variables");
        assert_eq!(group(None, "_HEADLINE"), "variables of the user");
        assert_eq!(group(Some(4), "$X"), "other system variables");
    }
}
