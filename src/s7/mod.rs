//! THE S7 SERVER AND CLIENT: S7 communication, with which operator panels, data collectors and test tools access PLC and NCK.
//!
//! [`wire`] has the formats. [`Session`] is the conversation with one client without a socket (bytes in, answers out), and [`Station`] is
//! the data that it serves. [`Bridge`] is the station of this simulator: it reads the [`Memory`](crate::image::Memory) of one step, and
//! collects commands for the start of the next step. [`variables::nc`](crate::variables::nc) is the catalogue of
//! NC variables.
//!
//! ```
//! use opennck::image::{Memory, Names};
//! use opennck::s7::{Answers, Bridge, Directory, Session, Settings};
//! use opennck::variables::Variables;
//!
//! let (memory, names, variables) = (Memory::new(), Names::default(), Variables::default());
//! let directory = Directory::of(&memory, names.profile);
//! let mut station = Bridge::new(&memory, &variables, &names, &directory);
//! let (mut session, mut answers) = (Session::new(Settings::default()), Answers::default());
//! // The connection request of most clients and its confirm: 22 bytes each; the confirm repeats the TSAPs.
//! let request = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
//! session.receive(&request, &mut station, &mut answers);
//! assert_eq!(answers.bytes()[5], 0xD0);
//! ```
//!
//! A session uses no clock and no socket: the time comes from [`Session::tick`], bytes from [`Session::receive`]. [`server`] does both for
//! many clients; [`live`] is the server of a machine in real time.

pub mod wire;

mod bridge;
pub mod client;
mod command;
mod directory;
pub mod live;
mod nck;
mod protected;
pub mod server;
mod session;
mod station;

#[cfg(test)]
mod tests;

pub use bridge::{Bridge, Machinery};
pub use command::Command;
pub use directory::Directory;
pub use protected::Protected;
pub use session::{Connection, Failure, Session, Settings};
pub use station::{
    Areas, BlockInfo, Blocks, Cpu, CpuState, Diagnosis, Identity, NcVariables, Protection, Restart, Station, Write,
    WrittenValue,
};
pub use wire::data::Refusal;
pub use wire::date_and_time::DateAndTime;
pub use wire::pdu::Answers;
