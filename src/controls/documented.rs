//! The rules and decisions of the pages of `docs/`, read from the texts in the program. `opennck rule` prints them; a scenario that cites one
//! which does not exist is refused.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use crate::source::{Problem, did_you_mean};

/// The rules.
const RULES: &str = include_str!("../../docs/rules.md");

/// The decisions.
const DECISIONS: &str = include_str!("../../docs/decisions.md");

/// A rule of a manual.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleRow {
    /// Its ID: `REF-02`.
    pub id: &'static str,
    /// What it says.
    pub text: String,
    /// Manual and chapter.
    pub source: &'static str,
}

/// A decision. The fields are the columns of its table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decision {
    /// All its IDs: `O-27, REF` belongs to `O-27`.
    pub id: &'static str,
    /// What the manuals leave open.
    pub question: String,
    /// What the model does.
    pub decision: String,
    /// Why.
    pub reason: String,
    /// The module that does it.
    pub module: String,
    /// The scenario or test that shows it.
    pub test: String,
}

/// The cells of a row of a table; nothing for other lines, for heads and for rules below heads.
fn cells(line: &'static str) -> Option<Vec<&'static str>> {
    let inner = line.trim().strip_prefix("| ")?.strip_suffix(" |")?;
    let cells: Vec<_> = inner.split(" | ").map(str::trim).collect();
    (cells.len() > 1 && cells[0] != "ID").then_some(cells)
}

/// A text without the marks of the pages: an escaped bar, emphasis, and links.
fn plain(text: &str) -> String {
    text.replace("\\|", "|").replace("**", "")
}

/// All rules, in the order of the page.
#[must_use]
pub fn rules() -> Vec<RuleRow> {
    let mut source = "";
    let mut rows = Vec::new();
    for line in RULES.lines() {
        if let Some(text) = line.strip_prefix("Source: ") {
            source = text;
        }
        if let Some(cells) = cells(line) {
            rows.push(RuleRow { id: cells[0], text: plain(&cells[1..].join(" | ")), source });
        }
    }
    rows
}

/// All decisions, in the order of the page.
#[must_use]
pub fn decisions() -> Vec<Decision> {
    let rows = DECISIONS.lines().filter_map(cells).filter(|cells| cells.len() >= 6);
    rows.map(|cells| Decision {
        id: cells[0],
        question: plain(cells[1]),
        decision: plain(&cells[2..cells.len() - 3].join(" | ")),
        reason: plain(cells[cells.len() - 3]),
        module: cells[cells.len() - 2].replace('`', ""),
        test: cells[cells.len() - 1].replace('`', ""),
    })
    .collect()
}

impl Decision {
    /// Its own ID: the first one.
    #[must_use]
    pub fn own_id(&self) -> &'static str {
        self.id.split(',').next().unwrap_or(self.id).trim()
    }

    /// Whether it names a rule.
    #[must_use]
    pub fn names(&self, id: &str) -> bool {
        [self.id, &self.question, &self.decision, &self.reason].iter().any(|text| contains(text, id))
    }
}

/// Whether a text names an ID: `REF-02` is not in `REF-021`.
#[must_use]
pub fn contains(text: &str, id: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-';
    text.match_indices(id).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + id.len()..]);
        !before.ends_with(is_part) && !after.starts_with(is_part)
    })
}

/// Why a decision has no row: the sentence of the page that names it, also in a range with `to` between two IDs.
#[must_use]
pub fn without_row(id: &str) -> Option<String> {
    let (letter, number) = id.split_once('-')?;
    let number: u32 = number.parse().ok()?;
    let mut paragraphs = DECISIONS.split("\n\n").filter(|text| text.starts_with("E-") || text.starts_with("O-"));
    let named = |text: &&str| {
        let words: Vec<_> = text.split([' ', '\n', ',']).filter(|word| !word.is_empty()).collect();
        let of_letter = |word: &str| {
            word.split_once('-').filter(|(of, _)| *of == letter).and_then(|(_, number)| number.parse::<u32>().ok())
        };
        let alone = words.iter().any(|word| of_letter(word) == Some(number));
        let in_range = words.windows(3).any(|three| {
            let ends = (of_letter(three[0]), of_letter(three[2]));
            matches!(ends, (Some(first), Some(last)) if three[1] == "to" && (first..=last).contains(&number))
        });
        alone || in_range
    };
    let found = paragraphs.find(named)?;
    Some(found.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// The IDs of all rules and decisions.
static IDS: LazyLock<BTreeSet<&'static str>> = LazyLock::new(|| {
    let decisions = decisions();
    rules().iter().map(|rule| rule.id).chain(decisions.iter().map(Decision::own_id)).collect()
});

/// The letters before the number of an ID: `REF` of `REF-02`; `None` for a text of another form.
fn family(id: &str) -> Option<&str> {
    let (family, number) = id.split_once('-')?;
    (!number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())).then_some(family)
}

/// Checks an ID that a scenario cites. IDs of families that the pages do not have belong to the user.
///
/// # Errors
/// The family is known, but no rule or decision has this ID; the problem names a near one.
pub fn check_id(id: &str) -> Result<(), Problem> {
    let wanted = id.to_ascii_uppercase();
    let Some(family_of) = family(&wanted) else { return Ok(()) };
    let mut of_family = IDS.iter().copied().filter(|known| family(known) == Some(family_of)).peekable();
    if of_family.peek().is_none() || IDS.contains(wanted.as_str()) || without_row(&wanted).is_some() {
        return Ok(());
    }
    let list = format!(
        "`opennck rule {family_of}-` lists the rules of this family; for IDs of your own, choose other letters"
    );
    let near = did_you_mean(&wanted, of_family, "");
    let cure = if near.is_empty() { list } else { format!("{near} {list}") };
    Err(Problem::new(format!("expected the ID of a rule or a decision, found `{id}`"), cure))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_of_a_known_family_must_exist_and_others_are_free() {
        for id in
            ["REF-02", "ref-02", "E-14", "O-30", "C-20", "SPEC-12", "REQ-7", "25040", "free text", "REF-", "REF-a"]
        {
            assert_eq!(check_id(id), Ok(()), "{id}");
        }
        let problem = check_id("REF-99").unwrap_err().to_string();
        assert!(problem.contains("found `REF-99`") && problem.contains("did you mean `REF-"), "{problem}");
        for family in ["MON", "SYN", "O", "E"] {
            assert!(check_id(&format!("{family}-990")).is_err(), "{family}");
        }
    }
}
