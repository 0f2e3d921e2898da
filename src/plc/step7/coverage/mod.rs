//! Coverage of a program: statements, networks, branches, and contacts that were true and false; as text, HTML, JSON and lcov.

mod html;
mod machine_readable;

use std::collections::BTreeMap;

use super::engine::{Kind, NO, Observed, RAN, YES, kind};
use super::program::Program;

/// What ran of a statement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatementCoverage {
    /// The index of its file.
    pub file: usize,
    /// The line in it, from one.
    pub line: u32,
    /// The block, as `FC10`.
    pub block: String,
    /// The network, from one.
    pub network: u16,
    /// The statement in the network, from one.
    pub statement: u32,
    /// It ran at least once.
    pub ran: bool,
    /// For a contact, a comparison or an edge: whether it was false, and whether it was true.
    pub contact: Option<[bool; 2]>,
    /// For a conditional jump, call or end: whether it was not taken, and whether it was taken.
    pub branch: Option<[bool; 2]>,
}

/// The coverage of a program by one or several runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// The name of the program.
    pub program: String,
    /// The paths of its sources and their texts.
    pub files: Vec<(String, String)>,
    /// Its statements, by block.
    pub statements: Vec<StatementCoverage>,
    /// Blocks of the basic program that are built in and called, as `FC10 AL_MSG`: none of the statements is theirs.
    pub basic_program: Vec<String>,
    fingerprint: u64,
}

/// Numbers of a coverage: those that were covered, and all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Statements that ran.
    pub statements: [usize; 2],
    /// Networks of which a statement ran.
    pub networks: [usize; 2],
    /// Branches that were taken, and those that were not: two for each conditional jump, call or end.
    pub branches: [usize; 2],
    /// Contacts that were true and false.
    pub contacts: [usize; 2],
}

impl Coverage {
    pub(super) fn of(name: &str, program: &Program, observed: &Observed, files: Vec<(String, String)>) -> Self {
        let mut statements: Vec<StatementCoverage> = Vec::new();
        let mut last = None;
        for (pc, (&op, &line)) in (0..).zip(program.code.iter().zip(&program.lines)) {
            let Some(block) = program.block_at(pc) else { continue };
            let mark = observed.marks.get(pc as usize).copied().unwrap_or(0);
            if last.replace((block.start, line)) != Some((block.start, line)) {
                statements.push(StatementCoverage {
                    file: line.file.into(),
                    line: line.line,
                    block: block.name.to_string(),
                    network: line.network,
                    statement: line.statement,
                    ran: false,
                    contact: None,
                    branch: None,
                });
            }
            let Some(statement) = statements.last_mut() else { continue };
            statement.ran |= mark & RAN != 0;
            let both = [mark & NO != 0, mark & YES != 0];
            match kind(op) {
                Kind::Plain => {}
                Kind::Contact => statement.contact = Some(both),
                Kind::Branch => statement.branch = Some(both),
            }
        }
        let basic_program = program.basic_program().map(|(block, name)| format!("{block} {name}")).collect();
        Self { program: name.to_owned(), files, statements, basic_program, fingerprint: program.fingerprint }
    }

    /// Whether it is of the same program.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        self.program == other.program && self.fingerprint == other.fingerprint
    }

    /// Adds what another run of the same program covered.
    pub fn add(&mut self, other: &Self) {
        let both = |mine: &mut Option<[bool; 2]>, other: Option<[bool; 2]>| {
            if let (Some(mine), Some(other)) = (mine, other) {
                *mine = [mine[0] | other[0], mine[1] | other[1]];
            }
        };
        for (mine, other) in self.statements.iter_mut().zip(&other.statements) {
            mine.ran |= other.ran;
            both(&mut mine.contact, other.contact);
            both(&mut mine.branch, other.branch);
        }
    }

    /// How much is covered.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        let mut networks: BTreeMap<(&str, u16), bool> = BTreeMap::new();
        for statement in &self.statements {
            counts.statements[0] += usize::from(statement.ran);
            counts.statements[1] += 1;
            *networks.entry((&statement.block, statement.network)).or_default() |= statement.ran;
            if let Some([no, yes]) = statement.branch {
                counts.branches[0] += usize::from(no) + usize::from(yes);
                counts.branches[1] += 2;
            }
            if let Some([no, yes]) = statement.contact {
                counts.contacts[0] += usize::from(no && yes);
                counts.contacts[1] += 1;
            }
        }
        counts.networks = [networks.values().filter(|ran| **ran).count(), networks.len()];
        counts
    }

    /// One line: `step7/portal: 120 of 140 statements (85 %), …`.
    #[must_use]
    pub fn summary(&self) -> String {
        let Counts { statements, networks, branches, contacts } = self.counts();
        let of = |[done, all]: [usize; 2], noun: &str| format!("{done} of {all} {noun} ({} %)", percent([done, all]));
        format!(
            "{}: {}, {}, {}, {}",
            self.program,
            of(statements, "statements"),
            of(networks, "networks"),
            of(branches, "branches"),
            of(contacts, "contacts true and false"),
        )
    }

    /// Contacts that ran and never changed, in the order of the program.
    pub fn unchanged(&self) -> impl Iterator<Item = &StatementCoverage> {
        self.statements.iter().filter(|statement| statement.ran && statement.contact.is_some_and(|[no, yes]| no != yes))
    }

    /// The line of a statement, without its comment.
    #[must_use]
    pub fn text(&self, statement: &StatementCoverage) -> &str {
        let text = self.files.get(statement.file).map_or("", |(_, text)| text);
        let line = text.lines().nth((statement.line as usize).saturating_sub(1)).unwrap_or_default();
        line.split("//").next().unwrap_or_default().trim()
    }

    /// The statements of each file by line.
    fn by_line(&self) -> Vec<BTreeMap<u32, Vec<&StatementCoverage>>> {
        let mut lines = vec![BTreeMap::<u32, Vec<&StatementCoverage>>::new(); self.files.len()];
        for statement in &self.statements {
            if let Some(lines) = lines.get_mut(statement.file) {
                lines.entry(statement.line).or_default().push(statement);
            }
        }
        lines
    }
}

/// Whole per cent; 100 of nothing.
fn percent([done, all]: [usize; 2]) -> usize {
    (done * 100).checked_div(all).unwrap_or(100)
}
