//! The findings at the opening of a machine: alarms that power on raises, data that act on a control otherwise than here, and data without
//! effect.
//!
//! Only axes, channels and encoders that exist are listed. Data that are read but have no effect in the model are listed where they differ
//! from their default. What a PLC program can see is a finding of the class "acts otherwise", everything else is "not modelled".

use crate::control::{Class, EncoderModel, Finding, Owner, Site, Value};
use crate::image::Names;
use crate::sinumerik::alarms::{self, Alarm};
use crate::sinumerik::machine_data::{Archive, Axis, check, datum_name};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::groupings::Fault;
use crate::sinumerik::parameters::spindle::is_spindle;
use crate::units::{AxisNumber, ModeGroupNumber};
use crate::variables::{Parameter, Place};

/// Data of the catalogue that have no effect in the model, what a control does with them, and what to do about it. A PLC program can see it.
const ACTS_OTHERWISE: &[(u32, &str, &str)] = &[
    (
        10735,
        "the extended functions of JOG are not modelled",
        "test without them: what the datum switches on does nothing here",
    ),
    (11410, "no alarm is suppressed", "expect the alarms that the datum suppresses on a control"),
    (11411, "no further alarm is enabled", "do not wait for the alarms that the datum enables on a control"),
    (
        30242,
        "the corrections of the active encoder always affect the other one",
        "reference each encoder before you compare the two",
    ),
    (30320, "the position is not shown modulo", "compare positions from 0 to 360 degrees only"),
    (32711, "lengths in tables $AN_CEC are in mm", "write the tables in mm"),
    (
        34102,
        "a reference point approach references one encoder",
        "select the other measuring system (position_measuring_system_1, position_measuring_system_2), and reference it as well",
    ),
    (34104, "an axis in follow-up is not referenced", "give the axis its controller_enable before the approach"),
    (35020, "a spindle begins in speed control", "expect control_mode after power on, NC start and RESET"),
    (36052, "clamping has no special functions", "expect clamping_in_progress to act as with MD36052 = 0"),
    (
        36730,
        "the signals of the drive are those of the plant",
        "let a scenario give faults of the drive: fault = { axis = \"AXIS\", kind = \"drive_fault\" }",
    ),
];

/// Data of the catalogue that have no effect in the model and no effect on the interface.
const WITHOUT_EFFECT: &[u32] = &[10200, 10210, 32070, 32402, 32650, 34220, 34232, 34800, 36042, 36520, 41100];

/// Data beside the catalogue with which a control shows a PLC program something that is not modelled, their default, and what to do.
const SEEN_BY_THE_PLC: &[(u32, f64, &str, &str)] = &[
    (
        10450,
        0.0,
        "software cams are not modelled",
        "the signals of the cams stay 0: test what follows from them at the machine",
    ),
    (24100, 0.0, "transformations are not modelled", "the signals of the transformation stay 0: test in machine axes"),
    (30500, 0.0, "indexing axes are not modelled", "traverse with keys, increments and handwheels in mm or degrees"),
    (
        33050,
        1e8,
        "the lubrication pulse is not modelled",
        "lubrication_pulse does not change: test the lubrication at the machine",
    ),
    (
        36901,
        0.0,
        "Safety Integrated is not modelled",
        "the safety signals stay 0: test what follows from them at the machine",
    ),
    (
        37000,
        0.0,
        "travel to fixed stop is not modelled",
        "the signals of travel to fixed stop stay 0: test what follows from them at the machine",
    ),
];

/// Whether a datum of the catalogue has an effect in the model.
pub(super) fn has_effect(number: u32) -> bool {
    !WITHOUT_EFFECT.contains(&number) && !ACTS_OTHERWISE.iter().any(|(other, ..)| *other == number)
}

/// All findings about a machine, the heaviest first.
pub(super) fn findings(archive: &Archive, control: &Nck, names: &Names, site: &Site<'_>) -> Vec<Finding> {
    let mut findings = archive.findings.clone();
    // A datum beside the catalogue is known, although the catalogue does not have it.
    let is_known = |number: Option<u32>| SEEN_BY_THE_PLC.iter().any(|(known, ..)| number == Some(*known));
    let mistyped = findings.iter_mut().filter(|finding| finding.class == Class::Mistyped && is_known(finding.number));
    for finding in mistyped {
        (finding.class, finding.what, finding.cure) = (Class::NotModelled, "kept, no effect".to_owned(), String::new());
    }
    findings.extend(check(archive));
    let parameters = control.parameters();
    findings.extend(parameters.groupings.faults.iter().map(|fault| of_grouping(fault, archive, control, names)));
    findings.extend(parameters.faults.iter().map(|found| of_channel(&found.fault, archive, names)));
    if parameters.corrected_ratios.is_some() {
        let shown = [Parameter::Milliseconds(parameters.cycle), Parameter::None, Parameter::None, Parameter::None];
        let fault = Fault { alarm: alarms::CYCLE_CHANGED, place: Place::Nck, parameters: shown };
        let finding = at_power_on(&fault, "set MD10070 to a multiple of MD10060", names);
        findings.push(archive.about(10070, Owner::Nck, 0, finding));
    }
    mode_groups(archive, &mut findings);
    for (number, _) in control.parameters().existing() {
        let axis = &control.active().axes[number];
        references(archive, number, axis, &mut findings);
        functions(archive, number, axis, &mut findings);
        encoders(archive, number, axis, site, &mut findings);
        unused_cam(archive, number, control, site, &mut findings);
    }
    without_effect(archive, control, &mut findings);
    seen_by_the_plc(archive, control, &mut findings);
    findings.sort_by(|a, b| a.class.cmp(&b.class).then_with(|| a.place.cmp(&b.place)));
    findings
}

/// The finding of a fault of a channel and its axes.
fn of_channel(fault: &Fault, archive: &Archive, names: &Names) -> Finding {
    let (cure, index) = match fault.parameters {
        _ if (alarms::SAG_TOO_MANY_TABLES..=alarms::SAG_PRODUCT).contains(&fault.alarm) => {
            ("correct the table $AN_CEC, or set SD41300 ($SN_CEC_TABLE_ENABLE) of it to 0", None)
        }
        [Parameter::Channel(channel), Parameter::Axis(axis), ..] => {
            let used = archive.data.channels[channel].axconf_machax_used;
            let cure =
                "give the axis to one channel, or set MD30550 of the axis to the channel that has it after power on";
            (cure, used.iter().position(|&number| number == axis.number()))
        }
        [_, _, Parameter::Number(index), _] => {
            ("close the gap, or set bit 0 of MD11640 ($MN_ENABLE_CHAN_AX_GAP)", usize::try_from(index).ok())
        }
        _ => ("", None),
    };
    let finding = at_power_on(fault, cure, names);
    match (fault.place, index.and_then(|index| u8::try_from(index).ok())) {
        (Place::Channel(channel), Some(index)) => archive.about(20070, Owner::Channel(channel), index, finding),
        _ => finding,
    }
}

/// The finding of a fault in the definition of a grouping.
fn of_grouping(fault: &Fault, archive: &Archive, control: &Nck, names: &Names) -> Finding {
    let finding = at_power_on(fault, cure_of(fault), names);
    match fault_axis(fault, control) {
        Some(axis) => archive.about(37100, Owner::Axis(axis), 0, finding),
        None => finding,
    }
}

/// The finding of an alarm that power on raises.
fn at_power_on(fault: &Fault, cure: &str, names: &Names) -> Finding {
    let shown = |parameter: &Parameter| match parameter {
        Parameter::None => String::new(),
        Parameter::Channel(channel) => names.channels[*channel].clone().unwrap_or_else(|| format!("CHAN{channel}")),
        Parameter::Axis(axis) => names.axes[*axis].clone().unwrap_or_else(|| format!("AX{axis}")),
        Parameter::Number(number) => number.to_string(),
        Parameter::Direction(sign) => if *sign < 0 { "-" } else { "+" }.to_owned(),
        Parameter::Milliseconds(time) => time.milliseconds().to_string(),
        Parameter::Text(text) => text.to_string(),
        Parameter::OfControl(_) => String::new(),
    };
    let alarm = Alarm::find(fault.alarm);
    let mut text = alarm.map_or_else(String::new, |alarm| alarm.text.to_owned());
    for (index, parameter) in fault.parameters.iter().enumerate() {
        text = text.replace(&format!("%{}", index + 1), &shown(parameter));
    }
    Finding::new(Class::AlarmAtPowerOn, format!("{}: {text}", Alarm::name(fault.alarm)), cure)
}

/// What to do about the definition of a grouping, by the reason of the alarm.
fn cure_of(fault: &Fault) -> &'static str {
    let reason = fault.parameters.iter().find_map(|parameter| match parameter {
        Parameter::Number(reason) => Some(*reason),
        Parameter::None
        | Parameter::Channel(_)
        | Parameter::Axis(_)
        | Parameter::Direction(_)
        | Parameter::Milliseconds(_)
        | Parameter::Text(_)
        | Parameter::OfControl(_) => None,
    });
    match reason {
        Some(1000..2000) => "no leading axis: give one axis MD37100 = the number of the grouping",
        Some(2000..3000) => "no synchronous axis: give one axis MD37100 = the number of the grouping + 10",
        Some(3000..4000) => "give the axes of the grouping the same MD30550",
        Some(4000..7000) => "assign all axes of the grouping to the same channel (MD20070)",
        Some(10_000) => "remove the synchronous axis from MD20050",
        Some(13_000) => "set MD35000 = 0, or remove the axis from the grouping (MD37100)",
        Some(14_000) => "set MD30505 = 0, or remove the axis from the grouping (MD37100)",
        Some(_) | None => "compare MD37100 of all axes: 1 to 8 leads, 11 to 18 follows, each number leads once",
    }
}

/// The axis whose MD37100 an alarm concerns: its own, or the first axis of the grouping in the reason.
fn fault_axis(fault: &Fault, control: &Nck) -> Option<AxisNumber> {
    if let Place::Axis(axis) = fault.place {
        return Some(axis);
    }
    let reason = fault.parameters.iter().find_map(|parameter| match parameter {
        Parameter::Number(reason) => Some(*reason),
        Parameter::None
        | Parameter::Channel(_)
        | Parameter::Axis(_)
        | Parameter::Direction(_)
        | Parameter::Milliseconds(_)
        | Parameter::Text(_)
        | Parameter::OfControl(_) => None,
    })?;
    let grouping = reason % 100;
    let of_grouping = |axis: &AxisNumber| {
        let code = i64::from(control.active().axes[*axis].gantry_axis_type);
        if grouping == 0 { code != 0 } else { code == grouping || code == grouping + 10 }
    };
    control.parameters().existing().map(|(number, _)| number).find(of_grouping)
}

fn mode_groups(archive: &Archive, findings: &mut Vec<Finding>) {
    for (index, group) in (0..).zip(archive.data.general.assign_chan_to_mode_group) {
        if group > i32::from(ModeGroupNumber::MAX) {
            let what = format!("channel {} is not modelled; the model has mode groups 1 and 2", index + 1);
            let cure = "assign the channel to mode group 1 or 2 for the test";
            findings.push(archive.about(10010, Owner::Nck, index, Finding::new(Class::ActsOtherwise, what, cure)));
        }
    }
}

/// A cam of the plant for an axis that does not search for it.
fn unused_cam(archive: &Archive, number: AxisNumber, control: &Nck, site: &Site<'_>, findings: &mut Vec<Finding>) {
    let place = (site.cam)(archive.data.axis_name(number));
    let Some(place) = place.filter(|_| !control.parameters().axes[number].reference.cam_is_active) else { return };
    let what = format!("the reference point approach does not use the cam of {place}");
    let name = archive.data.axis_name(number);
    let cure = format!("set MD34000 to 1, or write cam = false in [{name}]");
    findings.push(archive.about(34000, Owner::Axis(number), 0, Finding::new(Class::Implausible, what, cure)));
}

/// The reference point approach of the encoders that an axis has.
fn references(archive: &Archive, number: AxisNumber, axis: &Axis, findings: &mut Vec<Finding>) {
    let mut add = |datum: u32, index: u8, what: &str, cure: &str| {
        findings.push(archive.about(datum, Owner::Axis(number), index, Finding::new(Class::ActsOtherwise, what, cure)));
    };
    if axis.spind_assign_to_machax != 0 {
        return;
    }
    for encoder in 0..axis.num_encs.min(2) {
        match axis.enc_refp_mode[usize::from(encoder)] {
            // 0 without an absolute encoder has no approach on a control either.
            1 | 3 => {}
            0 if axis.enc_type[usize::from(encoder)] == 4 => {}
            0 => {
                let what = "an encoder that is not absolute (MD30240 = 4) has no reference point approach with 0, and is never referenced";
                add(34200, encoder, what, "set MD34200 = 1 (zero marks) or 3 (distance-coded marks)");
            }
            _ => {
                let what = "this kind of reference point approach is not modelled, and the encoder is never referenced; the model \
                    references with zero marks (1), distance-coded marks (3) and absolute encoders (0)";
                add(34200, encoder, what, "set MD34200 = 1 for the test; `plant.toml` gives the zero marks");
            }
        }
    }
}

fn functions(archive: &Archive, number: AxisNumber, axis: &Axis, findings: &mut Vec<Finding>) {
    let mut add = |datum: u32, what: &str, cure: &str| {
        findings.push(archive.about(datum, Owner::Axis(number), 0, Finding::new(Class::ActsOtherwise, what, cure)));
    };
    if axis.spind_assign_to_machax != 0 && !is_spindle(axis) {
        let what = "a spindle is a modulo rotary axis; this one stays an axis";
        add(35000, what, "set MD30300 and MD30310 to 1");
    }
    if axis.is_rot_ax && axis.rot_is_modulo {
        let what = "modulo only disables the software limits in the model; positions are not reset";
        add(30310, what, "compare positions from 0 to 360 degrees only");
    }
}

/// An encoder of the plant that is of another type than its machine data say.
fn encoders(archive: &Archive, number: AxisNumber, axis: &Axis, site: &Site<'_>, findings: &mut Vec<Finding>) {
    let kinds = (site.encoders)(archive.data.axis_name(number)).into_iter().zip(0..axis.num_encs.min(2));
    let name = archive.data.axis_name(number);
    for (kind, index) in kinds {
        let write = |kind: &str| format!("write kind = \"{kind}\" in [{name}.encoder{}] of plant.toml", index + 1);
        let (mode, encoder_type) = (axis.enc_refp_mode[usize::from(index)], axis.enc_type[usize::from(index)]);
        let reads = mode == 0 && encoder_type == 4;
        let (datum, what, cure) = match kind {
            Some(EncoderModel::Incremental | EncoderModel::DistanceCoded) if reads => {
                (30240, "the encoder of `plant.toml` is not absolute: alarm 26020", write("absolute"))
            }
            Some(EncoderModel::Absolute) if encoder_type != 4 => {
                let what = "the encoder of `plant.toml` is absolute, and the control uses it as an incremental one";
                (30240, what, "set MD30240 = 4 and MD34200 = 0".to_owned())
            }
            Some(EncoderModel::Incremental | EncoderModel::Absolute) if mode == 3 => {
                let what =
                    "the encoder of `plant.toml` has no distance-coded marks: positions after referencing are wrong";
                (34200, what, write("distance_coded"))
            }
            Some(EncoderModel::DistanceCoded) if mode != 3 => {
                let what =
                    "the encoder of `plant.toml` has distance-coded marks: the next of them is taken as the zero mark";
                (34200, what, "set MD34200 = 3".to_owned())
            }
            Some(EncoderModel::Incremental | EncoderModel::Absolute | EncoderModel::DistanceCoded) | None => continue,
        };
        let finding = Finding::new(Class::Implausible, what, cure);
        findings.push(archive.about(datum, Owner::Axis(number), index, finding));
    }
}

/// Given data of the catalogue without effect that differ from their default.
fn without_effect(archive: &Archive, control: &Nck, findings: &mut Vec<Finding>) {
    let exists = |owner: Owner, index: u8, per_encoder: bool| match owner {
        Owner::Axis(axis) => {
            let parameters = &control.parameters().axes[axis];
            parameters.exists && (!per_encoder || index < parameters.encoders)
        }
        Owner::Nck | Owner::Channel(_) => true,
    };
    for target in archive.given.keys() {
        let (datum, owner, index) = (target.datum(), target.owner(), target.index());
        let seen = ACTS_OTHERWISE.iter().find(|(number, ..)| *number == datum.number);
        if seen.is_none() && !WITHOUT_EFFECT.contains(&datum.number) {
            continue;
        }
        if archive.has_default(target) || !exists(owner, index, datum.count == 2) {
            continue;
        }
        let finding = match seen {
            Some(&(_, what, cure)) => Finding::new(Class::ActsOtherwise, what, of_the_axis(cure, archive, owner)),
            None => Finding {
                group: "read, without effect in the model",
                ..Finding::new(Class::NotModelled, "kept, no effect", "")
            },
        };
        findings.push(archive.about(datum.number, owner, index, finding));
    }
}

/// A remedy with the name of its axis in place of `AXIS`.
fn of_the_axis(cure: &str, archive: &Archive, owner: Owner) -> String {
    match owner {
        Owner::Axis(axis) => cure.replace("AXIS", archive.data.axis_name(axis)),
        Owner::Nck | Owner::Channel(_) => cure.to_owned(),
    }
}

/// Unknown data with which a control shows a PLC program something: one finding for each datum and axis, where a value is not the default.
fn seen_by_the_plc(archive: &Archive, control: &Nck, findings: &mut Vec<Finding>) {
    let mut named: Vec<(u32, String)> = Vec::new();
    for unknown in &archive.unknown {
        let row = SEEN_BY_THE_PLC.iter().find(|(number, ..)| unknown.number == Some(*number));
        let Some((number, default, what, cure)) = row else { continue };
        let value = Value::parse(&unknown.value).and_then(|value| value.number());
        if value.is_none_or(|value| (value - default).abs() < f64::EPSILON) {
            continue;
        }
        let inside = unknown.name.split_once('[').map_or("", |(_, inside)| inside.trim_end_matches(']'));
        let axis = inside.rsplit(',').next().and_then(|name| archive.data.axis(name.trim()));
        let is_axial = unknown.name.starts_with("$MA_");
        let owner = match axis {
            Some(axis) if is_axial && control.parameters().axes[axis].exists => {
                archive.data.owner_in_words(Owner::Axis(axis))
            }
            Some(_) | None if is_axial => continue,
            Some(_) | None => String::new(),
        };
        let key = (*number, owner);
        if named.contains(&key) {
            continue;
        }
        named.push(key.clone());
        findings.push(Finding {
            place: Some(unknown.place.clone()),
            number: Some(*number),
            datum: format!("{} {}", datum_name(*number), unknown.name),
            value: unknown.value.clone(),
            owner: key.1,
            ..Finding::new(Class::ActsOtherwise, *what, *cure)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinumerik::machine_data::by_number;

    #[test]
    fn every_listed_datum_is_in_the_catalogue_or_beside_it() {
        let read = ACTS_OTHERWISE.iter().map(|(number, ..)| number).chain(WITHOUT_EFFECT);
        for number in read {
            assert!(by_number(*number).is_some(), "{number}");
        }
        for (number, ..) in SEEN_BY_THE_PLC {
            assert!(by_number(*number).is_none(), "{number}");
        }
    }
}
