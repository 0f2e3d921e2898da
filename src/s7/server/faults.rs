//! Injected faults for tests of operator panels: answers that are late, missing or errors, and connections that break.
//!
//! | option | effect |
//! |---|---|
//! | `delay=50ms`, `delay=10ms..80ms` | delays each answer; requests that arrive together are delayed together |
//! | `drop=1%` | drops an answer; the request is executed |
//! | `close=1/1000` | closes the connection instead of answering; the request is executed |
//! | `error=1%` | refuses a read or write request without executing it: each item gets the return code `0A` |
//! | `code=05`, `code=8104` | changes the refusal of `error`: another return code (two digits), or an error of the whole request (four
//! digits) |
//! | `seed=7` | seed of the random numbers; default 1 |
//!
//! Faults affect only S7 answers, including updates of subscriptions; transport connects and disconnects as usual. The answers of a
//! connection stay in order. The random numbers depend on the seed and the number of the connection, with one draw per request and one per
//! answer. The same clients with the same requests in the same order therefore get the same faults, however the requests are split into
//! packets.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use tokio::io::AsyncWrite;
use tokio::time::{Instant, sleep_until};

use super::end::End;
use super::sending::write;
use super::witness::Witness;
use crate::s7::session::Failure;
use crate::s7::wire::cotp;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::pdu::Answers;
use crate::s7::wire::tpkt;
use crate::units::Time;

/// The longest delay.
const LONGEST: Duration = Duration::from_mins(1);

/// Kinds of faults and their probabilities.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults {
    delay: RangeInclusive<Duration>,
    drop: f64,
    close: f64,
    error: f64,
    failure: Failure,
    seed: u64,
}

impl Default for Faults {
    fn default() -> Self {
        let none = Duration::ZERO;
        Self { delay: none..=none, drop: 0.0, close: 0.0, error: 0.0, failure: Failure::Items(0x0A), seed: 1 }
    }
}

impl Faults {
    /// The seed of the random numbers.
    #[must_use]
    pub const fn seed(&self) -> u64 {
        self.seed
    }
}

impl FromStr for Faults {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut faults = Self::default();
        let mut has_code = false;
        for part in text.split(',') {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            match name.trim() {
                "delay" => faults.delay = delay(value)?,
                "drop" => faults.drop = chance(value)?,
                "close" => faults.close = chance(value)?,
                "error" => faults.error = chance(value)?,
                "code" => (faults.failure, has_code) = (code(value)?, true),
                "seed" => faults.seed = value.parse().map_err(|_| format!("expected a whole number, found {part}"))?,
                _ => {
                    return Err(format!(
                        "expected delay=, drop=, close=, error=, code= or seed=, separated by commas, found {part}"
                    ));
                }
            }
        }
        if has_code && faults.error == 0.0 {
            return Err(format!(
                "expected error= together with code=, found {text}: add error=1% for one request in a hundred"
            ));
        }
        if faults.delay.end() < faults.delay.start() || *faults.delay.end() > LONGEST {
            return Err(format!("expected a delay of at most a minute, the shorter time first, found {text}"));
        }
        Ok(faults)
    }
}

fn delay(value: &str) -> Result<RangeInclusive<Duration>, String> {
    let (first, last) = value.split_once("..").unwrap_or((value, value));
    let wrong = || format!("expected a delay such as 50ms, 1.5s or 10ms..80ms, found {value}");
    Ok(duration(first).ok_or_else(wrong)?..=duration(last).ok_or_else(wrong)?)
}

/// Parses `50ms` or `1.5s`.
fn duration(text: &str) -> Option<Duration> {
    Time::parse(text).map(|time| Duration::from_nanos(time.nanos().unsigned_abs()))
}

/// Parses `1%` or `1/100`.
fn chance(value: &str) -> Result<f64, String> {
    let number = |text: &str| text.parse::<f64>().ok();
    let chance = match (value.strip_suffix('%'), value.split_once('/')) {
        (Some(percent), _) => number(percent).map(|percent| percent / 100.0),
        (None, Some((some, all))) => number(some).zip(number(all)).map(|(some, all)| some / all),
        (None, None) => None,
    };
    chance
        .filter(|chance| (0.0..=1.0).contains(chance))
        .ok_or_else(|| format!("expected a chance such as 1% or 1/100, at most 100%, found {value:?}"))
}

fn code(value: &str) -> Result<Failure, String> {
    let wrong = || format!("expected two hexadecimal digits (05, 0A) or four (8104), not 00 and not FF, found {value}");
    let digits = value.bytes().all(|digit| digit.is_ascii_hexdigit()).then_some(value);
    match (value.len(), u16::from_str_radix(digits.ok_or_else(wrong)?, 16)) {
        (2, Ok(code @ 1..=0xFE)) => Ok(Failure::Items(u8::try_from(code).map_err(|_| wrong())?)),
        (4, Ok(error @ 1..)) => Ok(Failure::Request(ErrorCode(error))),
        _ => Err(wrong()),
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { delay, drop, close, error, failure, seed } = self;
        match (delay.start(), delay.end()) {
            (_, &Duration::ZERO) => {}
            (first, last) if first == last => write!(f, "delay={last:?} ")?,
            (first, last) => write!(f, "delay={first:?}..{last:?} ")?,
        }
        for (name, chance) in [("drop", drop), ("close", close), ("error", error)] {
            if *chance > 0.0 {
                write!(f, "{name}={}% ", chance * 100.0)?;
            }
        }
        match failure {
            Failure::Items(code) if *error > 0.0 => write!(f, "code={code:02X} ")?,
            Failure::Request(code) if *error > 0.0 => write!(f, "code={:04X} ", code.0)?,
            Failure::Items(_) | Failure::Request(_) => {}
        }
        write!(f, "seed={seed}")
    }
}

/// The treatment of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Sent,
    Swallowed,
    Cut,
}

/// The faults of one connection.
#[derive(Debug)]
pub(super) struct Faulty {
    faults: Faults,
    requests: Chance,
    /// The number of requests for which a random number was drawn.
    drawn: u64,
    answers: Chance,
}

impl Faulty {
    /// The faults of the connection with this number.
    pub(super) fn new(faults: &Faults, number: u64) -> Self {
        let mut seeds = Chance(faults.seed);
        let seed = seeds.next() ^ number;
        let mut seeds = Chance(seed);
        Self { faults: faults.clone(), requests: Chance(seeds.next()), drawn: 0, answers: Chance(seeds.next()) }
    }

    /// The refusal of the request after `requests` requests. The outer `None` means that it was returned before.
    pub(super) fn failure(&mut self, requests: u64) -> Option<Option<Failure>> {
        if requests < self.drawn {
            return None;
        }
        self.drawn = requests + 1;
        Some((self.requests.fraction() < self.faults.error).then_some(self.faults.failure))
    }

    /// Every answer draws the same number of random numbers, whatever faults are set.
    fn fate(&mut self) -> (Fate, Duration) {
        let (drop, close, delay) = (self.answers.fraction(), self.answers.fraction(), self.answers.fraction());
        let (first, last) = (*self.faults.delay.start(), *self.faults.delay.end());
        let fate = match () {
            () if close < self.faults.close => Fate::Cut,
            () if drop < self.faults.drop => Fate::Swallowed,
            () => Fate::Sent,
        };
        (fate, first + (last - first).mul_f64(delay))
    }

    /// Sends answers, or injects faults.
    pub(super) async fn send(
        &mut self,
        stream: &mut (impl AsyncWrite + Unpin),
        answers: &Answers,
        witness: &mut Witness<'_>,
        limit: Duration,
    ) -> Option<End> {
        let now = Instant::now();
        for answer in answers.iter() {
            if is_transport(answer) {
                if let Some(end) = write(stream, answer, witness, limit).await {
                    return Some(end);
                }
                continue;
            }
            let (fate, delay) = self.fate();
            if !delay.is_zero() {
                sleep_until(now + delay).await;
            }
            if fate != Fate::Sent || !delay.is_zero() {
                witness.fault();
            }
            let end = match fate {
                Fate::Sent => write(stream, answer, witness, limit).await,
                Fate::Swallowed => None,
                Fate::Cut => Some(End::Fault),
            };
            if end.is_some() {
                return end;
            }
        }
        None
    }
}

/// Whether it is a connection confirm or a disconnect confirm.
fn is_transport(answer: &[u8]) -> bool {
    answer.get(tpkt::HEADER + 1) != Some(&cotp::DATA_LAST[1])
}

/// Splitmix64 (Steele, Lea, Flood 2014): the same numbers from the same seed in all versions, which no crate guarantees.
#[derive(Debug)]
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let number = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let number = (number ^ number >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        number ^ number >> 31
    }

    /// From 0 to below 1.
    fn fraction(&mut self) -> f64 {
        u32::try_from(self.next() >> 32).map_or(0.0, f64::from) / 4_294_967_296.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_what_is_expected() {
        let seconds = |text: &str| text.parse::<Faults>().map(|faults| faults.delay);
        assert_eq!(seconds("delay=10ms..1.5s").unwrap(), Duration::from_millis(10)..=Duration::from_millis(1500));
        let faults: Faults = "drop=1/4,error=5%,code=8104,seed=7".parse().unwrap();
        assert_eq!((faults.drop, faults.error, faults.seed), (0.25, 0.05, 7));
        assert_eq!(faults.failure, Failure::Request(ErrorCode::NOT_IMPLEMENTED));
        assert_eq!(faults.to_string(), "drop=25% error=5% code=8104 seed=7");
        assert_eq!("delay=10ms..1.5s".parse::<Faults>().unwrap().to_string(), "delay=10ms..1.5s seed=1");
        assert_eq!("delay=50ms".parse::<Faults>().unwrap().to_string(), "delay=50ms seed=1");
        for (wrong, said) in [
            ("", "delay=, drop="),
            ("drip=1%", "drip=1%"),
            ("drop=2", "1/100"),
            ("drop=101%", "101%"),
            ("drop=1/0", "1/0"),
            ("delay=50", "50ms"),
            ("delay=-1ms", "50ms"),
            ("delay=80ms..10ms", "shorter time first"),
            ("delay=61s", "a minute"),
            ("code=FF", "not FF"),
            ("code=0", "two hexadecimal digits"),
            ("seed=x", "whole number"),
        ] {
            let error = wrong.parse::<Faults>().unwrap_err();
            assert!(error.contains(said), "{wrong}: {error}");
        }
    }

    /// The numbers of the authors' generator for seed 1234567.
    #[test]
    fn the_generator_matches_the_reference_numbers() {
        let mut chance = Chance(1_234_567);
        assert_eq!(chance.next(), 6_457_827_717_110_365_317);
        assert_eq!(chance.next(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn the_same_seed_and_connection_give_the_same_faults() {
        let fates = |seed: u64, number| {
            let faults = format!("drop=10%,close=10%,seed={seed}").parse().unwrap();
            let mut faulty = Faulty::new(&faults, number);
            (0..1000).map(|_| faulty.fate().0).collect::<Vec<_>>()
        };
        assert_eq!(fates(1, 1), fates(1, 1));
        assert_ne!(fates(1, 1), fates(1, 2));
        assert_ne!(fates(1, 1), fates(2, 1));
        // Of 1000 answers, 100 are cut off, and 10 % of the other 900 are dropped; five standard deviations are less than 50.
        let count = |fate| fates(1, 1).iter().filter(|found| **found == fate).count();
        assert!(count(Fate::Cut).abs_diff(100) < 50 && count(Fate::Swallowed).abs_diff(90) < 50);
    }
}
