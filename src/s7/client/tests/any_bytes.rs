//! Arbitrary input from a server: no panic, no wrong value, no unbounded memory.

use proptest::prelude::*;
use tokio::runtime::Builder;

use super::*;
use crate::s7::client::conversation::Conversation;
use crate::s7::client::{BlockKind, Mode, Value};
use crate::s7::tests::{bytes, changed, packet};
use crate::s7::wire::cotp::ConnectionConfirm;
use crate::s7::wire::replies::{DataItems, Setup, UserData, upload_begun, upload_piece};

/// Almost correct answers of every kind, with some bytes changed, and cut at any position. The reference is that of the first request.
fn nearly_right() -> impl Strategy<Value = Vec<u8>> {
    let templates = [
        "32 03 00 00 00 03 00 02 00 06 00 00 04 01 FF 04 00 10 12 34",
        "32 03 00 00 00 03 00 02 00 0E 00 00 04 02 FF 04 00 08 12 00 FF 09 00 04 01 02 03 04",
        "32 03 00 00 00 03 00 02 00 04 00 00 04 01 0A 00 00 04",
        "32 03 00 00 00 03 00 02 00 01 00 00 05 01 FF",
        "32 02 00 00 00 03 00 00 00 00 81 04",
        "32 07 00 00 00 03 00 0C 00 10 00 01 12 08 12 84 01 01 01 01 00 00 FF 09 00 0C 00 11 00 00 00 02 00 02 01 02 03 04",
        "32 07 00 00 00 03 00 0C 00 0B 00 01 12 08 12 82 01 07 00 00 00 00 FF 09 00 07 00 01 FF 04 00 08 05",
        "32 07 00 00 00 00 00 0C 00 0B 00 01 12 08 12 02 01 07 00 00 00 00 FF 09 00 07 00 01 FF 04 00 08 05",
        "32 07 00 00 00 03 00 0C 00 0E 00 01 12 08 12 87 01 01 00 00 00 00 FF 09 00 0A 00 20 26 11 22 05 06 07 00 01",
        "32 03 00 00 00 03 00 10 00 00 00 00 1D 00 01 00 00 00 00 01 07 30 30 30 30 32 32 30",
        "32 03 00 00 00 03 00 02 00 08 00 00 1E 00 00 04 00 FB 01 02 03 04",
    ];
    changed((0..templates.len()).prop_map(move |at| bytes(templates[at]))).prop_map(|pdu| packet(&pdu))
}

proptest! {
    #[test]
    fn views_take_any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..300), at in any::<prop::sample::Index>()) {
        let (parameter, data) = bytes.split_at(at.index(bytes.len() + 1));
        let read: usize = DataItems::new(&bytes).map(|item| item.map_or(0, <[u8]>::len) + 4).sum();
        prop_assert!(read <= bytes.len());
        let _ = (Setup::parse(parameter), UserData::parse(parameter, data), ConnectionConfirm::parse(&bytes));
        let _ = (upload_begun(parameter), upload_piece(parameter, data));
        for text in ["MB0..2", "DB1.DBD0:REAL", "M1.1", "MW0..4", "DB10.DBX1.2..4", "nck:C/SMA/1[1..3]", "nck:C/State/actToolIdent", "T1"] {
            let variable = variable(text);
            if let Some(value) = Value::decode(&variable, &bytes) {
                // A value that was read can be written back unchanged, except texts and groups of bits.
                if !matches!(value, Value::Text(_)) && !text.contains("DBX") && text != "M1.1" {
                    prop_assert_eq!(value.encode(&variable), Ok(bytes.clone()));
                }
            }
        }
    }

    #[test]
    fn a_conversation_takes_any_bytes_in_any_pieces(pieces in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..200), 0..8)) {
        let mut conversation = Conversation::default();
        for piece in [vec![3, 0, 0, 7, 2, 0xF0, 0]].into_iter().chain(pieces) {
            if conversation.receive(&piece, |_| {}).is_err() {
                break;
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_client_takes_any_answer(answers in proptest::collection::vec(nearly_right(), 1..6), question in 0..7_u8) {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let place = Place::open().await;
            let options = Options { timeout: Duration::from_millis(20), reconnect: None, ..Options::default() };
            let (client, mut peer) = place.meet(240, 4, options).await;
            let script = async {
                let (reference, _) = peer.request().await;
                assert_eq!(reference, 3, "the templates have it");
                let _ = peer.stream.write_all(&answers.concat()).await;
                peer
            };
            let client_side = async {
                match question {
                    0 => drop(client.read_all(&variables(&["MB1", "nck:C/SMA/1:LONG"])).await),
                    1 => drop(client.write(&variable("MB1"), &Value::Byte(1)).await),
                    2 => drop(client.list(0x11, 0).await),
                    3 => drop(client.clock().await),
                    4 => drop(client.upload(BlockKind::Db, 1).await),
                    5 => drop(client.describe_block(BlockKind::Db, 1).await),
                    _ => {
                        let memory = variables(&["MB1"]);
                        if let Ok(mut values) = client.subscribe(&memory, Mode::Cycle, Duration::from_millis(1)).await {
                            let _ = tokio::time::timeout(Duration::from_millis(20), values.next()).await;
                        }
                    }
                }
            };
            let ((), _peer) = tokio::join!(client_side, script);
        });
    }
}
