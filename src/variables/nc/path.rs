//! The paths of NC variables as OPC UA clients of a SINUMERIK write them: `/Channel/MachineAxis/actToolBasePos[u1,3]`. In a path, the modules
//! SMA and SEMA are `MachineAxis`, SGA and SEGA `GeometricAxis`.

use super::variable::module;
use super::{CATALOGUE, NckArea, Variable};

/// What a path stands for.
#[derive(Clone, Copy, Debug)]
pub enum Named {
    /// A row of the catalogue. The index is the row.
    Variable(&'static Variable),
    /// R parameters. The index is the number: `R[u1,5]` is R5, `R[0]` is R0.
    RParameter(&'static Variable),
    /// A variable that controls have and this simulator has not.
    Absent,
}

/// Names of clients for rows that have another name in the catalogue.
const ALIASES: &[(&str, &str)] = &[
    ("/Bag/State/OpMode", "/Bag/State/opMode"),
    ("/Channel/Parameter/R", "/Channel/Parameter/rpa"),
    ("/Channel/ProgramModification/singleBlockActive", "/Channel/ProgramModification/singleBlock"),
    ("/Channel/ProgramModification/progTestActive", "/Channel/ProgramModification/progTest"),
];

/// Variables that clients were seen to ask for, and that a control has.
#[rustfmt::skip]
const ABSENT: &[&str] = &[
    "/Channel/State/acProg", "/Channel/State/progEvent", "/Channel/ChannelDiagnose/setupTime", "/Channel/Spindle/driveLoad",
    "/Channel/GeometricAxis/actProgPos", "/Channel/GeometricAxis/actToolBasPosBN", "/Channel/GeometricAxis/name",
    "/Channel/MachineAxis/actToolBasPosBN", "/Nck/Configuration/accessLevel", "/Nck/Configuration/anLanguageOnHmi",
    "/Nck/Configuration/nckVersion", "/Nck/MachineAxis/aaIm", "/Nck/MachineAxis/aaTorque", "/Nck/MachineAxis/cmdFeedRate",
    "/Nck/MachineAxis/cmdSpeedRel", "/Nck/MachineAxis/refPtStatus", "/Nck/MachineAxis/vaCurr", "/Nck/MachineAxis/vaPower",
];

/// What a path without its index stands for; `None` if no control has such a variable. Upper and lower case differ.
#[must_use]
pub fn by_path(path: &str) -> Option<Named> {
    if ABSENT.contains(&path) {
        return Some(Named::Absent);
    }
    let path = ALIASES.iter().find(|(alias, _)| *alias == path).map_or(path, |(_, known)| known);
    // The NCK has the axes of all channels; here these are the same axes.
    let of_axes = path.strip_prefix("/Nck/MachineAxis/").map(|name| format!("/Channel/MachineAxis/{name}"));
    let path = of_axes.as_deref().unwrap_or(path);
    let variable = CATALOGUE.iter().find(|variable| variable.is_at(path))?;
    Some(if variable.module == module::RP { Named::RParameter(variable) } else { Named::Variable(variable) })
}

/// The folder of a module in paths; `None` if its variables have other ids.
const fn folder(of: u8) -> Option<&'static str> {
    Some(match of {
        module::SMA | module::SEMA => "MachineAxis",
        module::SGA | module::SEGA => "GeometricAxis",
        module::SSP => "Spindle",
        module::Y => "Configuration",
        module::FU => "UserFrame",
        module::S => "State",
        module::DIAGN => "ChannelDiagnose",
        module::RP => "Parameter",
        module::SPARP => "ProgramInfo",
        module::SPARPP => "ProgramPointer",
        module::SINF => "ProgramModification",
        module::SALA => "SequencedAlarms",
        module::SALAC => "AlarmEvent",
        module::SALAL => "LastAlarm",
        module::SALAP => "TopPrioAlarm",
        _ => return None,
    })
}

impl Variable {
    /// Its path in three parts: area, folder, name. `None` for a variable without a name of Siemens, and for machine and drive data.
    #[must_use]
    pub fn path(&self) -> Option<[&'static str; 3]> {
        let area = match self.area {
            NckArea::Nck => "Nck",
            NckArea::ModeGroup => "Bag",
            NckArea::Channel => "Channel",
            NckArea::Axis | NckArea::FeedDrive => return None,
        };
        let name = self.name.rsplit('/').next().filter(|name| !name.contains(' '))?;
        Some([area, folder(self.module)?, name])
    }

    fn is_at(&self, path: &str) -> bool {
        let mut parts = path.split('/').skip(1);
        let is_same = |part: &str| parts.next() == Some(part);
        self.path().is_some_and(|own| path.starts_with('/') && own.into_iter().all(is_same)) && parts.next().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(path: &str) -> String {
        match by_path(path) {
            Some(Named::Variable(variable)) => variable.name.to_owned(),
            Some(Named::RParameter(variable)) => format!("R {}", variable.name),
            Some(Named::Absent) => "absent".to_owned(),
            None => "unknown".to_owned(),
        }
    }

    #[test]
    fn paths_are_those_that_clients_write() {
        for (path, name) in [
            ("/Channel/MachineAxis/actToolBasePos", "C/MachineAxis/actToolBasePos"),
            ("/Channel/MachineAxis/measPos1", "C/MachineAxisExt/measPos1"),
            ("/Nck/MachineAxis/actFeedRate", "C/MachineAxisExt/actFeedRate"),
            ("/Channel/GeometricAxis/actFeedRate", "C/GeometricAxisExt/actFeedRate"),
            ("/Channel/State/chanStatus", "C/State/chanStatus"),
            ("/Bag/State/opMode", "B/State/opMode"),
            ("/Bag/State/OpMode", "B/State/opMode"),
            ("/Nck/State/numAlarms", "N/State/numAlarms"),
            ("/Nck/Configuration/maxnumAlarms", "N/Y/maxnumAlarms"),
            ("/Nck/SequencedAlarms/alarmNo", "N/AlarmList/alarmNo"),
            ("/Nck/TopPrioAlarm/alarmNo", "N/TopPrioAlarm/alarmNo"),
            ("/Channel/ChannelDiagnose/cuttingTime", "C/DIAGN/cuttingTime"),
            ("/Channel/ProgramInfo/progName", "C/ProgramInfo/progName"),
            ("/Channel/ProgramModification/singleBlockActive", "C/ProgramModification/singleBlock"),
            ("/Channel/Parameter/R", "R C/Parameter/rpa"),
            ("/Channel/Parameter/rpa", "R C/Parameter/rpa"),
            ("/Nck/MachineAxis/vaPower", "absent"),
            ("/channel/State/chanStatus", "unknown"),
            ("/Channel/State/chanStatus/", "unknown"),
            ("Channel/State/chanStatus", "unknown"),
            ("/Channel/GeometricAxis/position shown", "unknown"),
            ("", "unknown"),
        ] {
            assert_eq!(found(path), name, "{path}");
        }
    }

    #[test]
    fn each_path_belongs_to_one_row() {
        let paths: Vec<_> = CATALOGUE.iter().filter_map(Variable::path).collect();
        assert!(paths.len() > 60);
        for path in &paths {
            assert_eq!(paths.iter().filter(|other| *other == path).count(), 1, "{path:?}");
        }
    }
}
