//! System state lists (SZL): the properties of a module in lists of records. A list that is longer than the PDU is sent in parts.
//!
//! | list | record | index | content |
//! |---|---|---|---|
//! | `0000` | 2 | 0 | all lists |
//! | `0011`, `0111` | 28 | 1, 6, 7 | order number, hardware, firmware |
//! | `0012`, `0112` | 2 | | features of the CPU |
//! | `0013`, `0113` | 36 | 1 | memories |
//! | `0014` | 8 | | areas and their sizes |
//! | `0015` | 10 | | block types |
//! | `0019`, `0119`, `0074`, `0174` | 4 | number of a lamp | lamps |
//! | `001C`, `011C` | 34 | 1 to 11 | names, serial number, location |
//! | `0131` | 40 | 1 to 6, 9 | communication: what the module is able to do |
//! | `0132`, `0232` | 40 | 4 | protection |
//! | `0132` | 40 | 1, 2, 8 to 11 | communication: what happens now; 8 has the clock |
//! | `0222` | 28 | 1, 80, 100, 102 | the last start of an organization block |
//! | `0424` | 20 | | operating state and the last change |
//! | `0D91` | 16 | 0 | the modules of rack 0: the CPU |
//! | `00A0`, `01A0` | 20 | number of entries | diagnostic buffer |
//! | `001A`, `001B`, `003A`, `0A00` | | | internal lists that STEP 7 and TIA Portal ask for: they exist and have no records |
//!
//! A record whose fields tell of something that this CPU does not have (MPI, run-time meters, time synchronisation, jobs of a programming
//! device) contains its index and zeros.
//!
//! The extract `0Fxx` of a list is only its header, with the number of records of the list.

use super::exchange::Exchange;
use super::{LONGEST_PDU, SHORTEST_PDU, Session};
use crate::image::Area;
use crate::s7::station::{CpuState, Diagnosis, Station};
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::user_data::{Head, Request};

/// All lists in ascending order.
const LISTS: [u16; 43] = [
    0x0000, 0x0011, 0x0012, 0x0013, 0x0014, 0x0015, 0x0019, 0x001A, 0x001B, 0x001C, 0x003A, 0x0074, 0x00A0, 0x0111,
    0x0112, 0x0113, 0x0119, 0x011C, 0x0131, 0x0132, 0x0174, 0x01A0, 0x0222, 0x0232, 0x0424, 0x0A00, 0x0D91, 0x0F00,
    0x0F0A, 0x0F11, 0x0F12, 0x0F13, 0x0F14, 0x0F15, 0x0F19, 0x0F1A, 0x0F1B, 0x0F1C, 0x0F31, 0x0F32, 0x0F3A, 0x0F74,
    0x0FA0,
];

/// Lamps of a CPU with two interfaces: SF, RUN, STOP, FRCE, bus faults 1 and 2, maintenance demand.
const LAMPS: [u16; 7] = [1, 4, 5, 6, 0x0B, 0x0C, 0x15];

/// Features by group, which is the first byte: MC7 interpreter; a clock in BCD with a resolution of 1 ms; restarts; floating-point
/// arithmetic, its functions and four accumulators.
const FEATURES: [u16; 8] = [0x0002, 0x0101, 0x0104, 0x0202, 0x0302, 0x0303, 0x0304, 0x0305];

/// Maximum number of entries shown of the diagnostic buffer.
const ENTRIES: usize = 100;

impl Session {
    pub(super) fn read_list(&mut self, request: &Request<'_>, exchange: &mut Exchange<'_>) -> Result<(), ErrorCode> {
        let Some((list, index)) = two_words(request.payload) else {
            return Err(ErrorCode::NOT_SUPPORTED);
        };
        let longest = self.settings.longest_pdu.clamp(SHORTEST_PDU, LONGEST_PDU);
        let pdu = PduLengths { longest, agreed: u16::try_from(exchange.budget.pdu).unwrap_or(longest) };
        let payload = system_state_list(list, index, exchange.station, pdu)?;
        self.send_in_parts(request, exchange, payload);
        Ok(())
    }

    /// The message service. This server sends no messages: logging on succeeds, but no message follows.
    pub(super) fn log_on_to_messages(
        &mut self,
        request: &Request<'_>,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), ErrorCode> {
        /// Events and a reserved byte, then the name of the client.
        const WITHOUT_KIND: usize = 2 + 8;
        let head = Head::answer(request, self.next_sequence());
        let answer: &[u8] = match request.payload.get(WITHOUT_KIND) {
            Some(&kind) => &[2, 0, kind, 0, 0],
            None if request.payload.len() >= 2 => &[2, 0],
            None => return Err(ErrorCode::NOT_SUPPORTED),
        };
        head.send(exchange.answers, exchange.reference, exchange.budget, answer);
        Ok(())
    }
}

/// PDU sizes: of this module, and of this connection.
#[derive(Clone, Copy, Debug)]
struct PduLengths {
    longest: u16,
    agreed: u16,
}

fn two_words(payload: &[u8]) -> Option<(u16, u16)> {
    let [a, b, c, d] = payload else { return None };
    Some((u16::from_be_bytes([*a, *b]), u16::from_be_bytes([*c, *d])))
}

/// A list with its header: ID, index, record length and number of records.
fn system_state_list(list: u16, index: u16, station: &dyn Station, pdu: PduLengths) -> Result<Vec<u8>, ErrorCode> {
    let is_head = list >> 8 == 0x0F;
    // The header 0Fxx describes the whole list; some lists exist only as an extract.
    let whole = match list {
        0x0F31 => 0x0131,
        0x0F32 => 0x0132,
        0x0F0A => 0x0A00,
        _ if is_head => list & 0xFF,
        _ => list,
    };
    if LISTS.binary_search(&list).is_err() {
        return Err(ErrorCode::WRONG_LIST);
    }
    // A list without a selection of records ignores the index; its header then has index 0.
    let has_index = !is_head && !matches!(list, 0x01A0 | 0x0424) && list > 0x00FF;
    let mut records = records(whole, if is_head { 0 } else { index }, station, pdu)?;
    let index = if has_index { index } else { 0 };
    let count = records.count();
    if is_head {
        records.bytes.clear();
    }
    let mut payload = Vec::with_capacity(8 + records.bytes.len());
    for word in [list, index, records.length, count] {
        payload.extend_from_slice(&word.to_be_bytes());
    }
    payload.extend_from_slice(&records.bytes);
    Ok(payload)
}

/// Records of the same length.
#[derive(Debug)]
struct Records {
    length: u16,
    bytes: Vec<u8>,
}

impl Records {
    /// Records of this length.
    fn of(length: u16) -> Self {
        Self { length, bytes: Vec::new() }
    }

    /// Appends a record, padded with zeros or cut to its length.
    fn add(&mut self, parts: &[&[u8]]) {
        let end = self.bytes.len() + usize::from(self.length);
        for part in parts {
            self.bytes.extend_from_slice(part);
        }
        self.bytes.resize(end, 0);
    }

    fn words(&mut self, words: &[u16]) {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
        self.add(&[&bytes]);
    }

    fn count(&self) -> u16 {
        u16::try_from(self.bytes.len() / usize::from(self.length)).unwrap_or(u16::MAX)
    }

    /// The record that begins with an index.
    fn only(mut self, index: u16) -> Result<Self, ErrorCode> {
        let mut each = self.bytes.chunks(self.length.into());
        let found = each.find(|record| record.starts_with(&index.to_be_bytes())).map(<[u8]>::to_vec);
        self.bytes = found.ok_or(ErrorCode::WRONG_INDEX)?;
        Ok(self)
    }
}

/// The records of a list. If a list has only one record, index 0 selects it as well: several clients use it.
fn records(list: u16, index: u16, station: &dyn Station, pdu: PduLengths) -> Result<Records, ErrorCode> {
    match list {
        0x0000 => {
            let mut records = Records::of(2);
            LISTS.iter().for_each(|list| records.words(&[*list]));
            Ok(records)
        }
        0x0011 => Ok(order_numbers(station)),
        0x0111 => order_numbers(station).only(index),
        0x0012 => Ok(features(|_| true)),
        0x0112 => match features(|feature| feature & 0xFF00 == index) {
            none if none.bytes.is_empty() => Err(ErrorCode::WRONG_INDEX),
            found => Ok(found),
        },
        0x0013 => Ok(memories(station)),
        0x0113 => memories(station).only(index),
        0x0014 => Ok(areas(station)),
        0x0015 => Ok(block_types()),
        0x0019 | 0x0074 => Ok(lamps(station)),
        0x0119 | 0x0174 => lamps(station).only(index),
        0x001C => Ok(names(station)),
        0x011C => names(station).only(index),
        0x001A | 0x001B | 0x003A | 0x0A00 => Ok(Records::of(2)),
        0x0131 => communication(station, pdu).only(index.max(1)),
        0x0132 => status(station).only(if index == 0 { 4 } else { index }),
        0x0232 => match index {
            0 | 4 => Ok(protection(station)),
            _ => Err(ErrorCode::WRONG_INDEX),
        },
        0x0D91 if index == 0 => Ok(modules()),
        0x0D91 => Err(ErrorCode::WRONG_INDEX),
        0x0222 => start_of(index, station),
        0x0424 => Ok(operating_state(station)),
        0x00A0 | 0x01A0 => {
            let wanted = if index == 0 || list == 0x00A0 { ENTRIES } else { usize::from(index).min(ENTRIES) };
            let mut records = Records::of(20);
            station.diagnosis().iter().take(wanted).for_each(|entry| diagnosis(&mut records, entry));
            Ok(records)
        }
        _ => Err(ErrorCode::WRONG_LIST),
    }
}

/// A text in a field of fixed length.
fn field<const N: usize>(text: &str, fill: u8) -> [u8; N] {
    let mut field = [fill; N];
    for (to, from) in field.iter_mut().zip(text.bytes()) {
        *to = from;
    }
    field
}

fn order_numbers(station: &dyn Station) -> Records {
    let identity = station.identity();
    let number: [u8; 20] = field(identity.order_number, b' ');
    let [major, minor, patch] = identity.version;
    let mut records = Records::of(28);
    records.add(&[&[0, 1], &number, &[0, 0xC0, 0, 1, 0, 1]]);
    records.add(&[&[0, 6], &number, &[0, 0xC0, 0, 1, 0, 1]]);
    records.add(&[&[0, 7], &number, &[0, 0xC0, b'V', major, minor, patch]]);
    records
}

fn features(is_wanted: impl Fn(u16) -> bool) -> Records {
    let mut records = Records::of(2);
    FEATURES.iter().filter(|feature| is_wanted(**feature)).for_each(|feature| records.words(&[*feature]));
    records
}

fn memories(station: &dyn Station) -> Records {
    let used: u32 = station.data_blocks().iter().map(|block| u32::from(block.length)).sum();
    let size: u32 = 16 << 20;
    let free = size.saturating_sub(used).to_be_bytes();
    let (size, used) = (size.to_be_bytes(), used.to_be_bytes());
    let mut records = Records::of(36);
    // Work memory: RAM, its size, volatile; then size, used bytes, and the largest free part of its single area.
    records.add(&[&[0, 1, 0, 1], &size, &[0, 1, 0, 0], &size, &used, &free]);
    records
}

/// All nine areas. Index 3 counts the flags in bits and index 8 in bytes; index 7 counts local data in bytes and index 9 in kilobytes.
/// Choices: the addressable inputs and outputs equal the process image, as on a CPU 315; there are no local data, because the program is
/// not MC7 code.
fn areas(station: &dyn Station) -> Records {
    let length = |area| station.area_length(area);
    let flags = length(Area::Flags);
    let mut records = Records::of(8);
    let areas = [
        (1, length(Area::Inputs)),
        (2, length(Area::Outputs)),
        (3, flags.saturating_mul(8)),
        (4, length(Area::Timers) / 2),
        (5, length(Area::Counters) / 2),
        (6, length(Area::Inputs)),
        (7, 0),
        (8, flags),
        (9, 0),
    ];
    for (index, size) in areas {
        records.words(&[index, 1, u16::try_from(size).unwrap_or(u16::MAX), 0]);
    }
    records
}

fn block_types() -> Records {
    let mut records = Records::of(10);
    // DB: at most 65535 of 64 KB, with at most that many bytes each in work memory.
    records.words(&[0x0A00, u16::MAX, 64, 0, u16::MAX]);
    records
}

fn lamps(station: &dyn Station) -> Records {
    let runs = station.state() == CpuState::Run;
    let mut records = Records::of(4);
    for lamp in LAMPS {
        let is_on = match lamp {
            // The program failed.
            1 => !runs && station.diagnosis().first().is_some_and(|entry| entry.event == Diagnosis::FAULT),
            4 => runs,
            5 => !runs,
            _ => false,
        };
        records.add(&[&lamp.to_be_bytes(), &[u8::from(is_on), 0]]);
    }
    records
}

fn names(station: &dyn Station) -> Records {
    let identity = station.identity();
    let mut records = Records::of(34);
    let texts = [
        (1_u16, identity.system_name),
        (2, identity.module_name),
        (3, identity.plant),
        (4, identity.copyright),
        (5, identity.serial_number),
        (7, identity.module_type),
        (8, ""),
    ];
    for (index, text) in texts {
        records.add(&[&index.to_be_bytes(), &field::<32>(text, 0)]);
    }
    // Manufacturer Siemens, profile of a CPU, and the type as reported by a CPU 315: like the order number, these are values of a real
    // control.
    records.add(&[&[0, 9, 0x00, 0x2A, 0xF6, 0x00, 0x00, 0x01]]);
    records.add(&[&[0, 10]]);
    records.add(&[&[0, 11], &field::<32>(identity.location, 0)]);
    records
}

fn communication(station: &dyn Station, pdu: PduLengths) -> Records {
    let mut records = Records::of(40);
    /// The connections of a CPU 317-2. This server may have more clients.
    const CONNECTIONS: u16 = 32;
    // Longest PDU of the module, connections, and the data rates of two buses that do not exist.
    records.words(&[1, pdu.longest, station.connections().min(CONNECTIONS), 0, 0, 0, 0]);
    // Operator interface: read once, write once, cyclic services that start immediately and can be deleted; inputs, outputs and flags; data
    // blocks and counters; timers.
    let served = [0b0100_0111, 0b1110_0000, 0b1000_0001, 0b0000_0001];
    // 32 jobs with cycles of 0.1 s to 2550 s.
    records.add(&[&[0, 3], &served, &pdu.agreed.to_be_bytes(), &[0, 32, 0, 1], &25_500_u16.to_be_bytes()]);
    // No functions of a programming device, of object management, of process diagnosis, of communication blocks, of the last kind.
    [2, 4, 5, 6, 9].into_iter().for_each(|index| records.words(&[index]));
    records
}

/// What communication does now: indices 1 (connections), 2 (jobs of a programming device), 4 (protection), 8 (clock), 9 and 10 (baud rates
/// of MPI and K bus), 11 (run-time meters).
fn status(station: &dyn Station) -> Records {
    let mut records = protection(station);
    [1, 2, 9, 10, 11].into_iter().for_each(|index| records.words(&[index]));
    // Cycle of the synchronisation, correction and eight run-time meters: none. After the time: meters, status, which is valid.
    records.add(&[&[0, 8], &[0; 20], &station.clock().bytes(), &[0; 9], &[1]]);
    records
}

/// Rack 0, slot 2: a CPU is expected and found (type 00C0); its status says that it is there.
fn modules() -> Records {
    let mut records = Records::of(16);
    records.words(&[0, 0x0200, 0, 0x00C0, 0x00C0, 0, 0x0002, 0]);
    records
}

fn protection(station: &dyn Station) -> Records {
    let protection = station.protection();
    let parameter = if protection.password.is_some() { protection.level } else { 0 };
    // The mode selector is always at RUN-P, also when a client stops the CPU.
    const RUN_P: u16 = 2;
    let mut records = Records::of(40);
    records.words(&[4, 1, parameter.into(), protection.level.into(), RUN_P, 0]);
    records
}

/// The last start of an organization block: OB1, OB80, and the block called by the last restart, 100 or 102.
fn start_of(index: u16, station: &dyn Station) -> Result<Records, ErrorCode> {
    let entries = station.diagnosis();
    let started = entries.iter().position(|entry| entry.event == Diagnosis::START_UP);
    let restart = started.map(|at| (entries.get(at + 1).map(|before| before.event), entries[at].time.bytes()));
    let is_cold = |before: Option<u16>| before == Some(Diagnosis::COLD_RESTART);
    let mut records = Records::of(28);
    // Event class and start event, priority class, number; eight bytes of its own; time of the start.
    match (index, restart) {
        // A time error would have started OB80; none did, and the record says so by zeros behind the number.
        (80, _) => records.add(&[&[0, 0, 0x1A, 80]]),
        (0 | 1, _) => records.add(&[&[0x11, 0x03, 0x01, 0x01], &[0; 8], &station.clock().bytes()]),
        (100, Some((before, time))) if !is_cold(before) => {
            records.add(&[&[0x13, 0x81, 0x1B, 100], &[0; 8], &time]);
        }
        (102, Some((before, time))) if is_cold(before) => {
            records.add(&[&[0x13, 0x85, 0x1B, 102], &[0; 8], &time]);
        }
        _ => return Err(ErrorCode::WRONG_INDEX),
    }
    Ok(records)
}

fn operating_state(station: &dyn Station) -> Records {
    let changes: &[u16] = match station.state() {
        CpuState::Run => &[Diagnosis::RUN],
        CpuState::Stop => &[Diagnosis::STOP, Diagnosis::FAULT],
    };
    let change = station.diagnosis().iter().find(|entry| changes.contains(&entry.event));
    // The event of the last change, an identifier, the state (08 RUN, 04 STOP), and the time of the change.
    let event = change.map_or(changes[0], |change| change.event);
    let time = change.map_or_else(|| station.clock(), |change| change.time);
    let state = match station.state() {
        CpuState::Run => 8,
        CpuState::Stop => 4,
    };
    let mut records = Records::of(20);
    records.add(&[&event.to_be_bytes(), &[0xFF, state], &[0; 8], &time.bytes()]);
    records
}

fn diagnosis(records: &mut Records, entry: &Diagnosis) {
    records.add(&[&entry.event.to_be_bytes(), &entry.information, &entry.time.bytes()]);
}
