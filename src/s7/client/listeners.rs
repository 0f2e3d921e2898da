//! Subscriptions of a link: requested on each new connection, forwarded to their receiver, ended when the receiver is
//! dropped.

use tokio::sync::mpsc;
use tokio::time::Instant;

use super::error::Error;
use super::job::{Failure, Job, Reply, ReplyTo, Subscribed};
use super::link::Link;
use crate::s7::wire::header::{ErrorCode, kind};
use crate::s7::wire::replies::UserData;
use crate::s7::wire::requests;
use crate::s7::wire::user_data::group;

impl Link {
    /// Requests a subscription, for the first time or on a new connection.
    pub(super) fn renew(&mut self, at: usize) {
        let subscribed = &mut self.subscriptions[at];
        subscribed.number = None;
        let job = Job {
            what: "subscription",
            kind: kind::USER_DATA,
            parameter: requests::user_data(group::CYCLIC, subscribed.function).to_vec(),
            data: requests::payload(&subscribed.payload),
            pdu: subscribed.pdu,
            repeat: false, // it is requested again together with the other subscriptions
            asked: Instant::now(),
            was_sent: false,
            reply: ReplyTo::Subscription(subscribed.identifier),
        };
        self.queue.push_back(job);
    }

    /// Forwards an update that the module sent.
    pub(super) fn push(&mut self, push: &UserData<'_>) {
        let is_it = |subscribed: &Subscribed| {
            push.group == group::CYCLIC
                && subscribed.function == push.function
                && subscribed.number == Some(push.sequence)
        };
        match self.subscriptions.iter().position(is_it) {
            Some(at) => self.forward(at, Ok(push.payload.to_vec())),
            // The answer with its number never arrived. It has no receiver, and the module has few subscription slots:
            // end it.
            None if push.group == group::CYCLIC => self.end(push.function, push.sequence),
            None => {}
        }
    }

    /// Ends a job of the module, once.
    fn end(&mut self, function: u8, number: u8) {
        let data = requests::payload(&[function, number]);
        let is_same = |job: &Job| matches!(job.reply, ReplyTo::NoReceiver) && job.data == data;
        if self.queue.iter().any(is_same) || self.is_in_flight(is_same) {
            return;
        }
        self.queue.push_back(Job {
            what: "end of a subscription",
            kind: kind::USER_DATA,
            parameter: requests::user_data(group::CYCLIC, 4).to_vec(),
            data,
            pdu: 0,
            repeat: false,
            asked: Instant::now(),
            was_sent: false,
            reply: ReplyTo::NoReceiver,
        });
    }

    /// Forwards values to the receiver. If its buffer is full, the update is dropped; if it is gone, the subscription
    /// is ended.
    fn forward(&mut self, at: usize, values: Result<Vec<u8>, Error>) {
        let subscribed = &self.subscriptions[at];
        if let Err(mpsc::error::TrySendError::Closed(_)) = subscribed.to.try_send((subscribed.group, values)) {
            let subscribed = self.subscriptions.swap_remove(at);
            if let Some(number) = subscribed.number {
                self.end(subscribed.function, number);
            }
        }
    }

    pub(super) fn subscription_answered(&mut self, identifier: u64, reply: Result<Reply, Failure>) {
        let Some(at) = self.subscriptions.iter().position(|subscribed| subscribed.identifier == identifier) else {
            return;
        };
        let what = || "subscription".to_owned();
        let result = match reply {
            Err(Failure::Error(error)) => Err(error),
            Err(Failure::Renegotiated) => Err(Error::Rejected { what: what(), error: ErrorCode::WRONG_FRAME }),
            Ok(reply) => match UserData::parse(&reply.parameter, &reply.data) {
                _ if reply.error != ErrorCode::NONE => Err(Error::Rejected { what: what(), error: reply.error }),
                None => Err(Error::Unexpected { what: what(), found: "no user data".to_owned() }),
                Some(data) if data.error != ErrorCode::NONE => Err(Error::Rejected { what: what(), error: data.error }),
                Some(data) => Ok((data.sequence, data.payload.to_vec())),
            },
        };
        let subscribed = &mut self.subscriptions[at];
        let ready = subscribed.ready.take();
        match result {
            Ok((number, values)) => {
                subscribed.number = Some(number);
                if let Some(ready) = ready {
                    let _ = ready.send(Ok(()));
                }
                self.forward(at, Ok(values));
            }
            // An answer was lost but the connection was not: nothing else would request it again.
            Err(Error::TimedOut { .. }) if ready.is_none() => {
                if subscribed.to.is_closed() {
                    self.subscriptions.swap_remove(at);
                } else {
                    self.renew(at);
                }
            }
            // After a lost connection the reconnect requests it again.
            Err(error) if ready.is_none() && error.is_of_the_connection() => {}
            Err(error) => {
                match ready {
                    Some(ready) => drop(ready.send(Err(error))),
                    None => drop(subscribed.to.try_send((subscribed.group, Err(error)))),
                }
                self.subscriptions.swap_remove(at);
            }
        }
    }
}
