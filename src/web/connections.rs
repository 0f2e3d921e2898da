//! The limits of connections: their number, and how long one may be silent. A browser has one stream and a few short requests. When all places
//! are taken, a new client gets that of the one whose client has done nothing for the longest time: silent clients keep nobody out.

use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

use axum::serve::Listener;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, Sleep, sleep};

/// The number of connections at the same time.
const PLACES: usize = 128;
/// The time for a request to arrive, and for a client to read what it is sent.
const SLOWEST: Duration = Duration::from_secs(10);
/// The time that a connection may be silent between two requests. A stream sends something every second.
const SILENT: Duration = Duration::from_secs(30);
/// The time after which a silent connection loses its place to a new client, if there is no other.
const PATIENCE: Duration = Duration::from_secs(1);

/// Which clients may connect.
pub(super) type Admits = Arc<dyn Fn(IpAddr) -> bool + Send + Sync>;

/// The places of all listeners of a server.
#[derive(Clone, Default)]
pub(super) struct Places(Arc<Mutex<Vec<Arc<Seat>>>>);

impl Places {
    fn lock(&self) -> MutexGuard<'_, Vec<Arc<Seat>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A free place, or that of the connection that has been silent for the longest time.
    fn take(&self) -> Option<Place> {
        let mut seats = self.lock();
        if seats.len() >= PLACES {
            let oldest = (0..seats.len()).min_by_key(|&at| seats[at].lock().since)?;
            if seats[oldest].lock().since.elapsed() < PATIENCE {
                return None;
            }
            seats.swap_remove(oldest).give_up();
        }
        let seat = Arc::new(Seat(Mutex::new(Silence { since: Instant::now(), is_over: false, waker: None })));
        seats.push(Arc::clone(&seat));
        Some(Place { seat, places: self.clone() })
    }
}

/// A connection, seen by those that wait for its place.
struct Seat(Mutex<Silence>);

struct Silence {
    /// Since when the client has to do something.
    since: Instant,
    /// Another client has the place.
    is_over: bool,
    waker: Option<Waker>,
}

impl Seat {
    fn lock(&self) -> MutexGuard<'_, Silence> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn give_up(&self) {
        let mut silence = self.lock();
        silence.is_over = true;
        if let Some(waker) = silence.waker.take() {
            waker.wake();
        }
    }
}

/// The place of a connection, free when it is dropped.
struct Place {
    seat: Arc<Seat>,
    places: Places,
}

impl Drop for Place {
    fn drop(&mut self) {
        self.places.lock().retain(|seat| !Arc::ptr_eq(seat, &self.seat));
    }
}

/// Accepts the clients that may connect, as many as there are places.
pub(super) struct Doors {
    listener: TcpListener,
    places: Places,
    admits: Admits,
}

impl Doors {
    pub(super) fn new(listener: TcpListener, places: &Places, admits: &Admits) -> Self {
        Self { listener, places: places.clone(), admits: Arc::clone(admits) }
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
                    if let Some(place) = is_admitted.then(|| self.places.take()).flatten() {
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
    place: Place,
}

impl Connection {
    fn new(stream: TcpStream, place: Place) -> Self {
        Self { stream, waiting: Waiting::Rest, end: Box::pin(sleep(SLOWEST)), place }
    }

    /// From now on this is waited for. The time for the rest of a request does not begin anew with each byte.
    fn wait(&mut self, waiting: Waiting) {
        if waiting == self.waiting && waiting != Waiting::Request {
            return;
        }
        self.waiting = waiting;
        self.place.seat.lock().since = Instant::now();
        let time = if waiting == Waiting::Request { SILENT } else { SLOWEST };
        self.end.as_mut().reset(Instant::now() + time);
    }

    /// Whether the time is up, or the place is given away; the task is woken when it is.
    fn is_over(&mut self, context: &mut Context<'_>) -> bool {
        let mut silence = self.place.seat.lock();
        silence.waker = Some(context.waker().clone());
        silence.is_over || self.end.as_mut().poll(context).is_ready()
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
