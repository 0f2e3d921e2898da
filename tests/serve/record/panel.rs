//! A client that writes any number of items of any type in one request, at the NCK.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

/// A client that sends arbitrary bytes.
pub(super) struct Bare(TcpStream);

impl Bare {
    pub(super) fn connect(address: SocketAddr) -> Self {
        let mut bare = Self(TcpStream::connect(address).expect("the server is there"));
        bare.0.set_read_timeout(Some(Duration::from_secs(10))).expect("it is a time");
        bare.exchange(&[3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 4]); // slot 4, the NCK's
        bare.job(&[0xF0, 0, 0, 1, 0, 1, 3, 0xC0], &[]); // a PDU of 960 bytes
        bare
    }

    pub(super) fn exchange(&mut self, packet: &[u8]) -> Vec<u8> {
        self.0.write_all(packet).expect("it is connected");
        let mut head = [0; 4];
        self.0.read_exact(&mut head).expect("a packet comes");
        let mut answer = vec![0; usize::from(u16::from_be_bytes([head[2], head[3]])) - 4];
        self.0.read_exact(&mut answer).expect("its rest comes");
        answer
    }

    /// One job; returns parameter and data of its answer.
    pub(super) fn job(&mut self, parameter: &[u8], data: &[u8]) -> Vec<u8> {
        let length = |length: usize| u16::try_from(length).expect("it is short").to_be_bytes();
        let mut packet = vec![3, 0];
        packet.extend(length(17 + parameter.len() + data.len()));
        packet.extend([2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 7]);
        packet.extend(length(parameter.len()));
        packet.extend(length(data.len()));
        packet.extend(parameter);
        packet.extend(data);
        let answer = self.exchange(&packet);
        assert_eq!(answer[13..15], [0, 0], "the job was refused: {answer:x?}");
        answer[15..].to_vec()
    }

    /// One write request; returns the code of each item.
    pub(super) fn write(&mut self, items: &[Item]) -> Vec<u8> {
        let mut parameter = vec![5, u8::try_from(items.len()).expect("few")];
        let mut data = Vec::new();
        for item in items {
            if data.len() % 2 == 1 {
                data.push(0);
            }
            parameter.extend(&item.any);
            data.extend(&item.value);
        }
        self.job(&parameter, &data)[2..].to_vec()
    }
}

/// An item of a write request, and its value.
pub(super) struct Item {
    pub(super) any: Vec<u8>,
    value: Vec<u8>,
}

pub(super) const DB: u8 = 0x84;
pub(super) const FLAGS: u8 = 0x83;

impl Item {
    /// Elements of a type, starting at a bit of an area.
    pub(super) fn new(kind: u8, count: usize, (area, block): (u8, u16), bit: u32, bytes: &[u8]) -> Self {
        let mut any = vec![0x12, 10, 0x10, kind];
        any.extend(u16::try_from(count).expect("few").to_be_bytes());
        any.extend(block.to_be_bytes());
        any.push(area);
        any.extend(&bit.to_be_bytes()[1..]);
        let (size, length) = if kind == 1 { (3, 1) } else { (4, bytes.len() * 8) };
        let mut value = vec![0, size];
        value.extend(u16::try_from(length).expect("few").to_be_bytes());
        value.extend(bytes);
        Self { any, value }
    }

    pub(super) fn bit(area: (u8, u16), byte: u32, bit: u32, value: bool) -> Self {
        Self::new(1, 1, area, byte * 8 + bit, &[u8::from(value)])
    }

    pub(super) fn bytes(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(2, bytes.len(), area, byte * 8, bytes)
    }

    pub(super) fn words(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(4, bytes.len() / 2, area, byte * 8, bytes)
    }

    pub(super) fn doubles(area: (u8, u16), byte: u32, bytes: &[u8]) -> Self {
        Self::new(6, bytes.len() / 4, area, byte * 8, bytes)
    }

    /// A REAL.
    pub(super) fn real(area: (u8, u16), byte: u32, value: f32) -> Self {
        Self::new(8, 1, area, byte * 8, &value.to_be_bytes())
    }

    /// MD34090 of the second axis.
    pub(super) fn offset_of_the_second_axis(value: f64) -> Self {
        let any = vec![0x12, 8, 0x82, 0x62, 0x85, 0x2A, 0, 1, 0x1A, 1];
        let value = [&[0, 9, 0, 8], value.to_le_bytes().as_slice()].concat();
        Self { any, value }
    }
}
