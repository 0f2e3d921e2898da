//! The brake on guessing the password: each wrong password from an address doubles the time until the next one from there is answered.
//!
//! The time counts for the address, not for the connection: many connections do not guess faster. A right password is answered after the
//! same time and ends it, so neither its speed nor a second connection tells anything earlier. Other requests are not affected, except those
//! behind the password on the same connection.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use tokio::time::Instant;

use crate::s7::session::Guess;

/// The time after the first wrong password, and the longest.
const TIMES: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(60)];
/// Addresses that are remembered; the one whose time has been over for longest is forgotten first.
const ADDRESSES: usize = 4096;

/// The wrong passwords by address.
#[derive(Debug, Default)]
pub(super) struct Guesses(Mutex<BTreeMap<IpAddr, Wrong>>);

#[derive(Clone, Copy, Debug)]
struct Wrong {
    /// How much the next wrong password adds.
    next: Duration,
    /// When the next answer may leave.
    until: Instant,
}

impl Guesses {
    /// When the answer to this password may leave.
    pub(super) fn answer_at(&self, address: IpAddr, guess: Guess, now: Instant) -> Instant {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match guess {
            Guess::Right => known.remove(&address).map_or(now, |wrong| wrong.until.max(now)),
            Guess::Wrong => {
                if known.len() >= ADDRESSES
                    && !known.contains_key(&address)
                    && let Some(oldest) = known.iter().min_by_key(|(_, wrong)| wrong.until).map(|(address, _)| *address)
                {
                    known.remove(&oldest);
                }
                let [first, most] = TIMES;
                let wrong = known.entry(address).or_insert(Wrong { next: first, until: now });
                wrong.until = wrong.until.max(now) + wrong.next;
                wrong.next = (2 * wrong.next).min(most);
                wrong.until
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use super::*;

    #[test]
    fn the_time_doubles_per_address_and_ends_with_the_right_password() {
        let (guesses, now) = (Guesses::default(), Instant::now());
        let [one, other] = [1, 2].map(|last| IpAddr::V4(Ipv4Addr::new(10, 0, 0, last)));
        let wait = |address, guess| guesses.answer_at(address, guess, now) - now;
        assert_eq!(wait(one, Guess::Right), Duration::ZERO);
        let waits: Vec<_> = (0..4).map(|_| wait(one, Guess::Wrong).as_millis()).collect();
        assert_eq!(waits, [250, 750, 1750, 3750], "parallel guesses wait for each other");
        assert_eq!(wait(other, Guess::Wrong).as_millis(), 250);
        assert_eq!(wait(one, Guess::Right).as_millis(), 3750, "the right one is not told apart by its time");
        assert_eq!(wait(one, Guess::Wrong).as_millis(), 250);
        let later = now + Duration::from_secs(1);
        assert_eq!((guesses.answer_at(other, Guess::Wrong, later) - later).as_millis(), 500);
    }

    #[test]
    fn the_number_of_addresses_is_bounded() {
        let (guesses, now) = (Guesses::default(), Instant::now());
        for number in 0..10_000_u32 {
            guesses.answer_at(IpAddr::V4(Ipv4Addr::from_bits(number)), Guess::Wrong, now);
        }
        assert_eq!(guesses.0.lock().unwrap().len(), ADDRESSES);
    }
}
