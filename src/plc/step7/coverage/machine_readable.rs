//! Coverage for programs: JSON, and the format of lcov.

use std::fmt::Write;

use serde_json::json;

use super::{Counts, Coverage};

impl Coverage {
    /// As JSON: `program`, `counts`, `files` with their statements, and `unchanged`, the contacts that never changed.
    #[must_use]
    pub fn json(&self) -> String {
        let Counts { statements, networks, branches, contacts } = self.counts();
        let of = |[covered, all]: [usize; 2]| json!({ "covered": covered, "all": all });
        let statement = |one: &super::StatementCoverage| {
            let mut value = json!({
                "line": one.line, "block": one.block, "network": one.network, "statement": one.statement, "ran": one.ran,
            });
            let both = [("contact", one.contact, ["false", "true"]), ("branch", one.branch, ["not_taken", "taken"])];
            for (key, both, names) in both {
                if let Some([no, yes]) = both {
                    value[key] = json!({ names[0]: no, names[1]: yes });
                }
            }
            value
        };
        let files: Vec<_> = self
            .files
            .iter()
            .enumerate()
            .map(|(index, (path, _))| {
                let own = self.statements.iter().filter(|one| one.file == index).map(statement);
                json!({ "file": path, "statements": own.collect::<Vec<_>>() })
            })
            .collect();
        let unchanged: Vec<_> = self
            .unchanged()
            .map(|one| {
                json!({
                    "file": self.files.get(one.file).map(|(path, _)| path), "line": one.line, "block": one.block,
                    "network": one.network, "text": self.text(one), "always": one.contact.is_some_and(|[_, yes]| yes),
                })
            })
            .collect();
        let all = json!({
            "program": self.program,
            "counts": {
                "statements": of(statements), "networks": of(networks), "branches": of(branches), "contacts": of(contacts),
            },
            "built_in": self.basic_program,
            "unchanged": unchanged,
            "files": files,
        });
        format!("{all:#}\n")
    }

    /// As a tracefile of lcov: lines, and branches of jumps (`not taken`, `taken`) and of contacts (`false`, `true`).
    #[must_use]
    pub fn lcov(&self) -> String {
        let mut text = String::new();
        for ((path, _), lines) in self.files.iter().zip(self.by_line()) {
            if lines.is_empty() {
                continue;
            }
            let _ = writeln!(text, "TN:{}\nSF:{path}", self.program.replace(['/', ' '], "_"));
            let (mut found, mut hit) = (0, 0);
            for (line, statements) in &lines {
                for (block, one) in statements.iter().enumerate() {
                    let both = one.branch.iter().chain(&one.contact).flatten();
                    for (branch, taken) in both.enumerate() {
                        let count = if one.ran { u8::from(*taken).to_string() } else { "-".to_owned() };
                        let _ = writeln!(text, "BRDA:{line},{block},{branch},{count}");
                        found += 1;
                        hit += usize::from(*taken);
                    }
                }
            }
            let _ = writeln!(text, "BRF:{found}\nBRH:{hit}");
            for (line, statements) in &lines {
                let ran = statements.iter().any(|one| one.ran);
                let _ = writeln!(text, "DA:{line},{}", u8::from(ran));
            }
            let ran = lines.values().filter(|statements| statements.iter().any(|one| one.ran)).count();
            let _ = writeln!(text, "LF:{}\nLH:{ran}\nend_of_record", lines.len());
        }
        text
    }
}
