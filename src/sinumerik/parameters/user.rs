//! The machine data for the PLC, as an 828D shows them in DB4500.

use crate::image::UserFromNck;
use crate::sinumerik::machine_data::MachineData;

/// MD14510, MD14512, MD14514 and MD14516; no reaction is active.
pub(super) fn user_data(data: &MachineData) -> UserFromNck {
    let general = &data.general;
    let integer = |index| i16::try_from(general.user_data_int.get(index)).unwrap_or_default();
    #[expect(clippy::cast_possible_truncation, reason = "the interface has REALs of four bytes")]
    let real = |index| general.user_data_float.get(index) as f32;
    UserFromNck {
        reactions: 0,
        integers: std::array::from_fn(|index| integer(index).to_be_bytes()),
        bytes: std::array::from_fn(|index| general.user_data_hex.get(index)),
        reals: std::array::from_fn(|index| real(index).to_be_bytes()),
        alarms: std::array::from_fn(|index| general.user_data_plc_alarm.get(index)),
    }
}
