//! The OPC UA server from outside: where it listens, and what bytes do to it. `tests/foreign/opc_ua.py` has its services, with a client of
//! another project.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::Duration;

use opennck::live::{Live, Speed};
use opennck::machine::Machine;
use opennck::opcua::{OpcUaOptions, OpcUaServer};

fn live() -> Live {
    Live::start(Machine::open("g1_example").unwrap(), Speed::default())
}

/// The first message of a client: version 0, buffers of 65,536 bytes, no limits, and an address.
fn hello() -> Vec<u8> {
    let url = b"opc.tcp://127.0.0.1:4840";
    let mut body = Vec::new();
    for number in [0_u32, 65_536, 65_536, 0, 0, u32::try_from(url.len()).unwrap()] {
        body.extend(number.to_le_bytes());
    }
    body.extend(url);
    let length = u32::try_from(8 + body.len()).unwrap();
    [b"HELF", &length.to_le_bytes()[..], &body].concat()
}

/// The first four bytes of the answer.
fn answer(address: SocketAddr, bytes: &[u8]) -> Option<[u8; 4]> {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
    stream.write_all(bytes).unwrap();
    let mut answer = [0; 4];
    stream.read_exact(&mut answer).ok().map(|()| answer)
}

#[test]
fn a_client_is_acknowledged() {
    let live = live();
    let server = OpcUaServer::open(&live, OpcUaOptions::new("127.0.0.1:0")).unwrap();
    assert_eq!(answer(server.addresses()[0], &hello()), Some(*b"ACKF"));
    drop(server);
    assert!(live.end().is_some());
}

#[test]
fn bytes_that_no_client_sends_do_not_end_the_server() {
    let live = live();
    let server = OpcUaServer::open(&live, OpcUaOptions::new("127.0.0.1:0")).unwrap();
    let address = server.addresses()[0];
    let silent: Vec<_> = (0..50).map(|_| TcpStream::connect(address).unwrap()).collect();
    for bytes in
        [&b"GET / HTTP/1.1\r\n\r\n"[..], &[0xFF; 64], b"HELF\xFF\xFF\xFF\xFF", b"OPNF\x08\0\0\0", b"MSGF\x04\0\0\0"]
    {
        assert_ne!(answer(address, bytes), Some(*b"ACKF"));
    }
    assert_eq!(answer(address, &hello()), Some(*b"ACKF"));
    drop(silent);
}

#[test]
fn an_address_that_cannot_be_used_is_refused_with_a_reason() {
    let live = live();
    let problem = |address: &str| OpcUaServer::open(&live, OpcUaOptions::new(address)).unwrap_err().to_string();
    let used = TcpListener::bind("127.0.0.1:0").unwrap();
    assert!(problem(&used.local_addr().unwrap().to_string()).contains("the port is in use"));
    assert!(problem("nonsense").contains("cannot open this address"));
}

/// Without encryption everybody in the network could write.
#[test]
fn clients_on_other_computers_need_encryption() {
    let live = live();
    let problem = OpcUaServer::open(&live, OpcUaOptions::new("0.0.0.0:0")).unwrap_err().to_string();
    assert!(problem.contains("without encryption") && problem.contains("--opcua-pki"), "{problem}");
    let insecure = OpcUaOptions { is_insecure: true, ..OpcUaOptions::new("0.0.0.0:0") };
    assert!(OpcUaServer::open(&live, insecure).is_ok());
}
