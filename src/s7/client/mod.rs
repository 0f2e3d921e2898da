//! A client of S7 communication, which shares the wire formats with the server: for test tools, data collectors, and the commands of
//! `opennck s7`.
//!
//! ```no_run
//! use opennck::s7::client::{Client, Options, Value, Variable};
//!
//! # async fn example() -> Result<(), opennck::s7::client::Error> {
//! let plc = Client::connect("127.0.0.1:10102", Options::default()).await?;
//! let ready: Variable = "DB31.DBX101.4".parse()?;
//! if plc.read(&ready).await? == Value::Bit(true) {
//!     plc.write(&"DB31.DBX29.4".parse()?, &Value::Bit(true)).await?;
//! }
//! // Any number of items: as few requests as the negotiated PDU permits; each item has its own result.
//! let many = ["DB31.DBD78:REAL".parse()?, "MB0..500".parse()?, "DB99.DBW0".parse()?];
//! for (variable, value) in many.iter().zip(plc.read_all(&many).await) {
//!     println!("{variable}: {value:?}");
//! }
//! # Ok(())
//! # }
//! ```
//!
//! A client is a handle: its clones share one connection and send requests in parallel, as many as the module accepts. A lost connection is
//! reopened. Reads are then repeated; requests that change something are never repeated: their error reports whether they were sent.
//! [`Client::changes`] reports the state of the connection.
//!
//! Data from the server are not trusted: lengths are checked, memory is bounded, and an answer is matched to its request by reference and
//! function.
//!
//! | file | content |
//! |---|---|
//! | `variable`, `nc`, `value` | variables, values, and their bytes |
//! | `plan` | the distribution of items over requests |
//! | `conversation` | the transport without a socket |
//! | `opening`, `link`, `listeners` | opening the connection, and the task that owns the socket |
//! | `variables`, `subscription`, `system`, `blocks` | the requests of a client |

mod blocks;
mod conversation;
mod error;
mod job;
mod link;
mod listeners;
mod nc;
mod opening;
mod options;
mod plan;
mod subscription;
mod system;
mod value;
mod variable;
mod variables;

#[cfg(test)]
mod tests;

pub use blocks::{BlockCount, BlockDescription, BlockEntry, BlockKind};
pub use error::{Error, Execution};
pub use job::Negotiated;
pub use link::State;
pub use nc::{NcKind, NcVariable};
pub use options::{Backoff, ConnectionKind, Options, Tsaps, password};
pub use subscription::{Mode, Subscription, Update};
pub use system::{Identification, SystemStateList};
pub use value::Value;
pub use variable::{Memory, Variable};

use std::fmt::Debug;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::{Mutex, mpsc, oneshot, watch};
use tokio::time::Instant;

use crate::s7::wire::header::{ErrorCode, kind};
use job::{Failure, Job, LinkCommand, Reply, ReplyTo, by};
use link::Link;

/// The number of requests queued for the task; further callers wait.
const COMMANDS: usize = 32;

/// A connection to a module. It is closed when the last clone and the last subscription are dropped.
#[derive(Clone, Debug)]
pub struct Client {
    commands: mpsc::Sender<LinkCommand>,
    state: watch::Receiver<State>,
    options: Arc<Options>,
    /// A module keeps only one long answer at a time.
    long: Arc<Mutex<()>>,
}

/// A request without the fields that are the same for all requests.
struct Question<'a> {
    what: &'static str,
    kind: u8,
    parameter: &'a [u8],
    data: &'a [u8],
    pdu: usize,
    repeat: bool,
}

impl Client {
    /// Connects to an address with port: `192.168.214.1:102`, `[::1]:10102`, `localhost:10102`.
    ///
    /// The call needs a tokio runtime of either kind.
    ///
    /// # Errors
    /// The host cannot be reached, or does not accept the connection or the password.
    pub async fn connect(address: &str, options: Options) -> Result<Self, Error> {
        Self::connect_after(Duration::ZERO, address, options).await
    }

    /// Connects to a module for which the caller has already waited in vain, on other connections. Error messages add that time to the time limit.
    pub(crate) async fn connect_after(waited: Duration, address: &str, options: Options) -> Result<Self, Error> {
        let opened = opening::open(address, &options, waited).await?;
        Ok(Self::with_link(opened, address, options, waited))
    }

    /// Connects over a stream that is already open: a tunnel, or a test's stream. It is not reopened when it is lost, whatever the options
    /// are.
    ///
    /// # Errors
    /// The server does not accept the connection or the password.
    pub async fn over(
        stream: impl AsyncRead + AsyncWrite + Debug + Send + Unpin + 'static,
        options: Options,
    ) -> Result<Self, Error> {
        let (options, name) = (Options { reconnect: None, ..options }, "the other end");
        let (deadline, waited) = (Instant::now() + options.timeout, Duration::ZERO);
        let opened = opening::greet(Box::new(stream), name, &options, deadline, waited).await?;
        Ok(Self::with_link(opened, name, options, waited))
    }

    fn with_link(opened: opening::Opened, address: &str, options: Options, waited: Duration) -> Self {
        let (commands, receiver) = mpsc::channel(COMMANDS);
        let (sender, state) = watch::channel(State::Connected(opened.negotiated));
        let options = Arc::new(options);
        let link = Link::new(address.into(), Arc::clone(&options), waited, receiver, sender);
        tokio::spawn(link.run(opened));
        Self { commands, state, options, long: Arc::default() }
    }

    /// The state of the connection.
    #[must_use]
    pub fn state(&self) -> State {
        self.state.borrow().clone()
    }

    /// A receiver for every change of the connection state.
    #[must_use]
    pub fn changes(&self) -> watch::Receiver<State> {
        self.state.clone()
    }

    /// The values negotiated with the module on this connection, or on the last one.
    #[must_use]
    pub fn negotiated(&self) -> Option<Negotiated> {
        match &*self.state.borrow() {
            State::Connected(negotiated) => Some(*negotiated),
            State::Lost { .. } | State::Ended { .. } => None,
        }
    }

    /// Waits for a connection, at most as long as for a request.
    async fn connected(&self, what: &str) -> Result<Negotiated, Error> {
        let mut state = self.state.clone();
        let lost =
            |cause: &str| Error::Lost { what: what.to_owned(), execution: Execution::NotSent, cause: cause.to_owned() };
        let deadline = Instant::now() + self.options.patience;
        loop {
            let last = match &*state.borrow_and_update() {
                State::Connected(negotiated) => return Ok(*negotiated),
                State::Lost { cause, .. } => lost(cause),
                State::Ended { cause } => return Err(lost(cause)),
            };
            match by(deadline, state.changed()).await {
                Some(Ok(())) => {}
                Some(Err(_)) | None => return Err(last),
            }
        }
    }

    /// Hands a request to the task; the answer is received later.
    async fn send(&self, question: Question<'_>) -> oneshot::Receiver<Result<Reply, Failure>> {
        let (reply, answer) = oneshot::channel();
        let Question { what, kind, parameter, data, pdu, repeat } = question;
        let (parameter, data) = (parameter.to_vec(), data.to_vec());
        let (asked, reply) = (Instant::now(), ReplyTo::Caller(reply));
        let job = Job { what, kind, parameter, data, pdu, repeat, asked, was_sent: false, reply };
        // If the task has ended, the answer channel reports it as well.
        let _ = self.commands.send(LinkCommand::Ask(job)).await;
        answer
    }

    /// Sends a request and waits for the answer. An error of the whole request is returned as an error.
    async fn ask(&self, question: Question<'_>) -> Result<Reply, Error> {
        let what = question.what;
        let reply = match self.send(question).await.await {
            Ok(Ok(reply)) => reply,
            Ok(Err(Failure::Error(error))) => return Err(error),
            Ok(Err(Failure::Renegotiated)) | Err(_) => return Err(self.gone(what)),
        };
        match reply.error {
            ErrorCode::NONE => Ok(reply),
            error => Err(Error::Rejected { what: what.to_owned(), error }),
        }
    }

    /// The error of a request that the task did not accept any more.
    fn gone(&self, what: &str) -> Error {
        let cause = match &*self.state.borrow() {
            State::Ended { cause } | State::Lost { cause, .. } => cause.clone(),
            State::Connected(_) => "the client ends".to_owned(),
        };
        Error::Lost { what: what.to_owned(), execution: Execution::NotSent, cause }
    }
}

impl<'a> Question<'a> {
    fn job(what: &'static str, parameter: &'a [u8]) -> Self {
        Self { what, kind: kind::JOB, parameter, data: &[], pdu: 0, repeat: false }
    }

    fn user_data(what: &'static str, parameter: &'a [u8], data: &'a [u8]) -> Self {
        Self { what, kind: kind::USER_DATA, parameter, data, pdu: 0, repeat: false }
    }

    /// Marks a request that changes nothing and may be repeated.
    fn repeated(self) -> Self {
        Self { repeat: true, ..self }
    }
}
