//! The load: connections that send the next request as soon as they are answered, with several requests in flight each. One thread, one
//! epoll, the same for every server.

use std::io::{self, ErrorKind, Read, Write};
use std::net::SocketAddr;
use std::time::{Duration, Instant};

use mio::net::TcpStream;
use mio::{Events, Interest, Poll, Token};

/// The block that is read, and the number of bytes.
pub(crate) const BLOCK: u16 = 1000;
pub(crate) const BYTES: usize = 222;
/// Bytes of a request and of its answer: TPKT 4, COTP 3, and 10 + 14 of the job; 12 + 2 + 4 before the values.
pub(crate) const REQUEST: usize = 31;
pub(crate) const ANSWER: usize = 25 + BYTES;
/// The bytes before the values in an answer, from the function on: read, one item, success, in bits, 222 · 8.
const HEAD: [u8; 6] = [4, 1, 0xFF, 4, 0x06, 0xF0];

/// The connection request of most clients, to rack 0 slot 2; its confirm is as long.
pub(crate) const CONNECT: [u8; 22] = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
/// Setup communication; and the length of its answer.
pub(crate) fn setup(pdu: u16) -> [u8; 25] {
    let [high, low] = pdu.to_be_bytes();
    [3, 0, 0, 25, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, 0, 8, 0, 0, 0xF0, 0, 0, 8, 0, 8, high, low]
}
const SET_UP: usize = 27;

/// The read of the block.
pub(crate) fn request() -> [u8; REQUEST] {
    let [high, low] = BLOCK.to_be_bytes();
    let length = BYTES.to_be_bytes()[7];
    [
        3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 2, 0, 14, 0, 0, 4, 1, 0x12, 10, 0x10, 2, 0, length, high, low,
        0x84, 0, 0, 0,
    ]
}

/// The result of one round.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    pub(crate) per_second: f64,
    /// Latency of the answers in µs: median, 99th and 99.9th percentile.
    pub(crate) p50: f64,
    pub(crate) p99: f64,
    pub(crate) p999: f64,
    pub(crate) answers: u64,
}

/// A connected client, with setup communication if the server uses S7.
pub(crate) fn connect(address: SocketAddr, knows_s7: bool) -> io::Result<std::net::TcpStream> {
    let mut stream = std::net::TcpStream::connect(address)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    if knows_s7 {
        let mut answer = [0; SET_UP];
        stream.write_all(&CONNECT)?;
        stream.read_exact(&mut answer[..CONNECT.len()])?;
        stream.write_all(&setup(240))?;
        stream.read_exact(&mut answer)?;
        let pdu = u16::from_be_bytes([answer[25], answer[26]]);
        if answer[7..9] != [0x32, 3] || pdu != 240 {
            return Err(io::Error::other(format!("expected a PDU of 240 bytes, found {answer:02X?}")));
        }
    }
    Ok(stream)
}

/// One connection of the load.
struct Client {
    stream: TcpStream,
    /// When the requests in flight were sent, in nanoseconds of the round: a ring.
    sent: Vec<u64>,
    first: usize,
    /// Received bytes of an incomplete answer.
    begun: usize,
}

/// Sends requests for a while, with this many connections and requests in flight on each.
pub(crate) fn run(
    address: SocketAddr,
    knows_s7: bool,
    connections: usize,
    in_flight: usize,
    time: Duration,
) -> io::Result<Figures> {
    let mut poll = Poll::new()?;
    let mut clients = Vec::new();
    for number in 0..connections {
        let stream = connect(address, knows_s7)?;
        stream.set_nonblocking(true)?;
        let mut stream = TcpStream::from_std(stream);
        poll.registry().register(&mut stream, Token(number), Interest::READABLE)?;
        clients.push(Client { stream, sent: vec![0; in_flight], first: 0, begun: 0 });
    }
    let requests = request().repeat(in_flight);
    let begin = Instant::now();
    let nanos = || u64::try_from(begin.elapsed().as_nanos()).unwrap_or(u64::MAX);
    for client in &mut clients {
        client.sent.fill(nanos());
        client.stream.write_all(&requests)?;
    }
    let mut events = Events::with_capacity(1024);
    let mut space = vec![0; 64 * 1024];
    let mut took: Vec<u32> = Vec::with_capacity(1 << 20);
    while begin.elapsed() < time {
        poll.poll(&mut events, Some(Duration::from_millis(500)))?;
        for event in &events {
            let client = &mut clients[event.token().0];
            loop {
                let count = match client.stream.read(&mut space) {
                    Ok(0) => return Err(io::Error::other("the server closed the connection")),
                    Ok(count) => count,
                    Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                    Err(error) => return Err(error),
                };
                if knows_s7 && client.begun == 0 && count >= ANSWER && space[19..25] != HEAD {
                    return Err(io::Error::other(format!("expected the block, found {:02X?}", &space[..30])));
                }
                let come = client.begun + count;
                let (answers, now) = (come / ANSWER, nanos());
                client.begun = come % ANSWER;
                for _ in 0..answers {
                    took.push(u32::try_from(now - client.sent[client.first]).unwrap_or(u32::MAX));
                    client.sent[client.first] = now;
                    client.first = (client.first + 1) % in_flight;
                }
                client.stream.write_all(&requests[..answers * REQUEST])?;
                if count < space.len() {
                    break;
                }
            }
        }
    }
    let seconds = begin.elapsed().as_secs_f64();
    took.sort_unstable();
    let at =
        |share: f64| took.get((took.len() as f64 * share) as usize).map_or(f64::NAN, |nanos| f64::from(*nanos) / 1e3);
    Ok(Figures {
        per_second: took.len() as f64 / seconds,
        p50: at(0.5),
        p99: at(0.99),
        p999: at(0.999),
        answers: took.len() as u64,
    })
}
