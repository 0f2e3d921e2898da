//! The soak: clients of all kinds at a moderate rate for a long time; the server's memory and handles must not grow. Every answer is
//! checked: its reference, that nothing was refused, and that written values are read back.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::load::{BLOCK, CONNECT, setup};
use crate::servers::Server;

/// The offset of the clients' own bytes in the block, and their number.
const OWN: u16 = 1024;
const OWN_BYTES: u16 = 32;
/// Interval of the measurements.
const LOOK: Duration = Duration::from_secs(10);
/// One of this many measurements is printed.
const SHOWN: u32 = 6;

/// The sum of all clients' activity.
#[derive(Default)]
struct Done {
    requests: AtomicU64,
    pushes: AtomicU64,
    connections: AtomicU64,
    failures: AtomicU64,
}

/// One measurement of the server.
#[derive(Clone, Copy)]
struct Look {
    memory: u64,
    handles: usize,
}

/// Runs the soak; returns whether the server did not grow.
pub(crate) fn run(server: &Server, clients: u16, time: Duration, rate: f64) -> bool {
    let (done, ended) = (Done::default(), AtomicBool::new(false));
    let pause = Duration::from_secs_f64(f64::from(clients) / rate);
    println!("soak: {clients} clients, {rate} requests/s, {} s", time.as_secs());
    let mut looks = Vec::new();
    std::thread::scope(|scope| {
        for number in 0..clients {
            let (done, ended) = (&done, &ended);
            scope.spawn(move || {
                let mut chance = Chance(u64::from(number) + 1);
                while !ended.load(Ordering::Relaxed) {
                    if let Err(error) = converse(server.address, number, &mut chance, pause, done, ended) {
                        println!("client {number}: {error}");
                        done.failures.fetch_add(1, Ordering::Relaxed);
                        std::thread::sleep(Duration::from_millis(100));
                    }
                }
            });
        }
        let begin = Instant::now();
        while begin.elapsed() < time {
            std::thread::sleep(LOOK.min(time - begin.elapsed().min(time)));
            looks.push(Look { memory: server.memory(), handles: server.handles() });
            if looks.len().is_multiple_of(SHOWN as usize) {
                show(begin.elapsed(), &looks[looks.len() - 1], &done);
            }
        }
        ended.store(true, Ordering::Relaxed);
    });
    judge(&looks, &done)
}

fn show(elapsed: Duration, look: &Look, done: &Done) {
    let count = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
    println!(
        "{:5} s  memory {} KiB  handles {}  requests {}  pushes {}  connections {}  failures {}",
        elapsed.as_secs(),
        look.memory / 1024,
        look.handles,
        count(&done.requests),
        count(&done.pushes),
        count(&done.connections),
        count(&done.failures)
    );
}

/// The last quarter must not need more than the second: continuous growth would show between them.
fn judge(looks: &[Look], done: &Done) -> bool {
    let quarter = looks.len() / 4;
    if quarter == 0 {
        println!("soak: too short to judge");
        return false;
    }
    let most = |looks: &[Look]| {
        let memory = looks.iter().map(|look| look.memory).max().unwrap_or(0);
        (memory / 1024, looks.iter().map(|look| look.handles).max().unwrap_or(0))
    };
    let (early, late) = (most(&looks[quarter..2 * quarter]), most(&looks[looks.len() - quarter..]));
    let failures = done.failures.load(Ordering::Relaxed);
    // The memory of an allocator varies by some pages; a leak of one byte per request would be about 3 MiB in a quarter of an hour.
    let is_good = late.0 <= early.0 + 512 && late.1 <= early.1 + 8 && failures == 0;
    println!(
        "soak: most memory in the second quarter {} KiB, in the last {} KiB; most handles {} and {}; {failures} failures: {}",
        early.0,
        late.0,
        early.1,
        late.1,
        if is_good { "no growth" } else { "FAILED" }
    );
    is_good
}

/// Pseudo-random numbers, the same in every run.
struct Chance(u64);

impl Chance {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }
}

/// One client.
struct Client<'a> {
    stream: TcpStream,
    reference: u16,
    done: &'a Done,
}

/// One connection, from its beginning to its end.
fn converse(
    address: SocketAddr,
    number: u16,
    chance: &mut Chance,
    pause: Duration,
    done: &Done,
    ended: &AtomicBool,
) -> io::Result<()> {
    let stream = TcpStream::connect(address)?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(Duration::from_secs(5)))?;
    done.connections.fetch_add(1, Ordering::Relaxed);
    let mut client = Client { stream, reference: 0, done };
    client.stream.write_all(&CONNECT)?;
    client.packet()?;
    client.stream.write_all(&setup([240, 480, 960][usize::from(number % 3)]))?;
    client.packet()?;
    let mut is_subscribed = false;
    for _ in 0..200 + chance.below(600) {
        if ended.load(Ordering::Relaxed) {
            return Ok(());
        }
        match chance.below(20) {
            0..10 => {
                let length = [1, 2, 17, 60, 222][usize::try_from(chance.below(5)).unwrap_or(0)];
                client.read(u16::try_from(chance.below(800)).unwrap_or(0), length)?;
            }
            10..14 => {
                let own = OWN + number * OWN_BYTES;
                let value = u8::try_from(chance.below(256)).unwrap_or(0);
                let length = 2 + 2 * u16::try_from(chance.below(14)).unwrap_or(0);
                client.write(own, &vec![value; length.into()])?;
                if client.read(own, length)?.iter().any(|found| *found != value) {
                    return Err(io::Error::other("a written value was not read back"));
                }
            }
            14 => client.user_data(4, 1, &[0, 0x11, 0, 0])?,
            15 => client.user_data(4, 1, &[4, 0x24, 0, 0])?,
            16 => client.user_data(7, 1, &[])?,
            17 => client.upload()?,
            18 if !is_subscribed => {
                // MB0 every 100 ms.
                client.user_data(2, 1, &[0, 1, 0, 1, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0])?;
                is_subscribed = true;
            }
            18 => {
                client.user_data(2, 4, &[0, 0])?;
                is_subscribed = false;
            }
            // A client that sends an incomplete request and closes.
            _ => TcpStream::connect(address)?.write_all(&CONNECT[..usize::from(number % 20) + 1])?,
        }
        std::thread::sleep(pause);
    }
    Ok(())
}

impl Client<'_> {
    /// The next packet that is not a push.
    fn packet(&mut self) -> io::Result<Vec<u8>> {
        loop {
            let mut packet = vec![0; 4];
            self.stream.read_exact(&mut packet)?;
            packet.resize(usize::from(u16::from_be_bytes([packet[2], packet[3]])).max(4), 0);
            self.stream.read_exact(&mut packet[4..])?;
            // User data of the group "cyclic" without a request: a push, type 0.
            if packet.get(8) == Some(&7) && packet.get(22) == Some(&0x02) {
                self.done.pushes.fetch_add(1, Ordering::Relaxed);
                continue;
            }
            return Ok(packet);
        }
    }

    /// Sends a request, and returns the PDU of the answer.
    fn ask(&mut self, kind: u8, parameter: &[u8], data: &[u8]) -> io::Result<Vec<u8>> {
        self.reference = self.reference.wrapping_add(1);
        let length = |bytes: usize| u16::try_from(bytes).unwrap_or(0).to_be_bytes();
        let mut packet = vec![3, 0];
        packet.extend(length(17 + parameter.len() + data.len()));
        packet.extend([2, 0xF0, 0x80, 0x32, kind, 0, 0]);
        packet.extend(self.reference.to_be_bytes());
        packet.extend(length(parameter.len()));
        packet.extend(length(data.len()));
        packet.extend_from_slice(parameter);
        packet.extend_from_slice(data);
        self.stream.write_all(&packet)?;
        let answer = self.packet()?;
        self.done.requests.fetch_add(1, Ordering::Relaxed);
        let is_good = answer.get(11..13) == Some(&self.reference.to_be_bytes())
            && (kind == 7 || answer.get(17..19) == Some(&[0, 0]));
        if is_good { Ok(answer[7..].to_vec()) } else { Err(wrong(&packet, &answer)) }
    }

    fn read(&mut self, at: u16, length: u16) -> io::Result<Vec<u8>> {
        let parameter = [&[4, 1][..], &item(at, length)].concat();
        let answer = self.ask(1, &parameter, &[])?;
        if answer.get(14) != Some(&0xFF) || answer.len() != 18 + usize::from(length) {
            return Err(wrong(&parameter, &answer));
        }
        Ok(answer[18..].to_vec())
    }

    fn write(&mut self, at: u16, bytes: &[u8]) -> io::Result<()> {
        let length = u16::try_from(bytes.len()).unwrap_or(0);
        let [high, low] = (8 * length).to_be_bytes();
        let parameter = [&[5, 1][..], &item(at, length)].concat();
        let answer = self.ask(1, &parameter, &[&[0, 4, high, low][..], bytes].concat())?;
        if answer.get(14..) == Some(&[0xFF]) { Ok(()) } else { Err(wrong(&parameter, &answer)) }
    }

    fn user_data(&mut self, group: u8, function: u8, payload: &[u8]) -> io::Result<()> {
        let [high, low] = u16::try_from(payload.len()).unwrap_or(0).to_be_bytes();
        let head = if payload.is_empty() { [0x0A, 0, 0, 0] } else { [0xFF, 9, high, low] };
        let parameter = [0, 1, 0x12, 4, 0x11, 0x40 | group, function, 0];
        let answer = self.ask(7, &parameter, &[&head[..], payload].concat())?;
        if answer.get(20..22) == Some(&[0, 0]) { Ok(()) } else { Err(wrong(&parameter, &answer)) }
    }

    /// The whole block.
    fn upload(&mut self) -> io::Result<()> {
        let start = format!("_0A{BLOCK:05}A");
        let name = [&[0x1D, 0, 0, 0, 0, 0, 0, 0, 9][..], start.as_bytes()].concat();
        let begun = self.ask(1, &name, &[])?;
        let number = begun.get(19).copied().unwrap_or(0);
        while self.ask(1, &[0x1E, 0, 0, 0, 0, 0, 0, number], &[])?.get(13) == Some(&1) {}
        self.ask(1, &[0x1F, 0, 0, 0, 0, 0, 0, number], &[]).map(|_| ())
    }
}

/// Bytes of the block.
fn item(at: u16, length: u16) -> [u8; 12] {
    let ([high, low], [block_high, block_low]) = (length.to_be_bytes(), BLOCK.to_be_bytes());
    let [_, a, b, c] = (8 * u32::from(at)).to_be_bytes();
    [0x12, 10, 0x10, 2, high, low, block_high, block_low, 0x84, a, b, c]
}

fn wrong(request: &[u8], answer: &[u8]) -> io::Error {
    io::Error::other(format!("{request:02X?} was answered by {answer:02X?}"))
}
