//! Opening a control: from what the files of a machine say of it to a control that has just been switched on.

use std::path::Path;

use super::Control;
use crate::image::{Names, Profile};
use crate::source::{Problem, Table};
use crate::units::{AxisNumber, PerAxis, Position};

/// Reads the files of a machine: what they say of its control, and its `plant.toml`.
///
/// # Errors
/// Anything in the files that cannot be used, with file and line.
pub type Read = fn(&Path) -> Result<(Box<dyn Configuration>, Table), Problem>;

/// What the files of a machine say of its control, read and checked for themselves.
pub trait Configuration {
    /// The names of all axes that the control could have, in the order of their numbers.
    fn axis_names(&self) -> Vec<&str>;

    /// A control that has just been switched on. `profile` is [`Profile::default`] where nothing was asked for: then the first
    /// numbering of the control's own interface acts.
    ///
    /// # Errors
    /// Names of axes or channels that clash, or a profile of another control.
    fn open(&self, site: &Site<'_>, profile: Profile) -> Result<Opened, Problem>;
}

/// The kind of an encoder that a plant asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncoderModel {
    /// Equal zero marks.
    Incremental,
    /// It knows its position always.
    Absolute,
    /// The distances of its zero marks give the position.
    DistanceCoded,
}

/// What the plant says that a control has to know.
pub struct Site<'a> {
    /// Whether the plant names this axis.
    pub names_axis: &'a dyn Fn(&str) -> bool,
    /// The kinds of encoder 1 and 2 of an axis, where the plant says one.
    pub encoders: &'a dyn Fn(&str) -> [Option<EncoderModel>; 2],
    /// Whether the strobe of the machine function REF belongs to the HMI (E-01); `None` where nothing is said.
    pub strobe_is_the_hmi_s: Option<bool>,
}

/// A control that was opened, and what the rest of the machine needs of its files.
#[derive(Debug)]
pub struct Opened {
    /// The control.
    pub control: Box<dyn Control>,
    /// The names of its axes and channels.
    pub names: Names,
    /// What its data say of the mechanics.
    pub axes: PerAxis<AxisHints>,
    /// Its gantry groupings: number and axes, the leading axis first.
    pub groupings: Vec<(u8, Vec<AxisNumber>)>,
    /// What its files ask for and this version does not do, or what is odd in them.
    pub warnings: Vec<String>,
}

/// What the data of a control say of the mechanics of an axis, where the plant says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisHints {
    /// Whether there is such an axis.
    pub exists: bool,
    /// In which direction its reference cam lies, as a sign; 0 without a cam.
    pub cam_direction: i8,
    /// From one zero mark to the next, of encoder 1 and 2.
    pub zero_mark_spacing: [Position; 2],
}

/// What is in the files of a machine.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Examined {
    /// No machine can be made of them; `findings` say why.
    pub is_refused: bool,
    /// There are no files of machine data at all.
    pub is_empty: bool,
    /// What was read, in lines for people.
    pub summary: Vec<String>,
    /// What is wrong or odd, each with its place.
    pub findings: Vec<String>,
}
