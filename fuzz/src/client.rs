//! A client of S7 communication whose server sends arbitrary bytes, without a socket and without a clock.
//!
//! ```text
//! first byte          bits 0 to 3 what is asked, bit 4 whether the opening is in the input, too, bit 5 whether with a password
//! second byte         bits 0 to 3 what is asked at the same time
//! FE ED               the server waits for the client: until it has asked something, or does nothing more
//! everything else     bytes from the server; FF FF where a reference stands is the reference of the last request
//! ```
//! When the input ends the server closes the connection. What is judged: no panic; every question gets an end; a value is in the bytes
//! that came, as it came; requests are whole packets and not without end; memory within what the questions need and the bytes that came.

use std::cell::{Cell, RefCell};
use std::panic::{set_hook, take_hook};
use std::sync::Once;
use std::time::Duration;

use opennck::s7::client::{BlockKind, Client, Error, Mode, Options, Value, Variable};
use opennck::s7::{DateAndTime, Restart};
use tokio::io::{AsyncReadExt, AsyncWriteExt, DuplexStream, duplex};
use tokio::runtime::{Builder, Runtime};
use tokio::task::yield_now;

use super::conversation::PAUSE;

/// Memory of an idle client: its task, its input buffer, and its requests.
const MEMORY: u64 = 160 * 1024;
/// Memory for each received byte: kept in a list, reassembled, and grown by doubling.
const FOR_EACH_BYTE: u64 = 48;
/// Maximum number of packets from a client, per packet from the server, and without any.
const PACKETS: (usize, usize) = (16, 64);
/// A value of this many bytes is requested at once, whatever PDU was negotiated.
const WHOLE: usize = 32;
/// How often other tasks get their turn before the server continues.
const TURNS: usize = 24;
/// The negotiated values if the opening is not in the input: two jobs, a PDU of 240 bytes.
const OPENING: [&[u8]; 2] = [
    &[3, 0, 0, 22, 17, 0xD0, 0, 1, 0, 7, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2],
    &[3, 0, 0, 27, 2, 0xF0, 0x80, 0x32, 3, 0, 0, 0, 1, 0, 8, 0, 0, 0, 0, 0xF0, 0, 0, 2, 0, 2, 0, 0xF0],
];

thread_local! {
    static RUNTIME: Runtime = Builder::new_current_thread().enable_time().build().expect("it needs nothing");
    static HAS_PANICKED: Cell<bool> = const { Cell::new(false) };
}

/// A panic in a task is not reported to its creator: a hook records it.
fn listen_for_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let known = take_hook();
        set_hook(Box::new(move |panic| {
            HAS_PANICKED.set(true);
            known(panic);
        }));
    });
}

/// Sends requests, receives the answers of the input, and judges; returns the number of requests without an error.
///
/// # Panics
/// The client violated the rules.
pub fn judge(input: &[u8]) -> usize {
    let &[first, second, ref said @ ..] = input else { return 0 };
    listen_for_panics();
    HAS_PANICKED.set(false);
    let is_opened = first & 0x10 != 0;
    let heard = RefCell::new(Vec::new());
    let mut good = 0;
    let used = allocation_counter::measure(|| {
        RUNTIME.with(|runtime| {
            runtime.block_on(async {
                let (near, far) = duplex(64 * 1024);
                let server = Server { stream: far, requests: Vec::new(), packets: 0, heard: &heard };
                good = tokio::join!(server.say(said, is_opened), ask(near, [first, second], &heard)).1;
            });
        });
    });
    assert!(!HAS_PANICKED.get(), "a task of the client panicked");
    let came = heard.borrow().len() as u64;
    let limit = MEMORY + FOR_EACH_BYTE * came;
    assert!(used.bytes_max <= limit, "{} bytes for {came} that came", used.bytes_max);
    good
}

struct Server<'a> {
    stream: DuplexStream,
    /// Bytes of an incomplete packet from the client.
    requests: Vec<u8>,
    packets: usize,
    /// Everything that was sent.
    heard: &'a RefCell<Vec<u8>>,
}

impl Server<'_> {
    /// Sends everything and closes.
    async fn say(mut self, said: &[u8], is_opened: bool) {
        let opening = if is_opened { &[][..] } else { &OPENING[..] };
        for part in opening {
            self.wait().await;
            self.send(part).await;
        }
        let mut reference = self.wait().await;
        let mut rest = said;
        let mut parts = 0;
        while !rest.is_empty() {
            let end = rest.windows(2).position(|bytes| bytes == PAUSE).unwrap_or(rest.len());
            let mut part = rest[..end].to_vec();
            // After TPKT, DT and the first four bytes of the header.
            for at in 0..part.len() {
                if part[at..].starts_with(&[3, 0]) && part.get(at + 11..at + 13) == Some(&[0xFF, 0xFF]) {
                    part[at + 11..at + 13].copy_from_slice(&reference);
                }
            }
            self.send(&part).await;
            reference = self.wait().await;
            parts += 1;
            rest = rest.get(end + 2..).unwrap_or_default();
        }
        let most = PACKETS.1 + PACKETS.0 * (parts + said.len() / 7);
        assert!(self.packets <= most, "{} packets to {parts} times something", self.packets);
    }

    async fn send(&mut self, bytes: &[u8]) {
        self.heard.borrow_mut().extend_from_slice(bytes);
        let _ = self.stream.write_all(bytes).await; // the client may have closed
    }

    /// Waits until the client is idle, and takes its requests; returns the reference of the last request.
    async fn wait(&mut self) -> [u8; 2] {
        let mut reference = [0, 0];
        let mut turns = 0;
        while turns < TURNS {
            yield_now().await;
            turns += 1;
            let mut bytes = [0; 4096];
            let count = tokio::select! {
                biased;
                read = self.stream.read(&mut bytes) => read.unwrap_or(0),
                () = std::future::ready(()) => 0,
            };
            if count > 0 {
                turns = 0;
                self.requests.extend_from_slice(&bytes[..count]);
            }
            while let Some(&[3, 0, high, low, ref packet @ ..]) = Some(self.requests.as_slice()) {
                let length = usize::from(u16::from_be_bytes([high, low]));
                assert!(length >= 7, "a packet of {length} bytes");
                if self.requests.len() < length {
                    break;
                }
                if let Some(&[high, low]) = packet.get(7..9) {
                    reference = [high, low];
                }
                self.packets += 1;
                self.requests.drain(..length);
            }
            assert!(self.requests.first().is_none_or(|first| *first == 3), "a client sends whole packets");
        }
        reference
    }
}

async fn ask(stream: DuplexStream, questions: [u8; 2], heard: &RefCell<Vec<u8>>) -> usize {
    let (minute, options) =
        (Duration::from_mins(1), Options { timeout: Duration::from_hours(1), ..Options::default() });
    let options = Options { password: (questions[0] & 0x20 != 0).then_some(*b"OPENNCK!"), patience: minute, ..options };
    let Ok(client) = Client::over(stream, options).await else { return 0 };
    let [first, second] = questions.map(|question| question & 15);
    let (first, second) = tokio::join!(question(&client, first, heard), question(&client, second, heard));
    first + second
}

/// Sends one request.
async fn question(client: &Client, number: u8, heard: &RefCell<Vec<u8>>) -> usize {
    fn count<T>(result: &Result<T, Error>) -> usize {
        usize::from(result.is_ok())
    }
    match number {
        0 => values(client, &["MB0", "DB1.DBD0:REAL", "M1.1", "MW0..4", "T1", "DB10.DBX1.2..4"], heard).await,
        1 => values(client, &["MB0..500", "DB1.DBB2"], heard).await,
        2 => values(client, &["nck:C/SMA/1[1..3]", "nck:C/State/actToolIdent"], heard).await,
        3 => values(client, &["nck:A1/M/32000:DOUBLE", "nck:C/RP/1[5]", "nck:V/16#80/30:REAL"], heard).await,
        4 => {
            let writes = [(variable("MB1"), Value::Byte(1)), (variable("M1.1"), Value::Bit(true))];
            client.write_all(&writes).await.iter().map(count).sum()
        }
        5 => count(&client.write(&variable("nck:A1/M/32000:DOUBLE"), &Value::Double(1.5)).await),
        6 => count(&client.list(0x11, 0).await),
        7 => count(&client.identification().await) + count(&client.protection().await),
        8 => count(&client.cpu_state().await) + count(&client.clock().await),
        9 => count(&client.set_clock(DateAndTime::FIRST).await) + count(&client.give_password(*b"secret  ").await),
        10 => count(&client.stop_plc().await) + count(&client.start_plc(Restart::Cold).await),
        11 => count(&client.block_counts().await) + count(&client.blocks(BlockKind::Db).await),
        12 => count(&client.describe_block(BlockKind::Db, 1).await),
        13 => count(&client.upload(BlockKind::Db, 1).await),
        14 => listen(client, &["MB0", "MW2"], Mode::Cycle).await,
        _ => listen(client, &["nck:C/SMA/1[1..3]", "M1.1"], Mode::Change).await,
    }
}

fn variable(text: &str) -> Variable {
    text.parse().expect("it is a variable")
}

async fn values(client: &Client, texts: &[&str], heard: &RefCell<Vec<u8>>) -> usize {
    let variables: Vec<Variable> = texts.iter().map(|text| variable(text)).collect();
    let values = client.read_all(&variables).await;
    assert_eq!(values.len(), variables.len());
    let came = pieces(&heard.borrow());
    values.iter().flatten().map(|value| judge_value(value, &came)).count()
}

async fn listen(client: &Client, texts: &[&str], mode: Mode) -> usize {
    let variables: Vec<Variable> = texts.iter().map(|text| variable(text)).collect();
    let Ok(mut values) = client.subscribe(&variables, mode, Duration::from_millis(100)).await else { return 0 };
    let mut good = 0;
    while let Some(update) = values.next().await {
        good += usize::from(update.is_ok());
    }
    good
}

/// The pieces of S7 PDUs in a stream, one after another.
fn pieces(mut stream: &[u8]) -> Vec<u8> {
    let mut pieces = Vec::new();
    while let &[3, _, high, low, indicator, ..] = stream {
        let (length, start) = (usize::from(u16::from_be_bytes([high, low])), 5 + usize::from(indicator));
        pieces.extend_from_slice(stream.get(start..length).unwrap_or_default());
        stream = stream.get(length.max(1)..).unwrap_or_default();
    }
    pieces
}

/// The bytes of a value must appear consecutively, forward or reversed; long values may have been assembled from several answers.
fn judge_value(value: &Value, came: &[u8]) {
    let judge = |bytes: &[u8]| {
        let backwards: Vec<u8> = bytes.iter().rev().copied().collect();
        let has_come = came.windows(bytes.len().max(1)).any(|window| window == bytes || window == backwards);
        assert!(has_come || bytes.is_empty(), "{bytes:02X?} did not come");
    };
    match value {
        Value::Byte(value) => judge(&[*value]),
        Value::Word(value) => judge(&value.to_be_bytes()),
        Value::DoubleWord(value) => judge(&value.to_be_bytes()),
        Value::Int(value) => judge(&value.to_be_bytes()),
        Value::DoubleInt(value) => judge(&value.to_be_bytes()),
        Value::Real(value) => judge(&value.to_be_bytes()),
        Value::Double(value) => judge(&value.to_be_bytes()),
        Value::Bytes(bytes) if bytes.len() <= WHOLE => judge(bytes),
        Value::Bytes(bytes) => bytes.chunks(1).for_each(judge),
        Value::List(values) => values.iter().for_each(|value| judge_value(value, came)),
        Value::Bit(_) | Value::Text(_) => {}
    }
}
