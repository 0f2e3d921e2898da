//! Tests of S7 communication without a socket. The bytes are written by hand: the layout from RFC 1006, ISO 8073 and the dissector of
//! Wireshark (`packet-s7comm.c`), the requests as sent by snap7's client, python-snap7, pyS7, nodes7, nmap's `s7-info` and collectors of
//! SINUMERIK controls.

mod any_bytes;
mod blocks;
mod cpu;
mod cyclic;
mod defects_of_others;
mod nc_variables;
mod transport;
mod variables;

use proptest::prelude::*;
use proptest::sample::Index;

use super::station::{CpuState, Diagnosis, Protection};
use super::{Answers, Bridge, Command, Connection, DateAndTime, Directory, Machinery, Session, Settings};
use crate::image::{Bytes, DataBlock, Memory, Names, Profile};
use crate::units::{AxisNumber, ChannelNumber, Time};
use crate::variables::Variables;
use crate::variables::nc::{ControlValues, MachineData};

/// Connection request of snap7: TPDU 1024, TSAPs 0100 and 0102.
const CONNECT: &str = "03 00 00 16 11 E0 00 00 00 01 00 C0 01 0A C1 02 01 00 C2 02 01 02";

/// Bytes in hexadecimal.
pub(super) fn bytes(hex: &str) -> Vec<u8> {
    hex.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
}

/// A packet with data: TPKT and DT before an S7 PDU.
pub(super) fn packet(pdu: &[u8]) -> Vec<u8> {
    let length = u16::try_from(pdu.len() + 7).unwrap().to_be_bytes();
    [&[3, 0, length[0], length[1], 2, 0xF0, 0x80], pdu].concat()
}

/// A PDU with some bytes changed, sometimes truncated.
pub(super) fn changed(pdu: impl Strategy<Value = Vec<u8>>) -> impl Strategy<Value = Vec<u8>> {
    let changes = proptest::collection::vec((any::<Index>(), any::<u8>()), 0..4);
    (pdu, changes, any::<Index>(), any::<bool>()).prop_map(|(mut pdu, changes, end, cut)| {
        for (at, value) in changes {
            let at = at.index(pdu.len());
            pdu[at] = value;
        }
        if cut {
            pdu.truncate(end.index(pdu.len()));
        }
        pdu
    })
}

/// A client and its environment.
struct Client {
    session: Session,
    memory: Memory,
    variables: Variables,
    names: Names,
    directory: Directory,
    machine_data: Option<Box<dyn MachineData>>,
    control: Option<Box<dyn ControlValues>>,
    state: CpuState,
    clock: DateAndTime,
    protection: Protection,
    diagnosis: Vec<Diagnosis>,
    is_read_only: bool,
    connections: u16,
    commands: Vec<Command>,
    connection: Connection,
}

impl Client {
    /// Not connected yet. Every byte of the memory is A5, so that an unintended write is visible.
    fn new() -> Self {
        let mut memory = Memory::new();
        for part in [crate::image::Part::ToNck, crate::image::Part::FromNck, crate::image::Part::Hmi] {
            memory.part_mut(part).fill(0xA5);
        }
        for (number, length) in [(1000, 2048), (1001, 7)] {
            memory.blocks.put(DataBlock { number, name: None, bytes: Bytes::from(vec![0xA5; length]) });
        }
        memory.flags.fill(0xA5);
        let mut names = Names::default();
        for (number, name) in AxisNumber::all().zip(["X", "Y", "XF"]) {
            names.axes[number] = Some(name.to_owned());
        }
        names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
        Self {
            session: Session::new(Settings::default()),
            directory: Directory::of(&memory, names.profile),
            memory,
            variables: Variables::default(),
            names,
            machine_data: None,
            control: None,
            state: CpuState::Run,
            clock: DateAndTime { year: 2026, month: 11, day: 22, hour: 3, minute: 4, second: 5, millisecond: 678 },
            protection: Protection { level: 1, password: None },
            diagnosis: Vec::new(),
            is_read_only: false,
            connections: 32,
            commands: Vec::new(),
            connection: Connection::Open,
        }
    }

    /// Connected, with this PDU negotiated.
    fn ready(pdu: u16) -> Self {
        let mut client = Self::new();
        client.get_ready(pdu);
        client
    }

    fn get_ready(&mut self, pdu: u16) {
        self.send(&bytes(CONNECT));
        self.set_up(pdu);
    }

    fn set_up(&mut self, pdu: u16) {
        let [high, low] = pdu.to_be_bytes();
        let setup = format!("32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 {high:02X} {low:02X}");
        assert!(self.ask(&setup).starts_with("32 03 00 00 00 01 00 08 00 00 00 00 F0"));
        assert_eq!(self.session.pdu_length(), usize::from(pdu));
    }

    /// Connected to the NCK of a solution line, as data collectors do.
    fn at_the_nck(pdu: u16) -> Self {
        Self::called("0D 04", pdu)
    }

    /// Connected to this TSAP.
    fn called(tsap: &str, pdu: u16) -> Self {
        let mut client = Self::new();
        client.send(&bytes(&CONNECT.replace("C2 02 01 02", &format!("C2 02 {tsap}"))));
        client.set_up(pdu);
        client
    }

    fn on_828d(mut self) -> Self {
        self.names.profile = Profile::SINUMERIK_828D;
        self.directory = Directory::of(&self.memory, self.names.profile);
        self
    }

    /// The answers of the session to these bytes, one per answer.
    fn send(&mut self, bytes: &[u8]) -> Vec<Vec<u8>> {
        self.with_station(|session, station, answers| Some(session.receive(bytes, station, answers)))
    }

    fn tick(&mut self, milliseconds: i64) -> Vec<Vec<u8>> {
        let now = Time::from_millis(milliseconds);
        self.with_station(|session, station, answers| {
            session.tick(now, station, answers);
            None
        })
    }

    fn with_station(
        &mut self,
        work: impl FnOnce(&mut Session, &mut Bridge<'_>, &mut Answers) -> Option<Connection>,
    ) -> Vec<Vec<u8>> {
        let machinery = Machinery {
            state: self.state,
            clock: self.clock,
            protection: self.protection,
            diagnosis: &self.diagnosis,
            is_read_only: self.is_read_only,
            machine_data: self.machine_data.as_deref(),
            control: self.control.as_deref(),
            connections: self.connections,
            ..Machinery::default()
        };
        let mut bridge = Bridge::new(&self.memory, &self.variables, &self.names, &self.directory).with(machinery);
        let mut answers = Answers::default();
        if let Some(connection) = work(&mut self.session, &mut bridge, &mut answers) {
            self.connection = connection;
        }
        self.commands.extend(bridge.into_commands());
        answers.iter().map(<[u8]>::to_vec).collect()
    }

    /// The S7 PDU that answers an S7 PDU, both in hexadecimal.
    fn ask(&mut self, pdu: &str) -> String {
        let answers = self.send(&packet(&bytes(pdu)));
        assert_eq!(answers.len(), 1, "one answer to {pdu}, found {answers:02X?}");
        let answer = &answers[0];
        assert_eq!(&answer[..2], [3, 0]);
        assert_eq!(usize::from(u16::from_be_bytes([answer[2], answer[3]])), answer.len());
        assert_eq!(&answer[4..7], [2, 0xF0, 0x80]);
        assert!(answer.len() - 7 <= self.session.pdu_length(), "the answer is longer than the PDU");
        hex(&answer[7..])
    }

    /// A job with this parameter and data part, and the answer after its reference.
    fn job(&mut self, parameter: &str, data: &str) -> String {
        let (parameter, data) = (bytes(parameter), bytes(data));
        let lengths = format!("{} {}", word(parameter.len()), word(data.len()));
        let answer = self.ask(&format!("32 01 00 00 12 34 {lengths} {} {}", hex(&parameter), hex(&data)));
        let (head, rest) = answer.split_at(18);
        assert!(matches!(head, "32 03 00 00 12 34 " | "32 02 00 00 12 34 "), "{answer}");
        rest.to_owned()
    }

    /// User data of a group and function, and the answer's error and data part.
    fn user_data(&mut self, group: u8, function: u8, payload: &str) -> (String, String) {
        let payload = bytes(payload);
        let head = if payload.is_empty() { "0A 00".to_owned() } else { "FF 09".to_owned() };
        let data = format!("{head} {} {}", word(payload.len()), hex(&payload));
        let kind = 0x40 | group;
        let parameter = format!("00 01 12 04 11 {kind:02X} {function:02X} 00");
        let lengths = format!("00 08 {}", word(payload.len() + 4));
        let answer = bytes(&self.ask(&format!("32 07 00 00 12 34 {lengths} {parameter} {data}")));
        assert_eq!(hex(&answer[..6]), "32 07 00 00 12 34");
        assert_eq!(hex(&answer[6..8]), "00 0C");
        assert_eq!(usize::from(u16::from_be_bytes([answer[8], answer[9]])), answer.len() - 22);
        assert_eq!(hex(&answer[10..17]), format!("00 01 12 08 12 8{group:X} {function:02X}"));
        (hex(&answer[20..22]), hex(&answer[22..]))
    }

    /// Reads items that are given without their `12 0A 10`.
    fn read(&mut self, items: &[&str]) -> String {
        let each: Vec<String> = items.iter().map(|item| format!("12 0A 10 {item}")).collect();
        self.job(&format!("04 {:02X} {}", items.len(), each.join(" ")), "")
    }

    fn write(&mut self, items: &[&str], data: &str) -> String {
        let each: Vec<String> = items.iter().map(|item| format!("12 0A 10 {item}")).collect();
        self.job(&format!("05 {:02X} {}", items.len(), each.join(" ")), data)
    }

    /// Executes the requested commands, as at the start of a step.
    fn step(&mut self) {
        for command in std::mem::take(&mut self.commands) {
            match command {
                Command::Write { location, value } => self.memory.write(location, value),
                Command::PlcStop => self.state = CpuState::Stop,
                Command::PlcStart(_) => self.state = CpuState::Run,
                Command::SetClock(time) => self.clock = time,
                Command::MachineDatum { .. } | Command::RParameter { .. } => {}
            }
        }
    }
}

fn word(number: usize) -> String {
    let [high, low] = u16::try_from(number).unwrap().to_be_bytes();
    format!("{high:02X} {low:02X}")
}
