//! Comments, continued lines, skipped blocks.

use super::{Channel, blocks, code, fault};

fn order(text: &str) -> Vec<u32> {
    blocks(text).iter().map(|block| block.origin.block()).collect()
}

#[test]
fn comments_hide_what_is_in_them() {
    assert_eq!(blocks("(G1) X1 (Y2 ; ) Z3 ; A4 (").remove(0).axes.len(), 2);
    assert_eq!(blocks("G0 X=47;X previous master axis").remove(0).axes.len(), 1);
    // Unclosed, it ends with its line.
    assert_eq!(order("N10 X1 (open\nN20 X2"), [10, 20]);
    assert_eq!(blocks("G01(no word ends here)X1").len(), 1);
}

/// PROG, comments: `N300 (comment (nested comment))`.
#[test]
fn a_comment_in_a_comment_has_its_own_end() {
    assert_eq!(order("N10 X1\nN300 (comment (nested comment))\nN20 X2"), [10, 20]);
    for text in ["N10 G0 X1 (was (old) Y1=9)", "N10 G0 X1 (was (old) Y1=9", "N10 G0 X1 ((a) (b (c)) Y1=9)"] {
        assert_eq!(blocks(text).remove(0).axes.len(), 1, "{text}");
    }
    assert_eq!(blocks("N10 G0 X1 ((a) (b (c))) Y1=9").remove(0).axes.len(), 2);
}

#[test]
fn a_comment_block_hides_lines_up_to_its_end() {
    assert_eq!(order("N10 X1\n#COMMENT BEGIN\nN20 X\n#COMMENT END\nN30 X1"), [10, 30]);
    for (text, line) in [
        ("#COMMENT BEGIN\nX1", 1),
        ("X1\n#COMMENT END", 2),
        ("#COMMENT BEGIN X1\n#COMMENT END", 1),
        ("#COMMENT BEGIN\n#COMMENT END X1", 1),
        // Text commands have blanks between their words, and a block number has digits.
        ("#COMMENTBEGIN\nX1\n#COMMENT END", 1),
        ("N #COMMENT BEGIN\nX1\n#COMMENT END", 1),
    ] {
        let (code, number, ..) = fault(text);
        assert_eq!((code.as_str(), number), ("nc-syntax", line), "{text}");
    }
}

#[test]
fn a_backslash_continues_the_line_and_places_are_those_of_the_file() {
    let block = blocks("N10 G1 \\\n  X1 \\ (first)\n  Y2 F\\\n100\nN20").remove(0);
    assert_eq!((block.axes.len(), block.feed, block.origin.line), (2, Some(100.0), 1));
    // PROG, continued lines: the block number in them means nothing.
    let block = blocks("N10 G1 F1000 \\\nN20 X100 \\\n n30Y150\nN40 X1").remove(0);
    assert_eq!((block.origin.block(), block.axes.len()), (10, 2));
    let (code, line, column, _) = fault("N10 G1 \\\n  X1 \\\n  YY2 F100");
    assert_eq!((code.as_str(), line, column), ("nc-syntax", 3, 3));
    assert_eq!(super::code("(µ°) XX"), ("nc-syntax".to_owned(), 6));
}

#[test]
fn blocks_are_skipped_by_their_level() {
    let text = "/N10 X1\n/2 N20 X2\n/10 N30 X3\nN40 X4";
    let mut channel = Channel::new(&[("part.nc", text)]);
    let mut order = |skipped: &[u8]| {
        channel.skipped = skipped.to_vec();
        channel.run(false).unwrap().iter().map(|block| block.origin.block()).collect::<Vec<_>>()
    };
    assert_eq!((order(&[]), order(&[1]), order(&[2, 10])), (vec![10, 20, 30, 40], vec![20, 30, 40], vec![10, 40]));
}

/// SG-26: what only lenient reading takes.
#[test]
fn lenient_reading_takes_what_manuals_print() {
    for (text, wanted) in [
        ("# text\nN10 X1 # text\n:\nN20 X2", vec![10, 20]),
        ("(open\ntext\ntext.) )\nN20 X2", vec![20]),
        ("(open\ntext.) N15 X1\nN20 X2", vec![15, 20]),
        // Each `(` needs a `)` of its own, as in one line.
        ("(open (two\ntext) X9\nmore) N15 X1\nN20 X2", vec![15, 20]),
        ("(open\ntext (in it) X9\nmore) N15 X1\nN20 X2", vec![15, 20]),
        // A block ends the search.
        ("(open\nN10 X1 (a)\nN20 X2", vec![10, 20]),
        ("(open\nX1 (a)\nN20 X2", vec![2, 20]),
        ("(open\n\ntext)", vec![]),
    ] {
        let mut channel = Channel::new(&[("part.nc", text)]);
        let run = channel.run(true).map(|blocks| blocks.iter().map(|block| block.origin.block()).collect::<Vec<_>>());
        match run {
            Ok(found) => assert_eq!(found, wanted, "{text}"),
            Err(fault) => assert!(wanted.is_empty(), "{text}: {fault}"),
        }
    }
    assert_eq!(code("# text"), ("nc-syntax".to_owned(), 1));
}
