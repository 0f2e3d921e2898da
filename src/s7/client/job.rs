//! The commands of a client to its link: requests with a channel for their answers, and subscriptions.

use std::future::Future;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, timeout_at};

use super::error::{Error, Execution};
use crate::s7::wire::header::ErrorCode;

/// The values negotiated with a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Negotiated {
    /// Bytes of a PDU.
    pub pdu: usize,
    /// Maximum number of parallel requests.
    pub jobs: usize,
}

/// A command to the task.
#[derive(Debug)]
pub(super) enum LinkCommand {
    Ask(Job),
    Subscribe(Subscribed),
}

/// A request.
#[derive(Debug)]
pub(super) struct Job {
    /// Its name in errors.
    pub(super) what: &'static str,
    /// A job, or user data.
    pub(super) kind: u8,
    pub(super) parameter: Vec<u8>,
    pub(super) data: Vec<u8>,
    /// The PDU size that it needs. It is returned if a new connection has a shorter PDU.
    pub(super) pdu: usize,
    /// Whether it may be repeated on another connection.
    pub(super) repeat: bool,
    pub(super) asked: Instant,
    /// Whether it was sent on an earlier connection.
    pub(super) was_sent: bool,
    pub(super) reply: ReplyTo,
}

impl Job {
    /// Whether it may have been executed, after it was sent on this connection.
    pub(super) fn execution(&self) -> Execution {
        if self.repeat { Execution::Read } else { Execution::PerhapsExecuted }
    }

    /// Whether it may have been executed on an earlier connection, before it was sent on this one.
    pub(super) fn execution_before(&self) -> Execution {
        if self.was_sent { self.execution() } else { Execution::NotSent }
    }
}

/// The receiver of an answer.
#[derive(Debug)]
pub(super) enum ReplyTo {
    Caller(oneshot::Sender<Result<Reply, Failure>>),
    /// The subscription with this identifier.
    Subscription(u64),
    /// No receiver.
    NoReceiver,
}

/// An answer.
#[derive(Debug)]
pub(super) struct Reply {
    pub(super) error: ErrorCode,
    pub(super) parameter: Vec<u8>,
    pub(super) data: Vec<u8>,
}

/// The reason why there is no answer.
#[derive(Debug)]
pub(super) enum Failure {
    Error(Error),
    /// It was not sent: the connection has a shorter PDU now.
    Renegotiated,
}

#[derive(Debug)]
pub(super) struct InFlight {
    pub(super) job: Job,
    pub(super) sent: Instant,
}

/// A subscription, as long as it has a receiver.
#[derive(Debug)]
pub(super) struct Subscribed {
    /// Cyclic or on change.
    pub(super) function: u8,
    pub(super) payload: Vec<u8>,
    pub(super) pdu: usize,
    /// The index of its group.
    pub(super) group: usize,
    pub(super) to: mpsc::Sender<(usize, Result<Vec<u8>, Error>)>,
    /// Reports the first result, once.
    pub(super) ready: Option<oneshot::Sender<Result<(), Error>>>,
    /// Number at the module, while there is a connection.
    pub(super) number: Option<u8>,
    pub(super) identifier: u64,
}

/// Runs `work` until a common deadline.
pub(super) async fn by<T>(deadline: Instant, work: impl Future<Output = T>) -> Option<T> {
    timeout_at(deadline, work).await.ok()
}
