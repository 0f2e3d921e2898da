//! New clients: each is admitted and served in its own task, or rejected.

use std::future::Future;
use std::io;
use std::net::SocketAddr;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use socket2::{SockRef, TcpKeepalive};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, watch};
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

use super::conversation::Conversation;
use super::{Server, Stations};

/// How long to wait for the place of a client that was asked to disconnect.
const GIVING_WAY: Duration = Duration::from_secs(1);

impl<S: Stations> Server<S> {
    /// Serves all clients of a listener until the end. Requests in progress are still answered. One server may run on several listeners;
    /// its limits apply to all of them together.
    pub async fn run(self: Arc<Self>, listener: TcpListener, end: impl Future<Output = ()>) {
        let (ending, ended) = watch::channel(false);
        let mut conversations = JoinSet::new();
        let mut end = pin!(end);
        loop {
            tokio::select! {
                () = &mut end => break,
                Some(_) = conversations.join_next() => {}
                accepted = listener.accept() => match accepted {
                    Ok((stream, peer)) => {
                        if let Some(place) = self.admit(&stream, peer) {
                            conversations.spawn(Arc::clone(&self).attend(stream, peer, ended.clone(), place));
                        }
                    }
                    Err(error) => {
                        // No free handles, or the client has already disconnected. Other clients may still connect.
                        tracing::warn!("cannot accept a client: {error}");
                        sleep(Duration::from_millis(50)).await;
                    }
                },
            }
        }
        drop(listener);
        ending.send_replace(true);
        let _ = timeout(self.limits.end, async { while conversations.join_next().await.is_some() {} }).await;
        conversations.shutdown().await;
    }

    /// A place for a client that may connect. The place is `None` if a silent client was asked to disconnect first.
    fn admit(&self, stream: &TcpStream, peer: SocketAddr) -> Option<Option<OwnedSemaphorePermit>> {
        let networks = &self.limits.networks;
        if !networks.is_empty() && !networks.iter().any(|network| network.contains(peer.ip())) {
            self.counters.foreign.add(1);
            self.flood.log(|| tracing::warn!("{peer} rejected: not in an allowed network"));
            return None;
        }
        let place = Arc::clone(&self.places).try_acquire_owned().ok();
        if place.is_none() && !self.strangers.send_oldest_away() {
            self.send_away(peer);
            return None;
        }
        // The server also works without these options, only more slowly.
        let _ = stream.set_nodelay(true);
        let keep_alive = TcpKeepalive::new().with_time(Duration::from_secs(30));
        let _ = SockRef::from(stream).set_tcp_keepalive(&keep_alive);
        Some(place)
    }

    fn send_away(&self, peer: SocketAddr) {
        self.counters.crowded.add(1);
        self.flood.log(|| tracing::warn!("{peer} rejected: client limit ({}) reached", self.limits.clients));
    }

    async fn attend(
        self: Arc<Self>,
        stream: TcpStream,
        peer: SocketAddr,
        ended: watch::Receiver<bool>,
        place: Option<OwnedSemaphorePermit>,
    ) {
        let place = match place {
            Some(place) => place,
            None => match timeout(GIVING_WAY, Arc::clone(&self.places).acquire_owned()).await {
                Ok(Ok(place)) => place,
                Ok(Err(_)) | Err(_) => return self.send_away(peer),
            },
        };
        let _counted = Counted::new(&self.clients);
        let mut conversation = Conversation::new(&self, peer, stream);
        let end = conversation.hold(ended).await;
        conversation.close(end).await;
        drop(place);
    }
}

/// Counts a client during its lifetime.
struct Counted<'a>(&'a AtomicUsize);

impl<'a> Counted<'a> {
    fn new(count: &'a AtomicUsize) -> Self {
        count.fetch_add(1, Ordering::Relaxed);
        Self(count)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Opens all addresses of a text such as `127.0.0.1:10102`, `[::1]:10102` or `localhost:10102`. If a name has several addresses, those of a
/// protocol that this computer does not support are skipped.
///
/// # Errors
/// The address does not belong to this computer, or its port is in use.
pub async fn listen(address: &str) -> io::Result<Vec<TcpListener>> {
    let mut listeners = Vec::new();
    let mut nowhere = io::Error::from(io::ErrorKind::AddrNotAvailable);
    for address in tokio::net::lookup_host(address).await? {
        match TcpListener::bind(address).await {
            Ok(listener) => listeners.push(listener),
            Err(error) if matches!(error.kind(), io::ErrorKind::AddrNotAvailable | io::ErrorKind::Unsupported) => {
                nowhere = error;
            }
            Err(error) => return Err(error),
        }
    }
    if listeners.is_empty() { Err(nowhere) } else { Ok(listeners) }
}
