//! Commissioning: from the archive of a machine to a control after power on.
//!
//! The existing axes are: if the archive gives MD20070, the axes named there; otherwise the axes with machine data of their own; and in
//! addition those of `plant.toml`. Without any of these, the default of MD20070 applies.

use std::path::{Path, PathBuf};

use crate::control::{AxisHints, Configuration, EncoderModel, Examined, Opened, Owner, Settings, Site, StoredDatum};
use crate::image::{Names, OverrideCoding, Profile, SINUMERIK};
use crate::sinumerik::machine_data::{
    Archive, Finding, MachineData, Severity, Target, check as look_through, files_of, refusal,
};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::axis::AxisPresence;
use crate::sinumerik::parameters::groupings::GROUPINGS;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::strobe::Strobe;
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, Position};

/// The archive of a machine, read.
#[derive(Debug)]
pub struct Commissioning {
    archive: Archive,
}

impl Commissioning {
    /// Reads the files of an archive.
    ///
    /// # Errors
    /// The archive is rejected; the error gives file and line.
    pub fn load(files: &[PathBuf]) -> Result<Self, Problem> {
        Archive::load(files).map(|archive| Self { archive }).map_err(|findings| refusal(&findings))
    }

    /// Reads an archive from file names and contents.
    ///
    /// # Errors
    /// As [`Commissioning::load`].
    pub fn read(files: &[(&str, &[u8])]) -> Result<Self, Problem> {
        let archive = Archive::read(files.iter().copied());
        archive.map(|archive| Self { archive }).map_err(|findings| refusal(&findings))
    }

    fn presence(&self, site: &Site<'_>) -> PerAxis<AxisPresence> {
        let archive = &self.archive;
        let data = &archive.data;
        let channels: Vec<ChannelNumber> =
            ChannelNumber::all().filter(|&channel| data.mode_group(channel).is_some()).collect();
        let in_channel = |axis: AxisNumber| channels.iter().any(|&channel| data.channel_knows(channel, axis));
        let in_plant = |axis: AxisNumber| MachineData::is_axis(axis) && (site.names_axis)(data.axis_name(axis));
        let said = channels.iter().any(|&channel| archive.is_given_for(20070, Owner::Channel(channel)));
        let named = |axis: AxisNumber| in_plant(axis) || if said { in_channel(axis) } else { archive.given_axis(axis) };
        let any = MachineData::axis_numbers().any(named);
        PerAxis::from_fn(|axis| {
            let simulated = data.axes[axis].ctrlout_type == 0 && !data.axes[axis].simu_ax_vdi_output;
            let says_so = Target::new(30350, Owner::Axis(axis), 0).is_ok_and(|target| archive.is_given(&target));
            AxisPresence {
                exists: if any { named(axis) } else { in_channel(axis) },
                // E-26: an axis outputs its signals unless the archive explicitly disables them.
                silent: simulated && says_so,
                geometry_by_default: !archive.is_given_for(20050, Owner::Channel(data.home_channel(axis))),
                mechanics: Mechanics::new(&data.axes[axis]),
            }
        })
    }

    fn hints(&self, control: &Nck) -> PerAxis<AxisHints> {
        let parameters = control.parameters();
        PerAxis::from_fn(|axis| {
            let reference = &parameters.axes[axis].reference;
            AxisHints {
                exists: parameters.axes[axis].exists,
                cam_direction: match (reference.cam_is_active, reference.cam_direction > 0.0) {
                    (false, _) => 0,
                    (true, true) => 1,
                    (true, false) => -1,
                },
                zero_mark_spacing: self.archive.data.axes[axis].enc_refp_marker_dist.map(Position::from_user),
            }
        })
    }
}

impl Configuration for Commissioning {
    fn axis_names(&self) -> Vec<&str> {
        MachineData::axis_numbers().map(|axis| self.archive.data.axis_name(axis)).collect()
    }

    /// As in an archive: names of axes and channels first, then the types of axes, then everything else.
    fn store(&mut self, data: &[StoredDatum]) -> Result<(), Problem> {
        let order = |number| match number {
            10000 | 20000 => 0,
            30300 => 1,
            _ => 2,
        };
        for turn in 0..3 {
            for StoredDatum { target, place, value } in data {
                let found = self.archive.data.parse_target(target);
                match found {
                    Ok(found) if order(found.datum().number) == turn => {
                        self.archive.data.set(&found, value).map_err(|problem| problem.at(place))?;
                        self.archive.given.insert(found, place.clone());
                    }
                    // An axis may have its name only after another datum of this scenario.
                    Ok(_) => {}
                    Err(problem) if turn == 2 => return Err(problem.at(place)),
                    Err(_) => {}
                }
            }
        }
        Ok(())
    }

    #[expect(clippy::cast_possible_truncation, reason = "8 groupings")]
    fn groupings(&self) -> u8 {
        GROUPINGS as u8
    }

    fn open(&self, site: &Site<'_>, settings: &mut Settings, profile: Profile) -> Result<Opened, Problem> {
        let strobe = Strobe::read(settings)?;
        let data = &self.archive.data;
        let presence = self.presence(site);
        let control = Nck::new(data.clone(), presence, strobe);
        let names = Names {
            axes: PerAxis::from_fn(|axis| presence[axis].exists.then(|| data.axis_name(axis).to_owned())),
            channels: PerChannel::from_fn(|channel| Some(data.channels[channel].chan_name.clone())),
            profile,
        };
        names.check()?;
        let groupings = control.parameters().groupings.groupings.iter();
        let groupings = groupings.map(|grouping| (grouping.number, grouping.coupling.members().collect())).collect();
        let mut warnings: Vec<String> = self.archive.findings.iter().map(Finding::to_string).collect();
        warnings.extend(not_modelled(&control, &names, site));
        Ok(Opened { axes: self.hints(&control), control: Box::new(control), names, groupings, warnings })
    }
}

/// The contents of the files of an archive, whether or not they define a usable machine.
///
/// # Errors
/// A file cannot be read, or is not a machine data file.
pub fn examine(path: &Path) -> Result<Examined, Problem> {
    let files = files_of(path)?;
    let archive = match Archive::load(&files) {
        Ok(archive) => archive,
        Err(findings) => {
            return match findings.as_slice() {
                // Not a wrong datum, but a file that is not an archive.
                [Finding { severity: Severity::Error, number: None, place, what, cure, .. }] => {
                    Err(Problem { place: place.clone(), what: what.clone(), cure: cure.clone() })
                }
                findings => Ok(Examined {
                    is_refused: true,
                    is_empty: false,
                    summary: Vec::new(),
                    findings: findings.iter().map(ToString::to_string).collect(),
                }),
            };
        }
    };
    Ok(Examined {
        is_refused: false,
        is_empty: files.is_empty(),
        summary: archive.summary.to_string().lines().map(str::to_owned).collect(),
        findings: look_through(&archive).iter().map(Finding::to_string).collect(),
    })
}

impl MachineData {
    /// The coding of the override switches.
    pub(super) fn override_coding(&self) -> OverrideCoding {
        OverrideCoding {
            interface: &SINUMERIK,
            axis_is_gray: self.general.ovr_ax_is_gray_code,
            feed_is_gray: self.general.ovr_feed_is_gray_code,
            rapid_traverse_is_gray: self.general.ovr_rapid_is_gray_code,
        }
    }
}

/// Functions that machine data or plant request and this version does not model.
fn not_modelled(control: &Nck, names: &Names, site: &Site<'_>) -> Vec<String> {
    let mut warnings = Vec::new();
    for (index, group) in control.active().general.assign_chan_to_mode_group.iter().enumerate() {
        if *group > i32::from(ModeGroupNumber::MAX) {
            let channel = index + 1;
            warnings.push(format!(
                "channel {channel}: MD10010 = {group} is not modelled; the model has mode groups 1 and 2"
            ));
        }
    }
    for (number, axis) in control.parameters().existing() {
        let name = names.axes[number].as_deref().unwrap_or_default();
        for (index, &mode) in axis.reference.mode.iter().enumerate().take(usize::from(axis.encoders)) {
            if mode != 1 {
                let which = if index == 0 { "MD34200" } else { "MD34200[1]" };
                warnings.push(format!(
                    "axis {name}: {which} = {mode} is not modelled; the model references incremental encoders with zero marks (1)"
                ));
            }
        }
        for (index, kind) in (site.encoders)(name).into_iter().enumerate() {
            if matches!(kind, Some(EncoderModel::Absolute | EncoderModel::DistanceCoded)) {
                let number = index + 1;
                warnings.push(format!(
                    "axis {name}: the type of encoder {number} is not modelled; an incremental encoder is used"
                ));
            }
        }
        if axis.modulo {
            warnings.push(format!(
                "axis {name}: MD30310 (modulo) only disables the software limits in the model; positions are not reset"
            ));
        }
        if control.active().axes[number].gantry_function_mask & 1 != 0 {
            warnings.push(format!("axis {name}: MD37150 bit 0, extended monitoring, is not modelled"));
        }
    }
    warnings
}
