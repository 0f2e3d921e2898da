//! Requests byte by byte, compared with those of other clients.

use super::*;
use crate::s7::client::{ConnectionKind, Tsaps, Value, password};
use crate::s7::wire::data::TransportSize;
use crate::s7::wire::requests;

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
}

#[tokio::test]
async fn connection_request_and_setup_are_those_of_snap7() {
    let place = Place::open().await;
    let options = Options { pdu: 480, jobs: 1, ..quick() };
    let (address, captured) = (place.address(), async {
        let (stream, _) = place.listener.accept().await.unwrap();
        let mut peer = Peer { stream };
        let request = peer.packet().await;
        peer.stream.write_all(&[3, 0, 0, 11, 6, 0xD0, 0, 1, 0, 7, 0]).await.unwrap(); // without parameters, as some servers send it
        (request, peer.packet().await)
    });
    let (_, (request, setup)) = tokio::join!(Client::connect(&address, options), captured);
    assert_eq!(hex(&request), "03 00 00 16 11 E0 00 00 00 01 00 C0 01 0A C1 02 01 00 C2 02 01 02");
    assert_eq!(hex(&setup[7..]), "32 01 00 00 00 01 00 08 00 00 F0 00 00 01 00 01 01 E0");
}

#[test]
fn modules_are_called_by_rack_and_slot() {
    assert_eq!(Tsaps::of(ConnectionKind::ProgrammingDevice, 0, 2).called, [1, 2]);
    assert_eq!(Tsaps::of(ConnectionKind::OperatorPanel, 1, 3).called, [2, 0x23]);
    assert_eq!(Tsaps::of(ConnectionKind::Basic, 0, 1).called, [3, 1]);
    assert_eq!((Tsaps::nck().calling, Tsaps::nck().called), ([4, 0], [0x0D, 4]));
}

#[tokio::test]
async fn reads_and_writes_are_those_of_snap7() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(480, 1, quick()).await;
    let captured = async {
        let (reference, read) = peer.request().await;
        peer.values(reference, &[&[0; 16], &[0], &[0x12, 0x34]]).await;
        let (reference, write) = peer.request().await;
        peer.answer(reference, &[5, 3], &[0xFF, 0xFF, 0xFF]).await;
        (read, write)
    };
    // DB1.DBB0 to 15, M10.3, T5.
    let all = variables(&["DB1.DBB0..15", "M10.3", "T5"]);
    let writes = [
        (variable("DB1.DBD4"), Value::DoubleWord(0x1122_3344)),
        (variable("M10.3"), Value::Bit(true)),
        (variable("DB1.DBB9"), Value::Byte(0xAA)),
    ];
    let (values, (read, write)) = tokio::join!(
        async {
            let values = client.read_all(&all).await;
            assert!(client.write_all(&writes).await.iter().all(Result::is_ok));
            values
        },
        captured
    );
    assert_eq!(
        hex(&read),
        "04 03 12 0A 10 02 00 10 00 01 84 00 00 00 12 0A 10 01 00 01 00 00 83 00 00 53 12 0A 10 1D 00 01 00 00 1D 00 00 05"
    );
    assert_eq!(values[2], Ok(Value::Word(0x1234)));
    assert_eq!(
        hex(&write),
        "05 03 12 0A 10 02 00 04 00 01 84 00 00 20 12 0A 10 01 00 01 00 00 83 00 00 53 12 0A 10 02 00 01 00 01 84 00 00 48 \
         00 04 00 20 11 22 33 44 00 03 00 01 01 00 00 04 00 08 AA"
    );
}

#[test]
fn other_requests_are_as_captured() {
    assert_eq!(hex(&requests::start(&[])), "28 00 00 00 00 00 00 FD 00 00 09 50 5F 50 52 4F 47 52 41 4D");
    assert_eq!(
        hex(&requests::start(requests::COLD)),
        "28 00 00 00 00 00 00 FD 00 02 43 20 09 50 5F 50 52 4F 47 52 41 4D"
    );
    assert_eq!(hex(&requests::stop()), "29 00 00 00 00 00 09 50 5F 50 52 4F 47 52 41 4D");
    let name = requests::block_name(b'A', 1000);
    assert_eq!(hex(&requests::start_upload(name)), "1D 00 00 00 00 00 00 00 09 5F 30 41 30 31 30 30 30 41");
    assert_eq!(hex(&requests::upload(0x1E, [0, 0, 0, 1])), "1E 00 00 00 00 00 00 01");
    // List 0011, as requested by nmap.
    assert_eq!(hex(&requests::user_data(4, 1)), "00 01 12 04 11 44 01 00");
    assert_eq!(hex(&requests::payload(&[0, 0x11, 0, 1])), "FF 09 00 04 00 11 00 01");
    assert_eq!(hex(&requests::payload(&[])), "0A 00 00 00");
    assert_eq!(hex(&requests::next_part(4, 1, 7, 7)), "00 01 12 08 12 44 01 07 07 00 00 00");
}

/// The encoding is the reverse of the server's: each byte XORed with 55 and the encoded byte two positions before.
#[test]
fn passwords_are_folded() {
    let folded = requests::folded(password("pass").unwrap());
    let unfolded: Vec<u8> = (0..8).map(|at| folded[at] ^ 0x55 ^ if at < 2 { 0 } else { folded[at - 2] }).collect();
    assert_eq!(unfolded, b"pass    ");
    assert_eq!(password("much too long"), None);
}

#[test]
fn values_are_sent_with_their_length() {
    let mut out = Vec::new();
    requests::put_value(TransportSize::BYTES, &[1, 2], &mut out);
    requests::put_value(TransportSize::OCTETS, &[1, 2], &mut out);
    requests::put_value(TransportSize::BIT, &[1], &mut out);
    assert_eq!(hex(&out), "00 04 00 10 01 02 00 09 00 02 01 02 00 03 00 01 01");
}
