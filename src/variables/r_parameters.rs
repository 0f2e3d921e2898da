//! R parameters: numbers of a channel that programs, operators and clients share. A control retains them without power.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::units::{ChannelNumber, PerChannel};

/// The R parameters of all channels. A copy shares the values of each channel until one of them changes, so that a control can publish them
/// in every cycle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RParameters {
    channels: PerChannel<Arc<Vec<f64>>>,
}

impl RParameters {
    /// R parameters of 0, as many as `count` says for each channel.
    #[must_use]
    pub fn new(count: impl Fn(ChannelNumber) -> u32) -> Self {
        let none = Arc::default();
        let zeros = |channel| match usize::try_from(count(channel)).unwrap_or(0) {
            0 => Arc::clone(&none),
            count => Arc::new(vec![0.0; count]),
        };
        Self { channels: PerChannel::from_fn(zeros) }
    }

    /// The number of R parameters of a channel.
    #[must_use]
    pub fn count(&self, channel: ChannelNumber) -> usize {
        self.channels[channel].len()
    }

    /// Takes over the values of those that exist here, too.
    pub fn keep(&mut self, before: &Self) {
        for (channel, values) in self.channels.iter_mut() {
            let old = &before.channels[channel];
            if values.len() == old.len() {
                *values = Arc::clone(old);
                continue;
            }
            for (value, old) in Arc::make_mut(values).iter_mut().zip(old.iter()) {
                *value = *old;
            }
        }
    }

    /// Takes over all values; those of a channel that has not changed cost nothing.
    pub fn take_over(&mut self, other: &Self) {
        for (channel, values) in self.channels.iter_mut() {
            let others = &other.channels[channel];
            if !Arc::ptr_eq(values, others) {
                *values = Arc::clone(others);
            }
        }
    }

    /// The value of the R parameter with this number.
    #[must_use]
    pub fn get(&self, channel: ChannelNumber, number: u16) -> Option<f64> {
        self.channels[channel].get(usize::from(number)).copied()
    }

    /// Writes a value. Returns `false` if the parameter does not exist.
    pub fn set(&mut self, channel: ChannelNumber, number: u16, value: f64) -> bool {
        let values = &mut self.channels[channel];
        let Some(old) = values.get(usize::from(number)) else { return false };
        // A value that stays the same needs no copy.
        if old.to_bits() != value.to_bits()
            && let Some(parameter) = Arc::make_mut(values).get_mut(usize::from(number))
        {
            *parameter = value;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_shares_its_values_until_one_of_them_changes() {
        let (one, two) = (ChannelNumber::FIRST, ChannelNumber::new(2).unwrap());
        let mut own = RParameters::new(|_| 100);
        let mut published = own.clone();
        assert!(own.set(one, 5, 0.5));
        assert_eq!((own.get(one, 5), published.get(one, 5)), (Some(0.5), Some(0.0)));
        assert!(!own.set(one, 100, 1.0));
        published.take_over(&own);
        assert!(Arc::ptr_eq(&own.channels[one], &published.channels[one]));
        assert!(Arc::ptr_eq(&own.channels[two], &published.channels[two]));
        assert!(own.set(one, 5, 0.5));
        assert!(Arc::ptr_eq(&own.channels[one], &published.channels[one]), "the same value");
    }
}
