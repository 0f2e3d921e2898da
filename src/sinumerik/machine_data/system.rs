//! The basic system of units (MD10240): metric or inch.
//!
//! The unit of a datum in the catalogue is that of the metric system. On an inch machine every length of a linear axis is in inches:
//! inch, inch/min, inch/s², inch/s³ (FB1 G2). The model calculates in millimetres and works with a copy of the data in metric units. A
//! default is a length of the machine: it keeps its length, and has another number in the other system.
//!
//! When MD10240 is entered at the control and power on makes it active, all lengths keep their length as well: a control stores them in
//! millimetres. `METRIC` and `INCH` in a file say in which system its lengths are, whatever MD10240 says.

use std::borrow::Cow;

use super::scaling::{System, convert, metric_units};
use super::{MachineData, Target, by_number};
use crate::control::{Owner, Value};
use crate::units::{AxisNumber, Position};

impl MachineData {
    /// MD10240: the system of these data.
    pub(super) fn system(&self) -> System {
        if self.general.scaling_system_is_metric { System::Metric } else { System::Inch }
    }

    /// MD10250: millimetres in one inch.
    pub(super) fn millimetres(&self) -> f64 {
        let said = self.general.scaling_value_inch;
        if said > 0.0 { said } else { 25.4 }
    }

    /// A value of a file in a declared system, in the system of these data.
    pub(super) fn converted(&self, target: &Target, value: Value, declared: System) -> Value {
        let is_rotary = matches!(target.owner(), Owner::Axis(axis) if self.axes[axis].is_rot_ax);
        let factor = metric_units(target.datum(), is_rotary, self.millimetres());
        match (factor, value.number(), declared, self.system()) {
            (Some(factor), Some(number), System::Inch, System::Metric) => Value::Real(number * factor),
            (Some(factor), Some(number), System::Metric, System::Inch) => Value::Real(number / factor),
            (_, _, System::Inch | System::Metric, System::Inch | System::Metric) => value,
        }
    }

    /// Converts every length into another system; MD10240 itself does not change.
    pub(super) fn convert(&mut self, to: System) {
        let millimetres = self.millimetres();
        convert(&mut self.setting, false, millimetres, to);
        for (_, axis) in self.axes.iter_mut() {
            let is_rotary = axis.is_rot_ax;
            convert(axis, is_rotary, millimetres, to);
        }
        for (number, settings) in self.axis_settings.iter_mut() {
            convert(settings, self.axes[number].is_rot_ax, millimetres, to);
        }
        for (_, channel) in self.channels.iter_mut() {
            convert(channel, false, millimetres, to);
        }
        for (_, settings) in self.channel_settings.iter_mut() {
            convert(settings, false, millimetres, to);
        }
    }

    /// The value of a datum of these data in metric units.
    pub(in crate::sinumerik) fn metric(&self, number: u32, axis: Option<AxisNumber>, value: f64) -> f64 {
        let is_rotary = axis.is_some_and(|axis| self.axes[axis].is_rot_ax);
        let units = by_number(number).and_then(|datum| metric_units(datum, is_rotary, self.millimetres()));
        match self.system() {
            System::Inch => value * units.unwrap_or(1.0),
            System::Metric => value,
        }
    }

    /// A distance of an axis as the number of a datum in these data: millimetres or inches, or degrees of a rotary axis.
    pub(in crate::sinumerik) fn number_of(&self, axis: AxisNumber, distance: Position) -> f64 {
        match self.system() {
            System::Inch if !self.axes[axis].is_rot_ax => distance.user() / self.millimetres(),
            System::Inch | System::Metric => distance.user(),
        }
    }

    /// Makes MD10240 and all lengths those of another system.
    pub(in crate::sinumerik) fn change_system(&mut self, before: &Self) {
        if self.system() != before.system() {
            self.convert(self.system());
        }
    }

    /// Converts every length into the system of other data; MD10240 itself does not change.
    pub(in crate::sinumerik) fn convert_like(&mut self, other: &Self) {
        self.convert(other.system());
    }

    /// The data with which the model works: metric, and with the nearest permitted values in place of those at `out_of_range`.
    #[must_use]
    pub(in crate::sinumerik) fn acting(&self, out_of_range: &[Target]) -> Cow<'_, Self> {
        let mut data = Cow::Borrowed(self);
        if !out_of_range.is_empty() {
            data = Cow::Owned(self.within_range(out_of_range));
        }
        if self.system() == System::Inch {
            data.to_mut().convert(System::Metric);
        }
        data
    }
}
