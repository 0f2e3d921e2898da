//! The limits of connections: their number, and how long one may be silent. A browser has one stream and a few short requests.

use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::serve::Listener;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::time::{Instant, Sleep, sleep};

/// The number of connections at the same time.
const PLACES: usize = 128;
/// The time for a request to arrive, and for a client to read what it is sent.
const SLOWEST: Duration = Duration::from_secs(10);
/// The time that a connection may be silent between two requests. A stream sends something every second.
const SILENT: Duration = Duration::from_secs(30);

/// Which clients may connect.
pub(super) type Admits = Arc<dyn Fn(IpAddr) -> bool + Send + Sync>;

/// Accepts the clients that may connect, as many as there are places.
pub(super) struct Doors {
    listener: TcpListener,
    places: Arc<Semaphore>,
    admits: Admits,
}

impl Doors {
    pub(super) fn new(listener: TcpListener, places: &Arc<Semaphore>, admits: &Admits) -> Self {
        Self { listener, places: Arc::clone(places), admits: Arc::clone(admits) }
    }

    /// The places of all listeners of a server.
    pub(super) fn places() -> Arc<Semaphore> {
        Arc::new(Semaphore::new(PLACES))
    }
}

impl Listener for Doors {
    type Io = Connection;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Connection, SocketAddr) {
        loop {
            match self.listener.accept().await {
                Ok((stream, peer)) => {
                    let is_admitted = (self.admits)(peer.ip());
                    let place = Arc::clone(&self.places).try_acquire_owned();
                    if let (true, Ok(place)) = (is_admitted, place) {
                        let _ = stream.set_nodelay(true);
                        return (Connection::new(stream, place), peer);
                    }
                    // The connection closes without an answer.
                }
                // No free handles, or the client has already disconnected.
                Err(_) => sleep(Duration::from_millis(50)).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// The side that has to do something next.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Waiting {
    /// The next request.
    Request,
    /// The rest of a request, whose first bytes have come.
    Rest,
    /// That the client reads what is sent to it.
    Reader,
}

/// A connection that ends when its client is too slow.
pub(super) struct Connection {
    stream: TcpStream,
    waiting: Waiting,
    end: Pin<Box<Sleep>>,
    _place: OwnedSemaphorePermit,
}

impl Connection {
    fn new(stream: TcpStream, place: OwnedSemaphorePermit) -> Self {
        Self { stream, waiting: Waiting::Rest, end: Box::pin(sleep(SLOWEST)), _place: place }
    }

    /// From now on this is waited for. The time for the rest of a request does not begin anew with each byte.
    fn wait(&mut self, waiting: Waiting) {
        if waiting == self.waiting && waiting != Waiting::Request {
            return;
        }
        self.waiting = waiting;
        let time = if waiting == Waiting::Request { SILENT } else { SLOWEST };
        self.end.as_mut().reset(Instant::now() + time);
    }

    /// Whether the time is up; the task is woken when it is.
    fn is_over(&mut self, context: &mut Context<'_>) -> bool {
        self.end.as_mut().poll(context).is_ready()
    }
}

fn too_slow() -> io::Error {
    io::Error::new(io::ErrorKind::TimedOut, "the client is too slow")
}

impl AsyncRead for Connection {
    fn poll_read(self: Pin<&mut Self>, context: &mut Context<'_>, into: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        let this = self.get_mut();
        let before = into.filled().len();
        let read = Pin::new(&mut this.stream).poll_read(context, into);
        if read.is_ready() && into.filled().len() > before {
            this.wait(Waiting::Rest);
        }
        if read.is_pending() && this.is_over(context) {
            return Poll::Ready(Err(too_slow()));
        }
        read
    }
}

impl AsyncWrite for Connection {
    fn poll_write(self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let this = self.get_mut();
        let written = Pin::new(&mut this.stream).poll_write(context, bytes);
        match written {
            Poll::Ready(_) => this.wait(Waiting::Request),
            Poll::Pending => {
                this.wait(Waiting::Reader);
                if this.is_over(context) {
                    return Poll::Ready(Err(too_slow()));
                }
            }
        }
        written
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}
