//! Values that the module sends without further requests: cyclically, or when they change.

use std::time::Duration;

use tokio::sync::{mpsc, oneshot};

use super::Client;
use super::error::Error;
use super::job::{LinkCommand, Subscribed};
use super::plan::{Capacity, Part, Plan, Purpose, plan};
use super::value::Value;
use super::variable::Variable;
use crate::s7::wire::replies::DataItems;

/// The number of updates that are buffered for the receiver; further ones are dropped.
const WAITING: usize = 64;

/// When values are sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// In each cycle.
    Cycle,
    /// When one of the values has changed.
    Change,
}

/// The updates of a subscription. After a reconnect it is renewed on the new connection.
#[derive(Debug)]
pub struct Subscription {
    variables: Vec<Variable>,
    /// Several groups if the values need several PDUs.
    groups: Vec<Vec<Part>>,
    updates: mpsc::Receiver<(usize, Result<Vec<u8>, Error>)>,
    /// Keeps the connection open.
    _client: Client,
}

/// Values that arrived together.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// The index of each subscribed variable, and its value.
    pub values: Vec<(usize, Result<Value, Error>)>,
}

impl Client {
    /// Subscribes to variables; the first update has their current values. There is one group of updates per PDU that
    /// is needed.
    ///
    /// The interval is a multiple of 0.1 s; from 25.6 s on of 1 s; from 256 s on of 10 s.
    ///
    /// # Errors
    /// A variable is too long for a PDU, or the module does not support subscriptions.
    pub async fn subscribe(
        &self,
        variables: &[Variable],
        mode: Mode,
        interval: Duration,
    ) -> Result<Subscription, Error> {
        variables.iter().try_for_each(Variable::check)?;
        let pdu = self.connected("subscription").await?.pdu;
        let parts = variables.iter().enumerate().flat_map(|(of, variable)| Part::all(of, variable, Purpose::Subscribe));
        let Plan { requests: groups, too_long } = plan(parts, Purpose::Subscribe, Capacity { pdu, items: 255 });
        if let Some(part) = too_long.first() {
            return Err(Error::Input {
                what: format!("expected a variable that fits into a PDU of {pdu} bytes, found {}", variables[part.of]),
                cure: "subscribe to parts of the variable".to_owned(),
            });
        }
        let (to, updates) = mpsc::channel(WAITING);
        let (base, factor) = interval_on_the_wire(interval);
        for (group, parts) in groups.iter().enumerate() {
            let [high, low] = u16::try_from(parts.len()).unwrap_or(0).to_be_bytes();
            let mut payload = vec![high, low, base, factor];
            parts.iter().for_each(|part| part.put_item(&mut payload));
            let (ready, answer) = oneshot::channel();
            let subscribed = Subscribed {
                function: match mode {
                    Mode::Cycle => 1,
                    Mode::Change => 5,
                },
                payload,
                pdu,
                group,
                to: to.clone(),
                ready: Some(ready),
                number: None,
                identifier: 0,
            };
            let _ = self.commands.send(LinkCommand::Subscribe(subscribed)).await;
            answer.await.unwrap_or_else(|_| Err(self.gone("subscription")))?;
        }
        Ok(Subscription { variables: variables.to_vec(), groups, updates, _client: self.clone() })
    }
}

/// Time base and factor; never less than the requested interval.
fn interval_on_the_wire(interval: Duration) -> (u8, u8) {
    let tenths = interval.as_millis().div_ceil(100).max(1);
    for (base, unit) in [(0, 1), (1, 10), (2, 100)] {
        if let Ok(factor) = u8::try_from(tenths.div_ceil(unit)) {
            return (base, factor);
        }
    }
    (2, u8::MAX)
}

impl Subscription {
    /// Waits for the next update; `None` when the connection has ended for good.
    ///
    /// # Errors
    /// The module refused the subscription on a new connection, or sent invalid data.
    pub async fn next(&mut self) -> Option<Result<Update, Error>> {
        let (group, payload) = self.updates.recv().await?;
        Some(payload.and_then(|payload| self.decode(group, &payload)))
    }

    fn decode(&self, group: usize, payload: &[u8]) -> Result<Update, Error> {
        let unexpected = |found: &str| Error::Unexpected { what: "subscription".to_owned(), found: found.to_owned() };
        let parts = self.groups.get(group).ok_or_else(|| unexpected("values of an unknown group"))?;
        let items = payload.get(2..).ok_or_else(|| unexpected("no count of values"))?;
        let mut values = Vec::with_capacity(parts.len());
        for (part, item) in parts.iter().zip(DataItems::new(items)) {
            let variable = &self.variables[part.of];
            let what = || variable.to_string();
            let value = match item {
                Err(code) => Err(Error::Refused { what: what(), code }),
                Ok(bytes) => Value::decode(variable, bytes).ok_or_else(|| Error::Unexpected {
                    what: what(),
                    found: format!("a value of {} bytes", bytes.len()),
                }),
            };
            values.push((part.of, value));
        }
        if values.len() < parts.len() {
            return Err(unexpected("fewer values than were subscribed"));
        }
        Ok(Update { values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_never_shorter_than_asked_for() {
        let of = |milliseconds| interval_on_the_wire(Duration::from_millis(milliseconds));
        assert_eq!([of(0), of(100), of(101), of(25_500)], [(0, 1), (0, 1), (0, 2), (0, 255)]);
        assert_eq!([of(25_501), of(255_000), of(255_001)], [(1, 26), (1, 255), (2, 26)]);
        assert_eq!(of(100_000_000), (2, 255));
    }
}
