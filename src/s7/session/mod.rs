//! The conversation with one client, without a socket: bytes in, answers out. Every request gets an answer: a request that cannot be served
//! is refused with the error that a module would return. Bytes that are not a request end the connection.
//!
//! | state | event | then |
//! |---|---|---|
//! | new | connection request | connected |
//! | connected | setup communication | variables, jobs and user data are served, within the negotiated PDU |
//! | any | disconnect request, or bytes of another protocol | closed |
//!
//! The called TSAP determines which requests are allowed. Variables of the NCK are served at the TSAPs of the NCK, slot 3 (powerline) or 4
//! (solution line); at any other TSAP the whole request is refused with `8104`, as by a PLC. Everything else is served at every TSAP,
//! because many clients use one connection for all data.

mod blocks;
mod clock;
mod control;
mod cyclic;
mod exchange;
mod failure;
mod guess;
mod parts;
mod pending;
mod security;
mod subscriptions;
mod system_state;
mod upload;
mod values;
mod variables;

use super::station::Station;
use super::wire::cotp::{self, ConnectionRequest, Tpdu};
use super::wire::header::{ErrorCode, Message, Unreadable, function, kind};
use super::wire::pdu::{Answers, Budget, Pdu};
use super::wire::tpkt::{self, Packet};
use super::wire::user_data::{self, Head, Received, Request, group};
use crate::units::Time;

use exchange::Exchange;
pub use failure::Failure;
pub(super) use guess::Guess;
use pending::{Parts, Uploads};
use subscriptions::Subscriptions;

/// The shortest PDU that is agreed.
const SHORTEST_PDU: u16 = 240;
/// The longest PDU that is agreed.
const LONGEST_PDU: u16 = 960;
/// The longest request that is reassembled. A client that sends more is disconnected.
const LONGEST_REQUEST: usize = 4096;
/// The longest packet that is accepted: a TPDU of 8192 bytes.
const LONGEST_PACKET: usize = 8192 + tpkt::HEADER;

/// The settings of a connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The longest PDU that is agreed, 240 to 960.
    pub longest_pdu: u16,
    /// Maximum number of parallel requests of a client.
    pub jobs: u16,
    /// The server's reference of the connection, not 0.
    pub reference: u16,
    /// The called TSAPs that are accepted; `None` accepts all.
    pub called: Option<Vec<[u8; 2]>>,
    /// Minimum interval of updates, whatever the client requests.
    pub shortest_interval: Time,
}

impl Default for Settings {
    fn default() -> Self {
        Self { longest_pdu: LONGEST_PDU, jobs: 8, reference: 1, called: None, shortest_interval: Time::from_millis(50) }
    }
}

/// Whether the connection continues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Connection {
    /// It continues.
    Open,
    /// Send the answers, then close.
    Closed,
}

/// A conversation with one client.
#[derive(Clone, Debug)]
pub struct Session {
    settings: Settings,
    connection: Connection,
    is_connected: bool,
    is_set_up: bool,
    /// The slot of the called module: 2 PLC, 3 and 4 NCK.
    slot: u8,
    budget: Budget,
    /// Bytes of an incomplete packet.
    input: Vec<u8>,
    /// Pieces of an incomplete PDU.
    pieces: Vec<u8>,
    /// Buffer for NC variables.
    scratch: Vec<u8>,
    knows_password: bool,
    guess: Option<Guess>,
    sequence: u8,
    parts: Parts,
    uploads: Uploads,
    subscriptions: Subscriptions,
    failure: Option<Failure>,
    /// The number of read and write requests on this connection and those before it.
    requests: u64,
}

impl Session {
    /// A session with a new client.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            connection: Connection::Open,
            is_connected: false,
            is_set_up: false,
            slot: 0,
            budget: Budget { pdu: SHORTEST_PDU.into(), piece: usize::from(LONGEST_PDU) },
            input: Vec::new(),
            pieces: Vec::new(),
            scratch: Vec::new(),
            knows_password: false,
            guess: None,
            sequence: 0,
            parts: Parts::default(),
            uploads: Uploads::default(),
            subscriptions: Subscriptions::default(),
            failure: None,
            requests: 0,
        }
    }

    /// The negotiated PDU size.
    #[must_use]
    pub fn pdu_length(&self) -> usize {
        self.budget.pdu
    }

    /// Whether there are subscriptions, so that [`Session::tick`] must be called.
    #[must_use]
    pub fn has_subscriptions(&self) -> bool {
        !self.subscriptions.is_empty()
    }

    /// Refuses the next read or write request; `None` cancels that.
    pub fn fail_next(&mut self, failure: Option<Failure>) {
        self.failure = failure;
    }

    /// The number of read and write requests, including injected refusals. A request in several pieces counts once.
    #[must_use]
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Takes received bytes in pieces of any size, and appends the answers to complete requests, in order.
    pub fn receive(&mut self, bytes: &[u8], station: &mut dyn Station, answers: &mut Answers) -> Connection {
        let mut input = std::mem::take(&mut self.input);
        let is_joined = !input.is_empty();
        if is_joined {
            input.extend_from_slice(bytes);
        }
        let mut rest = if is_joined { input.as_slice() } else { bytes };
        while self.connection == Connection::Open {
            match tpkt::split(rest) {
                Packet::Whole { content, length } => {
                    self.tpdu(content, station, answers);
                    rest = &rest[length..];
                }
                Packet::Incomplete if is_too_long(rest) => self.connection = Connection::Closed,
                Packet::Incomplete => break,
                Packet::Wrong => self.connection = Connection::Closed,
            }
        }
        if self.connection == Connection::Open {
            let taken = if is_joined { input.len() - rest.len() } else { bytes.len() - rest.len() };
            if is_joined {
                input.drain(..taken);
            } else {
                input.extend_from_slice(&bytes[taken..]);
            }
            self.input = input;
        }
        self.connection
    }

    /// Sends the updates that are due: cyclic values and changed values. `now` may have any origin but must not go back.
    pub fn tick(&mut self, now: Time, station: &mut dyn Station, answers: &mut Answers) {
        if self.connection == Connection::Open {
            let Self { subscriptions, scratch, budget, settings, .. } = self;
            subscriptions.tick(now, settings.shortest_interval, scratch, *budget, station, answers);
        }
    }

    fn tpdu(&mut self, content: &[u8], station: &mut dyn Station, answers: &mut Answers) {
        match Tpdu::parse(content) {
            Tpdu::ConnectionRequest(request) => self.connect(&request, answers),
            Tpdu::Data { piece, last } if self.is_connected => self.piece(piece, last, station, answers),
            Tpdu::DisconnectRequest { source } => {
                answers.transport(|out| cotp::disconnect_confirm(source, self.settings.reference, out));
                self.connection = Connection::Closed;
            }
            Tpdu::Data { .. } | Tpdu::Other(_) | Tpdu::Malformed => self.connection = Connection::Closed,
        }
    }

    /// A second request on the same connection starts over.
    fn connect(&mut self, request: &ConnectionRequest<'_>, answers: &mut Answers) {
        let is_called = |known: &Vec<[u8; 2]>| known.iter().any(|tsap| request.called == Some(tsap.as_slice()));
        if self.settings.called.as_ref().is_some_and(|known| !is_called(known)) {
            answers.transport(|out| cotp::disconnect_request(request.source, cotp::UNKNOWN_ADDRESS, out));
            self.connection = Connection::Closed;
            return;
        }
        let (failure, requests) = (self.failure, self.requests);
        *self = Self { failure, requests, ..Self::new(self.settings.clone()) };
        self.is_connected = true;
        // Rack and slot are in the last byte.
        self.slot = request.called.and_then(<[u8]>::last).map_or(0, |last| last & 0x1F);
        self.budget.piece = request.piece();
        answers.transport(|out| request.confirm(self.settings.reference, out));
    }

    /// Reassembles a PDU. A piece without bytes changes nothing: some clients send one after every request.
    fn piece(&mut self, piece: &[u8], last: bool, station: &mut dyn Station, answers: &mut Answers) {
        if piece.is_empty() && self.pieces.is_empty() {
            return;
        }
        if self.pieces.len() + piece.len() > LONGEST_REQUEST {
            self.connection = Connection::Closed;
            return;
        }
        if last && self.pieces.is_empty() {
            self.pdu(piece, station, answers);
            return;
        }
        self.pieces.extend_from_slice(piece);
        if last {
            // Pieces are rare: the buffer is released after use.
            let whole = std::mem::take(&mut self.pieces);
            self.pdu(&whole, station, answers);
        }
    }

    fn pdu(&mut self, pdu: &[u8], station: &mut dyn Station, answers: &mut Answers) {
        let budget = self.budget;
        let message = match Message::parse(pdu) {
            Ok(message) => message,
            Err(Unreadable::Foreign) => {
                self.connection = Connection::Closed;
                return;
            }
            Err(Unreadable::Lengths { reference, kind }) => {
                if !matches!(kind, kind::ACK | kind::ACK_DATA) {
                    Pdu::refuse(answers, reference, budget, ErrorCode::WRONG_FRAME);
                }
                return;
            }
        };
        let mut exchange = Exchange { station, answers, reference: message.reference, budget };
        match message.kind {
            kind::ACK | kind::ACK_DATA => {} // an acknowledgement needs no answer
            _ if pdu.len() > budget.pdu => exchange.refuse(ErrorCode::WRONG_FRAME),
            kind::JOB => self.job(&message, &mut exchange),
            kind::USER_DATA => match user_data::parse(message.parameter, message.data) {
                Received::Request(request) => self.user_data(&request, &mut exchange),
                Received::Answer => {}
                Received::Malformed => exchange.refuse(ErrorCode::WRONG_FRAME),
            },
            _ => exchange.refuse(ErrorCode::NOT_IMPLEMENTED),
        }
    }

    fn job(&mut self, message: &Message<'_>, exchange: &mut Exchange<'_>) {
        let Some((&code, rest)) = message.parameter.split_first() else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        if code == function::SETUP {
            return self.set_up(rest, exchange);
        }
        if !self.is_set_up {
            return exchange.refuse(ErrorCode::WRONG_SEQUENCE);
        }
        if matches!(code, function::READ | function::WRITE) {
            self.requests += 1;
            if let Some(failure) = self.failure.take() {
                return failure.answer(code, rest, exchange);
            }
        }
        match code {
            function::READ => self.read_variables(rest, exchange),
            function::WRITE => self.write_variables(rest, message.data, exchange),
            function::START_UPLOAD => self.start_upload(rest, exchange),
            function::UPLOAD => self.upload(rest, exchange),
            function::END_UPLOAD => self.end_upload(rest, exchange),
            function::START => self.start(rest, exchange),
            function::STOP => self.stop(rest, exchange),
            // Blocks come from the PLC image; clients cannot download others.
            function::REQUEST_DOWNLOAD | function::DOWNLOAD | function::END_DOWNLOAD => {
                exchange.refuse(ErrorCode::PROTECTED);
            }
            _ => exchange.refuse(ErrorCode::NOT_IMPLEMENTED),
        }
    }

    /// Setup communication: the number of parallel jobs, and the PDU size. It may be repeated at any time.
    fn set_up(&mut self, rest: &[u8], exchange: &mut Exchange<'_>) {
        let &[_, calling_high, calling_low, called_high, called_low, pdu_high, pdu_low] = rest else {
            return exchange.refuse(ErrorCode::WRONG_FRAME);
        };
        let jobs = self.settings.jobs.max(1);
        let agreed = |high, low| u16::from_be_bytes([high, low]).clamp(1, jobs).to_be_bytes();
        let (calling, called) = (agreed(calling_high, calling_low), agreed(called_high, called_low));
        let longest = self.settings.longest_pdu.clamp(SHORTEST_PDU, LONGEST_PDU);
        let pdu = u16::from_be_bytes([pdu_high, pdu_low]).clamp(SHORTEST_PDU, longest);
        let [high, low] = pdu.to_be_bytes();
        let mut answer = Pdu::ack_data(exchange.answers, exchange.reference, exchange.budget);
        answer.put(&[function::SETUP, 0, calling[0], calling[1], called[0], called[1], high, low]);
        answer.finish();
        self.budget.pdu = pdu.into();
        self.is_set_up = true;
        // Subscriptions made for another PDU size may not fit this one.
        self.subscriptions = Subscriptions::default();
    }

    fn user_data(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) {
        if !self.is_set_up {
            return self.refuse_user_data(request, exchange, ErrorCode::WRONG_SEQUENCE);
        }
        if request.goes_on {
            return self.next_part(request, exchange);
        }
        let refused = match (request.group, request.function) {
            (group::CYCLIC, function) => self.cyclic(function, request, exchange),
            (group::BLOCKS, 1) => self.count_blocks(request, exchange),
            (group::BLOCKS, 2) => self.list_blocks(request, exchange),
            (group::BLOCKS, 3) => self.describe_block(request, exchange),
            (group::CPU, 1) => self.read_list(request, exchange),
            (group::CPU, 2) => self.log_on_to_messages(request, exchange),
            (group::SECURITY, 1) => self.give_password(request, exchange),
            (group::SECURITY, 2) => self.take_password_back(request, exchange),
            (group::TIME, 1 | 3) => self.read_clock(request, exchange),
            (group::TIME, 2 | 4) => self.set_clock(request, exchange),
            (group::PROGRAMMER | group::CPU | group::SECURITY | group::BLOCKS | group::TIME, _) => {
                Err(ErrorCode::NOT_SUPPORTED)
            }
            _ => Err(ErrorCode::NOT_IMPLEMENTED),
        };
        if let Err(error) = refused {
            self.refuse_user_data(request, exchange, error);
        }
    }

    fn refuse_user_data(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>, error: ErrorCode) {
        let head = Head { error, ..Head::answer(request, self.next_sequence()) };
        head.send_empty(exchange.answers, exchange.reference, exchange.budget);
    }

    /// Numbers of sequences and jobs, 1 to 255.
    fn next_sequence(&mut self) -> u8 {
        self.sequence = self.sequence.checked_add(1).unwrap_or(1);
        self.sequence
    }
}

/// Whether the packet that begins here would be longer than accepted.
fn is_too_long(bytes: &[u8]) -> bool {
    matches!(bytes, [_, _, high, low, ..] if usize::from(u16::from_be_bytes([*high, *low])) > LONGEST_PACKET)
}
