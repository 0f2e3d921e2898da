//! The bytes on the wire: views of received bytes that cannot read beyond their end, and emitters that cannot exceed the negotiated PDU.
//!
//! | layer | file | standard | begins with |
//! |---|---|---|---|
//! | TPKT, packets on TCP | `tpkt` | RFC 1006 | `03 00`, length of two bytes |
//! | COTP class 0, transport | `cotp` | ISO 8073, RFC 905 | length, type of the TPDU |
//! | S7 protocol data unit (PDU) | `header`, `pdu` | Siemens, not published | `32`, kind, reference |
//! | items: addresses | `items` | | `12`, length, syntax identifier |
//! | data: values | `data` | | return code, transport size, length |
//! | user data: all services except variables and jobs | `user_data` | | `00 01 12` |
//! | codes and errors as text | `codes` | | |
//! | the client's direction: its requests and their answers | `requests`, `replies` | | |
//!
//! Every function here is total: any input gives a value or a refusal, never a panic. No memory is allocated for a length field that
//! exceeds the received bytes. Numbers are big-endian on the wire unless noted otherwise.

pub mod codes;
pub mod cotp;
pub mod data;
pub mod date_and_time;
pub mod header;
pub mod items;
pub mod pdu;
pub mod replies;
pub mod requests;
pub mod tpkt;
pub mod user_data;
