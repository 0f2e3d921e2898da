//! A password that a client has given, for a server that slows down guessing.

/// A password that a client has given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guess {
    /// It is the password.
    Right,
    /// It is not.
    Wrong,
}
