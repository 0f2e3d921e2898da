//! What the NC offers a PLC program beside the bytes of the interface: NC variables, machine data, orders, and the list of messages.

use std::fmt::Debug;

use crate::units::ChannelNumber;

/// The address of an NC variable, as the NC variable selector writes it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NcVariable {
    /// 0 NCK, 1 mode group, 2 channel, 3 axis.
    pub area: u8,
    /// The number of the mode group, channel or axis, from 1.
    pub unit: u8,
    /// The column: for machine data their number.
    pub column: u16,
    /// The line, from 1.
    pub line: u16,
    /// The module: 15h R parameters, 1Ah machine data, 71h and 74h machine axes, 7Fh states.
    pub module: u8,
}

/// An order to the NC. It is carried out in this cycle, after the PLC program.
#[derive(Clone, Debug, PartialEq)]
pub enum NcOrder {
    /// Selects the program of a channel by its path.
    SelectProgram(ChannelNumber, String),
    /// Writes an NC variable.
    Write(NcVariable, f64),
    /// Makes stored machine data effective that wait for it.
    ActivateData,
}

/// The NC as a PLC program reaches it beside the interface.
pub trait NcServices: Debug {
    /// The value of an NC variable; `None` if it does not exist.
    fn read(&self, variable: NcVariable) -> Option<f64>;

    /// Takes an order; `false` if it is refused.
    fn order(&mut self, order: NcOrder) -> bool;

    /// Shows exactly these messages from now on, by their numbers in ascending order: 510000 to 799999.
    fn show(&mut self, messages: &[u32]);
}

/// No NC: no variable exists, and each order is refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoNc;

impl NcServices for NoNc {
    fn read(&self, _variable: NcVariable) -> Option<f64> {
        None
    }

    fn order(&mut self, _order: NcOrder) -> bool {
        false
    }

    fn show(&mut self, _messages: &[u32]) {}
}
