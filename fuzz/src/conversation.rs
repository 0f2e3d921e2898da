//! A conversation between a client that sends any bytes and a session over a real memory, with time and steps in between.
//!
//! ```text
//! first byte          the machine: bit 0 an 828D, bit 1 read only, bits 2 and 3 protection level 1, 2 or 3
//! FE ED nn            nn hundredths of a second pass, then a step takes up what was written
//! everything else     bytes from the client
//! ```
//! The same bytes are processed three times: packet by packet, with each answer judged; everything at once between two steps; and in small
//! pieces. All three runs must give the same answers and the same writes.

use std::borrow::Cow;

use opennck::image::{Bytes, DataBlock, Memory, Names, Profile};
use opennck::s7::{
    Answers, Bridge, Command, Connection, CpuState, DateAndTime, Diagnosis, Directory, Machinery, Protection, Session,
    Settings,
};
use opennck::units::{AxisNumber, ChannelNumber, Time};
use opennck::variables::nc::{Datum, MachineData};
use opennck::variables::{Place, Variables};

use super::oracle::{Expected, Listener, Shadow, packet_length};

/// Marks a pause.
pub const PAUSE: [u8; 2] = [0xFE, 0xED];
/// Memory limit of a session at its end, and for the answer to one packet.
const MEMORY: u64 = 192 * 1024;
/// Maximum number of allocations for one packet: slow code usually allocates often, and the machine waits meanwhile.
const ALLOCATIONS: u64 = 4000;
/// Maximum number of pushes of a session at once.
const PUSHES: usize = 32;

/// The environment of a session.
struct World {
    memory: Memory,
    names: Names,
    directory: Directory,
    variables: Variables,
    diagnosis: Vec<Diagnosis>,
}

/// The rights of a client.
#[derive(Clone, Copy)]
struct Rights {
    is_read_only: bool,
    protection: Protection,
}

thread_local! {
    static WORLDS: [World; 2] = [Profile::SINUMERIK_840D_SL, Profile::SINUMERIK_828D].map(World::new);
}

impl World {
    fn new(profile: Profile) -> Self {
        let mut memory = Memory::new();
        let patterned = |length: usize, seed: usize| {
            (0..length).map(|at| ((at * 7 + at / 256 + seed) % 256).try_into().unwrap_or(0)).collect()
        };
        for (number, length) in [(1000, 2048), (1001, 7)] {
            let bytes: Vec<u8> = patterned(length, number.into());
            memory.blocks.put(DataBlock { number, name: None, bytes: Bytes::from(bytes) });
        }
        let flags: Vec<u8> = patterned(256, 0);
        memory.flags.copy_from_slice(&flags);
        let mut names = Names { profile, ..Names::default() };
        for (number, name) in AxisNumber::all().zip(["X", "Y", "XF"]) {
            names.axes[number] = Some(name.to_owned());
        }
        names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
        let directory = Directory::of(&memory, profile);
        let entry = Diagnosis { event: 0x4302, information: [0; 10], time: DateAndTime::FIRST };
        Self { memory, names, directory, variables: Variables::default(), diagnosis: vec![entry; 10] }
    }
}

/// Some machine data of every kind.
struct Data;

impl MachineData for Data {
    fn datum(&self, _place: Place, number: u16, index: u16) -> Option<Datum<'_>> {
        Some(match (number, index) {
            (10000, 0..31) => Datum::Text("X1"),
            (10050, 0) => Datum::Number(0.002),
            (11410, 0) => Datum::Whole(-1),
            (30130, 0) => Datum::Byte(1),
            (37100, 0) => Datum::Boolean(true),
            _ => return None,
        })
    }
}

/// The result of a conversation: answers and commands between every two steps.
#[derive(Debug, Default, PartialEq)]
struct Record {
    answers: Vec<Vec<u8>>,
    commands: Vec<Vec<Command>>,
    ended: Option<usize>,
}

/// One run of a conversation.
struct Run<'a> {
    world: &'a World,
    rights: Rights,
    session: Session,
    memory: Cow<'a, Memory>,
    state: CpuState,
    clock: DateAndTime,
    now: i64,
    /// Since the last step.
    commands: Vec<Command>,
}

impl<'a> Run<'a> {
    fn new(world: &'a World, rights: Rights) -> Self {
        Self {
            world,
            rights,
            session: Session::new(Settings::default()),
            memory: Cow::Borrowed(&world.memory),
            state: CpuState::Run,
            clock: DateAndTime { year: 2026, month: 11, day: 22, hour: 3, minute: 4, second: 5, millisecond: 678 },
            now: 0,
            commands: Vec::new(),
        }
    }

    fn with<R>(&mut self, work: impl FnOnce(&mut Session, &mut Bridge<'_>) -> R) -> R {
        let world = self.world;
        let machinery = Machinery {
            state: self.state,
            clock: self.clock,
            protection: self.rights.protection,
            diagnosis: &world.diagnosis,
            is_read_only: self.rights.is_read_only,
            machine_data: Some(&Data),
            ..Machinery::default()
        };
        let mut bridge = Bridge::new(&self.memory, &world.variables, &world.names, &world.directory).with(machinery);
        let result = work(&mut self.session, &mut bridge);
        self.commands.extend(bridge.into_commands());
        result
    }

    fn receive(&mut self, bytes: &[u8], answers: &mut Answers) -> Connection {
        self.with(|session, bridge| session.receive(bytes, bridge, answers))
    }

    /// Advances time, and the machine executes the commands.
    fn step(&mut self, hundredths: u8, answers: &mut Answers) -> Vec<Command> {
        let commands = std::mem::take(&mut self.commands);
        for command in &commands {
            match *command {
                Command::Write { location, value } => self.memory.to_mut().write(location, value),
                Command::PlcStop => self.state = CpuState::Stop,
                Command::PlcStart(_) => self.state = CpuState::Run,
                Command::SetClock(time) => self.clock = time,
                Command::MachineDatum { .. } | Command::RParameter { .. } => {}
            }
        }
        self.now += i64::from(hundredths) * 10;
        let now = Time::from_millis(self.now);
        self.with(|session, bridge| session.tick(now, bridge, answers));
        commands
    }
}

/// Bytes of the client between two steps, and the hundredths of a second after them.
fn parts(input: &[u8]) -> Vec<(&[u8], u8)> {
    let (mut parts, mut rest) = (Vec::new(), input);
    while let Some(at) = rest.windows(3).position(|bytes| bytes[..2] == PAUSE) {
        parts.push((&rest[..at], rest[at + 2]));
        rest = &rest[at + 3..];
    }
    parts.push((rest, 10));
    parts
}

/// Runs the conversation and judges every answer.
///
/// # Panics
/// The session violated the rules.
pub fn judge(input: &[u8]) {
    let Some((machine, stream)) = input.split_first() else { return };
    let level = (machine >> 2 & 3) % 3 + 1;
    let protection = Protection { level, password: (level > 1).then_some(*b"OPENNCK!") };
    let rights = Rights { is_read_only: machine & 2 != 0, protection };
    let parts = parts(stream);
    WORLDS.with(|worlds| {
        let world = &worlds[usize::from(machine & 1)];
        let judged = judged(world, rights, &parts);
        let whole = run(world, rights, &parts, |_| usize::MAX);
        assert_eq!(judged, whole, "everything at once differs from packet by packet");
        let mut seed = stream.iter().fold(1_u32, |seed, byte| seed.wrapping_mul(31).wrapping_add((*byte).into()));
        let pieces = run(world, rights, &parts, |length| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if length <= 300 { 1 } else { (seed >> 24) as usize % 50 + 1 }
        });
        assert_eq!(judged, pieces, "small pieces differ from packet by packet");
    });
}

/// Runs it in pieces whose lengths `cut` returns.
fn run(world: &World, rights: Rights, parts: &[(&[u8], u8)], mut cut: impl FnMut(usize) -> usize) -> Record {
    let (mut telling, mut record) = (Run::new(world, rights), Record::default());
    for (index, &(bytes, hundredths)) in parts.iter().enumerate() {
        let mut answers = Answers::default();
        let mut rest = bytes;
        while !rest.is_empty() && record.ended.is_none() {
            let (piece, others) = rest.split_at(cut(bytes.len()).min(rest.len()));
            if telling.receive(piece, &mut answers) == Connection::Closed {
                record.ended = Some(index);
            }
            rest = others;
        }
        let commands = telling.step(hundredths, &mut answers);
        record.answers.push(answers.bytes().to_vec());
        record.commands.push(commands);
    }
    record
}

/// Runs it packet by packet and judges each answer.
fn judged(world: &World, rights: Rights, parts: &[(&[u8], u8)]) -> Record {
    let (mut telling, mut record) = (Run::new(world, rights), Record::default());
    let mut listener = Listener::new(shadow(&world.memory));
    // Bytes of an incomplete packet.
    let mut begun = Vec::new();
    for (index, &(bytes, hundredths)) in parts.iter().enumerate() {
        let mut rest = bytes;
        let mut all = Vec::new();
        while !rest.is_empty() && record.ended.is_none() {
            let stream = [&begun, rest].concat();
            let whole = packet_length(&stream).map(|length| length.filter(|length| *length <= stream.len()));
            let (end, expected) = match whole {
                Ok(Some(length)) => (length - begun.len(), listener.hear(&stream[..length])),
                Ok(None) => (rest.len(), Expected::Silence),
                Err(()) => (rest.len(), Expected::End),
            };
            let (piece, others) = rest.split_at(end);
            let mut answers = Answers::default();
            let before = telling.commands.len();
            let mut connection = Connection::Open;
            let used = allocation_counter::measure(|| connection = telling.receive(piece, &mut answers));
            assert!(used.bytes_max <= MEMORY, "{} bytes for one packet", used.bytes_max);
            assert!(used.count_total <= ALLOCATIONS, "{} allocations for one packet", used.count_total);
            let has_ended = connection == Connection::Closed;
            let each: Vec<&[u8]> = answers.iter().collect();
            assert_eq!(each.concat(), answers.bytes());
            listener.judge(&expected, &each, has_ended);
            if has_ended {
                record.ended = Some(index);
            }
            let has_asked = telling.commands.len() > before;
            assert!(!has_asked || listener.is_set_up() && !rights.is_read_only, "this client may not change anything");
            all.extend_from_slice(answers.bytes());
            begun = if whole.is_ok_and(|length| length.is_some()) { Vec::new() } else { stream };
            rest = others;
        }
        let mut answers = Answers::default();
        let had = telling.session.has_subscriptions();
        record.commands.push(telling.step(hundredths, &mut answers));
        assert!(answers.count() <= if had && record.ended.is_none() { PUSHES } else { 0 });
        answers.iter().for_each(|answer| listener.judge_push(answer));
        all.extend_from_slice(answers.bytes());
        record.answers.push(all);
        let shadow = shadow(&telling.memory);
        assert!(&shadow == listener.step(), "what was acknowledged is there at the next step, and nothing else");
    }
    let Run { session, .. } = telling;
    let freed = allocation_counter::measure(|| drop(session)).bytes_current.unsigned_abs();
    assert!(freed <= MEMORY, "a session held {freed} bytes");
    record
}

fn shadow(memory: &Memory) -> Shadow {
    let blocks = memory.blocks.iter().map(|block| (block.number, block.bytes.to_vec()));
    std::iter::once((0, memory.flags.to_vec())).chain(blocks).collect()
}
