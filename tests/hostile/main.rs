//! Tests of the S7 server, of NC programs and of parameter lists with input that no regular client sends: the corpus of the fuzz targets, and hostile
//! conversations, written by hand or generated.
//!
//! A separate test binary, because it uses sources of `fuzz`, which is not in the published package.
#![cfg(all(feature = "cli", feature = "s7"))]

mod answers;
#[path = "../../fuzz/src/client.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod client;
#[path = "../serve/clients.rs"]
mod clients;
#[path = "../../fuzz/src/conversation.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod conversation;
mod conversations;
mod corpus;
#[path = "../../fuzz/src/grammar.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod grammar;
#[path = "../../fuzz/src/isg_lists.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod isg_lists;
#[path = "../../fuzz/src/isg_program.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod isg_program;
#[path = "../../fuzz/src/nc_program.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod nc_program;
#[path = "../../fuzz/src/oracle.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod oracle;
