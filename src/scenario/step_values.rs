//! The tables of values in steps: machine data, PRESET, R parameters, bytes of the image.

use super::naming::{axis_named, place_named};
use super::steps::{Bits, Reader};
use crate::image::raw_value;
use crate::machine::{Command, DatumValue};
use crate::source::{Node, Problem};
use crate::variables::r_parameter;

impl Reader<'_> {
    pub(super) fn machine_data(&self, node: Node) -> Result<Box<[Command]>, Problem> {
        let mut table = node.into_table("machine data with their values")?;
        let entries = table.take_rest();
        let mut commands = Vec::with_capacity(entries.len());
        for (target, place, node) in entries {
            node.refuse_unquoted_key(&target)?;
            let value = DatumValue::from_node(&node)?;
            let command = Command::MachineDatum { target, value };
            self.judge(&command, &place)?;
            commands.push(command);
        }
        Ok(commands.into())
    }

    /// PRESET: axes with their new actual values.
    pub(super) fn presets(&self, node: Node) -> Result<Box<[Command]>, Problem> {
        let mut table = node.into_table("axes with their new actual values, as { X = 100.0 }")?;
        let mut commands = Vec::new();
        for (name, place, node) in table.take_rest() {
            let axis = axis_named(self.machine, &name).map_err(|problem| problem.at(&place))?;
            let command = Command::Preset { axis, value: node.number("a number in mm or degrees")? };
            self.judge(&command, &place)?;
            commands.push(command);
        }
        Ok(commands.into())
    }

    /// Writes to R parameters: `R5` of the first channel, `R5[CHAN2]` of channel 2.
    pub(super) fn r_parameters(&self, node: Node) -> Result<Box<[Command]>, Problem> {
        let mut table = node.into_table("R parameters with their values")?;
        let entries = table.take_rest();
        let mut commands = Vec::with_capacity(entries.len());
        for (name, place, node) in entries {
            let found = r_parameter(&name, self.machine.names()).map_err(|problem| problem.at(&place))?;
            let Some((channel, number)) = found else {
                return Err(place.problem(
                    format!("expected an R parameter, found {name:?}"),
                    "write \"R5\" for the first channel, \"R5[CHAN2]\" for channel 2",
                ));
            };
            let Ok(number) = u16::try_from(number) else {
                let count = self.machine.variables().r_parameters.count(channel);
                return Err(place.problem(
                    format!("expected R0 to R{}, found {name}", count.saturating_sub(1)),
                    "MD28050 is the number of R parameters of a channel",
                ));
            };
            let command = Command::RParameter { channel, number, value: node.number("a number")? };
            self.judge(&command, &place)?;
            commands.push(command);
        }
        Ok(commands.into())
    }

    pub(super) fn image(&self, node: Node) -> Result<Box<[Bits]>, Problem> {
        let mut table = node.into_table("addresses with their bits, as { \"DB31.DBB101\" = \"2#1100_0000\" }")?;
        let entries = table.take_rest();
        let mut expected = Vec::with_capacity(entries.len());
        for (name, place, node) in entries {
            node.refuse_unquoted_key(&name)?;
            let location = place_named(self.machine, &name).map_err(|problem| problem.at(&place))?;
            let bits = raw_value(&node, location, self.machine.override_coding())?;
            expected.push((node.place, location, bits));
        }
        Ok(expected.into())
    }
}
