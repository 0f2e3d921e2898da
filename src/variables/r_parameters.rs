//! R parameters: numbers of a channel that programs, operators and clients share. This simulator runs no NC program, so they keep the last
//! written value. A control retains them without power.

use serde::{Deserialize, Serialize};

use crate::units::{ChannelNumber, PerChannel};

/// The R parameters of all channels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RParameters {
    channels: PerChannel<Vec<f64>>,
}

impl RParameters {
    /// The number of R parameters per channel: R0 to R99, the default of MD28050.
    pub const COUNT: u16 = 100;

    /// The value of the R parameter with this number.
    #[must_use]
    pub fn get(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.channels[channel].get(usize::from(number)).copied()
    }

    /// Writes a value. Returns `false` if the parameter does not exist.
    pub fn set(&mut self, channel: ChannelNumber, number: u16, value: f64) -> bool {
        let parameter = self.channels[channel].get_mut(usize::from(number));
        parameter.map(|parameter| *parameter = value).is_some()
    }
}

impl Default for RParameters {
    fn default() -> Self {
        Self { channels: PerChannel::from_fn(|_| vec![0.0; usize::from(Self::COUNT)]) }
    }
}
