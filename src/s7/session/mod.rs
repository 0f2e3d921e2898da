//! One client's conversation, without a socket: bytes in, answers out. It never is silent: a request that cannot be served
//! is refused with the error that a module would give, and bytes that are no request end the connection.
//!
//! | state | by | then |
//! |---|---|---|
//! | new | connection request | connected |
//! | connected | setup communication | variables, jobs and user data are served, within the negotiated PDU |
//! | any | disconnect request, or bytes of another protocol | closed |
//!
//! Whom a client called decides what it may ask for: variables of the NCK have the NCK's TSAP, slot 3 (powerline) or 4 (solution
//! line), and anywhere else the whole request is refused with `8104`, as a PLC does. Everything else is served at every TSAP:
//! clients that keep one connection for all of it are many.

mod blocks;
mod clock;
mod control;
mod cyclic;
mod exchange;
mod failure;
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
use pending::{Parts, Uploads};
use subscriptions::Subscriptions;

/// The shortest PDU that is agreed.
const SHORTEST_PDU: u16 = 240;
/// The longest PDU that is agreed.
const LONGEST_PDU: u16 = 960;
/// The longest request that is put together before it is judged; whoever sends more is disconnected.
const LONGEST_REQUEST: usize = 4096;
/// The longest packet that is waited for: a TPDU of 8192 bytes.
const LONGEST_PACKET: usize = 8192 + tpkt::HEADER;

/// What a server offers each client.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The longest PDU that is agreed, 240 to 960.
    pub longest_pdu: u16,
    /// How many requests of a client may be on their way at once.
    pub jobs: u16,
    /// Our reference of the connection, not 0.
    pub reference: u16,
    /// The called TSAPs that are accepted; all where there is none.
    pub called: Option<Vec<[u8; 2]>>,
    /// How often something is sent by itself at most, whatever the client asked for.
    pub shortest_interval: Time,
}

impl Default for Settings {
    fn default() -> Self {
        Self { longest_pdu: LONGEST_PDU, jobs: 8, reference: 1, called: None, shortest_interval: Time::from_millis(50) }
    }
}

/// Whether the connection goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Connection {
    /// It does.
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
    /// The slot of the module that was called: 2 PLC, 3 and 4 NCK.
    slot: u8,
    budget: Budget,
    /// A packet that is not whole yet.
    input: Vec<u8>,
    /// The pieces of a PDU that is not whole yet.
    pieces: Vec<u8>,
    /// Space for NC variables.
    scratch: Vec<u8>,
    knows_password: bool,
    sequence: u8,
    parts: Parts,
    uploads: Uploads,
    subscriptions: Subscriptions,
    failure: Option<Failure>,
    /// Requests to read or write so far, on this connection and those before it.
    requests: u64,
}

impl Session {
    /// A session with a client that has just come.
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
            sequence: 0,
            parts: Parts::default(),
            uploads: Uploads::default(),
            subscriptions: Subscriptions::default(),
            failure: None,
            requests: 0,
        }
    }

    /// The negotiated length of a PDU.
    #[must_use]
    pub fn pdu_length(&self) -> usize {
        self.budget.pdu
    }

    /// Whether something is to be sent by itself, so that [`Session::tick`] is needed.
    #[must_use]
    pub fn has_subscriptions(&self) -> bool {
        !self.subscriptions.is_empty()
    }

    /// Refuses the next request to read or write; `None` takes that back.
    pub fn fail_next(&mut self, failure: Option<Failure>) {
        self.failure = failure;
    }

    /// How many requests to read or write there were, refused on purpose or not; a request in several pieces is one.
    #[must_use]
    pub fn requests(&self) -> u64 {
        self.requests
    }

    /// Takes bytes as they came from the socket, in whatever pieces, and appends the answers to whole requests, in order.
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

    /// Sends what is due by now: values in cycles and values that changed. Time is any time that does not go back.
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

    /// A second request on the same connection begins anew.
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

    /// Puts a PDU together. A piece without bytes changes nothing: some clients send one behind every request.
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
            // Pieces are rare, and a client that sent some once keeps no space for more.
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
            kind::ACK | kind::ACK_DATA => {} // an acknowledgement asks for nothing
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
            // Blocks come from the PLC image; nobody may load others.
            function::REQUEST_DOWNLOAD | function::DOWNLOAD | function::END_DOWNLOAD => {
                exchange.refuse(ErrorCode::PROTECTED);
            }
            _ => exchange.refuse(ErrorCode::NOT_IMPLEMENTED),
        }
    }

    /// Setup communication: how many jobs at once, and how long a PDU may be. It may be said again at any time.
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
        // What was begun for another PDU might not fit this one.
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

    /// Numbers of sequences and of jobs, 1 to 255.
    fn next_sequence(&mut self) -> u8 {
        self.sequence = self.sequence.checked_add(1).unwrap_or(1);
        self.sequence
    }
}

/// Whether what is begun here would become longer than any packet that is taken.
fn is_too_long(bytes: &[u8]) -> bool {
    matches!(bytes, [_, _, high, low, ..] if usize::from(u16::from_be_bytes([*high, *low])) > LONGEST_PACKET)
}
