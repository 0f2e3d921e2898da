//! The bytes on the wire: what was received as views that cannot be read beyond their end, and emitters that cannot exceed
//! what was negotiated.
//!
//! | layer | file | standard | begins with |
//! |---|---|---|---|
//! | TPKT, packets on TCP | `tpkt` | RFC 1006 | `03 00`, length of two bytes |
//! | COTP class 0, transport | `cotp` | ISO 8073, RFC 905 | length, type of the TPDU |
//! | S7 protocol data unit (PDU) | `header`, `pdu` | Siemens, not published | `32`, kind, reference |
//! | items: what is meant | `items` | | `12`, length, syntax identifier |
//! | data: its value | `data` | | return code, transport size, length |
//! | user data: everything that is no variable | `user_data` | | `00 01 12` |
//! | codes and errors, in words | `codes` | | |
//! | the client's direction: what it asks, what it is answered | `requests`, `replies` | | |
//!
//! Every function here is total: any bytes give a value or a refusal, none gives a panic, and nothing is allocated for a
//! length field that the bytes received do not cover. Numbers are big-endian on the wire unless a line says otherwise.

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
