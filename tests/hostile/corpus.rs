//! Runs the corpus of the fuzz targets again, and tests that the oracle detects errors.

use std::path::Path;

use crate::oracle::Listener;
use crate::{client, conversation, grammar, isg_lists, isg_program, nc_program};

/// The files of a corpus folder, by name.
fn corpus(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let files = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = files
        .map(|file| {
            let file = file.expect("the folder can be listed");
            (file.file_name().to_string_lossy().into_owned(), std::fs::read(file.path()).expect("it was just listed"))
        })
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn tell<R>(target: &str, judge: impl Fn(&[u8]) -> R + std::panic::RefUnwindSafe) {
    for (name, input) in corpus(target) {
        if let Err(panic) = std::panic::catch_unwind(|| judge(&input)) {
            eprintln!("fuzz/corpus/{target}/{name}");
            std::panic::resume_unwind(panic);
        }
    }
}

#[test]
fn streams_of_the_corpus_pass() {
    tell("session", conversation::judge);
}

#[test]
fn requests_of_the_corpus_pass() {
    tell("requests", |input| conversation::judge(&grammar::stream(input)));
}

#[test]
fn the_client_corpus_passes() {
    tell("client", client::judge);
}

#[test]
fn nc_programs_of_the_corpus_pass() {
    tell("nc_program", nc_program::judge);
}

#[test]
fn programs_of_the_isg_kernel_of_the_corpus_pass() {
    tell("isg_program", isg_program::judge);
    let blocks = |name: &str| {
        let (_, input) = corpus("isg_program").into_iter().find(|(file, _)| file == name).expect("it is in the corpus");
        isg_program::judge(&input)
    };
    assert!(blocks("tool_change") > 10 && blocks("control_blocks") > 10);
}

#[test]
fn parameter_lists_of_the_corpus_pass() {
    tell("isg_lists", isg_lists::judge);
    let axes = |name: &str| {
        let (_, input) = corpus("isg_lists").into_iter().find(|(file, _)| file == name).expect("it is in the corpus");
        isg_lists::judge(&input)
    };
    assert_eq!([axes("isg_soft_gantry"), axes("isg_hard_gantry"), axes("unreadable")], [5, 4, 0]);
}

/// The answers are decoded; the names of the conversations give the request.
#[test]
fn a_client_gets_the_values_of_valid_answers() {
    for (name, input) in corpus("client") {
        let expected = match name.as_str() {
            "read_memory" | "fragments" => 5, // of six values
            "write" | "list" | "upload" => 2,
            "stop_and_start" => 3,
            "blocks" => 4,
            "cyclic" => 8, // three updates and five values
            _ => continue,
        };
        assert_eq!(client::judge(&input), expected, "{name}");
    }
}

#[test]
fn the_corpus_is_small() {
    for target in ["session", "requests", "client", "nc_program", "isg_program", "isg_lists"] {
        let files = corpus(target);
        let bytes: usize = files.iter().map(|(_, input)| input.len()).sum();
        assert!(files.len() <= 300 && bytes <= 200_000, "{target}: {} files, {bytes} bytes: minimise it", files.len());
    }
}

/// A read of MB0 and MB1; the oracle knows that they are 05 and 06.
const READ: [u8; 43] = [
    3, 0, 0, 43, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 7, 0, 26, 0, 0, 4, 2, 0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 0,
    0x12, 10, 0x10, 2, 0, 1, 0, 0, 0x83, 0, 0, 8,
];
/// The correct answer.
const ANSWER: [u8; 32] =
    [3, 0, 0, 32, 2, 0xF0, 0x80, 0x32, 3, 0, 0, 0, 7, 0, 2, 0, 11, 0, 0, 4, 2, 0xFF, 4, 0, 8, 5, 0, 0xFF, 4, 0, 8, 6];

/// The verdict of a listener that has seen the setup of a conversation and this request.
fn is_right(request: &[u8], answers: &[&[u8]], has_ended: bool) -> bool {
    let mut listener = Listener::new(vec![(0, vec![5, 6])]);
    let connect = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
    let confirm = [3, 0, 0, 22, 17, 0xD0, 0, 1, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 2];
    let setup = [3, 0, 0, 25, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, 0, 8, 0, 0, 0xF0, 0, 0, 1, 0, 1, 0, 0xF0];
    let agreed = [3, 0, 0, 27, 2, 0xF0, 0x80, 0x32, 3, 0, 0, 0, 1, 0, 8, 0, 0, 0, 0, 0xF0, 0, 0, 1, 0, 1, 0, 0xF0];
    for (said, answer) in [(&connect[..], &confirm[..]), (&setup, &agreed)] {
        let expected = listener.hear(said);
        listener.judge(&expected, &[answer], false);
    }
    let expected = listener.hear(request);
    std::panic::catch_unwind(move || listener.judge(&expected, answers, has_ended)).is_ok()
}

#[test]
fn the_oracle_finds_what_is_wrong() {
    assert!(is_right(&READ, &[&ANSWER], false));
    assert!(!is_right(&READ, &[], false), "silence");
    assert!(!is_right(&READ, &[], true), "the end");
    assert!(!is_right(&READ, &[&ANSWER], true), "an answer, and the end");
    assert!(!is_right(&READ, &[&ANSWER, &ANSWER], false), "two answers");
    // Each byte matters, except the reserved one of the TPKT.
    for at in (0..ANSWER.len()).filter(|at| *at != 1) {
        for change in [1, 0x80] {
            let mut answer = ANSWER;
            answer[at] ^= change;
            assert!(!is_right(&READ, &[&answer], false), "byte {at} was {:02X}: {:02X}", ANSWER[at], answer[at]);
        }
    }
    for end in 0..ANSWER.len() {
        let mut answer = ANSWER[..end].to_vec();
        assert!(!is_right(&READ, &[&answer], false), "{end} bytes");
        if let Some(length) = answer.get_mut(3) {
            *length = u8::try_from(end).unwrap();
        }
        assert!(!is_right(&READ, &[&answer], false), "a packet of {end} bytes");
    }
    assert!(!is_right(&[3, 0, 0, 7, 2, 0xF0, 0x80], &[&ANSWER], false), "an answer to nothing");
    // A refusal is an answer as well.
    let refusal = [3, 0, 0, 19, 2, 0xF0, 0x80, 0x32, 2, 0, 0, 0, 7, 0, 0, 0, 0, 0x85, 0];
    assert!(is_right(&READ, &[&refusal], false));
    // 241 bytes although 240 are negotiated.
    let item = [0x12, 10, 0x10, 2, 0, 223, 0, 1, 0x84, 0, 0, 0];
    let read = [&[3, 0, 0, 31, 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 7, 0, 14, 0, 0, 4, 1], &item[..]].concat();
    let head = [3, 0, 0, 248, 2, 0xF0, 0x80, 0x32, 3, 0, 0, 0, 7, 0, 2, 0, 227, 0, 0, 4, 1, 0xFF, 4, 6, 0xF8];
    assert!(!is_right(&read, &[&[&head[..], &[0; 223]].concat()], false), "a PDU that is too long");
}
