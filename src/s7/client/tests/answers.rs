//! Requests and their answers: which request gets which answer, and the behaviour of unusual servers.

use super::*;
use crate::s7::client::{Error, Execution, Mode, Value};
use crate::s7::wire::header::ErrorCode;

#[tokio::test]
async fn a_late_answer_is_dropped() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (first, _) = peer.request().await;
        let (second, _) = peer.request().await; // after the time-out of the first
        peer.values(first, &[&[1]]).await;
        peer.values(second, &[&[2]]).await;
    };
    let client_side = async {
        let late = client.read(&variable("MB1")).await;
        assert!(matches!(late, Err(Error::TimedOut { execution: Execution::Read, .. })), "{late:?}");
        assert_eq!(client.read(&variable("MB2")).await, Ok(Value::Byte(2)));
    };
    tokio::join!(client_side, script);
}

#[tokio::test]
async fn an_answer_to_another_function_is_dropped() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (reference, _) = peer.request().await;
        peer.answer(reference, &[5, 1], &[0xFF]).await;
        peer.user_data(reference, 0x84, 1, 1, &[0; 8]).await;
        peer.values(reference, &[&[7]]).await;
    };
    let memory = variable("MB1");
    let (value, ()) = tokio::join!(client.read(&memory), script);
    assert_eq!(value, Ok(Value::Byte(7)));
}

#[tokio::test]
async fn answers_may_arrive_in_any_order_and_the_number_of_jobs_is_kept() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 2, quick()).await;
    let script = async {
        let (first, _) = peer.request().await;
        let (second, _) = peer.request().await;
        let third = tokio::time::timeout(Duration::from_millis(50), peer.stream.peek(&mut [0])).await;
        assert!(third.is_err(), "two jobs were agreed");
        peer.values(second, &[&[2]]).await;
        let (third, _) = peer.request().await;
        peer.values(third, &[&[3]]).await;
        peer.values(first, &[&[1]]).await;
    };
    let [a, b, c] = ["MB1", "MB2", "MB3"].map(variable);
    let (a, b, c, ()) = tokio::join!(client.read(&a), client.read(&b), client.read(&c), script);
    assert_eq!([a, b, c], [Ok(Value::Byte(1)), Ok(Value::Byte(2)), Ok(Value::Byte(3))]);
}

#[tokio::test]
async fn one_refused_item_fails_alone() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (reference, _) = peer.request().await;
        // snap7's server sends a length of 4 after a refusal.
        peer.answer(reference, &[4, 3], &[0xFF, 4, 0, 8, 1, 0, 0x0A, 0, 0, 4, 0xFF, 4, 0, 16, 2, 3]).await;
    };
    let all = variables(&["MB1", "DB99.DBW0", "MW2"]);
    let (values, ()) = tokio::join!(client.read_all(&all), script);
    assert_eq!(values[0], Ok(Value::Byte(1)));
    assert_eq!(values[1], Err(Error::Refused { what: "DB99.DBW0".to_owned(), code: 0x0A }));
    assert_eq!(values[2], Ok(Value::Word(0x0203)));
    let error = values[1].clone().unwrap_err().to_string();
    assert_eq!(error, "DB99.DBW0: the object does not exist (return code 0A)");
}

/// snap7's server answers 20 of 25 items.
#[tokio::test]
async fn a_server_that_answers_fewer_items_is_asked_for_the_rest() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(960, 1, quick()).await;
    let script = async {
        let (reference, request) = peer.request().await;
        assert_eq!(request[1], 3);
        peer.values(reference, &[&[1], &[2]]).await;
        let (reference, request) = peer.request().await;
        assert_eq!((request[1], request[13]), (1, 3 * 8)); // MB3
        peer.values(reference, &[&[3]]).await;
    };
    let all = variables(&["MB1", "MB2", "MB3"]);
    let (values, ()) = tokio::join!(client.read_all(&all), script);
    assert_eq!(values, [Ok(Value::Byte(1)), Ok(Value::Byte(2)), Ok(Value::Byte(3))]);
}

#[tokio::test]
async fn a_server_that_refuses_several_items_is_asked_for_fewer() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(960, 1, quick()).await;
    let script = async {
        let (reference, _) = peer.request().await;
        peer.refuse(reference, 0x8500).await;
        let (reference, _) = peer.request().await;
        peer.values(reference, &[&[1]]).await;
        let (reference, _) = peer.request().await;
        peer.refuse(reference, 0x8104).await;
    };
    let all = variables(&["MB1", "MB2"]);
    let (values, ()) = tokio::join!(client.read_all(&all), script);
    assert_eq!(values[0], Ok(Value::Byte(1)));
    let error = ErrorCode::NOT_IMPLEMENTED;
    assert_eq!(values[1], Err(Error::Rejected { what: "MB2".to_owned(), error }));
}

#[tokio::test]
async fn a_value_of_another_length_is_rejected() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (reference, _) = peer.request().await;
        peer.values(reference, &[&[1]]).await;
        let (reference, _) = peer.request().await;
        peer.answer(reference, &[4, 1], &[0xFF, 4, 0xFF, 0xFF, 1]).await;
    };
    let word = variable("MW0");
    let client_side = async { [client.read(&word).await, client.read(&word).await] };
    let (values, ()) = tokio::join!(client_side, script);
    assert!(values.iter().all(|value| matches!(value, Err(Error::Unexpected { .. }))), "{values:?}");
}

#[tokio::test]
async fn nothing_is_sent_if_one_value_does_not_fit() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let writes = [(variable("MB1"), Value::Byte(1)), (variable("MB2"), Value::Word(256))];
    let results = client.write_all(&writes).await;
    assert!(results.iter().all(|result| matches!(result, Err(Error::Input { .. }))), "{results:?}");
    let nothing = tokio::time::timeout(Duration::from_millis(50), peer.request()).await;
    assert!(nothing.is_err());
}

#[tokio::test]
async fn long_lists_come_in_parts() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let (reference, request) = peer.request().await;
        assert_eq!(request[..8], [0, 1, 0x12, 4, 0x11, 0x44, 1, 0]);
        let more = [0, 1, 0x12, 8, 0x12, 0x84, 1, 9, 9, 1, 0, 0];
        let data = [0xFF, 9, 0, 10, 0, 0x11, 0, 0, 0, 4, 0, 2, 1, 2];
        peer.send(&[7, 0, 0], reference, &[], &more, &data).await;
        let (reference, request) = peer.request().await;
        assert_eq!(request[..12], [0, 1, 0x12, 8, 0x12, 0x44, 1, 9, 9, 0, 0, 0]);
        peer.user_data(reference, 0x84, 1, 9, &[3, 4, 5, 6, 7, 8]).await;
    };
    let (list, ()) = tokio::join!(client.list(0x11, 0), script);
    let list = list.unwrap();
    assert_eq!((list.list, list.record, list.count), (0x11, 4, 2));
    assert_eq!(list.records().collect::<Vec<_>>(), [[1, 2, 3, 4], [5, 6, 7, 8]]);
}

#[tokio::test]
async fn an_endless_list_is_aborted() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let script = async {
        let more = [0, 1, 0x12, 8, 0x12, 0x84, 1, 9, 9, 1, 0, 0];
        let (reference, _) = peer.request().await;
        peer.send(&[7, 0, 0], reference, &[], &more, &[0xFF, 9, 0, 0]).await;
    };
    let (list, ()) = tokio::join!(client.list(0x11, 0), script);
    assert!(matches!(list, Err(Error::Unexpected { .. })), "{list:?}");
}

#[tokio::test]
async fn pushes_go_to_their_subscribers() {
    let place = Place::open().await;
    let (client, mut peer) = place.meet(240, 1, quick()).await;
    let one = |value: u8| [0, 1, 0xFF, 4, 0, 8, value];
    let script = async {
        let (reference, request) = peer.request().await;
        // 2/1, one item, every 0.2 s.
        assert_eq!(request[5..7], [0x42, 1]);
        assert_eq!(request[12..16], [0, 1, 0, 2]);
        peer.user_data(reference, 0x82, 1, 33, &one(1)).await;
        peer.user_data(0, 0x02, 1, 34, &one(9)).await; // another job
        peer.user_data(0, 0x02, 5, 33, &one(9)).await; // another kind
        peer.user_data(0, 0x02, 1, 33, &one(2)).await;
        peer
    };
    let listening = async {
        let memory = variables(&["MB1"]);
        let mut subscription = client.subscribe(&memory, Mode::Cycle, Duration::from_millis(200)).await.unwrap();
        let mut values = Vec::new();
        for _ in 0..2 {
            values.extend(subscription.next().await.unwrap().unwrap().values);
        }
        values
    };
    let (values, mut peer) = tokio::join!(listening, script);
    assert_eq!(values, [(0, Ok(Value::Byte(1))), (0, Ok(Value::Byte(2)))]);
    // Updates without a subscription are ended.
    for job in [[1, 34], [5, 33]] {
        let (reference, request) = peer.request().await;
        assert_eq!((request[6], &request[12..14]), (4, &job[..]));
        peer.user_data(reference, 0x82, 4, 0, &[]).await;
    }
    // The receiver is gone: the subscription is ended at the next update.
    peer.user_data(0, 0x02, 1, 33, &one(3)).await;
    let (_, request) = peer.request().await;
    assert_eq!(request[5..7], [0x42, 4]);
    assert_eq!(request[12..14], [1, 33]);
}
