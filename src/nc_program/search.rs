//! Searches in the text of a program: the end of a control structure, and jump targets. A search reads only the beginning of each line, so
//! a wrong block that is jumped over is never noticed.

use serde::{Deserialize, Serialize};

use super::dialect::Dialect;
use super::head::{Head, head, significant, word};
use super::source::Program;
use super::syntax::Direction;

/// A control structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum StructureKind {
    If,
    While,
    Repeat,
    Loop,
    For,
}

/// What a line does to the control structures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bracket {
    Opens(StructureKind),
    Else,
    Closes(StructureKind),
}

/// What the words of a line, which begin at `from`, do to the control structures.
pub(super) fn bracket(line: &str, from: usize, dialect: &Dialect) -> Option<Bracket> {
    let first = word(line, from);
    let rest = code(&line[from + first.len()..], dialect);
    if first.is_empty() || rest.trim_start().starts_with('=') && !rest.trim_start().starts_with("==") {
        return None;
    }
    let found = match first.to_ascii_uppercase().as_str() {
        "IF" if has_jump(rest) => return None,
        "IF" => Bracket::Opens(StructureKind::If),
        "ELSE" => Bracket::Else,
        "ENDIF" => Bracket::Closes(StructureKind::If),
        "WHILE" => Bracket::Opens(StructureKind::While),
        "ENDWHILE" => Bracket::Closes(StructureKind::While),
        "REPEAT" if !rest.trim().is_empty() => return None,
        "REPEAT" => Bracket::Opens(StructureKind::Repeat),
        "UNTIL" => Bracket::Closes(StructureKind::Repeat),
        "LOOP" => Bracket::Opens(StructureKind::Loop),
        "ENDLOOP" => Bracket::Closes(StructureKind::Loop),
        "FOR" => Bracket::Opens(StructureKind::For),
        "ENDFOR" => Bracket::Closes(StructureKind::For),
        _ => return None,
    };
    Some(found)
}

/// A text without strings that could contain a comment, up to the comment.
fn code<'a>(text: &'a str, dialect: &Dialect) -> &'a str {
    let mut is_string = false;
    let end = text.find(|c: char| {
        is_string ^= c == '"';
        c == dialect.comment && !is_string
    });
    &text[..end.unwrap_or(text.len())]
}

/// Whether a word outside strings begins with GOTO.
fn has_jump(text: &str) -> bool {
    text.split('"').step_by(2).any(|outside| {
        let mut words = outside.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        words.any(|word| word.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("GOTO")))
    })
}

/// The lines behind `line` with the effect of each on control structures.
fn brackets<'a>(program: &'a Program, line: u32, dialect: &'a Dialect) -> impl Iterator<Item = (u32, Bracket)> + 'a {
    (line.saturating_add(1)..=program.count()).filter_map(move |line| {
        let (head, text) = program.head(line)?;
        Some((line, bracket(text, head.rest, dialect)?))
    })
}

/// Where the structure that is open behind a line ends: its closing word, or its ELSE if that counts. None if it is not closed, or crossed.
pub(super) fn closing(
    program: &Program,
    line: u32,
    kind: StructureKind,
    stops_at_else: bool,
    dialect: &Dialect,
) -> Option<(u32, Bracket)> {
    let mut open = vec![kind];
    for (line, bracket) in brackets(program, line, dialect) {
        match bracket {
            Bracket::Opens(kind) => open.push(kind),
            Bracket::Else if open.len() == 1 && kind == StructureKind::If && stops_at_else => {
                return Some((line, bracket));
            }
            Bracket::Else => {}
            Bracket::Closes(kind) if open.pop() == Some(kind) => {
                if open.is_empty() {
                    return Some((line, bracket));
                }
            }
            Bracket::Closes(_) => return None,
        }
    }
    None
}

/// The number of structures, from the innermost one, that a jump forward leaves.
pub(super) fn left_by_jump(program: &Program, from: u32, to: u32, dialect: &Dialect) -> usize {
    let (mut inside, mut left) = (0_usize, 0_usize);
    for (line, bracket) in brackets(program, from, dialect) {
        if line >= to {
            break;
        }
        match bracket {
            Bracket::Opens(_) => inside += 1,
            Bracket::Else => {}
            Bracket::Closes(_) if inside > 0 => inside -= 1,
            Bracket::Closes(_) => left += 1,
        }
    }
    left
}

/// What a jump looks for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Wanted {
    Label(String),
    Number { is_main: bool, digits: String },
}

impl Wanted {
    /// `N10`, `:10`, or a label.
    pub(super) fn new(text: &str) -> Self {
        let text = text.trim().trim_end_matches(':').to_ascii_uppercase();
        let number = |prefix: char| {
            let digits = text.strip_prefix(prefix)?.trim();
            let is_number = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
            is_number.then(|| Self::Number { is_main: prefix == ':', digits: significant(digits).to_owned() })
        };
        number('N').or_else(|| number(':')).unwrap_or(Self::Label(text))
    }

    pub(super) fn text(&self) -> String {
        match self {
            Self::Label(label) => label.clone(),
            Self::Number { is_main, digits } => format!("{}{digits}", if *is_main { ':' } else { 'N' }),
        }
    }

    fn is_at(&self, program: &Program, line: u32) -> bool {
        program.head(line).is_some_and(|(head, _)| self.is_head(&head))
    }

    fn is_head(&self, head: &Head<'_>) -> bool {
        match self {
            Self::Label(label) => head.label.is_some_and(|found| found.eq_ignore_ascii_case(label)),
            Self::Number { is_main, digits } => {
                head.number.is_some_and(|found| found.is_main == *is_main && found.digits == digits)
            }
        }
    }
}

/// The line of a jump target. A search backward begins with the line of the jump itself.
pub(super) fn target(program: &Program, wanted: &Wanted, from: u32, direction: Direction) -> Option<u32> {
    let mut forward = from.saturating_add(1)..=program.count();
    let mut backward = (1..=from.min(program.count())).rev();
    let mut found = |line: &u32| wanted.is_at(program, *line);
    match direction {
        Direction::Forward => forward.find(&mut found),
        Direction::Backward => backward.find(&mut found),
        Direction::Both | Direction::BothSilent => forward.find(&mut found).or_else(|| backward.find(&mut found)),
        Direction::Start => Some(1),
    }
}

/// A block that a search of the operator looks for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlockTarget(Wanted);

impl BlockTarget {
    /// `N50`, `:50`, or a label of 2 to 32 characters of which the first two are letters or `_`.
    #[must_use]
    pub fn new(text: &str) -> Option<Self> {
        let wanted = Wanted::new(text);
        let is_valid = match &wanted {
            Wanted::Number { .. } => true,
            Wanted::Label(label) => {
                let is_part = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
                (2..=32).contains(&label.len())
                    && label.bytes().all(is_part)
                    && label.bytes().take(2).all(|byte| !byte.is_ascii_digit())
            }
        };
        is_valid.then_some(Self(wanted))
    }

    /// Whether this line is the block.
    #[must_use]
    pub fn is(&self, line: &str) -> bool {
        self.is_head(&head(line))
    }

    /// Whether a line with this head is the block.
    pub(super) fn is_head(&self, head: &Head<'_>) -> bool {
        self.0.is_head(head)
    }

    /// The line of the block in a program.
    pub(super) fn line(&self, program: &Program) -> Option<u32> {
        target(program, &self.0, 0, Direction::Forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nc_program::dialect::SINUMERIK;
    use crate::nc_program::source::ProgramKind;

    fn program(text: &str) -> Program {
        Program::new("A", ProgramKind::Main, "", text.as_bytes())
    }

    #[test]
    fn the_end_of_a_structure_is_found_over_nested_ones() {
        let program = program("IF A==1\nIF B GOTOF X\nWHILE C\nENDWHILE\nIF D ; GOTOF\nELSE\nENDIF\nELSE\nENDIF");
        let line = |stops| closing(&program, 1, StructureKind::If, stops, &SINUMERIK).map(|found| found.0);
        assert_eq!((line(true), line(false)), (Some(8), Some(9)));
    }

    #[test]
    fn crossed_and_open_structures_have_no_end() {
        for text in ["IF A\nWHILE B\nENDIF\nENDWHILE", "IF A\nM30"] {
            assert_eq!(closing(&program(text), 1, StructureKind::If, false, &SINUMERIK), None, "{text}");
        }
    }

    #[test]
    fn words_in_strings_and_comments_do_not_count() {
        assert_eq!(bracket("IF A==\"GOTOF\"", 0, &SINUMERIK), Some(Bracket::Opens(StructureKind::If)));
        assert_eq!(bracket("IF A GOTOB X", 0, &SINUMERIK), None);
        assert_eq!(bracket("REPEAT ; until", 0, &SINUMERIK), Some(Bracket::Opens(StructureKind::Repeat)));
        assert_eq!(bracket("REPEAT ABC", 0, &SINUMERIK), None);
        assert_eq!(bracket("LOOP=5", 0, &SINUMERIK), None);
    }

    #[test]
    fn the_nearest_target_in_the_direction_of_the_search_counts() {
        let program = program("AB: X1\nN010 X2\nGOTO AB\nAB: X3\n:10 X4");
        let find = |text: &str, direction| target(&program, &Wanted::new(text), 3, direction);
        assert_eq!(find("AB", Direction::Forward), Some(4));
        assert_eq!(find("ab", Direction::Backward), Some(1));
        assert_eq!(find("N10", Direction::Both), Some(2));
        assert_eq!(find("N10", Direction::Forward), None);
        assert_eq!(find(":10", Direction::Forward), Some(5));
    }
}
