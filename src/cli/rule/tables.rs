//! The rules and decisions of the pages of `docs/`, and the scenarios that cite them: read from the texts in the program.

/// The rules.
const RULES: &str = include_str!("../../../docs/rules.md");

/// The decisions.
const DECISIONS: &str = include_str!("../../../docs/decisions.md");

/// A rule and a scenario that cites it in `covers`, one pair a line. A test compares this file with the scenarios.
const SCENARIOS: &str = include_str!("scenarios.txt");

/// A rule of a manual.
pub(super) struct RuleRow {
    pub(super) id: &'static str,
    pub(super) text: String,
    /// Manual and chapter.
    pub(super) source: &'static str,
}

/// A decision. The fields are the columns of its table.
pub(super) struct Decision {
    /// All its IDs: `O-27, REF` belongs to `O-27`.
    pub(super) id: &'static str,
    pub(super) question: String,
    pub(super) decision: String,
    pub(super) reason: String,
    pub(super) module: String,
    pub(super) test: String,
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
pub(super) fn rules() -> Vec<RuleRow> {
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
pub(super) fn decisions() -> Vec<Decision> {
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
    pub(super) fn own_id(&self) -> &'static str {
        self.id.split(',').next().unwrap_or(self.id).trim()
    }

    /// Whether it names a rule.
    pub(super) fn names(&self, id: &str) -> bool {
        [self.id, &self.question, &self.decision, &self.reason].iter().any(|text| contains(text, id))
    }
}

/// The scenarios that cite a rule.
pub(super) fn scenarios(id: &str) -> Vec<&'static str> {
    let pairs = SCENARIOS.lines().filter_map(|line| line.split_once(' '));
    pairs.filter(|(rule, _)| rule.eq_ignore_ascii_case(id)).map(|(_, scenario)| scenario).collect()
}

/// Whether a text names an ID: `REF-02` is not in `REF-021`.
pub(super) fn contains(text: &str, id: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-';
    text.match_indices(id).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + id.len()..]);
        !before.ends_with(is_part) && !after.starts_with(is_part)
    })
}

/// Why a decision has no row: the sentence of the page that names it, also in a range with `to` between two IDs.
pub(super) fn without_row(id: &str) -> Option<String> {
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
