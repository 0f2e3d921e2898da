//! Names of entries: list names with zero-based indices (`getriebe[0].dynamik.a_max`) and IDs (`P-AXIS-00008`, O-33), and the parameters
//! that they mean.
//!
//! An ID may have the indices of the list name behind it, the last one last: `P-CHAN-00006[1]` is `gruppe[0].achse[1].bezeichnung`.
//! Without them it is the entry with the indices 0.

use super::parameter::{Index, Key, Parameter, Scope};
use super::table::PARAMETERS;

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// An entry of a known parameter.
    Known(&'static Parameter, Index),
    /// A parameter that is not in the table.
    Unknown,
}

/// The parameter with this ID or list name, and its indices: `P-AXIS-00072`, `kenngr.gantry_max_diff_resetable`,
/// `getriebe[0].dynamik.a_max`. `None` if it is unknown or an index is broken.
#[must_use]
pub fn parameter(name: &str) -> Option<(&'static Parameter, Index)> {
    match meaning(name) {
        Ok(Meaning::Known(parameter, index)) => Some((parameter, index)),
        Ok(Meaning::Unknown) | Err(_) => None,
    }
}

/// The parameter of the list of an axis or of a channel with this ID or list name, as a key.
pub(super) fn key(scope: Scope, name: &str) -> Option<Key> {
    let (parameter, index) = parameter(name)?;
    (parameter.scope == scope).then_some(Key { number: parameter.number(), index })
}

/// The meaning of a name.
///
/// # Errors
/// An index is broken; the text says what is wrong.
pub(super) fn meaning(name: &str) -> Result<Meaning, String> {
    let (plain, indices) = without_indices(name)?;
    let found = match by_id(&plain) {
        Some(parameter) => Some((parameter, true)),
        None => by_list_name(&plain).map(|parameter| (parameter, false)),
    };
    let Some((parameter, is_id)) = found else {
        return Ok(Meaning::Unknown);
    };
    let expected = parameter.indices();
    if indices.len() > expected || !is_id && indices.len() != expected {
        let printed = parameter.name.unwrap_or("without an index");
        return Err(format!("`{name}` has {}, its name is {printed}", count(indices.len())));
    }
    // The last index given is the last one of the list name.
    let mut index = [0; 2];
    for (place, value) in (0..expected).rev().zip(indices.iter().rev()) {
        index[place] = *value;
    }
    let largest = parameter.largest_index();
    if let Some(place) = (0..2).find(|place| index[*place] > largest[*place]) {
        return Err(format!("`{name}` has the index {}, the largest is {}", index[place], largest[place]));
    }
    Ok(Meaning::Known(parameter, index))
}

/// The name without what stands in brackets, `getriebe[].dynamik.a_max`, and the numbers that stood in them. An ID keeps no brackets.
fn without_indices(name: &str) -> Result<(String, Vec<u16>), String> {
    let broken = || format!("`{name}` has a broken index");
    let (mut plain, mut indices, mut rest) = (String::new(), Vec::new(), name);
    while let Some(at) = rest.find(['[', ']']) {
        let (before, bracket) = rest.split_at(at);
        let (number, after) = bracket.strip_prefix('[').and_then(|inner| inner.split_once(']')).ok_or_else(broken)?;
        let is_number = !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit());
        let ends = after.is_empty() || after.starts_with(['.', '[']);
        let is_named = !before.is_empty() && !before.ends_with('.') || before.is_empty() && !indices.is_empty();
        let number = number.parse().ok().filter(|_| is_number && ends && is_named).ok_or_else(broken)?;
        plain.push_str(before);
        plain.push_str("[]");
        indices.push(number);
        rest = after;
    }
    plain.push_str(rest);
    Ok((plain, indices))
}

fn by_id(plain: &str) -> Option<&'static Parameter> {
    let plain = plain.trim_end_matches("[]");
    let digits = plain.strip_prefix("P-AXIS-").or_else(|| plain.strip_prefix("P-CHAN-"))?;
    let digits: u32 = digits.parse().ok()?;
    PARAMETERS.iter().find(|parameter| parameter.digits == digits && parameter.id() == plain)
}

fn by_list_name(plain: &str) -> Option<&'static Parameter> {
    let unindexed = plain.replace("[]", "");
    PARAMETERS.iter().find(|parameter| {
        let Some(name) = parameter.name else { return false };
        let name = name.replace("[i]", "").replace("[j]", "");
        name == unindexed || parameter.is_structure_assumed && name.rsplit('.').next() == Some(plain)
    })
}

fn count(indices: usize) -> String {
    match indices {
        0 => "no index".to_owned(),
        1 => "one index".to_owned(),
        more => format!("{more} indices"),
    }
}

/// A known list name of this scope that a misspelt name probably means.
#[must_use]
pub(super) fn probably(scope: Scope, name: &str) -> Option<&'static str> {
    let (plain, _) = without_indices(name).ok()?;
    let plain = plain.replace("[]", "");
    let names = PARAMETERS.iter().filter(|parameter| parameter.scope == scope).filter_map(|parameter| parameter.name);
    let wrong = |known: &str| wrong_letters(&plain, &known.replace("[i]", "").replace("[j]", ""));
    names.map(|known| (wrong(known), known)).filter(|(wrong, _)| *wrong <= MOST_WRONG).min().map(|(_, known)| known)
}

/// Axis lists hold hundreds of similar names: one that is further away is another parameter.
const MOST_WRONG: usize = 2;

/// The number of letters to insert, remove or replace; a large number at once if the lengths are too different.
fn wrong_letters(one: &str, other: &str) -> usize {
    let (one, other): (Vec<char>, Vec<char>) = (one.chars().collect(), other.chars().collect());
    if one.len().abs_diff(other.len()) > MOST_WRONG {
        return usize::MAX;
    }
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, letter) in one.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, wanted) in other.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != wanted);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[other.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isg::lists::table::by_number;

    fn number(name: &str) -> Option<(u32, Index)> {
        parameter(name).map(|(parameter, index)| (parameter.number(), index))
    }

    /// HG-28: dotted names with zero-based indices; O-33: an ID has the same meaning.
    #[test]
    fn a_list_name_and_an_id_mean_the_same_parameter() {
        assert_eq!(number("P-AXIS-00072"), Some((72, [0, 0])));
        assert_eq!(number("kenngr.gantry_max_diff_resetable"), Some((72, [0, 0])));
        assert_eq!(number("getriebe[0].dynamik.a_max"), Some((8, [0, 0])));
        assert_eq!(number("getriebe[3].dynamik.a_max"), Some((8, [3, 0])));
        assert_eq!(number("P-AXIS-00008"), Some((8, [0, 0])));
        assert_eq!(number("P-AXIS-00261"), Some((261, [0, 0])));
        assert_eq!(number("P-CHAN-00104"), Some((100_104, [0, 0])));
        assert_eq!(number("gruppe[0].achse[4].bezeichnung"), Some((100_006, [0, 4])));
        assert_eq!(number("P-CHAN-00006[4]"), Some((100_006, [0, 4])));
        assert_eq!(number("P-CHAN-00006[0][4]"), Some((100_006, [0, 4])));
    }

    /// HG-28: what is not the name of a parameter is unknown, not another parameter.
    #[test]
    fn similar_names_are_other_parameters() {
        for name in
            ["P-AXIS-72", "P-AXIS-00999", "P-CHAN-00072", "P-AXIS-", "kenngr", "a_max", "kenngr.GANTRY_AX_NR", ""]
        {
            assert_eq!(meaning(name), Ok(Meaning::Unknown), "{name}");
        }
    }

    /// HG-28: the structure of three parameters is assumed, so their names are enough.
    #[test]
    fn a_name_of_an_assumed_structure_may_stand_alone() {
        assert_eq!(number("ref_ohne_nocken"), number("kenngr.ref_ohne_nocken"));
        assert_eq!(number("gantry_ax_nr"), None);
    }

    /// HG-28: a broken index is an error.
    #[test]
    fn a_broken_index_is_an_error() {
        for name in [
            "getriebe[.dynamik.a_max",
            "getriebe].dynamik.a_max",
            "getriebe[].dynamik.a_max",
            "getriebe[-1].dynamik.a_max",
            "getriebe[i].dynamik.a_max",
            "getriebe[0.dynamik.a_max",
            "getriebe[0]dynamik.a_max",
            "getriebe[70000].dynamik.a_max",
            "getriebe.dynamik.a_max",
            "kenngr.gantry_ax_nr[0]",
            "P-AXIS-00072[0]",
            "P-CHAN-00006[0][1][2]",
            "[0].a",
            "gruppe[0].achse[32].bezeichnung",
            "synchro_data.koppel_gruppe[0].paar[15].mode",
            "]",
        ] {
            assert!(meaning(name).is_err(), "{name}");
        }
    }

    #[test]
    fn a_misspelt_name_is_recognised_and_another_parameter_is_not() {
        let probably = |name| probably(Scope::Axis, name);
        assert_eq!(probably("kenngr.gantry_max_diff_resettable"), Some("kenngr.gantry_max_diff_resetable"));
        assert_eq!(probably("getriebe[0].dynamik.amax"), Some("getriebe[i].dynamik.a_max"));
        assert_eq!(probably("kenngr.swe_pos"), None);
        assert_eq!(probably("synchro_data.restore_coupling_after_rest"), None);
    }

    #[test]
    fn each_parameter_is_found_by_its_id_its_number_and_its_list_name() {
        for row in PARAMETERS {
            assert_eq!(parameter(&row.id()).map(|(found, _)| found), Some(row));
            assert_eq!(by_number(row.number()), Some(row));
            if let Some(name) = row.list_name([0, 0]) {
                assert_eq!(parameter(&name).map(|(found, _)| found), Some(row), "{name}");
            }
        }
        assert!(PARAMETERS.is_sorted_by_key(|parameter| parameter.number()));
    }
}
