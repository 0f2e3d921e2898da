//! The brake on guessing the password: each wrong password from an address doubles the time until the next one from there is answered.
//!
//! The time counts for the address, not for the connection: many connections do not guess faster. They take turns. A password that has its
//! turn and is right is answered at once and ends the brake. A wrong one takes its time, also if its connection closes meanwhile: a client
//! that does not wait for the answer learns nothing earlier. A password whose connection closes before its turn leaves the queue and costs
//! nothing. Other requests are not affected, except those behind the password on the same connection.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::Mutex as Turns;
use tokio::time::{Instant, sleep_until};

use crate::s7::session::Guess;

/// The time after the first wrong password, and the longest.
const TIMES: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(60)];
/// Addresses that are remembered; the one whose time has been over for longest is forgotten first.
const ADDRESSES: usize = 4096;

/// The wrong passwords by address.
#[derive(Debug, Default)]
pub(super) struct Guesses(Mutex<BTreeMap<IpAddr, Wrong>>);

#[derive(Debug)]
struct Wrong {
    /// How much the next wrong password adds.
    next: Duration,
    /// When the time of the last one is over.
    until: Instant,
    /// The passwords from this address take turns.
    turns: Arc<Turns<()>>,
}

impl Wrong {
    fn new() -> Self {
        Self { next: TIMES[0], until: Instant::now(), turns: Arc::default() }
    }
}

impl Guesses {
    /// Waits until the answer to this password may leave. Dropped when the connection closes, it leaves the queue.
    pub(super) async fn wait(&self, address: IpAddr, guess: Guess) {
        let known = self.known().get(&address).map(|wrong| Arc::clone(&wrong.turns));
        let turns = match (known, guess) {
            (Some(turns), _) => turns,
            (None, Guess::Right) => return,
            (None, Guess::Wrong) => Arc::clone(&row(&mut self.known(), address).turns),
        };
        let _turn = turns.lock().await;
        // Another one may have had its turn meanwhile.
        let before = self.known().get(&address).map_or_else(Instant::now, |wrong| wrong.until);
        sleep_until(before).await;
        match guess {
            Guess::Right => self.note_right(address),
            Guess::Wrong => {
                let until = self.note_wrong(address);
                sleep_until(until).await;
            }
        }
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<IpAddr, Wrong>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the brake. The row stays, so that those who wait for their turn and those who come later are in one queue.
    fn note_right(&self, address: IpAddr) {
        if let Some(wrong) = self.known().get_mut(&address) {
            (wrong.next, wrong.until) = (TIMES[0], Instant::now());
        }
    }

    /// Counts a wrong password, and returns when its time is over.
    fn note_wrong(&self, address: IpAddr) -> Instant {
        let [_, most] = TIMES;
        let mut known = self.known();
        let wrong = row(&mut known, address);
        wrong.until = Instant::now() + wrong.next;
        wrong.next = (2 * wrong.next).min(most);
        wrong.until
    }
}

/// The row of an address. A new one may replace the oldest one.
fn row(known: &mut BTreeMap<IpAddr, Wrong>, address: IpAddr) -> &mut Wrong {
    if known.len() >= ADDRESSES
        && !known.contains_key(&address)
        && let Some(oldest) = known.iter().min_by_key(|(_, wrong)| wrong.until).map(|(address, _)| *address)
    {
        known.remove(&oldest);
    }
    known.entry(address).or_insert_with(Wrong::new)
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use tokio::time::timeout;

    use super::*;

    const ONE: IpAddr = IpAddr::V4(Ipv4Addr::new(10, 0, 0, 1));
    const OTHER: IpAddr = IpAddr::V4(Ipv4Addr::new(10, 0, 0, 2));

    /// How long a password waits, in ms.
    async fn waits(guesses: &Guesses, address: IpAddr, guess: Guess) -> u128 {
        let begin = Instant::now();
        guesses.wait(address, guess).await;
        begin.elapsed().as_millis()
    }

    #[tokio::test(start_paused = true)]
    async fn the_time_doubles_per_address_and_ends_with_the_right_password() {
        let guesses = Guesses::default();
        assert_eq!(waits(&guesses, ONE, Guess::Right).await, 0);
        // 250 + 500 + 1000 ms: parallel guesses wait for each other. Then the right one, and a wrong one at the first time again.
        let found = tokio::join!(
            waits(&guesses, ONE, Guess::Wrong),
            waits(&guesses, ONE, Guess::Wrong),
            waits(&guesses, ONE, Guess::Wrong),
            waits(&guesses, ONE, Guess::Right),
            waits(&guesses, OTHER, Guess::Wrong),
            waits(&guesses, ONE, Guess::Wrong),
        );
        assert_eq!(found, (250, 750, 1750, 1750, 250, 2000));
        assert_eq!(waits(&guesses, OTHER, Guess::Wrong).await, 500);
    }

    #[tokio::test(start_paused = true)]
    async fn after_the_right_password_all_guesses_from_an_address_are_in_one_queue() {
        let guesses = Guesses::default();
        // The third one comes after the right one, while the second one still has its time of 250 ms: 250 + 500 ms.
        let late = async {
            tokio::time::sleep(Duration::from_millis(300)).await;
            waits(&guesses, ONE, Guess::Wrong).await
        };
        let found = tokio::join!(
            waits(&guesses, ONE, Guess::Wrong),
            waits(&guesses, ONE, Guess::Right),
            waits(&guesses, ONE, Guess::Wrong),
            late,
        );
        assert_eq!(found, (250, 250, 500, 700));
    }

    #[tokio::test(start_paused = true)]
    async fn a_guess_of_a_closed_connection_costs_no_more_than_its_own_delay_and_never_queues() {
        let guesses = Guesses::default();
        // Thirty connections guess and close after 5 ms: one had its turn, and 29 were waiting.
        let closed = (0..30).map(|_| timeout(Duration::from_millis(5), guesses.wait(ONE, Guess::Wrong)));
        let mut closed: Vec<_> = closed.map(Box::pin).collect();
        std::future::poll_fn(|cx| {
            closed.retain_mut(|closed| closed.as_mut().poll(cx).is_pending());
            if closed.is_empty() { std::task::Poll::Ready(()) } else { std::task::Poll::Pending }
        })
        .await;
        // The right password waits for the rest of the first 250 ms, and the next wrong one has the first time again.
        assert_eq!(waits(&guesses, ONE, Guess::Right).await, 245);
        assert_eq!(waits(&guesses, ONE, Guess::Wrong).await, 250);
    }

    #[tokio::test(start_paused = true)]
    async fn a_client_that_does_not_wait_for_the_answer_guesses_no_faster() {
        let guesses = Guesses::default();
        let begin = Instant::now();
        // Four wrong passwords, each given up 5 ms after a right one would have been answered.
        for doubled in [250, 500, 1000, 2000] {
            let due = guesses.known().get(&ONE).map_or_else(Instant::now, |wrong| wrong.until);
            let patience = due - Instant::now() + Duration::from_millis(5);
            timeout(patience, guesses.wait(ONE, Guess::Wrong)).await.unwrap_err();
            assert_eq!(guesses.known()[&ONE].next.as_millis(), 2 * doubled);
        }
        // 250 + 500 + 1000 ms passed before the fourth one had its turn, which was given up 5 ms later.
        assert_eq!(begin.elapsed().as_millis(), 1755);
    }

    #[tokio::test(start_paused = true)]
    async fn the_number_of_addresses_is_bounded() {
        let guesses = Guesses::default();
        for number in 0..10_000_u32 {
            guesses.note_wrong(IpAddr::V4(Ipv4Addr::from_bits(number)));
        }
        assert_eq!(guesses.known().len(), ADDRESSES);
    }
}
