//! What the controller start makes of the lists: the axes and channels with the values in effect, in the integer units of the lists.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::control::Value;

use super::message::Message;
use super::name::key;
use super::parameter::{Key, Scope};

/// The type of an axis (P-AXIS-00018).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisKind {
    /// Linear: 0.1 µm, 1 µm/s, mm/s².
    Linear,
    /// Rotary: 0.0001°, 0.001°/s, °/s².
    Rotary,
    /// Spindle, with the units of a rotary axis. It has no gantry parameters (HG-26).
    Spindle,
}

/// What clears a gantry difference (P-AXIS-00704).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OnMode {
    /// RESET, and gantry_on while it is set. With P-AXIS-00261, like [`OnMode::EdgeTriggered`].
    Default,
    /// gantry_on while it is set, with the enables set and the drive ready.
    OnlyControlUnit,
    /// The rising edge of gantry_on.
    EdgeTriggered,
    /// Nothing.
    Config,
}

/// How an axis is homed (P-AXIS-00299).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Homing {
    /// By the CNC.
    CncControlled,
    /// By the drive.
    DriveControlled,
    /// Not at all.
    Disabled,
    /// The absolute position of the encoder is ignored.
    IgnoreAbsolutePosition,
}

/// The limits of the gantry difference, and the velocity that clears it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Limits {
    /// P-AXIS-00072, resettable; 0.1 µm or 0.0001°.
    pub first: u32,
    /// P-AXIS-00071, locked; 0.1 µm or 0.0001°.
    pub second: u32,
    /// P-AXIS-00075; µm/s or 0.001°/s.
    pub correction_velocity: u32,
}

/// An axis with the values in effect. Positions are in 0.1 µm or 0.0001°, velocities in µm/s or 0.001°/s, accelerations in mm/s² or °/s².
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Logical number (P-AXIS-00016).
    pub number: u16,
    /// Default name (P-AXIS-00297).
    pub name: String,
    /// The default name is written in the list, correct, and no axis with a smaller number has it: it can name the axis.
    pub has_own_name: bool,
    /// Its type.
    pub kind: AxisKind,
    /// Modulo axis: bit 0x4 of P-AXIS-00015, of a linear axis bit 0x400; each spindle.
    pub is_modulo: bool,
    /// Lower and upper modulo limit (P-AXIS-00127, P-AXIS-00126), the upper one larger if the axis is a modulo axis.
    pub modulo_range: [i32; 2],
    /// Gantry master: bit 0x10000 of P-AXIS-00015.
    pub is_master: bool,
    /// Gantry slave: bit 0x20000 of P-AXIS-00015. It belongs to no channel.
    pub is_slave: bool,
    /// The master to which a slave is coupled; `None` without a valid one: the axis is a slave, but not coupled.
    pub master: Option<u16>,
    /// Limits and velocity of the difference, corrected for slaves. For other axes, [`Lists::gantry_pair`] corrects them.
    ///
    /// [`Lists::gantry_pair`]: super::Lists::gantry_pair
    pub limits: Limits,
    /// Slave minus master (P-AXIS-00073).
    pub offset: i32,
    /// P-AXIS-00074; false for a spindle.
    pub slave_no_homing: bool,
    /// P-AXIS-00249.
    pub check_without_homing: bool,
    /// P-AXIS-00253.
    pub synchronous_homing: bool,
    /// P-AXIS-00254.
    pub cnc_controlled_stop: bool,
    /// P-AXIS-00704.
    pub on_mode: OnMode,
    /// P-AXIS-00261.
    pub on_edge: bool,
    /// P-AXIS-00008.
    pub a_max: u32,
    /// P-AXIS-00003; P-AXIS-00008 if the list has 0.
    pub a_emergency: u32,
    /// Acceleration of G00, step 1 and 2 (P-AXIS-00005, P-AXIS-00006).
    pub a_step: [u32; 2],
    /// Acceleration of homing (P-AXIS-00285); without an entry the smaller one of `a_step`.
    pub a_ref: u32,
    /// P-AXIS-00212.
    pub vb_max: u32,
    /// Homing, to the cam (P-AXIS-00219).
    pub vb_ref_fast: u32,
    /// Homing, off the cam and onto it again (P-AXIS-00218).
    pub vb_ref_slow: u32,
    /// P-AXIS-00152.
    pub reference_position: i32,
    /// The cam is searched in positive direction (P-AXIS-00158).
    pub is_reference_direction_positive: bool,
    /// P-AXIS-00156.
    pub has_no_cam: bool,
    /// P-AXIS-00157.
    pub has_no_reversal: bool,
    /// P-AXIS-00084.
    pub has_no_zero_pulse: bool,
    /// P-AXIS-00299.
    pub homing: Homing,
    /// The list, or that of the master, gives P-AXIS-00299. Without it, the default of a SERCOS drive is [`Homing::DriveControlled`].
    pub is_homing_given: bool,
    /// P-AXIS-00284, without a sign; 0 = off.
    pub max_homing_distance: u32,
    /// P-AXIS-00367.
    pub watchdog_delay: u32,
    /// P-AXIS-00486.
    pub copies_master_coupling: bool,
    /// All values in effect.
    pub(super) values: BTreeMap<Key, Value>,
}

impl Axis {
    /// The value in effect of a parameter, in the unit of the list, by ID or list name; `None` if there is no such parameter or value.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&Value> {
        self.values.get(&key(Scope::Axis, name)?)
    }

    /// All values in effect, in the units of the list.
    pub fn values(&self) -> impl Iterator<Item = (&Key, &Value)> {
        self.values.iter()
    }

    /// Whether only the rising edge of gantry_on clears a difference (HG-21).
    #[must_use]
    pub const fn clears_on_edge(&self) -> bool {
        match self.on_mode {
            OnMode::Default => self.on_edge,
            OnMode::EdgeTriggered => true,
            OnMode::OnlyControlUnit | OnMode::Config => false,
        }
    }
}

/// An axis of a channel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChannelAxis {
    /// Its index in the channel, from 0.
    pub index: u16,
    /// Its name in programs of the channel (P-CHAN-00006).
    pub name: String,
    /// Its logical number (P-CHAN-00035).
    pub number: u16,
}

/// A pair of coupling group 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pair {
    /// Its index in the list, from 0.
    pub index: u16,
    /// Logical number of the master (P-CHAN-00037).
    pub master: u16,
    /// Logical number of the slave (P-CHAN-00038).
    pub slave: u16,
    /// A pair of spindles, not of path axes (P-CHAN-00061).
    pub is_spindles: bool,
}

/// A channel with the values in effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Its number, from 1.
    pub number: u16,
    /// Its list.
    pub file: String,
    /// Its axes, ascending by index. Gantry slaves are left out.
    pub axes: Vec<ChannelAxis>,
    /// Coupling group 0, without the pairs that the start-up checks skip.
    pub group_0: Vec<Pair>,
    /// P-CHAN-00104.
    pub restore_after_reset: bool,
    /// P-CHAN-00105.
    pub preserve_after_program_end: bool,
    /// P-CHAN-00460.
    pub retain_last_configuration: bool,
    /// P-CHAN-00346.
    pub always_shortest_way: bool,
    /// P-CHAN-00108: 0.1 = F in m/min, 100 = mm/min.
    pub is_feed_in_m_per_minute: bool,
    /// P-CHAN-00099; 0 = none.
    pub default_feed: f64,
    /// P-CHAN-00253: default axis names are A1 to A32.
    pub has_alias_names: bool,
    /// All values in effect.
    pub(super) values: BTreeMap<Key, Value>,
}

impl Channel {
    /// The value in effect of a parameter by ID or list name; `None` if there is no such parameter or value.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&Value> {
        self.values.get(&key(Scope::Channel, name)?)
    }

    /// All values in effect, in the units of the list.
    pub fn values(&self) -> impl Iterator<Item = (&Key, &Value)> {
        self.values.iter()
    }
}

/// The result of the start-up checks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Started {
    /// The axes, ascending by logical number.
    pub axes: Vec<Axis>,
    /// The channels, in the order of their numbers.
    pub channels: Vec<Channel>,
    /// The messages of the control, in the order of the checks.
    pub messages: Vec<Message>,
}

impl Started {
    /// The axis with a logical number.
    #[must_use]
    pub fn axis(&self, number: u16) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.number == number)
    }

    /// The slaves that are coupled to a master, ascending.
    pub fn slaves(&self, master: u16) -> impl Iterator<Item = &Axis> {
        self.axes.iter().filter(move |axis| axis.master == Some(master))
    }

    /// The names of an axis besides `ax<logical number>`: those in channels, or else its own default name.
    #[must_use]
    pub fn names(&self, axis: &Axis) -> Vec<&str> {
        let in_channels = self.channels.iter().flat_map(|channel| &channel.axes);
        let names: Vec<&str> = in_channels.filter(|of| of.number == axis.number).map(|of| of.name.as_str()).collect();
        if !names.is_empty() || !axis.has_own_name {
            return names;
        }
        self.axes.iter().filter(|of| of.number == axis.number).map(|of| of.name.as_str()).collect()
    }

    /// The logical number of the axis with this name: `ax5`, its name in a channel, or else its own default name.
    #[must_use]
    pub fn axis_named(&self, name: &str) -> Option<u16> {
        let number = name.strip_prefix("ax").and_then(|number| number.parse().ok());
        let by_number = self.axes.iter().find(|axis| Some(axis.number) == number);
        by_number.or_else(|| self.axes.iter().find(|axis| self.names(axis).contains(&name))).map(|axis| axis.number)
    }
}
