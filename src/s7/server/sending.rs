//! Sends answers to a client.

use std::future::poll_fn;
use std::pin::Pin;
use std::task::Poll;
use std::time::Duration;

use tokio::io::{AsyncWrite, AsyncWriteExt};
use tokio::time::timeout;

use super::end::End;
use super::witness::Witness;

/// Sends bytes within a time limit.
pub(super) async fn write(
    stream: &mut (impl AsyncWrite + Unpin),
    bytes: &[u8],
    witness: &mut Witness<'_>,
    limit: Duration,
) -> Option<End> {
    // The system usually takes all bytes at once; then no timer is needed.
    let taken = poll_fn(|cx| match Pin::new(&mut *stream).poll_write(cx, bytes) {
        Poll::Ready(Ok(taken)) => Poll::Ready(taken),
        Poll::Ready(Err(_)) | Poll::Pending => Poll::Ready(0), // the write below reports the error again
    });
    let left = &bytes[taken.await..];
    let written = if left.is_empty() { Ok(Ok(())) } else { timeout(limit, stream.write_all(left)).await };
    match written {
        Ok(Ok(())) => {
            witness.sent(bytes);
            None
        }
        Ok(Err(_)) => Some(End::Left),
        Err(_) => Some(End::Slow),
    }
}
