//! The bare echo: one thread, one epoll, and an answer of fixed length for each request of fixed length. It knows no protocol; its cost is
//! the cost of moving the bytes by the system.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};

use mio::net::{TcpListener, TcpStream};
use mio::{Events, Interest, Poll, Token};

use crate::load::{ANSWER, REQUEST};

const LISTENER: Token = Token(0);

/// One client, and the number of received bytes of its current request.
struct Client {
    stream: TcpStream,
    begun: usize,
}

/// Serves until the process is ended.
pub(crate) fn serve() -> io::Result<()> {
    let mut poll = Poll::new()?;
    let mut listener = TcpListener::bind(([127, 0, 0, 1], 0).into())?;
    poll.registry().register(&mut listener, LISTENER, Interest::READABLE)?;
    println!("ready {}", listener.local_addr()?.port());
    let (mut clients, mut next) = (BTreeMap::new(), 1);
    let mut events = Events::with_capacity(1024);
    let mut space = vec![0; 64 * 1024];
    let answers = vec![0xAA; ANSWER * (space.len() / REQUEST + 1)];
    loop {
        poll.poll(&mut events, None)?;
        for event in &events {
            if event.token() == LISTENER {
                while let Ok((mut stream, _)) = listener.accept() {
                    stream.set_nodelay(true)?;
                    poll.registry().register(&mut stream, Token(next), Interest::READABLE)?;
                    clients.insert(Token(next), Client { stream, begun: 0 });
                    next += 1;
                }
            } else if let Some(client) = clients.get_mut(&event.token())
                && !answer(client, &mut space, &answers)
            {
                clients.remove(&event.token());
            }
        }
    }
}

/// Answers all received requests in one write; returns whether the client is still connected.
fn answer(client: &mut Client, space: &mut [u8], answers: &[u8]) -> bool {
    loop {
        let count = match client.stream.read(space) {
            Ok(0) => return false,
            Ok(count) => count,
            Err(error) => return error.kind() == ErrorKind::WouldBlock,
        };
        let come = client.begun + count;
        client.begun = come % REQUEST;
        let mut left = &answers[..come / REQUEST * ANSWER];
        while !left.is_empty() {
            match client.stream.write(left) {
                Ok(written) => left = &left[written..],
                Err(error) if error.kind() == ErrorKind::WouldBlock => std::thread::yield_now(),
                Err(_) => return false,
            }
        }
        if count < space.len() {
            return true; // all bytes were read, so the next ones cause a new event
        }
    }
}
