//! The block search of a step: its block, and the words of its kinds.

use crate::machine::SearchKind;
use crate::source::{Node, Problem};

/// The words of the kinds of a block search.
const SEARCHES: [(&str, SearchKind); 4] = [
    ("without_calculation", SearchKind::WithoutCalculation),
    ("contour", SearchKind::Contour),
    ("end_point", SearchKind::EndPoint),
    ("serupro", SearchKind::ProgramTest),
];

/// The word of a kind of a block search.
pub(super) fn search_word(kind: SearchKind) -> &'static str {
    SEARCHES.iter().find(|(_, other)| *other == kind).map_or("", |(word, _)| word)
}

/// The kind of a block search by its word.
pub(super) fn search_kind(word: &str) -> Option<SearchKind> {
    SEARCHES.iter().find(|(other, _)| *other == word).map(|(_, kind)| *kind)
}

/// What a block search with an unknown kind should say.
pub(super) fn search_kinds() -> String {
    format!("write one of {}", SEARCHES.map(|(word, _)| format!("\"{word}\"")).join(", "))
}

/// A block search, as `{ block = "N50", kind = "serupro" }`.
pub(super) fn search(node: Node) -> Result<(String, SearchKind), Problem> {
    let place = node.place.clone();
    let mut table = node.into_table("a block search, as { block = \"N50\", kind = \"contour\" }")?;
    let Some(block) = table.take("block") else {
        return Err(place.problem("expected `block` in a block search, found none", "write block = \"N50\""));
    };
    let block = block.text("a block: \"N50\", \":50\" or a label")?.to_owned();
    let Some(kind) = table.take("kind") else {
        return Err(place.problem("expected `kind` in a block search, found none", search_kinds()));
    };
    let found = search_kind(kind.text("the kind of a block search")?);
    let kind = found.ok_or_else(|| kind.expected("the kind of a block search", &search_kinds()))?;
    table.finish()?;
    Ok((block, kind))
}
