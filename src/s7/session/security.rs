//! Passwords. A client gives the password for its connection. It is valid until it is taken back or the connection ends.
//!
//! On the wire the eight characters are encoded: the first two are XORed with `55`, each further one with `55` and the encoded character
//! two positions before.

use super::Session;
use super::exchange::Exchange;
use super::guess::Guess;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::user_data::Request;

impl Session {
    /// The password that was given since the last call, for a server that slows down guessing.
    pub fn take_guess(&mut self) -> Option<Guess> {
        self.guess.take()
    }

    /// Whether this client may use functions of this protection level.
    pub(super) fn permit(&self, level: u8, exchange: &Exchange<'_>) -> Result<(), ErrorCode> {
        let is_protected = exchange.station.protection().level >= level;
        if is_protected && !self.knows_password { Err(ErrorCode::PROTECTED) } else { Ok(()) }
    }

    pub(super) fn give_password(
        &mut self,
        request: &Request<'_>,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), ErrorCode> {
        let given = <[u8; 8]>::try_from(request.payload).map_err(|_| ErrorCode::NOT_SUPPORTED)?;
        match exchange.station.protection().password {
            None => return Err(ErrorCode::NO_PASSWORD),
            Some(password) if password != unfolded(given) => {
                self.guess = Some(Guess::Wrong);
                return Err(ErrorCode::WRONG_PASSWORD);
            }
            Some(_) => (self.knows_password, self.guess) = (true, Some(Guess::Right)),
        }
        self.acknowledge(request, exchange);
        Ok(())
    }

    pub(super) fn take_password_back(
        &mut self,
        request: &Request<'_>,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), ErrorCode> {
        if exchange.station.protection().password.is_none() {
            return Err(ErrorCode::NO_PASSWORD);
        }
        self.knows_password = false;
        self.acknowledge(request, exchange);
        Ok(())
    }
}

fn unfolded(given: [u8; 8]) -> [u8; 8] {
    std::array::from_fn(|at| given[at] ^ 0x55 ^ if at < 2 { 0 } else { given[at - 2] })
}
