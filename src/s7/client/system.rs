//! The CPU: system state lists, identification, RUN and STOP, clock, passwords.

use super::error::{Error, Execution};
use super::{Client, Question};
use crate::s7::station::{CpuState, Restart};
use crate::s7::wire::data::SUCCESS;
use crate::s7::wire::date_and_time::DateAndTime;
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::replies::UserData;
use crate::s7::wire::requests;
use crate::s7::wire::user_data::group;

/// Maximum length of an answer in several parts.
const LONGEST: usize = 1 << 20;
/// How often a long answer is requested again after the connection was lost in the middle of it.
const ATTEMPTS: usize = 3;

/// A system state list (SZL) with its records.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SystemStateList {
    /// The SZL ID.
    pub list: u16,
    /// The SZL index.
    pub index: u16,
    /// Bytes of a record.
    pub record: u16,
    /// The number of records reported by the module.
    pub count: u16,
    /// The records; the last one may be shorter if the module sent less than it reported.
    pub bytes: Vec<u8>,
}

impl SystemStateList {
    fn parse(payload: &[u8]) -> Option<Self> {
        let (head, bytes) = payload.split_first_chunk::<8>()?;
        let [a, b, c, d, e, f, g, h] = *head;
        let word = |high, low| u16::from_be_bytes([high, low]);
        Some(Self { list: word(a, b), index: word(c, d), record: word(e, f), count: word(g, h), bytes: bytes.to_vec() })
    }

    /// The records.
    pub fn records(&self) -> impl Iterator<Item = &[u8]> {
        self.bytes.chunks(usize::from(self.record).max(1))
    }

    /// The record that begins with an index.
    #[must_use]
    pub fn at(&self, index: u16) -> Option<&[u8]> {
        self.records().find(|record| record.starts_with(&index.to_be_bytes()))
    }
}

/// The identification of a module; fields that it does not report are empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identification {
    /// Order number.
    pub order_number: String,
    /// Version of the firmware.
    pub version: String,
    /// Name of the automation system.
    pub system_name: String,
    /// Name of the module.
    pub module_name: String,
    /// Plant identification.
    pub plant: String,
    /// Copyright entry.
    pub copyright: String,
    /// Serial number.
    pub serial_number: String,
    /// Type of the module.
    pub module_type: String,
}

/// Printable text up to the first zero, without surrounding blanks.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let text: String = bytes[..end].iter().map(|byte| char::from(*byte)).filter(|c| !c.is_control()).collect();
    text.trim().to_owned()
}

impl Client {
    /// A system state list, in as many parts as the module sends.
    ///
    /// # Errors
    /// There is no such list or index, or no answer arrives.
    pub async fn list(&self, list: u16, index: u16) -> Result<SystemStateList, Error> {
        let [a, b] = list.to_be_bytes();
        let [c, d] = index.to_be_bytes();
        let payload = self.long("system state list", group::CPU, 1, &[a, b, c, d]).await;
        let name = format!("system state list {list:04X} index {index:04X}");
        let payload = payload.map_err(|error| error.of(&name))?;
        SystemStateList::parse(&payload)
            .ok_or_else(|| Error::Unexpected { what: name, found: format!("{} bytes", payload.len()) })
    }

    /// The identification of the module: lists 0011 and 001C. Fields that it does not report stay empty.
    ///
    /// # Errors
    /// No answer arrives.
    pub async fn identification(&self) -> Result<Identification, Error> {
        let mut identification = Identification::default();
        if let Some(list) = optional(self.list(0x0011, 0).await)? {
            if let Some([_, _, number @ ..]) = list.at(1) {
                identification.order_number = text(number.get(..20).unwrap_or(number));
            }
            if let Some([.., b'V' | b'v', major, minor, patch]) = list.at(7).filter(|record| record.len() == 28) {
                identification.version = format!("V{major}.{minor}.{patch}");
            } else if let Some([.., major, minor]) = list.at(7).filter(|record| record.len() == 28) {
                identification.version = format!("V{major}.{minor}");
            }
        }
        if let Some(list) = optional(self.list(0x001C, 0).await)? {
            let at = |index| list.at(index).and_then(|record| record.get(2..)).map(text).unwrap_or_default();
            identification.system_name = at(1);
            identification.module_name = at(2);
            identification.plant = at(3);
            identification.copyright = at(4);
            identification.serial_number = at(5);
            identification.module_type = at(7);
        }
        Ok(identification)
    }

    /// RUN or STOP: list 0424. `None` if the module reports another state.
    ///
    /// # Errors
    /// The module does not report it, or no answer arrives.
    pub async fn cpu_state(&self) -> Result<Option<CpuState>, Error> {
        let list = self.list(0x0424, 0).await?;
        // The fourth byte is the operating state: 8 RUN, 3 and 4 STOP.
        Ok(match list.bytes.get(3) {
            Some(8) => Some(CpuState::Run),
            Some(3 | 4) => Some(CpuState::Stop),
            _ => None,
        })
    }

    /// The valid protection level: list 0232, index 4. `None` if the module does not report it.
    ///
    /// # Errors
    /// No answer arrives.
    pub async fn protection(&self) -> Result<Option<u16>, Error> {
        let list = optional(self.list(0x0232, 4).await)?;
        let record = list.as_ref().and_then(|list| list.at(4));
        // Index, level of the mode selector, level of the password, valid level.
        Ok(record.and_then(|record| record.get(6..8)).map(|level| u16::from_be_bytes([level[0], level[1]])))
    }

    /// The clock of the CPU.
    ///
    /// # Errors
    /// The module has no clock, or no answer arrives.
    pub async fn clock(&self) -> Result<DateAndTime, Error> {
        let payload = self.short("clock", group::TIME, 1, &[], true).await?;
        payload
            .get(2..10)
            .and_then(DateAndTime::parse)
            .ok_or_else(|| Error::Unexpected { what: "clock".to_owned(), found: "no date and time".to_owned() })
    }

    /// Sets the clock of the CPU.
    ///
    /// # Errors
    /// It is not permitted, or no answer arrives.
    pub async fn set_clock(&self, time: DateAndTime) -> Result<(), Error> {
        let mut payload = [0; 10];
        payload[1] = if time.year < 2000 { 0x19 } else { 0x20 };
        payload[2..].copy_from_slice(&time.bytes());
        self.short("setting the clock", group::TIME, 2, &payload, false).await.map(|_| ())
    }

    /// Gives a password. It is valid until it is taken back or the connection ends. [`Options::password`](super::Options::password) gives a
    /// password on each connection.
    ///
    /// # Errors
    /// The password is wrong, the module has none, or no answer arrives.
    pub async fn give_password(&self, password: [u8; 8]) -> Result<(), Error> {
        self.short("password", group::SECURITY, 1, &requests::folded(password), false).await.map(|_| ())
    }

    /// Takes the password back.
    ///
    /// # Errors
    /// There is none, or no answer arrives.
    pub async fn take_password_back(&self) -> Result<(), Error> {
        self.short("taking the password back", group::SECURITY, 2, &[], false).await.map(|_| ())
    }

    /// Stops the PLC. Stopping a PLC in STOP succeeds.
    ///
    /// # Errors
    /// It is not permitted, or no answer arrives.
    pub async fn stop_plc(&self) -> Result<(), Error> {
        self.control("PLC stop", &requests::stop(), 0x07).await
    }

    /// Restarts the PLC. Starting a PLC in RUN succeeds.
    ///
    /// # Errors
    /// It is not permitted, or no answer arrives.
    pub async fn start_plc(&self, restart: Restart) -> Result<(), Error> {
        let arguments: &[u8] = match restart {
            Restart::Warm => &[],
            Restart::Cold => requests::COLD,
        };
        self.control("PLC start", &requests::start(arguments), 0x03).await
    }

    async fn control(&self, what: &'static str, parameter: &[u8], already: u8) -> Result<(), Error> {
        let reply = self.ask(Question::job(what, parameter)).await?;
        match reply.parameter.as_slice() {
            [function::STOP | function::START] | [_, 0] => Ok(()),
            [_, code, ..] if *code == already => Ok(()),
            other => Err(Error::Unexpected { what: what.to_owned(), found: format!("{other:02X?}") }),
        }
    }

    /// User data with an answer in one part.
    pub(super) async fn short(
        &self,
        what: &'static str,
        group: u8,
        function: u8,
        payload: &[u8],
        repeat: bool,
    ) -> Result<Vec<u8>, Error> {
        let (parameter, data) = (requests::user_data(group, function), requests::payload(payload));
        let question = Question { repeat, ..Question::user_data(what, &parameter, &data) };
        let reply = self.ask(question).await?;
        part(what, &reply.parameter, &reply.data).map(|part| part.payload.to_vec())
    }

    /// User data that reads, with an answer in any number of parts. One request at a time, because a module keeps only one long answer.
    pub(super) async fn long(
        &self,
        what: &'static str,
        group: u8,
        function: u8,
        payload: &[u8],
    ) -> Result<Vec<u8>, Error> {
        let _alone = self.long.lock().await;
        let mut attempt = 1;
        loop {
            match self.parts(what, group, function, payload).await {
                // The rest of a long answer is lost with its connection.
                Err(
                    Error::Lost { execution: Execution::Read | Execution::PerhapsExecuted, .. }
                    | Error::Rejected { error: ErrorCode::WRONG_SEQUENCE, .. },
                ) if attempt < ATTEMPTS && self.options.reconnect.is_some() => {
                    attempt += 1;
                }
                result => return result,
            }
        }
    }

    async fn parts(&self, what: &'static str, group: u8, function: u8, payload: &[u8]) -> Result<Vec<u8>, Error> {
        let (parameter, data) = (requests::user_data(group, function), requests::payload(payload));
        let mut reply = self.ask(Question::user_data(what, &parameter, &data).repeated()).await?;
        let mut whole = Vec::new();
        loop {
            let part = part(what, &reply.parameter, &reply.data)?;
            whole.extend_from_slice(part.payload);
            if !part.more {
                return Ok(whole);
            }
            if whole.len() > LONGEST || part.payload.is_empty() {
                let found = format!("the answer exceeds the maximum length, {} bytes so far", whole.len());
                return Err(Error::Unexpected { what: what.to_owned(), found });
            }
            let parameter = requests::next_part(group, function, part.sequence, part.unit);
            let data = requests::payload(&[]);
            reply = self.ask(Question::user_data(what, &parameter, &data)).await?;
        }
    }
}

/// A successful answer of user data.
fn part<'a>(what: &str, parameter: &[u8], data: &'a [u8]) -> Result<UserData<'a>, Error> {
    let part = UserData::parse(parameter, data)
        .ok_or_else(|| Error::Unexpected { what: what.to_owned(), found: "no user data".to_owned() })?;
    match (part.error, part.code) {
        (ErrorCode::NONE, SUCCESS | 0x0A) => Ok(part),
        (ErrorCode::NONE, code) => Err(Error::Refused { what: what.to_owned(), code }),
        (error, _) => Err(Error::Rejected { what: what.to_owned(), error }),
    }
}

/// A list, or `None` if the module does not have it.
fn optional(list: Result<SystemStateList, Error>) -> Result<Option<SystemStateList>, Error> {
    match list {
        Ok(list) => Ok(Some(list)),
        Err(error) if error.is_of_the_connection() => Err(error),
        Err(_) => Ok(None),
    }
}
