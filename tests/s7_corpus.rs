//! The corpus of the fuzz targets, told again: what once led somewhere new still ends as it has to. And the oracle itself, which
//! finds what it is for.
#![cfg(feature = "s7")]

#[path = "../fuzz/src/conversation.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod conversation;
#[path = "../fuzz/src/grammar.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod grammar;
#[path = "../fuzz/src/oracle.rs"]
#[expect(unreachable_pub, reason = "it is the fuzz targets' too")]
mod oracle;

use std::path::Path;

/// The files of a folder of the corpus, by name.
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

fn tell(target: &str, judge: impl Fn(&[u8]) + std::panic::RefUnwindSafe) {
    for (name, input) in corpus(target) {
        if let Err(panic) = std::panic::catch_unwind(|| judge(&input)) {
            eprintln!("fuzz/corpus/{target}/{name}");
            std::panic::resume_unwind(panic);
        }
    }
}

#[test]
fn streams_end_as_they_have_to() {
    tell("session", conversation::judge);
}

#[test]
fn requests_end_as_they_have_to() {
    tell("requests", |input| conversation::judge(&grammar::stream(input)));
}

#[test]
fn the_corpus_is_small() {
    let files = [corpus("session"), corpus("requests")].concat();
    let bytes: usize = files.iter().map(|(_, input)| input.len()).sum();
    assert!(files.len() <= 300 && bytes <= 300_000, "{} files, {bytes} bytes: minimise it", files.len());
}
