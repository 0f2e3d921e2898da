//! Read and write requests: one or more variables, each with its own result.

use super::error::Error;
use super::job::{Failure, Negotiated, Reply};
use super::plan::{Capacity, Part, Plan, Purpose, plan};
use super::value::Value;
use super::variable::{Memory, Variable};
use super::{Client, Question};
use crate::image::{Area, Format, Width};
use crate::s7::wire::data::{SUCCESS, TransportSize};
use crate::s7::wire::header::{ErrorCode, function, kind};
use crate::s7::wire::replies::DataItems;
use crate::s7::wire::requests;

/// The state of each variable during an exchange.
struct Progress<'a> {
    variables: Vec<&'a Variable>,
    /// The bytes read or to be written.
    bytes: Vec<Vec<u8>>,
    errors: Vec<Option<Error>>,
}

impl Progress<'_> {
    fn fail(&mut self, part: &Part, error: Error) {
        let name = self.variables[part.of].to_string();
        self.errors[part.of].get_or_insert_with(|| error.of(&name));
    }

    fn fail_all(&mut self, parts: &[Part], error: &Error) {
        parts.iter().for_each(|part| self.fail(part, error.clone()));
    }

    fn unexpected(&mut self, parts: &[Part], found: &str) {
        self.fail_all(parts, &Error::Unexpected { what: String::new(), found: found.to_owned() });
    }
}

impl Client {
    /// Reads a variable.
    ///
    /// # Errors
    /// The read is refused, or no answer arrives.
    pub async fn read(&self, variable: &Variable) -> Result<Value, Error> {
        only(self.read_all(std::slice::from_ref(variable)).await)
    }

    /// Reads any number of variables, in as few requests as the negotiated PDU permits. Values in one request are of one cycle; a value
    /// that is longer than a PDU is not. Each variable has its own result.
    pub async fn read_all(&self, variables: &[Variable]) -> Vec<Result<Value, Error>> {
        let progress = self.read_bytes_of(variables.iter().collect()).await;
        let each = variables.iter().zip(progress.bytes).zip(progress.errors);
        each.map(|((variable, bytes), error)| match error {
            Some(error) => Err(error),
            None => Value::decode(variable, &bytes).ok_or_else(|| Error::Unexpected {
                what: variable.to_string(),
                found: format!("a value of {} bytes", bytes.len()),
            }),
        })
        .collect()
    }

    /// Reads any number of bytes of an area; timers and counters have two bytes each.
    ///
    /// # Errors
    /// The read is refused, or no answer arrives.
    pub async fn read_bytes(&self, area: Area, start: u32, length: u32) -> Result<Vec<u8>, Error> {
        let variable = Variable::Memory(bytes_of(area, start, length)?);
        let mut progress = self.read_bytes_of(vec![&variable]).await;
        match progress.errors.pop().flatten() {
            Some(error) => Err(error),
            None => Ok(progress.bytes.pop().unwrap_or_default()),
        }
    }

    /// Writes a variable.
    ///
    /// # Errors
    /// The value does not fit, the write is refused, or no answer arrives. In the last case the error reports whether the request was sent.
    pub async fn write(&self, variable: &Variable, value: &Value) -> Result<(), Error> {
        only(self.write_all(&[(variable.clone(), value.clone())]).await)
    }

    /// Writes any number of variables, in order, in as few requests as the negotiated PDU permits. If one of the values does not fit its
    /// variable, nothing is written. Each variable has its own result.
    pub async fn write_all(&self, writes: &[(Variable, Value)]) -> Vec<Result<(), Error>> {
        let encoded: Vec<_> = writes.iter().map(|(variable, value)| value.encode(variable)).collect();
        if encoded.iter().any(Result::is_err) {
            let other = || Error::Input {
                what: "nothing was written, because another value does not fit".to_owned(),
                cure: "correct the other value".to_owned(),
            };
            return encoded.into_iter().map(|bytes| bytes.and_then(|_| Err(other()))).collect();
        }
        let bytes = encoded.into_iter().flatten().collect();
        self.write_encoded(writes.iter().map(|(variable, _)| variable).collect(), bytes).await
    }

    /// Writes any number of bytes to an area; timers and counters have two bytes each.
    ///
    /// # Errors
    /// The write is refused, or no answer arrives. In the second case the error reports whether the request was sent.
    pub async fn write_bytes(&self, area: Area, start: u32, bytes: &[u8]) -> Result<(), Error> {
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let variable = Variable::Memory(bytes_of(area, start, length)?);
        only(self.write_encoded(vec![&variable], vec![bytes.to_vec()]).await)
    }

    async fn read_bytes_of<'a>(&self, variables: Vec<&'a Variable>) -> Progress<'a> {
        let count = variables.len();
        let mut progress = Progress { variables, bytes: vec![Vec::new(); count], errors: vec![None; count] };
        let mut parts = Vec::new();
        for of in 0..count {
            let variable = progress.variables[of];
            match variable.check() {
                Ok(()) => parts.extend(Part::all(of, variable, Purpose::Read)),
                Err(error) => progress.errors[of] = Some(error),
            }
        }
        self.exchange(Purpose::Read, parts, &mut progress).await;
        progress
    }

    async fn write_encoded(&self, variables: Vec<&Variable>, bytes: Vec<Vec<u8>>) -> Vec<Result<(), Error>> {
        let count = variables.len();
        let mut progress = Progress { variables, bytes, errors: vec![None; count] };
        let mut parts = Vec::new();
        for of in 0..count {
            let variable = progress.variables[of];
            match variable.check() {
                Ok(()) => parts.extend(parts_to_write(of, variable, progress.bytes[of].len())),
                Err(error) => progress.errors[of] = Some(error),
            }
        }
        self.exchange(Purpose::Write, parts, &mut progress).await;
        progress.errors.into_iter().map(|error| error.map_or(Ok(()), Err)).collect()
    }

    /// Plans the requests and sends them, and repeats this for parts that are left over: if a server answers fewer items than requested,
    /// refuses a request with several items, or if a new connection has a shorter PDU.
    async fn exchange(&self, purpose: Purpose, mut parts: Vec<Part>, progress: &mut Progress<'_>) {
        let mut most = usize::from(self.options.items).max(1);
        while !parts.is_empty() {
            let negotiated = match self.connected("read or write").await {
                Ok(negotiated) => negotiated,
                Err(error) => return progress.fail_all(&parts, &error),
            };
            let Negotiated { pdu, .. } = negotiated;
            let Plan { requests, too_long } = plan(parts.drain(..), purpose, Capacity { pdu, items: most });
            for part in too_long {
                let cure = format!("a PDU has {pdu} bytes; request fewer rows or a longer PDU");
                progress.fail(&part, Error::Input { what: "the value is too long for a PDU".to_owned(), cure });
            }
            let mut waiting = Vec::with_capacity(requests.len());
            for request in requests {
                let (parameter, data) = encode(purpose, &request, &progress.bytes);
                let (code, repeat) = (parameter[0], purpose == Purpose::Read);
                let what = if code == function::READ { "read" } else { "write" };
                let question = Question { what, kind: kind::JOB, parameter: &parameter, data: &data, pdu, repeat };
                waiting.push((request, self.send(question).await));
            }
            let all = waiting.len();
            for (request, answer) in waiting {
                let reply = match answer.await {
                    Ok(Ok(reply)) => reply,
                    Ok(Err(Failure::Renegotiated)) => {
                        parts.extend(request);
                        continue;
                    }
                    Ok(Err(Failure::Error(error))) => {
                        progress.fail_all(&request, &error);
                        continue;
                    }
                    Err(_) => {
                        progress.fail_all(&request, &self.gone("read or write"));
                        continue;
                    }
                };
                match reply.error {
                    ErrorCode::NONE => parts.extend(take(purpose, &request, &reply, progress)),
                    // Some servers refuse a whole request because of one item. A read can be repeated for each item separately.
                    _ if purpose == Purpose::Read && request.len() > 1 => {
                        most = if all == 1 { request.len().div_ceil(2) } else { 1 };
                        parts.extend(request);
                    }
                    error => progress.fail_all(&request, &Error::Rejected { what: String::new(), error }),
                }
            }
        }
    }
}

/// Returns the parts to request again: a server may answer only the first items.
fn take(purpose: Purpose, request: &[Part], reply: &Reply, progress: &mut Progress<'_>) -> Vec<Part> {
    let taken = match purpose {
        Purpose::Read | Purpose::Subscribe => take_values(request, &reply.data, progress),
        Purpose::Write => take_codes(request, &reply.data, progress),
    };
    let rest = request.get(taken..).unwrap_or_default();
    match (purpose, taken) {
        (_, 0) => progress.unexpected(rest, "the answer has no items"),
        // A write that was not acknowledged is not repeated.
        (Purpose::Write, _) => progress.unexpected(rest, "the answer acknowledges fewer items than were written"),
        (Purpose::Read | Purpose::Subscribe, _) => return rest.to_vec(),
    }
    Vec::new()
}

/// Takes the values of an answer; returns their number.
fn take_values(request: &[Part], data: &[u8], progress: &mut Progress<'_>) -> usize {
    let mut taken = 0;
    for (part, value) in request.iter().zip(DataItems::new(data)) {
        taken += 1;
        match value {
            Ok(value) if part.takes(value.len()) => {
                let bytes = &mut progress.bytes[part.of];
                let end = part.offset + value.len();
                if bytes.len() < end {
                    bytes.resize(end, 0);
                }
                bytes[part.offset..end].copy_from_slice(value);
            }
            Ok(value) => {
                let error = progress.variables[part.of].another_length(part.length, value.len());
                progress.fail(part, error);
            }
            Err(code) => progress.fail(part, Error::Refused { what: String::new(), code }),
        }
    }
    taken
}

fn take_codes(request: &[Part], data: &[u8], progress: &mut Progress<'_>) -> usize {
    for (part, code) in request.iter().zip(data) {
        if *code != SUCCESS {
            progress.fail(part, Error::Refused { what: String::new(), code: *code });
        }
    }
    request.len().min(data.len())
}

/// The parts of a variable with these bytes. The length of the bytes also gives the length of rows of unknown type.
fn parts_to_write(of: usize, variable: &Variable, length: usize) -> Vec<Part> {
    let mut parts = Part::all(of, variable, Purpose::Write);
    if let ([part], Variable::Nc(_)) = (parts.as_mut_slice(), variable) {
        part.length = length;
    }
    parts
}

/// Parameter and data part of a request.
fn encode(purpose: Purpose, request: &[Part], bytes: &[Vec<u8>]) -> (Vec<u8>, Vec<u8>) {
    let code = if purpose == Purpose::Write { function::WRITE } else { function::READ };
    let mut parameter = vec![code, u8::try_from(request.len()).unwrap_or(u8::MAX)];
    request.iter().for_each(|part| part.put_item(&mut parameter));
    let mut data = Vec::new();
    if purpose == Purpose::Write {
        for part in request {
            if data.len() % 2 == 1 {
                data.push(0);
            }
            let size = match (part.is_bit(), part.is_octets()) {
                (true, _) => TransportSize::BIT,
                (false, true) => TransportSize::OCTETS,
                (false, false) => TransportSize::BYTES,
            };
            let value = bytes[part.of].get(part.offset..part.offset + part.length).unwrap_or_default();
            requests::put_value(size, value, &mut data);
        }
    }
    (parameter, data)
}

fn bytes_of(area: Area, start: u32, length: u32) -> Result<Memory, Error> {
    let is_numbered = matches!(area, Area::Timers | Area::Counters);
    if !is_numbered {
        return Ok(Memory::bytes(area, start, length));
    }
    if start % 2 == 1 || length % 2 == 1 {
        return Err(Error::Input {
            what: format!("expected whole timers or counters, found {length} bytes from {start}"),
            cure: "they have two bytes each".to_owned(),
        });
    }
    let (width, format) = (Width::Word, Format::Unsigned);
    Ok(Memory { area, byte: start / 2, width, format, count: length / 2 })
}

/// The result of a single variable.
fn only<T>(mut results: Vec<Result<T, Error>>) -> Result<T, Error> {
    results.pop().unwrap_or_else(|| {
        Err(Error::Input { what: "expected a variable, found none".to_owned(), cure: "give a variable".to_owned() })
    })
}
