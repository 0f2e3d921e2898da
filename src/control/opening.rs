//! Opens a control: from the files of a machine to a control after power on.

use std::path::Path;

use super::{Control, Finding, Value};
use crate::image::{Names, Profile};
use crate::source::{Place, Problem, Table};
use crate::units::{AxisNumber, PerAxis, Position};

/// Reads the files of a machine: the configuration of its control, and its `plant.toml`.
///
/// # Errors
/// A file contains something unusable; the error gives file and line.
pub type Read = fn(&Path) -> Result<(Box<dyn Configuration>, Table), Problem>;

/// The configuration of a control from the files of a machine, read and checked on its own.
pub trait Configuration {
    /// The names of all possible axes of the control, in the order of their numbers. These are the names that `plant.toml` may use: a table
    /// `[X]` with any other name is an error.
    fn axis_names(&self) -> Vec<&str>;

    /// Stores data over those of the files, before the control is opened; later ones replace earlier ones.
    ///
    /// # Errors
    /// A datum does not exist, or a value does not fit it; the problem names its place.
    fn store(&mut self, data: &[StoredDatum]) -> Result<(), Problem> {
        match data.first() {
            Some(datum) => Err(datum.place.problem(
                format!("expected a datum of this control, found `{}`", datum.target),
                "remove it: this control has no data that a scenario can store",
            )),
            None => Ok(()),
        }
    }

    /// Which of the files are not used and why, and what to do, for the error about an axis that does not exist. The default is none.
    fn not_used(&self) -> Option<(String, String)> {
        None
    }

    /// The largest number of a gantry grouping that `plant.toml` may use in `[bridge.1]`. The default is 0: the control has no groupings.
    fn groupings(&self) -> u8 {
        0
    }

    /// A control after power on. It takes its own keys of `plant.toml` from `settings`; a key that is left is an error. `profile` is
    /// [`Profile::default`] if none was requested: then the first numbering of the control's own interface is used.
    ///
    /// # Errors
    /// Names of axes or channels clash, a setting is wrong, or the profile belongs to another control.
    fn open(&self, site: &Site<'_>, settings: &mut Settings, profile: Profile) -> Result<Opened, Problem>;
}

/// The tables of `plant.toml` with keys of a control. It takes the keys that it knows.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// `[machine]`, without the keys of the machine itself.
    pub machine: Table,
    /// `[compatibility]`.
    pub compatibility: Table,
    /// `[control]`.
    pub control: Table,
}

/// A datum that a scenario stores before the first power on.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredDatum {
    /// `34090[XF]`, `34100[2,XF]`, `11300`, an identifier.
    pub target: String,
    /// Its place in the scenario.
    pub place: Place,
    /// Its value.
    pub value: Value,
}

/// The type of an encoder in the plant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EncoderModel {
    /// Incremental, with equidistant zero marks.
    #[default]
    Incremental,
    /// Absolute: its position is always known.
    Absolute,
    /// Distance-coded: the distances of its zero marks give the position.
    DistanceCoded,
}

/// The plant data that a control needs.
pub struct Site<'a> {
    /// Whether the plant names this axis.
    pub names_axis: &'a dyn Fn(&str) -> bool,
    /// The types of encoder 1 and 2 of an axis, if the plant defines them.
    pub encoders: &'a dyn Fn(&str) -> [Option<EncoderModel>; 2],
    /// Whether the drive of an axis reacts and homes by itself.
    pub intelligent: &'a dyn Fn(&str) -> bool,
    /// The place where the plant gives an axis a reference cam, if it does.
    pub cam: &'a dyn Fn(&str) -> Option<Place>,
}

/// An opened control, and the data of its files that the rest of the machine needs.
#[derive(Debug)]
pub struct Opened {
    /// The control.
    pub control: Box<dyn Control>,
    /// The names of its axes and channels.
    pub names: Names,
    /// The mechanical data from its machine data.
    pub axes: PerAxis<AxisHints>,
    /// Its gantry groupings: number and axes, the leading axis first.
    pub groupings: Vec<(u8, Vec<AxisNumber>)>,
    /// Findings about its files, the heaviest first.
    pub findings: Vec<Finding>,
}

/// The mechanical data of an axis from the data of a control, used where the plant defines none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisHints {
    /// Whether the axis exists.
    pub exists: bool,
    /// The direction of its reference cam, as a sign; 0 without a cam.
    pub cam_direction: i8,
    /// A reference cam that the plant does not define lies at a fixed place, between two zero marks; otherwise 100 mm from the start.
    pub cam_is_fixed: bool,
    /// Distance between two zero marks, of encoder 1 and 2.
    pub zero_mark_spacing: [Position; 2],
    /// The types of both encoders, for those without a type in the plant.
    pub encoders: [EncoderModel; 2],
    /// The code of distance-coded marks: by how much the mark between two fixed ones moves on, and whether the scale counts against the axis.
    pub zero_mark_code: [(Position, bool); 2],
}

/// The contents of the files of a machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Examined {
    /// The files do not define a usable machine; `findings` gives the reasons.
    pub is_refused: bool,
    /// There are no machine data files.
    pub is_empty: bool,
    /// A summary of what was read, as lines of text.
    pub summary: Vec<String>,
    /// The names of its members without machine data, which are ignored.
    pub ignored: Vec<String>,
    /// The reasons of a refusal.
    pub findings: Vec<Finding>,
}
