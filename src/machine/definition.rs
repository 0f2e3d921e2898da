//! What the files say of a machine.

use crate::image::{Location, Memory, Names, OverrideCoding, Part, SINUMERIK};
use crate::plant::{Db11Byte5Bit2, Layout, Switch};
use crate::sinumerik::Control;
use crate::sinumerik::machine_data::MachineData;
use crate::units::{AxisNumber, ModeGroupNumber, PerModeGroup, Time};

/// What the files say of a machine; it never changes after opening and is shared by all forks.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) names: Names,
    pub(super) layout: Layout,
    /// Bits of the PLC's part that stand for switches that are not wired.
    pub(super) unwired: Vec<(AxisNumber, Switch, Location)>,
    /// The memory after power on: presets.
    pub(super) memory: Memory,
    /// How often the PLC program runs; in every cycle where it is not said.
    pub(super) plc_cycle: Option<Time>,
    pub(super) strobe: Strobe,
    pub(super) warnings: Vec<String>,
}

/// Whose DB11.DBX5.2 is, and DBX25.2 of the second mode group (E-01).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Strobe {
    pub(super) fixed: Option<Db11Byte5Bit2>,
    /// Where DB11.DBB5 and DBB25 lie in the HMI's part.
    pub(super) bytes: PerModeGroup<u32>,
}

impl Strobe {
    /// The mode groups whose byte a write there makes the HMI's.
    pub(super) fn touched_by(&self, location: Location) -> impl Iterator<Item = ModeGroupNumber> {
        let of_the_hmi = location.part == Part::Hmi && self.fixed.is_none();
        let touched = move |byte: u32| location.offset <= byte && byte < location.offset + location.bytes();
        ModeGroupNumber::all().filter(move |group| of_the_hmi && touched(self.bytes[*group]))
    }

    /// `hmi_strobe` fixes it from the start.
    pub(super) fn apply(&self, control: &mut Control) {
        if self.fixed == Some(Db11Byte5Bit2::HmiStrobe) {
            for group in ModeGroupNumber::all() {
                control.strobe_written(group);
            }
        }
    }
}

pub(super) fn override_coding(data: &MachineData) -> OverrideCoding {
    OverrideCoding {
        interface: &SINUMERIK,
        axis_is_gray: data.general.ovr_ax_is_gray_code,
        feed_is_gray: data.general.ovr_feed_is_gray_code,
        rapid_traverse_is_gray: data.general.ovr_rapid_is_gray_code,
    }
}
