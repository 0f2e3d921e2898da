//! Shared by the tests of the served machine: the first packets of a client, rust7 as a client, and bare sockets.
#![allow(dead_code, reason = "each test takes what it needs")]

use std::io::Read;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use rust7::S7Client;

/// The connection request of most clients.
pub(super) const CONNECT: [u8; 22] = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];

/// Setup communication: one job, a PDU of this size.
pub(super) const fn setup(pdu: u16) -> [u8; 25] {
    let [high, low] = pdu.to_be_bytes();
    [3, 0, 0, 25, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, 0, 8, 0, 0, 0xF0, 0, 0, 1, 0, 1, high, low]
}

/// rust7, connected to the PLC: rack 0, slot 2.
pub(super) fn client(address: SocketAddr) -> S7Client {
    let mut client = S7Client::new();
    client.set_connection_port(address.port()).expect("it is not connected yet");
    client.set_timeout(5000, 5000, 5000).expect("it is not connected yet");
    client.connect_rack_slot(&address.ip().to_string(), 0, 2).expect("the server is there");
    client
}

/// A socket that has sent nothing yet.
pub(super) fn bare(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("the server is there");
    stream.set_read_timeout(Some(Duration::from_secs(20))).expect("it is a time");
    stream
}

/// The next packet; `None` when the connection has ended.
pub(super) fn next(stream: &mut TcpStream) -> Option<Vec<u8>> {
    let mut packet = vec![0; 4];
    stream.read_exact(&mut packet).ok()?;
    packet.resize(usize::from(u16::from_be_bytes([packet[2], packet[3]])), 0);
    stream.read_exact(&mut packet[4..]).ok()?;
    Some(packet)
}

/// The next packet, which must arrive.
#[track_caller]
pub(super) fn packet(stream: &mut TcpStream) -> Vec<u8> {
    next(stream).expect("a packet comes")
}
