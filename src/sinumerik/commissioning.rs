//! Commissioning: from the archive of a machine to a control after power on.
//!
//! The existing axes are: if the archive gives MD20070, the axes named there; otherwise the axes with machine data of their own; and in
//! addition those of `plant.toml`. Without any of these, the default of MD20070 applies.

use std::path::{Path, PathBuf};

use crate::control::{AxisHints, Configuration, EncoderModel, Examined, Opened, Owner, Settings, Site, StoredDatum};
use crate::image::{Names, OverrideCoding, Profile, SINUMERIK};
use crate::sinumerik::machine_data::{Archive, Axis, MachineData, files_of, refusal};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::opening::findings;
use crate::sinumerik::parameters::axis::{AxisPresence, Kind};
use crate::sinumerik::parameters::groupings::GROUPINGS;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::parameters::spindle::is_spindle;
use crate::sinumerik::strobe::Strobe;
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, PerAxis, PerChannel, Position};

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
        let acting = data.acting(&archive.out_of_range);
        PerAxis::from_fn(|axis| AxisPresence {
            exists: if any { named(axis) } else { in_channel(axis) },
            output_is_given: archive.is_given_for(30350, Owner::Axis(axis)),
            geometry_by_default: !archive.is_given_for(20050, Owner::Channel(data.home_channel(axis))),
            mechanics: Mechanics::new(&acting.axes[axis]),
        })
    }

    fn hints(&self, control: &Nck) -> PerAxis<AxisHints> {
        let parameters = control.parameters();
        let acting = self.archive.data.acting(&self.archive.out_of_range);
        PerAxis::from_fn(|axis| {
            let reference = &parameters.axes[axis].reference;
            AxisHints {
                exists: parameters.axes[axis].exists,
                cam_direction: match (reference.cam_is_active, reference.cam_direction > 0.0) {
                    (false, _) => 0,
                    (true, true) => 1,
                    (true, false) => -1,
                },
                cam_is_fixed: false,
                zero_mark_spacing: spacing(&acting.axes[axis]),
                encoders: parameters.axes[axis].reference.kind.map(|kind| match kind {
                    Kind::Absolute => EncoderModel::Absolute,
                    Kind::DistanceCoded => EncoderModel::DistanceCoded,
                    Kind::ZeroMark | Kind::None => EncoderModel::Incremental,
                }),
                zero_mark_code: reference.scale.map(|scale| (scale.shift, scale.inverted)),
            }
        })
    }
}

/// MD34300, or its default where it is 0: the plant has zero marks also then.
fn spacing(md: &Axis) -> [Position; 2] {
    if is_spindle(md) {
        // One zero mark in each revolution.
        return [Position::from_user(360.0); 2];
    }
    let default = Axis::default().enc_refp_marker_dist;
    [0, 1]
        .map(|encoder| Position::from_user(md.enc_refp_marker_dist[encoder]))
        .map(|spacing| if spacing > Position::ZERO { spacing } else { Position::from_user(default[0]) })
}

impl Configuration for Commissioning {
    fn axis_names(&self) -> Vec<&str> {
        MachineData::axis_numbers().map(|axis| self.archive.data.axis_name(axis)).collect()
    }

    /// As in an archive: names of axes and channels first, then the system of units, in which the files keep their lengths, then the types of
    /// axes, then everything else.
    fn store(&mut self, data: &[StoredDatum]) -> Result<(), Problem> {
        let order = |number| match number {
            10000 | 20000 => 0,
            10240 | 10250 => 1,
            30300 => 2,
            _ => 3,
        };
        for turn in 0..4 {
            let before = (turn == 1).then(|| self.archive.data.clone());
            for StoredDatum { target, place, value } in data {
                let found = self.archive.data.parse_target(target);
                match found {
                    Ok(found) if order(found.datum().number) == turn => {
                        self.archive.lay_over(found, value, place).map_err(|problem| problem.at(place))?;
                    }
                    // An axis may have its name only after another datum of this scenario.
                    Ok(_) => {}
                    Err(problem) if turn == 3 => return Err(problem.at(place)),
                    Err(_) => {}
                }
            }
            if let Some(before) = before {
                self.archive.data.change_system(&before);
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
        let is_828d = profile == Profile::SINUMERIK_828D;
        let control = Nck::new(data.clone(), presence, self.archive.out_of_range.clone(), strobe, is_828d);
        let names = Names {
            axes: PerAxis::from_fn(|axis| presence[axis].exists.then(|| data.axis_name(axis).to_owned())),
            channels: PerChannel::from_fn(|channel| Some(data.channels[channel].chan_name.clone())),
            aliases: Vec::new(),
            profile,
        };
        names.check()?;
        let groupings = control.parameters().groupings.groupings.iter();
        let groupings = groupings.map(|grouping| (grouping.number, grouping.coupling.members().collect())).collect();
        let findings = findings(&self.archive, &control, &names, site);
        Ok(Opened { axes: self.hints(&control), control: Box::new(control), names, groupings, findings })
    }
}

/// The contents of the files of an archive, whether or not they define a usable machine.
///
/// # Errors
/// A file cannot be read.
pub fn examine(path: &Path) -> Result<Examined, Problem> {
    let files = files_of(path)?;
    Ok(match Archive::load(&files) {
        Ok(archive) => Examined {
            is_empty: files.is_empty(),
            summary: archive.summary.to_string().lines().map(str::to_owned).collect(),
            ignored: archive.summary.ignored().map(str::to_owned).collect(),
            ..Examined::default()
        },
        Err(findings) => Examined { is_refused: true, findings, ..Examined::default() },
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
            spindle_is_gray: self.general.ovr_spind_is_gray_code,
        }
    }
}
