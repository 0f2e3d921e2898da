//! The variables of the NCK as clients of a SINUMERIK read them: by area, unit, module, column and line, or by a path. S7 communication and
//! OPC UA read the same table.
//!
//! [`CATALOGUE`] has the variables by name, [`MachineData`] provides the machine data of module `1A`, and R parameters are module `15`.
//! Rows count from one; `R5` is row 6. Displayed values of the control cannot be written.

mod alarms;
mod catalogue;
mod data;
mod drives;
mod path;
mod values;
mod variable;
mod view;

pub use catalogue::CATALOGUE;
pub use data::{ControlValues, Datum, MachineData, Refused};
pub use drives::motor_speed;
pub use path::{Named, by_path};
pub use values::r_parameter;
pub use variable::{Kind, NckArea, Shown, Variable, module};
pub use view::{ClockTime, View};

use crate::image::{Layout, Sinumerik};
use crate::variables::Place;

/// Whether the machine has these variables: they are those of a SINUMERIK.
#[must_use]
pub fn is_sinumerik(view: &View<'_>) -> bool {
    Sinumerik::is_of(view.names.interface())
}

/// The row of the catalogue with this address. Another control has none of them.
#[must_use]
pub fn find(view: &View<'_>, area: u8, module: u8, column: u16) -> Option<&'static Variable> {
    if !is_sinumerik(view) {
        return None;
    }
    // The NCK has the axes of all channels; here these are the same axes.
    let area = match (area, module) {
        (0, module::SMA | module::SEMA) => NckArea::Channel.code(),
        (area, _) => area,
    };
    let is_it =
        |variable: &&Variable| variable.area.code() == area && variable.module == module && variable.column == column;
    CATALOGUE.iter().find(is_it)
}

/// The owner of machine data, by its area and its unit.
///
/// # Errors
/// The area has no machine data, or the channel or the axis does not exist.
pub fn owner(view: &View<'_>, area: u8, unit: u8) -> Result<Place, Refused> {
    let place = match area {
        0 => Some(Place::Nck),
        2 => values::channel_number(view, unit).map(Place::Channel),
        3 => values::axis_number(view, unit.into()).map(Place::Axis),
        _ => return Err(Refused::DoesNotExist),
    };
    place.ok_or(Refused::OutOfRange)
}

/// A machine datum, by its number and its line, which counts from one.
///
/// # Errors
/// There is no such datum, or it has no such line.
pub fn datum<'a>(view: &View<'a>, place: Place, number: u16, line: u16) -> Result<Datum<'a>, Refused> {
    let machine_data = view.machine_data.ok_or(Refused::DoesNotExist)?;
    let index = line.checked_sub(1).ok_or(Refused::OutOfRange)?;
    match machine_data.datum(place, number, index) {
        Some(datum) => Ok(datum),
        None if machine_data.datum(place, number, 0).is_some() => Err(Refused::OutOfRange),
        None => Err(Refused::DoesNotExist),
    }
}
