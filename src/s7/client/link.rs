//! One connection to a module, kept alive by a task. The task owns the socket, assigns references, sends as many parallel requests as
//! negotiated, and reconnects.
//!
//! | event | effect on a request |
//! |---|---|
//! | an answer with its reference and function | it is its answer |
//! | an answer with an unknown reference, or after the time limit | dropped; no other request gets it |
//! | no answer in time | it fails; its slot is free again |
//! | the connection is lost, it only reads | repeated on the next connection |
//! | the connection is lost, it changes something and was sent | it fails and reports that it was sent; never repeated |
//! | the connection is lost, it was not sent yet | it waits for the next connection |
//! | it waited too long for a connection | it fails and reports whether it was sent |
//! | it is repeated on one connection after the other | it fails when it has waited for longer than for a connection and for an answer |
//!
//! Several consecutive requests without an answer, and no other input, count as a lost connection as well.

use std::collections::{BTreeMap, VecDeque};
use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::conversation::Event;
use super::error::Error;
use super::job::{Failure, InFlight, Job, LinkCommand, Negotiated, Reply, ReplyTo, Subscribed};
use super::opening::{Opened, open};
use super::options::Options;
use crate::s7::wire::header::{ErrorCode, Message, Unreadable, kind};
use crate::s7::wire::pdu::{Answers, Budget, Pdu};
use crate::s7::wire::replies::UserData;

/// Maximum number of requests queued here; further callers wait.
const QUEUE: usize = 64;
/// After this many consecutive requests without an answer the connection counts as lost.
const SILENCES: u32 = 2;

/// The state of the connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// It is open.
    Connected(Negotiated),
    /// It was lost and is being reopened.
    Lost {
        /// The reason.
        cause: String,
        /// The number of failed attempts.
        attempts: u32,
    },
    /// It was lost and will not be reopened.
    Ended {
        /// The reason.
        cause: String,
    },
}

/// The task.
#[derive(Debug)]
pub(super) struct Link {
    address: Arc<str>,
    options: Arc<Options>,
    /// How long the caller had waited for the module before, in vain.
    waited: Duration,
    commands: mpsc::Receiver<LinkCommand>,
    state: watch::Sender<State>,
    pub(super) queue: VecDeque<Job>,
    in_flight: BTreeMap<u16, InFlight>,
    pub(super) subscriptions: Vec<Subscribed>,
    reference: u16,
    identifier: u64,
    /// Time of the last input.
    heard: Instant,
    silences: u32,
    /// Delay before the next attempt to connect. It is reset by an answer, not by an open connection: otherwise a server that closes on
    /// each request would be called without a pause.
    wait: Duration,
}

/// The reason for leaving a connection.
enum End {
    /// All clients were dropped.
    Left,
    Lost(String),
}

impl Link {
    pub(super) fn new(
        address: Arc<str>,
        options: Arc<Options>,
        waited: Duration,
        commands: mpsc::Receiver<LinkCommand>,
        state: watch::Sender<State>,
    ) -> Self {
        let (queue, in_flight, subscriptions) = (VecDeque::new(), BTreeMap::new(), Vec::new());
        let heard = Instant::now();
        // The handshake uses the numbers before.
        let reference = super::opening::REFERENCES;
        Self {
            address,
            options,
            waited,
            commands,
            state,
            queue,
            in_flight,
            subscriptions,
            reference,
            identifier: 0,
            heard,
            silences: 0,
            wait: Duration::ZERO,
        }
    }

    /// Whether such a job is in flight.
    pub(super) fn is_in_flight(&self, is_it: impl Fn(&Job) -> bool) -> bool {
        self.in_flight.values().any(|waiting| is_it(&waiting.job))
    }

    /// Runs until all clients are dropped, or the connection is lost for good.
    pub(super) async fn run(mut self, mut opened: Opened) {
        loop {
            self.state.send_replace(State::Connected(opened.negotiated));
            self.heard = Instant::now();
            self.silences = 0;
            let cause = match self.attend(&mut opened).await {
                End::Left => {
                    let _ = timeout(self.options.timeout, opened.stream.shutdown()).await;
                    return;
                }
                End::Lost(cause) => cause,
            };
            drop(opened);
            self.take_back(&cause);
            match self.reconnect(&cause).await {
                Some(again) => opened = again,
                None => return,
            }
            for at in 0..self.subscriptions.len() {
                self.renew(at);
            }
        }
    }

    async fn attend(&mut self, opened: &mut Opened) -> End {
        let mut input = vec![0; 16 * 1024];
        let mut out = Answers::default();
        loop {
            out.clear();
            self.emit(opened, &mut out);
            if !out.is_empty() {
                match timeout(self.options.timeout, opened.stream.write_all(out.bytes())).await {
                    Ok(Ok(())) => {}
                    Ok(Err(error)) => return End::Lost(error.to_string()),
                    Err(_) => return End::Lost("the server does not accept requests".to_owned()),
                }
            }
            let deadline = self.deadline();
            // Events take turns: a server that floods the client must not block requests or time limits.
            tokio::select! {
                read = opened.stream.read(&mut input) => match read {
                    Ok(0) => return End::Lost("the server closed the connection".to_owned()),
                    Err(error) => return End::Lost(error.to_string()),
                    Ok(count) => {
                        self.heard = Instant::now();
                        self.silences = 0;
                        let received = opened.conversation.receive(&input[..count], |event| {
                            if let Event::Pdu(pdu) = event {
                                self.pdu(pdu);
                            }
                        });
                        if let Err(broken) = received {
                            return End::Lost(broken.words().to_owned());
                        }
                    }
                },
                command = self.commands.recv(), if self.queue.len() < QUEUE => match command {
                    Some(command) => self.accept(command),
                    None => return End::Left,
                },
                () = sleep_until(deadline) => {
                    self.expire();
                    if self.silences >= SILENCES {
                        return End::Lost("the server no longer answers".to_owned());
                    }
                }
            }
        }
    }

    fn accept(&mut self, command: LinkCommand) {
        match command {
            LinkCommand::Ask(job) => self.queue.push_back(job),
            LinkCommand::Subscribe(mut subscribed) => {
                self.identifier += 1;
                subscribed.identifier = self.identifier;
                self.subscriptions.push(subscribed);
                self.renew(self.subscriptions.len() - 1);
            }
        }
    }

    /// Sends the requests that may be sent.
    fn emit(&mut self, opened: &Opened, out: &mut Answers) {
        let Negotiated { pdu, jobs } = opened.negotiated;
        let budget = Budget { pdu, piece: opened.piece };
        while self.in_flight.len() < jobs {
            let Some(job) = self.queue.pop_front() else { return };
            if matches!(&job.reply, ReplyTo::Caller(reply) if reply.is_closed()) {
                continue; // its receiver is gone
            }
            if job.pdu > pdu {
                self.answer(job, Err(Failure::Renegotiated));
                continue;
            }
            let reference = self.free_reference();
            let mut request = match job.kind {
                kind::USER_DATA => Pdu::user_data(out, reference, budget),
                _ => Pdu::job(out, reference, budget),
            };
            request.put(&job.parameter);
            request.data();
            request.put(&job.data);
            if request.is_full() {
                request.discard();
                let (what, error) = (job.what.to_owned(), ErrorCode::WRONG_FRAME);
                self.answer(job, Err(Failure::Error(Error::Rejected { what, error })));
                continue;
            }
            request.finish();
            self.in_flight.insert(reference, InFlight { job, sent: Instant::now() });
        }
    }

    /// A reference that no request in flight has, and not 0.
    fn free_reference(&mut self) -> u16 {
        loop {
            self.reference = self.reference.checked_add(1).unwrap_or(1);
            if !self.in_flight.contains_key(&self.reference) {
                return self.reference; // there are more references than jobs
            }
        }
    }

    /// Takes a PDU from the server. A PDU that answers no request is dropped.
    fn pdu(&mut self, pdu: &[u8]) {
        let message = match Message::parse(pdu) {
            Ok(message) => message,
            Err(Unreadable::Lengths { reference, .. }) => {
                if let Some(InFlight { job, .. }) = self.in_flight.remove(&reference) {
                    let found = "its lengths are wrong".to_owned();
                    let error = Error::Unexpected { what: job.what.to_owned(), found };
                    self.answer(job, Err(Failure::Error(error)));
                }
                return;
            }
            Err(Unreadable::Foreign) => return,
        };
        if message.kind == kind::USER_DATA
            && let Some(push) = UserData::parse(message.parameter, message.data).filter(|data| data.is_push)
        {
            self.push(&push);
            return;
        }
        let Some(waiting) = self.in_flight.get(&message.reference) else {
            return;
        };
        if answers(&waiting.job, &message)
            && let Some(InFlight { job, .. }) = self.in_flight.remove(&message.reference)
        {
            self.wait = Duration::ZERO;
            let (parameter, data) = (message.parameter.to_vec(), message.data.to_vec());
            self.answer(job, Ok(Reply { error: message.error, parameter, data }));
        }
    }

    fn answer(&mut self, job: Job, reply: Result<Reply, Failure>) {
        match job.reply {
            ReplyTo::Caller(caller) => {
                let _ = caller.send(reply); // the receiver may be gone
            }
            ReplyTo::Subscription(identifier) => self.subscription_answered(identifier, reply),
            ReplyTo::NoReceiver => {}
        }
    }

    /// The next deadline.
    fn deadline(&self) -> Instant {
        let sent = self.in_flight.values().map(|waiting| self.end_of(waiting));
        let asked = self.queue.iter().map(|job| job.asked + self.options.patience);
        sent.chain(asked).min().unwrap_or_else(|| Instant::now() + Duration::from_hours(1))
    }

    /// When a request in flight fails. One that is repeated also has a limit for all its connections together: otherwise a server that
    /// accepts and drops connections would hold it for ever.
    fn end_of(&self, InFlight { job, sent }: &InFlight) -> Instant {
        let answered = *sent + self.options.timeout;
        if job.was_sent { answered.min(job.asked + self.options.patience.max(self.options.timeout)) } else { answered }
    }

    /// Ends requests that exceeded their time limit.
    fn expire(&mut self) {
        let now = Instant::now();
        let Options { timeout, patience, .. } = *self.options;
        let waited = self.waited;
        let heard = self.heard;
        let ends: Vec<u16> =
            self.in_flight.iter().filter(|(_, waiting)| self.end_of(waiting) <= now).map(|(at, _)| *at).collect();
        let late: Vec<InFlight> = ends.iter().filter_map(|at| self.in_flight.remove(at)).collect();
        for InFlight { job, sent } in late {
            self.silences += u32::from(sent >= heard);
            let after = if job.was_sent { now - job.asked } else { timeout };
            let (what, after, execution) = (job.what.to_owned(), rounded(waited + after), job.execution());
            let error = Error::TimedOut { what, after, execution };
            self.answer(job, Err(Failure::Error(error)));
        }
        let (late, queue) = std::mem::take(&mut self.queue).into_iter().partition(|job| job.asked + patience <= now);
        self.queue = queue;
        for job in Vec::from(late) {
            let (what, execution) = (job.what.to_owned(), job.execution_before());
            let error = Error::TimedOut { what, after: waited + patience, execution };
            self.answer(job, Err(Failure::Error(error)));
        }
    }

    /// Handles the requests in flight when the connection is lost.
    fn take_back(&mut self, cause: &str) {
        let may_repeat = self.options.reconnect.is_some();
        let sent = std::mem::take(&mut self.in_flight);
        for (_, InFlight { mut job, .. }) in sent.into_iter().rev() {
            if job.repeat && may_repeat {
                job.was_sent = true;
                self.queue.push_front(job);
            } else {
                let (what, cause, execution) = (job.what.to_owned(), cause.to_owned(), job.execution());
                let error = Error::Lost { what, execution, cause };
                self.answer(job, Err(Failure::Error(error)));
            }
        }
        // Subscriptions are requested anew on the next connection.
        self.queue.retain(|job| !matches!(job.reply, ReplyTo::Subscription(_) | ReplyTo::NoReceiver));
    }

    /// Reopens the connection; `None` when all clients are dropped or reconnecting is disabled.
    async fn reconnect(&mut self, cause: &str) -> Option<Opened> {
        let Some(backoff) = self.options.reconnect else {
            self.state.send_replace(State::Ended { cause: cause.to_owned() });
            self.commands.close();
            while let Some(command) = self.commands.recv().await {
                self.accept(command);
            }
            for job in std::mem::take(&mut self.queue) {
                let (what, cause, execution) = (job.what.to_owned(), cause.to_owned(), job.execution_before());
                let error = Error::Lost { what, execution, cause };
                self.answer(job, Err(Failure::Error(error)));
            }
            return None;
        };
        let (address, options, waited) = (Arc::clone(&self.address), Arc::clone(&self.options), self.waited);
        let (address, options) = (&*address, &*options);
        let (mut attempts, mut cause) = (0, cause.to_owned());
        loop {
            self.state.send_replace(State::Lost { cause: cause.clone(), attempts });
            let wait = self.wait;
            self.wait = if wait.is_zero() { backoff.first } else { (wait * 2).min(backoff.most) };
            let mut attempt = pin!(async move {
                sleep(wait).await;
                open(address, options, waited).await
            });
            let opened = loop {
                let deadline = self.deadline();
                tokio::select! {
                    opened = &mut attempt => break opened,
                    command = self.commands.recv(), if self.queue.len() < QUEUE => match command {
                        Some(command) => self.accept_later(command),
                        None => return None,
                    },
                    () = sleep_until(deadline) => self.expire(),
                }
            };
            match opened {
                Ok(opened) => return Some(opened),
                Err(error) => cause = error.to_string(),
            }
            attempts += 1;
        }
    }

    /// A subscription that arrives without a connection is requested together with the others.
    fn accept_later(&mut self, command: LinkCommand) {
        self.accept(command);
        self.queue.retain(|job| !matches!(job.reply, ReplyTo::Subscription(_)));
    }
}

/// A time in whole milliseconds, for messages.
fn rounded(time: Duration) -> Duration {
    Duration::from_millis(u64::try_from(time.as_millis()).unwrap_or(u64::MAX))
}

/// Whether a message answers a request: same kind, same function.
fn answers(job: &Job, message: &Message<'_>) -> bool {
    match (job.kind, message.kind) {
        // A refusal fits any request.
        (_, kind::ACK) => true,
        (kind::USER_DATA, kind::USER_DATA) => {
            let at = |parameter: &[u8]| parameter.get(5..7).map(|at| (at[0] & 0xF, at[1]));
            at(&job.parameter) == at(message.parameter)
        }
        (kind::JOB, kind::ACK_DATA) => {
            message.error != ErrorCode::NONE || job.parameter.first() == message.parameter.first()
        }
        _ => false,
    }
}
