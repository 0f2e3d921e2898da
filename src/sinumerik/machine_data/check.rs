//! Values of an archive that contradict each other.
//!
//! Definitions that the control rejects or corrects at power on (4000, 4001, 4110, 10650, 10651) are left to its alarms.

use crate::control::{Class, Finding, Owner};
use crate::units::AxisNumber;

use super::archive::Archive;
use super::import::with_number;
use super::{Axis, MachineData, Target};

/// All contradictions in an archive.
#[must_use]
pub fn check(archive: &Archive) -> Vec<Finding> {
    let mut findings = Vec::new();
    cycles(archive, &mut findings);
    names(archive, &mut findings);
    for axis in MachineData::axis_numbers() {
        monitoring_order(archive, axis, &mut findings);
        if archive.data.axes[axis].gantry_axis_type != 0 {
            gantry_limits(archive, axis, &mut findings);
            gantry_dynamics(archive, axis, &mut findings);
        }
    }
    findings
}

/// DYN-03: the data of interpolation and jerk that must be equal within a grouping and differ, with the values of the
/// leading axis and the synchronous axis.
pub(in crate::sinumerik) fn unequal_data(leading: &Axis, synchronous: &Axis) -> impl Iterator<Item = (u32, [f64; 2])> {
    let values = |axis: &Axis| {
        [
            (33000, f64::from(axis.fipo_type)),
            (32400, f64::from(u8::from(axis.ax_jerk_enable))),
            (32410, axis.ax_jerk_time),
            (32420, f64::from(u8::from(axis.jog_and_pos_jerk_enable))),
            (32430, axis.jog_and_pos_max_jerk),
        ]
    };
    let both = values(leading).into_iter().zip(values(synchronous));
    both.map(|((datum, wanted), (_, found))| (datum, [wanted, found]))
        .filter(|(_, [wanted, found])| (wanted - found).abs() > 0.0)
}

/// A finding of implausible data about the value of a datum, at the place where it was given.
fn finding(archive: &Archive, number: u32, owner: Owner, index: u8, what: String, cure: &str) -> Finding {
    archive.about(number, owner, index, Finding::new(Class::Implausible, what, cure))
}

impl Archive {
    /// Whether a value is the default of its datum, for the type of its axis.
    #[must_use]
    pub fn has_default(&self, target: &Target) -> bool {
        let is_rotary = matches!(target.owner(), Owner::Axis(axis) if self.data.axes[axis].is_rot_ax);
        self.data.get(target) == target.datum().default_value(target.index(), is_rotary)
    }

    /// A finding about the value of a datum: with its place, number, name, value and owner.
    #[must_use]
    pub fn about(&self, number: u32, owner: Owner, index: u8, finding: Finding) -> Finding {
        let Ok(target) = Target::new(number, owner, index) else {
            return finding;
        };
        let value = self.data.get(&target).map(|value| value.export(target.datum().kind)).unwrap_or_default();
        Finding {
            place: self.given.get(&target).cloned(),
            number: Some(number),
            datum: with_number(Some(number), &target.to_string()),
            value,
            owner: self.data.owner_in_words(owner),
            ..finding
        }
    }
}

/// Checks that the basic cycle is within the range of a control.
fn cycles(archive: &Archive, findings: &mut Vec<Finding>) {
    let cycle = archive.data.general.sysclock_cycle_time;
    if !(0.000_1..=0.032).contains(&cycle) {
        let what = "expected a basic cycle from 0.0001 to 0.032 s".to_owned();
        findings.push(finding(archive, 10050, Owner::Nck, 0, what, "correct MD10050; its unit is seconds"));
    }
}

/// Finds names that two machine axes have, and names that hide the `AXn` of another axis.
fn names(archive: &Archive, findings: &mut Vec<Finding>) {
    for axis in MachineData::axis_numbers() {
        let name = archive.data.axis_name(axis);
        let logical = name
            .strip_prefix("AX")
            .and_then(|number| MachineData::axis_numbers().find(|other| *other != axis && number == other.to_string()));
        if let Some(other) = logical {
            let what = format!("expected a name other than `{name}`, which means axis {other}, for axis {axis}");
            let cure = "choose a name that is not AXn, or AXn with its own number";
            findings.push(finding(archive, 10000, Owner::Nck, axis.number() - 1, what, cure));
        }
        if let Some(other) = archive.data.axis(name)
            && other != axis
        {
            let what =
                format!("expected a unique name for machine axis {axis}, found `{name}`, which axis {other} has");
            let index = axis.number() - 1;
            findings.push(finding(archive, 10000, Owner::Nck, index, what, "give every machine axis its own name"));
        }
    }
}

/// Limits and times of an axis that must be in ascending order, checked if the archive gives one of the two.
fn monitoring_order(archive: &Archive, axis: AxisNumber, findings: &mut Vec<Finding>) {
    let (data, owner) = (&archive.data.axes[axis], Owner::Axis(axis));
    let order = [
        (36010, data.stop_limit_fine, 36000, data.stop_limit_coarse, "set exact stop fine below exact stop coarse"),
        (
            36000,
            data.stop_limit_coarse,
            36030,
            data.standstill_pos_tol,
            "set exact stop coarse below the standstill tolerance",
        ),
        (
            32000,
            data.max_ax_velo,
            36200,
            data.ax_velo_limit[0],
            "set the alarm limit 10 to 15 % above the largest velocity",
        ),
        (
            36610,
            data.ax_emergency_stop_time,
            36620,
            data.servo_disable_delay_time,
            "the ramp must end before the enables are removed",
        ),
    ];
    for (lower, least, upper, found, cure) in order {
        if found < least && (archive.is_given_for(lower, owner) || archive.is_given_for(upper, owner)) {
            let what = format!("expected at least MD{lower} = {least}");
            findings.push(finding(archive, upper, owner, 0, what, cure));
        }
    }
}

/// DYN-03, for a synchronous axis.
fn gantry_dynamics(archive: &Archive, axis: AxisNumber, findings: &mut Vec<Finding>) {
    let axes = &archive.data.axes;
    let Some(grouping @ 1..=8) = axes[axis].gantry_axis_type.checked_sub(10) else { return };
    let Some(leader) = MachineData::axis_numbers().find(|&other| axes[other].gantry_axis_type == grouping) else {
        return;
    };
    let leading = archive.data.axis_name(leader);
    for (datum, [wanted, _]) in unequal_data(&axes[leader], &axes[axis]) {
        let what = format!("DYN-03: expected {wanted}, as leading axis {leading} has");
        findings.push(finding(archive, datum, Owner::Axis(axis), 0, what, "set the same value within the grouping"));
    }
}

/// MON-16: MD37110 < MD37120 < MD37130; REF-28: MD36500 < MD37110 with two encoders. Without the warning limit (MD37110 = 0), only an
/// MD37120 above MD37130 is wrong: the limits of an axis that uses none of them are equal.
fn gantry_limits(archive: &Archive, axis: AxisNumber, findings: &mut Vec<Finding>) {
    let data = &archive.data.axes[axis];
    let (warning, trip, reference) = (data.gantry_pos_tol_warning, data.gantry_pos_tol_error, data.gantry_pos_tol_ref);
    let owner = Owner::Axis(axis);
    let warns = warning > 0.0;
    if warns && trip <= warning {
        let what = format!("MON-16: expected more than MD37110 = {warning}");
        findings.push(finding(archive, 37120, owner, 0, what, "set the trip limit above the warning limit"));
    }
    if reference < trip || warns && reference <= trip {
        let what = format!("MON-16: expected more than MD37120 = {trip}");
        findings.push(finding(archive, 37130, owner, 0, what, "set the limit for referencing above the trip limit"));
    }
    if warns && data.num_encs == 2 && data.enc_change_tol >= warning {
        let what = format!("REF-28: expected less than MD37110 = {warning}");
        findings.push(finding(
            archive,
            36500,
            owner,
            0,
            what,
            "lower MD36500: otherwise an encoder switch-over alone can cause the warning",
        ));
    }
}
