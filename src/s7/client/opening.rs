//! Opens a connection: TCP, connection request, setup communication, password.

use std::time::Duration;

use socket2::{SockRef, TcpKeepalive};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::time::Instant;

use super::conversation::{Conversation, Event};
use super::error::Error;
use super::job::{Negotiated, by};
use super::options::{Options, TPDU};
use crate::s7::wire::cotp::{ConnectionConfirm, ConnectionRequest};
use crate::s7::wire::header::{ErrorCode, Message, kind};
use crate::s7::wire::pdu::{Answers, Budget, Pdu};
use crate::s7::wire::replies::{Setup, UserData};
use crate::s7::wire::requests;
use crate::s7::wire::user_data::group;

/// The references used for setup and password; requests use the following numbers.
pub(super) const REFERENCES: u16 = 2;

/// The shortest usable PDU.
const SHORTEST: u16 = 64;
/// The longest supported PDU.
const LONGEST: u16 = 4096;

/// The stream under a connection.
pub(super) trait Stream: AsyncRead + AsyncWrite + std::fmt::Debug + Send + Unpin {}

impl<T: AsyncRead + AsyncWrite + std::fmt::Debug + Send + Unpin> Stream for T {}

/// An open connection.
#[derive(Debug)]
pub(super) struct Opened {
    pub(super) stream: Box<dyn Stream>,
    pub(super) conversation: Conversation,
    pub(super) negotiated: Negotiated,
    /// Bytes of a PDU in one packet.
    pub(super) piece: usize,
}

/// A message received while opening.
enum Received {
    Confirm(ConnectionConfirm),
    Pdu(Vec<u8>),
}

pub(super) async fn open(address: &str, options: &Options, waited: Duration) -> Result<Opened, Error> {
    let deadline = Instant::now() + options.timeout;
    let unreachable = |cause: String| Error::Unreachable { host: address.to_owned(), cause };
    let none = || unreachable(no_answer(options, waited));
    let stream = by(deadline, TcpStream::connect(address)).await.ok_or_else(none)?;
    let stream = stream.map_err(|error| unreachable(error.to_string()))?;
    // The connection also works without these options, only more slowly.
    let _ = stream.set_nodelay(true);
    let keep_alive = TcpKeepalive::new().with_time(Duration::from_secs(30));
    let _ = SockRef::from(&stream).set_tcp_keepalive(&keep_alive);
    greet(Box::new(stream), address, options, deadline, waited).await
}

/// Opens the layers above TCP.
pub(super) async fn greet(
    stream: Box<dyn Stream>,
    address: &str,
    options: &Options,
    deadline: Instant,
    waited: Duration,
) -> Result<Opened, Error> {
    let conversation = Conversation::default();
    let mut opening = Opening { stream, conversation, address, options, deadline, waited };
    let confirm = opening.connect().await?;
    let piece = confirm.piece(TPDU);
    let setup = opening.set_up(piece).await?;
    let negotiated = Negotiated { pdu: setup.pdu.into(), jobs: setup.jobs.into() };
    if let Some(password) = options.password {
        opening.give(password, piece).await?;
    }
    let Opening { stream, conversation, .. } = opening;
    Ok(Opened { stream, conversation, negotiated, piece })
}

/// Names the time limit with the time that the caller had waited before.
fn no_answer(options: &Options, waited: Duration) -> String {
    format!("no answer within {} s", (waited + options.timeout).as_secs_f64())
}

struct Opening<'a> {
    stream: Box<dyn Stream>,
    conversation: Conversation,
    address: &'a str,
    options: &'a Options,
    deadline: Instant,
    waited: Duration,
}

impl Opening<'_> {
    fn refused(&self, cause: impl Into<String>) -> Error {
        let (host, called) = (self.address.to_owned(), self.options.tsaps.called);
        Error::NotAccepted { host, called, cause: cause.into() }
    }

    async fn connect(&mut self) -> Result<ConnectionConfirm, Error> {
        let tsaps = &self.options.tsaps;
        let (calling, called) = (Some(&tsaps.calling[..]), Some(&tsaps.called[..]));
        let mut out = Vec::new();
        ConnectionRequest { source: [0, 1], size: Some(TPDU), calling, called }.put(&mut out);
        match self.exchange(&out).await? {
            Received::Confirm(confirm) => Ok(confirm),
            Received::Pdu(_) => Err(self.refused("the answer to the connection request is data")),
        }
    }

    async fn set_up(&mut self, piece: usize) -> Result<Setup, Error> {
        let (jobs, asked) = (self.options.jobs.max(1), self.options.pdu.clamp(SHORTEST, LONGEST));
        let pdu = self.ask(kind::JOB, 1, &requests::setup(jobs, asked), &[], piece).await?;
        let message = self.message(&pdu, 1)?;
        if message.error != ErrorCode::NONE {
            return Err(self.refused(format!("setup communication is refused: error {:04X}", message.error.0)));
        }
        match Setup::parse(message.parameter) {
            Some(setup) if setup.pdu >= SHORTEST => {
                // Some servers grant more than requested; the client uses at most what it requested.
                Ok(Setup { jobs: setup.jobs.clamp(1, jobs), pdu: setup.pdu.min(asked) })
            }
            _ => Err(self.refused("the answer to setup communication is invalid")),
        }
    }

    async fn give(&mut self, password: [u8; 8], piece: usize) -> Result<(), Error> {
        let parameter = requests::user_data(group::SECURITY, 1);
        let data = requests::payload(&requests::folded(password));
        let pdu = self.ask(kind::USER_DATA, 2, &parameter, &data, piece).await?;
        let message = self.message(&pdu, 2)?;
        match UserData::parse(message.parameter, message.data) {
            // A module without a password does not need one.
            Some(UserData { error: ErrorCode::NONE | ErrorCode::NO_PASSWORD, .. }) => Ok(()),
            Some(UserData { error, .. }) => Err(Error::Rejected { what: "password".to_owned(), error }),
            None => Err(self.refused("the answer to the password is invalid")),
        }
    }

    fn message<'a>(&self, pdu: &'a [u8], reference: u16) -> Result<Message<'a>, Error> {
        match Message::parse(pdu) {
            Ok(message) if message.reference == reference => Ok(message),
            _ => Err(self.refused("the answer is not S7 communication")),
        }
    }

    async fn ask(
        &mut self,
        kind: u8,
        reference: u16,
        parameter: &[u8],
        data: &[u8],
        piece: usize,
    ) -> Result<Vec<u8>, Error> {
        let mut out = Answers::default();
        let budget = Budget { pdu: usize::from(SHORTEST), piece };
        let mut pdu = match kind {
            kind::USER_DATA => Pdu::user_data(&mut out, reference, budget),
            _ => Pdu::job(&mut out, reference, budget),
        };
        pdu.put(parameter);
        pdu.data();
        pdu.put(data);
        pdu.finish();
        match self.exchange(out.bytes()).await? {
            Received::Pdu(pdu) => Ok(pdu),
            Received::Confirm(_) => Err(self.refused("the connection is confirmed twice")),
        }
    }

    /// Sends bytes and waits for a message.
    async fn exchange(&mut self, bytes: &[u8]) -> Result<Received, Error> {
        let late = || no_answer(self.options, self.waited);
        match by(self.deadline, self.stream.write_all(bytes)).await {
            Some(Ok(())) => {}
            Some(Err(error)) => return Err(self.refused(error.to_string())),
            None => return Err(self.refused(late())),
        }
        let mut input = [0; 2048];
        let mut came = None;
        loop {
            let count = match by(self.deadline, self.stream.read(&mut input)).await {
                Some(Ok(0)) => return Err(self.refused("the server closed the connection")),
                Some(Ok(count)) => count,
                Some(Err(error)) => return Err(self.refused(error.to_string())),
                None => return Err(self.refused(late())),
            };
            let received = self.conversation.receive(&input[..count], |event| {
                came.get_or_insert_with(|| match event {
                    Event::Confirmed(confirm) => Received::Confirm(confirm),
                    Event::Pdu(pdu) => Received::Pdu(pdu.to_vec()),
                });
            });
            if let Err(broken) = received {
                return Err(self.refused(broken.words()));
            }
            if let Some(came) = came {
                return Ok(came);
            }
        }
    }
}
