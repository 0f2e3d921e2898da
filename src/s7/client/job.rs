//! What a client asks of its link: requests with a way back for their answers, and subscriptions.

use std::future::Future;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, timeout_at};

use super::error::Error;
use crate::s7::wire::header::ErrorCode;

/// What was agreed with a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Negotiated {
    /// Bytes of a PDU.
    pub pdu: usize,
    /// Requests on their way at once.
    pub jobs: usize,
}

/// What a task is asked to do.
#[derive(Debug)]
pub(super) enum LinkCommand {
    Ask(Job),
    Subscribe(Subscribed),
}

/// A request.
#[derive(Debug)]
pub(super) struct Job {
    /// What it is, for errors.
    pub(super) what: &'static str,
    /// A job, or user data.
    pub(super) kind: u8,
    pub(super) parameter: Vec<u8>,
    pub(super) data: Vec<u8>,
    /// The PDU that it needs; it is given back where another connection has a shorter one.
    pub(super) pdu: usize,
    /// Whether it may be asked again on another connection.
    pub(super) repeat: bool,
    pub(super) asked: Instant,
    pub(super) reply: ReplyTo,
}

/// Who waits for an answer.
#[derive(Debug)]
pub(super) enum ReplyTo {
    Caller(oneshot::Sender<Result<Reply, Failure>>),
    /// The subscription with this identifier.
    Subscription(u64),
    /// Nobody.
    Nobody,
}

/// An answer.
#[derive(Debug)]
pub(super) struct Reply {
    pub(super) error: ErrorCode,
    pub(super) parameter: Vec<u8>,
    pub(super) data: Vec<u8>,
}

/// Why there is none.
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

/// A subscription, as long as somebody listens.
#[derive(Debug)]
pub(super) struct Subscribed {
    /// In cycles or on change.
    pub(super) function: u8,
    pub(super) payload: Vec<u8>,
    pub(super) pdu: usize,
    /// Which of several that belong together.
    pub(super) group: usize,
    pub(super) to: mpsc::Sender<(usize, Result<Vec<u8>, Error>)>,
    /// Told once.
    pub(super) ready: Option<oneshot::Sender<Result<(), Error>>>,
    /// Number at the module, while there is a connection.
    pub(super) number: Option<u8>,
    pub(super) identifier: u64,
}

/// The same deadline for everything that is awaited.
pub(super) async fn by<T>(deadline: Instant, work: impl Future<Output = T>) -> Option<T> {
    timeout_at(deadline, work).await.ok()
}
