//! The findings of `machine-data check` about a readable archive: unknown data, and values that contradict each other.
//!
//! Definitions that the control rejects at power on (10650, 10651) are left to its alarms.

use crate::control::Owner;
use crate::source::Place;
use crate::units::AxisNumber;

use super::archive::Archive;
use super::finding::{Finding, Severity};
use super::{Axis, Datum, MachineData, Target, by_number};

/// All findings about an archive.
#[must_use]
pub fn check(archive: &Archive) -> Vec<Finding> {
    let mut findings = archive.findings.clone();
    cycles(archive, &mut findings);
    names(archive, &mut findings);
    for axis in MachineData::axis_numbers() {
        gantry_code(archive, axis, &mut findings);
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

/// A finding at the place where the datum was given.
fn finding(archive: &Archive, number: u32, owner: Owner, index: u8, what: String, cure: &str) -> Finding {
    let place: Option<Place> =
        Target::new(number, owner, index).ok().and_then(|target| archive.given.get(&target).cloned());
    Finding {
        severity: Severity::Warning,
        place,
        number: Some(number),
        identifier: by_number(number).map(Datum::full_identifier).unwrap_or_default(),
        what,
        cure: cure.to_owned(),
    }
}

/// Checks that the interpolation cycle is a whole multiple of the position control cycle, and that both are within the
/// range of a control.
fn cycles(archive: &Archive, findings: &mut Vec<Finding>) {
    let general = &archive.data.general;
    let (position, interpolation) = (general.posctrl_sysclock_time_ratio, general.ipo_sysclock_time_ratio);
    if interpolation % position.max(1) != 0 {
        let what =
            format!("expected a whole multiple of MD10060 = {position} (else alarm 4110), found {interpolation}");
        findings.push(finding(archive, 10070, Owner::Nck, 0, what, "correct MD10070"));
    }
    let cycle = general.sysclock_cycle_time;
    if !(0.000_1..=0.032).contains(&cycle) {
        let what = format!("expected a basic cycle from 0.0001 to 0.032 s, found {cycle} s");
        findings.push(finding(archive, 10050, Owner::Nck, 0, what, "correct MD10050; its unit is seconds"));
    }
}

/// Finds names that two machine axes have, and names that hide the `AXn` of another axis.
fn names(archive: &Archive, findings: &mut Vec<Finding>) {
    for axis in MachineData::axis_numbers() {
        let name = archive.data.axis_name(axis);
        let logical = MachineData::axis_numbers().find(|other| *other != axis && name == format!("AX{other}"));
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

/// DEF-01, DEF-02: the code of MD37100.
fn gantry_code(archive: &Archive, axis: AxisNumber, findings: &mut Vec<Finding>) {
    let code = archive.data.axes[axis].gantry_axis_type;
    if !matches!(code, 0..=8 | 11..=18) {
        let name = archive.data.axis_name(axis);
        let what = format!("expected 0, 1 to 8 or 11 to 18 for axis {name}, found {code}: alarm 10650 at power on");
        findings.push(finding(
            archive,
            37100,
            Owner::Axis(axis),
            0,
            what,
            "for example 1 for the leading axis and 11 for a synchronous axis of grouping 1",
        ));
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
            let name = archive.data.axis_name(axis);
            let what = format!("expected at least MD{lower} = {least} for axis {name}, found {found}");
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
    let [leading, name] = [leader, axis].map(|axis| archive.data.axis_name(axis));
    for (datum, [wanted, found]) in unequal_data(&axes[leader], &axes[axis]) {
        let what = format!("DYN-03: expected {wanted} for axis {name}, as leading axis {leading} has, found {found}");
        findings.push(finding(archive, datum, Owner::Axis(axis), 0, what, "set the same value within the grouping"));
    }
}

/// MON-16: MD37110 < MD37120 < MD37130; REF-28: MD36500 < MD37110 with two encoders. Both apply only if MD37110 is in
/// use.
fn gantry_limits(archive: &Archive, axis: AxisNumber, findings: &mut Vec<Finding>) {
    let data = &archive.data.axes[axis];
    let name = archive.data.axis_name(axis);
    let (warning, trip, reference) = (data.gantry_pos_tol_warning, data.gantry_pos_tol_error, data.gantry_pos_tol_ref);
    if warning <= 0.0 {
        return;
    }
    let owner = Owner::Axis(axis);
    if trip <= warning {
        let what = format!("MON-16: expected more than MD37110 = {warning} for axis {name}, found {trip}");
        findings.push(finding(archive, 37120, owner, 0, what, "set the trip limit above the warning limit"));
    }
    if reference <= trip {
        let what = format!("MON-16: expected more than MD37120 = {trip} for axis {name}, found {reference}");
        findings.push(finding(archive, 37130, owner, 0, what, "set the limit for referencing above the trip limit"));
    }
    if data.num_encs == 2 && data.enc_change_tol >= warning {
        let what =
            format!("REF-28: expected less than MD37110 = {warning} for axis {name}, found {}", data.enc_change_tol);
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
