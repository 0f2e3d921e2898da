//! Lost connections, and the requests in flight.

use super::*;
use crate::s7::client::{BlockKind, Client, Error, Execution, Mode, State, Value};

/// The first three pushed values of a flag byte, across lost connections.
async fn first_three(client: &Client) -> Vec<Result<Value, Error>> {
    let memory = variables(&["MB1"]);
    let mut subscription = client.subscribe(&memory, Mode::Change, Duration::from_millis(100)).await.unwrap();
    let mut values = Vec::new();
    for _ in 0..3 {
        values.extend(subscription.next().await.unwrap().unwrap().values.into_iter().map(|(_, value)| value));
    }
    values
}

#[tokio::test]
async fn reads_are_repeated_on_the_next_connection() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (_, first) = peer.request().await;
        drop(peer);
        let mut peer = place.accept(240, 1).await;
        let (reference, again) = peer.request().await;
        assert_eq!(first, again);
        peer.values(reference, &[&[7]]).await;
    };
    let memory = variable("MB1");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert_eq!(value, Ok(Value::Byte(7)));
}

#[tokio::test]
async fn writes_are_never_repeated() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (_, write) = peer.request().await;
        assert_eq!(write[0], 5);
        drop(peer);
        let mut peer = place.accept(240, 1).await;
        let (reference, next) = peer.request().await;
        assert_eq!(next[0], 4, "a read is next, not the write");
        peer.values(reference, &[&[0]]).await;
    };
    let memory = variable("MB1");
    let client_side = async {
        let error = client.write(&memory, &Value::Byte(1)).await.unwrap_err();
        assert!(
            matches!(&error, Error::Lost { what, execution: Execution::PerhapsExecuted, .. } if what == "MB1"),
            "{error:?}"
        );
        assert!(error.cure().contains("may have been executed"));
        assert_eq!(client.read(&memory).await, Ok(Value::Byte(0)));
    };
    tokio::join!(client_side, script);
}

#[tokio::test]
async fn an_unsent_request_waits_for_the_next_connection_and_is_sent_once() {
    let place = Place::open().await;
    let (client, peer) = place.meet(240, 1, quick()).await;
    let mut changes = client.changes();
    drop(peer);
    changes.wait_for(|state| matches!(state, State::Lost { .. })).await.unwrap();
    let script = async {
        let mut peer = place.accept(240, 1).await;
        let (reference, write) = peer.request().await;
        assert_eq!(write[0], 5);
        peer.answer(reference, &[5, 1], &[0xFF]).await;
    };
    let memory = variable("MB1");
    let (written, ()) = tokio::join!(client.write(&memory, &Value::Byte(1)), script);
    assert_eq!(written, Ok(()));
}

#[tokio::test]
async fn a_request_that_waits_too_long_reports_that_it_was_not_sent() {
    let place = Place::open().await;
    let options = Options { patience: Duration::from_millis(100), ..quick() };
    let (client, peer) = place.meet(240, 1, options).await;
    drop((peer, place));
    client.changes().wait_for(|state| matches!(state, State::Lost { .. })).await.unwrap();
    let error = client.write(&variable("MB1"), &Value::Byte(1)).await.unwrap_err();
    assert!(matches!(error, Error::Lost { execution: Execution::NotSent, .. }), "{error:?}");
}

#[tokio::test]
async fn without_reconnection_a_lost_connection_stays_lost() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, Options { reconnect: None, ..quick() }).await;
    let script = async {
        let _ = peer.request().await;
        drop(peer);
    };
    let memory = variable("MB1");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert!(matches!(value, Err(Error::Lost { execution: Execution::Read, .. })), "{value:?}");
    let later = client.read(&memory).await;
    assert!(matches!(later, Err(Error::Lost { execution: Execution::NotSent, .. })), "{later:?}");
    assert!(matches!(client.state(), State::Ended { .. }));
}

#[tokio::test]
async fn a_silent_server_counts_as_lost() {
    let place = Place::open().await;
    let options = Options { timeout: Duration::from_millis(50), ..quick() };
    let (client, _silent) = place.meet(240, 2, options).await;
    let [a, b] = ["MB1", "MB2"].map(variable);
    let (a, b, mut peer) = tokio::join!(client.read(&a), client.read(&b), place.accept(240, 2));
    assert!(matches!(a, Err(Error::TimedOut { .. })) && matches!(b, Err(Error::TimedOut { .. })), "{a:?} {b:?}");
    let script = async {
        let (reference, _) = peer.request().await;
        peer.values(reference, &[&[7]]).await;
    };
    let memory = variable("MB1");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert_eq!(value, Ok(Value::Byte(7)));
}

#[tokio::test]
async fn requests_are_planned_again_for_a_shorter_pdu() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(480, 1, quick()).await;
    let script = async {
        let (_, request) = peer.request().await;
        assert_eq!(request[6..8], [1, 0x2C]); // 300 bytes at once
        drop(peer);
        let mut peer = place.accept(240, 1).await;
        for length in [222, 78] {
            let (reference, request) = peer.request().await;
            assert_eq!(request[6..8], [0, length]);
            peer.values(reference, &[&vec![length; length.into()]]).await;
        }
    };
    let memory = variable("MB0..299");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert_eq!(value, Ok(Value::Bytes([vec![222; 222], vec![78; 78]].concat())));
}

#[tokio::test]
async fn subscriptions_are_renewed() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let one = |value: u8| [0, 1, 0xFF, 4, 0, 8, value];
    let script = async {
        let (reference, first) = peer.request().await;
        peer.user_data(reference, 0x82, 5, 1, &one(1)).await;
        tokio::time::sleep(Duration::from_millis(20)).await;
        drop(peer);
        let mut peer = place.accept(240, 1).await;
        let (reference, again) = peer.request().await;
        assert_eq!(first, again);
        peer.user_data(reference, 0x82, 5, 8, &one(2)).await; // with another number
        peer.user_data(0, 0x02, 5, 8, &one(3)).await;
        peer
    };
    let (values, _peer) = tokio::join!(first_three(&client), script);
    assert_eq!(values, [Ok(Value::Byte(1)), Ok(Value::Byte(2)), Ok(Value::Byte(3))]);
}

#[tokio::test]
async fn a_renewed_subscription_whose_answer_is_lost_is_asked_for_again_and_the_lost_one_is_ended() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let one = |value: u8| [0, 1, 0xFF, 4, 0, 8, value];
    let script = async {
        let (reference, first) = peer.request().await;
        peer.user_data(reference, 0x82, 5, 1, &one(1)).await;
        drop(peer);
        let mut peer = place.accept(240, 1).await;
        let (_, lost) = peer.request().await; // the module has it as number 8, and its answer is lost
        assert_eq!(first, lost);
        let (reference, again) = peer.request().await;
        assert_eq!(first, again);
        peer.user_data(reference, 0x82, 5, 9, &one(2)).await;
        peer.user_data(0, 0x02, 5, 8, &one(7)).await;
        let (reference, end) = peer.request().await;
        assert_eq!((end[6], &end[8..]), (4, &[0xFF, 9, 0, 2, 5, 8][..]));
        peer.user_data(reference, 0x82, 4, 8, &[]).await;
        peer.user_data(0, 0x02, 5, 9, &one(3)).await;
        peer
    };
    let (values, _peer) = tokio::join!(first_three(&client), script);
    assert_eq!(values, [Ok(Value::Byte(1)), Ok(Value::Byte(2)), Ok(Value::Byte(3))]);
}

#[tokio::test]
async fn reconnect_delays_grow_if_the_server_closes_on_each_request() {
    let place = Place::open().await;
    let backoff = Backoff { first: Duration::from_millis(40), most: Duration::from_secs(1) };
    let (client, mut peer) = place.meet(240, 1, Options { reconnect: Some(backoff), ..quick() }).await;
    let script = async {
        let begin = tokio::time::Instant::now();
        for _ in 0..4 {
            let _ = peer.request().await;
            drop(peer);
            peer = place.accept(240, 1).await;
        }
        // At once, then after 40 ms, 80 ms and 160 ms.
        assert!(begin.elapsed() >= Duration::from_millis(280), "{:?}", begin.elapsed());
        let (reference, _) = peer.request().await;
        peer.values(reference, &[&[7]]).await;
    };
    let memory = variable("MB1");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert_eq!(value, Ok(Value::Byte(7)));
}

#[tokio::test]
async fn a_flood_does_not_block_time_limits() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let flood = tokio::spawn(async move {
        let head = [3, 0, 0, 33, 2, 0xF0, 0x80, 0x32, 7, 0, 0, 0, 0, 0, 12, 0, 4];
        let push = [&head[..], &[0, 1, 0x12, 8, 0x12, 4, 1, 1, 0, 0, 0, 0], &[0xFF, 9, 0, 0]].concat().repeat(2000);
        while peer.stream.write_all(&push).await.is_ok() {}
    });
    let memory = variable("MB1");
    let value = tokio::time::timeout(Duration::from_secs(10), client.read(&memory)).await;
    flood.abort();
    assert!(matches!(value, Ok(Err(Error::TimedOut { execution: Execution::Read, .. }))), "{value:?}");
}

#[tokio::test]
async fn an_upload_that_fails_is_ended() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (reference, begin) = peer.request().await;
        assert_eq!(begin[0], 0x1D);
        peer.answer(reference, &[0x1D, 0, 1, 0, 0, 0, 0, 5, 7, b'0', b'0', b'0', b'0', b'0', b'9', b'0'], &[]).await;
        let (reference, piece) = peer.request().await;
        assert_eq!((piece[0], piece[7]), (0x1E, 5));
        peer.refuse(reference, 0x8104).await;
        let (reference, end) = peer.request().await;
        assert_eq!((end[0], end[7]), (0x1F, 5));
        peer.answer(reference, &[0x1F], &[]).await;
    };
    let (block, ()) = tokio::join!(client.upload(BlockKind::Db, 1), script);
    assert!(matches!(block, Err(Error::Rejected { .. })), "{block:?}");
}

#[tokio::test]
async fn an_unreachable_host_is_named_with_a_remedy() {
    let place = Place::open().await;
    let address = place.address();
    drop(place);
    let error = Client::connect(&address, quick()).await.unwrap_err();
    assert!(matches!(error, Error::Unreachable { .. }) && error.to_string().contains(&address), "{error}");
    assert!(error.cure().contains("port"));
    // A server with another protocol.
    let place = Place::open().await;
    let (address, other) = (place.address(), async {
        let (mut stream, _) = place.listener.accept().await.unwrap();
        stream.write_all(b"SSH-2.0-OpenSSH\r\n").await.unwrap();
        stream
    });
    let (error, _stream) = tokio::join!(Client::connect(&address, quick()), other);
    let error = error.unwrap_err();
    assert!(matches!(error, Error::NotAccepted { called: [1, 2], .. }), "{error:?}");
    assert!(error.cure().contains("rack 0, slot 2"));
}
