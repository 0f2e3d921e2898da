//! Tests of the client against scripted servers, byte by byte. Requests are compared with captured requests of snap7's client, python-snap7
//! and nmap; tests against a real server are in `tests/serve/s7_client.rs`.

mod answers;
mod any_bytes;
mod reconnecting;
mod requests;

use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};

use super::{Backoff, Client, Options, Variable};

/// A listener to connect to.
struct Place {
    listener: TcpListener,
}

impl Place {
    async fn open() -> Self {
        Self { listener: TcpListener::bind("127.0.0.1:0").await.unwrap() }
    }

    fn address(&self) -> String {
        self.listener.local_addr().unwrap().to_string()
    }

    /// Accepts a connection and agrees to a PDU and a number of jobs.
    async fn accept(&self, pdu: u16, jobs: u16) -> Peer {
        let (stream, _) = self.listener.accept().await.unwrap();
        let mut peer = Peer { stream };
        let request = peer.packet().await;
        assert_eq!(request[5], 0xE0, "a connection request");
        let confirm = [3, 0, 0, 22, 17, 0xD0, 0, 1, 0, 7, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
        peer.stream.write_all(&confirm).await.unwrap();
        let (reference, setup) = peer.request().await;
        assert_eq!(setup[0], 0xF0, "setup communication");
        let ([p1, p0], [j1, j0]) = (pdu.to_be_bytes(), jobs.to_be_bytes());
        peer.answer(reference, &[0xF0, 0, j1, j0, j1, j0, p1, p0], &[]).await;
        peer
    }

    /// A client and its peer.
    async fn meet(&self, pdu: u16, jobs: u16, options: Options) -> (Client, Peer) {
        let address = self.address();
        let (client, peer) = tokio::join!(Client::connect(&address, options), self.accept(pdu, jobs));
        (client.unwrap(), peer)
    }
}

/// The other side of a client.
struct Peer {
    stream: TcpStream,
}

impl Peer {
    async fn packet(&mut self) -> Vec<u8> {
        let mut packet = vec![0; 4];
        self.stream.read_exact(&mut packet).await.unwrap();
        packet.resize(usize::from(u16::from_be_bytes([packet[2], packet[3]])), 0);
        self.stream.read_exact(&mut packet[4..]).await.unwrap();
        packet
    }

    /// The next request: its reference, and the bytes after its header of ten bytes.
    async fn request(&mut self) -> (u16, Vec<u8>) {
        let packet = self.packet().await;
        assert_eq!(packet[4..8], [2, 0xF0, 0x80, 0x32]);
        (u16::from_be_bytes([packet[11], packet[12]]), packet[17..].to_vec())
    }

    /// An acknowledgement with data.
    async fn answer(&mut self, reference: u16, parameter: &[u8], data: &[u8]) {
        self.send(&[3, 0, 0], reference, &[0, 0], parameter, data).await;
    }

    /// A refusal of the whole request.
    async fn refuse(&mut self, reference: u16, error: u16) {
        self.send(&[2, 0, 0], reference, &error.to_be_bytes(), &[], &[]).await;
    }

    /// User data: an answer (`80`) or a push (`00`) of a group and function.
    async fn user_data(&mut self, reference: u16, kind_group: u8, function: u8, sequence: u8, payload: &[u8]) {
        let parameter = [0, 1, 0x12, 8, 0x12, kind_group, function, sequence, 0, 0, 0, 0];
        let [high, low] = u16::try_from(payload.len()).unwrap().to_be_bytes();
        let data = [&[0xFF, 9, high, low], payload].concat();
        self.send(&[7, 0, 0], reference, &[], &parameter, &data).await;
    }

    async fn send(&mut self, kind: &[u8; 3], reference: u16, error: &[u8], parameter: &[u8], data: &[u8]) {
        let word = |number: usize| u16::try_from(number).unwrap().to_be_bytes();
        let (parameters, datas) = (word(parameter.len()), word(data.len()));
        let head = [&[0x32], &kind[..], &reference.to_be_bytes(), &parameters, &datas, error].concat();
        let length = word(7 + head.len() + parameter.len() + data.len());
        let packet = [&[3, 0, length[0], length[1], 2, 0xF0, 0x80], &head[..], parameter, data].concat();
        self.stream.write_all(&packet).await.unwrap();
    }

    /// Answers a read request with these bytes, one item each.
    async fn values(&mut self, reference: u16, values: &[&[u8]]) {
        let mut data = Vec::new();
        for value in values {
            if data.len() % 2 == 1 {
                data.push(0);
            }
            let [high, low] = u16::try_from(value.len() * 8).unwrap().to_be_bytes();
            data.extend_from_slice(&[&[0xFF, 4, high, low], *value].concat());
        }
        self.answer(reference, &[4, u8::try_from(values.len()).unwrap()], &data).await;
    }
}

/// Short times, so that the tests are fast.
fn quick() -> Options {
    Options {
        timeout: Duration::from_millis(300),
        patience: Duration::from_secs(5),
        reconnect: Some(Backoff { first: Duration::from_millis(10), most: Duration::from_millis(50) }),
        ..Options::default()
    }
}

fn variable(text: &str) -> Variable {
    text.parse().unwrap()
}

fn variables(texts: &[&str]) -> Vec<Variable> {
    texts.iter().map(|text| variable(text)).collect()
}
